//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl newborn.wgsl lists.wgsl coarse.wgsl cap.wgsl
// The flights with which the particles start the step; those that may meet a wall are to be completed (complete_lists.wgsl).
//
// Reads `sorted`, `cells`, `layers`, `newborns`, `shares`, the number of particles behind `cell_start`; writes `flights`, and appends to the second words of
// `choices`. One thread per particle, which writes its own flight. Flights are where the particles were from which they have been sorted, so `order` cannot write them.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(8) var<storage, read> cell_start: array<u32>;
@group(0) @binding(10) var<storage, read> sorted: array<Packed>;
@group(0) @binding(11) var<storage, read_write> flights: array<vec4<u32>>;
@group(0) @binding(15) var<storage, read_write> choices: array<vec2<u32>>;
@group(0) @binding(27) var<storage, read> cells: array<u32>;
@group(0) @binding(32) var<storage, read> layers: array<u32>;
@group(0) @binding(53) var<storage, read> shares: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn start_flights(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let s = linear(id, groups);
    if (s >= min(step.total, cell_start[step.bins])) {
        return;
    }
    var start = 0.0;
    if (step.newborns > 0u) {
        start = birth_time(id_of(sorted[s].place.w));
    }
    var share = 0u;
    if (CAPPED) {
        share = shares[block_of(cell_of(cells[s]))];
    }
    flights[2u * s] = packed_flight(Flight(start, NEVER, NOBODY, share << SHARE_AT));
    if ((layers[s] & NEAR) != 0u) {
        choices[append(LIST_INCOMPLETE)].y = s;
    }
}
