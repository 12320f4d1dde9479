//! uses: step.wgsl grid.wgsl particle.wgsl lists.wgsl walls.wgsl
// Takes from the neighbour lists near walls those that stand behind a wall where their flights start.
//
// Reads `sorted`, `flights` and the walls; reads and writes `neighbours`, `neighbour_count`. One thread
// per entry of `screened`. The test of a pair takes the lower id first, so both sides agree.

@group(0) @binding(10) var<storage, read> sorted: array<Particle>;
@group(0) @binding(11) var<storage, read> flights: array<Flight>;
@group(0) @binding(13) var<storage, read_write> neighbours: array<u32>;
@group(0) @binding(14) var<storage, read_write> neighbour_count: array<u32>;
@group(0) @binding(25) var<storage, read> screened: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn screen(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = linear(id, groups);
    if (entry >= atomicLoad(&counters[LIST_SCREEN])) {
        return;
    }
    let s = screened[entry];
    let stride = arrayLength(&neighbour_count);
    let listed = neighbour_count[s];
    let tag = sorted[s].tag;
    let place = shifted(sorted[s].position, sorted[s].velocity * flights[s].start);
    var kept = 0u;
    for (var k = 0u; k < listed; k++) {
        let j = neighbours[k * stride + s];
        let there = shifted(sorted[j].position, sorted[j].velocity * flights[j].start);
        let first = id_of(tag) < id_of(sorted[j].tag);
        if (!blocked(select(there, place, first), select(place, there, first))) {
            neighbours[kept * stride + s] = j;
            kept++;
        }
    }
    neighbour_count[s] = kept;
}
