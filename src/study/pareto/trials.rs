//! What a case of a chart runs.

use super::setting::{Range, Setting};
use crate::scene::Method;
use crate::simulation::Model;
use crate::study::StudyError;
use crate::study::verify::Run;

/// How much a chart takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Seconds to a minute: to see that it works.
    Quick,
    /// Minutes on two cores without a GPU.
    Normal,
    /// More particles: for a GPU.
    Full,
}

impl Extent {
    /// Of the quick, the normal and the full one.
    pub fn pick<T>(self, [quick, normal, full]: [T; 3]) -> T {
        match self {
            Extent::Quick => quick,
            Extent::Normal => normal,
            Extent::Full => full,
        }
    }

    /// The settings of the ranges for it.
    pub fn settings(self, ranges: [&[Range<'_>]; 3]) -> Vec<Setting> {
        self.pick(ranges).iter().flat_map(Range::settings).collect()
    }
}

/// The model of a setting and of a seed that is counted from 0.
pub type Build = Box<dyn Fn(&Setting, u64) -> Result<Model, StudyError>>;

/// The deviations of a run from the law; `None` if it says nothing.
pub type Judge = Box<dyn Fn(&Model, &Run) -> Option<Vec<f64>>>;

/// What makes one error of deviations. The error of the mean over seeds is that of their mean deviations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Norm {
    /// Mean of the magnitudes.
    Mean,
    /// Root of the mean square.
    RootMeanSquare,
}

impl Norm {
    pub fn of(self, deviations: &[f64]) -> f64 {
        let mean = |of: fn(f64) -> f64| deviations.iter().copied().map(of).sum::<f64>() / deviations.len() as f64;
        match self {
            Norm::Mean => mean(f64::abs),
            Norm::RootMeanSquare => mean(|deviation| deviation * deviation).sqrt(),
        }
    }
}

/// What a case runs.
pub struct Trials {
    /// What the error is, as precisely as words can, for the reader of the table.
    pub about: String,
    /// The label of its axis.
    pub error: String,
    /// Without that of a plan without any wish, which every case has.
    pub settings: Vec<Setting>,
    /// If a plan without any wish takes more particles it has this many.
    pub most_particles: u64,
    /// m3, of the gas that occupancy and step are of; `None`: of the plan's mean state at the end.
    pub volume: Option<f64>,
    pub model: Build,
    pub judge: Judge,
    pub norm: Norm,
}

impl Trials {
    /// The methods among the settings, in the order of their first mention.
    pub fn methods(&self) -> Vec<Method> {
        let mut found = Vec::new();
        for method in self.settings.iter().filter_map(|setting| setting.method) {
            if !found.contains(&method) {
                found.push(method);
            }
        }
        found
    }

    /// The setting of a plan without any wish, and the particles that it would take if they are too many here.
    ///
    /// # Errors
    /// If there is no such plan.
    pub fn unwished(&self) -> Result<(Setting, Option<u64>), StudyError> {
        let wanted = (self.model)(&Setting::default(), 0)?.plan.particles;
        if wanted <= self.most_particles {
            return Ok((Setting::default(), None));
        }
        Ok((Setting { particles: Some(self.most_particles), ..Setting::default() }, Some(wanted)))
    }
}
