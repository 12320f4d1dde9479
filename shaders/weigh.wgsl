//! uses: step.wgsl local.wgsl grid.wgsl particle.wgsl add64.wgsl fabric.wgsl
//! binds: histogram as sums
//! phase: blocks weigh
// Where the work of the last step was: sums of the particles' weights over the planes of cells of the boxes
// that are to be cut (recursive coordinate bisection), and the entries of all neighbour lists and of the lists of fabric of the particles'
// cells, those of ghosts apart.
//
// Reads `cells`, `marks`, `neighbour_count`, where fabric was, and the tree of cuts so far, `cuts`; writes the integer tally `sums`,
// two words a plane. One thread per particle, which descends the tree; ghosts are weighed by their owners.
// Sums of integers do not depend on order.

// A particle's weight, and what each entry of its neighbour list, a possible wall and each triangle of fabric in its cell add.
struct Weights {
    particle: u32,
    candidate: u32,
    wall: u32,
    sheet: u32,
    // Entries of `cuts` to descend; 0: only count.
    cuts: u32,
}

const OPEN: u32 = 3;

// Triangles of a cell that are counted, at most: a weight has 32 bits.
const MOST_SHEETS: u32 = 65536u;
// Cells per edge, log2, of what boxes are made of: tiles with the method `half-turn`.
override BOX_BITS: u32 = 0;

var<uniform> step: Step;
var<storage, read_write> counters: array<atomic<u32>>;
var<storage, read> neighbour_count: array<u32>;
var<storage, read_write> sums: array<atomic<u32>>;
var<storage, read> cells: array<u32>;
var<storage, read> marks: array<u32>;
var<uniform> weights: Weights;
var<storage, read> fabric_cells: array<u32>;
var<storage, read> fabric_entries: array<vec4<u32>>;
// A cut: axis, plane, the entries below and above. An open box: OPEN, the axis to cut, its lowest plane, its
// place in the histogram. A part: OPEN + 1.
var<storage, read> cuts: array<vec4<u32>>;

// How many triangles of fabric may touch a cell.
fn sheets_at(cell: vec3<u32>) -> u32 {
    if (!FABRIC || !has_fabric_list(cell)) {
        return 0u;
    }
    let listed = fabric_cells[FABRIC_FIRST + fabric_list(cell)];
    if (listed == 0u) {
        return 0u;
    }
    var count = 0u;
    var next = fabric_entries[arrayLength(&fabric_entries) / 2u + listed - 1u].z;
    while (next != 0u && count < MOST_SHEETS) {
        count++;
        next = fabric_entries[next - 1u].y;
    }
    return count;
}

@compute @workgroup_size(WORKGROUP)
fn weigh(thread: Thread) {
    let s = linear(thread);
    if (s >= step.total) {
        return;
    }
    let mark = marks[s];
    // Neighbours of the outermost ghosts are no candidates (on_demand.wgsl).
    let listed = select(neighbour_count[s], 0u, step.depth > 0u && (mark & LAYER) >= step.depth);
    let cell = cell_of(cells[s]);
    let sheets = sheets_at(cell);
    if (weights.cuts == 0u) {
        atomicAdd(&counters[CANDIDATES], listed);
        atomicAdd(&counters[SHEETS], sheets);
        if ((mark & LAYER) != 0u) {
            atomicAdd(&counters[GHOST_CANDIDATES], listed);
            atomicAdd(&counters[GHOST_SHEETS], sheets);
            atomicAdd(&counters[GHOST_WALLS], select(0u, 1u, (mark & NEAR) != 0u));
        }
        return;
    }
    if ((mark & LAYER) != 0u) {
        return;
    }
    let plane = (cell - shift_of(step.lattice)) >> vec3<u32>(BOX_BITS);
    var node = cuts[0];
    while (node.x < OPEN) {
        node = cuts[select(node.w, node.z, plane[node.x] < node.y)];
    }
    if (node.x == OPEN) {
        let weight = weights.particle + weights.candidate * listed + select(0u, weights.wall, (mark & NEAR) != 0u)
            + weights.sheet * sheets;
        add64(2u * (node.w + plane[node.y] - node.z), weight, 0u);
    }
}
