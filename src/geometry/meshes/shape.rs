//! Meshes that can be made: bags of two flat sheets, cylinders, spheres. Closed ones are turned outwards.

use super::bags::{cushion, teabag};
use super::error::MeshError;
use super::mesh::TriangleMesh;
use super::round_shapes::{Ends, cylinder, sphere};
use glam::DVec3;
use std::f64::consts::TAU;

/// m: lengths beyond these are slips.
const SHORTEST: f64 = 1e-6;
const LONGEST: f64 = 1e4;
/// Of sheets over their extent: less does not survive the rounding of a mesh file.
const LEAST_GAP: f64 = 1e-5;
const MOST_GAP: f64 = 0.5;
const MOST_ELEMENTS: u32 = 1000;
const MOST_RINGS: u32 = 500;
const MOST_AROUND: u32 = 4096;
const MOST_QUADS: u64 = 1 << 21;
const MOST_SUBDIVISIONS: u32 = 7;

/// Lengths in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeshShape {
    /// Two square sheets in planes across z, sewn along their perimeter. Without z it is the flat cut.
    Teabag { side: f64, elements: u32, gap: f64 },
    /// Two discs in planes across z, sewn along their rim. Without z it is the flat cut.
    Cushion { radius: f64, rings: u32, gap: f64 },
    /// About z, its nodes on the round surface. `along` elements of its height, else as long as they are wide.
    Cylinder { radius: f64, height: f64, around: u32, along: Option<u32>, closed: bool },
    /// An icosahedron whose triangles are quartered so often, its nodes on the sphere.
    Sphere { radius: f64, subdivisions: u32 },
}

impl MeshShape {
    pub fn name(&self) -> &'static str {
        match self {
            MeshShape::Teabag { .. } => "teabag",
            MeshShape::Cushion { .. } => "cushion",
            MeshShape::Cylinder { .. } => "cylinder",
            MeshShape::Sphere { .. } => "sphere",
        }
    }

    /// Its mesh around a centre (m).
    pub fn mesh(&self, center: [f64; 3]) -> Result<TriangleMesh, MeshError> {
        self.center(center)?;
        let mut mesh = match *self {
            MeshShape::Teabag { side, elements, gap } => {
                self.length("the side", side)?;
                self.count("elements a side", elements, 2..=MOST_ELEMENTS)?;
                self.gap(gap, side, "the side")?;
                teabag(side, elements, gap)
            }
            MeshShape::Cushion { radius, rings, gap } => {
                self.length("the radius", radius)?;
                self.count("rings", rings, 1..=MOST_RINGS)?;
                self.gap(gap, radius, "the radius")?;
                cushion(radius, rings, gap)
            }
            MeshShape::Cylinder { radius, height, around, along, closed } => {
                self.length("the radius", radius)?;
                self.length("the height", height)?;
                self.count("elements around", around, 3..=MOST_AROUND)?;
                let square = (height * f64::from(around) / (TAU * radius)).round().clamp(1.0, f64::from(u32::MAX));
                let along = along.unwrap_or(square as u32);
                self.count("elements along", along, 1..=(MOST_QUADS / u64::from(around)) as u32)?;
                cylinder(radius, height, [around, along], if closed { Ends::Closed } else { Ends::Open })
            }
            MeshShape::Sphere { radius, subdivisions } => {
                self.length("the radius", radius)?;
                self.count("subdivisions", subdivisions, 0..=MOST_SUBDIVISIONS)?;
                sphere(radius, subdivisions)
            }
        };
        mesh.nodes.iter_mut().for_each(|node| *node = (DVec3::from(*node) + DVec3::from(center)).to_array());
        Ok(mesh.numbered())
    }

    fn refused(&self, what: &'static str, found: String, expected: String) -> MeshError {
        MeshError::Number { shape: self.name(), what, found, expected }
    }

    fn length(&self, what: &'static str, value: f64) -> Result<(), MeshError> {
        if (SHORTEST..=LONGEST).contains(&value) {
            return Ok(());
        }
        Err(self.refused(what, format!("{value} m"), format!("{SHORTEST} to {LONGEST} m")))
    }

    fn gap(&self, gap: f64, extent: f64, of: &str) -> Result<(), MeshError> {
        if (LEAST_GAP * extent..=MOST_GAP * extent).contains(&gap) {
            return Ok(());
        }
        let expected =
            format!("{LEAST_GAP} to {MOST_GAP} times {of}, {} to {} m", LEAST_GAP * extent, MOST_GAP * extent);
        Err(self.refused("the gap", format!("{gap} m"), expected))
    }

    fn count(&self, what: &'static str, found: u32, allowed: std::ops::RangeInclusive<u32>) -> Result<(), MeshError> {
        if allowed.contains(&found) {
            return Ok(());
        }
        Err(self.refused(what, found.to_string(), format!("{} to {}", allowed.start(), allowed.end())))
    }

    fn center(&self, center: [f64; 3]) -> Result<(), MeshError> {
        match center.iter().find(|x| x.is_nan() || x.abs() > LONGEST) {
            None => Ok(()),
            Some(x) => Err(self.refused("the centre", format!("{x} m"), format!("-{LONGEST} to {LONGEST} m"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn absurd_numbers_are_refused_by_name() {
        let teabag = MeshShape::Teabag { side: 0.5, elements: 4, gap: 0.01 };
        let cylinder = |around, along| MeshShape::Cylinder { radius: 1.0, height: 1.0, around, along, closed: true };
        let cases = [
            (MeshShape::Teabag { side: -0.5, elements: 4, gap: 0.01 }, "teabag: the side: found -0.5 m, expected"),
            (MeshShape::Teabag { side: f64::NAN, elements: 4, gap: 0.01 }, "the side: found NaN m"),
            (MeshShape::Teabag { side: 0.5, elements: 1, gap: 0.01 }, "elements a side: found 1, expected 2 to 1000"),
            (MeshShape::Teabag { side: 0.5, elements: 4, gap: 0.0 }, "the gap: found 0 m, expected"),
            (MeshShape::Cushion { radius: 0.5, rings: 0, gap: 0.01 }, "rings: found 0, expected 1 to 500"),
            (MeshShape::Cushion { radius: 0.5, rings: 3, gap: 0.3 }, "0.5 times the radius, 0.000005"),
            (cylinder(2, None), "elements around: found 2"),
            (cylinder(4096, Some(513)), "elements along: found 513, expected 1 to 512"),
            (MeshShape::Sphere { radius: f64::INFINITY, subdivisions: 2 }, "the radius: found inf m"),
            (MeshShape::Sphere { radius: 1.0, subdivisions: 8 }, "subdivisions: found 8, expected 0 to 7"),
        ];
        for (shape, words) in cases {
            let error = shape.mesh([0.0; 3]).unwrap_err().to_string();
            assert!(error.contains(words), "{error}");
        }
        assert!(teabag.mesh([0.0, f64::NAN, 0.0]).unwrap_err().to_string().contains("the centre"));
        assert!(teabag.mesh([1.0, 2.0, 3.0]).is_ok());
    }

    /// Around another centre a shape has the same measures there.
    #[test]
    fn a_shape_can_be_anywhere() {
        let sphere = MeshShape::Sphere { radius: 0.2, subdivisions: 2 };
        let (here, there) = (sphere.mesh([0.0; 3]).unwrap(), sphere.mesh([1.0, -2.0, 3.0]).unwrap());
        assert!((here.volume() / there.volume() - 1.0).abs() < 1e-13);
        assert_eq!(there.middle().map(|x| (x * 1e9).round() / 1e9), [1.0, -2.0, 3.0]);
    }
}
