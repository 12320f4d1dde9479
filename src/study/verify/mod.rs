//! Reference cases: runs against closed forms and published figures.
//!
//! A [`Case`] runs scenes and says of each quantity what it should be, what it was, by how much it may be off and how
//! well the run knows it ([`Check`]). The tolerance is that of the law (how far a method of this kind may be from the
//! reference), fixed before any run; a run must know its quantity three times better than that, or it says nothing and
//! counts as a failure. Seeds are fixed, so an outcome is the same every time on one adapter.
//!
//! The same functions serve the tests (`tests/verification/`), which also show of the cases that they run that the check can
//! fail.

mod at_once;
pub mod collisions;
pub mod curve;
pub mod equilibrium;
pub mod figures;
pub mod filling;
pub mod gas_box;
pub mod holes;
pub mod losses;
pub mod mixing;
pub mod page;
pub mod piston;
pub mod report;
pub mod shear;
pub mod sod;
pub mod sound;
pub mod statistics;
pub mod tube;
mod witness;

use crate::gpu::Device;
use crate::output::{PALETTE, Series};

pub use at_once::run_cases;
pub(crate) use witness::model_from;
pub use witness::{Run, Witness, run, scene_of};

use super::StudyError;

/// How much a case takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// All cases together in minutes on two cores.
    Quick,
    /// The figures of the documentation.
    Full,
}

/// A law and the runs that show it.
pub struct Case {
    pub name: &'static str,
    /// What is compared with what, and where the reference is from.
    pub law: &'static str,
    run: fn(&Device, Effort) -> Result<Findings, StudyError>,
}

impl Case {
    /// # Errors
    /// If a run fails.
    pub fn run(&self, device: &Device, effort: Effort) -> Result<Findings, StudyError> {
        (self.run)(device, effort)
    }
}

/// What a case found.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Findings {
    pub checks: Vec<Check>,
    pub charts: Vec<Curves>,
    /// What is to be said of the specification's figures that were found to be otherwise.
    pub notes: Vec<String>,
}

impl From<Vec<Check>> for Findings {
    fn from(checks: Vec<Check>) -> Findings {
        Findings { checks, ..Findings::default() }
    }
}

impl FromIterator<Check> for Findings {
    fn from_iter<I: IntoIterator<Item = Check>>(checks: I) -> Findings {
        Findings::from(checks.into_iter().collect::<Vec<_>>())
    }
}

/// Measured curves beside their references.
#[derive(Debug, Clone, PartialEq)]
pub struct Curves {
    /// Of the file, without its ending.
    pub name: &'static str,
    pub title: String,
    pub x_label: &'static str,
    pub y_label: &'static str,
    pub series: Vec<Series>,
}

impl Curves {
    pub fn new(name: &'static str, title: String, x_label: &'static str, y_label: &'static str) -> Curves {
        Curves { name, title, x_label, y_label, series: Vec::new() }
    }

    /// Adds a measured one.
    #[must_use]
    pub fn line(mut self, name: &str, points: Vec<[f64; 2]>) -> Curves {
        let colour = PALETTE[self.series.len() % PALETTE.len()];
        self.series.push(Series { name: name.into(), points, dashed: false, colour });
        self
    }

    /// Adds what the last ones should be.
    #[must_use]
    pub fn reference(mut self, name: &str, points: Vec<[f64; 2]>) -> Curves {
        let [.., ink] = PALETTE;
        self.series.push(Series { name: name.into(), points, dashed: true, colour: ink });
        self
    }
}

/// A quantity of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Check {
    pub quantity: String,
    pub reference: f64,
    pub measured: f64,
    /// Largest difference of the two.
    pub tolerance: f64,
    /// Standard error of `measured`; 0 where it is a number of the run and no estimate.
    pub error: f64,
    /// The reference is a figure of the specification that runs do not find, as a note of the case tells.
    pub disputed: bool,
}

/// How far from a disputed figure a measured one may be, as a part of it: the specification's are of single runs.
const DISPUTED: f64 = 0.2;

/// Standard errors that a tolerance must have.
const ERRORS_IN_TOLERANCE: f64 = 3.0;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    Pass,
    Fail,
    /// From a disputed figure, by a fifth of it at most: that is no failure of the solver, nor does it pass.
    Differs,
    /// The run knows too little.
    Unclear,
}

impl Verdict {
    pub fn word(self) -> &'static str {
        match self {
            Verdict::Pass => "pass",
            Verdict::Fail => "FAIL",
            Verdict::Differs => "differs",
            Verdict::Unclear => "UNCLEAR",
        }
    }
}

impl Check {
    /// An estimate with a standard error.
    pub fn of(quantity: impl Into<String>, reference: f64, (measured, error): (f64, f64), tolerance: f64) -> Check {
        Check { quantity: quantity.into(), reference, measured, tolerance, error, disputed: false }
    }

    #[must_use]
    pub fn disputed(self) -> Check {
        Check { disputed: true, ..self }
    }

    pub fn verdict(&self) -> Verdict {
        let off = (self.measured - self.reference).abs();
        // Without a number there is no pass either.
        if off.is_nan() || self.error.is_nan() || ERRORS_IN_TOLERANCE * self.error > self.tolerance {
            Verdict::Unclear
        } else if off <= self.tolerance {
            Verdict::Pass
        } else if self.disputed && off <= DISPUTED * self.reference.abs() {
            Verdict::Differs
        } else {
            Verdict::Fail
        }
    }
}

/// All cases, those of the specification's figures last.
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
    Case { name: "effusion", law: "free flight through a hole over n cbar A/4 (kinetic theory)", run: holes::effusion },
    Case {
        name: "rough-tube",
        law: "free flight through a tube of rough walls over n cbar A/4 (Clausing 1932)",
        run: holes::rough_tube,
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
        run: holes::blow_down,
    },
    Case { name: "mixing", law: "two gases come to equal shares and one temperature (mixing)", run: mixing::mixing },
    Case {
        name: "viscosity",
        law: "decay of vortices as exp(-2 nu k^2 t) (Taylor and Green) with the viscosity of the method",
        run: shear::viscosities,
    },
    Case { name: "sod", law: "Sod's shock tube, gamma 7/5, against the exact Riemann solution", run: sod::sod },
    Case { name: "sod-monatomic", law: "the same with gamma 5/3", run: sod::sod_monatomic },
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
        name: "piston",
        law: "slow compression 2:1: T over (V0/V)^(gamma-1); fast pistons: pressure behind their shock (Rankine-Hugoniot)",
        run: piston::pistons,
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    /// A check passes within its tolerance, fails beyond it (or differs from what is disputed), and says nothing where it does
    /// not know.
    #[test]
    fn a_check_passes_fails_or_knows_too_little() {
        let check = |measured, error| Check::of("x", 1.0, (measured, error), 0.03).verdict();
        assert_eq!(check(1.029, 0.005), Verdict::Pass);
        assert_eq!(check(0.971, 0.0), Verdict::Pass);
        assert_eq!(check(1.031, 0.005), Verdict::Fail);
        assert_eq!(check(1.0, 0.011), Verdict::Unclear);
        assert_eq!(check(f64::NAN, 0.0), Verdict::Unclear);
        assert_eq!(check(1.0, f64::NAN), Verdict::Unclear);
        let disputed = |measured, error| Check::of("x", 1.0, (measured, error), 0.03).disputed().verdict();
        assert_eq!(disputed(1.029, 0.005), Verdict::Pass);
        assert_eq!(disputed(1.031, 0.005), Verdict::Differs);
        assert_eq!(disputed(0.801, 0.005), Verdict::Differs);
        assert_eq!(disputed(1.201, 0.005), Verdict::Fail);
        assert_eq!(disputed(1.031, 0.011), Verdict::Unclear);
    }

    #[test]
    fn names_are_unique() {
        let mut names: Vec<_> = all_cases().map(|case| case.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), all_cases().count());
    }
}
