//! Several cases at a time, each worker with its own device: most are so small that host and device wait for each other.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::thread;
use std::time::Instant;

use crate::gpu::{Device, GpuError};
use crate::study::StudyError;

use super::{Case, Effort, Findings};

/// Runs the cases on `workers` devices, and hands what they find, or why they could not run, to `done` in the order of
/// the cases. Every other worker takes them from the end, where the long ones are, so that all end together.
///
/// # Errors
/// Of `done`; no other case is started then.
pub fn run_cases<'a, E>(
    cases: &[&'a Case],
    effort: Effort,
    workers: usize,
    open: impl Fn() -> Result<Device, GpuError> + Sync,
    mut done: impl FnMut(&'a Case, Result<Findings, StudyError>) -> Result<(), E>,
) -> Result<(), E> {
    let (left, stop) = (Mutex::new(0..cases.len()), AtomicBool::new(false));
    let take = |from_end: bool| {
        let mut left = left.lock().unwrap_or_else(PoisonError::into_inner);
        if from_end { left.next_back() } else { left.next() }
    };
    let work = |from_end, sender: mpsc::Sender<(usize, Result<Findings, StudyError>)>| {
        let _guard = StopsOnPanic(&stop);
        let mut device = None;
        while !stop.load(Ordering::Relaxed) {
            let Some(index) = take(from_end) else { return };
            let case = cases[index];
            let start = Instant::now();
            let opened = device.take().map_or_else(&open, Ok);
            let found = opened.map_err(StudyError::from).and_then(|opened| {
                let found = case.run(&opened, effort)?;
                // One on which a case failed may be lost.
                device = Some(opened);
                Ok(found)
            });
            tracing::debug!("{}: {:.1} s", case.name, start.elapsed().as_secs_f64());
            if sender.send((index, found)).is_err() {
                return;
            }
        }
    };
    thread::scope(|scope| {
        let (sender, receiver) = mpsc::channel();
        for worker in 0..workers.clamp(1, cases.len().max(1)) {
            let (sender, work) = (sender.clone(), &work);
            scope.spawn(move || work(worker % 2 == 1, sender));
        }
        drop(sender);
        let mut found = BTreeMap::new();
        let mut expected = 0;
        for (index, findings) in receiver {
            found.insert(index, findings);
            while let Some(findings) = found.remove(&expected) {
                let handed = done(cases[expected], findings);
                if handed.is_err() {
                    stop.store(true, Ordering::Relaxed);
                    return handed;
                }
                expected += 1;
            }
        }
        Ok(())
    })
}

/// No worker goes on when another panics.
struct StopsOnPanic<'a>(&'a AtomicBool);

impl Drop for StopsOnPanic<'_> {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::verify::Check;
    use std::sync::atomic::AtomicUsize;
    use std::time::Duration;

    fn slow(_: &Device, _: Effort) -> Result<Findings, StudyError> {
        thread::sleep(Duration::from_millis(20));
        Ok(vec![Check::of("slow", 1.0, (1.0, 0.0), 0.1)].into())
    }

    fn fast(_: &Device, _: Effort) -> Result<Findings, StudyError> {
        Ok(vec![Check::of("fast", 1.0, (1.0, 0.0), 0.1)].into())
    }

    fn failing(_: &Device, _: Effort) -> Result<Findings, StudyError> {
        Err(StudyError::TooShort { state: "case".into() })
    }

    /// Which cases have been told, and which of them could not run.
    fn order(cases: &[&Case], workers: usize) -> (Vec<String>, Vec<String>) {
        let (mut seen, mut failed) = (Vec::new(), Vec::new());
        let outcome = run_cases(
            cases,
            Effort::Quick,
            workers,
            || Device::open(None),
            |case, findings| {
                seen.push(case.name.to_owned());
                match findings {
                    Ok(found) => {
                        assert_eq!(found.checks[0].quantity, if case.name == "a" { "slow" } else { "fast" })
                    }
                    Err(error) => failed.push(format!("{}: {error}", case.name)),
                }
                Ok::<(), StudyError>(())
            },
        );
        assert!(outcome.is_ok());
        (seen, failed)
    }

    /// One that cannot run takes nothing from the others.
    #[test]
    fn findings_come_in_the_order_of_the_cases() {
        let case = |name, run| Case { name, law: "", run };
        let cases = [case("a", slow), case("b", fast), case("c", fast), case("d", failing), case("e", fast)];
        let [a, b, c, d, e] = &cases;
        for workers in [1, 2, 9] {
            let (seen, failed) = order(&[a, b, c, e], workers);
            assert!(failed.is_empty() && seen == ["a", "b", "c", "e"], "{seen:?}");
            let (seen, failed) = order(&[a, b, d, c, e], workers);
            assert_eq!(seen, ["a", "b", "d", "c", "e"]);
            assert_eq!(failed, [format!("d: {}", StudyError::TooShort { state: "case".into() })]);
        }
        assert!(order(&[], 2).0.is_empty());
    }

    /// What stops the table stops the cases.
    #[test]
    fn no_case_is_started_when_nobody_listens() {
        static STARTED: AtomicUsize = AtomicUsize::new(0);
        fn counted(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
            STARTED.fetch_add(1, Ordering::Relaxed);
            slow(device, effort)
        }
        let cases: Vec<Case> = (0..40).map(|_| Case { name: "b", law: "", run: counted }).collect();
        let cases: Vec<&Case> = cases.iter().collect();
        let outcome = run_cases(&cases, Effort::Quick, 1, || Device::open(None), |_, _| Err("closed"));
        assert_eq!(outcome, Err("closed"));
        let started = STARTED.load(Ordering::Relaxed);
        assert!((1..40).contains(&started), "{started}");
    }
}
