//! How far a run has come: a bar on a terminal, plain log lines elsewhere.
//!
//! Rates are those of the last few seconds, so that they follow a growing number of particles; the time
//! left assumes that simulated time goes on at its recent pace, and is told once the run has shown one.

use std::io::IsTerminal;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressStyle};

use super::table::{grouped, metric};

/// Between two log lines, and the span over which rates are taken.
const LOG_INTERVAL: Duration = Duration::from_secs(5);
/// Between two updates of the bar.
const BAR_INTERVAL: Duration = Duration::from_millis(200);
/// The target of events that only the log of a run has: what a bar or standard output says in another form.
pub const LOG_ONLY: &str = "corpuscle::log_only";

/// How progress is shown on standard error; the log has its lines in any case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// A bar if that is a terminal, else lines.
    Yes {
        colour: bool,
    },
    No,
}

/// The share of the way that is behind before it is said when the end comes.
const LEAST_SHOWN: f64 = 0.02;
/// Steps of the bar.
const BAR_LENGTH: u64 = 1000;

/// Shows the progress of one run, on standard error.
#[derive(Debug)]
pub struct Progress {
    /// s of simulated time.
    end_time: f64,
    started: Instant,
    bar: Option<ProgressBar>,
    /// Log lines are for the log alone.
    hidden: bool,
    /// When the bar was drawn last, and when there was a line last.
    drawn: Duration,
    logged: Duration,
    /// Where the rates are measured from, and the one that will replace it.
    base: Sample,
    next_base: Sample,
    /// Where this process took the run up.
    first: Sample,
}

/// The run at one moment.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Sample {
    /// Since the start of the display.
    elapsed: Duration,
    /// s, simulated.
    time: f64,
    steps: u64,
    particle_steps: u64,
}

impl Progress {
    /// For a run that ends at `end_time` (s, simulated).
    pub fn new(end_time: f64, shown: Shown) -> Progress {
        let bar = match shown {
            Shown::Yes { colour } if std::io::stderr().is_terminal() => Some(bar(colour)),
            _ => None,
        };
        Progress {
            end_time,
            started: Instant::now(),
            hidden: bar.is_some() || shown == Shown::No,
            bar,
            drawn: Duration::ZERO,
            logged: Duration::ZERO,
            base: Sample::default(),
            next_base: Sample::default(),
            first: Sample::default(),
        }
    }

    /// For a run that goes on with these totals; they count in no rate.
    pub fn resume(self, time: f64, steps: u64, particle_steps: u64) -> Progress {
        let first = Sample { elapsed: Duration::ZERO, time, steps, particle_steps };
        let mut progress = self;
        (progress.base, progress.next_base, progress.first) = (first, first, first);
        progress
    }

    /// To be called as often as convenient with the totals so far: simulated time (s), steps, and the sum
    /// over the steps of the particles in each.
    pub fn update(&mut self, time: f64, steps: u64, particle_steps: u64) {
        let elapsed = self.started.elapsed();
        self.show(Sample { elapsed, time, steps, particle_steps });
    }

    /// Says something once; it stays above the bar.
    pub fn note(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| tracing::info!("{text}")),
            None => tracing::info!("{text}"),
        }
    }

    /// As [`Progress::note`], of what has gone wrong.
    pub fn warn(&self, text: &str) {
        match &self.bar {
            Some(bar) => bar.suspend(|| tracing::warn!("{text}")),
            None => tracing::warn!("{text}"),
        }
    }

    /// Ends the display and states this process's steps and rates.
    pub fn finish(&mut self, time: f64, steps: u64, particle_steps: u64) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
        let now = Sample { elapsed: self.started.elapsed(), time, steps, particle_steps };
        let rates = now.rates_since(&self.first);
        tracing::info!(
            "{} of {}, {} steps in {} ({}steps/s, {}particle-steps/s)",
            milliseconds(time),
            milliseconds(self.end_time),
            grouped(steps.saturating_sub(self.first.steps)),
            duration(now.elapsed.as_secs_f64()),
            metric(rates.steps),
            metric(rates.particle_steps),
        );
    }

    fn show(&mut self, now: Sample) {
        if let Some(bar) = self.bar.as_ref().filter(|_| now.elapsed.saturating_sub(self.drawn) >= BAR_INTERVAL) {
            self.drawn = now.elapsed;
            bar.set_position((BAR_LENGTH as f64 * self.fraction(now.time)) as u64);
            bar.set_message(self.message(&now));
        }
        if now.elapsed.saturating_sub(self.logged) < LOG_INTERVAL {
            return;
        }
        self.logged = now.elapsed;
        let line = format!("{:.0} %: {}", 100.0 * self.fraction(now.time), self.message(&now));
        if self.hidden {
            tracing::info!(target: LOG_ONLY, "{line}");
        } else {
            tracing::info!("{line}");
        }
        if now.elapsed.saturating_sub(self.next_base.elapsed) >= LOG_INTERVAL {
            self.base = self.next_base;
            self.next_base = now;
        }
    }

    fn fraction(&self, time: f64) -> f64 {
        if self.end_time > 0.0 { (time / self.end_time).clamp(0.0, 1.0) } else { 1.0 }
    }

    fn message(&self, now: &Sample) -> String {
        let rates = now.rates_since(&self.base);
        let behind = now.time - self.first.time;
        let left = if rates.time > 0.0 && behind >= LEAST_SHOWN * (self.end_time - self.first.time) {
            format!(", {} left", duration((self.end_time - now.time).max(0.0) / rates.time))
        } else {
            String::new()
        };
        format!(
            "{} of {}{left}, {}steps/s, {}particle-steps/s",
            milliseconds(now.time),
            milliseconds(self.end_time),
            metric(rates.steps),
            metric(rates.particle_steps),
        )
    }
}

/// As wide as its terminal at most: what does not fit is left out.
fn bar(colour: bool) -> ProgressBar {
    let blocks = if colour { "{bar:20.cyan/blue}" } else { "{bar:20}" };
    // The template is a constant; the default style stands in if it did not parse.
    let style = ProgressStyle::with_template(&format!("{blocks} {{percent:>3}} % {{wide_msg}}"))
        .unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(BAR_LENGTH).with_style(style)
}

impl Drop for Progress {
    /// An error that ends the run must not be printed into the bar's line.
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Per second of the wall clock.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Rates {
    time: f64,
    steps: f64,
    particle_steps: f64,
}

impl Sample {
    fn rates_since(&self, earlier: &Sample) -> Rates {
        let seconds = self.elapsed.saturating_sub(earlier.elapsed).as_secs_f64();
        let per_second = |amount: f64| if seconds > 0.0 { amount / seconds } else { 0.0 };
        Rates {
            time: per_second(self.time - earlier.time),
            steps: per_second(self.steps.saturating_sub(earlier.steps) as f64),
            particle_steps: per_second(self.particle_steps.saturating_sub(earlier.particle_steps) as f64),
        }
    }
}

fn milliseconds(time: f64) -> String {
    format!("{:.2} ms", 1e3 * time)
}

/// Of the wall clock, `seconds` as `1 h 05 min`, `3 min 20 s` or `7.5 s`.
fn duration(seconds: f64) -> String {
    if seconds < 60.0 {
        return format!("{seconds:.1} s");
    }
    let whole = seconds as u64;
    match (whole / 3600, whole / 60 % 60, whole % 60) {
        (0, minutes, seconds) => format!("{minutes} min {seconds:02} s"),
        (hours, minutes, _) => format!("{hours} h {minutes:02} min"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::sync::{Arc, Mutex};

    #[derive(Clone, Default)]
    struct Captured(Arc<Mutex<Vec<u8>>>);

    impl Write for Captured {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap().write(bytes)
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    fn logged(samples: impl Iterator<Item = Sample>) -> String {
        let captured = Captured::default();
        let writer = captured.clone();
        let subscriber = tracing_subscriber::fmt().with_writer(move || writer.clone()).with_ansi(false).finish();
        let mut progress = Progress::new(0.1, Shown::Yes { colour: false });
        (progress.bar, progress.hidden) = (None, false);
        tracing::subscriber::with_default(subscriber, || samples.for_each(|now| progress.show(now)));
        String::from_utf8(captured.0.lock().unwrap().clone()).unwrap()
    }

    /// A run of 100 steps/s, 1 ms of simulated time each second, after `i` seconds.
    fn second(i: u64) -> Sample {
        Sample { elapsed: Duration::from_secs(i), time: 1e-3 * i as f64, steps: 100 * i, particle_steps: 2_000_000 * i }
    }

    #[test]
    fn without_a_terminal_there_is_a_line_every_five_seconds_and_no_more() {
        let log = logged((0..=21).map(second));
        assert_eq!(log.lines().count(), 4, "{log}");
        // An interval half as long would show twice as many lines.
        let dense = logged((0..=42).map(second));
        assert_eq!(dense.lines().count(), 8, "{dense}");
    }

    #[test]
    fn a_line_gives_simulated_time_rates_and_time_left() {
        let log = logged((0..=6).map(second));
        let expected = "5 %: 5.00 ms of 100.00 ms, 1 min 35 s left, 100 steps/s, 2.00 M particle-steps/s";
        assert!(log.contains(expected), "{log}");
    }

    #[test]
    fn the_time_left_follows_a_run_that_slows_down() {
        // From 20 s on the run is ten times slower: 79 ms left at 0.1 ms/s.
        let slow = |i: u64| Sample { time: 0.02 + 1e-4 * (i - 20) as f64, ..second(i) };
        let log = logged((0..20).map(second).chain((20..=40).map(slow)));
        let last = log.lines().last().unwrap();
        assert!(last.contains("13 min 00 s left"), "{log}");
    }

    /// The first steps say little about the last: they are compiled, or come before the gas.
    #[test]
    fn when_the_end_comes_is_not_said_before_two_percent() {
        let long = |k: u64| Sample { time: 1.9e-3 * k as f64 / 6.0, ..second(k) };
        assert!(!logged((0..=6).map(long)).contains("left"));
        let later = |k: u64| Sample { time: 3e-3 * k as f64 / 6.0, ..second(k) };
        assert!(logged((0..=6).map(later)).contains("left"));
    }

    /// What an earlier process did counts in no rate; counted, it would make the run look fast.
    #[test]
    fn a_resumed_run_starts_with_its_own_rates() {
        let resumed = Progress::new(0.1, Shown::No).resume(0.05, 5000, 100_000_000);
        let after = Sample { elapsed: Duration::from_secs(5), time: 0.055, steps: 5500, particle_steps: 110_000_000 };
        let expected = "55.00 ms of 100.00 ms, 45.0 s left, 100 steps/s, 2.00 M particle-steps/s";
        assert_eq!(resumed.message(&after), expected);
        assert_ne!(Progress::new(0.1, Shown::No).message(&after), expected);
    }

    #[test]
    fn durations_are_told_in_their_own_unit() {
        assert_eq!(duration(7.46), "7.5 s");
        assert_eq!(duration(200.0), "3 min 20 s");
        assert_eq!(duration(3900.0), "1 h 05 min");
    }

    #[test]
    fn a_run_of_no_length_or_without_steps_still_shows() {
        let progress = Progress::new(0.0, Shown::No);
        assert_eq!(progress.fraction(0.0), 1.0);
        assert!(progress.message(&Sample::default()).starts_with("0.00 ms of 0.00 ms, 0"));
    }
}
