//! Two gases that start apart, at one pressure and two temperatures, come to equal shares everywhere and to one
//! temperature (docs/explanation/method.md, "The gas": equal moles per particle).

use crate::gpu::Device;
use crate::scene::Method;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::gas_box::GAS_CONSTANT;
use super::statistics::mean_of_series;
use super::witness::{model_from, scene_of};
use super::{Check, Curves, Effort, Findings, Run, run};

/// s.
pub const END: f64 = 6e-3;
/// m.
const EDGE: f64 = 0.1;
/// kg/mol, of nitrogen and argon.
const MASSES: [f64; 2] = [0.028, 0.04];

/// Nitrogen at 300 K in one half of a cube, argon at 600 K in the other, at one pressure; no wall between.
fn halves(particles: u64) -> String {
    let [nitrogen, argon] = MASSES;
    format!(
        "end_time = {END:e}\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = {nitrogen}\ngamma = 1.4\n\
         [[gas]]\nname = \"argon\"\nmolar_mass = {argon}\ngamma = 1.667\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{EDGE}, {EDGE}, {EDGE}]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"left\"\nregion = {{ box = {{ min = [0.0, 0.0, 0.0], max = [0.05, {EDGE}, {EDGE}] }} }}\n\
         pressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n\
         [[chamber]]\nname = \"right\"\npressure = 1e5\ntemperature = 600.0\ngas = \"argon\"\n\
         [model]\nparticles = {particles}\n[output]\nrows = 10\nsnapshots = 200\n"
    )
}

/// Of each gas at a time: its share of particles in the left half, and its translational temperature, K.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// s.
    pub time: f64,
    pub left: [f64; 2],
    pub temperature: [f64; 2],
}

/// # Errors
/// If the run fails.
pub fn mixed(device: &Device, particles: u64) -> Result<(Vec<Moment>, Run), StudyError> {
    mixed_by(device, Method::ClosestApproach, particles, END)
}

/// By another method, until a time (s).
///
/// # Errors
/// If the run fails.
pub fn mixed_by(device: &Device, method: Method, particles: u64, end: f64) -> Result<(Vec<Moment>, Run), StudyError> {
    let mut scene = scene_of("mixing", &halves(particles))?;
    (scene.model.method, scene.end_time) = (Some(method), end);
    let model = model_from("mixing", scene)?;
    let run = run(device, &model, Options::default())?;
    let of_gas = |particles: &[GpuParticle], gas: usize| {
        let own: Vec<&GpuParticle> = particles.iter().filter(|p| usize::from(p.gas()) == gas).collect();
        let left = own.iter().filter(|p| model.plan.grid.to_metres(p.position)[0] < EDGE / 2.0).count();
        let square: f64 = own.iter().map(|p| p.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>()).sum();
        let count = own.len() as f64;
        (left as f64 / count, MASSES[gas] / (3.0 * GAS_CONSTANT) * square / count)
    };
    let moment = |(time, particles): &(f64, Vec<GpuParticle>)| {
        let [first, second] = [0, 1].map(|gas| of_gas(particles, gas));
        Moment { time: *time, left: [first.0, second.0], temperature: [first.1, second.1] }
    };
    Ok((run.snapshots.iter().map(moment).collect(), run))
}

/// Mean over the second half of a run, in eight stretches, and its standard error.
pub fn late(moments: &[Moment], of: impl Fn(&Moment) -> f64) -> (f64, f64) {
    mean_of_series(&moments[moments.len() / 2..].iter().map(of).collect::<Vec<_>>(), 8)
}

/// That of the energies: n1 cv1 (T - 300) = n2 cv2 (600 - T) with n1 = 2 n2, cv 5/2 and 3/2 R.
pub fn common_temperature() -> f64 {
    (2.0 * 2.5 * 300.0 + 1.5 * 600.0) / (2.0 * 2.5 + 1.5)
}

/// Shares and temperature of the second half of a run; `method`: what the rows begin with.
pub fn of_late(moments: &[Moment], method: &str, tolerance: f64) -> Vec<Check> {
    let (found, error) = late(moments, |m| m.temperature[1]);
    let temperature = (found / common_temperature(), error / common_temperature());
    vec![
        Check::of(format!("{method}nitrogen in the left half"), 0.5, late(moments, |m| m.left[0]), tolerance),
        Check::of(format!("{method}argon in the left half"), 0.5, late(moments, |m| m.left[1]), tolerance),
        Check::of(format!("{method}T of argon over that of the energies"), 1.0, temperature, tolerance),
    ]
}

pub(super) fn mixing(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    // What so few particles can tell: .5/sqrt(N) at a moment, in some ten independent ones.
    let (particles, tolerance) = if effort == Effort::Quick { (1500, 0.05) } else { (12_000, 0.02) };
    let (moments, _) = mixed(device, particles)?;
    let mut checks = of_late(&moments, "", tolerance);
    // It diffuses more slowly, D .39 d c0 at 300 K and 14 particles a cell: exp(-D (pi/L)^2 t) is e^-2 at half of 6 ms with 1500 particles.
    let (slower, _) =
        mixed_by(device, Method::HalfTurn, particles, if effort == Effort::Quick { 2.0 } else { 4.0 } * END)?;
    checks.extend(of_late(&slower, "half-turn: ", tolerance));
    let line = |of: &dyn Fn(&Moment) -> f64| moments.iter().map(|m| [1e3 * m.time, of(m)]).collect();
    let title = format!("Nitrogen at 300 K and argon at 600 K, {particles} particles");
    let chart = Curves::new("mixing", title, "ms", "K")
        .line("nitrogen", line(&|m| m.temperature[0]))
        .line("argon", line(&|m| m.temperature[1]))
        .reference("of the energies", line(&|_| common_temperature()));
    Ok(Findings { charts: vec![chart], ..checks.into() })
}
