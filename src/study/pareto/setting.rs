//! What is varied: method, particles, occupancy, step and rounds; and how a case's scene is made to have them.

use std::fmt;

use crate::gas::kinetics;
use crate::plan::Plan;
use crate::scene::{DiameterCap, Method, Scene};
use crate::simulation::Model;
use crate::study::StudyError;
use crate::study::verify::model_from;

/// Of what is `None` the plan decides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Setting {
    pub method: Option<Method>,
    pub particles: Option<u64>,
    pub occupancy: Option<f64>,
    /// x = dt/tau. What is asked for is kept: the ladder, which otherwise shortens a step beyond the method's limit, only
    /// keeps particles from flying farther than a cell.
    pub step: Option<f64>,
    pub rounds: Option<u32>,
}

impl fmt::Display for Setting {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.method.map_or("the default", Method::name))?;
        if let Some(particles) = self.particles {
            write!(out, ", N = {particles}")?;
        }
        for (name, value) in [("f", self.occupancy), ("x", self.step)] {
            if let Some(value) = value {
                write!(out, ", {name} = {value}")?;
            }
        }
        if let Some(rounds) = self.rounds {
            write!(out, ", R = {rounds}")?;
        }
        Ok(())
    }
}

/// Every combination of these.
pub struct Range<'a> {
    pub method: Method,
    pub particles: &'a [u64],
    pub occupancies: &'a [f64],
    pub steps: &'a [f64],
    pub rounds: &'a [u32],
}

impl<'a> Range<'a> {
    pub const fn new(
        method: Method,
        particles: &'a [u64],
        occupancies: &'a [f64],
        steps: &'a [f64],
        rounds: &'a [u32],
    ) -> Range<'a> {
        Range { method, particles, occupancies, steps, rounds }
    }

    /// An empty list leaves the plan to decide.
    pub fn settings(&self) -> Vec<Setting> {
        fn or_plan<T: Copy>(list: &[T]) -> Vec<Option<T>> {
            if list.is_empty() { vec![None] } else { list.iter().copied().map(Some).collect() }
        }
        let mut settings = Vec::new();
        for particles in or_plan(self.particles) {
            for occupancy in or_plan(self.occupancies) {
                for step in or_plan(self.steps) {
                    for rounds in or_plan(self.rounds) {
                        settings.push(Setting { method: Some(self.method), particles, occupancy, step, rounds });
                    }
                }
            }
        }
        settings
    }
}

/// The scene with the setting in it. Occupancy and x are those of all particles in `volume` (m3), or without it of the
/// plan's mean state at the end of the run.
///
/// # Errors
/// If no plan can be made for it.
pub fn model_with(case: &str, mut scene: Scene, setting: &Setting, volume: Option<f64>) -> Result<Model, StudyError> {
    scene.model.method = setting.method;
    scene.model.particles = setting.particles;
    scene.model.rounds = setting.rounds;
    match (setting.occupancy, setting.particles, volume) {
        (Some(occupancy), Some(particles), Some(volume)) => {
            scene.model.diameter = Some(kinetics::diameter(particles as f64 / volume, occupancy));
            scene.model.diameter_cap = Some(DiameterCap::Off);
        }
        (occupancy, _, _) => scene.model.occupancy = occupancy,
    }
    let model = model_from(case, scene.clone())?;
    let Some(step) = setting.step else { return Ok(model) };
    scene.model.time_step = Some(step * collision_time(&model.plan, volume));
    let mut model = model_from(case, scene)?;
    model.plan.collision_limit = f64::INFINITY;
    Ok(model)
}

/// tau of the particles of the run in `volume`, or of the plan's mean state at the end; infinite without collisions.
pub fn collision_time(plan: &Plan, volume: Option<f64>) -> f64 {
    let count: u64 = plan.gases.iter().map(|gas| gas.particles).sum();
    let molar_mass = plan.gases.iter().map(|gas| gas.molar_mass * gas.particles as f64).sum::<f64>() / count as f64;
    let thermal_square = kinetics::thermal_square(plan.temperature_reference, molar_mass);
    // lambda is cbar tau.
    plan.mean_free_path / kinetics::mean_speed(thermal_square) / denser(plan, volume)
}

/// How many times denser all particles are in `volume` than in all the gas volume.
pub fn denser(plan: &Plan, volume: Option<f64>) -> f64 {
    let all: f64 = plan.chambers.iter().map(|chamber| chamber.volume).sum();
    volume.map_or(1.0, |volume| all / volume)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::verify::tube::SOD;

    #[test]
    fn a_range_has_every_combination_and_leaves_the_rest_to_the_plan() {
        let range = Range {
            method: Method::Cell,
            particles: &[1000, 2000],
            occupancies: &[0.1, 0.2, 0.3],
            steps: &[0.5],
            rounds: &[],
        };
        let settings = range.settings();
        assert_eq!(settings.len(), 6);
        assert!(settings.iter().all(|setting| setting.rounds.is_none() && setting.step == Some(0.5)));
        let distinct = |a: usize| settings[..a].iter().all(|other| *other != settings[a]);
        assert!((0..6).all(distinct));
    }

    /// x and f are those asked for, by the definitions of docs/explanation/method.md.
    #[test]
    fn a_model_has_the_occupancy_and_the_step_of_its_setting() {
        let setting = Setting {
            method: Some(Method::ClosestApproach),
            particles: Some(5000),
            occupancy: Some(0.2),
            step: Some(0.3),
            rounds: Some(2),
        };
        let plan = model_with("tube", SOD.scene().unwrap(), &setting, None).unwrap().plan;
        assert!((plan.occupancy - 0.2).abs() < 1e-3 && plan.rounds == 2 && plan.particles == 5000);
        let density = 5000.0 / 0.01;
        let thermal = kinetics::thermal_square(plan.temperature_reference, 0.028);
        let tau = kinetics::collision_time(density, plan.diameter, thermal);
        // The step divides the end time.
        assert!((plan.time_step / tau - 0.3).abs() < 0.01, "{}", plan.time_step / tau);
        // In half of the volume they are twice as dense.
        let half = model_with("tube", SOD.scene().unwrap(), &setting, Some(0.005)).unwrap().plan;
        assert!((half.occupancy - 0.1).abs() < 1e-3 && (denser(&half, Some(0.005)) - 2.0).abs() < 1e-3);
        let tau = kinetics::collision_time(2.0 * density, half.diameter, thermal);
        assert!((half.time_step / tau - 0.3).abs() < 0.01, "{}", half.time_step / tau);
    }

    /// Without a wish a run has the plan of the scene, its limits included.
    #[test]
    fn without_a_wish_the_plan_decides() {
        let plan = model_with("tube", SOD.scene().unwrap(), &Setting::default(), None).unwrap().plan;
        assert_eq!(plan.method, Method::HalfTurn);
        assert!(plan.collision_limit.is_finite());
        let mut wishless = SOD.scene().unwrap();
        (wishless.model.method, wishless.model.particles) = (None, None);
        assert_eq!(plan, model_from("tube", wishless).unwrap().plan);
    }
}
