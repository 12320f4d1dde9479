//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl counters.wgsl lists.wgsl touch.wgsl update.wgsl
// Update, part 2: what the owners of the ghosts did to them.
//
// Reads `updates_in`, `cell_start`; writes `sorted` and `flights`, and lets the particles around choose again.
// One thread per update, each of another ghost, which is found in its cell by its id; one that is not there
// is counted, and the host stops the run.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(8) var<storage, read> cell_start: array<u32>;
@group(0) @binding(10) var<storage, read_write> sorted: array<Particle>;
@group(0) @binding(11) var<storage, read_write> flights: array<Flight>;
@group(0) @binding(39) var<storage, read> updates_in: array<Update>;

@compute @workgroup_size(WORKGROUP)
fn receive(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    // The first entry says how many follow.
    let entry = linear(id, groups) + 1u;
    if (entry > updates_in[0].cell) {
        return;
    }
    let tag = updates_in[entry].particle.tag;
    let bin = local_index(global_cell(updates_in[entry].cell));
    let end = cell_start[bin + 1u];
    var place = cell_start[bin];
    while (place < end && sorted[place].tag != tag) {
        place++;
    }
    if (place == end) {
        atomicAdd(&counters[MISSING], 1u);
        return;
    }
    sorted[place] = updates_in[entry].particle;
    flights[place] = updates_in[entry].flight;
    let corner = bin - step.size.x * step.size.y - step.size.x - 1u;
    for (var row = 0u; row < 9u; row++) {
        let first = corner + (row / 3u) * step.size.x * step.size.y + (row % 3u) * step.size.x;
        let last = cell_start[first + 3u];
        for (var j = cell_start[first]; j < last; j++) {
            touch(j);
        }
    }
}
