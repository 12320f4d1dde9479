//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl on_demand.wgsl touch.wgsl touch_neighbours.wgsl neighbour_list.wgsl listed.wgsl update.wgsl coarse.wgsl cap.wgsl nearness.wgsl
//! binds: rechoose_dispatches as dispatches
//! phase: update
// Update, part 2: what the owners of the ghosts did to them.
//
// Reads `updates_in`, `cell_start`, `marks`, the lists of neighbours behind the flights, `midpoints`; writes `sorted` and `flights`, and lets the ghost choose
// again and those who may have it in their lists.
// One thread per update, each of another ghost, which is found in its cell by its id; one that is not there
// is counted, and the host stops the run.

var<uniform> step: Step;
var<storage, read> cell_start: array<u32>;
var<storage, read_write> sorted: array<Packed>;
var<storage, read_write> flights: array<vec4<u32>>;
var<storage, read> midpoints: array<u32>;
var<storage, read> updates_in: array<Update>;

// Those who choose and may have a particle in their lists that has none itself, or not all of it.
fn touch_around(s: u32, cell: vec3<u32>, thread: u32) {
    let midpoint = midpoints[s];
    let near = near2(FULL_SHARE);
    // In layers of cells farther out nobody chooses.
    let around = step.depth - 1u;
    let low = max(cell - 1u, max(step.own_low, vec3<u32>(around)) - around);
    let high = min(cell + 2u, step.own_high + around);
    for (var z = low.z; z < high.z; z++) {
        for (var y = low.y; y < high.y; y++) {
            let row = local_index(vec3<u32>(low.x, y, z));
            let last = cell_start[row + max(high.x, low.x) - low.x];
            for (var j = cell_start[row]; j < last; j++) {
                let away = packed_between(midpoint, midpoints[j]);
                if (dot(away, away) < near && (atomicLoad(&marks[j]) & LAYER) < step.depth) {
                    touch(j, thread);
                }
            }
        }
    }
}

@compute @workgroup_size(WORKGROUP)
fn receive(thread: Thread) {
    // (Of those that run together all must be of one part of the list that they append to.)
    let number = linear(thread);
    // The first entry says how many follow.
    let entry = number + 1u;
    if (entry > updates_in[0].cell) {
        return;
    }
    let after = packed_of(updates_in[entry].particle);
    let cell = global_cell(updates_in[entry].cell);
    let bin = local_index(cell);
    let end = cell_start[bin + 1u];
    var s = cell_start[bin];
    while (s < end && sorted[s].position_tag.w != after.position_tag.w) {
        s++;
    }
    if (s == end) {
        atomicAdd(&counters[MISSING], 1u);
        return;
    }
    sorted[s] = after;
    flights[2u * s] = packed_flight(updates_in[entry].flight);
    if (updates_in[entry].flight.wall < step.dt) {
        atomicOr(&marks[s], TURNED_TO_WALL);
    }
    touch(s, number);
    let layer = atomicLoad(&marks[s]) & LAYER;
    if (has_list_at(layer) || (notes_at(layer) && neighbour_count[s] <= DIRECT)) {
        touch_neighbours(neighbour_count[s], direct_of(s), 0u, vec4<u32>(0u), number);
    } else {
        touch_around(s, cell, number);
    }
    tell_cut_short();
}
