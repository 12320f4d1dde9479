//! Collective calls among the threads of one process.
//!
//! The k-th collective call of each rank belongs to the k-th of every other. A meeting lasts from the first
//! rank's arrival until the last has its result.

use super::reduction::Lengths;
use super::{LONGEST_MESSAGE, RankError};
use std::collections::VecDeque;
use std::sync::Arc;

/// What a rank brings to a collective call.
pub(super) enum Offer {
    Reduction { sums: Vec<u64>, maxima: Vec<u64> },
    Gather(Vec<u8>),
    AllGather(Vec<u8>),
    Broadcast(Vec<u8>),
    Barrier,
}

impl Offer {
    pub(super) const REDUCTION: &str = "a reduction";
    const GATHER: &str = "gather";
    const ALL_GATHER: &str = "all_gather";

    pub(super) fn name(&self) -> &'static str {
        match self {
            Offer::Reduction { .. } => Offer::REDUCTION,
            Offer::Gather(_) => Offer::GATHER,
            Offer::AllGather(_) => Offer::ALL_GATHER,
            Offer::Broadcast(_) => "broadcast",
            Offer::Barrier => "barrier",
        }
    }
}

/// What comes of it, for all ranks.
#[derive(Debug, Default)]
pub(super) struct Outcome {
    pub(super) sums: Vec<u64>,
    pub(super) maxima: Vec<u64>,
    /// By rank; of a broadcast only rank 0's.
    pub(super) messages: Vec<Vec<u8>>,
}

struct Meeting {
    name: &'static str,
    arrived: usize,
    left: usize,
    lengths: Option<Lengths>,
    outcome: Arc<Outcome>,
    error: Option<RankError>,
}

pub(super) struct Collectives {
    size: usize,
    /// How many calls each rank has made.
    calls: Vec<u64>,
    /// Those that not all ranks have left, from number `first`.
    meetings: VecDeque<Meeting>,
    first: u64,
}

impl Collectives {
    pub(super) fn new(size: usize) -> Collectives {
        Collectives { size, calls: vec![0; size], meetings: VecDeque::new(), first: 0 }
    }

    /// The rank's next collective call. Returns its number.
    pub(super) fn join(&mut self, rank: usize, offer: Offer) -> Result<u64, RankError> {
        let number = self.calls[rank];
        self.calls[rank] += 1;
        let at = (number - self.first) as usize;
        if at == self.meetings.len() {
            self.meetings.push_back(Meeting::new(offer.name()));
        }
        let meeting = &mut self.meetings[at];
        if meeting.name != offer.name() {
            return Err(RankError::Sequence { rank, found: offer.name(), expected: meeting.name });
        }
        meeting.arrive(rank, self.size, offer);
        Ok(number)
    }

    /// Whether all ranks have joined.
    pub(super) fn complete(&self, number: u64) -> bool {
        self.meetings[(number - self.first) as usize].arrived == self.size
    }

    /// A rank takes its result of a complete call.
    pub(super) fn leave(&mut self, rank: usize, number: u64) -> Result<Arc<Outcome>, RankError> {
        let meeting = &mut self.meetings[(number - self.first) as usize];
        meeting.left += 1;
        let result = match &meeting.error {
            Some(error) => Err(error.clone()),
            // Only rank 0 wants what was gathered: it owns it.
            None if meeting.name == Offer::GATHER && rank != 0 => Ok(Arc::default()),
            None if meeting.name == Offer::GATHER || meeting.left == self.size => {
                Ok(std::mem::take(&mut meeting.outcome))
            }
            None => Ok(Arc::clone(&meeting.outcome)),
        };
        while self.meetings.front().is_some_and(|meeting| meeting.left == self.size) {
            self.meetings.pop_front();
            self.first += 1;
        }
        result
    }
}

impl Meeting {
    fn new(name: &'static str) -> Meeting {
        Meeting { name, arrived: 0, left: 0, lengths: None, outcome: Arc::default(), error: None }
    }

    fn arrive(&mut self, rank: usize, size: usize, offer: Offer) {
        self.arrived += 1;
        // Nobody has a share of the outcome before all have arrived.
        let Some(outcome) = Arc::get_mut(&mut self.outcome) else { return };
        match offer {
            Offer::Reduction { sums, maxima } => {
                let own = Lengths::of(&sums, &maxima);
                match &mut self.lengths {
                    None => {
                        self.lengths = Some(own);
                        (outcome.sums, outcome.maxima) = (sums, maxima);
                    }
                    Some(lengths) => {
                        lengths.join(own);
                        self.error = lengths.check().err();
                        outcome.sums.iter_mut().zip(sums).for_each(|(sum, value)| *sum = sum.wrapping_add(value));
                        outcome.maxima.iter_mut().zip(maxima).for_each(|(most, value)| *most = value.max(*most));
                    }
                }
            }
            Offer::Gather(message) | Offer::AllGather(message) => {
                outcome.messages.resize_with(size, Vec::new);
                outcome.messages[rank] = message;
                if self.arrived == size {
                    self.error = too_long(self.name, &outcome.messages);
                }
            }
            Offer::Broadcast(message) if rank == 0 => {
                outcome.messages = vec![message];
                self.error = too_long(self.name, &outcome.messages);
            }
            Offer::Broadcast(_) | Offer::Barrier => {}
        }
    }
}

/// An `all_gather` is limited in sum, the others by message.
fn too_long(name: &str, messages: &[Vec<u8>]) -> Option<RankError> {
    let lengths = messages.iter().map(Vec::len);
    let bytes = if name == Offer::ALL_GATHER { lengths.sum() } else { lengths.max().unwrap_or(0) };
    (bytes > LONGEST_MESSAGE).then_some(RankError::TooLong { bytes })
}
