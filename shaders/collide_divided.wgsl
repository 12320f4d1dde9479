//! uses: step.wgsl grid.wgsl local.wgsl walls.wgsl parts.wgsl cell_gas.wgsl
//! phase: collide
// The collisions of the method `cell`, in cells that walls part: each part of the gas by itself.
//
// Pairs that a wall parts do not collide (where the gas of a part is not convex; the volumes allow for it).
//
// Reads `divided`, `cell_start`, `cell_volume`, `cell_parts`, `newborns`, the part of each particle in `marks` (arrange_crowded.wgsl) and the
// walls; reads and writes `sorted`, and of its own cell `order_by_id`. One thread per entry of `divided`; each works on its own cell.

var<storage, read> divided: array<u32>;
var<storage, read> cell_parts: array<Part>;

fn hidden(s: u32, t: u32) -> bool {
    return blocked(sorted[s].position_tag.xyz, sorted[t].position_tag.xyz, 0.0);
}

@compute @workgroup_size(WORKGROUP)
fn collide_divided(thread: Thread) {
    let place_in_list = linear(thread);
    if (place_in_list >= atomicLoad(&counters[LIST_DIVIDED])) {
        return;
    }
    let bin = divided[place_in_list];
    let cell = index_of(bin);
    let entry = cell_volume[cell];
    let parts = parts_of(entry);
    let begin = cell_start[bin];
    let end = last_of(begin, cell_start[bin + 1u]);
    var candidates = 0u;
    var part = 0u;
    for (; part < parts; part++) {
        candidates += collide_part(begin, end, cell_parts[first_part(entry) + part].volume, cell, part);
    }
    through(part, parts);
    tell_candidates(begin, candidates);
    tell_cut_short();
}
