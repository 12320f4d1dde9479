//! A case of reference, and what it finds.

use super::check::Check;
use crate::gpu::Device;
use crate::output::{PALETTE, Series};
use crate::study::StudyError;

/// How much a case takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// All cases together in minutes on two cores.
    Quick,
    /// The figures of the documentation.
    Full,
}

/// A law and the runs that show it.
pub struct Case {
    pub name: &'static str,
    /// What is compared with what, and where the reference is from.
    pub law: &'static str,
    pub(super) run: fn(&Device, Effort) -> Result<Findings, StudyError>,
}

impl Case {
    /// # Errors
    /// If a run fails.
    pub fn run(&self, device: &Device, effort: Effort) -> Result<Findings, StudyError> {
        (self.run)(device, effort)
    }
}

/// What a case found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Findings {
    pub checks: Vec<Check>,
    pub charts: Vec<Curves>,
    /// What is to be said of the prototype's figures that were found to be otherwise.
    pub notes: Vec<String>,
}

impl From<Vec<Check>> for Findings {
    fn from(checks: Vec<Check>) -> Findings {
        Findings { checks, ..Findings::default() }
    }
}

impl FromIterator<Check> for Findings {
    fn from_iter<I: IntoIterator<Item = Check>>(checks: I) -> Findings {
        Findings::from(checks.into_iter().collect::<Vec<_>>())
    }
}

/// Measured curves beside their references.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    /// Of the file, without its ending.
    pub name: &'static str,
    pub title: String,
    pub x_label: &'static str,
    pub y_label: &'static str,
    pub series: Vec<Series>,
}

impl Curves {
    pub fn new(name: &'static str, title: String, x_label: &'static str, y_label: &'static str) -> Curves {
        Curves { name, title, x_label, y_label, series: Vec::new() }
    }

    /// Adds a measured one.
    #[must_use]
    pub fn line(mut self, name: &str, points: Vec<[f64; 2]>) -> Curves {
        let colour = PALETTE[self.series.len() % PALETTE.len()];
        self.series.push(Series { name: name.into(), points, dashed: false, colour });
        self
    }

    /// Adds what the last ones should be.
    #[must_use]
    pub fn reference(mut self, name: &str, points: Vec<[f64; 2]>) -> Curves {
        let [.., ink] = PALETTE;
        self.series.push(Series { name: name.into(), points, dashed: true, colour: ink });
        self
    }
}
