//! What a run costs: particle-steps times the memory traffic of one (docs/reference/performance.md), scaled to what the device
//! does. A rough estimate: dense moments take shorter steps and small runs wait for the device.

use crate::plan::resolution::Resolution;
use crate::plan::warnings::lost_events;
use crate::scene::Method;

/// Bytes of a particle-step (docs/reference/performance.md): search of the neighbours; collide, move, bin, scan and scatter; a
/// further round; `cell`; `none`.
const SEARCH: f64 = 40.0;
const REST: f64 = 88.0 + 12.0 + 72.0;
const ROUND: f64 = 90.0;
const CELL: f64 = 170.0;
const FREE: f64 = 64.0;
/// Particles in a cell at f = .12 and h = sqrt(1.25) sigma, those of the plan's own choice: n h^3.
const USUAL_IN_CELL: f64 = 0.32;
/// Its x = dt/tau.
const USUAL_STEP: f64 = 0.27;
const USUAL_ROUNDS: u32 = 8;
/// s: a control volume's integration, an order of magnitude.
pub const UNIFORM_SECONDS: f64 = 0.01;
/// Particle-steps per second of lavapipe on two cores, closest-approach at 100,000 particles (`cargo bench --bench step`).
pub const USUAL_RATE: f64 = 3.0e6;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    pub particle_steps: f64,
    /// Of the device.
    pub seconds: f64,
}

/// `in_cell` particles lie in a cell. A further round looks at those whose collision the rounds before have lost.
fn bytes(method: Method, rounds: u32, collisions_per_step: f64, in_cell: f64) -> f64 {
    match method {
        Method::ClosestApproach | Method::HardSphere => {
            let further: f64 = (1..rounds).map(|round| lost_events(collisions_per_step, round)).sum();
            SEARCH * in_cell / USUAL_IN_CELL + REST + ROUND * further
        }
        Method::Cell | Method::HalfTurn => CELL,
        Method::None | Method::ControlVolume => FREE,
    }
}

impl Cost {
    /// `particles`: the mean over the run, one whose steps are halved counting twice; `density` at its end; `rate`:
    /// particle-steps per second at the plan's own choice.
    pub fn of(method: Method, resolution: &Resolution, particles: f64, density: f64, rate: f64) -> Cost {
        let particle_steps = particles * resolution.steps as f64;
        let in_cell = density * resolution.cell * resolution.cell * resolution.cell;
        let one = bytes(method, resolution.rounds, resolution.collisions_per_step, in_cell);
        let usual = bytes(Method::ClosestApproach, USUAL_ROUNDS, USUAL_STEP, USUAL_IN_CELL);
        Cost { particle_steps, seconds: particle_steps / rate * one / usual }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One round at the usual step is the prototype's 212 bytes; further ones look at ever fewer particles.
    #[test]
    fn traffic_of_a_particle_step() {
        let closest = |rounds| bytes(Method::ClosestApproach, rounds, USUAL_STEP, USUAL_IN_CELL);
        assert_eq!(closest(1), 212.0);
        assert!(closest(2) - closest(1) > 2.0 * (closest(3) - closest(2)) && closest(8) < 260.0);
        assert!(bytes(Method::ClosestApproach, 8, USUAL_STEP, 3.2) > 2.0 * closest(8));
        assert!(bytes(Method::Cell, 0, 1.0, 6.0) < closest(1) && bytes(Method::None, 0, 0.0, 1.0) == 64.0);
    }
}
