//! Values of the shaders' override constants: what specialises the kernels to a scene. Each is written
//! once, here, from the plan.

use crate::geometry::{CELL_GENERATOR, CELL_POINTS, CLEARANCE_UNIT};
use crate::gpu::Device;
use crate::plan::{Plan, TILE_EDGE};
use crate::scene::{GAS_CONSTANT, Method};

use super::fabric::Fabric;
use super::nearness;
use super::registry::{SURFACE_MODEL_WORDS, SURFACE_WORDS, VENT_WORDS};
use super::scales::Scales;
use super::sizes::{CHUNK, FEW_STRETCHES, MOST_MEMBERS, SURFACE_COPIES, TILE_BITS, WORKGROUP};
use super::walls::Walls;

const MOST_TALLY_LOOPS: u32 = 32;
/// So many workgroups give a GPU enough to do.
const FILLING_GROUPS: u64 = 1024;
/// Random numbers of collisions (the table of purposes is `gas::Purpose`).
const PURPOSE_COLLISION: u64 = crate::gas::Purpose::Collision as u64;
const PURPOSE_CELL: u64 = crate::gas::Purpose::CellCollision as u64;
/// And those of hits on walls.
const PURPOSE_WALL: u64 = crate::gas::Purpose::Wall as u64;

/// Bounces of a flight in a step before it is cut short: there are many in narrow gaps, between walls that close in on each
/// other, and in steps that are too long.
const MOST_BOUNCES: f64 = 1024.0;

/// What the scene has, and so what is compiled in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Features {
    pub collisions: bool,
    /// Pairs are chosen from neighbour lists, in rounds; without it they collide within their cells.
    pub rounds: bool,
    /// The particles of a cell collide all at once, without diameters.
    pub half_turn: bool,
    /// The collision diameter follows the local density where gas is dense.
    pub capped: bool,
    /// Walls part the gas of some cell.
    pub divided: bool,
    pub spin: bool,
    /// A heat capacity depends on the temperature.
    pub curves: bool,
    pub orifices: bool,
    pub surfaces: bool,
    /// Walls that exchange heat with the gas, or let it out.
    pub surface_models: bool,
    pub vents: bool,
    /// Walls that move.
    pub moving: bool,
    /// Surfaces that deform.
    pub fabric: bool,
    /// And are elastic.
    pub membrane: bool,
    /// And what hits give them is smoothed.
    pub smoothed: bool,
    /// Other devices own the particles of other cells.
    pub halo: bool,
}

/// The most particle-steps of a run on a software device with [`RUNTIME_CONSTANTS`]: up to here they save more in compilation than they cost in steps
/// (`docs/reference/performance.md`).
pub const MOST_WITH_RUNTIME_CONSTANTS: f64 = 1e8;

/// Constants that are numbers of a scene, which kernels can read from a uniform. (What branches ask of constants alone is compiled in.)
const RUNTIME_CONSTANTS: [&str; 30] = [
    "BLOCKS",
    "BLOCKS_X",
    "BLOCKS_Y",
    "BLOCK_BITS",
    "BLOCK_ENERGY_SCALE",
    "CELLS_X",
    "CELLS_Y",
    "CELLS_Z",
    "CELL_BITS",
    "CELL_SEED_HIGH",
    "SURFACE_MODELS_AT",
    "COPY_WORDS",
    "CROSS_SECTION",
    "DIAMETER",
    "DIAMETER2_PACKED",
    "ENERGY_SCALE",
    "FASTEST2",
    "IMPULSE_SCALE",
    "INVERSE_THERMAL",
    "QUANTA",
    "QUANTUM",
    "RECOIL_AT",
    "SEED_HIGH",
    "SEED_LOW",
    "TIME_STEP",
    "TOLERANCE",
    "VELOCITY_SCALE",
    "VENTS_AT",
    "WALL_SEED_HIGH",
    "WORKS_AT",
];

/// The runtime constants of the kernels of a plan.
pub fn runtime_constants_of(device: &Device, plan: &Plan) -> &'static [&'static str] {
    let is_short = plan.particles as f64 * plan.estimated_steps <= MOST_WITH_RUNTIME_CONSTANTS;
    if is_short { runtime_constants(device) } else { &[] }
}

/// Those of the kernels of short runs. A GPU's have all compiled in: it may round otherwise where it knows a number.
pub fn runtime_constants(device: &Device) -> &'static [&'static str] {
    if device.adapter().is_cpu() { &RUNTIME_CONSTANTS } else { &[] }
}

/// What walls have tallies for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Patches {
    pub surfaces: usize,
    pub surface_models: usize,
    pub vents: usize,
    /// As many as vents if some lead to other gas: what passes those is tallied apart, behind what leaves.
    pub passages: usize,
    /// Walls that move.
    pub motions: usize,
    /// Surfaces that deform.
    pub fabrics: usize,
    /// Whether they are elastic.
    pub membrane: bool,
    /// Whether what hits give them is smoothed.
    pub smoothed: bool,
}

impl Patches {
    /// Words of the tallies of surfaces, of these and the surface models, and of these and the vents.
    pub(super) fn ends(&self) -> [usize; 3] {
        let surfaces = self.surfaces.max(1) * SURFACE_WORDS as usize;
        let surface_models = surfaces + self.surface_models * SURFACE_MODEL_WORDS as usize;
        [surfaces, surface_models, surface_models + (self.vents + self.passages) * VENT_WORDS as usize]
    }

    /// Where the tally of what elastic fabric takes in recoiling is: the last.
    pub(super) fn recoil_at(&self) -> usize {
        self.ends()[2] + (self.motions + self.fabrics) * SURFACE_MODEL_WORDS as usize
    }

    pub(super) fn words(&self) -> usize {
        self.recoil_at() + usize::from(self.membrane) * SURFACE_MODEL_WORDS as usize
    }

    /// Words of a copy of these tallies: no two copies share a line of a cache.
    pub(super) fn copy_words(&self) -> usize {
        self.words().next_multiple_of(32)
    }
}

impl Features {
    /// Collisions are within cells.
    pub fn has_cells(self) -> bool {
        self.collisions && !self.rounds
    }

    pub fn of(plan: &Plan, patches: Patches, divided: bool, among_others: bool) -> Features {
        Features {
            collisions: plan.method != Method::None,
            rounds: plan.method.has_rounds(),
            half_turn: plan.method == Method::HalfTurn,
            capped: plan.diameter_cap.is_some(),
            divided,
            spin: plan.gases.iter().any(|gas| gas.species.has_spin() && gas.particles > 0),
            curves: plan.gases.iter().any(|gas| !gas.species.is_constant() && gas.particles > 0),
            orifices: plan.injected_particles > 0,
            surfaces: patches.surfaces > 0,
            surface_models: patches.surface_models > 0,
            vents: patches.vents > 0,
            moving: patches.motions > 0,
            fabric: patches.fabrics > 0,
            membrane: patches.membrane,
            smoothed: patches.smoothed,
            halo: among_others && plan.method != Method::None,
        }
    }

    /// With what any scene of this method may have, as if nothing were left out.
    #[must_use]
    pub fn with_all(self) -> Features {
        Features { spin: true, orifices: true, surfaces: true, surface_models: true, vents: true, moving: true, ..self }
    }
}

/// Particles that a thread of the tally adds, one after the other. Few where there are few, on a GPU: it would wait for each, with most of it idle.
pub fn tally_loops(device: &Device, plan: &Plan) -> u32 {
    if device.adapter().is_cpu() {
        return MOST_TALLY_LOOPS;
    }
    let groups = plan.particles / u64::from(WORKGROUP);
    (groups / FILLING_GROUPS).clamp(1, MOST_TALLY_LOOPS.into()) as u32
}

/// What the kernels of a scene are specialised to.
pub struct Specialisation<'a> {
    pub plan: &'a Plan,
    pub features: Features,
    pub patches: Patches,
    pub walls: &'a Walls,
    pub fabric: &'a Fabric,
    /// Particles of a thread of the tally.
    pub tally_loops: u32,
}

pub fn constants(of: &Specialisation<'_>) -> Vec<(&'static str, f64)> {
    let &Specialisation { plan, features, patches, walls, fabric, tally_loops } = of;
    let scales = Scales::new(plan);
    let grid = &plan.grid;
    let [surface_models_at, vents_at, works_at] = patches.ends();
    let flag = |on: bool| f64::from(u8::from(on));
    let blocks = block_counts(plan);
    let seed_high = |purpose: u64| ((((plan.seed >> 32) << 8) | purpose) & 0xffff_ffff) as f64;
    vec![
        ("WORKGROUP", f64::from(WORKGROUP)),
        ("CELLS_X", f64::from(grid.cells[0])),
        ("CELLS_Y", f64::from(grid.cells[1])),
        ("CELLS_Z", f64::from(grid.cells[2])),
        ("CELL_BITS", f64::from(grid.cell_bits)),
        ("QUANTUM", grid.quantum()),
        ("QUANTA", 1.0 / grid.quantum()),
        ("TOLERANCE", walls.tolerance),
        ("CLEARANCE_UNIT", CLEARANCE_UNIT),
        ("CHUNK", CHUNK as f64),
        ("CHUNK_LOOPS", f64::from(tally_loops)),
        ("FEW_STRETCHES", FEW_STRETCHES as f64),
        ("ROUNDS", f64::from(plan.rounds)),
        ("DIAMETER", plan.diameter),
        ("CAPPED", flag(features.capped)),
        ("DIAMETER2_PACKED", nearness::diameter2(plan)),
        ("FASTEST2", nearness::fastest2(plan)),
        ("RIGID", flag(plan.method == Method::HardSphere)),
        ("SEED_LOW", (plan.seed & 0xffff_ffff) as f64),
        ("CROSS_SECTION", std::f64::consts::PI * plan.diameter * plan.diameter),
        ("SEED_HIGH", seed_high(PURPOSE_COLLISION)),
        ("CELL_SEED_HIGH", seed_high(PURPOSE_CELL)),
        // Collisions in cells are at the start of the step.
        ("FLOWN", if features.collisions && !features.rounds { 0.0 } else { 0.5 }),
        ("WALL_SEED_HIGH", seed_high(PURPOSE_WALL)),
        ("COLLISIONS", flag(features.collisions)),
        ("ROUNDS_OF_PAIRS", flag(features.rounds)),
        ("SPIN", flag(features.spin)),
        ("CURVES", flag(features.curves)),
        ("MODES", most_modes(plan) as f64),
        (
            "INVERSE_THERMAL",
            scales.reference_mass / (plan.moles_per_particle * GAS_CONSTANT * plan.temperature_reference),
        ),
        ("ORIFICES", flag(features.orifices)),
        ("SURFACES", flag(features.surfaces)),
        ("SURFACE_MODELS", flag(features.surface_models)),
        ("VENTS", flag(features.vents)),
        ("HALO", flag(features.halo)),
        ("SURFACE_MODELS_AT", surface_models_at as f64),
        ("VENTS_AT", vents_at as f64),
        ("WORKS_AT", works_at as f64),
        ("RECOIL_AT", patches.recoil_at() as f64),
        ("COPIES", SURFACE_COPIES as f64),
        ("COPY_WORDS", patches.copy_words() as f64),
        ("CELL_POINTS", CELL_POINTS as f64),
        ("GENERATOR_Y", CELL_GENERATOR[1] as f64),
        ("GENERATOR_Z", CELL_GENERATOR[2] as f64),
        ("DIVIDED_GAS", flag(features.divided)),
        ("TILED", flag(features.half_turn)),
        ("BORDER", flag(!features.half_turn)),
        ("BOX_BITS", f64::from(box_bits(plan.method))),
        ("MOST_MEMBERS", f64::from(MOST_MEMBERS)),
        ("CELLS_FLOWN", f64::from(1u32 << box_bits(plan.method))),
        ("MOVING", flag(features.moving)),
        ("MOTIONS", patches.motions as f64),
        ("FABRIC", flag(features.fabric)),
        ("MEMBRANE", flag(features.membrane)),
        ("SMOOTHED", flag(features.smoothed)),
        ("NODES", fabric.nodes as f64),
        ("SHEET_GAP", fabric.gap),
        ("MOST_BOUNCES", MOST_BOUNCES),
        ("IMPULSE_SCALE", scales.velocity),
        ("GASES", plan.gases.len() as f64),
        ("CHAMBERS", plan.chambers.len() as f64),
        ("VELOCITY_SCALE", scales.velocity),
        ("ENERGY_SCALE", scales.energy),
        ("BLOCK_BITS", f64::from(plan.block_cells_log2)),
        ("BLOCKS_X", f64::from(blocks[0])),
        ("BLOCKS_Y", f64::from(blocks[1])),
        ("BLOCKS", f64::from(blocks.iter().product::<u32>())),
        ("TIME_STEP", plan.time_step),
        ("LEVELS", f64::from(plan.ladder_levels)),
        ("BLOCK_ENERGY_SCALE", scales.block_energy),
    ]
}

/// Plans count the largest collision cell as the kernels make it.
const _: () = assert!(TILE_EDGE == (1u32 << TILE_BITS) as f64);

/// Cells per edge, log2, of what the boxes of subdomains are made of: with the method `half-turn` tiles, whose collision cells have one owner.
pub fn box_bits(method: Method) -> u32 {
    if method == Method::HalfTurn { TILE_BITS } else { 0 }
}

/// Of a gas, at least one.
fn most_modes(plan: &Plan) -> usize {
    let modes = plan.gases.iter().map(|gas| gas.species.modes().map_or(1, |modes| modes.modes.len()));
    modes.max().unwrap_or(1)
}

/// Coarse blocks per axis.
pub fn block_counts(plan: &Plan) -> [u32; 3] {
    plan.grid.cells.map(|cells| ((cells - 1) >> plan.block_cells_log2) + 1)
}
