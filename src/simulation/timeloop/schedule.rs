//! When a run writes checkpoints of its own accord: every so many steps, every so much wall time, and before a limit of
//! wall time.
//!
//! Pure: it is told the time and changes no result. Wall times differ between ranks, so one rank decides for all.

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use super::interrupt::Request;

/// A length of wall time, as people write it: `90s`, `10m`, `2h`, `1h30m`, `1:30:00`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct WallTime(pub Duration);

/// How often checkpoints are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CheckpointEvery {
    Steps(u64),
    Wall(WallTime),
}

#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum WallTimeError {
    #[error("`{found}` is no wall time; write 90s, 10m, 2h, 1h30m or hours:minutes:seconds as in 1:30:00")]
    Form { found: String },
    #[error("`{found}` has no unit; write {found}s, {found}m or {found}h")]
    NoUnit { found: String },
    #[error("`{found}`: after a colon come minutes or seconds in two digits, 00 to 59")]
    Sexagesimal { found: String },
    #[error("`{found}` is no time at all; it must be longer than zero")]
    Zero { found: String },
    #[error("`{found}` is longer than a hundred years")]
    TooLong { found: String },
    #[error("`{found}` is neither a number of steps (5000) nor a wall time (90s, 10m, 2h, 1:30:00)")]
    Every { found: String },
}

const LONGEST: u64 = 100 * 366 * 24 * 3600;

impl FromStr for WallTime {
    type Err = WallTimeError;

    fn from_str(text: &str) -> Result<WallTime, WallTimeError> {
        let found = || text.to_owned();
        let seconds = if text.contains(':') { clock_seconds(text)? } else { unit_seconds(text)? };
        match seconds {
            0 => Err(WallTimeError::Zero { found: found() }),
            1..=LONGEST => Ok(WallTime(Duration::from_secs(seconds))),
            _ => Err(WallTimeError::TooLong { found: found() }),
        }
    }
}

/// The whole number that a text stands for, as people write it: 2000, 2_000, 2e3. None of what has a fraction or a sign; a number of
/// digits too large is as good as the largest.
pub fn whole_number(text: &str) -> Option<u64> {
    let digits = text.replace('_', "");
    let apart = text.starts_with('_') || text.ends_with('_') || text.contains("__");
    if apart || !digits.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    if digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return Some(digits.parse().unwrap_or(u64::MAX));
    }
    // Exact below 2^53, and no count with an exponent is beyond.
    let number: f64 = digits.parse().ok()?;
    (number.fract() == 0.0 && number < 9e15).then_some(number as u64)
}

/// `hours:minutes:seconds` or `minutes:seconds`.
fn clock_seconds(text: &str) -> Result<u64, WallTimeError> {
    let parts: Vec<&str> = text.split(':').collect();
    let form = || WallTimeError::Form { found: text.to_owned() };
    if !(2..=3).contains(&parts.len()) {
        return Err(form());
    }
    let mut seconds = whole_number(parts[0]).ok_or_else(form)?;
    for part in &parts[1..] {
        let own = whole_number(part).ok_or_else(form)?;
        if part.len() != 2 || own > 59 {
            return Err(WallTimeError::Sexagesimal { found: text.to_owned() });
        }
        seconds = seconds.saturating_mul(60).saturating_add(own);
    }
    Ok(seconds)
}

/// `2h`, `10m`, `90s`, or several in this order.
fn unit_seconds(text: &str) -> Result<u64, WallTimeError> {
    if whole_number(text).is_some() {
        return Err(WallTimeError::NoUnit { found: text.to_owned() });
    }
    let form = || WallTimeError::Form { found: text.to_owned() };
    let (mut rest, mut seconds, mut any) = (text, 0u64, false);
    for (unit, length) in [('h', 3600), ('m', 60), ('s', 1)] {
        if let Some((digits, after)) = rest.split_once(unit) {
            seconds = seconds.saturating_add(whole_number(digits).ok_or_else(form)?.saturating_mul(length));
            (rest, any) = (after, true);
        }
    }
    if any && rest.is_empty() { Ok(seconds) } else { Err(form()) }
}

impl FromStr for CheckpointEvery {
    type Err = WallTimeError;

    fn from_str(text: &str) -> Result<CheckpointEvery, WallTimeError> {
        match whole_number(text) {
            Some(0) => Err(WallTimeError::Zero { found: text.to_owned() }),
            Some(steps) => Ok(CheckpointEvery::Steps(steps)),
            None => text.parse().map(CheckpointEvery::Wall).map_err(|error| match error {
                WallTimeError::Form { found } => WallTimeError::Every { found },
                other => other,
            }),
        }
    }
}

impl fmt::Display for WallTime {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let seconds = self.0.as_secs();
        write!(out, "{}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60)
    }
}

/// Share of the limit that is kept for the last checkpoint while none has been measured.
const UNMEASURED: u32 = 50;

/// From a question to the state that is written pass two intervals more, and one until the next question.
const GAPS: u32 = 3;

/// Decides; all times are since the start of this process.
#[derive(Debug, Clone)]
pub struct Schedule {
    every: Option<CheckpointEvery>,
    stop_after: Option<WallTime>,
    /// The last checkpoint, or the start.
    last: (Duration, u64),
    costliest: Option<Duration>,
    asked: Duration,
    /// Between two questions.
    longest_gap: Duration,
}

impl Schedule {
    /// For a run whose time loop starts, or goes on, at `step` after `elapsed`.
    pub fn new(every: Option<CheckpointEvery>, stop_after: Option<WallTime>, elapsed: Duration, step: u64) -> Schedule {
        Schedule {
            every,
            stop_after,
            last: (elapsed, step),
            costliest: None,
            asked: elapsed,
            longest_gap: Duration::ZERO,
        }
    }

    /// To be asked between intervals. A stop is asked for while there is time to write: before the limit by three of the
    /// longest gaps between two questions and twice the costliest checkpoint so far (a fiftieth of the limit before the first).
    pub fn due(&mut self, elapsed: Duration, step: u64) -> Request {
        self.longest_gap = self.longest_gap.max(elapsed.saturating_sub(self.asked));
        self.asked = elapsed;
        if let Some(WallTime(limit)) = self.stop_after {
            let writing = self.costliest.map_or(limit / UNMEASURED, |cost| 2 * cost);
            if elapsed.saturating_add(GAPS * self.longest_gap).saturating_add(writing) >= limit {
                return Request::CheckpointAndStop(None);
            }
        }
        let (at, last_step) = self.last;
        let due = match self.every {
            None => false,
            // At multiples of the whole run's steps, wherever it was resumed.
            Some(CheckpointEvery::Steps(every)) => step / every.max(1) > last_step / every.max(1),
            Some(CheckpointEvery::Wall(WallTime(every))) => elapsed.saturating_sub(at) >= every,
        };
        if due { Request::Checkpoint } else { Request::None }
    }

    /// A checkpoint is written, for whatever reason; it took so long.
    pub fn written(&mut self, elapsed: Duration, step: u64, took: Duration) {
        self.last = (elapsed, step);
        self.costliest = Some(self.costliest.unwrap_or_default().max(took));
        // The time of writing is no gap between intervals.
        self.asked = elapsed;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    #[test]
    fn wall_times_are_read_as_people_write_them() {
        for (text, seconds) in [
            ("90s", 90),
            ("10m", 600),
            ("2h", 7200),
            ("1h30m", 5400),
            ("1h5s", 3605),
            ("1:30:00", 5400),
            ("02:05", 125),
            ("100:00:01", 360_001),
            ("0:00:01", 1),
        ] {
            assert_eq!(text.parse(), Ok(WallTime(Duration::from_secs(seconds))), "{text}");
        }
        assert_eq!("26h".parse::<WallTime>().unwrap().to_string(), "26:00:00");
    }

    /// What is no wall time is refused with the text and what would do.
    #[test]
    fn other_texts_are_refused_with_the_reason() {
        let said = |text: &str| {
            let error = text.parse::<WallTime>().unwrap_err().to_string();
            assert!(error.starts_with(&format!("`{text}`")), "{error}");
            error
        };
        assert!(said("90").contains("90s, 90m or 90h"));
        for text in
            ["", "s", "m10", "10 m", "-5s", "+5s", "1.5h", "5s3m", "1h2h", "ten", "1:2:3:4", ":30", "1::2", "5ms"]
        {
            assert!(said(text).contains("1:30:00"), "{text}");
        }
        for text in ["1:60:00", "1:5:00", "1:00:061", "0:99"] {
            assert!(said(text).contains("two digits"), "{text}");
        }
        assert!(said("0s").contains("longer than zero") && said("0:00:00").contains("longer than zero"));
        for text in ["99999999999999999999s", "99999999999999999999:00:00", "900000h"] {
            assert!(said(text).contains("hundred years"), "{text}");
        }
    }

    #[test]
    fn checkpoints_come_every_so_many_steps_or_so_much_time() {
        assert_eq!("5000".parse(), Ok(CheckpointEvery::Steps(5000)));
        assert_eq!("10m".parse(), Ok(CheckpointEvery::Wall(WallTime(600 * SECOND))));
        for text in ["0", "0m", "often", "1:99"] {
            assert!(text.parse::<CheckpointEvery>().is_err(), "{text}");
        }
        assert!("often".parse::<CheckpointEvery>().unwrap_err().to_string().contains("number of steps"));
    }

    #[test]
    fn whole_numbers_are_read_as_people_write_them() {
        for (text, number) in
            [("2000", 2000), ("2_000", 2000), ("2e3", 2000), ("2.5e3", 2500), ("1E6", 1_000_000), ("0", 0)]
        {
            assert_eq!(whole_number(text), Some(number), "{text}");
        }
        assert_eq!(whole_number("72057594037927935"), Some((1 << 56) - 1));
        for text in
            ["2.5", "-3", "", "two", "2e-3", "2e30", "_2", "2_", "2__0", "inf", "nan", "+2", "2,000", " 2", "0x10"]
        {
            assert_eq!(whole_number(text), None, "{text}");
        }
        assert!(matches!("1e3".parse(), Ok(CheckpointEvery::Steps(1000))));
    }

    /// The steps at which checkpoints are written do not depend on where the run was resumed.
    #[test]
    fn steps_are_counted_over_the_whole_run() {
        let every = Some(CheckpointEvery::Steps(100));
        let written = |from: u64| {
            let mut schedule = Schedule::new(every, None, Duration::ZERO, from);
            let due = |step: &u64| {
                let due = schedule.due(SECOND, *step) == Request::Checkpoint;
                if due {
                    schedule.written(SECOND, *step, SECOND);
                }
                due
            };
            (from + 32..1000).step_by(32).filter(due).collect::<Vec<_>>()
        };
        let whole = written(0);
        assert_eq!(whole, [128, 224, 320, 416, 512, 608, 704, 800, 928]);
        assert_eq!(written(320), whole[3..]);
    }

    #[test]
    fn wall_time_is_counted_from_the_last_checkpoint() {
        let mut schedule = Schedule::new("10s".parse().ok(), None, Duration::ZERO, 0);
        assert_eq!(schedule.due(9 * SECOND, 1), Request::None);
        assert_eq!(schedule.due(10 * SECOND, 2), Request::Checkpoint);
        schedule.written(15 * SECOND, 2, 5 * SECOND);
        assert_eq!(schedule.due(24 * SECOND, 3), Request::None);
        assert_eq!(schedule.due(25 * SECOND, 4), Request::Checkpoint);
    }

    /// The last checkpoint is written before the limit: with what an interval and a checkpoint have taken so far.
    #[test]
    fn a_run_stops_while_there_is_time_to_write() {
        let limited = |elapsed| Schedule::new(None, "1000s".parse().ok(), elapsed, 0);
        let mut schedule = limited(Duration::ZERO);
        assert_eq!(schedule.due(100 * SECOND, 1), Request::None);
        assert_eq!(schedule.due(400 * SECOND, 2), Request::CheckpointAndStop(None), "gaps of 300 s may come again");
        // A long set-up is no gap between questions.
        assert_eq!(limited(600 * SECOND).due(601 * SECOND, 2), Request::None);
        let mut schedule = limited(Duration::ZERO);
        for second in 1..977 {
            assert_eq!(schedule.due(second * SECOND, 1), Request::None, "{second}");
        }
        assert_eq!(schedule.due(977 * SECOND, 2), Request::CheckpointAndStop(None));
        schedule.written(900 * SECOND, 1, 40 * SECOND);
        assert_eq!(schedule.due(901 * SECOND, 2), Request::None);
        assert_eq!(schedule.due(917 * SECOND, 2), Request::CheckpointAndStop(None));
        // Without a limit it never stops.
        assert_eq!(Schedule::new(None, None, Duration::ZERO, 0).due(u32::MAX * SECOND, 1), Request::None);
    }
}
