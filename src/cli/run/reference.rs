//! The control-volume reference at any time of the run: solved once before it on a fine grid of times, linear
//! between them. It depends on the scene and the plan alone, so rows are the same however a run is batched.
//!
//! Where the gas moves fabric, volumes are known as far as the run has come: then it is solved anew at each row, with those of the rows.

use crate::gas::State;
use crate::simulation::{Model, Row, reference, reference_of_volumes};

/// Intervals of the grid: 50 us of a tank test of 100 ms, whose pressures take milliseconds.
const INTERVALS: usize = 2000;

pub struct Reference {
    /// s.
    spacing: f64,
    /// By time, then chamber.
    states: Vec<Vec<State>>,
    /// Times of rows, s, and the volumes of chambers then, m3: where the gas moves fabric.
    seen: (Vec<f64>, Vec<Vec<f64>>),
}

impl Reference {
    pub fn new(model: &Model) -> Reference {
        let end_time = model.plan.end_time;
        let times: Vec<f64> = (0..=INTERVALS).map(|k| end_time * k as f64 / INTERVALS as f64).collect();
        Reference {
            spacing: end_time / INTERVALS as f64,
            states: reference(model, &times),
            seen: (Vec::new(), Vec::new()),
        }
    }

    /// Takes in the volumes of a row, if the gas moves them.
    pub fn follow(&mut self, model: &Model, row: &Row) {
        if model.fabric.is_elastic() {
            self.see(row.time, row.chambers.iter().map(|chamber| chamber.volume).collect());
            self.spacing = f64::INFINITY;
            let now = reference_of_volumes(model, &self.seen.0, &self.seen.1);
            self.states = vec![now; 2];
        }
    }

    /// What a row of an earlier part of the run had: its time, s, and the volumes of chambers, m3.
    pub fn see(&mut self, time: f64, volumes: Vec<f64>) {
        self.seen.0.push(time);
        self.seen.1.push(volumes);
    }

    /// Pressure, Pa, and temperature, K, of a chamber at `time`, s; held beyond the ends.
    pub fn at(&self, time: f64, chamber: usize) -> [f64; 2] {
        let place = (time / self.spacing).clamp(0.0, (self.states.len() - 1) as f64);
        let low = (place as usize).min(self.states.len() - 2);
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
        let states = (0..=INTERVALS).map(|k| vec![state(k)]).collect();
        Reference { spacing: 1e-3, states, seen: (Vec::new(), Vec::new()) }
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
