//! What a membrane is made from, in SI.

use crate::geometry::Grid;

use super::elastic::Material;

/// How a node is held.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Hold {
    #[default]
    Free,
    Fixed,
    /// It moves with this velocity, m/s, which `Membrane::prescribe` changes.
    Prescribed([f64; 3]),
}

/// A face of a rigid convex body that nodes do not enter: of a half-space, if it has no other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle {
    /// On it, m, to half a quantum of the grid; of one that moves at the start of the next interval.
    pub place: [f64; 3],
    /// Of any length, towards the side where nodes may be.
    pub normal: [f64; 3],
    /// m/s.
    pub velocity: [f64; 3],
    /// mu of fabric on it, beside that of the fabric.
    pub friction: f64,
}

/// The size of a reference over time: that of its lengths over the true ones goes from `scale` at the start linearly to 1 at `time`, s; without
/// `time` it stays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    pub scale: f64,
    pub time: Option<f64>,
}

impl Relaxation {
    pub const NONE: Relaxation = Relaxation { scale: 1.0, time: None };

    /// At a time, s.
    pub fn at(&self, time: f64) -> f64 {
        let left = self.time.map_or(1.0, |whole| (1.0 - time / whole).max(0.0));
        1.0 + (self.scale - 1.0) * left
    }

    /// By how much lengths are larger than true at a time, s, if that did not end, and how fast it becomes less, 1/s.
    pub(super) fn line(&self, time: f64) -> [f64; 2] {
        let rate = self.time.map_or(0.0, |whole| (self.scale - 1.0) / whole);
        [self.scale - 1.0 - rate * time, rate]
    }
}

/// A triangle of fabric, free of stress where its first corner is the origin of a plane and the others are at `second` and `third`, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Element {
    pub second: [f64; 2],
    pub third: [f64; 2],
    /// m.
    pub thickness: f64,
    pub material: usize,
    /// Of the fibre in that plane, rad from its first axis.
    pub fibre: f64,
    /// What presses it along its normal, Pa: that on its back less that on its front.
    pub pressure: f64,
}

impl Element {
    /// One that is free of stress with its corners at these places, its first side along the first axis of the plane.
    pub fn of_places(corners: [[f64; 3]; 3], thickness: f64, material: usize) -> Element {
        let [a, b, c] = corners.map(glam::DVec3::from);
        let (second, third) = (b - a, c - a);
        let along = second.normalize_or_zero();
        let x = third.dot(along);
        let y = (third - along * x).length();
        let (second, third) = ([second.length(), 0.0], [x, y]);
        Element { second, third, thickness, material, fibre: 0.0, pressure: 0.0 }
    }

    /// One whose reference lies in the plane x, y, as its axes.
    pub fn of_flat_places(corners: [[f64; 2]; 3], thickness: f64, material: usize) -> Element {
        let [a, b, c] = corners;
        let less = |p: [f64; 2]| [p[0] - a[0], p[1] - a[1]];
        Element { second: less(b), third: less(c), thickness, material, fibre: 0.0, pressure: 0.0 }
    }

    /// m2 without stress; negative where it is turned clockwise.
    pub fn area(&self) -> f64 {
        0.5 * (self.second[0] * self.third[1] - self.second[1] * self.third[0])
    }

    /// The least height without stress, m.
    pub fn height(&self) -> f64 {
        let length = |p: [f64; 2]| libm::hypot(p[0], p[1]);
        let last = [self.third[0] - self.second[0], self.third[1] - self.second[1]];
        2.0 * self.area() / length(self.second).max(length(self.third)).max(length(last))
    }
}

#[derive(Debug, Clone, Copy)]
pub struct MembraneInput<'a> {
    pub grid: &'a Grid,
    /// m.
    pub nodes: &'a [[f64; 3]],
    /// m/s.
    pub velocities: &'a [[f64; 3]],
    /// Nodes, counter-clockwise seen from where the normal points.
    pub triangles: &'a [[u32; 3]],
    /// One for each triangle.
    pub elements: &'a [Element],
    pub materials: &'a [Material],
    /// kg, of each node beside its share of the fabric.
    pub added_masses: &'a [f64],
    /// mu on obstacles, of each node; none at all if there are none here.
    pub frictions: &'a [f64],
    /// Of each node.
    pub holds: &'a [Hold],
    /// m/s2.
    pub gravity: [f64; 3],
    /// Steps of the fabric in one of the gas.
    pub substeps: u32,
    /// Steps of the gas in an interval.
    pub steps_per_interval: u32,
    /// One unit of the gas's impulses, kg m/s.
    pub impulse_unit: f64,
    /// Of all nodes, 1/s. No fabric of a scene has it: shapes at rest are found with it.
    pub drag: f64,
}

/// Of the finest wave's crossing of the narrowest triangle: so much may a step of the fabric take.
const LONGEST: f64 = 0.4;

/// The longest step of the fabric, s: .4 h/c of the triangle where that is least, h the least height of its reference and c its wave speed; infinite without
/// triangles.
pub fn longest_step(elements: &[Element], materials: &[Material]) -> f64 {
    let speeds: Vec<f64> = materials.iter().map(Material::wave_speed).collect();
    let step =
        |element: &Element| LONGEST * element.height() / speeds.get(element.material).copied().unwrap_or(f64::NAN);
    elements.iter().map(step).fold(f64::INFINITY, f64::min)
}
