//! The longest step that a run takes, whatever `time_step` asks for.
//!
//! A step that is too long makes a run wrong, and it is warned of (`warnings.rs`). One that is far longer would stop it: a
//! flight has more hits on walls than are followed, every particle is a neighbour of every other, and the ladder of steps
//! ends above the step that the gas needs. No result of such a step means anything, so a shorter one is taken, and the
//! plan says so.

use super::resolution::{ExpectedGas, Extreme, FASTEST_PAIR, MeanState, Resolution};
use super::text::significant;
use super::{Measured, PlanError};
use crate::gas::kinetics;
use crate::scene::{Method, ModelRequest};

/// In mean collision times, of pairs in rounds: the longest that was measured (`corpuscle stability time-step --full`).
const MOST_COLLISIONS: f64 = 4.0;
/// Hits of a mean particle on walls in a step: a choice, between the .075 beyond which runs become wrong (`limits.rs`) and the 1024
/// that are followed, of which a fast particle in a corner has many times as many as the mean one.
const MOST_HITS: f64 = 4.0;
/// Neighbours in a step of a pair of the plan's fastest: a choice, as many as take 24 kB of list for each particle.
const MOST_NEIGHBOURS: f64 = 6000.0;
/// Times the step that the plan would choose: it leaves the ladder an eighth of its range for gas that becomes denser or
/// hotter.
const MOST_TIMES: f64 = 256.0;

/// What a plan is made from.
pub struct Basis<'a> {
    pub method: Method,
    pub request: &'a ModelRequest,
    pub measured: &'a Measured,
    /// At the start and the end.
    pub states: [MeanState; 2],
    pub extreme: Extreme,
    pub particles: u64,
    pub end_time: f64,
}

/// The request with the step that is taken, and a warning where it is not the one asked for.
///
/// # Errors
/// If the request has no plan whatever its step.
pub fn possible_step(basis: &Basis<'_>) -> Result<(ModelRequest, Option<String>), PlanError> {
    let request = basis.request.clone();
    let Some(asked) = request.time_step else { return Ok((request, None)) };
    // A step that is longer than the run is the run.
    let asked = asked.min(basis.end_time);
    let Some((longest, why)) = longest(basis)?.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Ok((request, None));
    };
    if asked <= longest {
        return Ok((request, None));
    }
    let us = |step: f64| significant(1e6 * step);
    let warning = format!(
        "the time step: {} us asked for, at most {} us: {why}; the shorter one is taken; a smaller `time_step`, or none",
        us(asked),
        us(longest)
    );
    Ok((ModelRequest { time_step: Some(longest), ..request }, Some(warning)))
}

/// As the plan would choose them without a `time_step`.
fn unasked(basis: &Basis<'_>) -> Result<Resolution, PlanError> {
    let request = ModelRequest { time_step: None, ..basis.request.clone() };
    let gas = ExpectedGas { states: basis.states, extreme: basis.extreme };
    Resolution::choose(basis.method, &request, gas, basis.end_time, &mut Vec::new())
}

/// The step that is asked for and that the plan would choose, s, if one is asked for.
///
/// # Errors
/// If the request has no plan whatever its step.
pub fn asked_and_own(basis: &Basis<'_>) -> Result<Option<[f64; 2]>, PlanError> {
    basis.request.time_step.map(|asked| Ok([asked, unasked(basis)?.time_step])).transpose()
}

/// Limits, s, and what is beyond them.
fn longest(basis: &Basis<'_>) -> Result<Vec<(f64, &'static str)>, PlanError> {
    let Basis { method, measured, states, extreme, .. } = *basis;
    let own = unasked(basis)?;
    let volume = measured.gas_volume * measured.motion.map_or(1.0, |motion| motion.least_share);
    let hit = 4.0 * volume / (measured.wall_area * kinetics::mean_speed(extreme.0));
    let mut limits = vec![
        (MOST_TIMES * own.time_step, "256 times what the plan would choose, beyond which the run finds no way back"),
        (MOST_HITS * hit, "a particle hits walls four times in it"),
    ];
    if method.has_rounds() {
        let times =
            states.map(|state| kinetics::collision_time(state.number_density, own.diameter, state.thermal_square));
        limits.push((
            MOST_COLLISIONS * times[0].min(times[1]),
            "four mean collision times, beyond which nothing is known",
        ));
        let density = states[0].number_density.max(states[1].number_density);
        // 4/3 pi h^3 n, h the distance within which pairs meet (`Resolution`).
        let reach = libm::cbrt(0.75 * MOST_NEIGHBOURS / (std::f64::consts::PI * density));
        if basis.particles as f64 > MOST_NEIGHBOURS && reach > own.diameter {
            let flown = (reach * reach - own.diameter * own.diameter).sqrt();
            let fastest = FASTEST_PAIR * extreme.0.sqrt();
            limits.push((2.0 * flown / fastest, "a particle may meet 6000 others in it"));
        }
    }
    // (A request of exactly that many collision times is not beyond.)
    Ok(limits.into_iter().map(|(step, why)| (step * (1.0 + 1e-6), why)).collect())
}
