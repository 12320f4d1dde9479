// The cells that have bins on this device: a box of the one global grid, in the grid's order, so that the
// order of the cells is the same on every device.

// There are others. Only kernels may ask whose results are no matter of floating point: others would be other pipelines on one device than
// on several, and a driver may round otherwise in each.
override HALO: bool = true;

// With the method `half-turn` bins are in the order of tiles of 4^3 cells, and within a tile so that each half, and each half of a half, is one
// stretch of bins. Where the tiles begin, one cell farther in every other step, and along which axis they are halved first, go with the number of the
// step (`step.lattice`, of six): no wall or front lies in the same place of a tile for long, and no direction is preferred.
override TILED: bool = false;
const TILE_BITS: u32 = 2;
const TILE_EDGE: u32 = 4;
const TILE_CELLS: u32 = 64;

// The tiles' first cell, along each axis, of a lattice.
fn shift_of(lattice: u32) -> u32 {
    return lattice & 1u;
}

fn turned_axes(v: vec3<u32>, lattice: u32) -> vec3<u32> {
    let turn = lattice % 3u;
    return select(select(v, v.yzx, turn == 1u), v.zxy, turn == 2u);
}

fn tiled_index(c: vec3<u32>, low: vec3<u32>, lattice: u32) -> u32 {
    let o = c - low;
    let tiles = step.size >> vec3<u32>(TILE_BITS);
    let tile = o >> vec3<u32>(TILE_BITS);
    let q = turned_axes(o & vec3<u32>(3u), lattice);
    let high = q >> vec3<u32>(1u);
    let within = q & vec3<u32>(1u);
    let place = (high.z << 5u) | (high.y << 4u) | (high.x << 3u) | (within.z << 2u) | (within.y << 1u) | within.x;
    return ((tile.z * tiles.y + tile.y) * tiles.x + tile.x) * TILE_CELLS + place;
}

fn tiled_cell(bin: u32) -> vec3<u32> {
    let tiles = step.size >> vec3<u32>(TILE_BITS);
    let tile = bin / TILE_CELLS;
    let row = tile / tiles.x;
    let bits = (vec3<u32>(bin) >> vec3<u32>(0u, 1u, 2u)) & vec3<u32>(1u);
    let high = (vec3<u32>(bin) >> vec3<u32>(3u, 4u, 5u)) & vec3<u32>(1u);
    // Turned back.
    let q = turned_axes(2u * high + bits, 3u - step.lattice % 3u);
    return step.low + TILE_EDGE * vec3<u32>(tile % tiles.x, row % tiles.y, row / tiles.y) + q;
}

// The bin of a cell; only for cells of the box.
fn local_index(c: vec3<u32>) -> u32 {
    if (TILED) {
        return tiled_index(c, step.low, step.lattice);
    }
    let o = c - step.low;
    return (o.z * step.size.y + o.y) * step.size.x + o.x;
}

// The cell of a bin.
fn cell_of(bin: u32) -> vec3<u32> {
    if (TILED) {
        return tiled_cell(bin);
    }
    let row = bin / step.size.x;
    return step.low + vec3<u32>(bin % step.size.x, row % step.size.y, row / step.size.y);
}

fn in_box(c: vec3<u32>, low: vec3<u32>, high: vec3<u32>) -> bool {
    return all(c >= low) && all(c < high);
}

// Layers of cells between a cell and the own ones; 0 in them.
fn layer_of(c: vec3<u32>) -> u32 {
    let below = select(step.own_low - c, vec3<u32>(0u), c >= step.own_low);
    let above = select(c + 1u - step.own_high, vec3<u32>(0u), c < step.own_high);
    let away = max(below, above);
    return max(away.x, max(away.y, away.z));
}

// `marks` holds a particle's layer (0 of the own, halo.wgsl) and these marks: another device may have it as a ghost; it is in the list
// `changed`; it may meet a wall in this step; it is in the list `on_demand`, its neighbours have been searched; its list of neighbours
// is yet to be screened, is yet to get its tail; it may meet a wall after a collision. Above them is a bit for each round: it is in the list of those that choose in it, or one of the
// outermost ghosts, who never are. (Where nobody chooses, the part of a particle in its cell is kept there, cell_gas.wgsl.)
const LAYER: u32 = 0xff;
const SHARED: u32 = 0x100;
const LISTED: u32 = 0x200;
const NEAR: u32 = 0x400;
const REQUESTED: u32 = 0x800;
const SEARCHED: u32 = 0x1000;
const UNSCREENED: u32 = 0x2000;
const LONG: u32 = 0x4000;
const INCOMPLETE: u32 = 0x6000;
const TURNED_TO_WALL: u32 = 0x8000;
const CHOOSES: u32 = 0x10000;
