//! uses: grid.wgsl step.wgsl has_fabric.wgsl
// Surfaces that deform: triangles between nodes that fly straight at one velocity each within a step. Where the nodes are at the start
// and the end of each step of an interval comes from the host, on the lattice of positions.
//
// Which triangles are where in a step (list_fabric.wgsl, bound_fabric.wgsl): `fabric_cells` counts the entries, and the cells that have some; of each
// cell of a box (`step.fabric_low`) it has the number of its record, from 1, or 0; and a bit, set where a triangle may touch one of the 27 cells around.
// `fabric_entries` has first the entries: a triangle, the number of the cell's next entry, from 1, or 0, and a box around what the triangle sweeps in
// the cell; and behind them, of each cell that has some, the record: the planes between which all of its fabric is, the number of its first entry, and the cell.

struct Sheet {
    // Its nodes, counter-clockwise seen from the side that its normal points to: of closed fabric the outer one.
    a: u32,
    b: u32,
    c: u32,
    // 1: of closed fabric, whose inside is known by the particles' tags.
    closed: u32,
    // The surface tally of the side that the normal points to, and behind it that of the other; or NOBODY.
    surface: u32,
    // What the side that the normal points to does to a particle that hits it (`surface_models`), and behind it the other; or
    // NOBODY: mirrors.
    surface_model: u32,
    // The tally of its work.
    work: u32,
    // The reference mass over that with which it recoils from a hit, 0 if nothing moves it.
    recoil: f32,
}

// What a triangle sweeps in the step, and a margin of SHEET_MARGIN gaps.
struct Swept {
    // The unit normal at the start, or zero.
    normal: vec3<f32>,
    // How far from the plane at the start it comes, quanta.
    away: f32,
    // A point of that plane.
    corner: vec3<u32>,
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

// Whether a cell is one of those in which triangles are listed; which of them.
fn has_fabric_list(c: vec3<u32>) -> bool {
    return all(c - step.fabric_low < step.fabric_size);
}

fn fabric_list(c: vec3<u32>) -> u32 {
    let o = c - step.fabric_low;
    return (o.z * step.fabric_size.y + o.y) * step.fabric_size.x + o.x;
}

// Where the bits begin.
fn fabric_bits() -> u32 {
    return FABRIC_FIRST + step.fabric_size.x * step.fabric_size.y * step.fabric_size.z;
}

// Four numbers of -128 to 127, in bytes.
fn bytes_of(word: u32) -> vec4<f32> {
    return vec4<f32>(bitcast<vec4<i32>>(vec4<u32>(word << 24u, word << 16u, word << 8u, word)) >> vec4<u32>(24u));
}

fn packed_bytes(v: vec4<f32>) -> u32 {
    let b = bitcast<vec4<u32>>(vec4<i32>(v)) & vec4<u32>(255u);
    return b.x | (b.y << 8u) | (b.z << 16u) | (b.w << 24u);
}

// Half a cell in the steps of an entry's box, whose corners are seen from the middle. (A box that reaches farther ends there.)
const BOX_STEPS: f32 = 127.0;

// A normal's longest component, and steps of a slab's planes in a cell along it.
const SLAB_NORMAL: f32 = 127.0;
const SLAB_STEPS: f32 = 16384.0;

struct Slab {
    normal: vec3<f32>,
    // How far the planes are from the middle, in cells.
    low: f32,
    high: f32,
}

fn slab_of(words: vec2<u32>) -> Slab {
    let ends = vec2<f32>(vec2<i32>(extractBits(i32(words.y), 0u, 16u), i32(words.y) >> 16u)) / SLAB_STEPS;
    return Slab(bytes_of(words.x).xyz / SLAB_NORMAL, ends.x, ends.y);
}

// How far around what a triangle sweeps it counts as being, quanta.
fn sheet_margin() -> f32 {
    return f32(SHEET_MARGIN) * SHEET_GAP * QUANTA;
}

// A point seen from the middle of a cell, in cells.
fn from_middle(c: vec3<u32>, p: vec3<u32>) -> vec3<f32> {
    let middle = (c << vec3<u32>(CELL_BITS)) + (1u << (CELL_BITS - 1u));
    return vec3<f32>(bitcast<vec3<i32>>(p - middle)) / f32(1u << CELL_BITS);
}
