//! A row of the history: the state of everything that has columns, over a window.

#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// s, the middle of the window.
    pub time: f64,
    /// s.
    pub window: [f64; 2],
    /// Mean step in the window, s.
    pub step: f64,
    /// At the end of the window.
    pub particles: u64,
    pub chambers: Vec<ZoneState>,
    pub probes: Vec<ZoneState>,
    pub surfaces: Vec<SurfaceState>,
    /// Those that exchange heat.
    pub walls: Vec<WallState>,
    pub vents: Vec<VentState>,
    /// The walls that move.
    pub motions: Vec<MotionState>,
    /// The surfaces that deform.
    pub fabrics: Vec<FabricState>,
}

/// Mean state of a zone over a window.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ZoneState {
    /// Pa.
    pub pressure: f64,
    /// K; zero in an empty zone.
    pub temperature: f64,
    /// kg/m3.
    pub density: f64,
    /// m/s, of the mass.
    pub velocity: [f64; 3],
    /// Mean number of particles of each gas.
    pub particles: Vec<f64>,
    /// m3.
    pub volume: f64,
}

/// What a surface received in a window.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceState {
    /// Pa.
    pub pressure: f64,
    /// kg m/s since the start of the run.
    pub impulse: [f64; 3],
    /// In the window.
    pub hits: u64,
}

/// What a wall that exchanges heat took.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WallState {
    /// J since the start of the run; negative if the wall gave more.
    pub heat: f64,
    /// W/m2 in the window; 0 where its parts leave nothing of a wall.
    pub heat_flux: f64,
}

impl WallState {
    /// `heat` since the start and `taken` in a window of this duration, s, by this area, m2.
    pub fn new(heat: f64, taken: f64, area: f64, duration: f64) -> WallState {
        WallState { heat, heat_flux: if area > 0.0 { taken / (area * duration) } else { 0.0 } }
    }
}

/// What left through a vent.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VentState {
    /// kg/s in the window, and what the vent should have passed for the gas before it.
    pub mass_flow: f64,
    pub wanted_mass_flow: f64,
    /// The two over the isentropic flow through its area; zero where that is.
    pub discharge: f64,
    pub wanted_discharge: f64,
    /// kg and J since the start of the run.
    pub mass: f64,
    pub enthalpy: f64,
}

/// A wall that moves.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct MotionState {
    /// m and m/s, in the middle of the window.
    pub displacement: f64,
    pub velocity: f64,
    /// That it has done on the gas since the start of the run, J.
    pub work: f64,
    /// The same per time in the window, W.
    pub power: f64,
}

/// A surface that deforms.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FabricState {
    /// What it encloses, m3 (of an open one zero), and its area, m2, in the middle of the window.
    pub volume: f64,
    pub area: f64,
    /// Of the gas on its outer side (that its normals point to) and on its inner side, Pa.
    pub pressure: [f64; 2],
    /// That it has done on the gas since the start of the run, J.
    pub work: f64,
    /// The same per time in the window, W.
    pub power: f64,
    /// Of an elastic one, at the end of the window, J.
    pub energies: Option<FabricEnergies>,
}

/// Of an elastic surface, J.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FabricEnergies {
    pub kinetic: f64,
    pub strain: f64,
    /// Damped since the start of the run.
    pub damped: f64,
}

/// The scene's side of the averages.
#[derive(Debug, Clone, Default)]
pub struct Layout {
    /// m3, chambers then probes.
    pub volumes: Vec<f64>,
    pub chambers: usize,
    /// Patches of each surface, and its area, m2.
    pub surfaces: Vec<(Vec<usize>, f64)>,
    /// The placed surface models of each wall that exchanges heat, and its area, m2.
    pub walls: Vec<(Vec<usize>, f64)>,
    pub surface_models: usize,
    /// Of each vent, whether it leads to other gas of the run.
    pub vents: Vec<bool>,
    pub motions: usize,
    pub fabrics: usize,
    /// Whether they are elastic.
    pub elastic: bool,
    /// Of walls: behind them are two of each surface that deforms, the outer side and the inner.
    pub patches: usize,
}
