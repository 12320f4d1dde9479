//! Signals that ask a run for a checkpoint: SIGUSR1 to go on after it, SIGTERM and SIGINT to stop after it.
//!
//! A handler only sets a flag; the time loop asks between intervals. A second SIGINT (Ctrl-C) ends the process at once,
//! with exit code 130. A second SIGTERM does not: launchers and batch systems each send their own. Ranks may be told
//! apart or not at all, so they take the largest of their requests.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM, SIGUSR1};
use signal_hook::{SigId, flag, low_level};

/// What is asked of the time loop, in the order of weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Request {
    #[default]
    None,
    /// Write a checkpoint and go on.
    Checkpoint,
    /// Write a checkpoint and stop.
    CheckpointAndStop,
}

impl Request {
    /// For a maximum over ranks.
    pub fn weight(self) -> u64 {
        self as u64
    }

    /// The request of this weight; whatever is heavier than all is the heaviest.
    pub fn of_weight(weight: u64) -> Request {
        match weight {
            0 => Request::None,
            1 => Request::Checkpoint,
            _ => Request::CheckpointAndStop,
        }
    }
}

/// Catches the signals as long as it lives.
#[derive(Debug)]
pub struct Interrupt {
    checkpoint: Arc<AtomicBool>,
    stop: Arc<AtomicBool>,
    handlers: Vec<SigId>,
}

impl Interrupt {
    /// # Errors
    /// If the system does not take the handlers.
    pub fn catch() -> io::Result<Interrupt> {
        let mut interrupt = Interrupt {
            checkpoint: Arc::new(AtomicBool::new(false)),
            stop: Arc::new(AtomicBool::new(false)),
            handlers: Vec::new(),
        };
        let Interrupt { checkpoint, stop, handlers } = &mut interrupt;
        // Before the flag is set: acts on the second signal only.
        handlers.push(flag::register_conditional_shutdown(SIGINT, 128 + SIGINT, stop.clone())?);
        handlers.push(flag::register(SIGINT, stop.clone())?);
        handlers.push(flag::register(SIGTERM, stop.clone())?);
        handlers.push(flag::register(SIGUSR1, checkpoint.clone())?);
        Ok(interrupt)
    }

    /// What signals have asked for since this was called last; a request to stop stays.
    pub fn take(&self) -> Request {
        let checkpoint = self.checkpoint.swap(false, Ordering::SeqCst);
        if self.stop.load(Ordering::SeqCst) {
            Request::CheckpointAndStop
        } else if checkpoint {
            Request::Checkpoint
        } else {
            Request::None
        }
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        for handler in self.handlers.drain(..) {
            low_level::unregister(handler);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heaviest_request_of_all_ranks_counts() {
        let all = [Request::None, Request::Checkpoint, Request::CheckpointAndStop];
        for a in all {
            assert_eq!(Request::of_weight(a.weight()), a);
            for b in all {
                assert_eq!(Request::of_weight(a.weight().max(b.weight())), a.max(b));
            }
        }
    }

    /// One test, because signals are the process's: each asks for what it should, once or for good.
    #[test]
    fn signals_become_requests() {
        let interrupt = Interrupt::catch().unwrap();
        assert_eq!(interrupt.take(), Request::None);
        low_level::raise(SIGUSR1).unwrap();
        low_level::raise(SIGUSR1).unwrap();
        assert_eq!([interrupt.take(), interrupt.take()], [Request::Checkpoint, Request::None]);
        low_level::raise(SIGUSR1).unwrap();
        low_level::raise(SIGTERM).unwrap();
        low_level::raise(SIGTERM).unwrap();
        assert_eq!([interrupt.take(), interrupt.take()], [Request::CheckpointAndStop; 2]);
        drop(interrupt);
        // A new run in the same process starts without the old one's requests.
        let again = Interrupt::catch().unwrap();
        low_level::raise(SIGINT).unwrap();
        assert_eq!(again.take(), Request::CheckpointAndStop);
    }
}
