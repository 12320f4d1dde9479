//! Particles on the wrong side of closed fabric. Fabric whose nodes are prescribed lets none pass. Sheets of elastic fabric, which does
//! not touch itself, may cross: what is between them then gets out, until it flies back in.

use super::grouped;

/// The most at a time when it was counted: at snapshots, checkpoints and the end.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct PassedParticles {
    pub particles: u64,
    /// All particles then.
    pub of: u64,
    /// Whether the fabric is elastic.
    pub elastic: bool,
}

impl PassedParticles {
    fn share(&self) -> f64 {
        self.particles as f64 / self.of.max(1) as f64
    }

    pub(super) fn amount(&self) -> String {
        let of = match self.particles {
            0 => String::new(),
            _ => format!(" of {} at a time", grouped(self.of)),
        };
        format!("{}{of}", grouped(self.particles))
    }

    /// Why the run cannot be trusted.
    pub(super) fn failure(&self, allowed: f64) -> Option<String> {
        let fails = self.particles > 0 && (!self.elastic || self.share() > allowed);
        let limit = if self.elastic { format!("; {:.0} % are allowed", 100.0 * allowed) } else { String::new() };
        fails.then(|| format!("{} particles were on the wrong side of closed fabric{limit}", self.amount()))
    }

    /// What is no failure and no zero.
    pub(super) fn warning(&self, allowed: f64) -> Option<String> {
        (self.particles > 0 && self.failure(allowed).is_none()).then(|| {
            format!(
                "{} particles were on the wrong side of elastic fabric: it does not touch itself, its sheets crossed, and let them \
                 out; from a bag that starts without folds, or is not sucked in, none get out",
                self.amount()
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_may_pass_but_where_sheets_can_cross() {
        let passed = |particles, elastic| PassedParticles { particles, of: 10_000, elastic };
        let fails = |own: PassedParticles| own.failure(0.01).is_some();
        let warns = |own: PassedParticles| own.warning(0.01).is_some();
        assert!(fails(passed(1, false)) && fails(passed(101, true)) && !fails(passed(23, true)));
        assert!(warns(passed(23, true)) && !warns(passed(101, true)) && !warns(passed(0, true)));
        assert!(!fails(passed(0, false)) && !warns(passed(1, false)));
        assert_eq!(passed(23, true).amount(), "23 of 10,000 at a time");
    }
}
