//! Error against cost: what each method, with each of its settings, makes of a case whose answer is known.
//!
//! A [`Case`] says what is compared with what and lists settings; each is run with one seed or several and becomes a
//! [`Point`]: its error, and the seconds that the device took. [`front::front`] finds what nothing beats; settings
//! beyond the limits of their method are charted, marked, and not on the front.
//!
//! To add a case: a function like `sod::trials` and a line in [`CASES`].

pub mod front;
mod orifice;
mod piston;
mod point;
pub mod report;
mod setting;
mod sod;
mod tank;
mod trials;

use crate::study::StudyError;

pub use point::{Point, Timed, measure};
pub use setting::{Range, Setting, collision_time, denser, model_with};
pub use trials::{Build, Extent, Judge, Norm, Trials};

/// A problem with a known answer.
pub struct Case {
    pub name: &'static str,
    /// What is compared with what, and where the reference is from.
    pub law: &'static str,
    pub trials: fn(Extent) -> Result<Trials, StudyError>,
}

/// All cases.
pub const CASES: &[Case] = &[
    Case {
        name: "sod",
        law: "Sod's shock tube, gamma 7/5: density profile against the exact Riemann solution",
        trials: sod::trials,
    },
    Case {
        name: "tank",
        law: "scenes/tank.toml, first part: pressures of both chambers against the control volume",
        trials: tank::trials,
    },
    Case {
        name: "orifice",
        law: "discharge through a resolved hole into near-vacuum against that of a thin orifice in a continuum",
        trials: orifice::trials,
    },
    Case {
        name: "piston",
        law: "a piston at half the thermal speed: pressure on it against Rankine and Hugoniot",
        trials: piston::trials,
    },
];

#[cfg(test)]
mod tests;
