//! One quantity, measured and as it should be.

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
    /// The reference is a figure of the prototype that runs do not find, as a note of the case tells.
    pub disputed: bool,
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

/// How far from a disputed figure a measured one may be, as a part of it: the prototype's are of single runs.
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
}
