//! The limits within which a run of particles is right: one table. The plan and the guards of a run (`simulation/guards.rs`)
//! warn beyond them, and `corpuscle stability` measures where they lie ([docs/reference/limits.md](../../docs/reference/limits.md)).
//!
//! A limit is of a quantity and of one method, or of all that have no limit of their own. What is not in the table was
//! not found to break anything.

use serde::{Deserialize, Serialize};

use super::text::significant;
use crate::gas::vent::UNCLIPPED;
use crate::scene::Method;

/// What a limit is of. Checkpoints have its number: new ones come last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// x = dt/tau.
    Step,
    /// Collisions lost over those that should be.
    LostCollisions,
    /// n pi sigma^3 / 6.
    Occupancy,
    /// Of a resolved opening; of free flight that of the molecules themselves.
    Knudsen,
    /// Of the whole run.
    Particles,
    /// In the cube of an opening's length.
    OpeningParticles,
    ProbeParticles,
    /// Hits on walls of a mean particle in a step.
    WallHits,
    /// The narrowest passage over the collision diameter; of cells, over their edge.
    Gap,
    /// Of a chamber that others press into: the mean free path at the start over the cube root of the volume.
    ThinGas,
    /// What |v| dt of 99.9 % of the particles is at most, in cells.
    Flight,
    /// Halvings of the step that are left before the smallest.
    Halvings,
    /// Energy found over that which should be there, less 1.
    EnergyDrift,
    /// Hits on a vent whose probability of passing would be above one, over what passed.
    ClippedHits,
    /// The largest flux through a vent, over p / sqrt(R T / M) of its place.
    VentFlux,
    /// The same; all hits together have no more.
    VentHits,
    /// A heat-transfer coefficient over that of walls all of whose hits leave with their temperature.
    Heat,
    /// Of a wall, over sqrt(kT/m) of the coldest gas.
    WallSpeed,
    /// Of all particles, those that fly more than a cell in a step.
    FastParticles,
    /// Of the method `cell`, where a cell is at least a mean free path long; of the method `half-turn`, in a tile, its largest collision cell.
    CellParticles,
    /// How far the facets of a round wall lie from the round surface at most, over its radius.
    Facets,
    /// How thick a body is, or how wide a gap that faces gas, over the longest side of the vessel.
    Thickness,
    /// The mass of a particle over that of the lightest node of elastic fabric.
    NodeMass,
    Ripples,
}

impl Quantity {
    pub fn name(self) -> &'static str {
        match self {
            Quantity::Step => "time step over collision time",
            Quantity::LostCollisions => "share of collisions lost",
            Quantity::Occupancy => "occupancy",
            Quantity::Knudsen => "Knudsen number",
            Quantity::Particles => "particles",
            Quantity::OpeningParticles => "particles in the cube of its length",
            Quantity::ProbeParticles => "particles in it",
            Quantity::WallHits => "wall hits per particle and step",
            Quantity::Gap => "smallest passage over what collides across it",
            Quantity::ThinGas => "mean free path over the chamber's size",
            Quantity::Flight => "cells flown in a step",
            Quantity::FastParticles => "share of particles that fly more than a cell",
            Quantity::CellParticles => "particles in a collision cell",
            Quantity::Thickness => "thickness over the vessel's longest side",
            Quantity::NodeMass => "mass of a particle over that of the lightest node",
            Quantity::Ripples => "share of its area that ripples take",
            Quantity::Halvings => "halvings of the step left",
            Quantity::EnergyDrift => "drift of the energy",
            Quantity::ClippedHits => "share of clipped hits",
            Quantity::VentFlux => "largest flux over p/sqrt(RT) of its place",
            Quantity::VentHits => "largest flux over p/sqrt(RT) of all hits on it",
            Quantity::Heat => "heat-transfer coefficient over what all hits can carry",
            Quantity::WallSpeed => "speed over sqrt(kT/m) of the coldest gas",
            Quantity::Facets => "distance of facets from the round surface over its radius",
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bound {
    AtMost(f64),
    AtLeast(f64),
}

impl Bound {
    pub fn value(self) -> f64 {
        match self {
            Bound::AtMost(value) | Bound::AtLeast(value) => value,
        }
    }

    /// False for a NaN.
    pub fn holds(self, found: f64) -> bool {
        match self {
            Bound::AtMost(limit) => found <= limit,
            Bound::AtLeast(limit) => found >= limit,
        }
    }

    pub fn words(self) -> String {
        match self {
            Bound::AtMost(limit) => format!("at most {}", significant(limit)),
            Bound::AtLeast(limit) => format!("at least {}", significant(limit)),
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    pub quantity: Quantity,
    /// `None`: of all methods that have none of their own.
    pub method: Option<Method>,
    pub bound: Bound,
    /// What is wrong beyond it.
    pub effect: &'static str,
}

const fn limit_of(quantity: Quantity, method: Option<Method>, bound: Bound, effect: &'static str) -> Limit {
    Limit { quantity, method, bound, effect }
}

use Bound::{AtLeast, AtMost};

/// Share of the particles that may fly more than a cell in a step: beyond it the ladder halves the step.
pub const FAST_TAIL: f64 = 1e-3;

/// All limits. That of the step depends on the rounds: [`step_limit`].
pub const LIMITS: &[Limit] = &[
    limit_of(Quantity::LostCollisions, None, AtMost(0.03), "the gas is too viscous, and spin falls behind translation"),
    limit_of(Quantity::Occupancy, None, AtMost(0.3), "it costs search time and buys no resolution"),
    // Carnahan and Starling: 1 % at f = .0025.
    limit_of(
        Quantity::Occupancy,
        Some(Method::HardSphere),
        AtMost(0.0025),
        "rigid spheres press harder than a gas, and flow faster",
    ),
    limit_of(Quantity::Knudsen, None, AtMost(0.1), "its flow is off by 7 % or more"),
    // `stability knudsen` has 20 % too little at .1 and 37 % at .3, taken as proportional below. It is of the mean gas at the end; where
    // gas before a hole is four times as dense, cells are twelve free paths long at the occupancy of plans, and a hole of .03 acts
    // as one of .13 (`kinetics::viscosity_of_cells`).
    limit_of(Quantity::Knudsen, Some(Method::Cell), AtMost(0.03), "its flow is off by 7 % or more"),
    // Measured at f = .03: 24 % too much at .1, where the others hold. What rigid spheres press harder drives the flow; no
    // Knudsen number mends it.
    limit_of(
        Quantity::Knudsen,
        Some(Method::HardSphere),
        AtMost(0.1),
        "its flow is off by 7 % or more; within the limit, too, where rigid spheres press harder than a gas",
    ),
    limit_of(
        Quantity::Knudsen,
        Some(Method::None),
        AtLeast(1.0),
        "its molecules collide, and free flight is wrong by up to a quarter",
    ),
    limit_of(Quantity::Particles, None, AtLeast(1000.0), "they are few: pressures will be noise"),
    // Spacing of half the length: its flow is that at a Knudsen number of .3.
    limit_of(Quantity::OpeningParticles, None, AtLeast(8.0), "the flow through it is not resolved"),
    // Noise of a sample's pressure, sqrt(2/(3 N)), of 8 %.
    limit_of(Quantity::ProbeParticles, None, AtLeast(100.0), "what it shows is mostly noise"),
    // Measured: p/nkT 1.036 in a slit of one diameter, 1 within 1 % in one of two.
    limit_of(Quantity::Gap, Some(Method::ClosestApproach), AtLeast(2.0), "gas there presses harder than an ideal one"),
    // Measured: 2.3 % above Carnahan and Starling's pressure in one of two, within 1 % of it in one of four.
    limit_of(Quantity::Gap, Some(Method::HardSphere), AtLeast(4.0), "rigid spheres there press still harder"),
    limit_of(Quantity::Gap, None, AtLeast(1.0), "what lies across the smallest passage is not resolved"),
    // Rounding leaves particles up to 1e-6 of it behind a wall, on either side (`TOLERANCE` of `src/subdomain/walls.rs`).
    limit_of(Quantity::Thickness, None, AtLeast(2e-6), "positions are too coarse for it, and gas may pass through"),
    // Hits make nodes as fast as c0 sqrt(m_p/M); what ten passes of smoothing serve to.
    limit_of(Quantity::NodeMass, None, AtMost(0.06), "hits shake the fabric, which ripples and becomes shorter"),
    // A bag of 2 % less area holds 3 % less.
    limit_of(Quantity::Ripples, None, AtMost(0.02), "noise of the gas makes the fabric shorter, and its bag smaller"),
    // Measured in shock tubes of 40,000 particles (map `density-ratio`): what the thin gas feels is .96 +- .04 of the exact push
    // at .12, .92 +- .04 at .34 and .78 +- .05 at 1.1 (`closest-approach`); .91, .88 and .83 (`cell`).
    limit_of(Quantity::ThinGas, None, AtMost(0.2), "fronts that run into it are blurred, and push it too weakly"),
    // Measured at one occupancy and x = dt/tau, with particles of two sizes: T_int/T_tr .959 at .19 hits, .980 at .077
    // (`tests/verification/wall_hits.rs`), so what is missing goes with the hits: 2 % at .077.
    limit_of(
        Quantity::WallHits,
        Some(Method::ClosestApproach),
        AtMost(0.075),
        "a pair does not meet after a wall in the same step, and spin falls behind translation",
    ),
    limit_of(
        Quantity::WallHits,
        Some(Method::HardSphere),
        AtMost(0.075),
        "a pair does not meet after a wall in the same step, and spin falls behind translation",
    ),
    limit_of(Quantity::Flight, None, AtMost(1.0001), "the time step lets particles fly past whole cells"),
    // docs/explanation/method.md, "What the plan decides, and why": all but one in a thousand.
    limit_of(Quantity::FastParticles, None, AtMost(FAST_TAIL), "they pass gas that they should have met"),
    // Of the collisions in a cell one in ten is with the partner of the last at two particles and one free path, and changes
    // nothing: `tests/verification/starved.rs`, which finds the gas of two a few per cent more viscous than that of full cells.
    limit_of(
        Quantity::CellParticles,
        Some(Method::Cell),
        AtLeast(2.0),
        "pairs collide again and again, and the gas is too viscous",
    ),
    // Map `members`: nu .21 d c0 down to 14 in a tile, .35 at 10, .46 at 8, .52 at 6, where no gradient is known, .69
    // at 2 (`closest-approach` has .65).
    limit_of(
        Quantity::CellParticles,
        Some(Method::HalfTurn),
        AtLeast(12.0),
        "the gas becomes as viscous as that of other methods (docs/reference/limits.md, members)",
    ),
    limit_of(
        Quantity::Halvings,
        None,
        AtLeast(1.0),
        "the step is the smallest: gas that becomes denser or hotter stops the run",
    ),
    // A tenth of what the audit lets pass.
    limit_of(Quantity::EnergyDrift, None, AtMost(1e-5), "the energy is not kept as it should be"),
    limit_of(Quantity::ClippedHits, None, AtMost(0.01), "it passes too little, or with less than its enthalpy"),
    limit_of(
        Quantity::VentFlux,
        None,
        AtMost(UNCLIPPED),
        "probabilities of passing are clipped, and what leaves takes less than its enthalpy",
    ),
    // n cbar m / 4.
    limit_of(Quantity::VentHits, None, AtMost(0.398_942_280_4), "it cannot pass more than hits it"),
    limit_of(Quantity::Heat, None, AtMost(1.0), "the wall exchanges what all hits carry, and no more"),
    limit_of(Quantity::WallSpeed, None, AtMost(4.0), "the shock before it is thinner than a cell"),
    // They keep its volume at any number.
    limit_of(
        Quantity::Facets,
        None,
        AtMost(0.02),
        "what is as large as the round body, or touches it, may stand in the wall or leave a gap",
    ),
];

/// The limit of a quantity; none where nothing was found to break.
pub fn limit(quantity: Quantity, method: Method) -> Option<&'static Limit> {
    let of = |asked: Option<Method>| LIMITS.iter().find(|limit| limit.quantity == quantity && limit.method == asked);
    of(Some(method)).or_else(|| of(None))
}

/// Largest x = dt/tau with at most 2 % of the events lost: method.md, "Collisions", for up to four rounds; for eight,
/// measured in `tests/verification`; between them by steps. Without rounds that of the method `cell`. Of `half-turn` the mean spacings that gas of thermal
/// speed flies, beyond which it becomes as much more viscous as steps are longer.
pub fn step_limit(method: Method, rounds: u32) -> f64 {
    if method == Method::HalfTurn {
        return 1.0;
    }
    match (method.has_rounds(), rounds) {
        (false, _) => 2.0,
        (true, 0 | 1) => 0.02,
        (true, 2) => 0.1,
        (true, 3) => 0.2,
        (true, 4) => 0.3,
        (true, 5) => 0.35,
        (true, 6) => 0.4,
        (true, 7) => 0.45,
        (true, _) => 0.5,
    }
}

/// Something is beyond its limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Warning {
    pub quantity: Quantity,
    pub value: f64,
    pub limit: f64,
    /// Names quantity, value, limit and remedy.
    pub text: String,
}

/// What was found of a quantity.
#[derive(Debug, Clone, Copy)]
pub struct Judged<'a> {
    /// What has it.
    pub subject: &'a str,
    pub value: f64,
    pub remedy: &'a str,
}

impl Warning {
    /// None within the bound; `effect` is what happens beyond it.
    pub fn beyond(quantity: Quantity, bound: Bound, effect: &str, found: Judged<'_>) -> Option<Warning> {
        let Judged { subject, value, remedy } = found;
        let text = || {
            let found = significant(value);
            format!("{subject}: {} {found}, {}: {effect}; {remedy}", quantity.name(), bound.words())
        };
        (!bound.holds(value)).then(|| Warning { quantity, value, limit: bound.value(), text: text() })
    }

    /// By the table; none where it has no such limit, too.
    pub fn by_table(quantity: Quantity, method: Method, subject: &str, value: f64, remedy: &str) -> Option<Warning> {
        let Limit { bound, effect, .. } = limit(quantity, method)?;
        Warning::beyond(quantity, *bound, effect, Judged { subject, value, remedy })
    }
}

impl std::fmt::Display for Warning {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At its limit a quantity is within it, a little beyond it is not; nor is what is not a number.
    /// Checkpoints have them by number (`src/output/checkpoint/mod.rs`: another order is another format).
    #[test]
    fn quantities_keep_their_numbers() {
        let numbered = [
            (Quantity::Step, 0),
            (Quantity::WallHits, 7),
            (Quantity::Flight, 10),
            (Quantity::Halvings, 11),
            (Quantity::EnergyDrift, 12),
            (Quantity::ClippedHits, 13),
            (Quantity::WallSpeed, 17),
            (Quantity::CellParticles, 19),
            (Quantity::Thickness, 21),
            (Quantity::NodeMass, 22),
            (Quantity::Ripples, 23),
        ];
        for (quantity, number) in numbered {
            assert_eq!(quantity as u32, number, "{quantity:?}");
        }
    }

    #[test]
    fn limits_hold_up_to_themselves() {
        for entry in LIMITS {
            // One without a limit of its own.
            let has_own = |method: Method| limit(entry.quantity, method).is_some_and(|limit| limit.method.is_some());
            let all = [Method::Cell, Method::ClosestApproach, Method::HardSphere, Method::None];
            let method = entry.method.or_else(|| all.into_iter().find(|&method| !has_own(method))).unwrap();
            let found = |value: f64| Warning::by_table(entry.quantity, method, "it", value, "mend it");
            let (value, sign) = match entry.bound {
                AtMost(value) => (value, 1.0),
                AtLeast(value) => (value, -1.0),
            };
            assert_eq!(found(value), None, "{entry:?}");
            assert_eq!(found(value - sign * 0.1 * value), None, "{entry:?}");
            let beyond = found(value + sign * 1e-9 * value).unwrap();
            assert_eq!((beyond.quantity, beyond.limit), (entry.quantity, value));
            for part in ["it: ", entry.quantity.name(), &entry.bound.words(), entry.effect, "mend it"] {
                assert!(beyond.text.contains(part), "{part} is not in {}", beyond.text);
            }
            assert!(found(f64::NAN).is_some());
        }
    }

    /// A method's own limit goes before that of all; each is there once.
    #[test]
    fn a_method_may_have_a_limit_of_its_own() {
        let of = |method| limit(Quantity::Knudsen, method).map(|limit| limit.bound);
        assert_eq!((of(Method::ClosestApproach), of(Method::Cell)), (Some(AtMost(0.1)), Some(AtMost(0.03))));
        assert_eq!(of(Method::None), Some(AtLeast(1.0)));
        for (index, one) in LIMITS.iter().enumerate() {
            let twice = LIMITS[index + 1..].iter().any(|o| (o.quantity, o.method) == (one.quantity, one.method));
            assert!(!twice, "{one:?}");
        }
        assert!((1..8).all(|r| step_limit(Method::HardSphere, r) < step_limit(Method::HardSphere, r + 1)));
    }
}
