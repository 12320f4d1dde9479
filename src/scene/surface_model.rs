//! What walls and fabric do to the gas that hits them: each has a surface model, and named parts of it may have their own.

use super::face::Face;

/// A surface that keeps its temperature and takes heat from the gas, or gives it (docs/explanation/method.md, "Walls").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallHeat {
    /// K.
    pub temperature: f64,
    pub transfer: HeatTransfer,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeatTransfer {
    /// The share of the hits that leave with the temperature of the wall, 0 to 1.
    Accommodation(f64),
    /// W/(m2 K).
    Coefficient(f64),
}

/// How a surface sends back what hits it. The default is a mirror: smooth and adiabatic.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceModel {
    /// `None`: adiabatic.
    pub heat: Option<WallHeat>,
    /// Share of the other hits that leave in a random direction with the speed they had: a rough wall, without heat.
    pub friction: f64,
}

impl SurfaceModel {
    pub fn is_mirror(&self) -> bool {
        self.heat.is_none() && self.friction == 0.0
    }
}

/// A named part of a wall or a fabric whose surface differs from the rest of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfacePart {
    pub face: Face,
    /// With the keys of the whole where the scene gives none.
    pub surface: SurfaceModel,
}

/// What has one surface model: a part of a wall or a fabric, or what the parts leave of the whole.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SurfaceId {
    /// Past the indices of all walls that of a fabric.
    pub wall: usize,
    /// Index in the wall's `parts`, or the fabric's `surface_parts`.
    pub part: Option<usize>,
}
