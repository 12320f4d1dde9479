//! Values that can be read but cannot be meant: beyond what any vessel, gas or inflator has. One table of ranges; each value
//! beyond its range is told with the range and, where one fits, the unit in which it would lie within.
//!
//! A scene may mean it, so these are warnings. What is meant now and then is let pass: a chamber of near vacuum beside gas of
//! ordinary pressure or before an inflow, free flight at any pressure, a vent into vacuum.

mod fabrics;
mod flows;
mod heat;
mod inflators;
mod known;
mod named;
mod places;
mod range;
mod shapes;
mod strokes;
mod systems;
mod times;
mod units;

use super::amounts::Contents;
use super::text::{as_written, significant};
use super::{Measured, MeasuredWall};
use crate::scene::{
    Course, Curve, Dimension, GAS_CONSTANT, Gas, HeatTransfer, JetSpeed, Method, Orifice, Scene, Shape, SurfaceId,
    UnitSystem, Vent, VentFlow, Wall, WallHeat,
};
use named::Named;
use range::{Kind, largest, most, range_of};
use shapes::longest;

pub use flows::notes as notes_of_flows;
pub use inflators::notes as notes_of_inflators;
pub use known::notes as notes_of_gases;
pub use places::notes as notes_of_places;
pub use times::{long_run, many_steps, short_step};
use units::likely;
pub use units::pressure_unit;

/// All that is beyond its range by the scene alone, in its order, with its line: known also where no plan can be made of it, often for
/// that reason.
pub fn by_scene(scene: &Scene) -> Vec<String> {
    of_scene(scene).into_iter().map(|doubt| scene.lines.told(doubt)).collect()
}

fn of_scene(scene: &Scene) -> Vec<String> {
    let named = |subject: String, key: &'static str| Named { subject, key, units: scene.units };
    let mut found =
        vec![systems::other_system(scene), named("the run".into(), "end_time").check(Kind::EndTime, scene.end_time)];
    found.extend(scene.gases.iter().flat_map(|gas| of_gas(scene, gas)));
    found.extend(scene.walls.iter().map(|wall| of_wall(scene, wall)));
    found.extend(scene.surface_ids().flat_map(|id| of_surface(scene, id)));
    for chamber in &scene.chambers {
        let subject = format!("chamber `{}`", chamber.name);
        found.push(chamber_pressure(scene, &named(subject.clone(), "pressure"), chamber.pressure));
        found.push(temperature(&named(subject, "temperature"), chamber.temperature));
    }
    found.extend(scene.orifices.iter().flat_map(|orifice| of_orifice(scene, orifice)));
    found.extend(scene.vents.iter().flat_map(|vent| of_vent(scene, vent)));
    found.extend(scene.motions.iter().map(|motion| {
        let Course::Velocity(curve) = &motion.course else { return None };
        let subject = format!("motion of wall `{}`", scene.walls[motion.wall].name);
        named(subject, "velocity").check(Kind::Speed, most(curve))
    }));
    found.extend(fabrics::doubts(scene));
    found.into_iter().flatten().chain(times::doubts(scene)).chain(shapes::doubts(scene)).collect()
}

/// The same, and by its meshes, where its walls and its gas are, and all its gas at the end.
pub fn doubts(scene: &Scene, measured: &Measured, end: &Contents) -> Vec<String> {
    let mut found = of_scene(scene);
    found.extend(of_meshes(scene, &measured.walls));
    let range = range_of(Kind::Pressure);
    if end.pressure > range.most && scene.chambers.iter().all(|chamber| chamber.pressure <= range.most) {
        let all = Named { subject: "all gas with all inflow".into(), key: "mean pressure", units: scene.units };
        let question = ": are `mass_flow` and the walls in the units of the scene?";
        found.push(all.beyond(range, end.pressure, question));
    }
    found.extend(places::doubts(scene, measured));
    found.extend(measured.strokes.iter().filter_map(|stroke| strokes::hardly_moves(scene, stroke)));
    found
}

/// Meshes that are too large or too small, or the metal of a vessel, as their walls were measured; with their lines.
pub fn by_meshes(scene: &Scene, walls: &[MeasuredWall]) -> Vec<String> {
    of_meshes(scene, walls).into_iter().map(|doubt| scene.lines.told(doubt)).collect()
}

fn of_meshes(scene: &Scene, walls: &[MeasuredWall]) -> Vec<String> {
    let meshes = scene.walls.iter().zip(walls).filter(|(wall, _)| is_mesh(wall));
    let sides = |own: &MeasuredWall| largest((0..3).map(|axis| own.max[axis] - own.min[axis]));
    let large = meshes.filter_map(|(wall, own)| extent(scene.units, wall, sides(own)));
    large.chain(scene.walls.iter().zip(walls).filter_map(|(wall, own)| places::shell(scene.units, wall, own))).collect()
}

/// Below the range degrees Celsius are likely.
fn temperature(named: &Named<'_>, kelvin: f64) -> Option<String> {
    let range = range_of(Kind::Temperature);
    let celsius = kelvin + 273.15;
    let question = if kelvin < range.least && range.holds(celsius) {
        format!(": is it in degrees Celsius? {} C are {} K", as_written(kelvin), as_written(celsius))
    } else {
        String::new()
    };
    (!range.holds(kelvin)).then(|| named.beyond(range, kelvin, &question))
}

fn of_wall(scene: &Scene, wall: &Wall) -> Option<String> {
    longest(&wall.shape).and_then(|longest| extent(scene.units, wall, longest))
}

fn of_surface(scene: &Scene, id: SurfaceId) -> Vec<Option<String>> {
    let Some(heat) = scene.surface_model(id).heat else { return Vec::new() };
    let own = id.part.and_then(|_| scene.surface_model(SurfaceId { part: None, ..id }).heat);
    let subject = scene.surface_title(id);
    let named = |key| Named { subject: subject.clone(), key, units: scene.units };
    // What a part has from its wall or fabric is told of that.
    let differs = |own: Option<f64>, value: f64| own != Some(value);
    let coefficient = |heat: WallHeat| match heat.transfer {
        HeatTransfer::Coefficient(coefficient) => Some(coefficient),
        HeatTransfer::Accommodation(_) => None,
    };
    let kept = Some(heat.temperature).filter(|&kept| differs(own.map(|own| own.temperature), kept));
    let given = coefficient(heat).filter(|&given| differs(own.and_then(coefficient), given));
    vec![
        kept.and_then(|kelvin| temperature(&named("temperature"), kelvin)),
        given.filter(|given| *given > 0.0).and_then(|given| heat_transfer(&named("heat_transfer"), given)),
    ]
}

/// With what the number would be in the scene's units.
fn heat_transfer(named: &Named<'_>, given: f64) -> Option<String> {
    let range = range_of(Kind::HeatTransfer);
    let (own, symbol) = (named.units.factor(Dimension::HeatTransfer), named.units.symbol(Dimension::HeatTransfer));
    let question = likely(range, given, named.units).first().map_or(String::new(), |unit| {
        let written = given / own;
        let meant = written * units::factor_of(unit, Dimension::HeatTransfer) / own;
        format!(": is it in {unit}? {} {unit} are {} {symbol}", as_written(written), as_written(meant))
    });
    (!range.holds(given)).then(|| named.beyond(range, given, &question))
}

fn is_mesh(wall: &Wall) -> bool {
    matches!(wall.shape, Shape::Mesh { .. })
}

fn extent(units: UnitSystem, wall: &Wall, longest: f64) -> Option<String> {
    let range = range_of(Kind::Extent);
    let named = Named { subject: format!("wall `{}`", wall.name), key: "longest side", units };
    if range.holds(longest) {
        return None;
    }
    let question = match likely(range, longest, units).first() {
        None => String::new(),
        Some(unit) if is_mesh(wall) => {
            let scale = units::factor_of(unit, Dimension::Length) / units.factor(Dimension::Length);
            format!(": is the mesh in {unit}? then `scale = {}`", as_written(scale))
        }
        Some(unit) => format!(": is it in {unit}?"),
    };
    Some(named.beyond(range, longest, &question))
}

/// Near vacuum is meant beside ordinary gas, before an inflow, and in free flight.
fn chamber_pressure(scene: &Scene, named: &Named<'_>, pressure: f64) -> Option<String> {
    let range = range_of(Kind::Pressure);
    let beside = scene.chambers.iter().any(|other| range.holds(other.pressure));
    // An atmosphere is more than this in MPa, as is a tenth of a bar.
    let evacuated = pressure < 0.05 && !scene.orifices.is_empty();
    let meant = pressure < range.least && (beside || evacuated || scene.model.method == Some(Method::None));
    named.atmosphere(pressure).or_else(|| if meant { None } else { named.check(Kind::Pressure, pressure) })
}

fn of_gas(scene: &Scene, gas: &Gas) -> Vec<Option<String>> {
    let named = |key| Named { subject: format!("gas `{}`", gas.name), key, units: scene.units };
    vec![named("molar_mass").check(Kind::MolarMass, gas.molar_mass), heat::doubt(scene, gas, &named("molar cp"))]
}

fn of_orifice(scene: &Scene, orifice: &Orifice) -> Vec<Option<String>> {
    let named = |key| Named { subject: format!("orifice `{}`", orifice.name), key, units: scene.units };
    let flow = most(&orifice.mass_flow);
    let coldest = orifice.temperature.points.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
    let hottest = most(&orifice.temperature);
    let speed = match orifice.jet.map(|jet| jet.speed) {
        Some(JetSpeed::Velocity(speed)) => inflators::slow(&named("jet velocity"), speed),
        _ => None,
    };
    vec![
        named("area").check(Kind::Area, orifice.area),
        narrow_cone(orifice),
        named("mass_flow up to").check(Kind::MassFlow, flow).or_else(|| driven(scene, orifice, flow)),
        temperature(&named("temperature"), if range_of(Kind::Temperature).holds(hottest) { coldest } else { hottest }),
        speed,
    ]
}

/// Radians of the half angle of a cone that is given in degrees: nobody spreads a jet by less than one.
fn narrow_cone(orifice: &Orifice) -> Option<String> {
    let degrees = orifice.jet?.cone_angle.to_degrees();
    (degrees > 0.0 && degrees < 1.0).then(|| {
        format!(
            "orifice `{}`: cone_angle {} degrees, usual is 0, or at least 1: is it in radians? {} degrees then",
            orifice.name,
            as_written(degrees),
            significant(degrees.to_degrees())
        )
    })
}

/// The pressure that drives a flow through an orifice at the speed of sound, p = G sqrt(R T/M) / .68: no inflator has more than
/// vessels have. (The factor is .6847 at gamma 1.4, .726 at 5/3.)
fn driven(scene: &Scene, orifice: &Orifice, flow: f64) -> Option<String> {
    let hottest = most(&orifice.temperature);
    let molar_mass = orifice.mixture.molar_mass(&scene.gases);
    let pressure = flow / orifice.area * libm::sqrt(GAS_CONSTANT * hottest / molar_mass) / 0.6847;
    let limit = range_of(Kind::Pressure).most;
    let in_units = |si: f64, dimension| {
        format!("{} {}", significant(si / scene.units.factor(dimension)), scene.units.symbol(dimension))
    };
    (pressure > limit).then(|| {
        format!(
            "orifice `{}`: mass_flow up to {} through an area of {} takes {} to drive it, usual is at most {}: are both in the \
             units of the scene?",
            orifice.name,
            in_units(flow, Dimension::MassFlow),
            in_units(orifice.area, Dimension::Area),
            in_units(pressure, Dimension::Pressure),
            in_units(limit, Dimension::Pressure),
        )
    })
}

fn of_vent(scene: &Scene, vent: &Vent) -> Vec<Option<String>> {
    let named = |key| Named { subject: format!("vent `{}`", vent.name), key, units: scene.units };
    let highest = range_of(Kind::Pressure).most;
    let outside = vent.external_pressure;
    let external = named("external_pressure");
    let opening = named("opening_pressure");
    let flow = match &vent.flow {
        VentFlow::Discharge(curve) => {
            let question = if (1.0..=100.0).contains(&most(curve)) { ": is it in per cent?" } else { "" };
            let range = range_of(Kind::Discharge);
            (!range.holds(most(curve))).then(|| named("discharge").beyond(range, most(curve), question))
        }
        VentFlow::DischargeByPressure(curve) => {
            let own = scene.units.factor(Dimension::Pressure);
            let are_coefficients = curve.points.iter().all(|point| point[0] / own <= 1.0) && curve.points.len() > 1;
            let question = ": a point is [pressure above the outside, coefficient], are its columns swapped?";
            let question = if are_coefficients { question } else { "" };
            let range = range_of(Kind::Discharge);
            (!range.holds(most(curve))).then(|| named("discharge_by_pressure").beyond(range, most(curve), question))
        }
        VentFlow::LeakVelocity(curve) if has_swapped_columns(curve) => {
            let question = ": a point is [pressure above the outside, velocity], are its columns swapped?";
            Some(named("leak_velocity").beyond(range_of(Kind::Speed), most(curve), question))
        }
        VentFlow::LeakVelocity(curve) => named("leak_velocity").check(Kind::Speed, most(curve)),
    };
    vec![
        vent.area.and_then(|area| named("area").check(Kind::Area, area)),
        absolute_points(vent),
        // Vacuum is no mistake.
        external
            .atmosphere(outside)
            .or_else(|| if outside > highest { external.check(Kind::Pressure, outside) } else { None }),
        if vent.opening_pressure > 0.0 { opening.check(Kind::Pressure, vent.opening_pressure) } else { None },
        flow,
    ]
}

/// A leak velocity that is faster than any, over pressures that are lower than any.
fn has_swapped_columns(curve: &Curve) -> bool {
    let pressures = largest(curve.points.iter().map(|point| point[0]));
    !range_of(Kind::Speed).holds(most(curve)) && pressures > 0.0 && pressures < range_of(Kind::Pressure).least
}

/// Points of a curve over the pressure above the external one that begin about there.
fn absolute_points(vent: &Vent) -> Option<String> {
    let (VentFlow::DischargeByPressure(curve) | VentFlow::LeakVelocity(curve)) = &vent.flow else { return None };
    let first = curve.points.first()?[0];
    (curve.points.len() > 1 && first > 0.0 && (0.9..1.1).contains(&(first / vent.external_pressure))).then(|| {
        format!(
            "vent `{}`: its curve begins at about the external pressure: are its pressures absolute? They are those above the external one",
            vent.name
        )
    })
}
