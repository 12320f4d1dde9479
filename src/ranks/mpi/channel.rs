//! Messages from one rank to another, each with memory that waits for it before it comes.
//!
//! The receiver must know how long a message may be before it can wait for it. Both ends know how long the messages
//! before were, so both know the [`Room`] for the next: no word goes between them about it. One that is longer is told
//! of in its place and comes after, which costs a message more and happens when messages grow.
//!
//! A message's last byte says which of the two it is.

use super::pending::PendingReceive;
use ::mpi::topology::SimpleCommunicator;
use ::mpi::{Rank, Tag};

pub(super) const MESSAGE: Tag = 0;
/// Of messages for which there was no room.
pub(super) const LONG_MESSAGE: Tag = 2;

const WHOLE: u8 = 0;
const COMES_AFTER: u8 = 1;

/// Bytes that wait for the next message, as both ends know it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Room(usize);

/// Whatever the messages before.
const LEAST: usize = 1 << 12;
/// More is not kept waiting: what moves at a rebalance would stay taken.
const MOST: usize = 1 << 26;

impl Room {
    pub(super) fn first() -> Room {
        Room(LEAST)
    }

    fn holds(self, message: usize) -> bool {
        message < self.0
    }

    /// After a message of so many bytes: up at once, down slowly.
    fn follow(&mut self, message: usize) {
        let wanted = message.saturating_add(message / 4).saturating_add(1);
        self.0 = wanted.max(self.0 - self.0 / 16).clamp(LEAST, MOST);
    }
}

/// What goes to the other end: at once, and afterwards.
pub(super) fn parts(room: &mut Room, mut message: Vec<u8>) -> (Vec<u8>, Option<Vec<u8>>) {
    let fits = room.holds(message.len());
    room.follow(message.len());
    if fits {
        message.push(WHOLE);
        (message, None)
    } else {
        (vec![COMES_AFTER], Some(message))
    }
}

/// The receiving end.
pub(super) struct Inbox {
    room: Room,
    waiting: PendingReceive,
}

impl Inbox {
    pub(super) fn open(world: &SimpleCommunicator, source: Rank) -> Inbox {
        let room = Room::first();
        Inbox { room, waiting: PendingReceive::start(world, source, MESSAGE, room.0) }
    }

    /// The next message; `after` gives the next of those for which there was no room. Memory waits for the one that
    /// follows when this returns.
    pub(super) fn next(
        &mut self,
        world: &SimpleCommunicator,
        source: Rank,
        after: impl FnOnce() -> Vec<u8>,
    ) -> Vec<u8> {
        let mut message = self.waiting.wait();
        if message.pop() == Some(COMES_AFTER) {
            message = after();
        }
        self.room.follow(message.len());
        self.waiting = PendingReceive::start(world, source, MESSAGE, self.room.0);
        message
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both ends have the same room after the same messages, and no message is longer than what waits for it.
    #[test]
    fn what_is_sent_fits_what_waits() {
        let mut room = Room::first();
        let mut later = 0;
        for length in [0, 1, LEAST - 1, LEAST, 10 * LEAST, 10 * LEAST, 12 * LEAST, 5, 5, MOST, MOST, 100] {
            let waiting = room;
            let (first, after) = parts(&mut room, vec![7; length]);
            assert!(first.len() <= waiting.0, "{length} bytes");
            assert_eq!(after.as_ref().map_or(first.len() - 1, Vec::len), length);
            assert_eq!(first.last(), Some(&if after.is_some() { COMES_AFTER } else { WHOLE }));
            later += usize::from(after.is_some());
            let mut there = waiting;
            there.follow(length);
            assert_eq!(there, room);
        }
        // Those that outgrew their room, and those for which none is kept.
        assert_eq!(later, 3);
    }

    /// A message that was long once does not hold its room for ever.
    #[test]
    fn room_shrinks_when_messages_do() {
        let mut room = Room::first();
        room.follow(1 << 24);
        assert!(room.holds(1 << 24));
        (0..200).for_each(|_| room.follow(100));
        assert_eq!(room, Room::first());
    }
}
