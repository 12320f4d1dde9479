//! Regions that are too small for a probe, and radii that are diameters, where the scene itself tells: a region with the
//! axis or the centre of a wall and exactly twice its radius, a vent through exactly four times the disc that it is given.

use super::named::Named;
use super::range::{Kind, largest, range_of};
use super::units::{likely, question};
use crate::plan::text::as_written;
use crate::scene::{Dimension, GasSide, Probe, Region, Scene, Shape, Vent};

/// How near to 1 the ratio of two lengths is that were meant to be the same number.
const SAME: f64 = 1e-6;

/// m: of 2^28 particles in a cubic millimetre.
const SMALLEST_PARTICLE: f64 = 1e-7;

fn is_same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}

/// The longest side of the box around a shape, m; of a mesh its file has to say.
pub fn longest(shape: &Shape) -> Option<f64> {
    Some(match shape {
        Shape::Box { min, max, .. } => largest((0..3).map(|axis| max[axis] - min[axis])),
        Shape::Cylinder { radius, height, .. } => height.max(2.0 * radius),
        Shape::Sphere { radius, .. } => 2.0 * radius,
        Shape::Plane { size, .. } => size[0].max(size[1]),
        Shape::Mesh { .. } => return None,
    })
}

pub fn doubts(scene: &Scene) -> Vec<String> {
    let chambers = scene.chambers.iter().filter_map(|c| Some(("chamber", &c.name, c.region.as_ref()?)));
    let regions = chambers.chain(scene.probes.iter().map(|probe| ("probe", &probe.name, &probe.region)));
    let doubled = regions.filter_map(|(kind, name, region)| {
        let (wall, radius) = scene.walls.iter().find_map(|wall| Some((wall, doubled(&wall.shape, region)?)))?;
        let shown = |m: f64| {
            let (value, unit) = (m / scene.units.factor(Dimension::Length), scene.units.symbol(Dimension::Length));
            format!("{} {unit}", as_written(value))
        };
        Some(format!(
            "{kind} `{name}`: its region has the radius {}, twice the {} of wall `{}` around it: is it the diameter?",
            shown(2.0 * radius),
            shown(radius),
            wall.name
        ))
    });
    let vents = scene.vents.iter().filter_map(|vent| wide_vent(scene, vent));
    let small = scene.probes.iter().filter_map(|probe| small_region(scene, probe));
    doubled.chain(small).chain(vents).chain(two_insides(scene)).chain(molecules(scene)).collect()
}

/// A probe is a part of a vessel, of which none is as small.
fn small_region(scene: &Scene, probe: &Probe) -> Option<String> {
    let longest = match &probe.region {
        Region::Box { min, max } => largest((0..3).map(|axis| max[axis] - min[axis])),
        Region::Sphere { radius, .. } => 2.0 * radius,
        Region::Cylinder { radius, height, .. } => height.max(2.0 * radius),
    };
    let range = range_of(Kind::Extent);
    let named =
        Named { subject: format!("probe `{}`", probe.name), key: "longest side of its region", units: scene.units };
    let question = question(&likely(range, longest, scene.units));
    (longest < range.least && !range.holds(longest)).then(|| named.beyond(range, longest, &question))
}

/// Gas inside of several walls is only where all of them enclose it.
fn two_insides(scene: &Scene) -> Option<String> {
    let inside: Vec<String> =
        scene.walls.iter().filter(|wall| wall.gas == GasSide::Inside).map(|wall| format!("`{}`", wall.name)).collect();
    (inside.len() > 1).then(|| {
        format!(
            "walls {}: all have the gas inside, so gas is only where all of them enclose it: a body in the gas has `gas = \"outside\"`",
            inside.join(", ")
        )
    })
}

/// The diameter of particles, each of which stands for very many molecules, m.
fn molecules(scene: &Scene) -> Option<String> {
    let diameter = scene.model.diameter.filter(|diameter| *diameter < SMALLEST_PARTICLE)?;
    Some(format!(
        "the model: diameter {} {}: is it of molecules? That of particles follows from their number: leave it out",
        as_written(diameter / scene.units.factor(Dimension::Length)),
        scene.units.symbol(Dimension::Length)
    ))
}

/// The radius of the wall, if the region has the same place and twice that.
fn doubled(shape: &Shape, region: &Region) -> Option<f64> {
    match (shape, region) {
        (Shape::Sphere { center, radius, .. }, Region::Sphere { center: middle, radius: own }) => {
            (center == middle && is_same(*own, 2.0 * radius)).then_some(*radius)
        }
        (Shape::Cylinder { base, axis, radius, .. }, Region::Cylinder { base: low, axis: along, radius: own, .. }) => {
            let way: [f64; 3] = std::array::from_fn(|k| low[k] - base[k]);
            let dot = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let beside = dot(&way, &way) - dot(&way, axis).powi(2);
            let parallel = dot(axis, along).abs() > 1.0 - SAME;
            (parallel && beside <= (SAME * radius).powi(2) && is_same(*own, 2.0 * radius)).then_some(*radius)
        }
        _ => None,
    }
}

fn wide_vent(scene: &Scene, vent: &Vent) -> Option<String> {
    let (disc, area) = (vent.disc?, vent.area?);
    let full = std::f64::consts::PI * disc.diameter * disc.diameter;
    // Areas are rounded to three digits or so.
    let near = (area / full - 1.0).abs() < 5e-3;
    let shown = |si: f64, dimension| {
        format!("{} {}", as_written(si / scene.units.factor(dimension)), scene.units.symbol(dimension))
    };
    near.then(|| {
        format!(
            "vent `{}`: its area {} is four times that of a disc of the diameter {}: is it the radius?",
            vent.name,
            shown(area, Dimension::Area),
            shown(disc.diameter, Dimension::Length)
        )
    })
}
