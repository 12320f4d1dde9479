//! Ranks as threads of one process.
//!
//! One lock guards mailboxes, collective calls and the schedule; every rank has its own condition to wait on, so
//! that what happens wakes only those that it lets go on. Since the schedule knows who waits, ranks that all
//! wait for each other are an error here and not a hang: unless they wait by other means than their
//! communicator, which they must not.

use super::collectives::{Collectives, Offer, Outcome};
use super::communicator::{check_other, panic_message, within_limit};
use super::reduction::{Reduction, Tickets};
use super::schedule::{Pace, Schedule, Wait};
use super::{Communicator, RankError};
use std::cell::RefCell;
use std::collections::{HashMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, Builder};

/// Bytes of stack of each thread, as much as the kernels' compiler may want. Only what is used is taken.
const STACK: usize = 8 << 20;

/// Runs `body` as each of `size` ranks, and returns what they return, by rank. A panic of one ends all, and is an
/// error that names it.
pub fn in_process<R: Send>(
    size: usize,
    pace: Pace,
    body: impl Fn(&dyn Communicator) -> R + Sync,
) -> Result<Vec<R>, RankError> {
    let world = World::new(size, pace);
    let returned = thread::scope(|scope| {
        let mut threads = Vec::with_capacity(size);
        for rank in 0..size {
            let (world, body) = (&world, &body);
            let thread = Builder::new().name(format!("rank {rank}")).stack_size(STACK);
            match thread.spawn_scoped(scope, move || world.run(rank, body)) {
                Ok(thread) => threads.push(thread),
                Err(error) => {
                    world.end_all(&mut world.lock(), RankError::Thread { rank, reason: error.to_string() });
                    break;
                }
            }
        }
        threads.into_iter().map(|thread| thread.join().unwrap_or_default()).collect::<Vec<Option<R>>>()
    });
    let complete: Option<Vec<R>> = returned.into_iter().collect();
    match (complete, world.lock().failure.take()) {
        (Some(results), _) if results.len() == size => Ok(results),
        (_, Some(failure)) => Err(failure),
        (_, None) => Err(RankError::Thread { rank: 0, reason: "it has ended without a result".to_owned() }),
    }
}

struct World {
    state: Mutex<State>,
    wakes: Vec<Condvar>,
}

struct State {
    schedule: Schedule,
    /// By destination, then by source.
    mail: Vec<HashMap<usize, VecDeque<Vec<u8>>>>,
    collectives: Collectives,
    failure: Option<RankError>,
}

impl State {
    fn check(&self) -> Result<(), RankError> {
        self.failure.as_ref().map_or(Ok(()), |failure| Err(failure.clone()))
    }
}

impl World {
    fn new(size: usize, pace: Pace) -> World {
        World {
            state: Mutex::new(State {
                schedule: Schedule::new(size, pace),
                mail: (0..size).map(|_| HashMap::new()).collect(),
                collectives: Collectives::new(size),
                failure: None,
            }),
            wakes: (0..size).map(|_| Condvar::new()).collect(),
        }
    }

    /// The lock guards nothing that a panic could leave half done.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn run<R>(&self, rank: usize, body: &(impl Fn(&dyn Communicator) -> R + Sync)) -> Option<R> {
        drop(self.until_its_turn(self.lock(), rank));
        let own = InProcess { world: self, rank, tickets: Tickets::default(), under_way: RefCell::default() };
        let result = catch_unwind(AssertUnwindSafe(|| body(&own)));
        let mut state = self.lock();
        if let Err(panic) = &result {
            let message = format!("panicked: {}", panic_message(panic.as_ref()));
            self.end_all(&mut state, RankError::Failed { rank, message });
        }
        let next = state.schedule.end(rank);
        self.end_if_stuck(&mut state);
        drop(state);
        self.wake(next);
        result.ok()
    }

    fn wake(&self, ranks: impl IntoIterator<Item = usize>) {
        ranks.into_iter().for_each(|rank| self.wakes[rank].notify_one());
    }

    /// Waits until the rank may run, or something has failed.
    fn until_its_turn<'a>(&'a self, mut state: MutexGuard<'a, State>, rank: usize) -> MutexGuard<'a, State> {
        while state.failure.is_none() && !state.schedule.may_run(rank) {
            state = self.wakes[rank].wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state
    }

    /// Lets others run until someone has brought what the rank waits for.
    fn block<'a>(
        &'a self,
        mut state: MutexGuard<'a, State>,
        rank: usize,
        wait: Wait,
    ) -> Result<MutexGuard<'a, State>, RankError> {
        let next = state.schedule.wait(rank, wait);
        self.wake(next);
        self.end_if_stuck(&mut state);
        let state = self.until_its_turn(state, rank);
        state.check()?;
        Ok(state)
    }

    fn end_if_stuck(&self, state: &mut State) {
        if let Some(waits) = state.schedule.stuck() {
            self.end_all(state, RankError::Stuck { waits });
        }
    }

    /// The first failure is kept; everyone hears of it.
    fn end_all(&self, state: &mut State, failure: RankError) {
        if state.failure.is_none() {
            state.failure = Some(failure);
            self.wakes.iter().for_each(Condvar::notify_one);
        }
    }

    /// Joins the rank's next collective call, and lets those go on whom that completes.
    fn join(&self, rank: usize, offer: Offer) -> Result<u64, RankError> {
        let name = offer.name();
        let mut state = self.lock();
        state.check()?;
        let number = match state.collectives.join(rank, offer) {
            Ok(number) => number,
            Err(error) => {
                self.end_all(&mut state, error.clone());
                return Err(error);
            }
        };
        if state.collectives.complete(number) {
            let wait = Wait::Collective { number, name };
            let waiting = (0..self.wakes.len()).filter(|&rank| state.schedule.waits_for(rank, wait));
            let waiting: Vec<usize> = waiting.collect();
            let able: Vec<usize> = waiting.into_iter().filter_map(|rank| state.schedule.go_on(rank)).collect();
            drop(state);
            self.wake(able);
        }
        Ok(number)
    }

    /// The outcome of a collective call that the rank has joined.
    fn leave(&self, rank: usize, number: u64, name: &'static str) -> Result<Arc<Outcome>, RankError> {
        let mut state = self.lock();
        state.check()?;
        if !state.collectives.complete(number) {
            state = self.block(state, rank, Wait::Collective { number, name })?;
        }
        state.collectives.leave(rank, number)
    }

    fn meet(&self, rank: usize, offer: Offer) -> Result<Arc<Outcome>, RankError> {
        let name = offer.name();
        let number = self.join(rank, offer)?;
        self.leave(rank, number, name)
    }
}

/// One of the threads.
struct InProcess<'a> {
    world: &'a World,
    rank: usize,
    tickets: Tickets,
    /// The numbers, as collective calls, of the reductions under way.
    under_way: RefCell<VecDeque<u64>>,
}

impl Communicator for InProcess<'_> {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.world.wakes.len()
    }

    fn node_rank(&self) -> usize {
        self.rank
    }

    fn node_size(&self) -> usize {
        self.size()
    }

    fn in_process(&self) -> bool {
        true
    }

    fn send(&self, dest: usize, message: Vec<u8>) -> Result<(), RankError> {
        check_other(self.rank, dest, self.size())?;
        let message = within_limit(message)?;
        let mut state = self.world.lock();
        state.check()?;
        state.mail[dest].entry(self.rank).or_default().push_back(message);
        if state.schedule.waits_for(dest, Wait::Message { source: self.rank }) {
            let able = state.schedule.go_on(dest);
            drop(state);
            self.world.wake(able);
        }
        Ok(())
    }

    fn receive(&self, source: usize) -> Result<Vec<u8>, RankError> {
        check_other(self.rank, source, self.size())?;
        let mut state = self.world.lock();
        state.check()?;
        loop {
            if let Some(message) = state.mail[self.rank].get_mut(&source).and_then(VecDeque::pop_front) {
                return Ok(message);
            }
            state = self.world.block(state, self.rank, Wait::Message { source })?;
        }
    }

    fn start_reduction(&self, sums: Vec<u64>, maxima: Vec<u64>) -> Result<Reduction, RankError> {
        let number = self.world.join(self.rank, Offer::Reduction { sums, maxima })?;
        self.under_way.borrow_mut().push_back(number);
        Ok(self.tickets.start())
    }

    fn finish_reduction(&self, reduction: Reduction) -> Result<(Vec<u64>, Vec<u64>), RankError> {
        self.tickets.finish(reduction)?;
        let number = self.under_way.borrow_mut().pop_front().unwrap_or_default();
        let outcome = self.world.leave(self.rank, number, Offer::REDUCTION)?;
        Ok((outcome.sums.clone(), outcome.maxima.clone()))
    }

    fn gather(&self, message: Vec<u8>) -> Result<Option<Vec<Vec<u8>>>, RankError> {
        let outcome = self.world.meet(self.rank, Offer::Gather(message))?;
        Ok((self.rank == 0).then(|| owned(outcome)))
    }

    fn all_gather(&self, message: Vec<u8>) -> Result<Vec<Vec<u8>>, RankError> {
        Ok(owned(self.world.meet(self.rank, Offer::AllGather(message))?))
    }

    fn broadcast(&self, message: Vec<u8>) -> Result<Vec<u8>, RankError> {
        Ok(owned(self.world.meet(self.rank, Offer::Broadcast(message))?).pop().unwrap_or_default())
    }

    fn barrier(&self) -> Result<(), RankError> {
        self.world.meet(self.rank, Offer::Barrier).map(drop)
    }

    fn fail(&self, message: &str, _exit_code: i32) {
        let failure = RankError::Failed { rank: self.rank, message: message.to_owned() };
        self.world.end_all(&mut self.world.lock(), failure);
    }
}

/// The messages, copied if another rank has yet to look at them.
fn owned(outcome: Arc<Outcome>) -> Vec<Vec<u8>> {
    Arc::try_unwrap(outcome).map_or_else(|shared| shared.messages.clone(), |sole| sole.messages)
}
