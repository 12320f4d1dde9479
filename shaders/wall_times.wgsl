//! uses: step.wgsl grid.wgsl particle.wgsl lists.wgsl walls.wgsl
// When the flights that may meet a wall meet it.
//
// Reads `near_walls`, `sorted` and the walls; writes `flights`. One thread per entry of `near_walls`,
// each of which writes its own flight.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(10) var<storage, read> sorted: array<Particle>;
@group(0) @binding(11) var<storage, read_write> flights: array<vec4<u32>>;
@group(0) @binding(24) var<storage, read> near_walls: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn wall_times(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = linear(id, groups);
    if (entry >= atomicLoad(&counters[LIST_NEAR_WALLS])) {
        return;
    }
    let s = near_walls[entry];
    var flight = flight_of(flights[2u * s]);
    flight.wall = first_hit(sorted[s].position, sorted[s].velocity, flight.start, step.dt).time;
    flights[2u * s] = packed_flight(flight);
    tell_cut_short();
}
