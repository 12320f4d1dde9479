//! A state with more and smaller particles: each is split into `times` children of 1/`times` its mass.
//!
//! The refined run is that of the same scene with `times` the particles, and goes on from the same moment. Of the parents
//! it keeps, in every group of neighbours (`groups`), mass, momentum, kinetic and spin energy; where a child is and how it
//! moves about its group's mean is sampled anew (`places`, `local`). How many particles of each gas a run of the refined
//! scene has at that moment follows from its plan and its inflow; that is not just `times` the parents', by rounding, so
//! a few parents have a child more or less (`lineage`), with the mean energy and momentum of their group.
//!
//! Invariants: children are in the gas and in the chamber of their parent, and no wall lies between them; the draws of a child depend
//! on the seed and its id only; the order and the number of files in which the parents come do not matter.

mod groups;
mod lineage;
mod local;
mod places;
mod report;
mod start;

use super::control::clock::Clock;
use super::control::ladder::LadderError;
use super::model::build::Model;
use super::model::error::ModelError;
use crate::gas::{FlowIntegral, InflowStateError, moles_at, thermo};
use crate::geometry::GeometryError;
use crate::plan::MOST_PARTICLES;
use crate::scene::Scene;
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::run_state::RunState;
use crate::subdomain::GpuParticle;
use groups::groups;
use lineage::Lineage;
use local::Split;
use places::Places;

pub use report::RefineReport;

/// A state from which a run can go on.
pub struct Refined {
    /// Of the same scene with more particles.
    pub model: Model,
    /// By id.
    pub particles: Vec<GpuParticle>,
    pub state: RunState,
    pub report: RefineReport,
}

#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum RefineError {
    #[error("{times} times as many particles is no refinement: expected at least 2")]
    Times { times: u64 },
    #[error("the scene has the vent `{vent}`: particles have left, and which of a refined run would have is unknown")]
    #[diagnostic(help("refine a state of a scene without vents"))]
    Vents { vent: String },
    #[error("the wall `{wall}` moves: the places of children are looked for between walls at rest")]
    #[diagnostic(help("refine a state of a scene without [[motion]]"))]
    Motion { wall: String },
    #[error("the fabric `{fabric}` deforms: the places of children are looked for between walls at rest")]
    #[diagnostic(help("refine a state of a scene without [[fabric]]"))]
    Fabric { fabric: String },
    #[error("{times} times the {particles} particles of the run are more than the {limit} that an id can name")]
    TooMany { times: u64, particles: u64, limit: u64 },
    #[error("the refined scene cannot be planned: {0}")]
    Model(#[source] ModelError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Geometry(#[from] GeometryError),
    #[error(transparent)]
    State(#[from] RunStateError),
    #[error(
        "the particles are of another moment than the state: {found} of gas `{gas}` are there, {expected} had entered"
    )]
    Particles { gas: String, found: u64, expected: u64 },
    #[error("particle {id} is of gas {gas}, the scene has {gases}")]
    UnknownGas { id: u32, gas: u8, gases: usize },
    #[error(
        "no particle of gas `{gas}` had entered by {time:.6} s, and {wanted} of the refined run have: there is nothing to draw them from"
    )]
    #[diagnostic(help("refine a later checkpoint, or one of a run with more particles"))]
    NoParents { gas: String, time: f64, wanted: u64 },
    #[error("the refined state: {0}")]
    Ladder(#[from] LadderError),
}

impl From<InflowStateError> for RefineError {
    fn from(error: InflowStateError) -> RefineError {
        RefineError::State(error.into())
    }
}

/// Splits all particles of a state. `particles` are those of the moment of `state`, in any order.
///
/// # Errors
/// If the state is not of this model, or the refined scene has too many particles or cannot be planned.
pub fn refine(parent: &Model, state: &RunState, particles: &[GpuParticle], times: u64) -> Result<Refined, RefineError> {
    if let Some(motion) = parent.scene.motions.first() {
        return Err(RefineError::Motion { wall: parent.scene.walls[motion.wall].name.clone() });
    }
    if let Some(fabric) = parent.scene.fabrics.first() {
        return Err(RefineError::Fabric { fabric: fabric.name.clone() });
    }
    if let Some(vent) = parent.scene.vents.first() {
        return Err(RefineError::Vents { vent: vent.name.clone() });
    }
    let progress = check(parent, state, particles)?;
    let model = Model::new(refined_scene(parent, times)?).map_err(RefineError::Model)?;
    let clock = Clock::starting_at(&model.plan, progress);
    let mut inflow = model.inflow();
    let newborns = inflow.take_until(clock.time());

    let mut parents = particles.to_vec();
    parents.sort_unstable_by_key(GpuParticle::id);
    let lineage = Lineage::new(&parents, &model.plan, &newborns);
    if let Some((gas, wanted)) = lineage.without_parents() {
        return Err(RefineError::NoParents { gas: model.plan.gases[gas].name.clone(), time: clock.time(), wanted });
    }
    let places = Places::new(parent, &parents)?;
    let split = Split::new(&model.plan, &places, &lineage);
    let (added, dropped) = lineage.rounding(times);
    let mut report = RefineReport {
        time: clock.time(),
        parents: parents.len() as u64,
        particles: lineage.total() as u64,
        added,
        dropped,
        ..RefineReport::default()
    };
    let mut children = vec![GpuParticle::default(); lineage.total()];
    for group in groups(&parents, &places) {
        split.group(&parents, &group, &mut children, &mut report);
    }
    let state = start::state(&model, clock, inflow, state, &children)?;
    Ok(Refined { model, particles: children, state, report })
}

/// The share of the simulated time that is done, if state and particles are of one moment of this model.
fn check(parent: &Model, state: &RunState, particles: &[GpuParticle]) -> Result<f64, RefineError> {
    let plan = &parent.plan;
    let mut clock = Clock::new(plan);
    clock.restore(&state.clock)?;
    let mut inflow = parent.inflow();
    inflow.restore(&state.inflow)?;
    let mut found = vec![0; plan.gases.len()];
    for particle in particles {
        let (id, gas) = (particle.id(), particle.gas());
        let unknown = RefineError::UnknownGas { id, gas, gases: plan.gases.len() };
        *found.get_mut(usize::from(gas)).ok_or(unknown)? += 1;
    }
    for ((gas, (&found, entered)), own) in found.iter().zip(inflow.entered_by_gas()).enumerate().zip(&plan.gases) {
        let expected = entered + plan.chambers.iter().map(|chamber| chamber.particles[gas]).sum::<u64>();
        if found != expected {
            return Err(RefineError::Particles { gas: own.name.clone(), found, expected });
        }
    }
    Ok(clock.progress())
}

/// The scene with `times` the particles.
fn refined_scene(parent: &Model, times: u64) -> Result<Scene, RefineError> {
    if times < 2 {
        return Err(RefineError::Times { times });
    }
    let asked = parent.scene.model.particles.unwrap_or_else(|| shares(parent));
    let limit = MOST_PARTICLES;
    let particles = asked.checked_mul(times).filter(|&particles| particles <= limit);
    let particles = particles.ok_or(RefineError::TooMany { times, particles: asked, limit })?;
    let mut scene = parent.scene.clone();
    scene.model.particles = Some(particles);
    if scene.model.diameter.is_none() {
        // As the spacing of the particles, and with it diameter, free path and cell.
        scene.model.time_step = scene.model.time_step.map(|step| step / libm::cbrt(times as f64));
    }
    Ok(scene)
}

/// Into how many particles the plan has cut the gas of the whole run, where the scene does not say it. (Rounded by
/// chamber and gas there are a few more or less.)
fn shares(model: &Model) -> u64 {
    let Model { scene, plan, .. } = model;
    let chambers = scene.chambers.iter().zip(&plan.chambers);
    let initial = chambers.map(|(asked, own)| moles_at(asked.pressure, own.volume, asked.temperature));
    let injected = scene.orifices.iter().map(|orifice| {
        let molar_mass = thermo::molar_mass(&orifice.mixture, &plan.species());
        FlowIntegral::new(&orifice.mass_flow, scene.end_time).total() / molar_mass
    });
    (initial.chain(injected).sum::<f64>() / plan.moles_per_particle).round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Smaller particles have shorter steps, where the step is written down but not the diameter.
    #[test]
    fn a_step_that_is_written_down_follows_the_spacing() {
        let refined = |keys: &str| {
            let text = include_str!("../../../scenes/box.toml").replace("occupancy = 0.1", keys);
            let scene = crate::scene::parse(&text, "box.toml", std::path::Path::new("")).unwrap();
            refined_scene(&Model::new(scene).unwrap(), 8).unwrap().model
        };
        let step = refined("occupancy = 0.1\ntime_step = 2e-6").time_step.unwrap();
        assert!((step / 1e-6 - 1.0).abs() < 1e-12, "{step}");
        assert_eq!(refined("diameter = 0.003\ntime_step = 2e-6").time_step, Some(2e-6));
        assert_eq!(refined("occupancy = 0.1").time_step, None);
    }
}
