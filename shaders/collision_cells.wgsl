//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl walls.wgsl
//! phase: collide
// Divides the gas into the collision cells of the method `half-turn`.
//
// A tile of 4^3 cells is halved, and its halves again, while they hold more than MOST_MEMBERS particles and more than one cell. The bins
// of each half lie one behind the other (local.wgsl), so its particles do. What is left is a collision cell: where gas is dense a cell of the grid, where it is thin
// a whole tile.
//
// Reads `cell_start`, `parting` and `motions`; appends collision cells of two particles and more to `collision_cells`, or where a wall may stand between
// two of them to `cut_cells`, each with its first particle and the end, and what cuts it. One thread per bin; that of a collision cell's first bin does it. The order of the lists is no matter:
// each entry has particles of its own.

// Collision cells of more particles are halved.
override MOST_MEMBERS: u32 = 21;
// Walls at rest may stand between particles somewhere.
override DIVIDED_GAS: bool = true;

var<uniform> step: Step;
var<storage, read> cell_start: array<u32>;
var<storage, read_write> collision_cells: array<vec2<u32>>;
var<storage, read_write> cut_cells: array<vec2<u32>>;

// What may stand between two particles of these bins. What `may_part` says of a cell is of those around it, too: of cells
// that are four wide two are asked along each axis.
fn cut_by(first: u32, bins: u32) -> u32 {
    let low = cell_of(first);
    let high = cell_of(first + bins - 1u);
    let last = vec3<u32>(CELLS_X, CELLS_Y, CELLS_Z) - 1u;
    var is_near = false;
    var found = 0u;
    for (var z = low.z; z <= high.z; z += 2u) {
        for (var y = low.y; y <= high.y; y += 2u) {
            for (var x = low.x; x <= high.x; x += 2u) {
                let c = min(vec3<u32>(x, y, z), last);
                if (wall_may_part(c)) {
                    found = CUT_BY_WALLS;
                }
                is_near = is_near || (FABRIC && near_fabric(c));
            }
        }
    }
    // (Of fabric it is enough to ask these cells.)
    if (is_near && any_fabric(Cells(low, min(high, last)))) {
        found |= CUT_BY_FABRIC;
    }
    return found;
}

@compute @workgroup_size(WORKGROUP)
fn collision_cells_of(thread: Thread) {
    let bin = linear(thread);
    if (bin >= step.bins) {
        return;
    }
    var first = bin & ~(TILE_CELLS - 1u);
    var bins = TILE_CELLS;
    var begin = cell_start[first];
    var end = cell_start[first + bins];
    // bench: halved
    while (bins > 1u && end - begin > MOST_MEMBERS) {
        bins /= 2u;
        let middle = cell_start[first + bins];
        if (bin < first + bins) {
            end = middle;
        } else {
            begin = middle;
            first += bins;
        }
    }
    if (bin != first || end == begin) {
        return;
    }
    if (end - begin == 1u) {
        atomicAdd(&counters[FREE_FLIGHTS], 1u);
        return;
    }
    var cut = 0u;
    if (DIVIDED_GAS || MOVING || FABRIC) {
        cut = cut_by(first, bins);
    }
    if (cut != 0u) {
        cut_cells[append(LIST_CUT_CELLS)] = vec2<u32>(begin, end | cut);
    } else {
        collision_cells[append(LIST_COLLISION_CELLS)] = vec2<u32>(begin, end);
    }
}
