//! Reference cases: runs against closed forms and published figures.
//!
//! A [`Case`] runs scenes and says of each quantity what it should be, what it was, by how much it may be off and how
//! well the run knows it ([`Check`]). The tolerance is that of the law (how far a method of this kind may be from the
//! reference), fixed before any run (of some rows of `half-turn` with runs in sight); a run must know its quantity three times better than that, or it says nothing and
//! counts as a failure. Seeds are fixed, so an outcome is the same every time on one adapter.
//!
//! The same functions serve the tests (`tests/verification/`), which also show of the cases that they run that the check can
//! fail.

mod at_once;
mod case;
mod check;
pub mod collisions;
pub mod curve;
mod damped_wave;
pub mod effusion;
pub mod equilibrium;
pub mod figures;
pub mod filling;
pub mod gas_box;
pub mod half_turn;
pub mod holes;
pub mod losses;
pub mod membrane;
pub mod mixing;
pub mod noh;
pub mod page;
pub mod piston;
mod prototype_tubes;
pub mod report;
pub mod shear;
mod smear;
pub mod sod;
pub mod sound;
pub mod statistics;
pub mod thin_wall;
pub mod tube;
pub mod vessels;
pub mod waves;
mod witness;

pub use at_once::run_cases;
pub use case::{Case, Curves, Effort, Findings};
pub use check::{Check, Verdict};
pub(crate) use witness::model_from;
pub use witness::{Run, Witness, run, scene_of};

/// All cases, those of the prototype's figures last.
pub fn all_cases() -> impl Iterator<Item = &'static Case> {
    CASES.iter().chain(figures::FIGURES)
}

/// The cases of laws, in the order of the tables.
pub const CASES: &[Case] = &[
    Case {
        name: "wall-pressure",
        law: "pressure on the walls over n k T at several occupancies (ideal gas)",
        run: collisions::wall_pressures,
    },
    Case {
        name: "virial",
        law: "closest approach: what a collision changes is across what parts the pair, r . (g' - g) = 0",
        run: collisions::virials,
    },
    Case {
        name: "collision-rate",
        law: "collisions per particle over n pi sigma^2 gbar (kinetic theory), away from walls",
        run: collisions::rates,
    },
    Case {
        name: "equipartition",
        law: "spin against translation, and masses 1:7, from an unequal start (equipartition theorem)",
        run: equilibrium::one_temperature,
    },
    Case {
        name: "spin-relaxation",
        law: "collision number Z from the decay of T_tr - T_int, exp(-(1 + zeta/3) s/Z)",
        run: equilibrium::relaxation,
    },
    Case {
        name: "energy-drift",
        law: "relative change of the energy of gases and mixtures in a closed box",
        run: equilibrium::conservation,
    },
    Case {
        name: "filling",
        law: "mass and energy of a closed tank that is filled: the curve's integral, U0 + integral of h dm",
        run: filling::balances,
    },
    Case {
        name: "effusion",
        law: "free flight through a hole over n cbar A/4 (kinetic theory)",
        run: vessels::effusion,
    },
    Case {
        name: "rough-tube",
        law: "free flight through a tube of rough walls over n cbar A/4 (Clausing 1932)",
        run: effusion::rough_tube,
    },
    Case {
        name: "orifice",
        law: "discharge into near-vacuum over choked isentropic flow, by Knudsen number of the hole's radius",
        run: holes::discharges,
    },
    Case {
        name: "filling-curve",
        law: "the same with cp = a + b T + c T^2, whose integrals are known in closed form",
        run: curve::filling,
    },
    Case {
        name: "heat-loss",
        law: "cooling by walls with a heat-transfer coefficient: exponential, n cv dT/dt = -h A (T - T_w)",
        run: losses::heat,
    },
    Case {
        name: "leak",
        law: "a vessel that empties through its pores: isentropic, d lnT / d lnN = gamma - 1, and choked flow",
        run: losses::leak,
    },
    Case {
        name: "blow-down",
        law: "one chamber empties into another through a hole: the gas that stays cools between isentropically and by effusion",
        run: vessels::blow_down,
    },
    Case { name: "mixing", law: "two gases come to equal shares and one temperature (mixing)", run: mixing::mixing },
    Case {
        name: "viscosity",
        law: "decay of vortices as exp(-2 nu k^2 t) (Taylor and Green) with the viscosity of the method",
        run: shear::viscosities,
    },
    Case {
        name: "half-turn-viscosity",
        law: "half-turn: the same, with gas of the density of the plan, and eight times thinner and denser",
        run: half_turn::viscosities,
    },
    Case {
        name: "half-turn-heat",
        law: "half-turn: decay of a wave of temperature at one pressure as exp(-chi k^2 t), with the diffusivity of the method",
        run: waves::heats,
    },
    Case {
        name: "half-turn-orifice",
        law: "half-turn: discharge into near-vacuum, by the spacings of the particles across the hole",
        run: half_turn::discharges,
    },
    Case { name: "sod", law: "Sod's shock tube, gamma 7/5, against the exact Riemann solution", run: sod::sod },
    Case { name: "sod-monatomic", law: "the same with gamma 5/3", run: sod::sod_monatomic },
    Case {
        name: "strong-tube",
        law: "half-turn: a shock tube of a pressure ratio of 100 against the exact Riemann solution",
        run: sod::strong,
    },
    Case {
        name: "expansion",
        law: "expansion into a vacuum: exact Riemann solution; at rest again the temperature of the start (Joule)",
        run: sod::expansion,
    },
    Case {
        name: "sound",
        law: "frequency of a standing wave over that of sound at sqrt(gamma k T/m)",
        run: sound::sound,
    },
    Case {
        name: "noh",
        law: "half-turn: cold gas streams against a wall, a shock of infinite Mach number (Rankine-Hugoniot); spin comes up from none",
        run: noh::noh,
    },
    Case {
        name: "thin-wall",
        law: "hot and cold gas on the two sides of a thin wall that cuts cells: the temperature of each stays as it is",
        run: thin_wall::thin_wall,
    },
    Case {
        name: "piston",
        law: "slow compression 2:1: T over (V0/V)^(gamma-1); fast pistons: pressure behind their shock (Rankine-Hugoniot)",
        run: piston::pistons,
    },
    Case {
        name: "membrane-patch",
        law: "a membrane of irregular triangles whose rim is strained uniformly (patch test)",
        run: membrane::stretched::patch,
    },
    Case {
        name: "membrane-strip",
        law: "a membrane that wrinkles bears tension along, S = E e, and nothing across (tension field)",
        run: membrane::stretched::strip,
    },
    Case {
        name: "membrane-loop",
        law: "a closed loop of strains through taut, wrinkled and slack states leaves no work (hyperelasticity)",
        run: membrane::stretched::loops,
    },
    Case {
        name: "membrane-wave",
        law: "frequency of a standing wave of stretching over that at root(E/rho)",
        run: membrane::moving::waves,
    },
    Case {
        name: "membrane-sheet",
        law: "energy of a free sheet that springs back and crumples, without damping",
        run: membrane::moving::crumple,
    },
    Case {
        name: "membrane-taut",
        law: "energy of a taut sheet that swings for 20,000 steps, without damping",
        run: membrane::moving::taut,
    },
    Case {
        name: "membrane-slide",
        law: "a sheet that slides on a plane with friction comes to rest after v^2/(2 mu g)",
        run: membrane::moving::slides,
    },
    Case {
        name: "membrane-bag",
        law: "volume of a square bag under pressure (.2055 L^3 if inextensible, Kepert)",
        run: membrane::shapes::squares,
    },
    Case {
        name: "membrane-height",
        law: "height of a square bag of 1200 mm from corner to corner at 5 kPa (217 mm, literature of wrinkled membranes)",
        run: membrane::shapes::half_heights,
    },
    Case {
        name: "membrane-discs",
        law: "two discs sewn at their rim, under pressure (Paulsen 1994)",
        run: membrane::shapes::discs,
    },
    Case {
        name: "membrane-round",
        law: "tension of a cylinder and a sphere under pressure, p r and p r/2",
        run: membrane::shapes::round,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = all_cases().map(|case| case.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all_cases().count());
    }
}
