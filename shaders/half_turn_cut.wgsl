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

// The cells that particles are in.
fn cells_of_all(begin: u32, end: u32) -> Cells {
    var cells = cells_of(sorted[begin].position_tag.xyz, sorted[begin].position_tag.xyz);
    var s = begin;
    for (; s < end; s++) {
        let own = cells_of(sorted[s].position_tag.xyz, sorted[s].position_tag.xyz);
        cells = Cells(min(cells.low, own.low), max(cells.high, own.high));
    }
    through(s, end);
    return cells;
}

// The slab that all fabric of some cells is in, seen from the middle of the first one: of each record, whose normal is n, there is where k = n . t
//
//     t . x = k/n^2 n . x + (t - k/n^2 n) . x, of which the last term is at most half a cell times the sum of the vector's sizes.
fn slab_of_all(cells: Cells) -> Slab {
    var slab = Slab(vec3<f32>(0.0), 1e30, -1e30);
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            for (var x = cells.low.x; x <= cells.high.x; x++) {
                let c = vec3<u32>(x, y, z);
                let listed = fabric_record(c);
                if (listed == 0u) {
                    continue;
                }
                let own = slab_of(record_at(listed).xy);
                if (own.low > own.high) {
                    continue;
                }
                if (all(slab.normal == vec3<f32>(0.0))) {
                    slab.normal = own.normal;
                }
                let k = dot(slab.normal, own.normal) / max(dot(own.normal, own.normal), 1e-6);
                let ends = vec2<f32>(min(k * own.low, k * own.high), max(k * own.low, k * own.high));
                let rest = 0.5 * manhattan(slab.normal - k * own.normal);
                let at = dot(slab.normal, vec3<f32>(c - cells.low));
                slab.low = min(slab.low, at + ends.x - rest);
                slab.high = max(slab.high, at + ends.y + rest);
            }
        }
    }
    return slab;
}

// Whether two points are on one side of a slab that is seen from the middle of a cell.
fn beside(slab: Slab, c: vec3<u32>, p: vec3<u32>, q: vec3<u32>) -> bool {
    let way = way_in(c, p, q);
    let ends = vec2<f32>(dot(slab.normal, way.from_end), dot(slab.normal, way.to_end));
    let margin = way_margin(way);
    return min(ends.x, ends.y) > slab.high + margin || max(ends.x, ends.y) < slab.low - margin;
}

// What cuts a cell: kinds, and the slab of fabric, seen from the middle of a cell of the grid.
struct Cut {
    by: u32,
    cell: vec3<u32>,
    slab: Slab,
}

// Whether nothing that may cut the cell stands between two particles, of place and tag. Of one inside and one outside of closed fabric
// it is known.
fn sees(a: vec4<u32>, b: vec4<u32>, cut: Cut) -> bool {
    if (is_inside(a.w) != is_inside(b.w)) {
        return false;
    }
    if ((cut.by & CUT_BY_WALLS) != 0u && blocked_by_wall(a.xyz, b.xyz, 0.0)) {
        return false;
    }
    if (!FABRIC || (cut.by & CUT_BY_FABRIC) == 0u || beside(cut.slab, cut.cell, a.xyz, b.xyz)) {
        return true;
    }
    return !blocked_by_fabric(cells_of(a.xyz, b.xyz), a.xyz, b.xyz, 0.0);
}

fn cut_of(by: u32, begin: u32, end: u32) -> Cut {
    var cut = Cut(by, vec3<u32>(0u), Slab(vec3<f32>(0.0), 0.0, 0.0));
    if (FABRIC && (by & CUT_BY_FABRIC) != 0u) {
        let cells = cells_of_all(begin, end);
        cut.cell = cells.low;
        cut.slab = slab_of_all(cells);
    }
    return cut;
}

@compute @workgroup_size(WORKGROUP)
fn half_turn_cut(thread: Thread) {
    let place_in_list = linear(thread);
    if (place_in_list >= atomicLoad(&counters[LIST_CUT_CELLS])) {
        return;
    }
    let begin = cut_cells[place_in_list].x;
    let end = cut_cells[place_in_list].y & ~(CUT_BY_WALLS | CUT_BY_FABRIC);
    let cut = cut_of(cut_cells[place_in_list].y, begin, end);
    for (var s = begin; s < end; s++) {
        put_in_group(s, select(IN_NO_GROUP, IN_NO_GROUP - 1u, is_newborn(id_of(sorted[s].position_tag.w))));
    }
    var group = 0u;
    var pivot = first_alone(begin, end);
    while (pivot != NOBODY && group < IN_NO_GROUP - 1u) {
        let place = sorted[pivot].position_tag;
        var count = 0u;
        for (var s = begin; s < end; s++) {
            if (group_at(s) == IN_NO_GROUP && (s == pivot || sees(place, sorted[s].position_tag, cut))) {
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
