//! A validated scene: what the user asked for, in SI units, with every name resolved to an index.
//!
//! Invariants (held by `scene::load`): names are unique within their list, every index is in range,
//! vectors called `direction`, `axis` or `normal` have unit length, mixtures sum to one, curves are
//! ordered in time, lengths, pressures, temperatures and masses are positive and finite.

pub use super::course::{Course, Curve};
pub use super::face::Face;
use std::path::PathBuf;

use super::fabric::Fabric;
use super::lines::Lines;
use super::region::Region;
use super::surface_model::{SurfaceModel, SurfacePart};

/// The universal gas constant, J/(mol K) (CODATA 2018, exact).
pub const GAS_CONSTANT: f64 = 8.314462618;

#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    pub title: String,
    /// The unit system of the file; everything in this struct is SI whatever it says.
    pub units: UnitSystem,
    /// Simulated time at the end, s.
    pub end_time: f64,
    /// At most 56 bits are used.
    pub seed: u64,
    pub gases: Vec<Gas>,
    pub walls: Vec<Wall>,
    pub chambers: Vec<Chamber>,
    pub openings: Vec<Opening>,
    pub orifices: Vec<Orifice>,
    pub probes: Vec<Probe>,
    pub surfaces: Vec<Surface>,
    pub vents: Vec<Vent>,
    pub motions: Vec<Motion>,
    pub fabrics: Vec<Fabric>,
    /// Of free fall, m/s2; it acts on membranes.
    pub gravity: [f64; 3],
    pub model: ModelRequest,
    pub output: OutputRequest,
    /// Where its entries stand in the file.
    pub lines: Lines,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum UnitSystem {
    #[default]
    Si,
    /// kg, mm, ms, K: pressure in GPa, energy in J.
    KgMmMs,
    /// t, mm, s, K: pressure in MPa, energy in mJ.
    TMmS,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Gas {
    pub name: String,
    /// kg/mol.
    pub molar_mass: f64,
    pub heat: HeatCapacity,
}

/// Molar heat capacity of a gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeatCapacity {
    /// At constant volume, J/(mol K), at least 3/2 R.
    Constant(f64),
    /// At constant pressure, cp = a + b T + c T^2: a in J/(mol K), b in J/(mol K2), c in J/(mol K3).
    Curve([f64; 3]),
}

impl HeatCapacity {
    /// At constant volume at a temperature (K), J/(mol K): as asked for, whether or not a gas can have it.
    pub fn molar_cv(&self, temperature: f64) -> f64 {
        match self {
            HeatCapacity::Constant(cv) => *cv,
            HeatCapacity::Curve([a, b, c]) => a + temperature * (b + temperature * c) - GAS_CONSTANT,
        }
    }
}

/// Mole fractions by gas index; positive, summing to one.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixture(pub Vec<(usize, f64)>);

impl Mixture {
    /// kg/mol.
    pub fn molar_mass(&self, gases: &[Gas]) -> f64 {
        self.0.iter().map(|&(gas, fraction)| fraction * gases[gas].molar_mass).sum()
    }
}

#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    pub name: String,
    pub shape: Shape,
    /// On which side of the surface the gas is. A shape with a thickness is a solid with gas on both sides.
    pub gas: GasSide,
    /// Of all that is in none of its `parts`.
    pub surface: SurfaceModel,
    /// Each face at most once.
    pub parts: Vec<SurfacePart>,
}

impl Wall {
    /// As scenes write a part of it.
    pub fn face_name(&self, face: Face) -> String {
        match &self.shape {
            Shape::Mesh { parts, .. } => face.name(parts),
            _ => face.name(&[]),
        }
    }

    /// Whether the wall is the surface of a convex space of gas: no line between two points of the gas
    /// crosses it.
    pub fn is_convex_cavity(&self) -> bool {
        let convex = match &self.shape {
            Shape::Box { thickness, .. } => thickness.is_none(),
            Shape::Cylinder { .. } | Shape::Sphere { .. } => true,
            Shape::Plane { .. } | Shape::Mesh { .. } => false,
        };
        convex && self.gas == GasSide::Inside
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GasSide {
    Inside,
    Outside,
    /// Of a shape with a thickness (a hollow box, a plate).
    Both,
}

/// Lengths in m.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Axis-aligned. Without `thickness` one closed surface from `min` to `max`. With it, `min` to `max`
    /// is the cavity, and the solid shell of that thickness lies around it; `holes` pierce the shell.
    Box { min: [f64; 3], max: [f64; 3], thickness: Option<f64>, holes: Vec<Hole> },
    /// Closed cylinder from `base` along `axis`; its curved side is a prism of `segments` facets.
    Cylinder { base: [f64; 3], axis: [f64; 3], radius: f64, height: f64, segments: u32 },
    /// `subdivisions` of an icosahedron (each quarters the triangles).
    Sphere { center: [f64; 3], radius: f64, subdivisions: u32 },
    /// A flat rectangular plate: `size` along `u` and `normal x u`, `thickness` along `normal`, centred on `center`.
    Plane { center: [f64; 3], normal: [f64; 3], u: [f64; 3], size: [f64; 2], thickness: f64, holes: Vec<Hole> },
    /// STL or OBJ (by extension), absolute or relative to the working directory; metres = file units x `scale`. `parts` are
    /// the names of those of its parts that the scene names: `Face::Part` counts in it.
    Mesh { path: PathBuf, scale: f64, parts: Vec<String> },
}

#[derive(Debug, Clone, PartialEq)]
pub struct Hole {
    pub name: String,
    /// Face of a box ("-x" .. "+z"); for a plane always `PlaneFace`.
    pub face: Face,
    /// In the face's two axes. For a box the remaining two axes in x, y, z order, absolute coordinates;
    /// for a plane (u, normal x u) from its centre.
    pub center: [f64; 2],
    pub outline: Outline,
    /// A plan with a wish may model the hole as a vent and leave out what is outside of the box.
    pub flow_only: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Outline {
    Rectangle {
        size: [f64; 2],
    },
    /// A polygon of `segments` corners with the circle's area.
    Circle {
        diameter: f64,
        segments: u32,
    },
}

/// A part of the gas space with its own initial state; the history has its averages beside the
/// control-volume reference. Where regions overlap the earlier chamber has the gas.
#[derive(Debug, Clone, PartialEq)]
pub struct Chamber {
    pub name: String,
    /// `None`: all gas space that no earlier chamber has; only the last chamber may be so.
    pub region: Option<Region>,
    /// The closed fabric whose inside it is, in place of a region.
    pub inside: Option<usize>,
    /// Pa.
    pub pressure: f64,
    /// K.
    pub temperature: f64,
    pub mixture: Mixture,
}

/// A hole between two chambers, for the control-volume reference. Holes of boxes and planes are found
/// by `plan`; those of mesh files are declared.
#[derive(Debug, Clone, PartialEq)]
pub struct Opening {
    pub name: String,
    /// Chamber indices.
    pub between: [usize; 2],
    /// m2.
    pub area: f64,
    /// The length of its Knudsen number, m: the radius of a round hole, 2 area / perimeter of another (of a
    /// declared one, by default, the radius of a circle of this area).
    pub length: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Orifice {
    pub name: String,
    /// Centre of a flat disc, m.
    pub position: [f64; 3],
    /// Into the gas.
    pub direction: [f64; 3],
    /// m2.
    pub area: f64,
    /// kg/s against s; zero outside its range.
    pub mass_flow: Curve,
    /// Stagnation temperature, K against s; constant beyond its ends.
    pub temperature: Curve,
    pub mixture: Mixture,
    pub jet: Option<Jet>,
}

/// At what speed a jet drifts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum JetSpeed {
    Mach(f64),
    /// m/s.
    Velocity(f64),
}

/// A drifting inflow; without it the orifice emits a Maxwell speed distribution (docs/explanation/method.md, "Inflow").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    pub speed: JetSpeed,
    /// Half angle of the cone over which the drift direction is spread, rad.
    pub cone_angle: f64,
}

/// A region in which pressure, temperature, density, velocity and particle counts are averaged.
#[derive(Debug, Clone, PartialEq)]
pub struct Probe {
    pub name: String,
    pub region: Region,
}

/// Walls on which pressure and impulse are measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    pub name: String,
    /// Wall index.
    pub wall: usize,
    /// A part of the wall, or all of it.
    pub face: Option<Face>,
}

/// Where a wall or a closed fabric lets gas out: a vent or pores, modelled (method.md, "Vents and leaks"). What leaves through a wall
/// is gone, as is what leaves a fabric without gas around it.
#[derive(Debug, Clone, PartialEq)]
pub struct Vent {
    pub name: String,
    /// Wall index; past those of all walls the index of a fabric ([`Scene::fabric_at`]).
    pub wall: usize,
    /// A part of it, or all of it.
    pub face: Option<Face>,
    /// Index of the chamber that it empties; `None`: the only one at its place.
    pub chamber: Option<usize>,
    /// Its place, if not all of the wall or face; of a fabric the triangles whose middles are in it at the start.
    pub disc: Option<Disc>,
    /// m2; `None`: that of its place.
    pub area: Option<f64>,
    pub flow: VentFlow,
    /// Pa above the external pressure, at which it opens; from then on it is open.
    pub opening_pressure: f64,
    /// Pa. Of a fabric with gas around it, that gas at the start: what drives the flow then is the gas that is there.
    pub external_pressure: f64,
}

/// What of a wall lies within half a diameter of a point, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    pub center: [f64; 3],
    pub diameter: f64,
}

/// How much flows; curves are constant beyond their ends.
#[derive(Debug, Clone, PartialEq)]
pub enum VentFlow {
    /// Coefficient C23 against time, s.
    Discharge(Curve),
    /// C23 against the pressure above the external one, Pa.
    DischargeByPressure(Curve),
    /// Velocity, m/s, of the gas as it is inside, against the pressure above the external one.
    LeakVelocity(Curve),
}

/// A wall that moves along a straight line, whatever the gas does.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// Wall index; each wall has at most one motion.
    pub wall: usize,
    pub direction: [f64; 3],
    pub course: Course,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Pairs collide at their closest approach; ideal-gas pressure at any occupancy.
    ClosestApproach,
    /// Rigid spheres; their pressure is not the ideal gas's. Only for comparison with legacy results.
    HardSphere,
    /// Pairs drawn at random within a cell collide; ideal-gas pressure, long steps, many particles.
    Cell,
    /// The particles of a cell collide all at once, by half a turn about an axis of their stress: a third of the viscosity of `closest-approach`.
    HalfTurn,
    /// Free flight without collisions.
    None,
    /// No particles: each chamber is uniform, gas flows between them through their openings.
    ControlVolume,
}

impl Method {
    /// As scenes write it.
    pub fn name(self) -> &'static str {
        match self {
            Method::ClosestApproach => "closest-approach",
            Method::HardSphere => "hard-sphere",
            Method::Cell => "cell",
            Method::HalfTurn => "half-turn",
            Method::None => "none",
            Method::ControlVolume => "control-volume",
        }
    }

    /// Whether pairs are found among neighbours and settled in rounds.
    pub fn has_rounds(self) -> bool {
        match self {
            Method::ClosestApproach | Method::HardSphere => true,
            Method::Cell | Method::HalfTurn | Method::None | Method::ControlVolume => false,
        }
    }

    /// The keys of `[model]` that a run of it would not heed, and why.
    pub fn has_no(self) -> (&'static [&'static str], &'static str) {
        let of_collisions = &["diameter", "occupancy", "diameter_cap", "rounds", "collision_number"];
        let of_particles = &["diameter", "occupancy", "diameter_cap", "time_step", "rounds", "collision_number"];
        match self {
            Method::ClosestApproach => (&[], ""),
            Method::HardSphere => (&["diameter_cap"], "whose pressure depends on the diameter"),
            Method::Cell => (&["diameter_cap", "rounds"], "whose particles collide within their cells"),
            Method::HalfTurn => {
                (of_collisions, "whose particles have no diameter: those of a cell collide all at once")
            }
            Method::None => (of_collisions, "whose particles do not collide"),
            Method::ControlVolume => (of_particles, "which has no particles"),
        }
    }
}

/// What the plan decides unless the scene says it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelRequest {
    pub method: Option<Method>,
    /// Particles at the end of the run, initial and injected together.
    pub particles: Option<u64>,
    /// Collision diameter, m. At most one of `diameter` and `occupancy` is set.
    pub diameter: Option<f64>,
    /// Occupancy n pi sigma^3 / 6 at the mean number density at the end of the run.
    pub occupancy: Option<f64>,
    pub diameter_cap: Option<DiameterCap>,
    /// Largest time step, s.
    pub time_step: Option<f64>,
    pub rounds: Option<u32>,
    /// Rotational collision number Z (default 5).
    pub collision_number: Option<f64>,
    pub switch: Option<Switch>,
    pub wish: Wish,
}

impl ModelRequest {
    /// Without what its method has no use for.
    pub fn heeded(self) -> ModelRequest {
        let Some((keys, _)) = self.method.map(Method::has_no) else { return self };
        let has = |key: &str| !keys.contains(&key);
        ModelRequest {
            diameter: self.diameter.filter(|_| has("diameter")),
            occupancy: self.occupancy.filter(|_| has("occupancy")),
            diameter_cap: self.diameter_cap.filter(|&cap| cap == DiameterCap::Off || has("diameter_cap")),
            time_step: self.time_step.filter(|_| has("time_step")),
            rounds: self.rounds.filter(|_| has("rounds")),
            collision_number: self.collision_number.filter(|_| has("collision_number")),
            ..self
        }
    }
}

/// What holds the collision diameter down where gas is dense.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DiameterCap {
    Off,
    /// Mean spacings n^(-1/3) of the local gas.
    Spacings(f64),
}

/// When a run of particles goes on as a control volume.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Switch {
    /// s.
    At(f64),
    /// Once the pressure of all probes and surfaces has been that of their chamber, within the noise, for so long, s.
    WhenUniform { lasting: f64 },
}

/// What a run shall be worth, or may cost: the plan then chooses what else is not said.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Wish {
    /// Largest predicted error of a pressure of the history, relative.
    pub accuracy: Option<f64>,
    /// Device time, s.
    pub time_budget: Option<f64>,
    /// Most particles at the end of the run.
    pub particle_budget: Option<u64>,
    /// Particle-steps per second of the device, at the occupancy and step of the plan's own choice.
    pub device_rate: Option<f64>,
}

impl Wish {
    /// Whether anything is wished; how fast the device is, is none.
    pub fn is_any(&self) -> bool {
        self.accuracy.is_some() || self.time_budget.is_some() || self.particle_budget.is_some()
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutputRequest {
    /// Rows of history.csv (at most; a row holds whole step intervals). Default 200.
    pub rows: u32,
    /// Snapshots after the initial one. Default 10; 0 writes none.
    pub snapshots: u32,
    /// Whether a run writes its page; `None`: if somebody sees it.
    pub report: Option<bool>,
}
