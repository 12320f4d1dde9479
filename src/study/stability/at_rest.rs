//! Gas at rest, of which laws know most: p = n k T, one temperature, the collision rate.

use std::f64::consts::PI;

use crate::gas::kinetics::{collision_time, rigid_compressibility};
use crate::gpu::Device;
use crate::plan::{Quantity, limit};
use crate::scene::{Method, Shape};
use crate::simulation::{Model, Options, audit_limits};
use crate::study::StudyError;
use crate::study::verify::collisions::{pressure_in, virial_error_of_cells, watched};
use crate::study::verify::equilibrium::temperatures;
use crate::study::verify::gas_box::{EDGE, EquilibriumBox, TEMPERATURE};
use crate::study::verify::statistics::mean_of_series;
use crate::study::verify::{Check, Run, model_from, scene_of};

use super::{Effort, ROUNDS};

/// Allowed of p over n k T and of the collision rate, relative (method.md, "Collisions": .5 % and 1.5 %, and 3 %
/// lost), and of temperatures that should be one.
pub(super) const PRESSURE: f64 = 0.01;
const RATE: f64 = 0.03;
pub(super) const TEMPERATURES: f64 = 0.02;
/// Stretches of a series for its standard error.
pub(super) const BLOCKS: usize = 6;

/// Particles and collisions of each.
fn size(effort: Effort) -> (u64, f64) {
    match effort {
        Effort::Quick => (1000, 40.0),
        Effort::Usual => (2000, 150.0),
        Effort::Full => (8000, 300.0),
    }
}

/// Thinner for rigid spheres, whose pressure is another matter.
fn usual_occupancy(method: Method) -> f64 {
    if method == Method::HardSphere { 0.03 } else { 0.1 }
}

fn rigid_pressure() -> f64 {
    rigid_compressibility(usual_occupancy(Method::HardSphere))
}

fn base(method: Method, effort: Effort) -> EquilibriumBox<'static> {
    let (particles, _) = size(effort);
    EquilibriumBox {
        method: method.name(),
        particles,
        occupancy: usual_occupancy(method),
        step_over_tau: 0.2,
        rounds: ROUNDS,
        ..EquilibriumBox::default()
    }
}

/// As many steps as give each particle so many collisions.
pub(super) fn lasting(gas: EquilibriumBox<'_>, collisions: f64) -> EquilibriumBox<'_> {
    EquilibriumBox { steps: (collisions / gas.step_over_tau).ceil().max(60.0) as u32, ..gas }
}

/// What every run can be judged by: energy, tightness of the walls, lost collisions.
pub(super) fn of_any(model: &Model, run: &Run) -> Vec<Check> {
    let audit = &run.outcome.audit;
    let bound = |quantity| limit(quantity, model.plan.method).map_or(f64::NAN, |limit| limit.bound.value());
    let limits = audit_limits(&model.plan);
    // In allowances, so that neither hides the other; a particle outside is beyond all.
    let tight = (audit.wall_overshoot / limits.wall_overshoot).max(2.0 * audit.particles_outside as f64);
    let tight = if audit.truncated_flights > 0 { tight.max(2.0) } else { tight };
    let mut checks = vec![
        Check::of("energy", 0.0, (audit.energy_error(), 0.0), bound(Quantity::EnergyDrift)),
        Check::of("wall tightness", 0.0, (tight, 0.0), 1.0),
    ];
    if let Some(lost) = audit.lost_collision_fraction {
        let events = (run.outcome.collisions as f64 / f64::from(model.plan.steps_per_interval)).max(1.0);
        let error = (lost * (1.0 - lost) / events).sqrt();
        checks.push(Check::of("lost collisions", 0.0, (lost, error), bound(Quantity::LostCollisions)));
    }
    checks
}

/// Gas at rest, and what is known of it.
struct RestingBox<'a> {
    gas: &'a EquilibriumBox<'a>,
    /// Of each gas over the heaviest.
    masses: &'a [f64],
    /// p over n k T expected of rigid spheres.
    rigid: f64,
    /// The step stays the plan's.
    hold_step: bool,
}

fn findings(device: &Device, mut model: Model, rest: &RestingBox<'_>) -> Result<Vec<Check>, StudyError> {
    let &RestingBox { gas, masses, rigid, hold_step } = rest;
    let margin = gas.wall_layer();
    let core = |x: &f64| *x >= margin && *x <= EDGE - margin;
    let (mut visits, mut ends, mut time) = (0u64, 0u64, 0.0);
    let mut states: Vec<Vec<[f64; 2]>> = Vec::new();
    let counts = gas.method == "closest-approach" && masses.len() == 1 && margin < 0.4 * EDGE;
    let run = watched(device, &mut model, Options { hold_step, ..Options::default() }, |model, particles, flights| {
        if counts {
            for (particle, (_, flight)) in particles.iter().zip(flights) {
                if model.plan.grid.to_metres(particle.position).iter().all(core) {
                    visits += 1;
                    ends += u64::from(flight.collided());
                }
            }
        }
        let of_gas = |(index, &mass): (usize, &f64)| temperatures(particles, index as u8, mass);
        states.push(masses.iter().enumerate().map(of_gas).collect());
        time += 1.0;
    })?;
    let mut checks = of_any(&model, &run);
    let pressure = pressure_in(&model, gas, &run.rows[0]);
    let error = match model.plan.method {
        Method::Cell => pressure.error.hypot(virial_error_of_cells(gas)),
        Method::HardSphere => pressure.of_hits,
        _ => pressure.error,
    };
    let expected = if model.plan.method == Method::HardSphere { rigid } else { 1.0 };
    checks.push(Check::of("pressure, p/nkT", expected, (pressure.ratio, error), PRESSURE * expected));
    // The first quarter is the way to where the method has it.
    let late = &states[states.len() / 4..];
    let sum = |state: &[[f64; 2]], k: usize| state.iter().map(|own| own[k]).sum::<f64>();
    let spin: Vec<f64> = late.iter().map(|state| sum(state, 1) / sum(state, 0)).collect();
    let blocks = BLOCKS.min(spin.len());
    checks.push(Check::of("equipartition, T_int/T_tr", 1.0, mean_of_series(&spin, blocks), TEMPERATURES));
    if masses.len() == 2 {
        let ratio: Vec<f64> = late.iter().map(|state| state[0][0] / state[1][0]).collect();
        checks.push(Check::of("equipartition, T1/T2", 1.0, mean_of_series(&ratio, blocks), TEMPERATURES));
    }
    let temperature = run.rows[0].chambers[0].temperature / TEMPERATURE;
    let gbar = (16.0 / PI * temperature).sqrt() * gas.thermal_speed();
    let density = (gas.particles - 1) as f64 / EDGE.powi(3);
    let expected = density * PI * model.plan.diameter.powi(2) * gbar * gas.time_step();
    if ends > 0 {
        let rate = ends as f64 / visits as f64 / expected;
        checks.push(Check::of("collision rate", 1.0, (rate, rate * (2.0 / ends as f64).sqrt()), RATE));
    } else if model.plan.method == Method::Cell && masses.len() == 1 {
        let rate = 2.0 * run.outcome.collisions as f64 / (gas.particles as f64 * time) / expected;
        let error = rate / (run.outcome.collisions as f64).sqrt();
        checks.push(Check::of("collision rate", 1.0, (rate, error), RATE));
    }
    Ok(checks)
}

/// One gas in its box, the step held.
pub(super) fn at_rest(device: &Device, gas: &EquilibriumBox<'_>, rigid: f64) -> Result<Vec<Check>, StudyError> {
    findings(device, gas.model()?, &RestingBox { gas, masses: &[1.0], rigid, hold_step: true })
}

pub(super) fn time_step(device: &Device, method: Method, x: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let gas = EquilibriumBox { step_over_tau: x, ..base(method, effort) };
    at_rest(device, &lasting(gas, size(effort).1), rigid_pressure())
}

pub(super) fn rounds(device: &Device, method: Method, rounds: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let gas = EquilibriumBox { rounds: rounds as u32, ..base(method, effort) };
    at_rest(device, &lasting(gas, size(effort).1), rigid_pressure())
}

/// Here rigid spheres are judged as a gas.
pub(super) fn occupancy(device: &Device, method: Method, f: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let gas = EquilibriumBox { occupancy: f, ..base(method, effort) };
    at_rest(device, &lasting(gas, size(effort).1), 1.0)
}

pub(super) fn particles(device: &Device, method: Method, count: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let (usual, collisions) = size(effort);
    let gas = EquilibriumBox { particles: count as u64, step_over_tau: 0.4, ..base(method, effort) };
    // As many collisions in all, within bounds.
    let longer = (usual as f64 / count).clamp(0.5, 20.0);
    at_rest(device, &lasting(gas, collisions * longer), rigid_pressure())
}

/// A box that is a slit: `width` diameters high.
pub(super) fn gap(device: &Device, method: Method, width: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let gas = lasting(base(method, effort), size(effort).1);
    // n pi sigma^3 / 6 = f at a height of `width` sigma.
    let diameter = EDGE * (6.0 * gas.occupancy * width / (PI * gas.particles as f64)).sqrt();
    let height = width * diameter;
    let mut scene = scene_of("slit", &gas.toml())?;
    for wall in &mut scene.walls {
        if let Shape::Box { max, .. } = &mut wall.shape {
            max[2] = height;
        }
    }
    let density = gas.particles as f64 / (EDGE * EDGE * height);
    let step = gas.step_over_tau * collision_time(density, diameter, gas.thermal_speed().powi(2));
    scene.model.time_step = Some(step);
    scene.end_time = step * f64::from(gas.steps);
    let rest = RestingBox { gas: &gas, masses: &[1.0], rigid: rigid_pressure(), hold_step: true };
    let checks = findings(device, model_from("slit", scene)?, &rest)?;
    // Pairs do not meet behind walls, and there are many: their rate is no longer that of free space.
    Ok(checks.into_iter().filter(|check| check.quantity != "collision rate").collect())
}

pub(super) fn mass_ratio(
    device: &Device,
    method: Method,
    ratio: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    let mean = 0.028;
    let light = 2.0 * mean / (1.0 + ratio);
    let gases = format!(
        "[[gas]]\nname = \"light\"\nmolar_mass = {light:e}\ngamma = 1.4\n\
         [[gas]]\nname = \"heavy\"\nmolar_mass = {:e}\ngamma = 1.4\n",
        ratio * light
    );
    let gas = EquilibriumBox { gases: &gases, mixture: "{ light = 0.5, heavy = 0.5 }", ..base(method, effort) };
    // Gases of unlike masses take as much longer to agree.
    let longer = (0.5 * ratio.sqrt()).clamp(1.0, 4.0);
    let gas = lasting(gas, longer * size(effort).1);
    // Steps follow the light gas, as in any run.
    let masses = [1.0 / ratio, 1.0];
    let rest = RestingBox { gas: &gas, masses: &masses, rigid: rigid_pressure(), hold_step: false };
    findings(device, gas.model()?, &rest)
}
