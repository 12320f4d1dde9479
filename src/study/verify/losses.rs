//! What a vessel loses: heat to its walls, and gas through pores (docs/explanation/method.md, "Walls").

use std::f64::consts::PI;

use crate::gpu::Device;
use crate::scene::{Method, Scene};
use crate::simulation::{Model, Options};
use crate::study::StudyError;

use super::gas_box::GAS_CONSTANT;
use super::waves::DIFFUSIVITY;
use super::witness::{model_from, model_of, scene_of};
use super::{Check, Curves, Effort, Findings, Run, run};

/// m.
pub const EDGE: f64 = 0.1;
pub const MOLAR_MASS: f64 = 0.028;
/// Nitrogen at 1 bar, K: at the start, and the walls.
pub const WARM: f64 = 600.0;
pub const COLD: f64 = 300.0;
/// Time constant, s, and length of the run.
pub const TAU: f64 = 2.5e-3;

/// A cube of nitrogen at 1 bar whose walls have 300 K and these further keys.
///
/// # Errors
/// If the run fails.
pub fn within_walls(
    device: &Device,
    particles: u64,
    end_time: f64,
    temperature: f64,
    wall: &str,
) -> Result<Run, StudyError> {
    run(device, &model_within_walls(particles, end_time, temperature, wall)?, Options::default())
}

/// The cube's scene, by a method that the plan gives diameter and step, in place of closest approach.
fn scene_by(method: Method, particles: u64, temperature: f64, wall: &str) -> Result<Scene, StudyError> {
    let mut scene = scene_of("heat-loss", &text_within_walls(particles, TAU, temperature, wall))?;
    (scene.model.method, scene.model.occupancy, scene.model.time_step) = (Some(method), None, None);
    Ok(scene)
}

/// The model of [`within_walls`].
///
/// # Errors
/// If no plan can be made for it.
pub fn model_within_walls(particles: u64, end_time: f64, temperature: f64, wall: &str) -> Result<Model, StudyError> {
    model_of("heat-loss", &text_within_walls(particles, end_time, temperature, wall))
}

fn text_within_walls(particles: u64, end_time: f64, temperature: f64, wall: &str) -> String {
    format!(
        "end_time = {end_time:e}\nseed = 3\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = {MOLAR_MASS}\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{EDGE}, {EDGE}, {EDGE}]\n\
         gas = \"inside\"\ntemperature = {COLD}\n{wall}\n\
         [[chamber]]\nname = \"all\"\npressure = 100000.0\ntemperature = {temperature}\ngas = \"nitrogen\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = {particles}\noccupancy = 0.1\ntime_step = 3e-6\n[output]\nrows = 60\nsnapshots = 0\n"
    )
}

/// Temperature of the cube after `time`, K: dT/dt = -(T - T_w)/tau, tau = n cv / (h A).
pub fn cooled(time: f64) -> f64 {
    COLD + (WARM - COLD) * (-time / TAU).exp()
}

/// mol in the cube.
fn moles() -> f64 {
    1e5 * EDGE.powi(3) / (GAS_CONSTANT * WARM)
}

/// The cube cooled by walls over one time constant: its last temperature, by all heat that is gone (finer than the
/// translational temperature of a row), the standard error of it, and the run.
///
/// A share alpha = h / (3/4 c R cbar) of the hits is exchanged, N alpha cbar A t / (4 V) of them; each changes the energy by
/// kT sqrt(6) at random (2 kT of the flux and spin, before and after).
///
/// # Errors
/// If the run fails.
pub fn heat_loss(device: &Device, particles: u64) -> Result<((f64, f64), Run), StudyError> {
    heat_loss_in(particles, 1.0, |wall| within_walls(device, particles, TAU, WARM, wall))
}

/// With walls that exchange so many times as much as the law is told.
fn heat_loss_in(
    particles: u64,
    times: f64,
    cooled_by: impl Fn(&str) -> Result<Run, StudyError>,
) -> Result<((f64, f64), Run), StudyError> {
    let heat_capacity = moles() * 2.5 * GAS_CONSTANT;
    let area = 6.0 * EDGE * EDGE;
    let coefficient = heat_capacity / (area * TAU);
    let run = cooled_by(&format!("heat_transfer = {:e}", times * coefficient))?;
    let heat = run.rows.last().map_or(f64::NAN, |row| row.walls[0].heat);
    let mean = 0.5 * (WARM + COLD);
    let speed = (8.0 * GAS_CONSTANT * mean / (PI * MOLAR_MASS)).sqrt();
    let volume = EDGE.powi(3);
    let share = coefficient / (moles() / volume * speed * GAS_CONSTANT * 0.75);
    let exchanged = particles as f64 * share * speed * area / (4.0 * volume) * TAU;
    let error = mean * (exchanged * 6.0).sqrt() / (particles as f64 * 2.5);
    Ok(((WARM - heat / heat_capacity, error), run))
}

/// What half-turn keeps, of which the gas at the walls is colder, since it conducts less: between the law's and that of a solid of
/// its conductivity, whose fall is slower by the factor zeta^2/Bi, zeta tan zeta = Bi, the Biot number of half an edge. `times`: by how much the
/// coefficient of the walls is larger than that of the law.
///
/// # Errors
/// If the run fails.
pub fn by_half_turn(device: &Device, particles: u64, times: f64) -> Result<Check, StudyError> {
    let ((end, error), _) = heat_loss_in(particles, times, |wall| {
        let model = model_from("heat-loss", scene_by(Method::HalfTurn, particles, WARM, wall)?)?;
        run(device, &model, Options::default())
    })?;
    let fall = WARM - COLD;
    let spacing = EDGE / (particles as f64).cbrt();
    let thermal = (GAS_CONSTANT * 0.5 * (WARM + COLD) / MOLAR_MASS).sqrt();
    // h (L/2)/lambda with h = n cv L/(6 tau) and lambda = n cp chi, gamma 1.4.
    let biot = EDGE * EDGE / (12.0 * TAU * 1.4 * DIFFUSIVITY * spacing * thermal);
    let (law, solid) = ((-1.0f64).exp(), (-slowed(biot)).exp());
    let (expected, tolerance) = (0.5 * (law + solid), 0.5 * (solid - law) + 3.0 * error / fall);
    let quantity = format!("half-turn: the same, between the law's and a solid's {solid:.3}");
    Ok(Check::of(quantity, expected, ((end - COLD) / fall, error / fall), tolerance))
}

/// zeta^2/Bi.
fn slowed(biot: f64) -> f64 {
    let (mut low, mut high) = (0.0f64, 0.5 * PI);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if middle * middle.tan() < biot { low = middle } else { high = middle }
    }
    low * low / biot
}

/// A coefficient a fifth larger would be .067 of the fall.
///
/// The law's gas has one temperature. Here heat is conducted to the walls, and what they exchange is that of the gas at
/// them, which is colder than the mean: a solid of this conductivity (half an edge times h over it is a third) would
/// keep .41 instead of .37. Gas does better, as it flows towards what is cooled.
pub(super) fn heat(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, tolerance) = if effort == Effort::Quick { (8000, 0.05) } else { (40_000, 0.025) };
    let ((end, error), run) = heat_loss(device, particles)?;
    let fall = WARM - COLD;
    let checks = vec![
        Check::of(
            "(T - T_w) over that of the start, after n cv / (h A)",
            (-1.0f64).exp(),
            ((end - COLD) / fall, error / fall),
            tolerance,
        ),
        by_half_turn(device, particles, 1.0)?,
    ];
    let found = run.rows.iter().map(|row| [1e3 * row.time, WARM - row.walls[0].heat / (moles() * 2.5 * GAS_CONSTANT)]);
    let exact = run.rows.iter().map(|row| [1e3 * row.time, cooled(row.time)]);
    let title = format!("A cube that its walls cool, {particles} particles");
    let chart = Curves::new("heat-loss", title, "ms", "K")
        .line("by the heat that is gone", found.collect())
        .reference("exponential", exact.collect());
    Ok(Findings { charts: vec![chart], ..checks.into() })
}

/// Choked isentropic flow over p sqrt(M / (R T)), gamma 1.4.
pub const CHOKED: f64 = 0.684_731;
/// K, of the cube that empties.
pub const TEMPERATURE: f64 = 400.0;

/// A cube all of whose walls vent into vacuum with this coefficient C23.
///
/// # Errors
/// If the run fails.
pub fn emptied(device: &Device, particles: u64, end_time: f64, coefficient: f64) -> Result<Run, StudyError> {
    let text = format!(
        "end_time = {end_time:e}\nseed = 11\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = {MOLAR_MASS}\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [{EDGE}, {EDGE}, {EDGE}]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 200000.0\ntemperature = {TEMPERATURE}\ngas = \"nitrogen\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [[vent]]\nname = \"pores\"\nwall = \"box\"\ndischarge = {coefficient:e}\nexternal_pressure = 0.0\n\
         [model]\nparticles = {particles}\noccupancy = 0.1\n[output]\nrows = 20\nsnapshots = 0\n"
    );
    run(device, &model_of("leak", &text)?, Options::default())
}

/// C23 for beta = .02 over the thermal speed: G = beta p / 2.
pub fn pores() -> f64 {
    0.5 * 0.02 / CHOKED
}

/// K = C23 A/V .6847 sqrt(R T0 / M), 1/s.
pub fn rate(coefficient: f64) -> f64 {
    coefficient * 6.0 / EDGE * CHOKED * (GAS_CONSTANT * TEMPERATURE / MOLAR_MASS).sqrt()
}

/// The part of the mass that is left: dx/dt = -K x^((gamma+1)/2), gamma = 1.4.
pub fn left(coefficient: f64, time: f64) -> f64 {
    (1.0 + 0.2 * rate(coefficient) * time).powi(-5)
}

/// d lnT / d lnN over a whole run, and its standard error.
///
/// The energy of a particle that leaves has the mean 7/2 kT and the variance 7/2 (kT)^2 (two degrees of freedom of spin: of
/// the normal component 2 kT as a gamma variate of shape 2, the rest of shape 3/2). Over n of them the slope errs by
/// 1.4 sqrt(2/7) / sqrt(n).
pub fn slope(run: &Run) -> (f64, f64) {
    let audit = &run.outcome.audit;
    let (before, after) = (audit.particles_initial as f64, audit.particles_inside as f64);
    let temperatures = (audit.energy_end / after / (audit.energy_start / before)).ln();
    (temperatures / (after / before).ln(), 1.4 * (2.0 / 7.0 / (before - after)).sqrt())
}

/// To .01 (docs/reference/accuracy.md), a third of which takes 105,000 particles; to what 10,000 can tell else.
pub(super) fn leak(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, tolerance) = if effort == Effort::Quick { (10_000, 0.035) } else { (120_000, 0.01) };
    let end_time = 0.7 / rate(pores());
    let run = emptied(device, particles, end_time, pores())?;
    let out = run.outcome.audit.particles_vented as f64 / particles as f64;
    let expected = 1.0 - left(pores(), end_time);
    // What the loop that meters the flow owes, and the temperature's own noise.
    let error = (expected * (1.0 - expected) / particles as f64).sqrt();
    Ok(vec![
        Check::of("d lnT / d lnN", 0.4, slope(&run), tolerance),
        Check::of("part of the mass that left, choked", expected, (out, error), 0.02),
    ]
    .into())
}
