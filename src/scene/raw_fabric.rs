//! Fabric as it is written in the scene file.

use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};

use super::raw_part::RawPart;
use super::raw_region::RawRegion;
use super::raw_values::{At, NumberOr, Numbers};

/// A surface with gas on both sides: of a `material` the gas moves it, with a `motion` a file does, else it rests.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawFabric {
    /// Unique among fabrics and walls.
    pub name: At<String>,
    /// Path of an STL or OBJ file, relative to the scene file: the surface at the start.
    pub file: At<String>,
    /// Length units of the scene per unit of the files; 1 unless given.
    pub scale: Option<At<f64>>,
    /// Path of the positions of its nodes over time: a `.nodes` file or a series of VTK files. With `material` its `fixed`
    /// nodes follow it.
    pub motion: Option<At<String>>,
    /// How it turns as a whole about an axis at rest, instead of `motion`.
    pub turn: Option<At<RawTurn>>,
    /// What an elastic membrane is of, which the gas moves.
    pub material: Option<At<RawMaterial>>,
    /// Of a membrane: path of a mesh file with the same triangles, free of stress; the surface at the start unless given.
    pub reference: Option<At<String>>,
    /// Of a membrane: lengths of the reference over those of its file at the start, above 0; 1 unless given.
    pub reference_scale: Option<At<f64>>,
    /// With `reference_scale`: the time in which it goes linearly to 1 (SI: s), above 0; unless given it stays.
    pub reference_time: Option<At<f64>>,
    /// Of a membrane: mass per area of the reference beside that of its material (SI: kg/m2), at least 0; 0 unless given.
    pub added_mass: Option<At<f64>>,
    /// Of a membrane: coefficient of its friction on walls, at least 0; 0 unless given.
    pub wall_friction: Option<At<f64>>,
    /// Of a membrane: the nodes that are held, by regions in which they are at the start, or `"edge"` for those of the
    /// open edge; none unless given.
    pub fixed: Option<At<RawFixed>>,
    /// Temperature that it keeps, and at which it exchanges heat with the gas on both sides, K; without it the fabric is
    /// adiabatic.
    pub temperature: Option<At<f64>>,
    /// Share of the hits that leave diffusely with the fabric's temperature, 0 to 1; with `temperature`, 1 unless it or
    /// `heat_transfer` is given.
    pub accommodation: Option<At<f64>>,
    /// Heat-transfer coefficient of each side (SI: W/(m2 K)), instead of `accommodation`.
    pub heat_transfer: Option<At<f64>>,
    /// Share of the hits that leave in a random direction with the speed they had, 0 to 1, of those that do not take the
    /// fabric's temperature; 0 unless given.
    pub friction: Option<At<f64>>,
    /// Of closed fabric: the uniform pressure outside, where no gas is then (SI: Pa).
    pub external_pressure: Option<At<f64>>,
    /// Parts of the mesh whose surface differs from the rest of the fabric.
    #[serde(default)]
    pub part: Vec<At<RawPart>>,
}

/// A turn about an axis, counter-clockwise seen from where the axis points to.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawTurn {
    /// Direction of the axis, of any length.
    pub axis: At<Numbers<3>>,
    /// A point on the axis.
    pub center: At<Numbers<3>>,
    /// Radians per unit of time: a number, or points [time, angular velocity], linear between, constant beyond the ends.
    pub angular_velocity: Option<At<NumberOr<Numbers<2>>>>,
    /// Points [time, angle from where it is drawn], in radians, linear between, constant beyond the ends; the first is [0, 0].
    pub angle: Option<At<Vec<At<Numbers<2>>>>>,
}

/// What a membrane is of. One `young` is an isotropic material; two, along the warp and along the weft, are a woven one.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawMaterial {
    /// Thickness (SI: m).
    pub thickness: At<f64>,
    /// Mass per volume (SI: kg/m3).
    pub density: At<f64>,
    /// Young's modulus (SI: Pa): a number, or two, along the warp and along the weft.
    pub young: At<NumberOr<f64>>,
    /// Poisson's ratio, 0 to 0.5; with two moduli that of a pull along the warp, and without it warp and weft are uncoupled.
    pub poisson: Option<At<f64>>,
    /// Shear modulus (SI: Pa), with two moduli.
    pub shear: Option<At<f64>>,
    /// Direction of the warp, of any length, with two moduli; in each triangle its part along the stress-free triangle
    /// counts.
    pub fibre: Option<At<Numbers<3>>>,
    /// Share of critical damping of the shortest waves where the fabric is taut, 0 to 1; 0.05 unless given.
    pub damping: Option<At<f64>>,
}

/// Which nodes are held.
#[derive(Debug)]
pub enum RawFixed {
    Edge,
    Within(Vec<At<RawRegion>>),
}

const FIXED: &str = "\"edge\", or a list of regions such as [{ box = { min = [0, 0, 0], max = [1, 1, 1] } }]";

impl<'de> Deserialize<'de> for RawFixed {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct EdgeOrRegions;
        impl<'de> Visitor<'de> for EdgeOrRegions {
            type Value = RawFixed;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(FIXED)
            }
            fn visit_str<E: Error>(self, word: &str) -> Result<RawFixed, E> {
                match word {
                    "edge" => Ok(RawFixed::Edge),
                    other => Err(E::invalid_value(serde::de::Unexpected::Str(other), &self)),
                }
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut elements: A) -> Result<RawFixed, A::Error> {
                let mut regions = Vec::new();
                while let Some(region) = elements.next_element()? {
                    regions.push(region);
                }
                Ok(RawFixed::Within(regions))
            }
        }
        deserializer.deserialize_any(EdgeOrRegions)
    }
}

impl JsonSchema for RawFixed {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Fixed".into()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let region = generator.subschema_for::<RawRegion>();
        json_schema!({ "anyOf": [{ "const": "edge" }, { "type": "array", "items": region, "minItems": 1 }] })
    }
}
