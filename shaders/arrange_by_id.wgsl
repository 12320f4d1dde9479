//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lay.wgsl place_by_id.wgsl
//! phase: sort
// Sort of the method `half-turn`, part 2: the particles by cell, and in each by id.
//
// Reads `bins`, `cell_start`, `slots`, `particles`; writes `sorted` (lay.wgsl). One thread per particle as they lie in `particles`.

var<storage, read> bins: array<vec2<u32>>;

@compute @workgroup_size(WORKGROUP)
fn arrange_by_id(thread: Thread) {
    let i = linear(thread);
    if (step.peers > 0u) {
        lay_nobody(i, cell_start[step.bins]);
    }
    if (i >= step.count + step.newborns + step.arrivals) {
        return;
    }
    let bin = bins[i].x;
    if (bin != NOBODY) {
        lay(i, place_by_id(bin, id_of(particles[i].position_tag.w)), bin);
    }
}
