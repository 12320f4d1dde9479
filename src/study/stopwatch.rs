//! A communicator that notes what a rank does between its calls.
//!
//! At the pace of one rank at a time nobody else runs between two calls of a rank's communicator, so that the time
//! between them is its own: its device's, the host's work, and the waits for its device. What it takes to bring
//! messages is not in it.
//!
//! A *stage* is an exchange: messages sent to some, then received. An interval of k steps has k times the stages of a
//! step, and one more in its first step, where lost collisions are counted. A *lap* goes from the first message of a
//! step to that of the next. The first step and the last, which is timed by phases, are in no lap, nor is what is done
//! once per interval: so a lap is a step like most.

use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

use crate::ranks::{Communicator, RankError, Reduction};

/// What a rank called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Call {
    /// Of so many bytes.
    Send(usize),
    Receive,
    Collective,
    /// An interval begins.
    Mark,
}

/// A call and the rank's own time before it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Event {
    pub own: Duration,
    pub call: Call,
}

pub struct Stopwatch<'a> {
    inner: &'a dyn Communicator,
    since: Cell<Instant>,
    events: RefCell<Vec<Event>>,
}

impl<'a> Stopwatch<'a> {
    pub fn new(inner: &'a dyn Communicator) -> Stopwatch<'a> {
        Stopwatch { inner, since: Cell::new(Instant::now()), events: RefCell::default() }
    }

    pub fn mark(&self) {
        self.note(Call::Mark);
        self.since.set(Instant::now());
    }

    pub fn events(self) -> Vec<Event> {
        self.events.into_inner()
    }

    fn note(&self, call: Call) {
        self.events.borrow_mut().push(Event { own: self.since.get().elapsed(), call });
    }

    fn timed<T>(&self, call: Call, act: impl FnOnce() -> T) -> T {
        self.note(call);
        let result = act();
        self.since.set(Instant::now());
        result
    }
}

impl Communicator for Stopwatch<'_> {
    fn rank(&self) -> usize {
        self.inner.rank()
    }

    fn size(&self) -> usize {
        self.inner.size()
    }

    fn node_rank(&self) -> usize {
        self.inner.node_rank()
    }

    fn node_size(&self) -> usize {
        self.inner.node_size()
    }

    fn in_process(&self) -> bool {
        self.inner.in_process()
    }

    fn send(&self, dest: usize, message: Vec<u8>) -> Result<(), RankError> {
        self.timed(Call::Send(message.len()), || self.inner.send(dest, message))
    }

    fn receive(&self, source: usize) -> Result<Vec<u8>, RankError> {
        self.timed(Call::Receive, || self.inner.receive(source))
    }

    fn start_reduction(&self, sums: Vec<u64>, maxima: Vec<u64>) -> Result<Reduction, RankError> {
        self.timed(Call::Collective, || self.inner.start_reduction(sums, maxima))
    }

    fn finish_reduction(&self, reduction: Reduction) -> Result<(Vec<u64>, Vec<u64>), RankError> {
        self.timed(Call::Collective, || self.inner.finish_reduction(reduction))
    }

    fn gather(&self, message: Vec<u8>) -> Result<Option<Vec<Vec<u8>>>, RankError> {
        self.timed(Call::Collective, || self.inner.gather(message))
    }

    fn all_gather(&self, message: Vec<u8>) -> Result<Vec<Vec<u8>>, RankError> {
        self.timed(Call::Collective, || self.inner.all_gather(message))
    }

    fn broadcast(&self, message: Vec<u8>) -> Result<Vec<u8>, RankError> {
        self.timed(Call::Collective, || self.inner.broadcast(message))
    }

    fn barrier(&self) -> Result<(), RankError> {
        self.timed(Call::Collective, || self.inner.barrier())
    }

    fn fail(&self, message: &str, exit_code: i32) {
        self.inner.fail(message, exit_code);
    }
}

/// A rank's step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Lap {
    /// Its own time, s.
    pub seconds: f64,
    pub stages: f64,
    /// Sent, and their bytes.
    pub messages: f64,
    pub bytes: f64,
}

/// The laps of each interval that the marks begin, of `steps` steps each; none of an interval that was run again. A
/// rank alone has no stages: one lap, the mean of the interval's steps.
pub fn laps(events: &[Event], steps: usize) -> Vec<Vec<Lap>> {
    let marks = events.iter().enumerate().filter(|(_, event)| event.call == Call::Mark).map(|(at, _)| at);
    let mut starts: Vec<usize> = marks.collect();
    starts.push(events.len());
    // With the mark that ends it, which knows the time since the last call.
    let ends = |next: usize| (next + 1).min(events.len());
    starts.windows(2).map(|bounds| laps_of(&events[bounds[0] + 1..ends(bounds[1])], steps)).collect()
}

fn laps_of(interval: &[Event], steps: usize) -> Vec<Lap> {
    let exchanges = |event: &&Event| matches!(event.call, Call::Send(_) | Call::Receive);
    let runs: Vec<&[Event]> = interval
        .split(|event| event.call == Call::Collective)
        .filter(|run| run.iter().any(|event| exchanges(&event)))
        .collect();
    match runs[..] {
        [] => {
            let seconds = interval.iter().map(|event| event.own.as_secs_f64()).sum::<f64>() / steps as f64;
            vec![Lap { seconds, ..Lap::default() }]
        }
        [run] => laps_between(run, steps),
        // What hits gave elastic fabric is summed between steps.
        _ if runs.len() == steps => laps_between(&without_sums(interval), steps),
        _ => Vec::new(),
    }
}

/// The exchanges of an interval; what the rank did before a collective counts to what follows it.
fn without_sums(interval: &[Event]) -> Vec<Event> {
    let mut left = Vec::with_capacity(interval.len());
    let mut before = Duration::ZERO;
    for event in interval {
        match event.call {
            Call::Collective => before += event.own,
            call => left.push(Event { own: std::mem::take(&mut before) + event.own, call }),
        }
    }
    left
}

fn laps_between(run: &[Event], steps: usize) -> Vec<Lap> {
    let sends = |at: usize| matches!(run[at].call, Call::Send(_));
    let stages: Vec<usize> = (0..run.len()).filter(|&at| sends(at) && (at == 0 || !sends(at - 1))).collect();
    let (of_step, more) = (stages.len() / steps, stages.len() % steps);
    if of_step == 0 || more > 1 {
        return Vec::new();
    }
    let firsts: Vec<usize> = stages.iter().copied().skip(of_step + more).step_by(of_step).collect();
    let lap = |bounds: &[usize]| {
        let sent = run[bounds[0]..bounds[1]].iter().filter_map(|event| match event.call {
            Call::Send(bytes) => Some(bytes),
            _ => None,
        });
        Lap {
            seconds: run[bounds[0] + 1..=bounds[1]].iter().map(|event| event.own.as_secs_f64()).sum(),
            stages: of_step as f64,
            messages: sent.clone().count() as f64,
            bytes: sent.sum::<usize>() as f64,
        }
    };
    firsts.windows(2).map(lap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::{Pace, in_process};

    fn event(milliseconds: u64, call: Call) -> Event {
        Event { own: Duration::from_millis(milliseconds), call }
    }

    /// Three steps of two stages, and one more in the first, with two peers; the numbers are powers of two, so that a
    /// sum tells its terms.
    fn interval(stages: u64) -> Vec<Event> {
        let mut events = vec![event(1 << 12, Call::Mark), event(1 << 11, Call::Collective)];
        for k in 0..stages {
            let bytes = 10 * (k as usize + 1);
            events.push(event(1 << k, Call::Send(bytes)));
            events.push(event(0, Call::Send(bytes + 1)));
            events.push(event(0, Call::Receive));
            events.push(event(0, Call::Receive));
        }
        events.push(event(1 << 10, Call::Collective));
        events
    }

    /// Of three steps the one in the middle.
    #[test]
    fn a_lap_goes_from_a_steps_first_message_to_the_next_steps() {
        let expected = Lap { seconds: 0.016 + 0.032, stages: 2.0, messages: 4.0, bytes: 40.0 + 41.0 + 50.0 + 51.0 };
        assert_eq!(laps(&interval(7), 3), [vec![expected]]);
        // Without the counting of lost collisions.
        let expected = Lap { seconds: 0.008 + 0.016, stages: 2.0, messages: 4.0, bytes: 30.0 + 31.0 + 40.0 + 41.0 };
        assert_eq!(laps(&interval(6), 3), [vec![expected]]);
        assert_eq!(laps(&interval(9), 4)[0].len(), 2);
    }

    #[test]
    fn what_is_no_whole_interval_of_steps_gives_no_laps() {
        assert_eq!(laps(&interval(8), 3), [vec![]]);
        assert_eq!(laps(&interval(2), 3), [vec![]]);
        // Run again: two runs of exchanges.
        let again = [interval(7), interval(7)[1..].to_vec()].concat();
        assert_eq!(laps(&again, 3), [vec![]]);
        assert_eq!(laps(&[interval(7), interval(7)].concat(), 3).len(), 2);
    }

    /// The sum between two steps is of the step before it, as is what was done before it.
    #[test]
    fn sums_between_steps_do_not_end_an_interval() {
        let step = |k: u64| {
            let exchange = [event(1 << k, Call::Send(10)), event(0, Call::Receive)];
            [&exchange[..], &exchange[..], &[event(1 << (k + 6), Call::Collective)]].concat()
        };
        let events = [vec![event(0, Call::Mark)], step(0), step(1), step(2)].concat();
        let expected = Lap { seconds: 0.002 + 0.128 + 0.004, stages: 2.0, messages: 2.0, bytes: 20.0 };
        assert_eq!(laps(&events, 3), [vec![expected]]);
    }

    #[test]
    fn a_rank_alone_has_the_mean_of_its_steps() {
        let events = [event(5, Call::Mark), event(60, Call::Collective), event(4, Call::Mark)];
        assert_eq!(laps(&events, 32)[0], [Lap { seconds: 0.002, ..Lap::default() }]);
    }

    /// What a rank waits for others is not its own.
    #[test]
    fn waiting_for_others_is_not_counted() {
        let own = in_process(2, Pace::OneAtATime, |comm: &dyn Communicator| {
            let watch = Stopwatch::new(comm);
            watch.mark();
            if watch.rank() == 0 {
                watch.receive(1).unwrap();
            } else {
                std::thread::sleep(Duration::from_millis(200));
                watch.send(0, vec![1, 2, 3]).unwrap();
            }
            watch.barrier().unwrap();
            watch.events()
        })
        .unwrap();
        let total = |rank: usize| own[rank].iter().map(|event| event.own).sum::<Duration>();
        assert!(total(1) >= Duration::from_millis(200) && total(0) < total(1), "{own:?}");
        assert_eq!(
            own[1].iter().map(|event| event.call).collect::<Vec<_>>(),
            [Call::Mark, Call::Send(3), Call::Collective]
        );
    }
}
