//! Whether a run can be trusted, as its files say it: the audit's verdict, the warnings with their remedies.

use serde::Serialize;

use super::super::names::AUDIT_FILE;
use super::record::Record;
use super::state::Progressing;

/// Begins the lines of [`AUDIT_FILE`] that say why the run cannot be trusted.
const FAILED: &str = "failed: ";
/// The line of one that can.
const CLEAN: &str = "verdict: the account closes";
/// Begins the lines of what has left its limits.
const WARNING: &str = "warning";

/// What stands in [`AUDIT_FILE`] of the failures and the warnings of an audit, a line each.
pub fn audit_verdict(failures: &[String], warned: &[String]) -> String {
    let warned: String = warned.iter().map(|text| format!("{WARNING}: {text}\n")).collect();
    let failed: String = failures.iter().map(|text| format!("{FAILED}{text}\n")).collect();
    if failures.is_empty() { format!("{warned}{CLEAN}\n") } else { warned + &failed }
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// `good`, `careful`, `bad` or `unknown`: how the page marks it.
    pub level: &'static str,
    pub word: String,
    pub lines: Vec<String>,
}

/// What the planner or a guard has told.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Warned {
    /// `in the plan`, or the time of the run.
    pub when: String,
    pub what: String,
    /// Empty if it names none.
    pub remedy: String,
}

impl Warned {
    fn new(when: &str, text: &str) -> Warned {
        let (what, remedy) = text.rsplit_once("; ").unwrap_or((text, ""));
        Warned { when: when.to_owned(), what: what.to_owned(), remedy: remedy.to_owned() }
    }
}

pub fn warnings(record: &Record) -> Vec<Warned> {
    let planned = record.planned("warnings").and_then(toml::Value::as_array);
    let mut warned: Vec<Warned> = planned
        .into_iter()
        .flatten()
        .filter_map(toml::Value::as_str)
        .map(|text| Warned::new("in the plan", text))
        .collect();
    let known: Vec<String> = warned.iter().map(|one| format!("{}; {}", one.what, one.remedy)).collect();
    match &record.audit {
        Some(audit) => warned.extend(audit.lines().filter_map(of_audit)),
        // What the plan has told stands in the log once more.
        None => warned.extend(
            record.logged().iter().filter(|line| !known.contains(line)).map(|line| Warned::new("in the log", line)),
        ),
    }
    warned
}

/// `warning at 0.57 ms: what; remedy`, `warning: what; remedy`.
fn of_audit(line: &str) -> Option<Warned> {
    let rest = line.strip_prefix(WARNING)?;
    let (when, text) = rest.split_once(": ")?;
    Some(Warned::new(if when.is_empty() { "at the end" } else { when.trim() }, text))
}

pub fn verdict(record: &Record, warned: &[Warned]) -> Verdict {
    let end = 1e3 * record.scene.end_time;
    let reached = format!("its history ends at {:.4} ms of {end:.4} ms", 1e3 * record.reached());
    let told = |level, word: &str, lines: Vec<String>| Verdict { level, word: word.to_owned(), lines };
    let mut stopped = vec![reached.clone()];
    if record.cut {
        stopped.push("the last line of history.csv is cut off and is left out here".to_owned());
    }
    match (&record.state, &record.audit) {
        (Progressing::Going(holder), _) => {
            told("unknown", "This run goes on", vec![format!("written by {holder}"), reached])
        }
        (Progressing::Stopped, _) | (_, None) => {
            stopped.push(
                "it was killed, has failed, or was stopped: there is no audit, and what is below is a part".to_owned(),
            );
            stopped
                .push(format!("`corpuscle resume {}` goes on from a checkpoint, if it has one", record.path.display()));
            told("bad", "This run has not reached its end", stopped)
        }
        (Progressing::Ended, Some(audit)) => {
            let failures: Vec<String> =
                audit.lines().filter_map(|line| line.strip_prefix(FAILED)).map(str::to_owned).collect();
            if !failures.is_empty() {
                return told("bad", "The audit failed: the results cannot be trusted", failures);
            }
            if !audit.lines().any(|line| line == CLEAN) {
                let why = format!("{AUDIT_FILE} says no verdict: an older version wrote it");
                return told("unknown", "The run has reached its end; its audit is below", vec![why]);
            }
            match warned.len() {
                0 => told("good", "The audit is clean, and nothing warns", Vec::new()),
                1 => told("careful", "The audit is clean; there is a warning", Vec::new()),
                count => told("careful", &format!("The audit is clean; there are {count} warnings"), Vec::new()),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_the_audit_have_a_time_and_a_remedy() {
        let timed = of_audit("warning at 0.5749 ms: probe `jet`: 4 particles; more `particles`").unwrap();
        assert_eq!((timed.when.as_str(), timed.remedy.as_str()), ("at 0.5749 ms", "more `particles`"));
        assert_eq!(timed.what, "probe `jet`: 4 particles");
        let untimed = of_audit("warning: 4 % of the collisions were lost").unwrap();
        assert_eq!((untimed.when.as_str(), untimed.remedy.as_str()), ("at the end", ""));
        assert_eq!(of_audit("mass, kg  1  2  3"), None);
    }
}
