//! uses: step.wgsl local.wgsl particle.wgsl add64.wgsl
//! binds: histogram as sums
//! phase: blocks weigh
// Where the work of the last step was: sums of the particles' weights over the planes of cells of the boxes
// that are to be cut (recursive coordinate bisection), and the entries of all neighbour lists, those of ghosts apart.
//
// Reads `cells`, `marks`, `neighbour_count` and the tree of cuts so far, `cuts`; writes the integer tally `sums`,
// two words a plane. One thread per particle, which descends the tree; ghosts are weighed by their owners.
// Sums of integers do not depend on order.

// A particle's weight, and what each entry of its neighbour list and a possible wall add.
struct Weights {
    particle: u32,
    candidate: u32,
    wall: u32,
    // Entries of `cuts` to descend; 0: only count.
    cuts: u32,
}

const OPEN: u32 = 3;

// Cells per edge, log2, of what boxes are made of: tiles with the method `half-turn`.
override BOX_BITS: u32 = 0;

var<uniform> step: Step;
var<storage, read_write> counters: array<atomic<u32>>;
var<storage, read> neighbour_count: array<u32>;
var<storage, read_write> sums: array<atomic<u32>>;
var<storage, read> cells: array<u32>;
var<storage, read> marks: array<u32>;
var<uniform> weights: Weights;
// A cut: axis, plane, the entries below and above. An open box: OPEN, the axis to cut, its lowest plane, its
// place in the histogram. A part: OPEN + 1.
var<storage, read> cuts: array<vec4<u32>>;

@compute @workgroup_size(WORKGROUP)
fn weigh(thread: Thread) {
    let s = linear(thread);
    if (s >= step.total) {
        return;
    }
    let mark = marks[s];
    // Neighbours of the outermost ghosts are no candidates (on_demand.wgsl).
    let listed = select(neighbour_count[s], 0u, step.depth > 0u && (mark & LAYER) >= step.depth);
    if (weights.cuts == 0u) {
        atomicAdd(&counters[CANDIDATES], listed);
        if ((mark & LAYER) != 0u) {
            atomicAdd(&counters[GHOST_CANDIDATES], listed);
            atomicAdd(&counters[GHOST_WALLS], select(0u, 1u, (mark & NEAR) != 0u));
        }
        return;
    }
    if ((mark & LAYER) != 0u) {
        return;
    }
    let cell = (cell_of(cells[s]) - shift_of(step.lattice)) >> vec3<u32>(BOX_BITS);
    var node = cuts[0];
    while (node.x < OPEN) {
        node = cuts[select(node.w, node.z, cell[node.x] < node.y)];
    }
    if (node.x == OPEN) {
        let weight = weights.particle + weights.candidate * listed + select(0u, weights.wall, (mark & NEAR) != 0u);
        add64(2u * (node.w + cell[node.y] - node.z), weight, 0u);
    }
}
