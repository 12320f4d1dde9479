//! Gases and their mixtures.
//!
//! cv = cp - R = R / (gamma - 1); the least is 3/2 R, of a gas without internal energy. A polynomial cp(T) is
//! held against that by the plan, which knows the scene's temperatures.

use super::errors::Problem;
use super::names::Names;
use super::numbers::{bounded, described, number, positive, show};
use super::raw::RawGas;
use super::raw_values::{At, NumberOr, RawMixture};
use super::types::{GAS_CONSTANT, Gas, HeatCapacity, Mixture, UnitSystem};
use super::units::Quantity;

/// Gas indices are packed into few bits on the device.
pub(super) const MOST_GASES: usize = 16;

/// Heat capacities this near to 3/2 R are those of a monatomic gas, rounded: gamma = 1.67 means 5/3.
const MONATOMIC: f64 = 1.5 * GAS_CONSTANT;
const MONATOMIC_TOLERANCE: f64 = 5e-3;

/// Mole fractions may miss one by this much.
const FRACTION_TOLERANCE: f64 = 1e-9;

pub(super) fn gas(raw: &At<RawGas>, units: UnitSystem) -> Result<Gas, Problem> {
    let raw_gas = &raw.value;
    let molar_mass = positive(&raw_gas.molar_mass, Quantity::MolarMass, units)?;
    let heat = match curve(raw_gas, units)? {
        Some(curve) => HeatCapacity::Curve(curve),
        None => HeatCapacity::Constant(molar_cv(raw, units)?),
    };
    Ok(Gas { name: raw_gas.name.value.clone(), molar_mass, heat })
}

/// What `cp` is.
const FORM: &str = "one number, or up to three coefficients [a, b, c] of cp = a + b T + c T^2, T in K";

/// The coefficients of a `cp` that depends on temperature, SI.
fn curve(raw: &RawGas, units: UnitSystem) -> Result<Option<[f64; 3]>, Problem> {
    let (Some(cp), None, None) = (&raw.cp, &raw.cv, &raw.gamma) else { return Ok(None) };
    let NumberOr::Array(given) = &cp.value else { return Ok(None) };
    if given.is_empty() || given.len() > 3 {
        return Err(Problem::value(&cp.span, format!("an array of {} coefficients", given.len()), FORM).hint(
            "Shomate's coefficients are of T/1000: fit three of T, in K, to cp at the temperatures of the scene",
        ));
    }
    let mut coefficients = [0.0; 3];
    for (own, given) in coefficients.iter_mut().zip(given) {
        *own = number(given, Quantity::MolarHeat, units)?;
    }
    let constant = coefficients[1..] == [0.0; 2];
    Ok((!constant).then_some(coefficients))
}

/// J/(mol K), from whichever of the three keys is given.
fn molar_cv(raw: &At<RawGas>, units: UnitSystem) -> Result<f64, Problem> {
    const KEYS: &str = "exactly one of `cp`, `cv`, `gamma`";
    let (cv, span, found) = match (&raw.value.cp, &raw.value.cv, &raw.value.gamma) {
        (None, None, None) => return Err(Problem::value(&raw.span, "none of `cp`, `cv`, `gamma`", KEYS)),
        (Some(cp), None, None) => {
            let at = At { value: constant_of(&cp.value), span: cp.span.clone() };
            let hinted = |problem: Problem| if at.value <= 0.0 { problem.hint(FORM) } else { problem };
            (positive(&at, Quantity::MolarHeat, units).map_err(hinted)? - GAS_CONSTANT, &cp.span, at.value)
        }
        (None, Some(cv), None) => (positive(cv, Quantity::MolarHeat, units)?, &cv.span, cv.value),
        (None, None, Some(gamma)) => {
            let ratio = bounded(gamma, Quantity::Pure, units, GAMMA_ALLOWED, |gamma| gamma > 1.0)?;
            (GAS_CONSTANT / (ratio - 1.0), &gamma.span, gamma.value)
        }
        (cp, cv, gamma) => {
            // Point at the last one given.
            let spans = [cp.as_ref().map(|a| &a.span), cv.as_ref().map(|a| &a.span), gamma.as_ref().map(|a| &a.span)];
            let span = spans.into_iter().flatten().max_by_key(|span| span.start).unwrap_or(&raw.span);
            return Err(Problem::value(span, "a second heat capacity", KEYS));
        }
    };
    if (cv / MONATOMIC - 1.0).abs() <= MONATOMIC_TOLERANCE {
        return Ok(MONATOMIC);
    }
    if cv < MONATOMIC {
        let allowed = match (&raw.value.cp, &raw.value.cv) {
            (None, None) => GAMMA_ALLOWED.to_string(),
            (None, Some(_)) => least_heat_capacity("3/2 R", MONATOMIC, units),
            _ => least_heat_capacity("5/2 R", MONATOMIC + GAS_CONSTANT, units),
        };
        let problem = Problem::value(span, show(found), allowed);
        let hinted = raw.value.gamma.is_none().then(|| {
            let molar_mass = raw.value.molar_mass.value;
            other_system(cv + GAS_CONSTANT, molar_mass * units.factor(Quantity::MolarMass), units)
                .or_else(|| another_unit(found, molar_mass, units))
        });
        let hinted = hinted.flatten();
        return Err(if let Some(hint) = hinted { problem.hint(&hint) } else { problem });
    }
    // A ratio next to 1 asks for more internal energy than numbers can hold.
    if cv > 1e6 * GAS_CONSTANT {
        return Err(Problem::value(span, show(found), "a heat capacity of at most a million R"));
    }
    Ok(cv)
}

const GAMMA_ALLOWED: &str = "a number above 1 and at most 5/3";

fn least_heat_capacity(name: &str, si: f64, units: UnitSystem) -> String {
    let least = si / units.factor(Quantity::MolarHeat);
    described(&format!("at least {name} = {least:.4}"), Quantity::MolarHeat, units)
}

/// No gas of an inflator has more, J/(mol K); hexane has 17 R.
pub(super) const MOST_MOLAR_HEAT: f64 = 20.0 * GAS_CONSTANT;

/// What a heat capacity per kilogram, or one in R, would be in the unit that is asked for, if a gas can have that.
fn another_unit(found: f64, molar_mass: f64, units: UnitSystem) -> Option<String> {
    let own = units.factor(Quantity::MolarHeat);
    let molar_mass = molar_mass * units.factor(Quantity::MolarMass);
    let meant = [
        ("kJ/(kg K)", 1e3 * found * molar_mass),
        ("J/(mol K)", found),
        ("J/(kg K)", found * molar_mass),
        ("cal/(mol K)", 4.184 * found),
    ];
    let possible =
        |si: f64| (0.99 * MONATOMIC..=MOST_MOLAR_HEAT).contains(&si) && (si / (found * own) - 1.0).abs() > 1e-9;
    let (unit, si) = meant.into_iter().find(|(_, si)| possible(*si))?;
    Some(format!("is it in {unit}? Then it is {:.4} {}", si / own, units.symbol(Quantity::MolarHeat)))
}

/// A hint, if heat capacity and molar mass (SI, as read) are those of a gas once the numbers are taken in another unit system, and
/// neither is one now.
pub(super) fn other_system(cp: f64, molar_mass: f64, units: UnitSystem) -> Option<String> {
    let is_gas = |system: UnitSystem| {
        let si = |read: f64, quantity: Quantity| read / units.factor(quantity) * system.factor(quantity);
        [
            (0.99 * (MONATOMIC + GAS_CONSTANT)..=MOST_MOLAR_HEAT).contains(&si(cp, Quantity::MolarHeat)),
            (1e-3..=0.5).contains(&si(molar_mass, Quantity::MolarMass)),
        ]
    };
    let fitting: Vec<String> = UnitSystem::ALL
        .into_iter()
        .filter(|system| is_gas(units) == [false; 2] && is_gas(*system) == [true; 2])
        .map(|system| format!("`units = \"{}\"`", system.name()))
        .collect();
    (!fitting.is_empty()).then(|| {
        format!("neither its molar mass nor its heat capacity is a gas's, but both are with {}: are the numbers in that system?", fitting.join(" or "))
    })
}

/// The number, or the first coefficient: those of higher powers are zero here.
fn constant_of(cp: &NumberOr<f64>) -> f64 {
    match cp {
        NumberOr::Number(value) => *value,
        NumberOr::Array(coefficients) => coefficients.first().map_or(0.0, |first| first.value),
    }
}

/// Least rotational collision number with which the exchange probability of docs/explanation/method.md, "Spin exchange"
/// exists: (1 + zeta/4) / (1 - a/2), a = zeta / (zeta + 4).
pub(super) fn least_collision_number(zeta: f64) -> f64 {
    (1.0 + zeta / 4.0) / (1.0 - 0.5 * zeta / (zeta + 4.0))
}

/// It rounded up to the four decimals of messages: what they show does, but for the rounding of the number itself.
pub fn shown_collision_number(least: f64) -> f64 {
    (1e4 * least * (1.0 - 1e-12)).ceil() / 1e4
}

/// Mole fractions by gas index, in the order of the indices.
pub(super) fn mixture(raw: &At<RawMixture>, gases: &Names) -> Result<Mixture, Problem> {
    let fractions = match &raw.value {
        RawMixture::Pure(name) => {
            return Ok(Mixture(vec![(gases.find_str(name, &raw.span)?, 1.0)]));
        }
        RawMixture::Fractions(fractions) => fractions,
    };
    if fractions.is_empty() {
        return Err(Problem::value(&raw.span, "an empty mixture", "a gas by name, or mole fractions that sum to 1"));
    }
    let mut parts = Vec::with_capacity(fractions.len());
    for (name, fraction) in fractions {
        let index = gases.find(name)?;
        parts.push((index, positive(fraction, Quantity::Pure, UnitSystem::Si)?));
    }
    parts.sort_by_key(|part| part.0);
    let sum: f64 = parts.iter().map(|part| part.1).sum();
    if (sum - 1.0).abs() > FRACTION_TOLERANCE {
        let problem = Problem::value(&raw.span, format!("mole fractions that sum to {sum:.10}"), "a sum of 1");
        let per_cent = (sum / 100.0 - 1.0).abs() < 1e-3;
        return Err(if per_cent { problem.hint("in per cent? 60 per cent are 0.6") } else { problem });
    }
    // Left alone where only rounding is off, so that a resolved scene reads back as it was.
    if (sum - 1.0).abs() > 1e-14 {
        for part in &mut parts {
            part.1 /= sum;
        }
    }
    Ok(Mixture(parts))
}
