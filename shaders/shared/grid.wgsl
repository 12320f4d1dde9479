//! uses: rounded.wgsl
// The one global cell grid and its fixed-point positions (src/geometry/grid.rs).

override CELLS_X: u32;
override CELLS_Y: u32;
override CELLS_Z: u32;
override CELL_BITS: u32;
// Metres per quantum, and its inverse.
override QUANTUM: f32;
override QUANTA: f32;

const CLASS_CLEAR: u32 = 0;
const CLASS_GAS: u32 = 1;
const CLASS_CUT: u32 = 2;
const CLASS_SOLID: u32 = 3;

fn cell_index(c: vec3<u32>) -> u32 {
    return (c.z * CELLS_Y + c.y) * CELLS_X + c.x;
}

fn cell_at(index: u32) -> vec3<u32> {
    let row = index / CELLS_X;
    return vec3<u32>(index % CELLS_X, row % CELLS_Y, row / CELLS_Y);
}

fn in_grid(c: vec3<u32>) -> bool {
    return c.x < CELLS_X && c.y < CELLS_Y && c.z < CELLS_Z;
}

// A position moved at v m/s for some seconds, rounded to the nearest quantum. Below the origin it wraps to a huge
// number, which no cell of the grid has.
fn shifted(p: vec3<u32>, v: vec3<f32>, time: f32) -> vec3<u32> {
    return p + bitcast<vec3<u32>>(rounded((v * QUANTA) * time));
}

// b - a in metres; the difference of integers is exact.
fn between(a: vec3<u32>, b: vec3<u32>) -> vec3<f32> {
    return vec3<f32>(bitcast<vec3<i32>>(b - a)) * QUANTUM;
}

// The cell of a point up to 2^30 quanta (half the longest side of the grid, or more) outside the grid on
// either side. Positions in the grid reach up to 2^31, so the sign bit alone does not tell the two sides.
const MARGIN: u32 = 0x40000000;

fn signed_cell(p: vec3<u32>) -> vec3<i32> {
    return (bitcast<vec3<i32>>(p - vec3<u32>(MARGIN)) >> vec3<u32>(CELL_BITS)) + vec3<i32>(i32(MARGIN >> CELL_BITS));
}

// A position packed into one word for the search of neighbours: 10 bits per axis, in 1/128 of a cell,
// modulo 8 cells, and no more than a cell beyond the grid, so that the word and the cell (`nearest_cell`) tell the place;
// the top bit marks a cell near a wall that can part two particles, the next a point that is beyond its
// cell (`nearest_cell`).
const NEAR_WALL: u32 = 0x80000000;
const ASTRAY: u32 = 0x40000000;

fn packed(p: vec3<u32>) -> u32 {
    let cell = i32(1u << CELL_BITS);
    let end = (vec3<u32>(CELLS_X, CELLS_Y, CELLS_Z) << vec3<u32>(CELL_BITS)) - vec3<u32>(MARGIN);
    let inside = clamp(bitcast<vec3<i32>>(p - vec3<u32>(MARGIN)), vec3<i32>(-i32(MARGIN) - cell), bitcast<vec3<i32>>(end) + cell - 1);
    let q = ((bitcast<vec3<u32>>(inside) + MARGIN) >> vec3<u32>(CELL_BITS - 7u)) & vec3<u32>(1023u);
    return q.x | (q.y << 10u) | (q.z << 20u);
}

// b - a of two packed positions, in 1/128 cells.
fn packed_between(a: u32, b: u32) -> vec3<i32> {
    let x = extractBits(i32(b & 1023u) - i32(a & 1023u), 0u, 10u);
    let y = extractBits(i32((b >> 10u) & 1023u) - i32((a >> 10u) & 1023u), 0u, 10u);
    let z = extractBits(i32((b >> 20u) & 1023u) - i32((a >> 20u) & 1023u), 0u, 10u);
    return vec3<i32>(x, y, z);
}

// The cell of a point that may lie outside the grid (the mid-step point of a fast particle beyond a
// wall): the nearest cell that has all its neighbours. Only the cell is moved, never the particle.
fn nearest_cell(p: vec3<u32>) -> vec3<u32> {
    let c = signed_cell(p);
    let last = vec3<i32>(i32(CELLS_X), i32(CELLS_Y), i32(CELLS_Z)) - 2;
    return vec3<u32>(clamp(c, vec3<i32>(1), last));
}
