//! Molar heat capacities that no gas has: per kilogram, or by coefficients of another formula.

use super::named::Named;
use super::range::{Kind, Range, range_of};
use crate::plan::text::{as_written, significant};
use crate::scene::{Dimension, GAS_CONSTANT, Gas, HeatCapacity, Scene};

/// At constant pressure, of a gas without internal energy, J/(mol K).
const LEAST: f64 = 2.5 * GAS_CONSTANT;
/// The share of the least that is rounding.
const ROUNDED: f64 = 0.99;
/// K: where a gas is taken to be at least and at most.
const COLD: f64 = 300.0;
const HOT: f64 = 1500.0;

pub fn doubt(scene: &Scene, gas: &Gas, named: &Named<'_>) -> Option<String> {
    let usual = range_of(Kind::MolarHeat);
    // Where the gas may be, K.
    let temperature = scene.chambers.iter().map(|chamber| chamber.temperature).fold(COLD, f64::max).min(HOT);
    let cp = gas.heat.molar_cv(temperature) + GAS_CONSTANT;
    let HeatCapacity::Curve(coefficients) = gas.heat else {
        let rest = " (20 R): is it per kilogram? Multiply it by the molar mass then";
        return (!usual.holds(cp)).then(|| named.beyond(usual, cp, rest));
    };
    let range = Range { least: LEAST, ..*usual };
    let is_gas = |cp: f64| cp >= ROUNDED * LEAST && cp <= range.most;
    if is_gas(cp) {
        return None;
    }
    let at = format!("at {} K", significant(temperature));
    let (range, bounds) = if cp < LEAST { (&range, "5/2 R to 20 R") } else { (usual, "20 R") };
    let molar_mass = gas.molar_mass;
    let rest = match of_thousandths(coefficients) {
        of_kelvin if is_gas(value(of_kelvin, temperature)) => format!(
            ": cp = a + b T + c T^2 has T in K; are these coefficients of T/1000, as Shomate's are? Those of T are {}, \
             without what D and E add: fit three to cp at the temperatures of the scene if that counts",
            listed(scene, of_kelvin)
        ),
        _ if is_gas(cp * molar_mass) => ": is it per kilogram? Multiply all coefficients by the molar mass then".into(),
        _ => ": cp = a + b T + c T^2 has T in K and molar coefficients: look at their signs and powers of ten"
            .to_string(),
    };
    Some(named.beyond(range, cp, &format!(" {at} ({bounds}){rest}")))
}

fn value([a, b, c]: [f64; 3], temperature: f64) -> f64 {
    a + temperature * (b + temperature * c)
}

/// The coefficients of a polynomial in T of one in T/1000.
fn of_thousandths([a, b, c]: [f64; 3]) -> [f64; 3] {
    [a, 1e-3 * b, 1e-6 * c]
}

/// As the scene has to give them.
fn listed(scene: &Scene, coefficients: [f64; 3]) -> String {
    let own = coefficients.map(|si| as_written(si / scene.units.factor(Dimension::MolarHeat)));
    format!("`cp = [{}]`", own.join(", "))
}
