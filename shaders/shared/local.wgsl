// The cells that have bins on this device: a box of the one global grid, in the grid's order, so that the
// order of the cells is the same on every device.

// There are others. Only kernels may ask whose results are no matter of floating point: others would be other pipelines on one device than
// on several, and a driver may round otherwise in each.
override HALO: bool = true;

// The bin of a cell; only for cells of the box.
fn local_index(c: vec3<u32>) -> u32 {
    let o = c - step.low;
    return (o.z * step.size.y + o.y) * step.size.x + o.x;
}

// The cell of a bin.
fn cell_of(bin: u32) -> vec3<u32> {
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
