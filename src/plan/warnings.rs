//! What a plan will do less well than its user may expect.

use super::population::WANTED_KNUDSEN;
use super::render::significant;
use super::resolution::Resolution;
use super::{Measured, OpeningPlan};
use crate::gas::kinetics;
use crate::scene::Method;

const FEW_PARTICLES: u64 = 1000;
const MOST_LOST: f64 = 0.03;
const DENSE: f64 = 0.3;

/// Share of collision events lost, by x = dt/tau (first column) for 1 to 4 rounds (specification,
/// section 2; measured at f = .1, +-.01; gains taken as zero).
const LOST: [[f64; 5]; 6] = [
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [0.05, 0.055, 0.002, 0.006, 0.001],
    [0.1, 0.116, 0.018, 0.0, 0.0],
    [0.2, 0.186, 0.053, 0.018, 0.006],
    [0.5, 0.352, 0.145, 0.065, 0.030],
    [1.0, 0.538, 0.288, 0.154, 0.086],
];

/// Interpolated in the table; constant beyond x = 1. Eight rounds lose about half of what four do at x = .5
/// (measured in `tests/verification`), those between in proportion.
pub fn lost_events(collisions_per_step: f64, rounds: u32) -> f64 {
    let column = rounds.clamp(1, 4) as usize;
    let share = 1.0 - 0.125 * f64::from(rounds.clamp(4, 8) - 4);
    for pair in LOST.windows(2) {
        let (low, high) = (pair[0], pair[1]);
        if collisions_per_step <= high[0] {
            let fraction = (collisions_per_step - low[0]) / (high[0] - low[0]);
            return share * (low[column] + fraction * (high[column] - low[column]));
        }
    }
    share * LOST[5][column]
}

pub fn warnings(
    method: Method,
    particles: u64,
    occupancy: f64,
    resolution: &Resolution,
    openings: &[OpeningPlan],
    measured: &Measured,
) -> Vec<String> {
    let mut warnings = Vec::new();
    if particles < FEW_PARTICLES {
        warnings.push(format!("{particles} particles are few: pressures will be noise; {FEW_PARTICLES} is a start"));
    }
    let collides = method != Method::None;
    for opening in openings.iter().filter(|opening| collides && opening.knudsen > WANTED_KNUDSEN) {
        warnings.push(format!(
            "opening `{}` has a Knudsen number of {}: its flow is off by 7 % or more; {WANTED_KNUDSEN} takes {:.1} \
             times the particles",
            opening.name,
            significant(opening.knudsen),
            // lambda ~ d at fixed occupancy, d ~ N^(-1/3).
            (opening.knudsen / WANTED_KNUDSEN).powi(3)
        ));
    }
    let smallest = openings.iter().map(|o| o.length).chain(measured.smallest_gap).fold(f64::INFINITY, f64::min);
    if method == Method::HardSphere {
        warnings.push(format!(
            "rigid spheres at occupancy {} press {:.1} % harder than the ideal gas (Carnahan-Starling), more in denser gas: \
             `hard-sphere` is for comparison with legacy results only",
            significant(occupancy),
            100.0 * (kinetics::rigid_compressibility(occupancy) - 1.0)
        ));
    }
    if method.has_rounds() && resolution.diameter > smallest {
        warnings.push(format!(
            "the collision diameter of {} mm is larger than the smallest passage, {} mm: gas on its two sides will \
             collide through it",
            significant(1e3 * resolution.diameter),
            significant(1e3 * smallest)
        ));
    }
    if occupancy > DENSE {
        warnings.push(format!("an occupancy of {} costs search time and buys no resolution", significant(occupancy)));
    }
    if method.has_rounds() {
        let lost = lost_events(resolution.collisions_per_step, resolution.rounds);
        if lost > MOST_LOST {
            warnings.push(format!(
                "about {:.0} % of the collisions will be lost: the time step is {} of the collision time, the limit \
                 for {} rounds {}",
                100.0 * lost,
                significant(resolution.collisions_per_step),
                resolution.rounds,
                resolution.collision_limit
            ));
        }
    } else if resolution.flight_over_cell > 1.0001 {
        warnings.push(format!(
            "the time step lets particles fly {} cells at once",
            significant(resolution.flight_over_cell)
        ));
    }
    if method == Method::Cell && resolution.collisions_per_step > resolution.collision_limit {
        warnings.push(format!(
            "the time step is {} mean collision times, the limit of `cell` is {}: shorter ones will be taken",
            significant(resolution.collisions_per_step),
            resolution.collision_limit
        ));
    }
    if method == Method::Cell && resolution.cell > smallest {
        warnings.push(format!(
            "a cell of {} mm is larger than the smallest passage, {} mm: the gas in it is not resolved",
            significant(1e3 * resolution.cell),
            significant(1e3 * smallest)
        ));
    }
    warnings
}
