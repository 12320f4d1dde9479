//! The outcome of the reference cases as a table: for a terminal, and as a page of the documentation.

use std::fmt::Write;

use crate::output::figure;

use super::{Case, Check, Curves, Findings, Verdict};

/// Columns of the table: case, quantity, reference, measured, standard error, tolerance, verdict.
const WIDTHS: [usize; 7] = [15, 44, 10, 12, 10, 10, 8];
pub(super) const TITLES: [&str; 7] = ["case", "quantity", "reference", "measured", "std error", "tolerance", "verdict"];

/// The titles above the lines of [`lines`].
pub fn head() -> String {
    line(&TITLES.map(str::to_owned))
}

/// A line for each check of a case.
pub fn lines(case: &Case, checks: &[Check]) -> String {
    checks.iter().map(|check| line(&cells(case, check))).collect()
}

/// In place of the lines of a case whose run failed.
pub fn failed(case: &Case, why: &str) -> String {
    format!("{:<width$} failed: {}\n", case.name, one_line(why), width = WIDTHS[0])
}

pub(super) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// How many checks came out how.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tally {
    pub pass: usize,
    pub differ: usize,
    pub all: usize,
}

impl Tally {
    pub fn of(outcomes: &[(&Case, Findings)]) -> Tally {
        let verdicts = || outcomes.iter().flat_map(|(_, found)| &found.checks).map(Check::verdict);
        let count = |wanted: Verdict| verdicts().filter(|verdict| *verdict == wanted).count();
        Tally { pass: count(Verdict::Pass), differ: count(Verdict::Differs), all: verdicts().count() }
    }

    /// Those that fail, or say nothing.
    pub fn failed(self) -> usize {
        self.all - self.pass - self.differ
    }

    /// With how many cases failed before they had any.
    pub fn in_words(self, failed: usize) -> String {
        let mut words = format!("{} of {} pass", self.pass, self.all);
        if self.differ > 0 {
            let (verb, figures) =
                if self.differ == 1 { ("differs", "a disputed figure") } else { ("differ", "disputed figures") };
            let _ = write!(words, ", {} {verb} from {figures} of the prototype", self.differ);
        }
        match failed {
            0 => {}
            1 => words += ", 1 case failed",
            _ => {
                let _ = write!(words, ", {failed} cases failed");
            }
        }
        words
    }
}

/// The name of the file that a chart is drawn into.
pub fn file(chart: &Curves) -> String {
    format!("accuracy-{}.svg", chart.name)
}

pub(super) fn cells(case: &Case, check: &Check) -> [String; 7] {
    let error = if check.error == 0.0 { "exact".to_owned() } else { figure(check.error, 4) };
    [
        case.name.to_owned(),
        check.quantity.clone(),
        figure(check.reference, 4),
        figure(check.measured, 4),
        error,
        figure(check.tolerance, 4),
        check.verdict().word().to_owned(),
    ]
}

fn line(cells: &[String; 7]) -> String {
    let mut text = String::new();
    for (column, (cell, width)) in cells.iter().zip(WIDTHS).enumerate() {
        // Words to the left, figures to the right.
        let _ = match column {
            0 | 1 | 6 => write!(text, "{cell:<width$} "),
            _ => write!(text, "{cell:>width$} "),
        };
    }
    text.trim_end().to_owned() + "\n"
}

#[cfg(test)]
mod tests {
    use super::super::CASES;
    use super::super::page::Page;
    use super::*;

    /// The page has a row for each check and says how many pass; bars in a quantity do not end its cell.
    #[test]
    fn the_page_tells_what_passed() {
        let good = Check::of("mean |x|", 1.0, (1.01, 0.001), 0.02);
        let bad = Check { measured: 1.03, ..good.clone() };
        let other = bad.clone().disputed();
        let chart = Curves::new("wall-pressure", "Pressure".into(), "f", "p");
        let found = Findings { charts: vec![chart], ..vec![good, bad, other].into() };
        let failed = [(&CASES[1], "no\n  room".to_owned())];
        let page = Page::new(&[(&CASES[0], found)], &failed, "corpuscle verify", "a device", "figures").text();
        let summary = "1 of 3 pass, 1 differs from a disputed figure of the prototype, 1 case failed.";
        assert!(page.contains(summary), "{page}");
        assert!(page.contains(&format!("\n- `{}`: no room.\n", CASES[1].name)), "{page}");
        assert!(
            page.contains("| wall-pressure | mean \\|x\\| | 1.000 | 1.010 | 0.001000 | 0.02000 | pass |"),
            "{page}"
        );
        assert!(page.contains("| FAIL |") && page.contains("| differs |"), "{page}");
        assert!(page.contains("![Pressure](figures/accuracy-wall-pressure.svg)"), "{page}");
    }
}
