//! One rank in one process.

use super::communicator::{check_other, within_limit};
use super::reduction::{Reduction, Tickets};
use super::{Communicator, RankError};
use std::cell::{OnceCell, RefCell};
use std::collections::VecDeque;

/// The only rank.
#[derive(Debug, Default)]
pub struct Solo {
    tickets: Tickets,
    under_way: RefCell<VecDeque<(Vec<u64>, Vec<u64>)>>,
    failure: OnceCell<RankError>,
}

impl Solo {
    pub fn new() -> Solo {
        Solo::default()
    }

    fn check(&self) -> Result<(), RankError> {
        self.failure.get().map_or(Ok(()), |failure| Err(failure.clone()))
    }
}

impl Communicator for Solo {
    fn rank(&self) -> usize {
        0
    }

    fn size(&self) -> usize {
        1
    }

    fn node_rank(&self) -> usize {
        0
    }

    fn node_size(&self) -> usize {
        1
    }

    fn in_process(&self) -> bool {
        false
    }

    fn send(&self, dest: usize, _message: Vec<u8>) -> Result<(), RankError> {
        self.check()?;
        check_other(0, dest, 1)
    }

    fn receive(&self, source: usize) -> Result<Vec<u8>, RankError> {
        self.check()?;
        check_other(0, source, 1).map(|()| Vec::new())
    }

    fn start_reduction(&self, sums: Vec<u64>, maxima: Vec<u64>) -> Result<Reduction, RankError> {
        self.check()?;
        self.under_way.borrow_mut().push_back((sums, maxima));
        Ok(self.tickets.start())
    }

    fn finish_reduction(&self, reduction: Reduction) -> Result<(Vec<u64>, Vec<u64>), RankError> {
        self.check()?;
        self.tickets.finish(reduction)?;
        Ok(self.under_way.borrow_mut().pop_front().unwrap_or_default())
    }

    fn gather(&self, message: Vec<u8>) -> Result<Option<Vec<Vec<u8>>>, RankError> {
        self.all_gather(message).map(Some)
    }

    fn all_gather(&self, message: Vec<u8>) -> Result<Vec<Vec<u8>>, RankError> {
        self.check()?;
        Ok(vec![within_limit(message)?])
    }

    fn broadcast(&self, message: Vec<u8>) -> Result<Vec<u8>, RankError> {
        self.check()?;
        within_limit(message)
    }

    fn barrier(&self) -> Result<(), RankError> {
        self.check()
    }

    fn fail(&self, message: &str, _exit_code: i32) {
        self.failure.get_or_init(|| RankError::Failed { rank: 0, message: message.to_owned() });
    }
}
