//! A figure of the prototype, and what a run finds.

use crate::study::verify::Check;

/// A figure that the prototype knows to `known`, found in a run that must know it as well.
pub(super) fn figure(quantity: String, reference: f64, found: (f64, f64), known: f64) -> Check {
    let enough = 3.0 * found.1 <= known;
    Check::of(quantity, reference, found, if enough { known.hypot(3.0 * found.1) } else { known })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::verify::Verdict;

    /// A run that knows less than the prototype says nothing; one that knows more is held to both.
    #[test]
    fn a_run_must_know_as_much_as_the_figure() {
        let verdict = |measured, error| figure("x".into(), 1.0, (measured, error), 0.03).verdict();
        assert_eq!(verdict(1.029, 0.005), Verdict::Pass);
        assert_eq!(verdict(1.034, 0.005), Verdict::Fail);
        assert_eq!(verdict(1.0, 0.011), Verdict::Unclear);
    }
}
