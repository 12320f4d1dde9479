//! Figures that a prototype on the CPU gave, and that no law gives: found again with this solver, in the cases of
//! `corpuscle verify --full` and by name.
//!
//! A check's reference is the prototype's figure, and its tolerance is what that is known to (viscosity 10 %, shock
//! tubes 5 %, orifices 2 %, rates .01) and three standard errors of the run, as root of the squares. Where theory says
//! otherwise, the reference is what it says, and the quantity names the figure. Where it says nothing and runs find another, the
//! figure stays, disputed. A note says why.

mod figure;
mod flights;
mod floors;
pub mod half_turn;
mod lost;
mod openings;
mod rigid;
mod tubes;

use super::Case;

/// All of them, in the order of the tables.
pub const FIGURES: &[Case] = &[
    Case {
        name: "lost-collisions",
        law: "the prototype's table of collisions over theory by rounds and step",
        run: lost::collisions,
    },
    Case {
        name: "rigid-spheres",
        law: "the prototype's pressures of hard-sphere, and its sound against that of Carnahan and Starling's gas",
        run: rigid::spheres,
    },
    Case {
        name: "viscosity-floor",
        law: "as viscosity, at the prototype's other occupancies and of the method cell",
        run: floors::viscosities,
    },
    Case {
        name: "sod-table",
        law: "the prototype's table of Sod's shock tube by method, particles, occupancy, step and rounds",
        run: tubes::table,
    },
    Case {
        name: "half-turn-flows",
        law: "half-turn: viscosity by collision cell and step, as the prototype found it",
        run: half_turn::flows,
    },
    Case {
        name: "half-turn-tubes",
        law: "half-turn: Sod's shock tube by particles, single runs and their mean, as the prototype found it",
        run: half_turn::tubes,
    },
    Case {
        name: "free-flight",
        law: "what the method none has wrong when a gas is compressed, and when a tank is filled: exact for free flight",
        run: flights::wrong,
    },
    Case {
        name: "constant-vent",
        law: "a vessel that empties through vents that each hit passes: effusion, d lnT / d lnN = (gamma-1)/2",
        run: openings::constant_probability,
    },
    Case {
        name: "small-difference",
        law: "the prototype's discharge of a hole into gas of .8 of the pressure, over the isentropic law",
        run: openings::small_difference,
    },
];
