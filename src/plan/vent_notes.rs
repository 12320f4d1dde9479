//! What vents do that was hardly meant: chambers with less pressure than outside, pressures of opening that look absolute, curves whose pressures no chamber has, more area
//! than wall, nothing at all, and gas of the scene behind them.

use super::amounts::Contents;
use super::plausible::pressure_unit;
use super::text::{as_written, significant};
use super::{Measured, MeasuredVent};
use crate::scene::{Chamber, Curve, Dimension, Scene, Vent, VentFlow};

/// Share by which two pressures differ that were meant to be the same.
pub const SAME: f64 = 1e-3;
/// Area over that of a vent's place: what is less is rounding.
const ALL: f64 = 1.05;
/// Shares of what a chamber may have above the outside: a curve that ends below the first is in another unit, or one that begins beyond
/// the second.
const FAR_BELOW: f64 = 0.003;
const FAR_BEYOND: f64 = 3.0;
/// What another unit or the other column may make of the last point, over the same.
const FITS: std::ops::RangeInclusive<f64> = 0.1..=10.0;
/// Pressure of a chamber over that outside of its vent: between these two it may be gauge. With less it is near vacuum, or in another unit.
const FAINT: f64 = 0.02;
const LESS: f64 = 0.98;
/// Coefficients below it are hardly those of a vent.
const SMALL: f64 = 0.05;

/// Beside each vent and its place the highest pressure that is known of all gas, Pa: of chambers at the start, and of all gas
/// together at the end, no heat lost.
pub fn of_vents(scene: &Scene, measured: &Measured, end: &Contents) -> Vec<String> {
    let squeezed = measured.motion.map_or(1.0, |motion| libm::pow(motion.least_share, -5.0 / 3.0));
    let highest = squeezed * scene.chambers.iter().map(|chamber| chamber.pressure).fold(end.pressure, f64::max);
    let vents = scene.vents.iter().zip(&measured.vents);
    let own = vents.flat_map(|(vent, place)| {
        let above = highest - vent.external_pressure;
        let curve = swapped(scene, vent, above).or_else(|| other_unit(scene, vent, above));
        let held = leaks_without_pressure(scene, vent);
        [looks_absolute(scene, vent), curve, wide(scene, vent, place), shut(vent), held].into_iter().flatten()
    });
    own.chain(below_outside(scene, measured)).chain(backed(scene, measured)).chain(of_bags(scene)).collect()
}

/// A pressure of opening that no gas reaches but would as an absolute one: " Is ...?", or nothing.
pub fn absolute_question(scene: &Scene, vent: &Vent, highest: f64) -> &'static str {
    let above_outside = vent.opening_pressure >= (1.0 - SAME) * vent.external_pressure;
    if above_outside && !is_absolute(scene, vent) && vent.opening_pressure <= highest {
        ". `opening_pressure` is above the outside: is it absolute? Write `opening_pressure_absolute` then"
    } else {
        ""
    }
}

/// Whether the scene gives the pressure of opening as an absolute one.
pub fn is_absolute(scene: &Scene, vent: &Vent) -> bool {
    scene.lines.holds(&format!("vent `{}`: opening_pressure_absolute", vent.name))
}

/// Up to six digits of a pressure, with the unit of the scene.
pub fn pressure(scene: &Scene, si: f64) -> String {
    let unit = scene.units.symbol(Dimension::Pressure);
    format!("{} {unit}", as_written(si / scene.units.factor(Dimension::Pressure)))
}

/// Digits that are written of a number, at most six.
fn digits(value: f64) -> usize {
    let text = format!("{value:.5e}");
    let mantissa = text.split('e').next().unwrap_or_default();
    mantissa.trim_end_matches('0').chars().filter(char::is_ascii_digit).count()
}

/// An atmosphere and a round number more, or just an atmosphere.
fn looks_absolute(scene: &Scene, vent: &Vent) -> Option<String> {
    let above = vent.opening_pressure - vent.external_pressure;
    let is_outside = above.abs() <= 1e-6 * vent.external_pressure;
    let is_round = is_outside || (above > 0.0 && digits(above) <= 2);
    (vent.external_pressure > 0.0 && digits(vent.opening_pressure) >= 4 && is_round && !is_absolute(scene, vent)).then(|| {
        let more = if is_outside { "the outside".into() } else { format!("the outside and {} more", pressure(scene, above)) };
        format!(
            "vent `{}`: opening_pressure {} is {more}: is it absolute? It is one above the outside; write `opening_pressure_absolute` then",
            vent.name,
            pressure(scene, vent.opening_pressure)
        )
    })
}

fn over_pressure(vent: &Vent) -> Option<(&'static str, &Curve)> {
    match &vent.flow {
        VentFlow::Discharge(_) => None,
        VentFlow::DischargeByPressure(curve) => Some(("discharge_by_pressure", curve)),
        VentFlow::LeakVelocity(curve) => Some(("leak_velocity", curve)),
    }
}

/// Coefficients in the place of pressures, which no gas reaches, and pressures in theirs.
fn swapped(scene: &Scene, vent: &Vent, above: f64) -> Option<String> {
    let VentFlow::DischargeByPressure(curve) = &vent.flow else { return None };
    let unit = scene.units.factor(Dimension::Pressure);
    let last = curve.points.last()?;
    let rises = curve.points.windows(2).all(|pair| pair[1][1] > pair[0][1]);
    let are_coefficients = last[0] / unit <= 1.0 && last[0] / unit > SMALL;
    let are_pressures = FITS.contains(&(last[1] * unit / above));
    let beyond = curve.points.iter().all(|point| point[0] == 0.0 || point[0] > above);
    let hardly_coefficients = last[1] < SMALL || curve.points.len() > 2;
    let is_so = rises && are_coefficients && are_pressures && beyond && hardly_coefficients;
    (above > 0.0 && curve.points.len() > 1 && is_so).then(|| {
        format!(
            "vent `{}`: discharge_by_pressure has coefficients of at most {} at pressures up to {}, and its chamber has at most {} above \
             the outside: are its columns swapped? A point is [pressure above the outside, coefficient]",
            vent.name,
            significant(last[1]),
            pressure(scene, last[0]),
            pressure(scene, above)
        )
    })
}

/// Pressures that are all far below what the chamber comes to have, or all far beyond it.
fn other_unit(scene: &Scene, vent: &Vent, above: f64) -> Option<String> {
    let (key, curve) = over_pressure(vent)?;
    let [first, last] = [curve.points.iter().find(|point| point[0] > 0.0)?[0], curve.points.last()?[0]];
    let unit = scene.units.factor(Dimension::Pressure);
    // Nothing at 0 and all at next to nothing is a switch.
    let is_switch = curve.points.len() == 2 && curve.points[0][1] == 0.0 && last / unit <= 1.0;
    let below = curve.points.len() > 1 && last < FAR_BELOW * above && !is_switch;
    let beyond = curve.points.len() > 2 && first > FAR_BEYOND * above;
    if above <= 0.0 || !(below || beyond) {
        return None;
    }
    let meant = pressure_unit(above / (last / unit), scene.units)?;
    let reach = if below { "ends at" } else { "has its first pressure at" };
    Some(format!(
        "vent `{}`: {key} {reach} {}, and its chamber may have {} above the outside: are its pressures in {meant}? This scene has {}",
        vent.name,
        pressure(scene, if below { last } else { first }),
        significant_pressure(scene, above),
        scene.units.symbol(Dimension::Pressure)
    ))
}

fn significant_pressure(scene: &Scene, si: f64) -> String {
    let unit = scene.units.symbol(Dimension::Pressure);
    format!("{} {unit}", significant(si / scene.units.factor(Dimension::Pressure)))
}

/// Vents of fabric that moves: a bag that grows may have less pressure than is around it.
fn of_bags(scene: &Scene) -> Option<String> {
    let moves = |vent: &&Vent| {
        let fabric = scene.fabric_at(vent.wall).map(|index| &scene.fabrics[index]);
        fabric.is_some_and(|fabric| fabric.motion.is_some() || fabric.turn.is_some() || fabric.membrane.is_some())
    };
    let names: Vec<String> = scene.vents.iter().filter(moves).map(|vent| format!("`{}`", vent.name)).collect();
    (!names.is_empty()).then(|| {
        format!(
            "nothing flows in through {}: the end of a run tells for how long gas would have, where fabric that grows had less pressure \
             inside than around it",
            names.join(", ")
        )
    })
}

/// Chambers with less pressure at the start than outside of a vent: the first vent of each.
fn below_outside(scene: &Scene, measured: &Measured) -> Vec<String> {
    let vents = || scene.vents.iter().zip(&measured.vents);
    let of_chamber = |(index, chamber): (usize, &Chamber)| {
        let share = |vent: &Vent| chamber.pressure / vent.external_pressure;
        let (vent, _) = vents().find(|(vent, place)| place.chamber == index && (FAINT..LESS).contains(&share(vent)))?;
        Some(format!(
            "vent `{}`: chamber `{}` has {} at the start, less than the {} outside, and a vent lets nothing in: is the pressure of the \
             chamber gauge? It is absolute, as `external_pressure` is",
            vent.name,
            chamber.name,
            pressure(scene, chamber.pressure),
            pressure(scene, vent.external_pressure)
        ))
    };
    scene.chambers.iter().enumerate().filter_map(of_chamber).collect()
}

/// A fabric that is measured from some pressure on, and leaks as much without any.
fn leaks_without_pressure(scene: &Scene, vent: &Vent) -> Option<String> {
    let VentFlow::LeakVelocity(curve) = &vent.flow else { return None };
    let [least, velocity] = *curve.points.first()?;
    (least > 0.0 && velocity > 0.0).then(|| {
        format!(
            "vent `{}`: its leak_velocity begins with {} {} at {}, and holds that at all pressures below, down to 0: begin with [0, 0] if \
             nothing leaks without pressure",
            vent.name,
            as_written(velocity / scene.units.factor(Dimension::Velocity)),
            scene.units.symbol(Dimension::Velocity),
            pressure(scene, least)
        )
    })
}

/// More area than wall. (A leaking fabric may be folded.)
fn wide(scene: &Scene, vent: &Vent, place: &MeasuredVent) -> Option<String> {
    let area = vent.area.filter(|area| vent.disc.is_some() && *area > ALL * place.area)?;
    if matches!(vent.flow, VentFlow::LeakVelocity(_)) {
        return None;
    }
    let shown = |si: f64| significant(si / scene.units.factor(Dimension::Area));
    Some(format!(
        "vent `{}`: its area {} is more than the {} {} of its disc: is it an area, and in the unit of the scene?",
        vent.name,
        shown(area),
        shown(place.area),
        scene.units.symbol(Dimension::Area)
    ))
}

/// A vent that never lets anything out.
fn shut(vent: &Vent) -> Option<String> {
    let (VentFlow::Discharge(curve) | VentFlow::DischargeByPressure(curve) | VentFlow::LeakVelocity(curve)) =
        &vent.flow;
    let is_shut = curve.points.iter().all(|point| point[1] == 0.0);
    is_shut
        .then(|| format!("vent `{}`: its coefficient, or its velocity, is 0 throughout: nothing passes it", vent.name))
}

/// Gas of the scene behind a vent.
fn backed(scene: &Scene, measured: &Measured) -> Vec<String> {
    let told = measured.backed_vents.iter().map(|&[vent, chamber]| {
        let own = &scene.vents[vent];
        format!(
            "vent `{}`: behind wall `{}` is the gas of chamber `{}`, and what passes a vent leaves the model: it does not come there. A hole \
             between chambers is a [[wall.hole]], or one in the mesh",
            own.name, scene.walls[own.wall].name, scene.chambers[chamber].name
        )
    });
    told.collect()
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn digits_are_those_that_are_written() {
        assert_eq!([101_325.0, 151_325.0, 5e4, 0.05, 1.51325e-4, 1.5e5].map(digits), [6, 6, 1, 1, 6, 2]);
    }
}
