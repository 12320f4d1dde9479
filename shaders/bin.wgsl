//! uses: step.wgsl grid.wgsl local.wgsl lists.wgsl entering.wgsl flown.wgsl
//! phase: bin
// Puts the newborns behind the particles, counts the particles of each cell, by their mid-step position (by that at the start of the step, where collisions
// are then), and finds those that other devices need.
//
// Reads `particles` and `newborns`; writes `particles[count ..]`, `bins` (bin and slot within the cell, or NOBODY for a particle that neither is
// owned here nor lies in the halo) and `cell_counts` (zero before), and appends the
// earlier particles in cells that others own or have in their halo to `border` (slot, cell). One thread per slot. The slot
// within the cell depends on the order of the threads; where an order matters it is replaced by the rank of the id (arrange_crowded.wgsl). On a device that is stalled
// (STALLED) nobody is in any cell, and nobody enters.

override ROUNDS_OF_PAIRS: bool = true;

var<uniform> step: Step;
var<storage, read> stalled: array<u32>;
var<storage, read_write> particles: array<Packed>;
var<storage, read_write> bins: array<vec2<u32>>;
var<storage, read_write> cell_counts: array<atomic<u32>>;
var<storage, read_write> border: array<vec2<u32>>;

@compute @workgroup_size(WORKGROUP)
fn bin(thread: Thread) {
    let i = step.first + linear(thread);
    if (i >= step.count + step.newborns + step.arrivals) {
        return;
    }
    if ((ROUNDS_OF_PAIRS && stalled[STALLED] > 0u) || !enter(i)) {
        bins[i] = vec2<u32>(NOBODY, 0u);
        return;
    }
    let place = particles[i].position_tag;
    let cell = flown_cell(place.xyz, particles[i].motion.xyz);
    let there = place.w != NOBODY;
    // bench: binned
    if (there && has_bin(cell)) {
        let index = local_index(cell);
        bins[i] = vec2<u32>(index, atomicAdd(&cell_counts[index], 1u));
    } else {
        bins[i] = vec2<u32>(NOBODY, 0u);
        atomicAdd(&counters[COUNT_DROPPED], 1u);
    }
    if (there) {
        if (i >= step.count + step.newborns && in_box(cell, step.own_low, step.own_high)) {
            atomicAdd(&counters[MOVED], 1u);
        }
        // Every device has the newborns of its own cells and halo by itself; arrivals are sent by no other.
        if (step.peers > 0u && i < step.count && !in_box(cell, step.inner_low, step.inner_high)) {
            border[append(LIST_BORDER)] = vec2<u32>(i, cell_index(cell));
        }
    }
}
