//! Sod's problem and expansion into a vacuum against exact Riemann solutions.

use crate::gas::kinetics;
use crate::gpu::Device;
use crate::scene::Method;
use crate::simulation::{Model, Options};
use crate::study::StudyError;
use crate::study::pareto::{Setting, model_with};

use super::prototype_tubes::single;
use super::shear::FLOOR;
use super::smear::{OF_HALF_TURN, expected};
use super::statistics::mean_and_error;
use super::tube::{LENGTH, SOD, Slice, Tube, counting_noise, mean_differences};
use super::waves::DAMPING;
use super::{Check, Curves, Effort, Findings, run};

/// The profile at the end of a run with this setting, and the model. Occupancy and step are of all particles in `volume` (m3),
/// or of the mean state.
///
/// # Errors
/// If the run fails.
pub fn profile(
    device: &Device,
    tube: &Tube,
    setting: &Setting,
    volume: Option<f64>,
) -> Result<(Model, Vec<Slice>), StudyError> {
    let setting = Setting { particles: Some(tube.particles), ..*setting };
    let model = model_with("tube", tube.scene()?, &setting, volume)?;
    let particles = run(device, &model, Options::default())?.outcome.particles;
    let profile = tube.profile(&model, tube.end, &particles).unwrap_or_default();
    Ok((model, profile))
}

/// Particles of the prototype's limits, and how mean differences fall with them: as N^-.26 at fixed occupancy
/// (section 2).
const PARTICLES: f64 = 160_000.0;
const POWER: f64 = -0.26;

/// A method, and at most what its mean |difference| of the density (docs/reference/accuracy.md) and of the velocity (its table
/// of section 2 and the 5 % to which that is known) is at 160,000 particles and f = .1.
type Limits = (Method, Option<f64>, [f64; 2]);
const LIMITS: [Limits; 2] = [
    // The defaults of the plan.
    (Method::ClosestApproach, None, [0.024, 1.05 * 0.045]),
    (Method::Cell, Some(0.1), [0.025, 1.05 * 0.046]),
];

/// The checks of half-turn, and the profile. A profile is the exact one, smeared by the method's diffusivities, and
/// counted: the limits are what that makes of it (`smear.rs`) and three standard deviations of the counting.
///
/// # Errors
/// If the run fails.
pub fn half_turn_in(device: &Device, tube: &Tube) -> Result<(Vec<Check>, Vec<Slice>), StudyError> {
    by_method_in(device, tube, Method::HalfTurn)
}

/// By those limits of another method.
///
/// # Errors
/// If the run fails.
pub fn by_method_in(device: &Device, tube: &Tube, method: Method) -> Result<(Vec<Check>, Vec<Slice>), StudyError> {
    let setting = Setting { method: Some(method), ..Setting::default() };
    let (model, profile) = profile(device, tube, &setting, None)?;
    let left = &model.plan.chambers[0];
    let density: u64 = left.particles.iter().sum();
    let spacing = kinetics::mean_spacing(density as f64 / left.volume) / LENGTH;
    let exact = tube.exact();
    let most = exact.map_or([f64::NAN; 2], |exact| expected(&exact, tube.end, OF_HALF_TURN, spacing, &profile));
    let (found, noise) = (mean_differences(&profile), counting_noise(&profile));
    let check = |k: usize| {
        let quantity = format!("{}: mean |{} - exact|, N = {}", method.name(), ["rho", "u"][k], tube.particles);
        Check::of(quantity, 0.0, (found[k], noise[k].1), most[k] + 3.0 * noise[k].1)
    };
    Ok((vec![check(0), check(1)], profile))
}

/// The checks of half-turn against the prototype's table of single runs, which is the mean of four runs
/// and more, known to 5 %; three standard deviations of the counting noise of one run are what one may be off.
fn half_turn_by_table(device: &Device, particles: u64) -> Result<Vec<Check>, StudyError> {
    let setting = Setting { method: Some(Method::HalfTurn), ..Setting::default() };
    let (_, profile) = profile(device, &Tube { particles, ..SOD }, &setting, None)?;
    let (found, noise) = (mean_differences(&profile), counting_noise(&profile));
    let table = single(particles).unwrap_or([f64::NAN; 2]);
    let check = |k: usize| {
        let quantity = format!("half-turn: mean |{} - exact|, N = {particles}, by its table", ["rho", "u"][k]);
        Check::of(quantity, table[k], (found[k], noise[k].1), (0.05 * table[k]).hypot(3.0 * noise[k].1))
    };
    Ok(vec![check(0), check(1)])
}

/// The checks of a method against the limits of the `limits`' one, and the profile.
///
/// # Errors
/// If the run fails.
pub fn against(
    device: &Device,
    particles: u64,
    gamma: f64,
    method: Method,
    limits: usize,
) -> Result<(Vec<Check>, Vec<Slice>), StudyError> {
    let (_, occupancy, limits) = LIMITS[limits];
    let setting = Setting { method: Some(method), occupancy, ..Setting::default() };
    let (_, profile) = profile(device, &Tube { particles, gamma, ..SOD }, &setting, None)?;
    let (found, noise) = (mean_differences(&profile), counting_noise(&profile));
    let scale = (particles as f64 / PARTICLES).powf(POWER);
    let check = |k: usize| {
        let quantity = format!("{}: mean |{} - exact|, N = {particles}", method.name(), ["rho", "u"][k]);
        Check::of(quantity, 0.0, (found[k], noise[k].1), scale * limits[k])
    };
    Ok((vec![check(0), check(1)], profile))
}

fn sod_at(device: &Device, effort: Effort, gamma: f64, name: &'static str) -> Result<Findings, StudyError> {
    let particles = if effort == Effort::Quick { 40_000 } else { 160_000 };
    let (mut checks, profile) = against(device, particles, gamma, Method::ClosestApproach, 0)?;
    // One gas is enough for what is beside it.
    if gamma == SOD.gamma {
        checks.extend(against(device, particles, gamma, Method::Cell, 1)?.0);
        checks.extend(half_turn_by_table(device, particles)?);
    } else {
        checks.extend(half_turn_in(device, &Tube { particles, gamma, ..SOD })?.0);
    }
    let line = |of: fn(&Slice) -> f64| profile.iter().map(|slice| [slice.x, of(slice)]).collect();
    let title = format!("Sod's shock tube, gamma {gamma:.3}, {particles} particles");
    let chart = Curves::new(name, title, "x over the length", "density and velocity, of the left")
        .line("density", line(|slice| slice.density[0]))
        .line("velocity", line(|slice| slice.velocity[0]))
        .reference("exact", line(|slice| slice.density[1]))
        .reference("exact", line(|slice| slice.velocity[1]));
    Ok(Findings { charts: vec![chart], ..checks.into() })
}

pub(super) fn sod(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    sod_at(device, effort, SOD.gamma, "sod")
}

pub(super) fn sod_monatomic(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    sod_at(device, effort, 5.0 / 3.0, "sod-monatomic")
}

/// A pressure ratio of 100, a temperature ratio of 12.5: a shock of Mach 3.8 into thin and cold gas.
pub const STRONG: Tube = Tube { right: [0.01, 0.08], ..SOD };

pub(super) fn strong(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let particles = if effort == Effort::Quick { 40_000 } else { 160_000 };
    Ok(half_turn_in(device, &Tube { particles, ..STRONG })?.0.into())
}

/// A tube whose right half is empty. The front of the exact solution is at 5.9 sqrt(p/rho).
pub const VACUUM: Tube = Tube { right: [0.0, 1.0], end: 0.08, ..SOD };

/// What viscosity and heat conduction make of the mean |difference| of an expansion, over the tube's length.
///
/// The slope of the density falls by 2/((gamma+1) a t) at the head of the wave, which moves at the sound speed a. Sound of
/// diffusivity D there becomes as wide as s^2 = D t, and the integral of the difference to the kink is the fall of the
/// slope times s^2/2: D/((gamma+1) a), at all times. D is 4/3 nu, .4 nu of conduction with a Prandtl number of .7 (0.56 nu) and some
/// .6 nu of the spin's relaxation (Landau and Lifshitz, Fluid Mechanics, section 79): 2.5 nu, nu = .65 d c0. That of
/// half-turn is twice its damping of sound.
fn widened(model: &Model, tube: &Tube, method: Method) -> f64 {
    let diffusivity = if method == Method::HalfTurn { 2.0 * DAMPING } else { 2.5 * FLOOR };
    let density = model.plan.chambers[0].particles[0] as f64 / model.plan.chambers[0].volume;
    let sound = tube.gamma.sqrt();
    diffusivity * kinetics::mean_spacing(density) / LENGTH / ((tube.gamma + 1.0) * sound)
}

/// The profile: what counting noise makes of it, and as much more as viscosity and three standard errors do.
///
/// # Errors
/// If the run fails.
pub fn expanded(device: &Device, particles: u64, method: Method) -> Result<Check, StudyError> {
    let tube = Tube { particles, ..VACUUM };
    let setting = Setting { method: Some(method), ..Setting::default() };
    let (model, profile) = profile(device, &tube, &setting, None)?;
    let [found, _] = mean_differences(&profile);
    let [(noise, error), _] = counting_noise(&profile);
    let quantity = format!("{}: mean |rho - exact|, N = {particles}", method.name());
    Ok(Check::of(quantity, noise, (found, error), widened(&model, &tube, method) + 3.0 * error))
}

/// Times, of some sound crossings each, over which gas at rest is observed.
const MOMENTS: u32 = 16;

/// The early profile against the exact solution; long after it energy is kept, so gas at rest has the temperature of the
/// start again. At a moment 3 N/2 degrees of freedom show it to sqrt(2/(3N)); between two of them lie hundreds of
/// collision times.
pub(super) fn expansion(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, few) = if effort == Effort::Quick { (40_000, 2000) } else { (160_000, 6000) };
    let early = expanded(device, particles, Method::ClosestApproach)?;
    let of_half_turn = expanded(device, particles, Method::HalfTurn)?;
    let late = Tube { particles: few, end: 30.0, snapshots: 2 * MOMENTS, ..VACUUM };
    let model = late.model()?;
    let moments = run(device, &model, Options::default())?.snapshots;
    let temperature = |particles: &[crate::subdomain::GpuParticle]| {
        let squares = particles.iter().flat_map(|particle| particle.velocity).map(|v| f64::from(v).powi(2));
        squares.sum::<f64>() / (3.0 * particles.len() as f64) / late.speed().powi(2)
    };
    let at_rest = &moments[moments.len().saturating_sub(MOMENTS as usize)..];
    let found: Vec<f64> = at_rest.iter().map(|(_, particles)| temperature(particles)).collect();
    let quantity = "temperature at rest over that of the start";
    Ok(vec![early, of_half_turn, Check::of(quantity, 1.0, mean_and_error(&found), 0.02)].into())
}
