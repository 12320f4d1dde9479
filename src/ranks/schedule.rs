//! Which of the threads of one process may run.
//!
//! A rank runs, waits for something that another rank will bring, or has ended. Whoever brings it lets exactly
//! that rank go on. At the pace [`Pace::OneAtATime`] a baton goes from a rank that waits or ends to the one that
//! has been able to go on for the longest time, first of all rank 0: so the order is the same in every run.

use std::collections::VecDeque;

/// How the ranks of one process take turns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// Each runs when it can.
    Together,
    /// One at a time, handing over only where it must wait within a call of its communicator: the time between
    /// two calls is the rank's own.
    OneAtATime,
}

/// What a rank waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wait {
    Message {
        source: usize,
    },
    /// The collective call of this number, in each rank's own count.
    Collective {
        number: u64,
        name: &'static str,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Activity {
    Running,
    Waiting(Wait),
    Ended,
}

#[derive(Debug)]
pub(super) struct Schedule {
    pace: Pace,
    activity: Vec<Activity>,
    running: usize,
    ended: usize,
    /// One at a time: who has the baton, and who can go on once he has it.
    holder: Option<usize>,
    ready: VecDeque<usize>,
}

impl Schedule {
    pub(super) fn new(size: usize, pace: Pace) -> Schedule {
        let mut ready = VecDeque::new();
        if pace == Pace::OneAtATime {
            ready.extend(0..size);
        }
        let holder = ready.pop_front();
        Schedule { pace, activity: vec![Activity::Running; size], running: size, ended: 0, holder, ready }
    }

    pub(super) fn may_run(&self, rank: usize) -> bool {
        self.activity[rank] == Activity::Running && (self.pace == Pace::Together || self.holder == Some(rank))
    }

    pub(super) fn waits_for(&self, rank: usize, wait: Wait) -> bool {
        self.activity[rank] == Activity::Waiting(wait)
    }

    /// A running rank waits. Returns whom to wake.
    pub(super) fn wait(&mut self, rank: usize, wait: Wait) -> Option<usize> {
        self.activity[rank] = Activity::Waiting(wait);
        self.running -= 1;
        self.hand_over(rank)
    }

    /// A running rank ends. Returns whom to wake.
    pub(super) fn end(&mut self, rank: usize) -> Option<usize> {
        if self.activity[rank] == Activity::Running {
            self.running -= 1;
        }
        self.activity[rank] = Activity::Ended;
        self.ended += 1;
        self.hand_over(rank)
    }

    /// What the rank waits for has come. Returns whom to wake.
    pub(super) fn go_on(&mut self, rank: usize) -> Option<usize> {
        self.activity[rank] = Activity::Running;
        self.running += 1;
        match self.pace {
            Pace::Together => Some(rank),
            Pace::OneAtATime => {
                self.ready.push_back(rank);
                None
            }
        }
    }

    fn hand_over(&mut self, rank: usize) -> Option<usize> {
        if self.holder == Some(rank) {
            self.holder = self.ready.pop_front();
            return self.holder;
        }
        None
    }

    /// If all that have not ended wait: what the first few wait for.
    pub(super) fn stuck(&self) -> Option<String> {
        const SHOWN: usize = 4;
        let size = self.activity.len();
        if self.running > 0 || self.ended == size {
            return None;
        }
        let mut waits = Vec::new();
        for (rank, activity) in self.activity.iter().enumerate() {
            if let Activity::Waiting(wait) = activity {
                waits.push(match *wait {
                    Wait::Message { source } if self.activity[source] == Activity::Ended => {
                        format!("rank {rank} for a message from rank {source}, which has ended")
                    }
                    Wait::Message { source } => format!("rank {rank} for a message from rank {source}"),
                    Wait::Collective { name, .. } => format!("rank {rank} for others to call {name}"),
                });
            }
        }
        if waits.len() > SHOWN {
            let more = waits.len() - SHOWN;
            waits.truncate(SHOWN);
            waits.push(format!("and {more} more"));
        }
        Some(waits.join("; "))
    }
}
