//! What is seen of a vent: what it owes, and what it lately let out beside what it would of a gas at rest.

use serde::{Deserialize, Serialize};

/// A vent pays what it owes within so many intervals of its flow, or while so many particles leave.
pub const PAID_IN: f64 = 8.0;
pub const PAID_BY: f64 = 32.0;
/// Its flow is raised to so many times what the gas gives it, at most.
pub const MOST_RAISED: f64 = 4.0;
/// It is learnt over so many particles at least, and as many intervals as it pays in, what a beta lets out; a beta is corrected
/// by it so many times at most.
pub const LEARNT_BY: f64 = 256.0;
pub const MOST_CORRECTED: f64 = 2.0;

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct VentSeen {
    pub open: bool,
    /// kg; negative if too much has left.
    pub owed: f64,
    /// kg that have lately left, and that its beta would have let out of a gas at rest in the state of the chamber.
    pub left: f64,
    pub at_rest: f64,
    /// m2, of its place at the end of the interval; 0 before any.
    pub area: f64,
    /// Pa, lately on the sides of an open sheet, on that which its normals point to first; 0 before any was seen.
    pub sides: [f64; 2],
}

impl VentSeen {
    /// Takes in what left in an interval, and what of a gas at rest would have; `particle` is the mass of one, kg.
    pub fn learn(&mut self, left: f64, at_rest: f64, particle: f64) {
        self.left += left;
        self.at_rest += at_rest;
        let most = (PAID_IN * at_rest).max(LEARNT_BY * particle);
        let kept = (most / self.at_rest).min(1.0);
        if kept < 1.0 {
            self.left *= kept;
            self.at_rest *= kept;
        }
    }

    /// How many times as much leaves as of a gas at rest; one before anything is known.
    pub fn eagerness(&self, particle: f64) -> f64 {
        let unknown = (LEARNT_BY * particle - self.at_rest).max(0.0) / PAID_IN;
        ((self.left + unknown) / (self.at_rest + unknown)).clamp(1.0 / MOST_CORRECTED, MOST_CORRECTED)
    }
}
