//! Why a scene cannot be planned.

use super::text::significant;
use crate::geometry::GridError;
use crate::scene::shown_collision_number;

/// A particle's id and its gas share one 32-bit word on the device: 27 bits of id, one that tells the side of closed fabric, 4 of gas.
pub const MOST_PARTICLES: u64 = (1 << 27) - 1;
pub const MOST_GASES: usize = 16;
pub const MOST_ROUNDS: u32 = 8;
/// Cell numbers are 32-bit on the device, with a bit to spare.
pub const MOST_CELLS: usize = 1 << 31;

/// What a jet is that is beyond the largest Mach number, or faster than its enthalpy allows.
fn too_fast(mach: f64) -> String {
    if mach.is_finite() {
        format!("would have Mach number {}", significant(mach))
    } else {
        "is faster than gas of that temperature can flow, sqrt(2 cp T0)".into()
    }
}

#[derive(Debug, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum PlanError {
    #[error("the scene holds no gas: no chamber has any, and no orifice delivers any before the end time")]
    #[diagnostic(help("give a chamber a pressure, or an orifice a mass flow within the run"))]
    NoGas,
    #[error("chamber `{chamber}` has {moles:.3e} mol of gas but no particle at {moles_per_particle:.3e} mol each")]
    #[diagnostic(help("{}", for_a_particle(*needed)))]
    EmptyChamber { chamber: String, moles: f64, moles_per_particle: f64, needed: u64 },
    #[error("chamber `{chamber}` has a volume of {volume} m3")]
    #[diagnostic(help(
        "its region must overlap the gas space enclosed by the walls; where regions overlap the earlier chamber has the gas, so a larger one comes later"
    ))]
    NoVolume { chamber: String, volume: f64 },
    #[error(
        "orifice `{orifice}`: a jet of {} m/s at a stagnation temperature of {} K {}; Mach {}, {} m/s, is the largest",
        significant(*velocity), significant(*temperature), too_fast(*mach), significant(*limit), significant(*fastest)
    )]
    #[diagnostic(help("give the jet a smaller `velocity`, or a `mach`, or the gas a higher `temperature`"))]
    JetTooFast { orifice: String, velocity: f64, temperature: f64, mach: f64, limit: f64, fastest: f64 },
    #[error("{volumes} volumes were measured for {chambers} chambers")]
    Volumes { volumes: usize, chambers: usize },
    #[error("{particles} particles are more than the {limit} that an id can name")]
    #[diagnostic(help("set a smaller `particles` in [model]"))]
    TooManyParticles { particles: u64, limit: u64 },
    #[error("{found} gases are more than the {limit} that a particle can tell apart")]
    #[diagnostic(help("merge gases of like molar mass and heat capacity"))]
    TooManyGases { found: usize, limit: usize },
    #[error(
        "gas `{gas}`: no gas can have this cp(T): between {} and {} K, the temperatures of the scene, it falls to that of a \
         gas without internal energy or below (cv {} J/(mol K) at the end where it is less)",
        significant(range[0]), significant(range[1]), significant(*least)
    )]
    #[diagnostic(help(
        "cp must be above 5/2 R = 20.79 J/(mol K) there: check the coefficients and their units; outside the \
         temperatures it was made for a polynomial may run anywhere"
    ))]
    HeatCapacityLow { gas: String, range: [f64; 2], least: f64 },
    #[error(
        "gas `{gas}`: between {} and {} K, the temperatures of the scene, the nearest heat capacity that a gas of \
         particles can have is off by {residual:.2} %; {limit} % is allowed",
        significant(range[0]), significant(range[1])
    )]
    #[diagnostic(help(
        "the internal energy of particles must be that of a partition function: a cp(T) that falls with the temperature \
         is none; give a constant `cp`, or coefficients fitted to the temperatures of the scene"
    ))]
    HeatCapacity { gas: String, range: [f64; 2], residual: f64, limit: f64 },
    #[error("no plan is predicted to be within {}: the best, {best}", significant(*asked))]
    #[diagnostic(help("{remedy}"))]
    Accuracy { asked: f64, floor: f64, best: String, remedy: String },
    #[error(
        "a time budget of {} s is not enough for any plan: the cheapest, {plan}, is predicted to take {} s",
        significant(*budget), significant(*least)
    )]
    #[diagnostic(help(
        "raise it, or set `device_rate` in [model] to what `cargo bench --bench step` prints for your device"
    ))]
    TimeBudget { budget: f64, least: f64, plan: String },
    #[error("an accuracy or a budget together with [[motion]]: errors beside moving walls are not predicted yet")]
    #[diagnostic(help("leave out `accuracy`, `time_budget` and `particle_budget`, and set `particles` in [model]"))]
    WishOfMotion,
    #[error("an accuracy or a budget together with the method `control-volume`: {why}")]
    #[diagnostic(help(
        "leave out `method` in [model]: the plan takes one whose error is predicted; or leave out the wish"
    ))]
    WishOfControlVolume { why: &'static str },
    #[error(
        "{asked}: {} % of the gas space belongs to no chamber and is empty at the start (chambers of {} m3 in {} m3)",
        significant(100.0 * (1.0 - chambers / gas)), significant(*chambers), significant(*gas)
    )]
    #[diagnostic(help(
        "give that space a chamber of little gas (each chamber takes a particle at least), or leave out what is asked for: particles fill it"
    ))]
    EmptySpace { asked: &'static str, chambers: f64, gas: f64 },
    #[error("an accuracy or a budget together with `switch`: what a switch saves is not predicted yet")]
    #[diagnostic(help("leave out the wish, or `switch` in [model]"))]
    WishOfSwitch,
    #[error("`diameter_cap` with the method `{method}`; only `closest-approach` has one")]
    #[diagnostic(help("leave out `diameter_cap` in [model], or choose another `method`"))]
    CapOf { method: &'static str },
    #[error(
        "`diameter_cap` of {} mean spacings, which is less than the diameter at the mean density, {} spacings",
        significant(*asked), significant(*spacings)
    )]
    #[diagnostic(help("set a smaller `occupancy` or `diameter` in [model], or a larger cap"))]
    CapOfAll { asked: f64, spacings: f64 },
    #[error("`switch` at, or `uniform_for`, {} s, which is not before the end of the run, {} s", significant(*at), significant(*end))]
    #[diagnostic(help("set a shorter time in [model], or leave `switch` out"))]
    SwitchTime { at: f64, end: f64 },
    #[error(
        "`switch = \"when-uniform\"` in a scene without probes and surfaces: nothing shows whether pressures are uniform"
    )]
    #[diagnostic(help("add a [[probe]] or a [[surface]], or give a time as `switch` in [model]"))]
    SwitchUnseen,
    #[error(
        "`switch = \"when-uniform\"` with surfaces and the method `hard-sphere`, whose spheres press a wall harder than a gas"
    )]
    #[diagnostic(help("choose another `method`, or give a time as `switch` in [model]"))]
    SwitchOfRigidSpheres,
    #[error("no method can run this scene with {particles} particles or more")]
    #[diagnostic(help(
        "leave out `diameter`, `rounds` or `particles` in [model]: one of them does not fit the vessel"
    ))]
    NoCandidate { particles: f64 },
    #[error("{found} rounds of pairing per step; from 1 to {limit} are possible")]
    #[diagnostic(help("leave `rounds` in [model] out for the cheapest number"))]
    Rounds { found: u32, limit: u32 },
    #[error("a collision number of {found} is less than the {:.4} that gas `{gas}` can relax with", shown_collision_number(*least))]
    #[diagnostic(help("set `collision_number` in [model] to at least {:.4}, or leave it out", shown_collision_number(*least)))]
    CollisionNumber { gas: String, found: f64, least: f64 },
    #[error("the cell grid does not fit: {0}")]
    #[diagnostic(help(
        "cells follow the collision diameter and the time step: use fewer particles, a larger `diameter` or \
         a larger `time_step` in [model], or a smaller vessel"
    ))]
    Grid(#[from] GridError),
    #[error("the cell grid has {cells} cells, more than the {limit} that can be numbered")]
    #[diagnostic(help("use fewer particles or a larger `diameter` in [model], or a smaller vessel"))]
    TooManyCells { cells: usize, limit: usize },
}

/// Where even the most particles of a run give a chamber none, only another scene does.
fn for_a_particle(needed: u64) -> String {
    if needed > MOST_PARTICLES {
        return format!(
            "even the most particles that a run may have, {MOST_PARTICLES}, give it none: leave its gas out (`pressure = \
             0`), or give it more"
        );
    }
    format!("give the chamber a particle: set `particles` in [model] to at least {needed}")
}
