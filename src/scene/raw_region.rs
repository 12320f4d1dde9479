//! Parts of space as they are written in the scene file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::raw_values::{At, Numbers};

/// A part of space.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RawRegion {
    Box(RawBox),
    Sphere(RawSphere),
    Cylinder(RawCylinder),
}

/// An axis-aligned box.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawBox {
    /// Corner of least coordinates.
    pub min: At<Numbers<3>>,
    /// Corner of greatest coordinates.
    pub max: At<Numbers<3>>,
}

/// A ball.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawSphere {
    /// Centre.
    pub center: At<Numbers<3>>,
    /// Radius.
    pub radius: At<f64>,
}

/// A cylinder.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawCylinder {
    /// Centre of the lower end.
    pub base: At<Numbers<3>>,
    /// Direction from the lower to the upper end, of any length.
    pub axis: At<Numbers<3>>,
    /// Radius.
    pub radius: At<f64>,
    /// Distance between the ends.
    pub height: At<f64>,
}
