//! A sweep as it will be done.

use std::path::PathBuf;

use crate::cli::arguments::SweepArguments;
use crate::scene::Scene;
use crate::study::Strategy;
use crate::study::state::Moment;

/// A sweep as it will be done.
pub(super) struct SweepPlan {
    pub(super) raw: SweepArguments,
    pub(super) scene: Scene,
    pub(super) folder: PathBuf,
    pub(super) devices: Vec<usize>,
    /// Counts that are run.
    pub(super) real: Vec<usize>,
    pub(super) strategies: Vec<Strategy>,
    pub(super) launcher: Vec<String>,
    /// What the runs go on from, in order of time; none: the start of the scene.
    pub(super) moments: Vec<Moment>,
}
