//! Diameter, rounds, time step and cell edge.

use super::error::MOST_ROUNDS;
use super::limits::step_limit;
use super::text::significant;
use super::{PlanError, Reason};
use crate::gas::kinetics;
use crate::scene::{Method, ModelRequest};

pub const LADDER_LEVELS: u32 = 12;
pub const STEPS_PER_INTERVAL: u32 = 32;
pub const TALLY_EVERY: u32 = 8;
/// Particles in a mean block of the coarse grid, at least.
pub(super) const PER_BLOCK: f64 = 64.0;
/// Particles in a cell of the method `cell`: the middle of the 4 to 8 of the measured viscosity (method.md, "Collisions").
pub const PER_CELL: f64 = 6.0;
/// In thin gas: one thread collides all of a cell.
const MOST_PER_CELL: f64 = 20.0;
/// f = .12, i.e. sigma = .61 d, lambda = sigma (docs/explanation/method.md, "What the plan decides, and why").
const DEFAULT_OCCUPANCY: f64 = 0.12;
/// Of rigid spheres, whose pressure is 4 % off there.
const RIGID_OCCUPANCY: f64 = 0.01;
const DEFAULT_ROUNDS: u32 = 8;
/// A cell edge must not fall short of its rule by rounding.
const EDGE_MARGIN: f64 = 1.0001;
/// Relative speeds above this many sqrt(kT/m) do not occur in practice.
pub const FASTEST_PAIR: f64 = 6.0;
/// 99.9 % of the molecules are slower than this many sqrt(kT/m).
const FAST_PARTICLE: f64 = 4.04;
/// Edge of a collision cell of the method `half-turn` in mean spacings of its gas: 14 particles.
pub const COLLISION_CELL: f64 = 2.41;
/// Cells of the grid along an edge of its largest one, a tile.
pub const TILE_EDGE: f64 = 4.0;
/// Mean spacings that gas of thermal speed flies in a step of the method `half-turn`: by the plan, and at most before a run halves the step. At 1 its
/// viscosity is half as much again.
pub const SPACINGS_FLOWN: f64 = 0.6;
const MOST_SPACINGS_FLOWN: f64 = 0.75;
/// 99.97 %: the step is halved where more than .1 % cross a cell, and noise must not do that.
const SURELY_FAST: f64 = 4.4;

/// Share of the particles that may be in blocks beyond the collision limit: local peaks of a few noisy blocks do not set the
/// step of all.
pub const LADDER_TAIL: f64 = 0.02;
/// Standard errors of a block: two leave 2 % of the particles in denser and hotter ones, and a third is for how that varies
/// from interval to interval.
const SCATTER: f64 = 3.0;
/// Those of the tail alone: what a step may be without being halved.
const TAIL_SCATTER: f64 = 2.0;
/// Of a step, down to the ladder's smallest.
const MOST_HALVINGS: u32 = LADDER_LEVELS - 1;

/// That of a scene that says nothing.
pub fn default_occupancy(method: Method) -> f64 {
    match method {
        Method::HardSphere => RIGID_OCCUPANCY,
        Method::ClosestApproach | Method::Cell | Method::HalfTurn | Method::None | Method::ControlVolume => {
            DEFAULT_OCCUPANCY
        }
    }
}

/// A uniform state of the modelled gas.
#[derive(Debug, Clone, Copy)]
pub struct MeanState {
    /// Particles per m3.
    pub number_density: f64,
    /// kT/m, m2/s2.
    pub thermal_square: f64,
}

/// kT/m of the lightest gas at the highest temperature, m2/s2.
#[derive(Debug, Clone, Copy)]
pub struct Extreme(pub f64);

/// What the run is thought to hold.
#[derive(Debug, Clone, Copy)]
pub struct ExpectedGas {
    /// The mean states at the start and the end; sizes follow that at the end.
    pub states: [MeanState; 2],
    pub extreme: Extreme,
}

pub struct Resolution {
    pub method: Method,
    /// m; 0 where particles have none.
    pub diameter: f64,
    pub rounds: u32,
    pub collision_limit: f64,
    pub time_step: f64,
    pub steps: u64,
    pub cell: f64,
    /// x = dt/tau of the denser of the two mean states.
    pub collisions_per_step: f64,
    /// |v| dt of all but .1 % of the fastest gas, over the cell edge.
    pub flight_over_cell: f64,
}

impl Resolution {
    /// For a run of this length, s.
    pub fn choose(
        method: Method,
        request: &ModelRequest,
        gas: ExpectedGas,
        end_time: f64,
        reasons: &mut Vec<Reason>,
    ) -> Result<Self, PlanError> {
        match method {
            // Control volumes have no particles, and need no resolution.
            Method::None | Method::ControlVolume => Ok(Self::free_flight(method, request, gas, end_time, reasons)),
            Method::Cell => Ok(Self::within_cells(request, gas, end_time, reasons)),
            Method::HalfTurn => Ok(Self::half_turn(request, gas, end_time, reasons)),
            Method::ClosestApproach | Method::HardSphere => Self::in_rounds(method, request, gas, end_time, reasons),
        }
    }

    /// x = dt/tau of gas in such a state whose particles have such a diameter, m; of `half-turn`, which has none, the
    /// mean spacings that a particle of thermal speed flies.
    pub fn collisions_in_step(&self, state: MeanState, diameter: f64) -> f64 {
        match self.method {
            Method::HalfTurn => spacings_flown(self.time_step, state),
            _ => self.time_step / kinetics::collision_time(state.number_density, diameter, state.thermal_square),
        }
    }

    /// Whether blocks of uniform gas of this density (at the end, 1/m3) that are denser by chance do not halve the step.
    pub fn has_room(&self, number_density: f64) -> bool {
        self.collisions_per_step * unevenness(number_density * self.cell.powi(3), SCATTER) <= self.collision_limit
    }

    /// How many steps a run makes of one: in gas of this x, whose blocks scatter as those of this mean number density.
    pub fn halved(&self, x: f64, number_density: f64) -> f64 {
        let uneven = x * unevenness(number_density * self.cell.powi(3), TAIL_SCATTER);
        let enough = (0..MOST_HALVINGS).find(|&level| libm::ldexp(uneven, -(level as i32)) <= self.collision_limit);
        libm::ldexp(1.0, enough.unwrap_or(MOST_HALVINGS) as i32)
    }

    fn in_rounds(
        method: Method,
        request: &ModelRequest,
        gas: ExpectedGas,
        end_time: f64,
        reasons: &mut Vec<Reason>,
    ) -> Result<Self, PlanError> {
        let ExpectedGas { states, extreme } = gas;
        let mut because = |quantity: &str, value: String, why: String| {
            reasons.push(Reason { quantity: quantity.into(), value, why });
        };
        let density = states[1].number_density;
        let (diameter, why) = diameter(method, request, density);
        because("diameter", format!("{} mm", significant(1e3 * diameter)), why);

        let rounds = request.rounds.unwrap_or(DEFAULT_ROUNDS);
        if rounds == 0 || rounds > MOST_ROUNDS {
            return Err(PlanError::Rounds { found: rounds, limit: MOST_ROUNDS });
        }
        let limit = step_limit(method, rounds);
        let why = match request.rounds {
            Some(_) => format!("asked for; at most 2 % of collisions are lost up to dt = {limit} tau"),
            None => format!(
                "allows dt = {limit} tau; later rounds look only at particles that a collision may have changed, and cost little"
            ),
        };
        because("rounds", rounds.to_string(), why);

        let fastest = FASTEST_PAIR * extreme.0.sqrt();
        let tau = states
            .iter()
            .map(|state| kinetics::collision_time(state.number_density, diameter, state.thermal_square))
            .fold(f64::INFINITY, f64::min);
        let edge = |step: f64| {
            let reach = 0.5 * fastest * step;
            // At its closest approach a pair is perpendicular to its relative velocity; rigid spheres meet earlier.
            match method {
                Method::HardSphere => diameter + reach,
                _ => (diameter * diameter + reach * reach).sqrt(),
            }
        };
        let by_cell = diameter / fastest;
        let by_rate = limit * tau / unevenness(density * edge(limit * tau).powi(3), SCATTER);
        let (wanted, why) = match request.time_step {
            Some(step) => (step, "asked for, cut to divide the end time".to_string()),
            None if by_cell <= by_rate => {
                (by_cell, "the fastest pairs close in by no more than a diameter: cells stay small".to_string())
            }
            None => {
                let share = significant(by_rate / tau);
                (
                    by_rate,
                    format!(
                        "{share} of the mean collision time: {limit}, for {rounds} rounds, in the densest blocks of gas"
                    ),
                )
            }
        };
        let (time_step, steps) = divide(end_time, wanted);
        because("time step", format!("{} us", significant(1e6 * time_step)), why);
        let cell = EDGE_MARGIN * edge(time_step);
        because(
            "cell",
            format!("{} mm", significant(1e3 * cell)),
            "no pair that meets within the step lies further apart than neighbouring cells".into(),
        );
        Ok(Self {
            method,
            diameter,
            rounds,
            collision_limit: limit,
            time_step,
            steps,
            cell,
            collisions_per_step: time_step / tau,
            flight_over_cell: FAST_PARTICLE * extreme.0.sqrt() * time_step / cell,
        })
    }

    /// The method `cell`: a cell of a few particles, steps in which almost none crosses more than that, x <= 2.
    fn within_cells(request: &ModelRequest, gas: ExpectedGas, end_time: f64, reasons: &mut Vec<Reason>) -> Self {
        let ExpectedGas { states, extreme } = gas;
        let mut because = |quantity: &str, value: String, why: String| {
            reasons.push(Reason { quantity: quantity.into(), value, why });
        };
        let limit = step_limit(Method::Cell, 0);
        let density = states[1].number_density;
        let (diameter, why) = diameter(Method::Cell, request, density);
        because("diameter", format!("{} mm", significant(1e3 * diameter)), why);
        let path = kinetics::mean_free_path(density, diameter);
        let [few, many] = cell_bounds(density);
        let cell = cell_edge(density, diameter);
        let why = if path > many {
            format!("{MOST_PER_CELL} particles at the mean density of the end; the mean free path is longer")
        } else if path > few {
            "the mean free path at the end: what is shorter is no gradient of the gas".to_string()
        } else {
            format!("{PER_CELL} particles at the mean density of the end; {} mean free paths", significant(few / path))
        };
        because("cell", format!("{} mm", significant(1e3 * cell)), why);
        let tau = states
            .iter()
            .map(|state| kinetics::collision_time(state.number_density, diameter, state.thermal_square))
            .fold(f64::INFINITY, f64::min);
        let speed = FAST_PARTICLE * extreme.0.sqrt();
        let by_cell = cell / (SURELY_FAST * extreme.0.sqrt());
        let by_rate = limit * tau / unevenness(density * cell.powi(3), SCATTER);
        let (wanted, why) = match request.time_step {
            Some(step) => (step, "asked for, cut to divide the end time".to_string()),
            None if by_cell <= by_rate => {
                (by_cell, "99.97 % of the hottest particles fly no further than a cell".to_string())
            }
            None => (
                by_rate,
                format!("{} mean collision times: {limit} in the densest blocks of gas", significant(by_rate / tau)),
            ),
        };
        let (time_step, steps) = divide(end_time, wanted);
        because("time step", format!("{} us", significant(1e6 * time_step)), why);
        let collisions_per_step = time_step / tau;
        let in_cell = 0.5 * density * cell * cell * cell * collisions_per_step;
        let why = format!("expected in a step; {} per particle, {limit} at most", significant(collisions_per_step));
        because("collisions per cell", significant(in_cell), why);
        Self {
            method: Method::Cell,
            diameter,
            rounds: 0,
            collision_limit: limit,
            time_step,
            steps,
            cell,
            collisions_per_step,
            flight_over_cell: speed * time_step / cell,
        }
    }

    /// The method `half-turn`: cells of the grid an eighth of the volume of a collision cell at the mean density of the end, steps in which the hottest gas flies
    /// some half a mean spacing.
    fn half_turn(request: &ModelRequest, gas: ExpectedGas, end_time: f64, reasons: &mut Vec<Reason>) -> Self {
        let ExpectedGas { states, extreme } = gas;
        let mut because = |quantity: &str, value: String, why: String| {
            reasons.push(Reason { quantity: quantity.into(), value, why });
        };
        let spacing = kinetics::mean_spacing(states[1].number_density);
        let cell = 0.5 * COLLISION_CELL * spacing;
        let why = format!(
            "half the edge of a collision cell of {:.0} particles at the mean density of the end; where gas is thinner or denser collision cells follow, by halves",
            COLLISION_CELL.powi(3)
        );
        because("cell", format!("{} mm", significant(1e3 * cell)), why);
        let most = states.map(|state| state.number_density).into_iter().fold(0.0, f64::max);
        let densest = MeanState { number_density: most, thermal_square: extreme.0 };
        let (wanted, why) = match request.time_step {
            Some(step) => (step, "asked for, cut to divide the end time".to_string()),
            None => (
                SPACINGS_FLOWN / spacings_flown(1.0, densest),
                format!(
                    "the hottest gas flies {SPACINGS_FLOWN} mean spacings a step, {MOST_SPACINGS_FLOWN} at most where it is denser"
                ),
            ),
        };
        let (time_step, steps) = divide(end_time, wanted);
        because("time step", format!("{} us", significant(1e6 * time_step)), why);
        let flown = states.map(|state| spacings_flown(time_step, state)).into_iter().fold(0.0, f64::max);
        Self {
            method: Method::HalfTurn,
            diameter: 0.0,
            rounds: 0,
            collision_limit: MOST_SPACINGS_FLOWN,
            time_step,
            steps,
            cell,
            collisions_per_step: flown,
            flight_over_cell: FAST_PARTICLE * extreme.0.sqrt() * time_step / (TILE_EDGE * cell),
        }
    }

    fn free_flight(
        method: Method,
        request: &ModelRequest,
        gas: ExpectedGas,
        end_time: f64,
        reasons: &mut Vec<Reason>,
    ) -> Self {
        let cell = kinetics::mean_spacing(gas.states[1].number_density);
        let speed = FAST_PARTICLE * gas.extreme.0.sqrt();
        let (wanted, why) = match request.time_step {
            Some(step) => (step, "asked for, cut to divide the end time"),
            None => (cell / speed, "99.9 % of the particles fly no further than a cell"),
        };
        let (time_step, steps) = divide(end_time, wanted);
        let because =
            |quantity: &str, value: String, why: &str| Reason { quantity: quantity.into(), value, why: why.into() };
        reasons.push(because("time step", format!("{} us", significant(1e6 * time_step)), why));
        let value = format!("{} mm", significant(1e3 * cell));
        reasons.push(because("cell", value, "the mean spacing at the end; nothing is searched for in it"));
        Self {
            method,
            diameter: 0.0,
            rounds: 0,
            collision_limit: 0.0,
            time_step,
            steps,
            cell,
            collisions_per_step: 0.0,
            flight_over_cell: speed * time_step / cell,
        }
    }
}

/// Mean spacings that a particle of thermal speed sqrt(kT/m) flies in a time, s.
fn spacings_flown(time: f64, state: MeanState) -> f64 {
    time * state.thermal_square.sqrt() / kinetics::mean_spacing(state.number_density)
}

/// The mean free path, m, by which Knudsen numbers are counted.
pub(super) fn mean_free_path(method: Method, density: f64, diameter: f64) -> f64 {
    match method {
        Method::HalfTurn => kinetics::HALF_TURN_PATHS[0] * kinetics::mean_spacing(density),
        _ => kinetics::mean_free_path(density, diameter),
    }
}

/// The edge of a cell of the method `cell`, m, in gas of this density (1/m3) and collision diameter (m): a mean free path, within these bounds.
pub(super) fn cell_edge(density: f64, diameter: f64) -> f64 {
    let [few, many] = cell_bounds(density);
    kinetics::mean_free_path(density, diameter).clamp(few, many)
}

fn cell_bounds(density: f64) -> [f64; 2] {
    [PER_CELL, MOST_PER_CELL].map(|particles| libm::cbrt(particles / density))
}

/// The collision diameter, m, and why.
fn diameter(method: Method, request: &ModelRequest, density: f64) -> (f64, String) {
    let unasked = default_occupancy(method);
    match (request.diameter, request.occupancy) {
        (Some(diameter), _) => (diameter, "asked for".to_string()),
        (None, Some(f)) => (kinetics::diameter(density, f), format!("occupancy {f} asked for")),
        (None, None) if method == Method::HardSphere => (
            kinetics::diameter(density, unasked),
            format!("occupancy {unasked}: at more the pressure is far from the ideal gas's"),
        ),
        (None, None) => (
            kinetics::diameter(density, unasked),
            "0.61 of the mean spacing at the end (occupancy 0.12): more buys almost no resolution".to_string(),
        ),
    }
}

/// x of the densest and hottest blocks of a uniform gas, but for a tail, over the mean: steps that leave no room for it would be
/// halved all the time. A block has 2^k cells along an edge and at least [`PER_BLOCK`] of n particles; the density in which a
/// particle is scatters by 1/sqrt(n) around 1 + 1/n, the thermal speed by 1/sqrt(6 n).
fn unevenness(in_cell: f64, scatter: f64) -> f64 {
    let mut in_block = 8.0 * in_cell;
    while in_block > 0.0 && in_block < PER_BLOCK {
        in_block *= 8.0;
    }
    let in_block = in_block.max(PER_BLOCK);
    1.0 + 1.0 / in_block + scatter * (7.0 / 6.0 / in_block).sqrt()
}

/// The largest step of at most `wanted` of which the end time is an integer multiple, and that integer.
fn divide(end_time: f64, wanted: f64) -> (f64, u64) {
    // A step asked for as end / k must not become end / (k + 1) by rounding.
    let steps = (end_time / wanted - 1e-9).ceil().max(1.0);
    (end_time / steps, steps as u64)
}
