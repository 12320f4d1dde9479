//! What is varied: all axes, their values, and the limits that guard runs.

use crate::gas::kinetics::HALF_TURN_PATHS;
use crate::plan::{Bound, Quantity, limit, step_limit};
use crate::scene::Method;

use super::{Axis, ROUNDS, at_rest, flows, half_turn};

const COLLIDING: &[Method] = &[Method::ClosestApproach, Method::HardSphere, Method::Cell];
const ALL: &[Method] = &[Method::ClosestApproach, Method::HardSphere, Method::Cell, Method::None];
const HALF_TURN: &[Method] = &[Method::HalfTurn];
/// With the method without a diameter.
const WITH_HALF_TURN: &[Method] = &[Method::ClosestApproach, Method::HardSphere, Method::Cell, Method::HalfTurn];

fn of_table(quantity: Quantity) -> impl Fn(Method) -> Option<Bound> {
    move |method| limit(quantity, method).map(|limit| limit.bound)
}

/// All axes, in the order of the maps.
pub const AXES: &[Axis] = &[
    Axis {
        name: "time-step",
        what: "x = dt/tau, 8 rounds",
        runs: "gas at rest in a box at occupancy 0.1 (rigid spheres 0.03, against Carnahan and Starling's pressure), the step held against the ladder",
        methods: COLLIDING,
        quick: &[0.2, 2.0],
        usual: &[0.05, 0.1, 0.3, 1.0, 2.0, 4.0],
        full: &[0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0],
        limit: |method| Some(Bound::AtMost(step_limit(method, ROUNDS))),
        run: at_rest::time_step,
    },
    Axis {
        name: "rounds",
        what: "rounds R at x = 0.2",
        runs: "as time-step",
        methods: &[Method::ClosestApproach],
        quick: &[4.0, 1.0],
        usual: &[8.0, 3.0, 2.0, 1.0],
        full: &[8.0, 6.0, 5.0, 4.0, 3.0, 2.0, 1.0],
        // The fewest rounds whose limit is x = .2.
        limit: |method| (1..=8).find(|&r| step_limit(method, r) >= 0.2).map(|r| Bound::AtLeast(f64::from(r))),
        run: at_rest::rounds,
    },
    Axis {
        name: "occupancy",
        what: "occupancy f",
        runs: "gas at rest in a box at x = 0.2",
        methods: COLLIDING,
        quick: &[0.1, 0.3],
        usual: &[0.0025, 0.01, 0.1, 0.3, 0.4],
        full: &[0.001, 0.0025, 0.005, 0.01, 0.03, 0.1, 0.2, 0.3, 0.4],
        limit: |method| of_table(Quantity::Occupancy)(method),
        run: at_rest::occupancy,
    },
    Axis {
        name: "particles",
        what: "particles in all",
        runs: "as occupancy, at occupancy 0.1 (rigid spheres as in time-step), runs as much longer",
        methods: WITH_HALF_TURN,
        quick: &[2000.0, 200.0],
        usual: &[2000.0, 500.0, 100.0],
        full: &[16000.0, 4000.0, 2000.0, 1000.0, 500.0, 200.0, 100.0],
        limit: |method| of_table(Quantity::Particles)(method),
        run: at_rest::particles,
    },
    Axis {
        name: "gap",
        what: "width of a slit over the collision diameter",
        runs: "gas at rest in a slit, at the occupancy of time-step and x = 0.2",
        methods: COLLIDING,
        quick: &[2.0, 0.5],
        usual: &[4.0, 2.0, 1.0, 0.5, 0.25],
        full: &[8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.1],
        limit: |method| of_table(Quantity::Gap)(method),
        run: at_rest::gap,
    },
    Axis {
        name: "mass-ratio",
        what: "heavier over lighter gas, half each",
        runs: "two gases at rest in a box, x = 0.2 of the mean mass",
        methods: COLLIDING,
        quick: &[7.0, 70.0],
        usual: &[1.0, 7.0, 70.0],
        full: &[1.0, 2.0, 7.0, 20.0, 40.0, 70.0],
        limit: |_| None,
        run: at_rest::mass_ratio,
    },
    Axis {
        name: "knudsen",
        what: "Knudsen number of a hole, of its radius, at the start",
        runs: "discharge through a square hole into near-vacuum against the 0.84 of a continuum, of at most 64,000 particles at \
               occupancy 0.12 (rigid spheres 0.03) where the noise of 8,000 allows",
        methods: ALL,
        quick: &[0.3, 1.0],
        usual: &[0.1, 0.3, 1.0],
        full: &[0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0, 10.0],
        limit: |method| match method {
            // Its limit is of the molecules of the gas.
            Method::None => None,
            _ => of_table(Quantity::Knudsen)(method),
        },
        run: flows::knudsen,
    },
    Axis {
        name: "cell-edge",
        what: "edge of a cell over the mean free path before a hole",
        runs: "as knudsen, of a hole of Knudsen number 0.1 and as many particles as this takes, against the flow that forecasts say",
        methods: &[Method::Cell],
        quick: &[7.0, 10.0],
        usual: &[4.2, 5.0, 6.0, 8.0, 10.0],
        full: &[4.2, 4.6, 5.0, 5.5, 6.0, 7.0, 8.0, 10.0, 12.0],
        limit: |_| None,
        run: flows::cell_edge,
    },
    Axis {
        name: "spacings-flown",
        what: "mean spacings that thermal speed flies in a step, c0 dt/d",
        runs: "gas at rest in a box, and its viscosity, of vortices in a box, against 0.21 d c0",
        methods: HALF_TURN,
        quick: &[0.6, 2.0],
        usual: &[0.3, 0.6, 1.0, 1.5, 2.0],
        full: &[0.1, 0.3, 0.6, 0.8, 1.0, 1.25, 1.5, 2.0, 3.0],
        limit: |method| Some(Bound::AtMost(step_limit(method, 0))),
        run: half_turn::spacings_flown,
    },
    Axis {
        name: "members",
        what: "mean particles in a tile of 4^3 cells, the largest collision cell",
        runs: "viscosity, of vortices in a box, against 0.21 d c0, on grids made for denser gas",
        methods: HALF_TURN,
        quick: &[112.0, 2.0],
        usual: &[112.0, 14.0, 10.0, 8.0, 6.0, 4.0, 2.0],
        full: &[900.0, 112.0, 28.0, 14.0, 12.0, 10.0, 8.0, 7.0, 6.0, 5.0, 4.0, 2.0],
        limit: |method| of_table(Quantity::CellParticles)(method),
        run: half_turn::members,
    },
    Axis {
        name: "across",
        what: "mean spacings across a hole, D/d, at the start",
        runs: "discharge through a square hole into near-vacuum against the 0.84 of a continuum, at most eight runs of each",
        methods: HALF_TURN,
        quick: &[10.0, 3.0],
        usual: &[20.0, 14.0, 10.0, 7.0, 5.0, 3.0],
        full: &[24.0, 20.0, 16.0, 14.0, 12.0, 10.0, 8.0, 6.0, 5.0, 4.0, 3.0, 2.0],
        // The hole's Knudsen number is by a mean free path of so many spacings over its radius.
        limit: |method| {
            let knudsen = limit(Quantity::Knudsen, method)?.bound.value();
            Some(Bound::AtLeast(2.0 * HALF_TURN_PATHS[0] / knudsen))
        },
        run: half_turn::across,
    },
    Axis {
        name: "wall-speed",
        what: "speed of a piston over sqrt(kT/m)",
        runs: "a piston that starts at once into gas at rest, until its shock is near the far end, against Rankine and Hugoniot",
        methods: ALL,
        quick: &[0.2, 1.0],
        usual: &[0.2, 0.5, 1.0, 2.0],
        full: &[0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 3.0, 5.0],
        limit: |_| None,
        run: flows::wall_speed,
    },
    Axis {
        name: "density-ratio",
        what: "density left over right of a shock tube, at one temperature",
        runs: "tube against the exact Riemann solution, until its front is .4 of the tube's length away, at t = 0.15 at the latest",
        methods: ALL,
        quick: &[8.0, 100.0],
        usual: &[10.0, 30.0, 100.0, 1000.0],
        full: &[2.0, 10.0, 30.0, 100.0, 300.0, 1000.0],
        limit: |_| None,
        run: flows::density_ratio,
    },
    Axis {
        name: "temperature-ratio",
        what: "temperature left over right of a shock tube, at one density",
        runs: "as density-ratio",
        methods: ALL,
        quick: &[4.0, 100.0],
        usual: &[10.0, 100.0],
        full: &[2.0, 5.0, 10.0, 30.0, 100.0],
        limit: |_| None,
        run: flows::temperature_ratio,
    },
    Axis {
        name: "mach",
        what: "Mach number of a jet",
        runs: "a jet doubles the gas of a box of 1 L in 1 ms; judged when that has come to rest, 2 to 4 ms later",
        methods: ALL,
        quick: &[1.0, 4.0],
        usual: &[1.0, 2.0, 4.0, 8.0],
        full: &[0.5, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0],
        limit: |_| None,
        run: flows::mach,
    },
];
