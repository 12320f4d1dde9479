//! Ranks as processes of MPI.
//!
//! One thread of the process calls MPI: the one that started it ("funneled"). MPI's own errors end all ranks,
//! as is its default. So does a panic of any thread, which else would leave the other ranks waiting: a hook
//! tells of it with the rank and aborts.
//!
//! MPI's behaviour is undefined where ranks reduce lists of different lengths. Therefore the first words of a
//! reduction travel in messages of one size for all, together with the lengths; what does not fit follows once
//! the lengths are known to agree, and then ranks wait. That size grows with the longest that was ever finished, which all
//! ranks know alike: of reductions that are made again and again only the first ones wait.

mod channel;
mod pending;

use super::communicator::{check_other, panic_message, within_limit};
use super::launcher::Launcher;
use super::reduction::{Lengths, Reduction, Tickets};
use super::{Communicator, LONGEST_MESSAGE, RankError};
use ::mpi::collective::{CommunicatorCollectives, Root};
use ::mpi::datatype::{Equivalence, PartitionMut};
use ::mpi::environment::{Universe, is_finalized};
use ::mpi::point_to_point::Source;
use ::mpi::topology::{Communicator as _, SimpleCommunicator};
use ::mpi::{Count, Rank, Tag, Threading};
use channel::{Inbox, LONG_MESSAGE, MESSAGE, Room, parts};
use pending::{Operation, PendingReduction, PendingSend};
use std::cell::{Cell, RefCell};
use std::collections::{HashMap, VecDeque};
use std::io::Write;
use std::marker::PhantomData;
use std::panic;
use std::thread;

const GATHERED: Tag = 1;
/// Words of a reduction's head, of sums and of maxima each, at first.
const HEAD: usize = 64;
/// And at most.
const LONGEST_HEAD: usize = 1 << 14;
/// Exit code after a panic, as of any program in Rust.
const PANICKED: i32 = 101;

/// One of the processes.
///
/// Fields are dropped in order: what is under way first, MPI last.
pub(super) struct Mpi {
    sends: RefCell<Vec<PendingSend>>,
    /// By source, of those from whom a message was received.
    inboxes: RefCell<HashMap<usize, Inbox>>,
    /// By destination.
    rooms: RefCell<Vec<Room>>,
    tickets: Tickets,
    under_way: RefCell<VecDeque<UnderWay>>,
    /// Words of the heads of reductions that are started from now on: the same for all ranks, since they start and finish in one
    /// order.
    head: Cell<usize>,
    rank: usize,
    size: usize,
    node_rank: usize,
    node_size: usize,
    world: SimpleCommunicator,
    _universe: Universe,
    /// Stays on its thread.
    _thread: PhantomData<*const ()>,
}

/// A reduction whose head is being reduced.
struct UnderWay {
    /// As many as its head has.
    sums: PendingReduction,
    /// [`Lengths`] and as many maxima.
    maxima: PendingReduction,
    count: (usize, usize),
    rest: (Vec<u64>, Vec<u64>),
}

impl Mpi {
    /// Joins the ranks that `launcher` started.
    pub(super) fn start(launcher: &Launcher) -> Result<Mpi, RankError> {
        let started = ::mpi::initialize_with_threading(Threading::Funneled);
        let (universe, _) = started.ok_or(RankError::AlreadyRunning)?;
        let world = universe.world();
        let (rank, size) = (world.rank() as usize, world.size() as usize);
        if !launcher.started(size) {
            let (variable, value) = (launcher.variable.to_owned(), launcher.value.clone());
            return Err(RankError::Launcher { variable, value, found: size });
        }
        abort_on_panic(rank);
        let node = world.split_shared(world.rank());
        Ok(Mpi {
            sends: RefCell::default(),
            inboxes: RefCell::default(),
            rooms: RefCell::new(vec![Room::first(); size]),
            tickets: Tickets::default(),
            under_way: RefCell::default(),
            head: Cell::new(HEAD),
            rank,
            size,
            node_rank: node.rank() as usize,
            node_size: node.size() as usize,
            world,
            _universe: universe,
            _thread: PhantomData,
        })
    }

    fn start_send(&self, dest: usize, tag: Tag, message: Vec<u8>) -> Result<(), RankError> {
        let message = within_limit(message)?;
        let mut sends = self.sends.borrow_mut();
        sends.retain_mut(|send| !send.done());
        sends.push(PendingSend::start(&self.world, dest as Rank, tag, message));
        Ok(())
    }

    fn receive_tagged(&self, source: usize, tag: Tag) -> Vec<u8> {
        let (message, status) = self.world.process_at_rank(source as Rank).matched_probe_with_tag(tag);
        let mut bytes = vec![0u8; status.count(u8::equivalent_datatype()) as usize];
        message.matched_receive_into(&mut bytes[..]);
        self.sends.borrow_mut().retain_mut(|send| !send.done());
        bytes
    }

    /// Every rank's `length`.
    fn all_lengths(&self, length: usize) -> Vec<usize> {
        let mut lengths = vec![0u64; self.size];
        self.world.all_gather_into(&(length as u64), &mut lengths[..]);
        lengths.into_iter().map(|length| length as usize).collect()
    }

    /// Appends the reduction of `rest` over all ranks to `reduced`.
    fn reduce_rest(&self, operation: Operation, rest: Vec<u64>, reduced: &mut Vec<u64>) {
        for words in rest.chunks(LONGEST_MESSAGE) {
            reduced.extend(PendingReduction::start(&self.world, operation, words.to_vec()).wait());
        }
    }
}

impl Communicator for Mpi {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn node_rank(&self) -> usize {
        self.node_rank
    }

    fn node_size(&self) -> usize {
        self.node_size
    }

    fn in_process(&self) -> bool {
        false
    }

    fn send(&self, dest: usize, message: Vec<u8>) -> Result<(), RankError> {
        check_other(self.rank, dest, self.size)?;
        let (message, after) = parts(&mut self.rooms.borrow_mut()[dest], within_limit(message)?);
        self.start_send(dest, MESSAGE, message)?;
        after.map_or(Ok(()), |message| self.start_send(dest, LONG_MESSAGE, message))
    }

    fn receive(&self, source: usize) -> Result<Vec<u8>, RankError> {
        check_other(self.rank, source, self.size)?;
        let rank = source as Rank;
        let mut inboxes = self.inboxes.borrow_mut();
        let inbox = inboxes.entry(source).or_insert_with(|| Inbox::open(&self.world, rank));
        let message = inbox.next(&self.world, rank, || self.receive_tagged(source, LONG_MESSAGE));
        self.sends.borrow_mut().retain_mut(|send| !send.done());
        Ok(message)
    }

    fn start_reduction(&self, mut sums: Vec<u64>, mut maxima: Vec<u64>) -> Result<Reduction, RankError> {
        let (count, words) = ((sums.len(), maxima.len()), self.head.get());
        let mut head = Lengths::of(&sums, &maxima).0.to_vec();
        let rest = (sums.split_off(count.0.min(words)), maxima.split_off(count.1.min(words)));
        sums.resize(words, 0);
        head.append(&mut maxima);
        head.resize(Lengths::WORDS + words, 0);
        self.under_way.borrow_mut().push_back(UnderWay {
            sums: PendingReduction::start(&self.world, Operation::Sum, sums),
            maxima: PendingReduction::start(&self.world, Operation::Maximum, head),
            count,
            rest,
        });
        Ok(self.tickets.start())
    }

    fn finish_reduction(&self, reduction: Reduction) -> Result<(Vec<u64>, Vec<u64>), RankError> {
        self.tickets.finish(reduction)?;
        let Some(under_way) = self.under_way.borrow_mut().pop_front() else { return Ok(Default::default()) };
        let (mut sums, head) = (under_way.sums.wait(), under_way.maxima.wait());
        let (lengths, maxima) = head.split_at(Lengths::WORDS);
        let mut maxima = maxima.to_vec();
        Lengths([lengths[0], lengths[1], lengths[2], lengths[3]]).check()?;
        let longest = under_way.count.0.max(under_way.count.1).min(LONGEST_HEAD);
        self.head.set(self.head.get().max(longest.next_power_of_two()));
        sums.truncate(under_way.count.0);
        maxima.truncate(under_way.count.1);
        self.reduce_rest(Operation::Sum, under_way.rest.0, &mut sums);
        self.reduce_rest(Operation::Maximum, under_way.rest.1, &mut maxima);
        Ok((sums, maxima))
    }

    /// Message by message, since together they may be longer than MPI can count.
    fn gather(&self, message: Vec<u8>) -> Result<Option<Vec<Vec<u8>>>, RankError> {
        let longest = self.all_lengths(message.len()).into_iter().max().unwrap_or(0);
        check_length(longest)?;
        if self.rank > 0 {
            self.start_send(0, GATHERED, message)?;
            return Ok(None);
        }
        let others = (1..self.size).map(|source| self.receive_tagged(source, GATHERED));
        Ok(Some(std::iter::once(message).chain(others).collect()))
    }

    fn all_gather(&self, message: Vec<u8>) -> Result<Vec<Vec<u8>>, RankError> {
        let lengths = self.all_lengths(message.len());
        check_length(lengths.iter().sum())?;
        let counts: Vec<Count> = lengths.iter().map(|&length| length as Count).collect();
        let starts = counts.iter().scan(0, |next, count| {
            let start = *next;
            *next += count;
            Some(start)
        });
        let starts: Vec<Count> = starts.collect();
        let mut all = vec![0u8; lengths.iter().sum()];
        self.world.all_gather_varcount_into(&message[..], &mut PartitionMut::new(&mut all[..], counts, starts));
        let mut rest = &all[..];
        let split = lengths.into_iter().map(|length| {
            let (message, after) = rest.split_at(length);
            rest = after;
            message.to_vec()
        });
        Ok(split.collect())
    }

    fn broadcast(&self, mut message: Vec<u8>) -> Result<Vec<u8>, RankError> {
        let root = self.world.process_at_rank(0);
        let mut length = message.len() as u64;
        root.broadcast_into(&mut length);
        check_length(length as usize)?;
        message.resize(length as usize, 0);
        // The address of an empty vector may be that of MPI_IN_PLACE, which a broadcast refuses.
        if length > 0 {
            root.broadcast_into(&mut message[..]);
        }
        Ok(message)
    }

    fn barrier(&self) -> Result<(), RankError> {
        self.world.barrier();
        Ok(())
    }

    fn fail(&self, message: &str, exit_code: i32) {
        tell(self.rank, message);
        self.world.abort(if exit_code == 0 { 1 } else { exit_code });
    }
}

fn check_length(bytes: usize) -> Result<(), RankError> {
    if bytes <= LONGEST_MESSAGE { Ok(()) } else { Err(RankError::TooLong { bytes }) }
}

/// The last words of a rank. That standard error is gone is no reason to go on.
fn tell(rank: usize, message: &str) {
    let _ = std::io::stdout().flush();
    let mut stderr = std::io::stderr().lock();
    let _ = writeln!(stderr, "rank {rank}: {message}");
    let _ = stderr.flush();
}

/// Makes a panic of any thread end all ranks, while MPI runs.
fn abort_on_panic(rank: usize) {
    let before = panic::take_hook();
    let mpi_thread = thread::current().id();
    panic::set_hook(Box::new(move |panic| {
        before(panic);
        if is_finalized() {
            return;
        }
        tell(rank, &format!("panicked: {}", panic_message(panic.payload())));
        if thread::current().id() == mpi_thread {
            SimpleCommunicator::world().abort(PANICKED);
        }
        // No other thread may call MPI: its launcher ends the others when this one dies.
        std::process::abort();
    }));
}
