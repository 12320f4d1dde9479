//! uses: step.wgsl grid.wgsl local.wgsl dsmc.wgsl cell_gas.wgsl members.wgsl
//! phase: collide
// The collisions of the method `cell`, in cells of more than MEMBERS particles that no wall parts.
//
// Reads `crowds`, `cell_start`, `cell_volume` and `slots`; writes `order_by_id`; reads and writes `sorted`, and among other devices
// leaves the number of a cell's candidates with its first particle, in `neighbour_count`. One thread per entry of `crowds`; each works on
// its own particles, in order of their ids, in which those of up to CROWD slots need not lie where NETWORKS are (crowds.wgsl); elsewhere all do, and neither
// `slots` nor `order_by_id` is touched.

var<storage, read> crowds: array<u32>;
// Four ids each.
var<storage, read> slots: array<vec4<u32>>;
// The places of a cell's particles by their ids.
var<storage, read_write> order_by_id: array<u32>;
var<storage, read_write> neighbour_count: array<u32>;

const ROWS: u32 = CROWD / 4u;

// Four ids, one of each column, and the slots they are of.
struct Row {
    ids: vec4<u32>,
    slots: vec4<u32>,
}

fn member(begin: u32, k: u32, part: u32) -> u32 {
    if (!NETWORKS) {
        return begin + k;
    }
    return order_by_id[begin + k];
}

fn hidden(s: u32, t: u32) -> bool {
    return false;
}

// The slots begin .. end of a row; behind all ids where there is none.
fn row_of(begin: u32, end: u32, row: u32) -> Row {
    let at = begin / 4u + row;
    let slot = vec4<u32>(4u * at) + vec4<u32>(0u, 1u, 2u, 3u);
    var ids = vec4<u32>(NOBODY);
    if (4u * at < end) {
        ids = select(ids, slots[at], (slot >= vec4<u32>(begin)) & (slot < vec4<u32>(end)));
    }
    return Row(ids, slot);
}

// The lower of each column to `low`.
fn exchange(rows: ptr<function, array<Row, ROWS>>, low: u32, high: u32) {
    let a = (*rows)[low];
    let b = (*rows)[high];
    let turned = b.ids < a.ids;
    (*rows)[low] = Row(min(a.ids, b.ids), select(a.slots, b.slots, turned));
    (*rows)[high] = Row(max(a.ids, b.ids), select(b.slots, a.slots, turned));
}

// The stages of a bitonic network (Batcher, 1968) that works on four columns at a time. Of each stretch of 2 `half` rows the first with the
// last, and so on.
fn mirror(rows: ptr<function, array<Row, ROWS>>, half: u32) {
    // bench: half of the rows
    for (var k = 0u; k < ROWS / 2u; k++) {
        let first = 2u * (k - k % half);
        exchange(rows, first + k % half, first + 2u * half - 1u - k % half);
    }
}

// Each row of the first half with that of the second.
fn halve(rows: ptr<function, array<Row, ROWS>>, half: u32) {
    // bench: half of the rows
    for (var k = 0u; k < ROWS / 2u; k++) {
        let first = 2u * k - k % half;
        exchange(rows, first, first + half);
    }
}

fn halve_all(rows: ptr<function, array<Row, ROWS>>) {
    halve(rows, 8u);
    halve(rows, 4u);
    halve(rows, 2u);
    halve(rows, 1u);
}

// The lower of each first and second column, and of each third and fourth, to `low`, a row of the first and third.
fn exchange_columns(rows: ptr<function, array<Row, ROWS>>, low: u32, high: u32) {
    let a = (*rows)[low];
    let b = (*rows)[high];
    let turned = b.ids.yw < a.ids.xz;
    let low_ids = min(a.ids.xz, b.ids.yw);
    let high_ids = max(a.ids.xz, b.ids.yw);
    let low_slots = select(a.slots.xz, b.slots.yw, turned);
    let high_slots = select(b.slots.yw, a.slots.xz, turned);
    (*rows)[low].ids.x = low_ids.x;
    (*rows)[low].ids.z = low_ids.y;
    (*rows)[low].slots.x = low_slots.x;
    (*rows)[low].slots.z = low_slots.y;
    (*rows)[high].ids.y = high_ids.x;
    (*rows)[high].ids.w = high_ids.y;
    (*rows)[high].slots.y = high_slots.x;
    (*rows)[high].slots.w = high_slots.y;
}

// Two columns, each in order, as `mirror`: the first row of the one with the last of the other, and so on.
fn mirror_pairs(rows: ptr<function, array<Row, ROWS>>) {
    // bench: row
    for (var k = 0u; k < ROWS; k++) {
        exchange_columns(rows, k, ROWS - 1u - k);
    }
}

// The same of the first two columns, in order one after the other, and the last two.
fn mirror_all(rows: ptr<function, array<Row, ROWS>>) {
    // bench: row
    for (var k = 0u; k < ROWS; k++) {
        let a = (*rows)[k];
        let b = (*rows)[ROWS - 1u - k];
        let turned = b.ids.wz < a.ids.xy;
        (*rows)[k] = Row(
            vec4<u32>(min(a.ids.xy, b.ids.wz), a.ids.zw),
            vec4<u32>(select(a.slots.xy, b.slots.wz, turned), a.slots.zw),
        );
        let last = (*rows)[ROWS - 1u - k];
        (*rows)[ROWS - 1u - k] = Row(
            vec4<u32>(last.ids.xy, max(a.ids.xy, b.ids.wz).yx),
            vec4<u32>(last.slots.xy, select(b.slots.wz, a.slots.xy, turned).yx),
        );
    }
}

// Each row of the first column with that of the second, of the third with that of the fourth.
fn halve_pairs(rows: ptr<function, array<Row, ROWS>>) {
    // bench: row
    for (var k = 0u; k < ROWS; k++) {
        exchange_columns(rows, k, k);
    }
}

fn put(place: u32, end: u32, slot: u32) {
    if (place < end) {
        order_by_id[place] = slot;
    }
}

fn put_in_order(begin: u32, end: u32) {
    var rows: array<Row, ROWS>;
    // bench: row
    for (var k = 0u; k < ROWS; k++) {
        rows[k] = row_of(begin, end, k);
    }
    mirror(&rows, 1u);
    mirror(&rows, 2u);
    halve(&rows, 1u);
    mirror(&rows, 4u);
    halve(&rows, 2u);
    halve(&rows, 1u);
    mirror(&rows, 8u);
    halve(&rows, 4u);
    halve(&rows, 2u);
    halve(&rows, 1u);
    mirror_pairs(&rows);
    halve_all(&rows);
    mirror_all(&rows);
    halve_pairs(&rows);
    halve_all(&rows);
    // bench: row
    for (var k = 0u; k < ROWS; k++) {
        put(begin + k, end, rows[k].slots.x);
        put(begin + ROWS + k, end, rows[k].slots.y);
        put(begin + 2u * ROWS + k, end, rows[k].slots.z);
        put(begin + 3u * ROWS + k, end, rows[k].slots.w);
    }
}

@compute @workgroup_size(WORKGROUP)
fn collide_crowded(thread: Thread) {
    let place_in_list = linear(thread);
    if (place_in_list >= atomicLoad(&counters[LIST_CROWDS])) {
        return;
    }
    let bin = crowds[place_in_list];
    let cell = index_of(bin);
    let begin = cell_start[bin];
    let end = cell_start[bin + 1u];
    // bench: fits
    if (fits_a_thread(begin, end)) {
        put_in_order(begin, end);
    } else if (NETWORKS) {
        var s = begin;
        for (; s < end; s++) {
            order_by_id[s] = s;
        }
        through(s, end);
    }
    var count = end - begin;
    while (count > 0u && is_newborn(id_of(sorted[member(begin, count - 1u, 0u)].position_tag.w))) {
        count--;
    }
    // bench: colliding
    if (count > 1u) {
        let bulk = bulk_of(begin, count, 0u);
        let done = collide_members(begin, count, bulk, bitcast<f32>(cell_volume[cell]), cell, 0u);
        count_collisions(done.collisions, cell);
        if (step.peers > 0u) {
            neighbour_count[begin] = done.candidates;
        }
    }
    tell_cut_short();
}
