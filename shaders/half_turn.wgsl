//! uses: step.wgsl grid.wgsl local.wgsl lists.wgsl relaxed.wgsl
//! phase: collide
// The collisions of the method `half-turn` in cells that no wall cuts.
//
// Reads `collision_cells`; reads and writes `sorted`. One thread per entry of `collision_cells`; each works on its own particles, in the order of
// their cells, and in a cell of their ids.

var<storage, read> collision_cells: array<vec2<u32>>;

fn member(begin: u32, k: u32) -> u32 {
    return begin + k;
}

@compute @workgroup_size(WORKGROUP)
fn half_turn(thread: Thread) {
    let place_in_list = linear(thread);
    if (place_in_list >= atomicLoad(&counters[LIST_COLLISION_CELLS])) {
        return;
    }
    let entry = collision_cells[place_in_list];
    relax(entry.x, entry.y - entry.x, 0u);
    tell_cut_short();
}
