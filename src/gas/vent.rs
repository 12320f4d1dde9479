//! Flow out through a vent or a leaking wall (docs/explanation/method.md, "Vents and leaks").
//!
//! Wang and Nefske: G = C23 p / sqrt(R T / M) sqrt(2 gamma/(gamma-1) (Q^(2/gamma) - Q^((gamma+1)/gamma))),
//! Q = max(pe/p, critical). A fabric: G = rho v(p - pe). What leaves takes the enthalpy of the gas inside with it.

use super::Species;
use super::curve::value_held;
use super::discharge::{CHORD, isentropic};
use crate::scene::{GAS_CONSTANT, Vent, VentFlow};

/// Beyond this share of p / sqrt(R T / M) a flux can no longer be modelled by a probability in proportion to the
/// normal speed without clipping it (docs/explanation/method.md, "Vents and leaks").
pub const UNCLIPPED: f64 = 0.125;

/// A uniform gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LocalGas {
    /// Pa.
    pub pressure: f64,
    /// K.
    pub temperature: f64,
    /// kg/mol.
    pub molar_mass: f64,
    /// cp / cv.
    pub gamma: f64,
}

impl LocalGas {
    /// With `moles` mol/m3 of each gas; `None` without any.
    pub fn new(gases: &[Species], moles: &[f64], temperature: f64) -> Option<LocalGas> {
        let total: f64 = moles.iter().sum();
        if !(total > 0.0 && temperature > 0.0) {
            return None;
        }
        let mean =
            |of: &dyn Fn(&Species) -> f64| gases.iter().zip(moles).map(|(gas, n)| n * of(gas)).sum::<f64>() / total;
        Some(LocalGas {
            pressure: total * GAS_CONSTANT * temperature,
            temperature,
            molar_mass: mean(&|gas| gas.molar_mass),
            gamma: 1.0 + GAS_CONSTANT / mean(&|gas| gas.molar_cv(temperature)),
        })
    }

    /// p / sqrt(R T / M), kg/(m2 s).
    pub fn unit_flux(&self) -> f64 {
        self.pressure / (GAS_CONSTANT * self.temperature / self.molar_mass).sqrt()
    }

    /// kg/m3.
    pub fn density(&self) -> f64 {
        self.pressure * self.molar_mass / (GAS_CONSTANT * self.temperature)
    }

    /// The isentropic flux to `outside`, Pa, kg/(m2 s); zero where the pressure is not above it.
    pub fn isentropic_flux(&self, outside: f64) -> f64 {
        if self.pressure <= outside { 0.0 } else { self.unit_flux() * isentropic(self.gamma, outside / self.pressure) }
    }
}

/// The flux through an open vent at `time`, kg/(m2 s) of its area.
pub fn flux(vent: &Vent, gas: &LocalGas, time: f64) -> f64 {
    let outside = vent.external_pressure;
    let excess = gas.pressure - outside;
    // Rounding is no excess.
    if excess <= 1e-12 * gas.pressure {
        return 0.0;
    }
    match &vent.flow {
        VentFlow::Discharge(curve) => value_held(curve, time) * gas.isentropic_flux(outside),
        VentFlow::DischargeByPressure(curve) => value_held(curve, excess) * gas.isentropic_flux(outside),
        // Towards no excess linear, as the others are: pressures would chatter about balance where a curve begins above 0.
        VentFlow::LeakVelocity(curve) => {
            value_held(curve, excess) * gas.density() * (excess / (CHORD * gas.pressure)).min(1.0)
        }
    }
}

/// Whether a vent is open that was so before, or not.
pub fn opens(vent: &Vent, was_open: bool, pressure: f64) -> bool {
    was_open || pressure - vent.external_pressure >= vent.opening_pressure
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Curve;

    fn air() -> LocalGas {
        let gases = [Species::constant(0.029, 2.5 * GAS_CONSTANT)];
        LocalGas::new(&gases, &[2e5 / (GAS_CONSTANT * 400.0)], 400.0).unwrap()
    }

    fn vent(flow: VentFlow) -> Vent {
        Vent {
            name: "vent".into(),
            wall: 0,
            face: None,
            chamber: None,
            disc: None,
            area: None,
            flow,
            opening_pressure: 0.0,
            external_pressure: 5e4,
        }
    }

    /// Choked at gamma 1.4: .6847 p / sqrt(R T); and nothing against a higher pressure.
    #[test]
    fn choked_flow_and_none_backwards() {
        let air = air();
        let whole = vent(VentFlow::Discharge(Curve { points: vec![[0.0, 1.0]] }));
        assert!((flux(&whole, &air, 0.0) / air.unit_flux() - 0.6847).abs() < 1e-4);
        let lower = Vent { external_pressure: 0.0, ..whole.clone() };
        assert_eq!(flux(&lower, &air, 0.0), flux(&whole, &air, 0.0));
        let subsonic = Vent { external_pressure: 1.8e5, ..whole.clone() };
        assert!(flux(&subsonic, &air, 0.0) < 0.7 * flux(&whole, &air, 0.0));
        assert_eq!(flux(&Vent { external_pressure: 2.0001e5, ..whole }, &air, 0.0), 0.0);
    }

    #[test]
    fn curves_are_against_time_or_excess_pressure() {
        let air = air();
        let curve = Curve { points: vec![[0.0, 0.0], [3e5, 0.6]] };
        // The excess is 1.5e5 Pa, half of the curve; at time 0 it is at its start.
        let by_pressure = flux(&vent(VentFlow::DischargeByPressure(curve.clone())), &air, 0.0);
        assert!((by_pressure / (0.3 * air.isentropic_flux(5e4)) - 1.0).abs() < 1e-12);
        assert_eq!(flux(&vent(VentFlow::Discharge(curve.clone())), &air, 0.0), 0.0);
        let leak = flux(&vent(VentFlow::LeakVelocity(curve)), &air, 0.0);
        // A curve that begins above 0 falls to it within 1e-4 of the pressure.
        let open = |excess: f64| {
            let flow = VentFlow::LeakVelocity(Curve { points: vec![[0.0, 0.3]] });
            flux(&Vent { external_pressure: 2e5 - excess, ..vent(flow) }, &air, 0.0) / (0.3 * air.density())
        };
        assert!((open(1e3) - 1.0).abs() < 1e-9 && (open(5.0) - 0.25).abs() < 1e-9 && open(-5.0) == 0.0);
        assert!((leak / (0.3 * 2e5 * 0.029 / (GAS_CONSTANT * 400.0)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn an_open_vent_stays_open() {
        let vent = Vent { opening_pressure: 1e5, ..vent(VentFlow::Discharge(Curve { points: vec![[0.0, 1.0]] })) };
        assert!(!opens(&vent, false, 1.4e5) && opens(&vent, false, 1.5e5) && opens(&vent, true, 5e4));
    }
}
