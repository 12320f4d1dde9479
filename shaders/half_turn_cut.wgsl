//! uses: step.wgsl grid.wgsl local.wgsl lists.wgsl walls.wgsl relaxed.wgsl
//! phase: collide
// The collisions of the method `half-turn` in cells that walls cut: in groups of particles that see one another.
//
// The particle of the lowest id that is in no group begins one, with all that it sees and that are in none. So it goes on until each is in a
// group, however many there are; one that is alone in its group flies on.
//
// Reads `cut_cells` and the walls; reads and writes `sorted`, the group of each particle in `marks`, and of its own cell `order_by_id`. One thread per
// entry of `cut_cells`; each works on its own particles. Collisions are at the start of the step.

var<storage, read> cut_cells: array<vec2<u32>>;
// The group of each particle in the upper half of its word (the lower is the exchange's).
var<storage, read_write> marks: array<u32>;
// The places of a group's particles.
var<storage, read_write> order_by_id: array<u32>;

const IN_NO_GROUP: u32 = 0xffff;
const GROUP_SHIFT: u32 = 16;

fn member(begin: u32, k: u32) -> u32 {
    return order_by_id[begin + k];
}

fn group_at(s: u32) -> u32 {
    return marks[s] >> GROUP_SHIFT;
}

fn put_in_group(s: u32, group: u32) {
    marks[s] = (marks[s] & 0xffffu) | (group << GROUP_SHIFT);
}

// The place of the lowest id that is in no group, or NOBODY.
fn first_alone(begin: u32, end: u32) -> u32 {
    var found = NOBODY;
    var least = NOBODY;
    var s = begin;
    for (; s < end; s++) {
        let id = id_of(sorted[s].position_tag.w);
        if (group_at(s) == IN_NO_GROUP && id < least) {
            found = s;
            least = id;
        }
    }
    through(s, end);
    return found;
}

@compute @workgroup_size(WORKGROUP)
fn half_turn_cut(thread: Thread) {
    let place_in_list = linear(thread);
    if (place_in_list >= atomicLoad(&counters[LIST_CUT_CELLS])) {
        return;
    }
    let begin = cut_cells[place_in_list].x;
    let end = cut_cells[place_in_list].y;
    for (var s = begin; s < end; s++) {
        put_in_group(s, select(IN_NO_GROUP, IN_NO_GROUP - 1u, is_newborn(id_of(sorted[s].position_tag.w))));
    }
    var group = 0u;
    var pivot = first_alone(begin, end);
    while (pivot != NOBODY && group < IN_NO_GROUP - 1u) {
        let place = sorted[pivot].position_tag.xyz;
        var count = 0u;
        for (var s = begin; s < end; s++) {
            if (group_at(s) == IN_NO_GROUP && (s == pivot || !blocked(place, sorted[s].position_tag.xyz, 0.0))) {
                put_in_group(s, group);
                order_by_id[begin + count] = s;
                count++;
            }
        }
        relax(begin, count, group);
        group++;
        pivot = first_alone(begin, end);
    }
    atomicAdd(&counters[CUT_GROUPS], group);
    tell_cut_short();
}
