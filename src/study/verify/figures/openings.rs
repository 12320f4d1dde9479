//! Flow through vents that let every hit pass, and through a hole between gases of nearly the same pressure.

use std::f64::consts::PI;
use std::fmt::Write;

use super::figure::figure;
use crate::gas::kinetics;
use crate::gpu::Device;
use crate::scene::Method;
use crate::simulation::{Options, Row};
use crate::study::StudyError;
use crate::study::verify::gas_box::GAS_CONSTANT;
use crate::study::verify::holes::{AREA, VOLUME, emptying_scene, isentropic_speed, set_knudsen, thin_gas_step};
use crate::study::verify::losses::{EDGE, MOLAR_MASS, TEMPERATURE};
use crate::study::verify::witness::model_of;
use crate::study::verify::{Effort, Findings, model_from, run};

/// Diameter of each of six vents, m, and occupancy: with 20,000 particles a mean free path is nine radii long, and longer when some
/// have left, so nothing flows but what flies. (At one radius and a half the slope is .217 +- .003: gas that collides before a
/// hole flows.)
const VENT: f64 = 0.02;
const OCCUPANCY: f64 = 5e-4;

/// The prototype has its rates to .01; so few particles as a quick run has know it to three times that.
const KNOWN: [f64; 2] = [0.03, 0.01];

/// d lnT / d lnN of a cube with a hole of this size in the middle of each face, made of vents that ask for so much that each hit
/// passes.
///
/// What leaves takes 2 kT of translation and kT of spin, a variance of 3 (kT)^2: over n of them the slope errs by 1.2
/// sqrt(3/9)/sqrt(n), and what is left halves.
pub fn constant_probability(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, seeds) = if effort == Effort::Quick { (10_000u64, 1) } else { (20_000, 5) };
    let (low, middle) = (0.0, 0.5 * EDGE);
    let mut vents = String::new();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (side, sign, at) in [("low", "-", low), ("high", "+", EDGE)] {
            let mut position = [middle; 3];
            position[axis] = at;
            let _ = write!(
                vents,
                "[[vent]]\nname = \"{side} {name}\"\nwall = \"box\"\nface = \"{sign}{name}\"\nposition = {position:?}\n\
                 diameter = {VENT}\ndischarge = 10.0\nexternal_pressure = 0.0\n"
            );
        }
    }
    let speed = (8.0 * GAS_CONSTANT * TEMPERATURE / (PI * MOLAR_MASS)).sqrt();
    let rate = speed * 6.0 * 0.25 * PI * VENT * VENT / (4.0 * EDGE.powi(3));
    let (mut slopes, mut left) = (0.0, 0.0);
    for seed in 1..=seeds {
        let text = format!(
            "end_time = {end:e}\nseed = {seed}\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = {MOLAR_MASS}\ngamma = 1.4\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{EDGE}, {EDGE}, {EDGE}]\ngas = \"inside\"\n\
             [[chamber]]\nname = \"all\"\npressure = 200000.0\ntemperature = {TEMPERATURE}\ngas = \"nitrogen\"\n{vents}\
             [model]\nparticles = {particles}\noccupancy = {OCCUPANCY}\n[output]\nrows = 20\nsnapshots = 0\n",
            end = 0.8 / rate,
        );
        let mut model = model_of("leak", &text)?;
        let density = particles as f64 / EDGE.powi(3);
        if let Some(step) = thin_gas_step(model.plan.diameter, density, TEMPERATURE) {
            let mut scene = model.scene;
            scene.model.time_step = Some(step);
            model = model_from("leak", scene)?;
        }
        let run = run(device, &model, Options::default())?;
        let audit = &run.outcome.audit;
        let (before, after) = (audit.particles_initial as f64, audit.particles_inside as f64);
        slopes += (audit.energy_end / after / (audit.energy_start / before)).ln() / (after / before).ln();
        left += before - after;
    }
    let (slope, error) = (slopes / f64::from(seeds), 1.2 * (3.0f64 / 9.0 / left).sqrt());
    let quantity = "d lnT / d lnN, a constant P (prototype .206)".to_owned();
    let known = KNOWN[usize::from(effort == Effort::Full)];
    Ok(vec![figure(quantity, 0.2, (slope, error), known)].into())
}

/// Pressure behind the hole over that before it.
const BEHIND: f64 = 0.8;
/// The prototype's discharge coefficients there by Knudsen number, and particles in the chamber and seeds that know them, in a
/// full run: the second gas has an occupancy of .09. The second is the one that was settled after its first, of too few particles. They are
/// those of a difference that dies down in the run, to .9 and more; of steady flow they are in `src/gas/discharge.rs`.
const SMALL: [(f64, f64, u64, u64); 2] = [(1.0, 0.18, 30_000, 9), (0.1, 0.40, 120_000, 3)];
/// What these are known to, in a quick run of four seeds of the first and in a full one.
const ORIFICES: [f64; 2] = [0.03, 0.02];
const QUICK_SEEDS: u64 = 4;
/// Particles and seeds of a gas with the second Knudsen number by its density, and an occupancy of .34.
const FEW: (u64, u64) = (8000, 5);
/// Particles of a gas with it whose collisions are in cells of a mean free path, and seeds.
const CELLS: (u64, u64) = (1_000_000, 2);
/// Rows that see the flow start.
const STARTING: usize = 2;

/// Net flow through a hole over that of the isentropic law at the pressures of the moment.
///
/// The second is held against what another method finds as well: collisions of random pairs of a cell (direct simulation Monte
/// Carlo), whose particles have no size.
pub fn small_difference(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let full = effort == Effort::Full;
    let known = ORIFICES[usize::from(full)];
    let [(knudsen, expected, particles, seeds), (dense, specified, many, dense_seeds)] = SMALL;
    let seeds = if full { seeds } else { QUICK_SEEDS };
    let found = net_discharge(device, Method::ClosestApproach, knudsen, particles, seeds)?;
    let mut findings =
        Findings::from(vec![figure(format!("Cd at p2/p1 = {BEHIND}, Kn = {knudsen}"), expected, found, known)]);
    if full {
        let (reference, of_reference) = net_discharge(device, Method::Cell, dense, CELLS.0, CELLS.1)?;
        let (found, error) = net_discharge(device, Method::ClosestApproach, dense, many, dense_seeds)?;
        let quantity = format!("Cd at p2/p1 = {BEHIND}, Kn = {dense}");
        findings.checks.push(figure(quantity.clone(), specified, (found, error), known));
        let both = (found, error.hypot(of_reference));
        findings.checks.push(figure(format!("{quantity}, by that of cell"), reference, both, known));
        let (few, of_few) = net_discharge(device, Method::ClosestApproach, dense, FEW.0, FEW.1)?;
        findings.notes.push(format!(
            "At Kn = {dense} two methods agree: closest approach with {many} particles has {found:.3} +- {error:.3}, collisions in \
             cells with {} {reference:.3} +- {of_reference:.3}. With {} spheres closest approach has {few:.3} +- {of_few:.3}: they \
             fill a third of the space, and are more viscous than their Knudsen number says",
            CELLS.0, FEW.0
        ));
    }
    Ok(findings)
}

/// Discharge coefficient of a gas of so many particles in the chamber, and its standard error.
fn net_discharge(
    device: &Device,
    method: Method,
    knudsen: f64,
    particles: u64,
    seeds: u64,
) -> Result<(f64, f64), StudyError> {
    let mut scene = emptying_scene()?;
    scene.model.method = Some(method);
    scene.chambers[1].pressure = BEHIND * scene.chambers[0].pressure;
    set_knudsen(&mut scene, particles as f64 / VOLUME, knudsen);
    if method == Method::Cell {
        // It has no diameters that could be capped.
        scene.model.diameter_cap = None;
    }
    // As many in the chamber as said.
    let plan = model_from("orifice", scene.clone())?.plan;
    let [chamber, behind] = [0, 1].map(|k| plan.chambers[k].volume);
    scene.model.particles = Some((particles as f64 * (1.0 + BEHIND * behind / chamber)).round() as u64);
    let (mut left, mut isentropic, mut crossed) = (0.0, 0.0, 0.0);
    for seed in 0..seeds {
        let mut scene = scene.clone();
        scene.seed += seed;
        let rows = run(device, &model_from("orifice", scene)?, Options::default())?.rows;
        let flow = NetFlow::of(rows.get(STARTING..).unwrap_or_default(), chamber);
        left += flow.left;
        isentropic += flow.isentropic;
        crossed += flow.crossed;
    }
    Ok((left / isentropic, crossed.sqrt() / isentropic))
}

/// Particles that left, on balance; that should have by the isentropic law; and that flew to and fro, whose chance is that of their number.
struct NetFlow {
    left: f64,
    isentropic: f64,
    crossed: f64,
}

impl NetFlow {
    /// Of rows of two chambers, the first of this volume, m3, that empties into the second.
    fn of(rows: &[Row], volume: f64) -> NetFlow {
        let mut flow = NetFlow { left: 0.0, isentropic: 0.0, crossed: 0.0 };
        for pair in rows.windows(2) {
            let middle = |row: &Row| 0.5 * (row.window[0] + row.window[1]);
            let mean = |of: &dyn Fn(&Row) -> f64| 0.5 * (of(&pair[0]) + of(&pair[1]));
            let ratio = mean(&|row| row.chambers[1].pressure / row.chambers[0].pressure);
            let temperature = mean(&|row| row.chambers[0].temperature);
            let swept =
                (middle(&pair[1]) - middle(&pair[0])) * AREA / volume * mean(&|row| row.chambers[0].particles[0]);
            let effusing = 0.25 * kinetics::mean_speed(kinetics::thermal_square(temperature, 0.028));
            flow.left += pair[0].chambers[0].particles[0] - pair[1].chambers[0].particles[0];
            flow.isentropic += swept * isentropic_speed(ratio, temperature);
            flow.crossed += swept * effusing * (1.0 + ratio);
        }
        flow
    }
}
