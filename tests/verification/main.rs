//! Whole runs against closed forms: the reference cases of docs/reference/accuracy.md.
//!
//! Each case states its law, takes its tolerance from the statistics of the run (a fixed seed makes the
//! outcome of each the same every time), and shows that the check fails where the law does not hold.

mod capped;
mod cell;
mod collision_rate;
mod effusion;
mod energy_drift;
mod equilibrium_box;
mod equipartition;
mod filling;
mod half_turn;
mod half_turn_rows;
mod hard_sphere;
mod heat_curve;
mod long_steps;
mod membranes;
mod mixing;
mod orifice;
mod piston;
mod planner;
mod reference_cases;
mod starved;
mod statistics;
mod switch;
mod two_chambers;
mod vents;
mod vessels;
mod wall_hits;
mod wall_parts;
mod wall_pressure;
mod walls;
#[path = "../whole_run/mod.rs"]
mod whole_run;
