//! The account of elastic fabric: what gas, pressure, gravity and supports did is in its motion and strain, or was damped.
//!
//! from the gas + external pressure + gravity + supports = kinetic + strain (end less start) + damped + ledger. The ledger is the
//! difference of what hits took from the gas, at the velocity that a node had, and what they gave to the node, whose velocity other
//! forces change as well (docs/explanation/method.md, "Fabric").

use super::grouped;

/// J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FabricAccount {
    /// What hits took from the gas.
    pub from_gas: f64,
    pub from_pressure: f64,
    pub from_gravity: f64,
    /// Of what holds nodes.
    pub from_supports: f64,
    /// At the start and the end.
    pub kinetic: [f64; 2],
    pub strain: [f64; 2],
    pub damped: f64,
    pub ledger: f64,
}

/// Flights that ended at elastic fabric till the next step, as they were to hit it once more than is followed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CaughtFlights {
    pub flights: u64,
    /// Over the particles of all steps.
    pub share: f64,
}

impl CaughtFlights {
    pub(super) fn amount(&self) -> String {
        format!("{}, {:.4} % of particle-steps", grouped(self.flights), 100.0 * self.share)
    }

    pub(super) fn told(&self) -> String {
        format!("flights were caught by elastic fabric till the next step: {}", self.amount())
    }
}

impl FabricAccount {
    pub fn received(&self) -> f64 {
        self.from_gas + self.from_pressure + self.from_gravity + self.from_supports
    }

    /// What the steps lost or made up.
    pub fn missing(&self) -> f64 {
        let [kinetic, strain] = [self.kinetic, self.strain].map(|[start, end]| end - start);
        kinetic + strain + self.damped + self.ledger - self.received()
    }

    /// Over the largest amount of the account.
    pub fn error(&self) -> f64 {
        let amounts =
            [self.from_gas, self.from_pressure, self.kinetic[0], self.kinetic[1], self.strain[0], self.strain[1]];
        let largest = amounts.into_iter().chain([self.damped, self.from_gravity]).map(f64::abs).fold(0.0, f64::max);
        if largest > 0.0 { self.missing() / largest } else { 0.0 }
    }

    /// What is missing over the work that gas and external pressure did; `None` where they did none.
    pub fn error_of_pressures(&self) -> Option<f64> {
        let work = (self.from_gas + self.from_pressure).abs();
        (work > 0.0).then(|| self.missing() / work)
    }

    /// Lines of the audit.
    pub fn facts(&self) -> Vec<(&'static str, String)> {
        let joules = |value: f64| format!("{value:.6e}");
        let change = |[start, end]: [f64; 2]| format!("{start:.6e} to {end:.6e}");
        let of_pressures = self.error_of_pressures();
        let of_pressures =
            of_pressures.map_or_else(String::new, |share| format!(", {:+.2} % of what pressures did", 100.0 * share));
        vec![
            ("fabric, J: from the gas", joules(self.from_gas)),
            ("  from external pressure", joules(self.from_pressure)),
            ("  from gravity", joules(self.from_gravity)),
            ("  from supports", joules(self.from_supports)),
            ("  kinetic", change(self.kinetic)),
            ("  strain", change(self.strain)),
            ("  damped", joules(self.damped)),
            ("  ledger of hits", joules(self.ledger)),
            ("  error", format!("{:+.2e}{of_pressures}", self.error())),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_account_that_closes_has_no_error() {
        let account = FabricAccount {
            from_gas: 10.0,
            from_pressure: -2.0,
            from_gravity: 0.5,
            from_supports: 0.0,
            kinetic: [1.0, 3.0],
            strain: [0.0, 5.0],
            damped: 1.25,
            ledger: 0.25,
        };
        assert!(
            account.missing().abs() < 1e-12 && account.error_of_pressures().is_some_and(|share| share.abs() < 1e-12)
        );
        let leaky = FabricAccount { damped: 1.0, ..account };
        assert!((leaky.error() + 0.025).abs() < 1e-12);
        // A quarter of a joule, of eight.
        assert!(leaky.facts().last().is_some_and(|(_, told)| told == "-2.50e-2, -3.12 % of what pressures did"));
    }
}
