//! Flows: a hole, tubes with jumps, a jet.

use crate::gas::{CONTINUUM_COEFFICIENT, coefficient_into_vacuum, kinetics};
use crate::gpu::Device;
use crate::plan::PER_CELL;
use crate::scene::{DiameterCap, Jet, JetSpeed, Method};
use crate::simulation::{Model, Options};
use crate::study::StudyError;
use crate::study::verify::equilibrium::temperatures;
use crate::study::verify::filling::{energy_error, enthalpy};
use crate::study::verify::holes::{RADIUS, VOLUME, discharge_of, emptying_scene};
use crate::study::verify::piston::{Piston, on_piston, shock_pressure};
use crate::study::verify::statistics::{error_of_hits, mean_of_series};
use crate::study::verify::tube::{SOD, Tube};
use crate::study::verify::{Check, Run, model_from, run, scene_of};
use crate::subdomain::GpuParticle;

use super::Effort;
use super::at_rest::{BLOCKS, PRESSURE, TEMPERATURES, of_any};

/// What guards allow a resolved hole (docs/explanation/method.md, "What the plan decides, and why").
pub(super) const FLOW: f64 = 0.07;
/// At 160,000 particles, and how it falls with their number (docs/reference/accuracy.md: .024, as N^-.26).
const PROFILE: f64 = 0.024;
/// Of the pressure behind a shock that is a few mean free paths wide, and of its excess.
const ON_PISTON: [f64; 2] = [0.05, 0.2];
/// Intervals of a hole's run at least: its flow is the slope over the rows behind the first two.
const INTERVALS: u32 = 24;
/// Occupancies of holes' runs, the second of rigid spheres.
const USUAL: f64 = 0.12;
const THIN: f64 = 0.03;
/// Of the holes with cells of several edges.
const KNUDSEN_OF_EDGES: f64 = 0.1;
/// rad.
const CONE: f64 = 0.2;

pub(super) fn knudsen(device: &Device, method: Method, knudsen: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    // Enough for noise, and so many that the gas is no denser than plans make it.
    let [least, most] = match effort {
        Effort::Quick => [4000, 4000],
        Effort::Usual => [8000, 64_000],
        Effort::Full => [64_000, 512_000],
    };
    let occupancy = if method == Method::HardSphere { THIN } else { USUAL };
    let path_over_spacing = kinetics::mean_free_path_over_spacing(occupancy);
    let resolving = VOLUME * (path_over_spacing / (knudsen * RADIUS)).powi(3);
    let particles = if method == Method::None { least } else { (resolving as u64).clamp(least, most) };
    let path = (method != Method::None).then_some(knudsen * RADIUS);
    let model = hole(method, particles, path)?;
    through_hole(device, &model, "flow, Cd over that of a continuum", CONTINUUM_COEFFICIENT)
}

/// Holes of one Knudsen number, of as many particles as make the cells so many free paths long: against the flow that forecasts say.
pub(super) fn cell_edge(device: &Device, method: Method, edge: f64, _: Effort) -> Result<Vec<Check>, StudyError> {
    let model = hole_of_edge(method, edge)?;
    let expected = coefficient_into_vacuum(KNUDSEN_OF_EDGES * kinetics::viscosity_of_cells(edge));
    through_hole(device, &model, "flow, Cd over that of forecasts", expected)
}

fn hole_of_edge(method: Method, edge: f64) -> Result<Model, StudyError> {
    let path = KNUDSEN_OF_EDGES * RADIUS;
    // A cell is that of the gas at the end, when it has all the room.
    let room: f64 = hole(method, 1000, None)?.plan.chambers.iter().map(|chamber| chamber.volume).sum();
    let particles = PER_CELL * room / (edge * path).powi(3);
    hole(method, particles as u64, Some(path))
}

fn through_hole(device: &Device, model: &Model, what: &str, expected: f64) -> Result<Vec<Check>, StudyError> {
    let run = run(device, model, Options::default())?;
    let (found, error) = discharge_of(&run.rows);
    let mut checks = of_any(model, &run);
    checks.push(Check::of(what, 1.0, (found / expected, error / expected), FLOW));
    Ok(checks)
}

/// Gas with this mean free path at the start, and a hole.
pub(super) fn hole(method: Method, particles: u64, path: Option<f64>) -> Result<Model, StudyError> {
    let mut scene = emptying_scene()?;
    scene.model.method = Some(method);
    scene.model.particles = Some(particles);
    if let Some(path) = path {
        scene.model.diameter = Some(kinetics::diameter_of_path(particles as f64 / VOLUME, path));
        // The Knudsen number is that of the gas that stays, which is denser than the mean.
        scene.model.diameter_cap = Some(DiameterCap::Off);
    }
    let mut model = model_from("orifice", scene)?;
    // A row is of whole intervals: of long steps there are few.
    let steps = (model.plan.estimated_steps / f64::from(INTERVALS)) as u32;
    model.plan.steps_per_interval = steps.clamp(1, model.plan.steps_per_interval);
    model.plan.tally_every = model.plan.tally_every.min(model.plan.steps_per_interval);
    Ok(model)
}

/// Of the pressure behind a shock, both over that before it.
fn allowed_behind(pressure: f64) -> f64 {
    (ON_PISTON[0] * pressure).min(ON_PISTON[1] * (pressure - 1.0))
}

pub(super) fn wall_speed(
    device: &Device,
    method: Method,
    speed: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    let particles = match effort {
        Effort::Quick => 4000,
        // At twice c0 20,000 know the pressure to half of what it is allowed.
        Effort::Usual => 24_000,
        Effort::Full => 64_000,
    };
    let piston = Piston::shock(particles, speed).by(method);
    let model = piston.model()?;
    let run = run(device, &model, Options::default())?;
    let (found, error) = on_piston(&piston, &run);
    let expected = shock_pressure(speed);
    let allowed = allowed_behind(expected);
    let mut checks = of_any(&model, &run);
    checks.push(Check::of("pressure on the piston over p1", expected, (found, error), allowed));
    Ok(checks)
}

/// Of the densities of the exact solution: what a profile is off grows with its jumps.
fn range(tube: &Tube) -> f64 {
    let exact = tube.exact();
    let densities = (-300..=300).filter_map(|k| exact.as_ref().map(|exact| exact.at(f64::from(k) / 50.0).density));
    let (low, high) = densities.fold((f64::INFINITY, 0.0), |(low, high): (f64, f64), d| (low.min(d), high.max(d)));
    high - low
}

/// Where the front of a tube's right wave is at the end, over the tube's length from its middle.
const FRONT: f64 = 0.4;

/// Momentum that the gas of the right has got from that of the left, over (p - p_right) t of the exact solution, p its
/// pressure between the waves; and its standard error, that of as many velocities at the temperature behind the shock.
/// Momentum is kept in all collisions, so whatever the methods make of the gas, this is what the one side did to the other.
fn push(tube: &Tube, model: &Model, particles: &[GpuParticle]) -> Option<(f64, f64)> {
    let exact = tube.exact()?;
    let (pressure, velocity) = exact.between_waves()?;
    let [right_pressure, right_temperature] = tube.right;
    // In the units of the left: half of the tube is of the right.
    let expected = (pressure - right_pressure) * tube.end / (0.5 * right_pressure / right_temperature);
    let shocked = exact.at(velocity + 1e-9);
    let of_left = model.plan.chambers[0].particles.iter().sum::<u64>();
    let pushed = particles.iter().filter(|particle| u64::from(particle.id()) >= of_left);
    let (mut sum, mut count) = (0.0, 0.0);
    for particle in pushed {
        sum += f64::from(particle.velocity[0]) / tube.speed();
        count += 1.0;
    }
    (count > 0.0).then(|| (sum / count / expected, (shocked.pressure / shocked.density / count).sqrt() / expected))
}

fn tube(device: &Device, method: Method, right: [f64; 2], effort: Effort) -> Result<Vec<Check>, StudyError> {
    let particles = match effort {
        Effort::Quick => 4000,
        Effort::Usual => 40_000,
        Effort::Full => 160_000,
    };
    let mut tube = Tube { particles, right, end: 0.15, ..SOD };
    let exact = tube.exact();
    if let Some(front) = exact.and_then(|exact| exact.right_front()) {
        tube.end = tube.end.min(FRONT / front);
    }
    let mut scene = tube.scene()?;
    scene.model.method = Some(method);
    let model: Model = model_from("tube", scene)?;
    let run: Run = run(device, &model, Options::default())?;
    let found = &run.outcome.particles;
    let density = tube.errors(&model, tube.end, found).map_or(f64::NAN, |[density, _]| density);
    let mut checks = of_any(&model, &run);
    let allowed = PROFILE * (particles as f64 / 160_000.0).powf(-0.26) * range(&tube) / range(&SOD);
    checks.push(Check::of("density profile", 0.0, (density, tube.noise(&model)), allowed));
    let pressure = exact.and_then(|exact| exact.between_waves()).map_or(f64::NAN, |(pressure, _)| pressure) / right[0];
    let allowed = allowed_behind(pressure) / (pressure - 1.0);
    let pushed = push(&tube, &model, found).unwrap_or((f64::NAN, f64::NAN));
    checks.push(Check::of("push on the right, of the exact one", 1.0, pushed, allowed));
    Ok(checks)
}

pub(super) fn density_ratio(
    device: &Device,
    method: Method,
    ratio: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    tube(device, method, [1.0 / ratio, 1.0], effort)
}

pub(super) fn temperature_ratio(
    device: &Device,
    method: Method,
    ratio: f64,
    effort: Effort,
) -> Result<Vec<Check>, StudyError> {
    tube(device, method, [1.0 / ratio, 1.0 / ratio], effort)
}

/// Of the box into which a jet blows, m; s until the jet has ended, and until the end.
const BOX: f64 = 0.1;
const BLOWN: f64 = 1e-3;
const AT_REST: f64 = 5e-3;
/// Share of the time that is judged, the last of it.
const JUDGED: f64 = 0.4;
/// K of the jet's gas at rest; kg/s at its strongest: with .0008 s of it the gas of the start once more.
const STAGNATION: f64 = 600.0;
const STRONGEST: f64 = 1.4;

/// A closed box into which a jet blows as much gas as was in it. What it has become when it is at rest again depends on
/// no Mach number: energy is U0 and the enthalpy that came in (docs/reference/accuracy.md: 1e-4), p V of it 2/(3 + zeta), and spin
/// has its share.
pub(super) fn mach(device: &Device, method: Method, mach: f64, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let particles = match effort {
        Effort::Quick => 1000,
        Effort::Usual => 4000,
        Effort::Full => 30_000,
    };
    let rows = 20;
    let half = 0.5 * BOX;
    let text = format!(
        "end_time = {AT_REST:e}\n[[gas]]\nname = \"gas\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{BOX}, {BOX}, {BOX}]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"gas\"\n\
         [[orifice]]\nname = \"jet\"\nposition = [0.0, {half}, {half}]\ndirection = [1.0, 0.0, 0.0]\narea = 1e-3\n\
         gas = \"gas\"\ntemperature = {STAGNATION:.1}\n\
         mass_flow = [[0.0, 0.0], [{rise:e}, {STRONGEST}], [{fall:e}, {STRONGEST}], [{BLOWN:e}, 0.0]]\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = {particles}\n[output]\nrows = {rows}\nsnapshots = {snapshots}\n",
        rise = 0.2 * BLOWN,
        fall = 0.8 * BLOWN,
        snapshots = 8 * rows,
    );
    let mut scene = scene_of("jet", &text)?;
    scene.model.method = Some(method);
    for orifice in &mut scene.orifices {
        orifice.jet = Some(Jet { speed: JetSpeed::Mach(mach), cone_angle: CONE });
    }
    let model = model_from("jet", scene)?;
    let run = run(device, &model, Options::default())?;
    let brought = enthalpy(&model) * run.outcome.audit.mass_injected;
    let mut checks = of_any(&model, &run);
    checks.retain(|check| check.quantity != "energy");
    checks.insert(0, Check::of("energy", 0.0, (energy_error(&run, brought), 0.0), 1e-4));
    let late = |time: f64| time > (1.0 - JUDGED) * AT_REST;
    let (mut pressure, mut duration, mut hits) = (0.0, 0.0, 0);
    for row in run.rows.iter().filter(|row| late(row.window[0])) {
        let length = row.window[1] - row.window[0];
        pressure += length * row.surfaces[0].pressure;
        duration += length;
        hits += row.surfaces[0].hits;
    }
    let ratio = pressure / duration * BOX.powi(3) / (0.4 * run.outcome.audit.energy_end);
    checks.push(Check::of("pressure, p V/((gamma - 1) U)", 1.0, (ratio, ratio * error_of_hits(hits as f64)), PRESSURE));
    let spin = |particles: &[GpuParticle]| {
        let [translation, spin] = temperatures(particles, 0, 1.0);
        spin / translation
    };
    let found: Vec<f64> =
        run.snapshots.iter().filter(|(time, _)| late(*time)).map(|(_, particles)| spin(particles)).collect();
    let mean = if found.is_empty() { (f64::NAN, f64::NAN) } else { mean_of_series(&found, BLOCKS.min(found.len())) };
    checks.push(Check::of("equipartition, T_int/T_tr", 1.0, mean, TEMPERATURES));
    Ok(checks)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the map shows to hold is not warned of, and what it shows to fail is (`ThinGas` in `plan/limits.rs`).
    #[test]
    fn the_guard_of_thin_gas_lies_between_what_holds_and_what_fails() {
        let warning = |ratio: f64| {
            let tube = Tube { particles: 40_000, right: [1.0 / ratio, 1.0], end: 0.15, ..SOD };
            tube.model().unwrap().plan.warnings.into_iter().find(|warning| warning.contains("chamber's size"))
        };
        assert!(warning(10.0).is_none());
        assert!(warning(30.0).unwrap().contains("size 0.3433"));
        assert!(warning(100.0).unwrap().contains("size 1.118"));
    }

    /// Sod's gas of the right, by the published solution: (.30313 - .1) .2/(.125/2) is what it moves with on average.
    #[test]
    fn the_push_is_over_that_of_the_exact_solution() {
        let tube = Tube { particles: 1000, ..SOD };
        let model = tube.model().unwrap();
        let of_left = model.plan.chambers[0].particles.iter().sum::<u64>() as u32;
        let particle = |id: u32| GpuParticle {
            position: [0; 3],
            tag: GpuParticle::tag(0, id),
            velocity: [if id < of_left { -1e6 } else { (0.650_02 * tube.speed()) as f32 }, 0.0, 0.0],
            spin: 0.0,
        };
        let particles: Vec<GpuParticle> = (0..1000).map(particle).collect();
        let (found, error) = push(&tube, &model, &particles).unwrap();
        assert!((found - 1.0).abs() < 1e-4, "{found}");
        // sqrt(T/n)/.65, T = .30313/.26557.
        let count = f64::from(1000 - of_left);
        assert!((error - (1.14143 / count).sqrt() / 0.650_02).abs() < 1e-4, "{error}");
        assert!((97.0..130.0).contains(&count), "{count}");
        assert!(push(&tube, &model, &particles[..of_left as usize]).is_none());
    }

    /// Sod's densities run from .125 to 1; against cold gas of the same density a shock piles up several times it.
    #[test]
    fn the_range_is_that_of_the_exact_solution() {
        assert!((range(&SOD) - 0.875).abs() < 1e-3);
        let strong = range(&Tube { right: [0.01, 0.01], ..SOD });
        assert!((3.0..6.0).contains(&strong), "{strong}");
    }

    /// The number of particles follows from the room of the gas, and a plan's grid from both.
    #[test]
    fn cells_before_a_hole_have_their_edge() {
        let edge = |edge| hole_of_edge(Method::Cell, edge).unwrap().plan.grid.cell / (KNUDSEN_OF_EDGES * RADIUS);
        for wanted in [4.2, 7.0] {
            assert!((edge(wanted) / wanted - 1.0).abs() < 1e-3, "{}, not {wanted}", edge(wanted));
        }
        // The check can fail: plans make cells at least as long as the free path of the end.
        assert!(edge(3.0) > 4.0);
    }
}
