//! Parts of space.

/// Lengths in m.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    Box { min: [f64; 3], max: [f64; 3] },
    Sphere { center: [f64; 3], radius: f64 },
    Cylinder { base: [f64; 3], axis: [f64; 3], radius: f64, height: f64 },
}
