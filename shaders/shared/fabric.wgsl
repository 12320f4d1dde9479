//! uses: grid.wgsl step.wgsl has_fabric.wgsl
// Surfaces that deform: triangles between nodes that fly straight at one velocity each within a step. Where the nodes are at the start
// and the end of each step of an interval comes from the host, on the lattice of positions.
//
// `fabric_cells` has which triangles are where in a step (list_fabric.wgsl): a word that counts the entries; of each cell of
// the grid the number of its first entry, from 1, or 0; of each cell a bit, set where a triangle may touch one of the 27 cells around; the
// entries, of two words: a triangle, and the number of the cell's next entry, or 0.

struct Sheet {
    // Its nodes, counter-clockwise seen from the side that its normal points to: of closed fabric the outer one.
    a: u32,
    b: u32,
    c: u32,
    // 1: of closed fabric, whose inside is known by the particles' tags.
    closed: u32,
    // The surface tally of the side that the normal points to, and behind it that of the other; or NOBODY.
    surface: u32,
    // As those of a triangle of a wall (walls.wgsl).
    surface_model: u32,
    // The tally of its work.
    work: u32,
    pad: u32,
}

override NODES: u32 = 0;
// How near a flight comes to a sheet, m: some ten times what rounding may do to the place of a hit.
override SHEET_GAP: f32 = 0.0;
// How far beyond a sheet of closed fabric a particle is still put back on its own side, in gaps.
const SHEET_BEHIND: f32 = 8.0;
// How far sheets reach beyond their edges, in gaps.
const SHEET_REACH: f32 = 2.0;

var<storage, read> nodes: array<vec4<u32>>;
var<storage, read> fabric: array<Sheet>;

// A node at the start of the step and at its end.
fn node_before(node: u32) -> vec3<u32> {
    return nodes[step.slot * NODES + node].xyz;
}

fn node_after(node: u32) -> vec3<u32> {
    return nodes[(step.slot + 1u) * NODES + node].xyz;
}

fn grid_cells() -> u32 {
    return CELLS_X * CELLS_Y * CELLS_Z;
}

// Where the bits begin.
fn fabric_bits() -> u32 {
    return FABRIC_FIRST + grid_cells();
}

// Where the entries begin.
fn fabric_entries() -> u32 {
    return fabric_bits() + (grid_cells() + 31u) / 32u;
}
