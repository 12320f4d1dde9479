//! A thin wall between hot and cold gas, across cells: each side keeps its temperature.
//!
//! Walls are mirrors and the gas has no spin, so the temperature of a side is that of its particles, changed by rounding
//! alone (`energy-drift`). Particles that met through the wall would carry heat within a few steps.

use crate::gpu::Device;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::witness::model_of;
use super::{Check, Effort, Findings, run};

/// m: where the wall is, and how thick.
const PLACE: f64 = 0.0391;
const THICKNESS: f64 = 1e-4;
/// What rounding may do to the temperature of a side: the tolerance of `energy-drift` in 2,000 steps.
const ROUNDING: f64 = 2e-7;

/// Temperatures of the cold and of the hot side at the end of a run over those of its first snapshot, less 1.
///
/// # Errors
/// If the run fails.
pub fn changes(device: &Device, method: &str, particles: u64, steps: u32, wall: bool) -> Result<[f64; 2], StudyError> {
    let plate = format!(
        "[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [{PLACE}, 0.02, 0.02]\nnormal = [1.0, 0.0, 0.0]\n\
         u = [0.0, 1.0, 0.0]\nsize = [0.044, 0.044]\nthickness = {THICKNESS}\n"
    );
    let step = 1.25e-6;
    let text = format!(
        "end_time = {end:e}\n[[gas]]\nname = \"argon\"\nmolar_mass = 0.04\ngamma = 1.6666667\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.08, 0.04, 0.04]\n\
         gas = \"inside\"\n{plate}\
         [[chamber]]\nname = \"cold\"\nregion = {{ box = {{ min = [0.0, 0.0, 0.0], max = [{PLACE}, 0.04, 0.04] }} }}\n\
         pressure = 1e5\ntemperature = 300.0\ngas = \"argon\"\n\
         [[chamber]]\nname = \"hot\"\npressure = 1e5\ntemperature = 900.0\ngas = \"argon\"\n\
         [model]\nmethod = \"{method}\"\nparticles = {particles}\ntime_step = {step:e}\n\
         [output]\nrows = 4\nsnapshots = 2\n",
        end = step * f64::from(steps),
        plate = if wall { plate.as_str() } else { "" },
    );
    let model = model_of("thin-wall", &text)?;
    let snapshots = run(device, &model, Options::default())?.snapshots;
    let temperatures = |particles: &[GpuParticle]| {
        let (mut sums, mut counts) = ([0.0; 2], [0.0; 2]);
        for particle in particles {
            let side = usize::from(model.plan.grid.to_metres(particle.position)[0] > PLACE);
            sums[side] += particle.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
            counts[side] += 1.0;
        }
        [sums[0] / counts[0], sums[1] / counts[1]]
    };
    let (Some((_, first)), Some((_, last))) = (snapshots.first(), snapshots.last()) else {
        return Ok([f64::NAN; 2]);
    };
    let (before, after) = (temperatures(first), temperatures(last));
    Ok([0, 1].map(|side| after[side] / before[side] - 1.0))
}

pub(super) fn thin_wall(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, steps) = if effort == Effort::Quick { (4000, 600) } else { (20_000, 3000) };
    let mut checks = Vec::new();
    for method in ["closest-approach", "cell", "half-turn"] {
        let found = changes(device, method, particles, steps, true)?;
        for (side, change) in ["cold", "hot"].into_iter().zip(found) {
            let quantity = format!("{method}: T of the {side} side over that before, less 1");
            checks.push(Check::of(quantity, 0.0, (change, 0.0), ROUNDING));
        }
    }
    Ok(checks.into())
}
