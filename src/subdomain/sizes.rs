//! Sizes that kernels and host agree on and that no scene changes: threads of a workgroup, cells of a chunk, members of a cell.

/// Threads of a workgroup. Part of the plan's bits: a driver may contract differently for another size.
pub const WORKGROUP: u32 = 64;
/// Particles of a cell of the method `cell` that a thread puts in order by itself, at most: as `shaders/shared/members.wgsl`
/// has it, whose sorting network is made for so many (held against it in `tests/layouts.rs`).
pub const MEMBERS: u32 = 12;
/// And of more, slots that one thread puts in order.
pub const CROWD: u32 = 64;

/// Cells per edge, log2, of a tile of the method `half-turn`: as `shaders/shared/local.wgsl` has it.
pub const TILE_BITS: u32 = 2;
/// Collision cells of the method `half-turn` with more particles are halved.
pub const MOST_MEMBERS: u32 = 21;

/// Cells per thread of the scan.
pub const CHUNK: u64 = 64;
/// Those of a workgroup, of a thread each.
pub const STRETCH: u64 = CHUNK * WORKGROUP as u64;
/// Stretches that each chunk adds up by itself (`shaders/scan_cells.wgsl`): of so few that takes less than a kernel between.
pub const FEW_STRETCHES: u64 = 64;

/// Cells that a thread clears (`shaders/clear_cells.wgsl`).
pub const CLEARED_CELLS: u64 = 16;
/// Copies of the tallies of walls (`shaders/bounce.wgsl`).
pub const SURFACE_COPIES: usize = 16;
/// Entries of the table of moving walls, of which each step has `MOST_MOTIONS` (`shaders/shared/motions.wgsl`).
pub const MOTION_ENTRIES: usize = 128;
