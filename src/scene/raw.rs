//! The scene file as it is written: names, units and defaults not yet resolved.
//!
//! Serde reads these types and schemars describes them, so that the file format, its errors and its
//! JSON schema cannot drift apart. Unknown keys are refused everywhere. Doc comments here are the
//! schema's descriptions: they are written for the author of a scene. Units are those of the file
//! (`units`); docs/reference/scenes.md has the table.

use schemars::JsonSchema;
use serde::Deserialize;

use super::raw_fabric::RawFabric;
use super::raw_part::RawPart;
use super::raw_region::RawRegion;
use super::raw_values::{At, NumberOr, Numbers, RawMixture};
use super::types::Method;

/// A scene of the corpuscle solver.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "corpuscle scene")]
pub struct RawScene {
    /// What the scene shows; the name of the file unless given.
    pub title: Option<At<String>>,
    /// Unit system of every number in the file; SI unless given.
    pub units: Option<RawUnits>,
    /// Simulated time at the end of the run; the start is 0.
    pub end_time: At<f64>,
    /// Seed of all random numbers, 0 to 2^56 - 1; 1 unless given.
    pub seed: Option<At<i64>>,
    /// Acceleration of free fall of fabric that has a material (SI: m/s2); none unless given.
    pub gravity: Option<At<Numbers<3>>>,
    /// The gases that occur in the scene, 1 to 16.
    #[serde(default)]
    pub gas: Vec<At<RawGas>>,
    /// Rigid walls; at least one.
    #[serde(default)]
    pub wall: Vec<At<RawWall>>,
    /// The initial gas, by region; at least one.
    #[serde(default)]
    pub chamber: Vec<At<RawChamber>>,
    /// Openings between chambers that the walls do not tell of themselves (those of mesh files).
    #[serde(default)]
    pub opening: Vec<At<RawOpening>>,
    /// Where gas flows in.
    #[serde(default)]
    pub orifice: Vec<At<RawOrifice>>,
    /// Regions in which the state of the gas is averaged.
    #[serde(default)]
    pub probe: Vec<At<RawProbe>>,
    /// Walls or faces on which pressure and impulse are measured.
    #[serde(default)]
    pub surface: Vec<At<RawSurface>>,
    /// Where walls let gas out.
    #[serde(default)]
    pub vent: Vec<At<RawVent>>,
    /// Walls that move.
    #[serde(default)]
    pub motion: Vec<At<RawMotion>>,
    /// Surfaces with gas on both sides that the gas moves, or that deform as a file says.
    #[serde(default)]
    pub fabric: Vec<At<RawFabric>>,
    /// What the plan otherwise decides.
    #[serde(default)]
    pub model: RawModel,
    /// How much is written.
    #[serde(default)]
    pub output: RawOutput,
}

/// Unit system of a scene file.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub enum RawUnits {
    /// kg, m, s, K, Pa, J.
    #[serde(rename = "SI")]
    Si,
    /// kg, mm, ms, K, GPa, J.
    #[serde(rename = "kg-mm-ms")]
    KgMmMs,
    /// t, mm, s, K, MPa, mJ.
    #[serde(rename = "t-mm-s")]
    TMmS,
}

/// A gas; exactly one of `cp`, `cv`, `gamma`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawGas {
    /// Unique among the gases.
    pub name: At<String>,
    /// Mass per mole (SI: kg/mol).
    pub molar_mass: At<f64>,
    /// Molar heat capacity at constant pressure (SI: J/(mol K)), at least 5/2 R: a number, or the coefficients
    /// [a, b, c] of a + b T + c T^2, T in K.
    pub cp: Option<At<NumberOr<f64>>>,
    /// Molar heat capacity at constant volume (SI: J/(mol K)), at least 3/2 R.
    pub cv: Option<At<f64>>,
    /// Ratio of the heat capacities, above 1 and at most 5/3.
    pub gamma: Option<At<f64>>,
}

/// A rigid wall; which keys apply depends on `shape`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawWall {
    /// Unique among the walls.
    pub name: At<String>,
    /// The kind of surface.
    pub shape: At<RawShape>,
    /// On which side the gas is; not given for what has gas on both sides (a box with `thickness`, a plane).
    pub gas: Option<At<RawSide>>,
    /// box: corner of least coordinates (of the cavity, with `thickness`).
    pub min: Option<At<Numbers<3>>>,
    /// box: corner of greatest coordinates.
    pub max: Option<At<Numbers<3>>>,
    /// box: thickness of the solid shell around the cavity; plane: of the plate, along `normal`.
    pub thickness: Option<At<f64>>,
    /// cylinder: centre of the lower end.
    pub base: Option<At<Numbers<3>>>,
    /// cylinder: direction from the lower to the upper end, of any length.
    pub axis: Option<At<Numbers<3>>>,
    /// cylinder, sphere: radius.
    pub radius: Option<At<f64>>,
    /// cylinder: distance between the ends.
    pub height: Option<At<f64>>,
    /// cylinder: facets of the curved side, 3 to 4096; 48 unless given.
    pub segments: Option<At<i64>>,
    /// sphere, plane: centre.
    pub center: Option<At<Numbers<3>>>,
    /// sphere: subdivisions of an icosahedron, 0 to 7; 3 unless given.
    pub subdivisions: Option<At<i64>>,
    /// plane: direction across the plate, of any length.
    pub normal: Option<At<Numbers<3>>>,
    /// plane: direction of the first side, perpendicular to `normal`; the second is `normal` x `u`.
    pub u: Option<At<Numbers<3>>>,
    /// plane: lengths of the two sides.
    pub size: Option<At<Numbers<2>>>,
    /// mesh: path of an STL or OBJ file, relative to the scene file.
    pub file: Option<At<String>>,
    /// mesh: length units of the scene per unit of the mesh file; 1 unless given.
    pub scale: Option<At<f64>>,
    /// Temperature of a wall that exchanges heat with the gas, K; without it the wall is smooth and adiabatic.
    pub temperature: Option<At<f64>>,
    /// Share of the hits that leave diffusely with the wall's temperature, 0 to 1; with `temperature`, 1 unless it or
    /// `heat_transfer` is given.
    pub accommodation: Option<At<f64>>,
    /// Heat-transfer coefficient (SI: W/(m2 K)), instead of `accommodation`.
    pub heat_transfer: Option<At<f64>>,
    /// Share of the hits that leave in a random direction with the speed they had, 0 to 1, of those that do not take the
    /// wall's temperature; 0 unless given.
    pub friction: Option<At<f64>>,
    /// box with `thickness`, plane: holes through the wall.
    #[serde(default)]
    pub hole: Vec<At<RawHole>>,
    /// Parts whose surface differs from the rest of the wall.
    #[serde(default)]
    pub part: Vec<At<RawPart>>,
}

/// The kind of a wall's surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RawShape {
    Box,
    Cylinder,
    Sphere,
    Plane,
    Mesh,
}

/// The side of a surface on which the gas is.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RawSide {
    Inside,
    Outside,
}

/// A face of a box.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub enum RawFace {
    #[serde(rename = "-x")]
    XLow,
    #[serde(rename = "+x")]
    XHigh,
    #[serde(rename = "-y")]
    YLow,
    #[serde(rename = "+y")]
    YHigh,
    #[serde(rename = "-z")]
    ZLow,
    #[serde(rename = "+z")]
    ZHigh,
}

/// A hole through a wall; exactly one of `size`, `diameter`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawHole {
    /// Unique among all holes and openings.
    pub name: At<String>,
    /// The face of the box that it pierces; not given for a plane.
    pub face: Option<At<RawFace>>,
    /// Centre: for a box the coordinates of the face's two axes, in the order x, y, z; for a plane
    /// along (`u`, `normal` x `u`) from its centre.
    pub center: At<Numbers<2>>,
    /// Sides of a rectangle, along the same axes as `center`.
    pub size: Option<At<Numbers<2>>>,
    /// Diameter of a circle.
    pub diameter: Option<At<f64>>,
    /// Corners of the polygon of equal area that stands for the circle, 3 to 1024; 32 unless given.
    pub segments: Option<At<i64>>,
    /// Of a box: of what is behind the hole only the flow into it matters, so a plan with an accuracy or a budget may model
    /// the hole as a vent and leave out what is behind it; false unless given.
    pub flow_only: Option<At<bool>>,
}

/// The initial gas of a region.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawChamber {
    /// Unique among the chambers.
    pub name: At<String>,
    /// Where; the last chamber may leave it out and then has all gas space that is left. Where regions
    /// overlap the earlier chamber has the gas.
    pub region: Option<At<RawRegion>>,
    /// The name of a closed [[fabric]] whose inside this chamber is, in place of a region.
    pub inside: Option<At<String>>,
    /// Initial pressure (SI: Pa).
    pub pressure: At<f64>,
    /// Initial temperature, K.
    pub temperature: At<f64>,
    /// A gas by name, or mole fractions such as { air = 0.8, helium = 0.2 }.
    pub gas: At<RawMixture>,
}

/// An opening between two chambers, for the control-volume reference.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawOpening {
    /// Unique among all holes and openings.
    pub name: At<String>,
    /// The names of the two chambers.
    pub between: At<Vec<At<String>>>,
    /// Area (SI: m2).
    pub area: At<f64>,
    /// Length of its Knudsen number; the square root of the area unless given.
    pub length: Option<At<f64>>,
}

/// A flat disc from which gas flows in.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawOrifice {
    /// Unique among the orifices.
    pub name: At<String>,
    /// Centre of the disc.
    pub position: At<Numbers<3>>,
    /// Into the gas, of any length.
    pub direction: At<Numbers<3>>,
    /// Area of the disc (SI: m2).
    pub area: At<f64>,
    /// Points [time, mass per time] (SI: s, kg/s), linear between, zero outside; at least two.
    pub mass_flow: At<Vec<At<Numbers<2>>>>,
    /// Stagnation temperature in K: a number, or points [time, temperature], constant beyond the ends.
    pub temperature: At<NumberOr<Numbers<2>>>,
    /// A gas by name, or mole fractions such as { air = 0.8, helium = 0.2 }.
    pub gas: At<RawMixture>,
    /// A drifting inflow; without it gas enters with a Maxwell speed distribution.
    pub jet: Option<At<RawJet>>,
}

/// A drifting inflow; exactly one of `mach`, `velocity`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawJet {
    /// Mach number, above 0 and at most 20.
    pub mach: Option<At<f64>>,
    /// Above 0, and at no time beyond Mach 20.
    pub velocity: Option<At<f64>>,
    /// Half angle of the cone over which the direction is spread, degrees, 0 to below 90; 0 unless given.
    pub cone_angle: Option<At<f64>>,
}

/// A region in which the state of the gas is averaged.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawProbe {
    /// Unique among the probes.
    pub name: At<String>,
    /// Where.
    pub region: At<RawRegion>,
}

/// A wall, or a part of one, on which pressure and impulse are measured.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawSurface {
    /// Unique among the surfaces.
    pub name: At<String>,
    /// The name of a wall.
    pub wall: At<String>,
    /// A named part of it: `"-x"` to `"+z"` or `"outside"` of a box, `"base"`, `"top"` or `"side"` of a cylinder, `"front"`,
    /// `"back"` or `"rim"` of a plane, a solid, group or object of a mesh file; all of the wall unless given.
    pub face: Option<At<String>>,
}

/// A part of a wall that lets gas out of the scene, or of a closed fabric; exactly one of `wall` and `fabric`, and exactly one of
/// `discharge`, `discharge_by_pressure`, `leak_velocity`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawVent {
    /// Unique among the vents.
    pub name: At<String>,
    /// The name of a wall.
    pub wall: Option<At<String>>,
    /// The name of a closed fabric: gas flows from its inside to the other side, or out of the scene with the fabric's
    /// `external_pressure`.
    pub fabric: Option<At<String>>,
    /// A named part of it: `"-x"` to `"+z"` or `"outside"` of a box, `"base"`, `"top"` or `"side"` of a cylinder, `"front"`,
    /// `"back"` or `"rim"` of a plane, a solid, group or object of a mesh file; all of the wall or fabric unless given.
    pub face: Option<At<String>>,
    /// The chamber that it empties; needed where its place borders on several.
    pub chamber: Option<At<String>>,
    /// Centre of a disc on the wall or face, its place; of fabric the triangles whose middles are in it at the start; with
    /// `diameter`.
    pub position: Option<At<Numbers<3>>>,
    /// Diameter of that disc.
    pub diameter: Option<At<f64>>,
    /// Area that the gas flows through (SI: m2), spread over its place; the area of the place unless given.
    pub area: Option<At<f64>>,
    /// Vent coefficient C23 of the Wang-Nefske formula: a number, or points [time, C23], constant beyond the ends.
    pub discharge: Option<At<NumberOr<Numbers<2>>>>,
    /// C23 as points [pressure above the external one, C23], constant beyond the ends.
    pub discharge_by_pressure: Option<At<Vec<At<Numbers<2>>>>>,
    /// Leakage of a fabric: points [pressure above the external one, velocity of the gas] (SI: Pa, m/s).
    pub leak_velocity: Option<At<Vec<At<Numbers<2>>>>>,
    /// Pressure above the external one (gauge) at which it opens, for good (SI: Pa); 0 unless given.
    pub opening_pressure: Option<At<f64>>,
    /// The same as an absolute pressure, not below the external one (SI: Pa); instead of `opening_pressure`.
    pub opening_pressure_absolute: Option<At<f64>>,
    /// External pressure of a vent on a wall (SI: Pa); 101325 Pa unless given.
    pub external_pressure: Option<At<f64>>,
}

/// The motion of a wall along a straight line, as it is prescribed; exactly one of `velocity`, `displacement`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawMotion {
    /// The name of a wall, a body with the gas outside of it (or on both sides).
    pub wall: At<String>,
    /// Along which it moves, of any length.
    pub direction: At<Numbers<3>>,
    /// Velocity along `direction` (SI: m/s): a number, or points [time, velocity], linear between, constant beyond the ends.
    pub velocity: Option<At<NumberOr<Numbers<2>>>>,
    /// Points [time, distance from where it is drawn], linear between, constant beyond the ends; the first is [0, 0].
    pub displacement: Option<At<Vec<At<Numbers<2>>>>>,
}

/// What the plan otherwise decides.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawModel {
    /// How particles meet.
    pub method: Option<Method>,
    /// Particles at the end of the run, initial and injected together, 1 to 134217727.
    pub particles: Option<At<i64>>,
    /// Collision diameter; not together with `occupancy`.
    pub diameter: Option<At<f64>>,
    /// Fraction of space that spheres of the collision diameter fill at the end of the run, above 0 and at most 0.5.
    pub occupancy: Option<At<f64>>,
    /// Where gas is dense, the collision diameter is at most so many local mean spacings; or `"off"`.
    pub diameter_cap: Option<At<RawCap>>,
    /// Largest time step.
    pub time_step: Option<At<f64>>,
    /// Pairing rounds per step, 1 to 8.
    pub rounds: Option<At<i64>>,
    /// Rotational collision number Z; 5 unless given.
    pub collision_number: Option<At<f64>>,
    /// Go on as a control volume from a time on, or `"when-uniform"`.
    pub switch: Option<At<RawSwitch>>,
    /// How long the pressures must have been uniform, with `switch = "when-uniform"`.
    pub uniform_for: Option<At<f64>>,
    /// Largest predicted error of a pressure in the history, relative, 0.0001 to 0.5: the plan chooses what reaches it
    /// at the least cost.
    pub accuracy: Option<At<f64>>,
    /// Device time that the run may take, in seconds whatever the units.
    pub time_budget: Option<At<f64>>,
    /// The most particles that the plan may choose, 1 to 134217727.
    pub particle_budget: Option<At<i64>>,
    /// Million particle-steps per second that the device does (`cargo bench --bench step` prints it), for the predicted
    /// time; 3 unless given, that of lavapipe on two cores.
    pub device_rate: Option<At<f64>>,
}

/// In local mean spacings, or none.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number of mean spacings, or \"off\"")]
pub enum RawCap {
    Spacings(f64),
    Off(Off),
}

#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub enum Off {
    #[serde(rename = "off")]
    Off,
}

/// A time, or what is waited for.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a time, or \"when-uniform\"")]
pub enum RawSwitch {
    At(f64),
    When(When),
}

/// What is waited for.
#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
pub enum When {
    #[serde(rename = "when-uniform")]
    Uniform,
}

/// How much is written.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RawOutput {
    /// Rows of history.csv at most, 1 to 1000000; 200 unless given.
    pub rows: Option<At<i64>>,
    /// Snapshots after the initial one, 0 to 100000; 10 unless given, 0 writes none.
    pub snapshots: Option<At<i64>>,
    /// Whether a run writes report.html at its end; unless given, one that is started in a terminal does.
    pub report: Option<At<bool>>,
}
