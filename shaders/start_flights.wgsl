//! uses: step.wgsl grid.wgsl midpoint.wgsl coarse.wgsl first_flight.wgsl
//! phase: sort
// The flights with which the particles start the step, where their diameters are capped, which the search asks them for; else the search starts them.
//
// Reads `sorted`, `newborns`, `cross_section_shares`, the number of particles behind `cell_start`; writes `flights`. One thread per particle, which writes
// its own flight. Flights are where the particles were from which they have been sorted, so `order` cannot write them.

var<uniform> step: Step;
var<storage, read> cell_start: array<u32>;
var<storage, read_write> flights: array<vec4<u32>>;
var<storage, read> cross_section_shares: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn start_flights(thread: Thread) {
    let s = linear(thread);
    if (s >= min(step.total, cell_start[step.bins])) {
        return;
    }
    let midpoint = midpoint_of(sorted[s].position_tag.xyz, sorted[s].motion.xyz);
    flights[2u * s] = first_flight(s, cross_section_shares[block_of(nearest_cell(midpoint))]);
}
