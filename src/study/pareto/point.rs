//! A setting on the chart: its error and its cost, over one seed or several.

use std::time::Instant;

use crate::gpu::Device;
use crate::output::{AuditLimits, PhaseTable};
use crate::plan::Plan;
use crate::scene::Method;
use crate::simulation::{Model, Options, SimulationError, audit_limits, run_uniform};
use crate::study::StudyError;
use crate::study::verify::{Run, run, statistics::mean_and_error};

use super::{Setting, Trials, collision_time, denser};

/// What the seconds are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Timed {
    /// Timestamps of the device, summed over the phases of all steps.
    Device,
    /// From the first submission to the last result: the device has no timestamps.
    Wall,
    /// Of the host: there is nothing for a device to do.
    Host,
}

impl Timed {
    pub fn name(self) -> &'static str {
        match self {
            Timed::Device => "device",
            Timed::Wall => "wall",
            Timed::Host => "host",
        }
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    pub setting: Setting,
    pub method: Method,
    pub particles: u64,
    /// 0 without collisions, as are rounds and step.
    pub occupancy: f64,
    pub rounds: u32,
    /// x of the mean step taken.
    pub step: f64,
    /// Of each seed; empty if the setting cannot be run, and of the reference itself.
    pub errors: Vec<f64>,
    /// Of the mean over the seeds; `None` with one seed.
    pub error_of_mean: Option<f64>,
    /// s, of each seed.
    pub seconds: Vec<f64>,
    pub timed: Timed,
    /// Of all seeds.
    pub steps: u64,
    pub particle_steps: u64,
    /// The largest share of collisions lost; `None` where none can be.
    pub lost: Option<f64>,
    /// Of the plan and of the runs, each once.
    pub warnings: Vec<String>,
    /// The step is longer than the method's limit, more collisions were lost than it allows, or the audit failed.
    pub beyond: bool,
    /// Why it has no error.
    pub trouble: Option<String>,
    /// It is that of a plan without any wish, but perhaps for the number of particles.
    pub unwished: bool,
}

impl Point {
    pub(super) fn new(setting: &Setting, plan: Option<&Plan>, volume: Option<f64>) -> Point {
        Point {
            setting: *setting,
            method: plan.map(|plan| plan.method).or(setting.method).unwrap_or(Method::ClosestApproach),
            particles: plan.map(|plan| plan.particles).or(setting.particles).unwrap_or(0),
            occupancy: plan.map_or(0.0, |plan| plan.occupancy * denser(plan, volume)),
            rounds: plan.map_or(0, |plan| plan.rounds),
            step: 0.0,
            errors: Vec::new(),
            error_of_mean: None,
            seconds: Vec::new(),
            timed: Timed::Wall,
            steps: 0,
            particle_steps: 0,
            lost: None,
            warnings: plan.map(|plan| plan.warnings.clone()).unwrap_or_default(),
            beyond: false,
            trouble: None,
            unwished: *setting == Setting { particles: setting.particles, ..Setting::default() },
        }
    }

    /// Mean over the seeds.
    pub fn error(&self) -> Option<f64> {
        (!self.errors.is_empty()).then(|| self.errors.iter().sum::<f64>() / self.errors.len() as f64)
    }

    /// Standard error of that mean; `None` with one seed.
    pub fn standard_error(&self) -> Option<f64> {
        (self.errors.len() > 1).then(|| mean_and_error(&self.errors).1)
    }

    /// Median, least and most, s.
    pub fn cost(&self) -> Option<[f64; 3]> {
        let mut sorted = self.seconds.clone();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.len() / 2;
        let (least, most) = (*sorted.first()?, *sorted.last()?);
        let median =
            if sorted.len().is_multiple_of(2) { 0.5 * (sorted[middle - 1] + sorted[middle]) } else { sorted[middle] };
        Some([median, least, most])
    }

    /// (s, error), of what may be on the front: settings within their limits.
    pub fn place(&self) -> Option<[f64; 2]> {
        let place = [self.cost()?[0], self.error()?];
        // A reference has no error, and a logarithm takes none.
        place.iter().all(|value| value.is_finite() && *value > 0.0).then_some(place)
    }

    fn add(&mut self, model: &Model, trials: &Trials, run: &Run, deviations: Option<&[f64]>) {
        let outcome = &run.outcome;
        let limits = audit_limits(&model.plan);
        match deviations.map(|all| trials.norm.of(all)).filter(|error| error.is_finite()) {
            Some(error) => self.errors.push(error),
            None => self.trouble = Some("the run says nothing of the quantity".into()),
        }
        let (seconds, timed) = seconds(&outcome.phases, outcome.stepping_seconds);
        self.seconds.push(seconds);
        self.timed = timed;
        self.steps += outcome.steps;
        self.particle_steps += outcome.particle_steps;
        let mean_step = outcome.time / outcome.steps.max(1) as f64;
        let tau = collision_time(&model.plan, trials.volume);
        self.step = if tau.is_finite() { mean_step / tau } else { 0.0 };
        if let Some(lost) = outcome.audit.lost_collision_fraction {
            self.lost = Some(self.lost.unwrap_or(0.0).max(lost));
        }
        let failures = outcome.audit.verdict(&limits);
        self.beyond |= !failures.is_empty() || self.loses_too_much(&limits);
        for warning in outcome.audit.warnings(&limits).into_iter().chain(failures) {
            if !self.warnings.contains(&warning) {
                self.warnings.push(warning);
            }
        }
    }

    fn loses_too_much(&self, limits: &AuditLimits) -> bool {
        // Where the method has rounds; in a cell nothing is lost.
        self.method.has_rounds() && self.lost.is_some_and(|lost| lost > limits.lost_collision_fraction)
    }
}

/// The sum of the timestamps where the device has them.
fn seconds(phases: &PhaseTable, stepping: f64) -> (f64, Timed) {
    let on_device = phases.seconds();
    if on_device > 0.0 { (on_device, Timed::Device) } else { (stepping, Timed::Wall) }
}

/// Runs the setting with so many seeds. What cannot be planned or stops for the physics' sake is a point without an
/// error, with its reason.
///
/// # Errors
/// If the device fails.
pub fn measure(device: &Device, trials: &Trials, setting: &Setting, repeat: u32) -> Result<Point, StudyError> {
    let mut point: Option<Point> = None;
    // Of the deviations over the seeds.
    let mut sums: Option<Vec<f64>> = Some(Vec::new());
    for seed in 0..u64::from(repeat) {
        let model = match (trials.model)(setting, seed) {
            Ok(model) => model,
            Err(error) => return Ok(failed(point, setting, trials, &error)),
        };
        let point = point.get_or_insert_with(|| {
            let mut point = Point::new(setting, Some(&model.plan), trials.volume);
            point.beyond = exceeds(&model, setting, trials);
            point
        });
        if model.plan.method == Method::ControlVolume {
            let began = Instant::now();
            run_uniform(&model, &mut ())?;
            point.seconds.push(began.elapsed().as_secs_f64());
            point.timed = Timed::Host;
            continue;
        }
        match run(device, &model, Options::default()) {
            Ok(run) => {
                let found = (trials.judge)(&model, &run);
                point.add(&model, trials, &run, found.as_deref());
                sums = added(sums, found);
            }
            Err(error @ StudyError::Simulation(SimulationError::Ladder { .. } | SimulationError::Lost { .. })) => {
                return Ok(failed(Some(point.clone()), setting, trials, &error));
            }
            Err(error) => return Err(error),
        }
    }
    let mut point = point.unwrap_or_else(|| Point::new(setting, None, trials.volume));
    if point.errors.len() > 1 {
        let seeds = f64::from(repeat);
        let mean = |sums: Vec<f64>| trials.norm.of(&sums.iter().map(|sum| sum / seeds).collect::<Vec<f64>>());
        point.error_of_mean = sums.map(mean);
    }
    Ok(point)
}

/// Sums of deviations with those of one seed more; `None` if seeds do not have the same ones.
fn added(sums: Option<Vec<f64>>, more: Option<Vec<f64>>) -> Option<Vec<f64>> {
    let (sums, more) = (sums?, more?);
    if sums.is_empty() {
        return Some(more);
    }
    (sums.len() == more.len()).then(|| sums.iter().zip(&more).map(|(sum, more)| sum + more).collect())
}

fn failed(point: Option<Point>, setting: &Setting, trials: &Trials, error: &StudyError) -> Point {
    let point = point.unwrap_or_else(|| Point::new(setting, None, trials.volume));
    // The mean of some seeds is not that of all.
    Point { errors: Vec::new(), error_of_mean: None, beyond: true, trouble: Some(error.to_string()), ..point }
}

/// Whether the step asked for is beyond the limit of the plan that was not asked for one.
fn exceeds(model: &Model, setting: &Setting, trials: &Trials) -> bool {
    let limit = (trials.model)(&Setting { step: None, ..*setting }, 0).map(|model| model.plan.collision_limit);
    let asked = model.plan.time_step / collision_time(&model.plan, trials.volume);
    // A step divides the end time; that makes it no longer.
    limit.is_ok_and(|limit| setting.step.is_some() && asked > limit * (1.0 + 1e-9))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::pareto::Norm;

    fn point(errors: &[f64], seconds: &[f64]) -> Point {
        Point { errors: errors.to_vec(), seconds: seconds.to_vec(), ..Point::new(&Setting::default(), None, None) }
    }

    #[test]
    fn several_seeds_have_a_mean_an_error_bar_and_a_median() {
        let three = point(&[0.02, 0.03, 0.04], &[3.0, 1.0, 1.5]);
        assert!((three.error().unwrap() - 0.03).abs() < 1e-12);
        // Standard deviation .01 over sqrt(3).
        assert!((three.standard_error().unwrap() - 0.01 / 3f64.sqrt()).abs() < 1e-12);
        assert_eq!(three.cost(), Some([1.5, 1.0, 3.0]));
        assert_eq!(point(&[0.1], &[1.0, 2.0]).cost(), Some([1.5, 1.0, 2.0]));
        assert_eq!(point(&[0.1], &[1.0]).standard_error(), None);
    }

    /// A chart of logarithms has no place for what is no positive number.
    #[test]
    fn what_has_no_error_has_no_place() {
        assert_eq!(point(&[0.1], &[2.0]).place(), Some([2.0, 0.1]));
        for (errors, seconds) in [(&[][..], &[1.0][..]), (&[0.0], &[1.0]), (&[f64::NAN], &[1.0]), (&[0.1], &[])] {
            assert_eq!(point(errors, seconds).place(), None);
        }
    }

    #[test]
    fn seconds_are_the_devices_where_it_tells_them() {
        let phases =
            PhaseTable { rows: vec![("bin".into(), 0.5, 1), ("sort".into(), 0.25, 1)], ..PhaseTable::default() };
        assert_eq!(seconds(&phases, 9.0), (0.75, Timed::Device));
        assert_eq!(seconds(&PhaseTable::default(), 9.0), (9.0, Timed::Wall));
    }

    /// Deviations of opposite signs cancel in the mean over seeds, not in the mean of their errors.
    #[test]
    fn the_error_of_the_mean_is_that_of_the_mean_deviations() {
        let sums = [[0.3, -0.1], [-0.1, -0.1]]
            .into_iter()
            .try_fold(Vec::new(), |sums, of_seed| added(Some(sums), Some(of_seed.to_vec())));
        let mean: Vec<f64> = sums.unwrap().iter().map(|sum| sum / 2.0).collect();
        assert!((Norm::Mean.of(&mean) - 0.1).abs() < 1e-12);
        assert!((Norm::RootMeanSquare.of(&[0.3, -0.1]) - 0.05f64.sqrt()).abs() < 1e-12);
        assert_eq!(added(Some(vec![1.0]), None), None);
        assert_eq!(added(Some(vec![1.0]), Some(vec![1.0, 2.0])), None);
    }

    /// What a plan decides is unwished whatever the number of particles; any other wish is one.
    #[test]
    fn the_default_is_known_by_its_setting() {
        let unwished = |setting: Setting| Point::new(&setting, None, None).unwished;
        assert!(unwished(Setting::default()));
        assert!(unwished(Setting { particles: Some(1000), ..Setting::default() }));
        assert!(!unwished(Setting { rounds: Some(8), ..Setting::default() }));
        assert!(!unwished(Setting { method: Some(Method::Cell), ..Setting::default() }));
    }
}
