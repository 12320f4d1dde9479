//! Collisions of a gas at rest: what they press on the walls, and how many there are.

use std::f64::consts::PI;

use crate::gpu::Device;
use crate::simulation::{Options, Outcome, Simulation};
use crate::study::StudyError;

use super::gas_box::{EDGE, EquilibriumBox, GAS_CONSTANT, TEMPERATURE};
use super::{Check, Effort, Witness, run};

/// Wall pressure over n k T of one run.
#[derive(Debug, Clone, Copy)]
pub struct PressureRatio {
    pub ratio: f64,
    /// By the virial theorem, which the six faces of a box together obey: d/dt sum m r.v = 2 Wk - 3 p V + virial of the
    /// collisions. The last is zero for closest-approach, and the first averages to a difference of boundary terms over
    /// the window, sqrt(2/N) / 6 x edge / (c0 T_w) of the pressure.
    pub error: f64,
    /// Of as many independent hits, 1.13 / sqrt(H) (specification, section 6).
    pub of_hits: f64,
}

/// # Errors
/// If the run fails.
pub fn pressure_ratio(device: &Device, gas: &EquilibriumBox<'_>) -> Result<PressureRatio, StudyError> {
    let mut model = gas.model()?;
    // The temperature of every step: it moves as translation and spin exchange energy.
    model.plan.tally_every = 1;
    let run = run(device, &model, Options::default())?;
    let row = &run.rows[0];
    let moles = model.plan.particles as f64 * model.plan.moles_per_particle;
    let ideal = moles * GAS_CONSTANT * row.chambers[0].temperature / EDGE.powi(3);
    let window = row.window[1] - row.window[0];
    Ok(PressureRatio {
        ratio: row.surfaces[0].pressure / ideal,
        error: (2.0 / gas.particles as f64).sqrt() / 6.0 * EDGE / (gas.thermal_speed() * window),
        of_hits: 1.13 / (row.surfaces[0].hits as f64).sqrt(),
    })
}

pub(super) fn wall_pressures(device: &Device, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let occupancies: &[(f64, f64)] = match effort {
        Effort::Quick => &[(0.01, 0.05), (0.1, 0.2), (0.3, 0.3)],
        Effort::Full => &[(0.01, 0.05), (0.03, 0.1), (0.1, 0.2), (0.2, 0.25), (0.3, 0.3)],
    };
    let check = |&(occupancy, step_over_tau): &(f64, f64)| {
        let gas = EquilibriumBox { occupancy, step_over_tau, steps: 1500, rounds: 4, ..EquilibriumBox::default() };
        let found = pressure_ratio(device, &gas)?;
        Ok(Check::of(format!("p/nkT, f = {occupancy}"), 1.0, (found.ratio, found.error), 0.005))
    };
    occupancies.iter().map(check).collect()
}

/// Collisions of a gas over n pi sigma^2 gbar.
pub struct Rate {
    pub core: f64,
    /// C collisions have two ends each and are nearly independent: 1 / sqrt(C).
    pub error: f64,
    /// As `core`, of the layer along the walls that `core` leaves out: near a wall a pair does not meet behind it.
    pub layer: f64,
    pub outcome: Outcome,
}

/// Counted from the flights of single steps. The ideal-gas measure is stationary, so n is (N - 1)/V wherever one looks.
///
/// # Errors
/// If the run fails.
pub fn collision_rate(device: &Device, gas: &EquilibriumBox<'_>) -> Result<Rate, StudyError> {
    let mut model = gas.model()?;
    // Intervals of one step, so that every step's flights can be read, and no finer steps.
    model.plan.steps_per_interval = 1;
    model.plan.tally_every = 1;
    model.plan.collision_limit = 1.0;
    let margin = 2.0 * gas.diameter() + gas.mean_free_path();
    let mut witness = Witness::default();
    let mut simulation = Simulation::new(&model, device, Options::default())?;
    simulation.begin(&mut witness)?;
    let (mut visits, mut ends) = ([0u64; 2], [0u64; 2]);
    while simulation.advance(&mut witness)? {
        let places = simulation.particles()?;
        for (particle, (_, flight)) in places.iter().zip(simulation.flights()?) {
            let place = model.plan.grid.to_metres(particle.position);
            let layer = usize::from(place.iter().any(|x| *x < margin || *x > EDGE - margin));
            visits[layer] += 1;
            ends[layer] += u64::from(flight.collisions);
        }
    }
    let outcome = simulation.finish(&mut witness)?;
    let temperature = witness.rows[0].chambers[0].temperature / TEMPERATURE;
    let gbar = (16.0 / PI * temperature).sqrt() * gas.thermal_speed();
    let density = (gas.particles - 1) as f64 / EDGE.powi(3);
    let expected = density * PI * model.plan.diameter.powi(2) * gbar * gas.time_step();
    let ratio = |k: usize| ends[k] as f64 / visits[k] as f64 / expected;
    Ok(Rate { core: ratio(0), error: (2.0 / ends[0] as f64).sqrt(), layer: ratio(1), outcome })
}

/// The specification's table of lost collisions, section 2: rounds, x, rate over theory (good to .01). The first is
/// that of all collisions.
const RATES: [(u32, f64, f64, f64); 5] =
    [(3, 0.1, 1.0, 0.015), (1, 0.2, 0.814, 0.02), (2, 0.2, 0.947, 0.02), (3, 0.2, 0.982, 0.02), (4, 0.5, 0.970, 0.02)];

pub(super) fn rates(device: &Device, effort: Effort) -> Result<Vec<Check>, StudyError> {
    let count = if effort == Effort::Quick { 3 } else { RATES.len() };
    let check = |&(rounds, step_over_tau, expected, tolerance): &(u32, f64, f64, f64)| {
        let steps = if step_over_tau < 0.15 { 250 } else { 80 };
        let gas = EquilibriumBox { particles: 8000, rounds, step_over_tau, steps, ..EquilibriumBox::default() };
        let rate = collision_rate(device, &gas)?;
        let quantity = format!("rate, R = {rounds}, x = {step_over_tau}");
        Ok(Check::of(quantity, expected, (rate.core, rate.error), tolerance))
    };
    RATES[..count].iter().map(check).collect()
}
