//! Membranes under pressure, at rest: bags against figures of the literature, round ones against p r.
//!
//! - Square bag of an inextensible membrane: V = .2055 L^3 (Kepert, by minimisation; upper bound .217).
//! - Square bag of 1200 mm from corner to corner, E = 588 MPa, nu = .4, .6 mm, 5 kPa: 217 mm high from its middle plane, in studies of wrinkled membranes.
//! - Two discs of radius a: V = 1.2185 a^3, thickness .9139 a, radius .7628 a (Paulsen, Am. Math. Monthly 101 (1994) 953).
//! - Round ones: the tension per length is p r around a cylinder, p r/2 of a sphere, on the radius that they come to.

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use crate::fabric::{Elasticity, Material};
use crate::geometry::MeshShape;
use crate::gpu::Device;
use crate::study::StudyError;

use crate::study::verify::{Check, Effort, Findings};

use super::sheet::{FABRIC, Run, Sheet, THICKNESS};

/// Of the largest peak of the energy of motion: the last one, at rest.
const STILL: f64 = 1e-6;
const MOST_STEPS: u32 = 60_000;

fn at_rest<'a>(device: &'a Device, sheet: &Sheet) -> Result<Run<'a>, StudyError> {
    let run = sheet.run(device, 1.0)?;
    let rest = run.rest(STILL, MOST_STEPS)?;
    tracing::debug!("{rest:?}");
    Ok(run)
}

/// `tolerance` is a part of the reference.
fn check(quantity: String, reference: f64, measured: f64, tolerance: f64) -> Check {
    Check::of(quantity, reference, (measured, 0.0), tolerance * reference)
}

fn of(effort: Effort, quick: u32, full: u32) -> u32 {
    if effort == Effort::Quick { quick } else { full }
}

/// The volume of a square bag of so many elements a side.
pub fn square(device: &Device, elements: u32) -> Result<Check, StudyError> {
    let side: f64 = 0.5;
    let shape = MeshShape::Teabag { side, elements, gap: 0.01 * side };
    let run = at_rest(device, &Sheet::bag(shape, THICKNESS, 1000.0)?)?;
    let found = run.shape()?.volume() / side.powi(3);
    let tolerance = if elements < 40 { 0.03 } else { 0.02 };
    Ok(check(format!("V/L^3, {elements} elements a side"), 0.2055, found, tolerance))
}

pub fn squares(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    Ok(vec![square(device, of(effort, 20, 40))?].into())
}

/// The height of the bag of 1200 mm, at 5 kPa in the literature.
pub fn half_height(device: &Device, elements: u32, pressure: f64) -> Result<Check, StudyError> {
    let side = 1.2 * FRAC_1_SQRT_2;
    let mut sheet = Sheet::bag(MeshShape::Teabag { side, elements, gap: 0.01 * side }, 6e-4, pressure)?;
    sheet.material = Material { elasticity: Elasticity::Isotropic { young: 588e6, poisson: 0.4 }, ..FABRIC };
    let [low, high] = at_rest(device, &sheet)?.shape()?.bounds();
    let found = 0.5 * (high[2] - low[2]);
    Ok(check(format!("half height, m, {elements} elements a side"), 0.217, found, 0.02))
}

pub fn half_heights(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    Ok(vec![half_height(device, of(effort, 20, 40), 5000.0)?].into())
}

/// Two discs of so many rings.
pub fn disc(device: &Device, rings: u32) -> Result<Vec<Check>, StudyError> {
    let radius: f64 = 0.3;
    let shape = MeshShape::Cushion { radius, rings, gap: 0.01 * radius };
    let run = at_rest(device, &Sheet::bag(shape, THICKNESS, 1000.0)?)?;
    let shape = run.shape()?;
    let [low, high] = shape.bounds();
    // The rim's nodes were at z = 0.
    let rim = run.mesh.nodes.iter().zip(&shape.nodes).filter(|(start, _)| start[2] == 0.0);
    let mean = mean(rim.map(|(_, node)| libm::hypot(node[0], node[1])));
    let title = |what: &str| format!("{what}, {rings} rings");
    Ok(vec![
        check(title("V/a^3"), 1.2185, shape.volume() / radius.powi(3), 0.015),
        check(title("thickness/a"), 0.9139, (high[2] - low[2]) / radius, 0.03),
        check(title("radius/a"), 0.7628, mean / radius, 0.03),
    ])
}

pub fn discs(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    Ok(disc(device, of(effort, 12, 24))?.into())
}

/// The tension per length along a direction in a triangle, N/m: of F S F^T in what its area is now.
fn tension(run: &Run<'_>, triangle: usize, places: &[DVec3], along: impl Fn(DVec3) -> DVec3) -> f64 {
    let model = run.membrane.model();
    let triangle = &model.triangles[triangle];
    let [a, b, c] = triangle.nodes.map(|node| places[node as usize]);
    let edges = [b - a, c - a];
    let stress = model.stress(triangle, [a, b, c]).stress;
    let direction = along((a + b + c) / 3.0);
    let [x, y] = triangle.deformation(edges).map(|column| column.dot(direction));
    let along = stress[0] * x * x + stress[1] * y * y + 2.0 * stress[2] * x * y;
    along * triangle.volume / (0.5 * edges[0].cross(edges[1]).length())
}

const ROUND_PRESSURE: f64 = 2e4;
const ROUND_RADIUS: f64 = 0.1;

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// A cylinder of so many elements around.
pub fn cylinder(device: &Device, around: u32) -> Result<Check, StudyError> {
    let height = 4.0 * ROUND_RADIUS;
    let shape = MeshShape::Cylinder { radius: ROUND_RADIUS, height, around, along: None, closed: false };
    let mut sheet = Sheet::new(shape.mesh([0.0; 3])?, THICKNESS, |place| place);
    sheet.press(ROUND_PRESSURE);
    sheet.fix(|place| place.z.abs() > 0.4999 * height);
    let run = at_rest(device, &sheet)?;
    let places = run.places()?;
    // Far from the ends, which are held at the radius of the start.
    let middle = |place: &DVec3| place.z.abs() < 0.7 * ROUND_RADIUS;
    let radius = mean(places.iter().filter(|place| middle(place)).map(|place| libm::hypot(place.x, place.y)));
    let around_z = |place: DVec3| DVec3::Z.cross(place).normalize();
    let triangles = run.membrane.model().triangles.iter().enumerate();
    let inner = triangles.filter(|(_, triangle)| triangle.nodes.iter().all(|&node| middle(&places[node as usize])));
    let found = mean(inner.map(|(k, _)| tension(&run, k, &places, around_z)));
    let title = format!("cylinder, {around} around: tension/(p r)");
    Ok(check(title, 1.0, found / (ROUND_PRESSURE * radius), 0.005))
}

/// A sphere of an icosahedron that is quartered so often.
pub fn sphere(device: &Device, subdivisions: u32) -> Result<Check, StudyError> {
    let shape = MeshShape::Sphere { radius: ROUND_RADIUS, subdivisions };
    let mut sheet = Sheet::new(shape.mesh([0.0; 3])?, THICKNESS, |place| place);
    sheet.press(ROUND_PRESSURE);
    let run = at_rest(device, &sheet)?;
    let places = run.places()?;
    let radius = mean(places.iter().map(|place| place.length()));
    // Over both directions in the sheet.
    let east = |place: DVec3| place.normalize().any_orthonormal_vector();
    let north = |place: DVec3| place.normalize().cross(east(place));
    let both = |k| 0.5 * (tension(&run, k, &places, east) + tension(&run, k, &places, north));
    let found = mean((0..run.mesh.triangles.len()).map(both));
    let title = format!("sphere, {} triangles: tension/(p r/2)", run.mesh.triangles.len());
    Ok(check(title, 1.0, 2.0 * found / (ROUND_PRESSURE * radius), 0.005))
}

pub fn round(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    Ok(vec![cylinder(device, of(effort, 48, 64))?, sphere(device, of(effort, 3, 4))?].into())
}
