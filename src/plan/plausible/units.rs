//! In which unit a number is likely meant, and how numbers are written so that their author knows them again.

use super::range::Range;
use crate::scene::{Dimension, UnitSystem};

/// Name and SI units in it. Of several names of one size the first of the list is told.
const UNITS: &[(Dimension, &str, f64)] = &[
    (Dimension::Length, "m", 1.0),
    (Dimension::Length, "mm", 1e-3),
    (Dimension::Length, "cm", 1e-2),
    (Dimension::Area, "m2", 1.0),
    (Dimension::Area, "mm2", 1e-6),
    (Dimension::Area, "cm2", 1e-4),
    (Dimension::Pressure, "Pa", 1.0),
    (Dimension::Pressure, "kPa", 1e3),
    (Dimension::Pressure, "bar", 1e5),
    (Dimension::Pressure, "hPa (mbar)", 1e2),
    (Dimension::Pressure, "MPa", 1e6),
    (Dimension::Pressure, "GPa", 1e9),
    (Dimension::MassFlow, "kg/s", 1.0),
    (Dimension::MassFlow, "g/s", 1e-3),
    (Dimension::MassFlow, "kg/ms", 1e3),
    (Dimension::MassFlow, "mg/s", 1e-6),
    (Dimension::MolarMass, "kg/mol", 1.0),
    (Dimension::MolarMass, "g/mol", 1e-3),
    (Dimension::MolarHeat, "J/(mol K)", 1.0),
    (Dimension::MolarHeat, "mJ/(mol K)", 1e-3),
    (Dimension::HeatTransfer, "W/(m2 K)", 1.0),
    (Dimension::HeatTransfer, "W/(mm2 K)", 1e6),
    (Dimension::Density, "kg/m3", 1.0),
    (Dimension::Density, "g/cm3", 1e3),
    (Dimension::Density, "kg/mm3", 1e9),
    (Dimension::Density, "t/mm3", 1e12),
    (Dimension::Acceleration, "m/s2", 1.0),
    (Dimension::Acceleration, "mm/s2", 1e-3),
    (Dimension::Velocity, "m/s", 1.0),
    (Dimension::Velocity, "mm/s", 1e-3),
    (Dimension::Time, "s", 1.0),
    (Dimension::Time, "ms", 1e-3),
    (Dimension::Time, "us", 1e-6),
];

/// SI units in one of the list; 1 of what is not there.
pub fn factor_of(unit: &str, dimension: Dimension) -> f64 {
    UNITS.iter().find(|known| known.0 == dimension && known.1 == unit).map_or(1.0, |known| known.2)
}

/// The names of the list.
pub fn units_of(dimension: Dimension) -> impl Iterator<Item = &'static str> {
    UNITS.iter().filter(move |known| known.0 == dimension).map(|known| known.1)
}

/// The unit of pressure, not the scene's own, that is nearest to so many Pa, if one is within a power of ten.
pub fn pressure_unit(wanted: f64, units: UnitSystem) -> Option<&'static str> {
    let own = units.factor(Dimension::Pressure);
    let distance = |factor: f64| libm::fabs(libm::log10(factor / wanted));
    let pressures = UNITS.iter().filter(|(dimension, ..)| *dimension == Dimension::Pressure);
    let others = pressures.filter(|(_, _, factor)| libm::fabs(factor / own - 1.0) > 1e-9 && distance(*factor) <= 1.0);
    others.min_by(|a, b| distance(a.2).total_cmp(&distance(b.2))).map(|known| known.1)
}

/// How much farther from what is usual than the nearest another unit may lie to be named beside it, in powers of ten: pressures in
/// hPa and kPa are both common.
const AS_LIKELY: f64 = 0.4;

/// The units in which the number that was written for `si` would lie within the range, by how near to what is usual: those that
/// are about as likely as the first.
pub fn likely(range: &Range, si: f64, units: UnitSystem) -> Vec<&'static str> {
    let own = units.factor(range.dimension);
    let written = si / own;
    let distance = |factor: f64| libm::fabs(libm::log10(written * factor / range.usual));
    let mut fitting: Vec<(f64, &'static str)> = UNITS
        .iter()
        .filter(|(dimension, _, factor)| *dimension == range.dimension && libm::fabs(factor / own - 1.0) > 1e-9)
        .filter(|(_, _, factor)| written > 0.0 && range.holds(written * factor))
        .map(|known| (distance(known.2), known.1))
        .collect();
    fitting.sort_by(|a, b| a.0.total_cmp(&b.0));
    let nearest = fitting.first().map_or(0.0, |first| first.0);
    fitting.into_iter().filter(|(distance, _)| distance - nearest < AS_LIKELY).map(|known| known.1).collect()
}

/// ": is it in kPa or hPa (mbar)?", or nothing.
pub fn question(likely: &[&str]) -> String {
    if likely.is_empty() { String::new() } else { format!(": is it in {}?", likely.join(" or ")) }
}

/// The standard atmosphere, Pa, and how far from it its rounded digits are (1.013, 1.0133).
const ATMOSPHERE: f64 = 101_325.0;
const ROUNDED: f64 = 4e-4;

/// The unit in which a number has the digits of an atmosphere, if that is not the scene's own.
pub fn atmosphere_in(written: f64, units: UnitSystem) -> Option<&'static str> {
    let own = units.factor(Dimension::Pressure);
    let is_one = |factor: f64| libm::fabs(written * factor / ATMOSPHERE - 1.0) < ROUNDED;
    let pressures = UNITS.iter().filter(|(dimension, ..)| *dimension == Dimension::Pressure);
    pressures.filter(|(_, _, factor)| is_one(*factor) && !is_one(own)).map(|known| known.1).next()
}
