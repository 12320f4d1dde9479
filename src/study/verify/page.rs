//! The outcome of the reference cases as a page of the documentation: written anew, or with the cases that were run in place of
//! those of before.
//!
//! A page is its parts by case, each as it stands in the text; so what is kept is kept to the letter, and a page read and
//! written again is the same.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::report::{TITLES, Tally, cells, file, one_line};
use super::{Case, Findings, Verdict, all_cases};

const TITLE: &str = "# Accuracy";
const ALIGNMENT: &str = "|---|---|--:|--:|--:|--:|---|";
const FAILED: &str = "## What failed";
const NOTES: &str = "## Where the prototype's figures are others";

/// A page by its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    command: String,
    device: String,
    cases: BTreeMap<String, Part>,
}

/// The lines of a case.
#[derive(Debug, Clone, PartialEq, Default)]
struct Part {
    rows: Vec<String>,
    failure: Option<String>,
    notes: Vec<String>,
    charts: Vec<String>,
}

/// Why a page cannot keep what it has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PageError {
    #[error("line {line} is {found:?}: expected {expected}")]
    Line { line: usize, found: String, expected: &'static str },
    #[error("it is of {found:?}, and the cases of now ran on {expected:?}: run all of them")]
    Device { found: String, expected: String },
    #[error("it is of `{found}`, which is not as large as `{expected}`: run all cases")]
    Extent { found: String, expected: String },
}

impl Page {
    /// `command`: what made it, `device`: where; `figures`: the folder with the charts, from the page.
    pub fn new(
        outcomes: &[(&Case, Findings)],
        failed: &[(&Case, String)],
        command: &str,
        device: &str,
        figures: &str,
    ) -> Page {
        let mut cases: BTreeMap<String, Part> = BTreeMap::new();
        for (case, found) in outcomes {
            let row = |check| format!("| {} |", cells(case, check).map(|cell| cell.replace('|', "\\|")).join(" | "));
            let part = Part {
                rows: found.checks.iter().map(row).collect(),
                failure: None,
                notes: found.notes.iter().map(|note| format!("- `{}`: {}.", case.name, one_line(note))).collect(),
                charts: found
                    .charts
                    .iter()
                    .map(|chart| format!("![{}]({figures}/{})", chart.title, file(chart)))
                    .collect(),
            };
            cases.insert(case.name.to_owned(), part);
        }
        for (case, why) in failed {
            let failure = Some(format!("- `{}`: {}.", case.name, one_line(why)));
            cases.insert(case.name.to_owned(), Part { failure, ..Part::default() });
        }
        Page { command: command.to_owned(), device: device.to_owned(), cases }
    }

    /// Of a text that [`Page::text`] has given.
    ///
    /// # Errors
    /// If it is none.
    pub fn read(text: &str) -> Result<Page, PageError> {
        let mut lines = text.lines().enumerate();
        let mut wanted = |expected: &'static str, of: &dyn Fn(&str) -> Option<String>| {
            let found = lines.by_ref().map(|(k, line)| (k, line, of(line))).find(|(.., found)| found.is_some());
            found.and_then(|(.., found)| found).ok_or(PageError::Line {
                line: text.lines().count(),
                found: "the end".into(),
                expected,
            })
        };
        wanted("`# Accuracy`", &|line| (line == TITLE).then(String::new))?;
        let command = wanted("the command", &|line| line.starts_with("corpuscle verify").then(|| line.to_owned()))?;
        let device = wanted("the device", &|line| {
            line.strip_prefix("on ")?.split_once(". Another adapter").map(|(device, _)| device.to_owned())
        })?;
        wanted("the table", &|line| (line == ALIGNMENT).then(String::new))?;
        let mut cases: BTreeMap<String, Part> = BTreeMap::new();
        let mut section = "";
        for (line, found) in lines {
            let wrong = |expected| PageError::Line { line: line + 1, found: found.to_owned(), expected };
            if found.is_empty() {
                continue;
            }
            if let Some(next) = [FAILED, NOTES].into_iter().find(|title| *title == found) {
                section = next;
                continue;
            }
            let owned = || found.to_owned();
            if found.starts_with("![") {
                // A chart is of the case whose name is that of its file.
                let name = found.rsplit_once("accuracy-").and_then(|(_, rest)| rest.strip_suffix(".svg)"));
                let name = name.ok_or_else(|| wrong("a chart of a case"))?;
                cases.entry(name.to_owned()).or_default().charts.push(owned());
            } else if section.is_empty() {
                let name = found.strip_prefix("| ").and_then(|rest| rest.split_once(" |"));
                let (name, _) = name.ok_or_else(|| wrong("a row of the table"))?;
                cases.entry(name.to_owned()).or_default().rows.push(owned());
            } else {
                let name = found.strip_prefix("- `").and_then(|rest| rest.split_once('`'));
                let (name, _) = name.ok_or_else(|| wrong("a line of a case"))?;
                let part = cases.entry(name.to_owned()).or_default();
                if section == FAILED { part.failure = Some(owned()) } else { part.notes.push(owned()) }
            }
        }
        Ok(Page { command, device, cases })
    }

    /// What `before` has, with the cases of this page in place of its own. The command is that of before.
    ///
    /// # Errors
    /// If they are of two devices, or not both of `--full` or `--quick`.
    pub fn in_place_of(self, before: Page) -> Result<Page, PageError> {
        if before.device != self.device {
            return Err(PageError::Device { found: before.device, expected: self.device });
        }
        if before.command.contains(" --full") != self.command.contains(" --full") {
            return Err(PageError::Extent { found: before.command, expected: self.command });
        }
        let mut cases = before.cases;
        cases.extend(self.cases);
        Ok(Page { cases, ..before })
    }

    /// In the order of the cases; what is no case any more is left out.
    pub fn text(&self) -> String {
        let parts: Vec<&Part> = all_cases().filter_map(|case| self.cases.get(case.name)).collect();
        let rows: Vec<&String> = parts.iter().flat_map(|part| &part.rows).collect();
        let count = |verdict: Verdict| {
            let end = format!("| {} |", verdict.word());
            rows.iter().filter(|row| row.ends_with(&end)).count()
        };
        let tally = Tally { pass: count(Verdict::Pass), differ: count(Verdict::Differs), all: rows.len() };
        let failures: Vec<&String> = parts.iter().filter_map(|part| part.failure.as_ref()).collect();
        let mut text = format!(
            "{TITLE}\n\n\
             Reference cases and what a run gave for them, as printed by\n\n```sh\n{}\n```\n\n\
             on {}. Another adapter draws another sample, as good.\n\n\
             The tolerance is that of the law, fixed before the first run; of `half-turn` some were fixed with runs in sight. A check\n\
             passes if the measured figure is within it, and its standard error at most a third of it. One that differs is of a\n\
             disputed figure of the prototype. The law of each case stands in `corpuscle verify --list`.\n\n",
            self.command, self.device
        );
        let _ = writeln!(text, "{}.\n\n| {} |", tally.in_words(failures.len()), TITLES.join(" | "));
        let _ = writeln!(text, "{ALIGNMENT}");
        let mut section = |title: &str, lines: Vec<&String>| {
            if !lines.is_empty() {
                text += title;
                lines.iter().for_each(|line| text += &format!("{line}\n"));
            }
        };
        section("", rows);
        section(&format!("\n{FAILED}\n\n"), failures);
        section(&format!("\n{NOTES}\n\n"), parts.iter().flat_map(|part| &part.notes).collect());
        for chart in parts.iter().flat_map(|part| &part.charts) {
            let _ = writeln!(text, "\n{chart}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::super::{CASES, Check, Curves};
    use super::*;

    fn found(case: &Case, measured: f64) -> Findings {
        let chart = Curves::new(case.name, "Pressure".into(), "f", "p");
        let check = Check::of("mean |x|", 1.0, (measured, 0.001), 0.02);
        Findings { checks: vec![check], charts: vec![chart], notes: vec!["it is so".into()] }
    }

    fn page(outcomes: &[(&Case, Findings)], command: &str, device: &str) -> Page {
        Page::new(outcomes, &[(&CASES[2], "no\n  room".to_owned())], command, device, "figures")
    }

    /// What is read and written again is the same, and cases that are run again stand where they stood; the others stay.
    #[test]
    fn cases_that_are_run_again_take_the_place_of_their_own() {
        let (all, one) = ("corpuscle verify --full", "corpuscle verify virial --full");
        let both = page(&[(&CASES[0], found(&CASES[0], 1.0)), (&CASES[1], found(&CASES[1], 1.5))], all, "a device");
        let text = both.text();
        assert!(text.contains("1 of 2 pass, 1 case failed.") && text.contains("no room."), "{text}");
        assert_eq!(Page::read(&text), Ok(both.clone()));
        let again = Page::new(&[(&CASES[1], found(&CASES[1], 1.01))], &[], one, "a device", "figures");
        let merged = again.clone().in_place_of(Page::read(&text).unwrap()).unwrap().text();
        assert_eq!(merged, text.replace("1.500", "1.010").replace("FAIL", "pass").replace("1 of 2", "2 of 2"));
        let of_other = Page::read(&page(&[], all, "another").text()).unwrap();
        assert!(matches!(again.clone().in_place_of(of_other), Err(PageError::Device { .. })));
        let quick = Page::read(&page(&[], "corpuscle verify --quick", "a device").text()).unwrap();
        assert!(matches!(again.in_place_of(quick), Err(PageError::Extent { .. })));
        assert!(matches!(Page::read("# Limits"), Err(PageError::Line { .. })));
    }
}
