//! Flow through vents that let every hit pass.

use std::f64::consts::PI;
use std::fmt::Write;

use super::figure;
use crate::gpu::Device;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::study::verify::gas_box::GAS_CONSTANT;
use crate::study::verify::holes::thin_gas_step;
use crate::study::verify::losses::{EDGE, MOLAR_MASS, TEMPERATURE};
use crate::study::verify::witness::model_of;
use crate::study::verify::{Effort, Findings, model_from, run};

/// Diameter of each of six vents, m, and occupancy: with 20,000 particles a mean free path is nine radii long, and longer when some
/// have left, so nothing flows but what flies. (At one radius and a half the slope is .217 +- .003: gas that collides before a
/// hole flows.)
const VENT: f64 = 0.02;
const OCCUPANCY: f64 = 5e-4;

/// The specification has its rates to .01; so few particles as a quick run has know it to three times that.
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
    let quantity = "d lnT / d lnN, a constant P (specification .206)".to_owned();
    let known = KNOWN[usize::from(effort == Effort::Full)];
    Ok(vec![figure(quantity, 0.2, (slope, error), known)].into())
}
