//! Parts of walls and fabrics as they are written in the scene file.

use schemars::JsonSchema;
use serde::Deserialize;

use super::raw_values::At;

/// A named part of a wall or a fabric with a surface of its own; keys that are not given are those of the whole.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawPart {
    /// The part: a face of a shape, a group of an OBJ file or a solid of an STL file; each at most once.
    pub face: At<String>,
    /// Temperature of the part, K.
    pub temperature: Option<At<f64>>,
    /// Share of the hits that leave diffusely with the part's temperature, 0 to 1.
    pub accommodation: Option<At<f64>>,
    /// Heat-transfer coefficient (SI: W/(m2 K)), instead of `accommodation`.
    pub heat_transfer: Option<At<f64>>,
    /// Share of the hits that leave in a random direction with the speed they had, 0 to 1, of those that do not take the
    /// part's temperature.
    pub friction: Option<At<f64>>,
}
