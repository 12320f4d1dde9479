//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl walls.wgsl cell_gas.wgsl lay.wgsl place_by_id.wgsl
//! phase: sort
// Sort of the method `cell`, in cells that `collide` does not put in order: their particles by id, and where walls at rest part the gas the part
// of each.
//
// A particle belongs to the first part whose point it sees, or if it sees none, to the one with the nearest point.
//
// Reads `crowded`, `bins`, `cell_start`, `slots`, `particles`, `cell_volume`, `cell_parts` and the walls; writes `sorted` and `marks` (lay.wgsl). One thread
// per entry of `crowded`.

var<storage, read> bins: array<vec2<u32>>;
var<storage, read> crowded: array<u32>;
var<storage, read> cell_parts: array<Part>;

// Walls part the gas of some cell.
override DIVIDED_GAS: bool = true;

fn part_of(place: vec3<u32>, first: u32, parts: u32) -> u32 {
    var nearest = 0u;
    var least = NEVER;
    for (var part = 0u; part < parts; part++) {
        let away = between(place, cell_parts[first + part].place);
        if (!blocked(place, cell_parts[first + part].place, 0.0)) {
            return part;
        }
        if (dot(away, away) < least) {
            nearest = part;
            least = dot(away, away);
        }
    }
    return nearest;
}

@compute @workgroup_size(WORKGROUP)
fn arrange_crowded(thread: Thread) {
    let place_in_list = linear(thread);
    if (place_in_list >= atomicLoad(&counters[LIST_CROWDED])) {
        return;
    }
    let i = crowded[place_in_list];
    let cell = bins[i].x;
    let place = place_by_id(cell, id_of(particles[i].position_tag.w));
    lay(i, place, cell);
    // (Where walls may be that move `collide_moved` finds the parts.)
    if (DIVIDED_GAS && !moving_in(cell_of(cell))) {
        let entry = cell_volume[index_of(cell)];
        if ((entry & DIVIDED) != 0u) {
            marks[place] = part_of(particles[i].position_tag.xyz, first_part(entry), parts_of(entry)) << PART_SHIFT;
            tell_cut_short();
        }
    }
}
