//! uses: step.wgsl particle.wgsl local.wgsl grid.wgsl
//! phase: sort
// Sort of the method `half-turn`, part 1: the ids to the places of their cells, in the order of the threads.
//
// Reads `bins`, `cell_start`, `particles`; writes `slots`. One thread per particle as they lie in `particles`.

var<uniform> step: Step;
var<storage, read> bins: array<vec2<u32>>;
var<storage, read> cell_start: array<u32>;
var<storage, read> particles: array<Packed>;
var<storage, read_write> slots: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn list_ids(thread: Thread) {
    let i = linear(thread);
    if (i >= step.count + step.newborns + step.arrivals) {
        return;
    }
    let bin = bins[i];
    if (bin.x != NOBODY) {
        slots[cell_start[bin.x] + bin.y] = id_of(particles[i].position_tag.w);
    }
}
