//! Signals that ask a run for a checkpoint: SIGUSR1 to go on after it, SIGTERM, SIGINT and SIGHUP to stop after it.
//!
//! A handler only sets a flag; the time loop asks between intervals. A second SIGINT (Ctrl-C) ends the process at once,
//! with exit code 130. A second SIGTERM does not: launchers and batch systems each send their own. SIGHUP stays ignored where it
//! is (`nohup`). Ranks may be told apart or not at all, so they take the largest of their requests.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1};
use signal_hook::{SigId, flag, low_level};

/// What is asked of the time loop, in the order of weight.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Request {
    #[default]
    None,
    /// Write a checkpoint and go on.
    Checkpoint,
    /// Write a checkpoint and stop; for this signal, or because the time is up.
    CheckpointAndStop(Option<u8>),
}

impl Request {
    /// For a maximum over ranks.
    pub fn weight(self) -> u64 {
        match self {
            Request::None => 0,
            Request::Checkpoint => 1,
            Request::CheckpointAndStop(signal) => 2 + u64::from(signal.unwrap_or(0)),
        }
    }

    /// The request of this weight.
    pub fn of_weight(weight: u64) -> Request {
        match weight {
            0 => Request::None,
            1 => Request::Checkpoint,
            2 => Request::CheckpointAndStop(None),
            more => Request::CheckpointAndStop(Some(u8::try_from(more - 2).unwrap_or(u8::MAX))),
        }
    }
}

/// Catches the signals as long as it lives.
#[derive(Debug)]
pub struct Interrupt {
    checkpoint: Arc<AtomicBool>,
    /// The number of the signal; 0: none.
    stop: Arc<AtomicUsize>,
    handlers: Vec<SigId>,
}

impl Interrupt {
    /// # Errors
    /// If the system does not take the handlers.
    pub fn catch() -> io::Result<Interrupt> {
        let mut interrupt = Interrupt {
            checkpoint: Arc::new(AtomicBool::new(false)),
            stop: Arc::new(AtomicUsize::new(0)),
            handlers: Vec::new(),
        };
        let Interrupt { checkpoint, stop, handlers } = &mut interrupt;
        let stopping = Arc::new(AtomicBool::new(false));
        // Before the flag is set: acts on the second signal only.
        handlers.push(flag::register_conditional_shutdown(SIGINT, 128 + SIGINT, stopping.clone())?);
        for signal in [SIGINT, SIGTERM, SIGHUP] {
            if signal == SIGHUP && is_ignored(signal) {
                continue;
            }
            handlers.push(flag::register_usize(signal, stop.clone(), signal as usize)?);
            handlers.push(flag::register(signal, stopping.clone())?);
        }
        handlers.push(flag::register(SIGUSR1, checkpoint.clone())?);
        Ok(interrupt)
    }

    /// What signals have asked for since this was called last; a request to stop stays.
    pub fn take(&self) -> Request {
        let checkpoint = self.checkpoint.swap(false, Ordering::SeqCst);
        let stop = self.stop.load(Ordering::SeqCst);
        if stop > 0 {
            Request::CheckpointAndStop(u8::try_from(stop).ok())
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

/// Whether the process was started with a signal ignored. Where the system does not tell it is not.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}

/// What a signal is called.
pub fn signal_name(signal: u8) -> &'static str {
    low_level::signal_name(signal.into()).unwrap_or("a signal")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heaviest_request_of_all_ranks_counts() {
        let stop = Request::CheckpointAndStop;
        let all = [Request::None, Request::Checkpoint, stop(None), stop(Some(1)), stop(Some(15)), stop(Some(255))];
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
        assert_eq!([interrupt.take(), interrupt.take()], [Request::CheckpointAndStop(Some(15)); 2]);
        drop(interrupt);
        // A new run in the same process starts without the old one's requests.
        let again = Interrupt::catch().unwrap();
        low_level::raise(SIGINT).unwrap();
        assert_eq!(again.take(), Request::CheckpointAndStop(Some(2)));
        drop(again);
        let hung_up = Interrupt::catch().unwrap();
        low_level::raise(SIGHUP).unwrap();
        // The tests themselves may run under `nohup`.
        let expected = if is_ignored(SIGHUP) { Request::None } else { Request::CheckpointAndStop(Some(1)) };
        assert_eq!(hung_up.take(), expected);
        assert_eq!([1, 2, 15].map(signal_name), ["SIGHUP", "SIGINT", "SIGTERM"]);
    }
}
