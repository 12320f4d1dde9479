//! The control-volume reference at any time of the run: solved once before it on a fine grid of times, linear
//! between them. It depends on the scene and the plan alone, so rows are the same however a run is batched.

use crate::gas::State;
use crate::simulation::{Model, reference};

/// Intervals of the grid: 50 us of a tank test of 100 ms, whose pressures take milliseconds.
const INTERVALS: usize = 2000;

pub struct Reference {
    /// s.
    spacing: f64,
    /// By time, then chamber.
    states: Vec<Vec<State>>,
}

impl Reference {
    pub fn new(model: &Model) -> Reference {
        let end_time = model.plan.end_time;
        let times: Vec<f64> = (0..=INTERVALS).map(|k| end_time * k as f64 / INTERVALS as f64).collect();
        Reference { spacing: end_time / INTERVALS as f64, states: reference(model, &times) }
    }

    /// Pressure, Pa, and temperature, K, of a chamber at `time`, s; held beyond the ends.
    pub fn at(&self, time: f64, chamber: usize) -> [f64; 2] {
        let place = (time / self.spacing).clamp(0.0, INTERVALS as f64);
        let low = (place as usize).min(INTERVALS - 1);
        let (a, b) = (&self.states[low][chamber], &self.states[low + 1][chamber]);
        let between = |a: f64, b: f64| a + (b - a) * (place - low as f64);
        [between(a.pressure, b.pressure), between(a.temperature, b.temperature)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Reference {
        let state = |k: usize| State { pressure: k as f64, temperature: 300.0, moles: Vec::new(), energy: 0.0 };
        Reference { spacing: 1e-3, states: (0..=INTERVALS).map(|k| vec![state(k)]).collect() }
    }

    #[test]
    fn it_is_linear_between_its_times_and_held_beyond() {
        let pressure = |time| ramp().at(time, 0)[0];
        assert!((pressure(1.25e-3) - 1.25).abs() < 1e-12);
        assert!((pressure(1.9995) - 1999.5).abs() < 1e-9);
        assert_eq!([pressure(-1.0), pressure(2.0), pressure(9.0)], [0.0, 2000.0, 2000.0]);
        assert_ne!(pressure(1.25e-3), 1.0);
    }
}
