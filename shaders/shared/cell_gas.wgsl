// The gas of a cell: its volume, and where walls part it, its parts (src/geometry/cell_gas.rs).

// A part of the gas of a cell: a point that sees it, and its volume, m3.
struct Part {
    place: vec3<u32>,
    volume: f32,
}

// Per cell its volume, m3 (the bits of an f32), or this mark, and below it the number of its parts and the first of
// them in `cell_parts`.
const DIVIDED: u32 = 0x80000000;

// The gas that walls at rest leave of a cell that moving walls may touch: which points of its lattice are gas, a bit for
// each, and the volume, m3.
struct StillGas {
    points: vec3<u32>,
    volume: f32,
}

var<storage, read> cell_volume: array<u32>;

// Where in a particle's word of `marks` its part is.
const PART_SHIFT: u32 = 16;

fn parts_of(entry: u32) -> u32 {
    return (entry >> 24u) & 0x7fu;
}

fn first_part(entry: u32) -> u32 {
    return entry & 0xffffffu;
}

// The place in the grid of a cell of this device (local.wgsl).
fn index_of(bin: u32) -> u32 {
    if (step.bins == CELLS_X * CELLS_Y * CELLS_Z) {
        // The box is the grid.
        return bin;
    }
    return cell_index(cell_of(bin));
}
