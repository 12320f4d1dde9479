//! Orifices that no inflator has: gas colder than what it flows into, jets as slow as a Mach number or with less pressure than where they flow,
//! one flow that several bring.

use glam::DVec3;

use super::named::Named;
use super::range::{Kind, Range, most, range_of};
use super::units::{likely, question};
use crate::plan::text::{as_written, significant};
use crate::scene::{Dimension, GAS_CONSTANT, JetSpeed, Orifice, Scene, UnitSystem};

/// Temperature over that of the chamber: colder gas than this is not just as warm as the room.
const COLDER: f64 = 0.97;
/// K: hardly any inflator's gas is colder.
const COLD: f64 = 250.0;
/// m/s: no jet that anybody models is slower.
const SLOW: f64 = 1.0;
/// Up to this a number may be a Mach number.
const MOST_MACH: f64 = 10.0;
/// Pressure at rest over that where a jet flows: no choked nozzle has less; it takes 1.9.
const WEAK: f64 = 0.5;
/// m2: no nozzle is as large.
const LARGE: f64 = 1e-3;
/// Distance over the radius of an orifice, within which two are at one place.
const SAME_PLACE: f64 = 0.1;

/// `sources`: the chamber that each orifice blows into.
pub fn notes(scene: &Scene, sources: &[Option<usize>]) -> Vec<String> {
    let cold = scene.orifices.iter().zip(sources).filter_map(|(orifice, &into)| cold(scene, orifice, into));
    let slow = scene.orifices.iter().filter_map(|orifice| slow_jet(scene, orifice));
    let weak = scene.orifices.iter().zip(sources).filter_map(|(orifice, &into)| weak_jet(scene, orifice, into));
    cold.chain(slow).chain(weak).chain(shared_flows(scene)).collect()
}

/// Gas that is cold at its hottest. (What no gas has is doubted otherwise.)
fn cold(scene: &Scene, orifice: &Orifice, into: Option<usize>) -> Option<String> {
    let hottest = most(&orifice.temperature);
    let warmer = into.map(|chamber| &scene.chambers[chamber]).filter(|own| hottest < COLDER * own.temperature);
    if !range_of(Kind::Temperature).holds(hottest) || warmer.is_none() && hottest >= COLD {
        return None;
    }
    let than = warmer.map_or(String::new(), |own| {
        format!(", colder than the {} K of chamber `{}`", as_written(own.temperature), own.name)
    });
    let most = if orifice.temperature.points.len() > 1 { "at most " } else { "" };
    let shown = as_written(hottest);
    Some(format!(
        "orifice `{}`: its gas has {most}{shown} K{than}: is it in degrees Celsius? {shown} C are {} K",
        orifice.name,
        as_written(hottest + 273.15)
    ))
}

/// Whether the number of a speed, m/s, may be a Mach number.
fn may_be_mach(units: UnitSystem, speed: f64) -> bool {
    speed / units.factor(Dimension::Velocity) < MOST_MACH
}

/// A jet that is slower than any, or faster than gas.
pub fn slow(named: &Named<'_>, speed: f64) -> Option<String> {
    let range = Range { least: SLOW, ..*range_of(Kind::Speed) };
    let question = if may_be_mach(named.units, speed) {
        ": is it a Mach number? That is `mach`".into()
    } else {
        question(&likely(&range, speed, named.units))
    };
    (!range.holds(speed)).then(|| named.beyond(&range, speed, &question))
}

/// Jets that are slower than any are doubted otherwise.
fn slow_jet(scene: &Scene, orifice: &Orifice) -> Option<String> {
    let JetSpeed::Velocity(speed) = orifice.jet?.speed else { return None };
    (speed >= SLOW && may_be_mach(scene.units, speed)).then(|| {
        format!(
            "orifice `{}`: its jet has a velocity of {} {}: is it a Mach number? That is `mach`",
            orifice.name,
            as_written(speed / scene.units.factor(Dimension::Velocity)),
            scene.units.symbol(Dimension::Velocity)
        )
    })
}

/// Jets at the speed of sound and above, from more than a nozzle, that have less pressure at rest than the chamber that they flow into.
///
/// Where a mass flow G goes through an area A at a Mach number Ma, p0 = G/A sqrt(R T0/(gamma M)) / Ma (1 + (gamma-1)/2 Ma^2)^((gamma+1)/(2 (gamma-1))).
fn weak_jet(scene: &Scene, orifice: &Orifice, into: Option<usize>) -> Option<String> {
    let JetSpeed::Mach(mach) = orifice.jet?.speed else { return None };
    let (chamber, flow) = (&scene.chambers[into?], most(&orifice.mass_flow));
    if mach < 1.0 || flow <= 0.0 || orifice.area < LARGE {
        return None;
    }
    let hottest = most(&orifice.temperature);
    let gamma = heat_capacity_ratio(scene, orifice, hottest);
    let thermal = GAS_CONSTANT * hottest / orifice.mixture.molar_mass(&scene.gases);
    let stagnation = 1.0 + 0.5 * (gamma - 1.0) * mach * mach;
    let at_rest = flow / (orifice.area * mach)
        * libm::sqrt(thermal / gamma)
        * libm::pow(stagnation, 0.5 * (gamma + 1.0) / (gamma - 1.0));
    let shown = |si: f64, dimension: Dimension| {
        format!("{} {}", significant(si / scene.units.factor(dimension)), scene.units.symbol(dimension))
    };
    (at_rest < WEAK * chamber.pressure).then(|| {
        format!(
            "orifice `{}`: {} at Mach {} through {} come from {} at rest, and chamber `{}` has {}: is `area` a diameter, or in another unit?",
            orifice.name,
            shown(flow, Dimension::MassFlow),
            as_written(mach),
            shown(orifice.area, Dimension::Area),
            shown(at_rest, Dimension::Pressure),
            chamber.name,
            shown(chamber.pressure, Dimension::Pressure)
        )
    })
}

/// The frozen gamma of the gas of an orifice.
fn heat_capacity_ratio(scene: &Scene, orifice: &Orifice, temperature: f64) -> f64 {
    let of_gas = |&(gas, fraction): &(usize, f64)| fraction * scene.gases[gas].heat.molar_cv(temperature);
    1.0 + GAS_CONSTANT / orifice.mixture.0.iter().map(of_gas).sum::<f64>()
}

/// Orifices with one place, direction and mass flow: each species of a mixture, with the flow of all.
fn shared_flows(scene: &Scene) -> Vec<String> {
    let all = &scene.orifices;
    let group = |index: usize| {
        let first = &all[index];
        if most(&first.mass_flow) <= 0.0 || all[..index].iter().any(|earlier| is_twin(earlier, first)) {
            return None;
        }
        let names: Vec<String> =
            all[index..].iter().filter(|own| is_twin(first, own)).map(|own| format!("`{}`", own.name)).collect();
        let (last, rest) = names.split_last()?;
        (!rest.is_empty()).then(|| {
            format!(
                "orifices {} and {last}: they have one place and one mass_flow, and each brings all of it: is it that of their mixture? \
                 Give each its mass fraction of it, or give one orifice the mixture",
                rest.join(", ")
            )
        })
    };
    (0..all.len()).filter_map(group).collect()
}

fn is_twin(a: &Orifice, b: &Orifice) -> bool {
    let radius = libm::sqrt(a.area.min(b.area) / std::f64::consts::PI);
    let apart = DVec3::from(a.position).distance(DVec3::from(b.position));
    let along = DVec3::from(a.direction).dot(DVec3::from(b.direction));
    a.mass_flow == b.mass_flow && apart < SAME_PLACE * radius && along > 1.0 - 1e-6
}
