//! What a kernel needs to run alone: a device, a world (`world.rs`), and buffers that the test owns.

use std::collections::BTreeMap;

use corpuscle::gpu::{Kernel, KernelVariant, Recording};
use corpuscle::subdomain::{
    GpuFlight, GpuGas, GpuMotion, GpuSheet, GpuStep, MOTION_ENTRIES, registry, runtime_constants, shader, share_table,
};

pub use crate::devices::device;
pub use crate::world::*;

/// Numbers of the registry, as places of words.
macro_rules! places {
    ($($name:ident),* $(,)?) => { $(pub const $name: usize = registry::$name as usize;)* };
}

places! {
    LISTS, LIST_CROWDED, LIST_CROWDS, LIST_COLLISION_CELLS, LIST_CUT_CELLS, LIST_NEAR_WALLS, LIST_INCOMPLETE, LIST_BOUNCE, LIST_BORDER, LIST_CHANGED,
    LIST_OUTBOX, LIST_UPDATES, LIST_RECHOOSE, LIST_ON_DEMAND, LIST_TAILS, COUNT_DROPPED,
    COUNTER_WORDS, COLLISIONS_LOW, LOST, SAMPLED, TAILS_WANTED, OUTSIDE, OVERSHOOT, TRUNCATED, TALLY_OVERFLOW,
    CAPACITY_FAILED, BOUNCES, BLOCKED, FOREIGN, STRAYS, MISSING, CANDIDATES, GHOST_CANDIDATES, GHOST_SHEETS, GHOST_WALLS, MOVED, SHEETS,
    FREE_FLIGHTS, CUT_GROUPS, UNFITTED, FAST_PAIRS, CUT_SHORT, MISPLACED, CELL_COLLISIONS, LIST_SHARDS, SHARD_WORDS, LENGTHS_OF_SHARDS,
    STALLED, STALLED_PARTICLES, INTERVAL_STEPS, PRESENT,
    ZONE_WORDS, SURFACE_WORDS, SURFACE_MODEL_WORDS, VENT_WORDS, BLOCK_WORDS,
}

/// The variants of kernels that the device can run.
pub fn variants() -> Vec<KernelVariant> {
    device().adapter().variants()
}

/// Whether a word of the counters is the length of a part of a list (`shaders/shared/list_shards.gpu.wgsl`).
pub fn is_of_shard(variant: KernelVariant, word: usize) -> bool {
    let of_shards = LENGTHS_OF_SHARDS..LENGTHS_OF_SHARDS + LIST_SHARDS * SHARD_WORDS;
    variant == KernelVariant::Gpu && of_shards.contains(&word) && (word - LENGTHS_OF_SHARDS) % SHARD_WORDS < LISTS
}

pub const NOBODY: u32 = u32::MAX;
pub const NEVER: f32 = 1e30;
/// Nearer than a cell's edge, once packed: (128 + sqrt(3))^2 < 16831.
pub const CELL_NEAR2: u32 = 16_831;
/// Marks of `layers` (`shaders/shared/local.wgsl`).
pub const SHARED: u32 = 0x100;
pub const LISTED: u32 = 0x200;
pub const NEAR: u32 = 0x400;
pub const TURNED_TO_WALL: u32 = 0x8000;
pub const UNSCREENED: u32 = 0x2000;
pub const LONG: u32 = 0x4000;
pub const CHOOSES: u32 = 0x10000;
/// Words of a particle's flight and the beginning of its neighbour list.
pub const RECORD: usize = 8;

/// The numbers of the registry as every kernel has them.
pub fn numbers() -> String {
    let all = registry::NUMBERS.into_iter().flatten();
    all.map(|(name, value)| format!("const {name}: u32 = {value}u;\n")).collect()
}

/// Threads of the largest dispatch over particles.
const MOST_PARTICLES: usize = 8192;

/// Unit roundoff of f32.
pub const U: f64 = 1.0 / 16_777_216.0;

/// Flights that start at 0 and meet no wall.
pub fn free_flights(count: usize) -> Vec<GpuFlight> {
    vec![GpuFlight { start: 0.0, wall: NEVER, partner: NOBODY, collisions: 0 }; count]
}

/// Buffers and constants for kernels on one world.
pub struct Rig {
    /// Cells of the world's grid.
    grid: [u32; 3],
    buffers: BTreeMap<&'static str, wgpu::Buffer>,
    /// Of each particle, and the tails behind (neighbour_lists.rs).
    records: Vec<[u32; RECORD]>,
    tails: Vec<u32>,
    constants: Vec<(&'static str, f64)>,
    /// Of its kernels.
    pub variant: KernelVariant,
}

impl Rig {
    pub fn new(world: &World) -> Rig {
        let grid = &world.grid;
        let constants = vec![
            ("CELLS_X", f64::from(grid.cells[0])),
            ("CELLS_Y", f64::from(grid.cells[1])),
            ("CELLS_Z", f64::from(grid.cells[2])),
            ("CELL_BITS", f64::from(grid.cell_bits)),
            ("QUANTUM", grid.quantum()),
            ("QUANTA", 1.0 / grid.quantum()),
            ("TOLERANCE", world.walls.tolerance),
            ("CLEARANCE_UNIT", corpuscle::geometry::CLEARANCE_UNIT),
            ("CHUNK", 64.0),
            ("FEW_STRETCHES", 0.0),
            // Mirrors, unless a test gives the walls surface_models.
            ("SURFACE_MODELS", 0.0),
            ("VENTS", 0.0),
            // One block, and one diameter, which no kernel needs but where a test says so.
            ("BLOCK_BITS", 15.0),
            ("BLOCKS_X", 1.0),
            ("BLOCKS_Y", 1.0),
            ("DIAMETER", 0.0),
            ("DIAMETER2_PACKED", 0.0),
            ("FASTEST2", 1e30),
            ("SEED_LOW", 0.0),
            ("SEED_HIGH", 4.0),
            ("WALL_SEED_HIGH", 7.0),
        ];
        let mut rig = Rig {
            grid: grid.cells,
            buffers: BTreeMap::new(),
            records: vec![],
            tails: vec![],
            constants,
            variant: device().variant(),
        };
        rig.put("wall_start", &world.walls.start);
        rig.put("wall_list", &world.walls.list);
        rig.put("triangles", &world.walls.triangles);
        rig.put("cell_class", &world.walls.class);
        rig.put("parting", &world.walls.parting);
        // No fabric, unless a test has some.
        rig.put("nodes", &[0u32; 4]);
        rig.put("fabric", &[GpuSheet::default()]);
        rig.put("fabric_cells", &[0u32; 4]);
        rig.put("fabric_entries", &[0u32; 8]);
        rig.put("fabric_swept", &[0u32; 8]);
        rig.put("node_impulses", &[0u32; 8]);
        rig.put("node_velocities", &[0f32; 4]);
        rig.put("counters", &[0u32; COUNTER_WORDS]);
        rig.put("stalled", &[0u32; STALLED_PARTICLES + 1]);
        rig.put("step_state", &[0u32; INTERVAL_STEPS + 1]);
        rig.put("dispatches", &[0u32; 3 * LISTS]);
        rig.put("rechoose_dispatches", &[0u32; 3 * LISTS]);
        rig.uniform("modes", &[[0.0f32; 4]; 1024]);
        rig.uniform("motions", &[GpuMotion::default(); MOTION_ENTRIES]);
        rig.put("newborns", &[0u32; 12]);
        // A device alone: all are in layer 0, and nobody is told.
        rig.put("marks", &[0u32; MOST_PARTICLES]);
        rig.put("border", &[[0u32; 2]; 2]);
        rig.put("changed", &[0u32; 4]);
        rig.put("surface_models", &[0u32; 8]);
        rig.put("vents", &[0u32; 8]);
        rig.put("zones", &[0u32; 16]);
        rig.put("on_demand", &[0u32; 4]);
        rig.put("on_demand_dispatches", &[0u32; 3 * LISTS]);
        rig.put("cross_section_shares", &[0u32; 4]);
        rig.put("firsts", &[0u32; 8]);
        rig.put_records(|records, _| records.resize(1, [NOBODY; RECORD]));
        for buffer in ["cell_start", "cell_counts", "bins", "stretch_sums", "cells", "midpoints", "neighbour_count"] {
            rig.put(buffer, &[0u32; 4]);
        }
        rig
    }

    pub fn constant(&mut self, name: &'static str, value: f64) {
        self.constants.retain(|(known, _)| *known != name);
        self.constants.push((name, value));
    }

    /// A storage buffer; its length is rounded up to 16 bytes, with zeros.
    pub fn put<T: bytemuck::Pod>(&mut self, name: &'static str, data: &[T]) {
        self.buffers.insert(name, device().storage_of(name, data).expect("memory"));
    }

    /// Changes the particles' records and the tails behind them, in the one buffer that has the flights, the neighbour lists, and when these
    /// are done with the particles.
    pub fn put_records(&mut self, change: impl FnOnce(&mut Vec<[u32; RECORD]>, &mut Vec<u32>)) {
        change(&mut self.records, &mut self.tails);
        let words = [self.records.as_flattened(), &self.tails].concat();
        let buffer = device().storage_of("particles", &words).expect("memory");
        for name in ["particles", "flights", "neighbours"] {
            self.buffers.insert(name, buffer.clone());
        }
    }

    pub fn uniform<T: bytemuck::Pod>(&mut self, name: &'static str, data: &[T]) {
        let buffer = device().uniform(name, size_of_val(data) as u64).expect("memory");
        device().write(&buffer, 0, data);
        self.buffers.insert(name, buffer);
    }

    /// The parameters of a step. Those that say where the device's cells lie are of one that owns the whole
    /// grid, unless they are given; `total` is by default all that there are, and particles meet within a
    /// cell's edge.
    pub fn step(&mut self, step: GpuStep) {
        let alone = GpuStep {
            size: self.grid,
            bins: self.grid.iter().product(),
            own_low: [1; 3],
            own_high: self.grid.map(|cells| cells - 1),
            inner_low: [1; 3],
            inner_high: self.grid.map(|cells| cells - 1),
            ..step
        };
        let placed = if step.bins == 0 { alone } else { step };
        let total = if step.total == 0 { step.count + step.newborns + step.arrivals } else { step.total };
        let near2 = if step.near2 == 0 { CELL_NEAR2 } else { step.near2 };
        let fabric_size = if step.fabric_size == [0; 3] { self.grid } else { step.fabric_size };
        self.uniform("step", &[GpuStep { total, near2, fabric_size, stride: step.stride.max(1), ..placed }]);
        // The last of its interval.
        self.set_step_state(INTERVAL_STEPS, if step.peers == 0 { step.slot + 1 } else { 0 });
    }

    pub fn gases(&mut self, gases: &[GpuGas]) {
        let mut table = [GpuGas::default(); 16];
        table[..gases.len()].copy_from_slice(gases);
        self.uniform("gases", &table);
        self.uniform("mass_shares", &share_table(gases));
        self.constant("GASES", gases.len() as f64);
    }

    pub fn set_stalled(&self, word: usize, value: u32) {
        device().write(&self.buffers["stalled"], 4 * word as u64, &[value]);
    }

    pub fn stalled(&self, word: usize) -> u32 {
        self.get::<u32>("stalled", STALLED_PARTICLES + 1)[word]
    }

    pub fn set_step_state(&self, word: usize, value: u32) {
        device().write(&self.buffers["step_state"], 4 * word as u64, &[value]);
    }

    pub fn step_state(&self, word: usize) -> u32 {
        self.get::<u32>("step_state", INTERVAL_STEPS + 1)[word]
    }

    /// Sets one counter, the others as they are.
    pub fn set_counter(&self, slot: usize, value: u32) {
        device().write(&self.buffers["counters"], 4 * slot as u64, &[value]);
    }

    pub fn counter(&self, slot: usize) -> u32 {
        self.get::<u32>("counters", COUNTER_WORDS)[slot]
    }

    /// Collisions in cells, whatever shards they are counted in.
    pub fn cell_collisions(&self) -> u32 {
        let words: Vec<u32> = self.get("counters", COUNTER_WORDS);
        assert!(words[CELL_COLLISIONS + 1..CELL_COLLISIONS + 64].iter().step_by(2).all(|&high| high == 0));
        words[CELL_COLLISIONS..CELL_COLLISIONS + 64].iter().step_by(2).sum()
    }

    /// Runs a kernel over workgroups.
    pub fn run_groups(&self, kernel: &str, groups: [u32; 3]) {
        let source = shader(kernel).expect("a shader of this name");
        // As in a run of so few particles: most tests then have the same kernels, each compiled once.
        let runtime = runtime_constants(device());
        let compiled = Kernel::in_variant(device(), self.variant, source, &self.constants, runtime).expect("a kernel");
        let bound = compiled.bind(device(), |name| self.buffers.get(name)).expect("all its buffers");
        let mut recording = Recording::new(device());
        bound.dispatch(&mut recording.phase(source.phases.first().unwrap_or(&"test")), 0, groups);
        recording.submit();
    }

    /// Runs a kernel over threads.
    pub fn run(&self, kernel: &str, threads: usize) {
        self.run_groups(kernel, [threads.div_ceil(64) as u32, 1, 1]);
    }

    pub fn get<T: bytemuck::Pod>(&self, name: &str, items: usize) -> Vec<T> {
        device().read(&self.buffers[name], items).expect("the device's answer")
    }

    /// Where the entries are of a list in shards, if it has any, that has so many at most (`shaders/shared/sharded_lists.wgsl`).
    pub fn sharded(&self, list: usize, most: usize) -> Vec<usize> {
        let lengths: Vec<u32> = self.get("counters", COUNTER_WORDS);
        if self.variant != KernelVariant::Gpu {
            return (0..lengths[list] as usize).collect();
        }
        let room = (most / (64 * LIST_SHARDS) + 1) * 64;
        let places = |shard: usize| {
            let length = lengths[LENGTHS_OF_SHARDS + shard * SHARD_WORDS + list] as usize;
            (0..length.min(room)).map(move |k| (k / 64 * LIST_SHARDS + shard) * 64 + k % 64)
        };
        (0..LIST_SHARDS).flat_map(places).collect()
    }

    /// The first so many entries of such a list are all that it has.
    pub fn set_sharded(&self, list: usize, count: usize) {
        self.set_counter(list, if self.variant == KernelVariant::Gpu { 0 } else { count as u32 });
        for shard in 0..LIST_SHARDS {
            let length = (0..count).filter(|place| place / 64 % LIST_SHARDS == shard).count();
            self.set_counter(LENGTHS_OF_SHARDS + shard * SHARD_WORDS + list, length as u32);
        }
    }

    /// Those that choose in a round, of so many particles, in ascending order.
    pub fn choosers(&self, round: usize, particles: usize) -> Vec<u32> {
        let places = self.sharded(LIST_RECHOOSE + round, particles);
        let entries: Vec<u32> = self.get("rechoose", particles + 64 * LIST_SHARDS);
        let mut found: Vec<u32> = places.into_iter().map(|place| entries[place]).collect();
        found.sort_unstable();
        found
    }

    /// The first so many entries of `rechoose` choose in a round.
    pub fn set_choosers(&self, round: usize, count: usize) {
        self.set_sharded(LIST_RECHOOSE + round, count);
    }

    /// The entries of a list, in ascending order: which thread appends first is not determined.
    pub fn list(&self, buffer: &str, list: usize) -> Vec<u32> {
        let mut entries = self.get::<u32>(buffer, self.counter(list) as usize);
        entries.sort_unstable();
        entries
    }
}
