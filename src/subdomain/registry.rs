//! What kernels and host number alike: buffers, lists, counters, and the words of tallies.
//!
//! `build.rs` compiles this file, too: every kernel begins with the numbers below as constants of WGSL, and a
//! declaration `var<storage, ..> NAME` or `var<uniform> NAME` gets the binding number of the buffer NAME. To add a
//! number or a buffer is to add its line here.
//!
//! Numbers of lists are words of the buffer `counters` and, three words each, of the buffers of dispatches.

/// Constants, and all of them as a table of names and values.
macro_rules! registry {
    ($(#[doc = $all:literal])* $table:ident { $($(#[doc = $about:literal])* $name:ident = $value:expr,)* }) => {
        $($(#[doc = $about])* pub const $name: u32 = $value;)*
        $(#[doc = $all])*
        pub const $table: &[(&str, u32)] = &[$((stringify!($name), $name)),*];
    };
}

registry! {
    /// Lists of rare work, and counts that a step has like their lengths.
    LISTS_AND_COUNTS {
        /// The pairs of round r are list r; the list behind the last round's counts the pairs that the rounds lost.
        LIST_PAIRS = 0,
        /// Cells that walls divide, and cells that moving walls may touch, with the method `cell`, which has no rounds.
        LIST_DIVIDED = 0,
        LIST_MOVED = 1,
        /// Particles of cells that are put in order one by one, and crowded cells, with the method `cell`.
        LIST_CROWDED = 2,
        LIST_CROWDS = 3,
        /// Collision cells of the method `half-turn`, and those that walls may cut.
        LIST_COLLISION_CELLS = 4,
        LIST_CUT_CELLS = 5,
        /// The particles that may meet a wall in the step: their number alone, they are in other lists.
        LIST_NEAR_WALLS = 9,
        LIST_INCOMPLETE = 10,
        /// Particles that meet a wall.
        LIST_BOUNCE = 11,
        /// The particles that other devices may need, and those of them that a round has changed.
        LIST_BORDER = 12,
        LIST_CHANGED = 13,
        /// Sendings of particles, and of updates.
        LIST_OUTBOX = 14,
        LIST_UPDATES = 15,
        /// The particles that choose in round r are list `LIST_RECHOOSE` + r: so many lists, up to the one behind the last round's.
        LIST_RECHOOSE = 16,
        RECHOOSE_LISTS = 10,
        /// The ghosts that were asked for their choice.
        LIST_ON_DEMAND = 26,
        /// The entries of the tails of neighbour lists.
        LIST_TAILS = 29,
        /// Slots that hold no particle of this device or its halo.
        COUNT_DROPPED = 31,
        LISTS = 32,
    }
}

registry! {
    /// Words of `counters` behind the lists. The host reads them some steps late.
    COUNTERS {
        /// Collisions of the rounds since the last read, two words.
        COLLISIONS_LOW = LISTS,
        COLLISIONS_HIGH = 33,
        /// Pairs lost, and collisions, in the sampled steps.
        LOST = 34,
        SAMPLED = 35,
        /// Entries of the tails of neighbour lists where there was no room for all.
        TAILS_WANTED = 36,
        /// Particles found outside the vessel, once a step.
        OUTSIDE = 37,
        /// Largest distance behind a wall, quanta.
        OVERSHOOT = 38,
        /// Flights cut short after the last bounce off walls.
        TRUNCATED = 39,
        /// Values beyond the range of a tally.
        TALLY_OVERFLOW = 40,
        /// Newborns that found no room.
        CAPACITY_FAILED = 41,
        /// Wall hits since the last read.
        BOUNCES = 42,
        /// Pairs parted by a wall where they would have met.
        BLOCKED = 43,
        /// Pairs settled here that another device counts.
        FOREIGN = 44,
        /// Particles whose owner, or who may need them, is none of the peers.
        STRAYS = 45,
        /// Updates of ghosts that are not here.
        MISSING = 46,
        /// Entries of the neighbour lists at the last step before the read.
        CANDIDATES = 47,
        /// Particles that came from another owner since the last read.
        MOVED = 48,
        /// Collisions of pairs faster than the plan's fastest since the last read.
        FAST_PAIRS = 49,
        /// The entries of ghosts among `CANDIDATES`, and ghosts that may meet a wall in that step.
        GHOST_CANDIDATES = 50,
        GHOST_WALLS = 51,
        /// Threads whose loops the device ended too soon (`shaders/shared/turns.wgsl`).
        CUT_SHORT = 52,
        /// Collisions in cells since the last read, in `COLLISION_COUNTS` parts of two words each, so that few threads
        /// count up the same word.
        CELL_COLLISIONS = 53,
        COLLISION_COUNTS = 32,
        /// Entries of lists that found no place, and threads that were parted while they counted together.
        MISPLACED = 117,
        /// With the method `half-turn` since the last read: particles that flew on, alone in their collision cell or group; groups
        /// that walls made; and particles that collided without a velocity gradient.
        FREE_FLIGHTS = 118,
        CUT_GROUPS = 119,
        UNFITTED = 120,
        /// Flights that ended at elastic fabric after as many hits as are followed there in a step.
        CAUGHT = 121,
        /// Triangles of fabric in the cells of the particles at the last step before the read, for each particle, and those of ghosts among them.
        SHEETS = 122,
        GHOST_SHEETS = 123,
        /// The lengths of sharded lists (`shaders/shared/sharded_lists.gpu.wgsl`), by shard: each shard's so far
        /// behind the one before that another part of a GPU's cache has them.
        LENGTHS_OF_SHARDS = 128,
        SHARD_WORDS = 64,
        LIST_SHARDS = 16,
        COUNTER_WORDS = LENGTHS_OF_SHARDS + SHARD_WORDS * LIST_SHARDS,
    }
}

registry! {
    /// Words of `stalled`, which a device alone writes where its lists had too little room. They are no counters, which are
    /// counted up meanwhile: each thread of the kernels behind reads them.
    STALLED_TABLE {
        /// One more than the place of the step in its interval, after whose search nothing changes until the host has made
        /// room. The host alone clears it.
        STALLED = 0,
        /// How many particles are in `sorted` then.
        STALLED_PARTICLES = 1,
        STALLED_WORDS = 2,
    }
}

registry! {
    /// Words of `step_state`, which each thread of the kernels of a step may read.
    STEP_STATE {
        /// The particles that are in cells.
        PRESENT = 0,
        /// On a device alone that sorts its particles the number of steps of the interval, else 0; from the host. It is
        /// here and not in a uniform: where a branch asks uniforms alone, Mesa's lavapipe of 22.3 makes a kernel for
        /// their values, some kernels anew at each dispatch.
        INTERVAL_STEPS = 1,
        STEP_STATE_WORDS = 2,
    }
}

registry! {
    /// The integer tallies: words of an entry, and where in it each sum of two words begins.
    TALLIES {
        /// A gas in a zone (`shaders/tally.wgsl`).
        ZONE_NUMBER = 0,
        ZONE_VELOCITY = 2,
        ZONE_KINETIC = 8,
        ZONE_SPIN = 10,
        ZONE_WORDS = 12,
        /// A surface (`shaders/bounce.wgsl`): three components of the impulse, the normal impulse, hits.
        SURFACE_IMPULSE = 0,
        SURFACE_NORMAL = 6,
        SURFACE_HITS = 8,
        SURFACE_WORDS = 10,
        /// A surface model, a vent or a moving wall: an energy, and that energy times the tallies of zones that followed.
        WALL_ENERGY = 0,
        WALL_TALLIED = 2,
        SURFACE_MODEL_WORDS = 4,
        /// A vent has behind these: hits, hits whose probability was clipped to one, and then, a word each, the
        /// particles of each gas that left.
        VENT_HITS = 4,
        VENT_CLIPPED = 6,
        VENT_LEFT = 8,
        VENT_WORDS = 24,
        /// A coarse block (`shaders/blocks.wgsl`).
        BLOCK_NUMBER = 0,
        BLOCK_ENERGY = 2,
        BLOCK_WORDS = 4,
    }
}

registry! {
    /// Fabric (`shaders/shared/fabric.wgsl`).
    FABRIC_TABLE {
        /// How far around the box that a triangle sweeps it is listed, in gaps.
        SHEET_MARGIN = 16,
        /// Words of `fabric_cells`: how many entries there are, how many cells have some, and where the cells begin.
        FABRIC_ENTRIES = 0,
        FABRIC_LISTED = 1,
        FABRIC_FIRST = 2,
        /// Of a node of elastic fabric: three components of the impulse that the gas gives it in a step, of two words each.
        NODE_IMPULSE_WORDS = 6,
    }
}

/// All numbers that kernels see.
pub const NUMBERS: [&[(&str, u32)]; 6] = [LISTS_AND_COUNTS, COUNTERS, STALLED_TABLE, STEP_STATE, TALLIES, FABRIC_TABLE];

/// The uniform of which each dispatch sees the part of its step and round.
pub const STEPPED: &str = "step";

/// The buffers of kernels: the place of a name is its binding number.
pub const BUFFERS: &[&str] = &[
    "step",
    "gases",
    "modes",
    "mass_shares",
    "motions",
    "weights",
    "counters",
    "dispatches",
    "rechoose_dispatches",
    "on_demand_dispatches",
    "stalled",
    "step_state",
    "zone_sums",
    "surface_sums",
    "block_sums",
    "histogram",
    "surface_models",
    "vents",
    "cross_section_shares",
    "zones",
    "wall_start",
    "wall_list",
    "triangles",
    "cell_class",
    "parting",
    "nodes",
    "fabric",
    "fabric_cells",
    "fabric_entries",
    "fabric_swept",
    "node_impulses",
    "node_velocities",
    "cell_volume",
    "cell_parts",
    "still_gas",
    "chunk_sums",
    "stretch_sums",
    "cell_counts",
    "cell_start",
    "particles",
    "flights",
    "neighbours",
    "newborns",
    "bins",
    "crowds",
    "choices",
    "border",
    "slots",
    "incomplete",
    "pairs",
    "crowded",
    "order_by_id",
    "rechoose",
    "bouncing",
    "sorted",
    "midpoints",
    "neighbour_count",
    "cells",
    "marks",
    "changed",
    "on_demand",
    "firsts",
    "divided",
    "moved",
    "collision_cells",
    "cut_cells",
    "peers",
    "sendings",
    "peer_counts",
    "peer_starts",
    "outbox",
    "updates_out",
    "updates_in",
    "cuts",
    // The kernels of `corpuscle bench` have these.
    "copy_from",
    "copy_to",
];

/// The phases of a step in their order, and behind them what is done between steps. Collisions are those of `collide`
/// (the method `cell`) or those of `neighbours` to `lost`.
pub const PHASES: &[&str] = &[
    "membrane",
    "fabric",
    "bin",
    "exchange",
    "scan",
    "sort",
    "collide",
    "neighbours",
    "choose",
    "settle",
    "update",
    "lost",
    "advect",
    "tally",
    "blocks",
    "weigh",
    "lists",
];

/// Which runs have a name of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Runs {
    All,
    /// Those of the method `cell`.
    Cell,
    /// Those of the method `half-turn`.
    HalfTurn,
    /// Those whose pairs are chosen in rounds.
    Rounds,
}

/// Names of a buffer, and the stretch of phases in which it is that: where `to` is before `from`, through the end of the
/// step to the next one's.
#[derive(Debug, Clone, Copy)]
pub struct Use {
    pub names: &'static [&'static str],
    pub runs: Runs,
    pub from: &'static str,
    pub to: &'static str,
    /// Kernels that have a name bound in other phases, too, and do not touch it there.
    pub idle: &'static [&'static str],
}

/// One buffer of the device that has several names, one after the other: it is made under the first.
///
/// In a phase in which one use ends another may begin; else no two of them share a phase in one run.
pub const REUSED: &[&[Use]] = &[
    // How many particles a cell has, and then where they start.
    &[
        Use { names: &["cell_counts"], runs: Runs::All, from: "advect", to: "scan", idle: &[] },
        Use { names: &["cell_start"], runs: Runs::All, from: "scan", to: "advect", idle: &[] },
    ],
    // A particle's record: all that it is, while it lies in `sorted` its flight and the beginning of its neighbour list.
    &[
        Use { names: &["particles"], runs: Runs::All, from: "advect", to: "sort", idle: &[] },
        Use { names: &["flights", "neighbours"], runs: Runs::Rounds, from: "sort", to: "advect", idle: &[] },
    ],
    &[
        Use { names: &["bins"], runs: Runs::All, from: "advect", to: "sort", idle: &[] },
        Use { names: &["crowds"], runs: Runs::Cell, from: "collide", to: "collide", idle: &[] },
        Use { names: &["collision_cells"], runs: Runs::HalfTurn, from: "collide", to: "collide", idle: &[] },
        Use { names: &["choices"], runs: Runs::Rounds, from: "neighbours", to: "lost", idle: &[] },
    ],
    &[
        Use { names: &["slots"], runs: Runs::Cell, from: "sort", to: "collide", idle: &[] },
        Use { names: &["cut_cells"], runs: Runs::HalfTurn, from: "collide", to: "collide", idle: &[] },
        Use { names: &["border"], runs: Runs::All, from: "bin", to: "exchange", idle: &[] },
        // The pass over the ghosts that were asked reads `asked`.
        Use { names: &["incomplete"], runs: Runs::Rounds, from: "sort", to: "neighbours", idle: &["complete_lists"] },
        Use { names: &["pairs"], runs: Runs::Rounds, from: "settle", to: "lost", idle: &[] },
    ],
    &[
        Use { names: &["crowded"], runs: Runs::Cell, from: "sort", to: "sort", idle: &[] },
        Use { names: &["order_by_id"], runs: Runs::All, from: "collide", to: "collide", idle: &[] },
        Use { names: &["rechoose"], runs: Runs::Rounds, from: "neighbours", to: "lost", idle: &[] },
        Use { names: &["bouncing"], runs: Runs::All, from: "advect", to: "advect", idle: &[] },
    ],
];

/// The name under which a buffer is made.
pub fn made_as(name: &str) -> &str {
    let has = |uses: &&&[Use]| uses.iter().any(|used| used.names.contains(&name));
    REUSED.iter().find(has).map_or(name, |uses| uses[0].names[0])
}
