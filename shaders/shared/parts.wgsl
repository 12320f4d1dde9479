//! uses: dsmc.wgsl cell_gas.wgsl
// Cells whose gas is in parts, each of which collides by itself: the part of each particle is kept in the upper half of its
// word in `marks` (the lower half is the halo's), and while a part collides its members' places are in those of the cell in `order_by_id`.

var<storage, read_write> neighbour_count: array<u32>;
var<storage, read_write> marks: array<u32>;
var<storage, read_write> order_by_id: array<u32>;

// The particles begin .. end of a bin, by id, that can collide.
fn last_of(begin: u32, bin_end: u32) -> u32 {
    var end = bin_end;
    while (end > begin && is_newborn(id_of(sorted[end - 1u].position_tag.w))) {
        end--;
    }
    return end;
}

fn put_in_part(s: u32, part: u32) {
    marks[s] = (marks[s] & 0xffffu) | (part << PART_SHIFT);
}

// The k-th particle of the part that was found last.
fn member(begin: u32, k: u32, part: u32) -> u32 {
    return order_by_id[begin + k];
}

// Finds a part's particles among begin .. end, which lie by id; how many there are.
fn find_members(begin: u32, end: u32, part: u32) -> u32 {
    var count = 0u;
    var s = begin;
    for (; s < end; s++) {
        if ((marks[s] >> PART_SHIFT) == part) {
            order_by_id[begin + count] = s;
            count++;
        }
    }
    through(s, end);
    return count;
}

// The collisions of a part of this volume, m3, among the particles begin .. end of its cell; how many candidates there were.
fn collide_part(begin: u32, end: u32, volume: f32, cell: u32, part: u32) -> u32 {
    let count = find_members(begin, end, part);
    if (count < 2u) {
        return 0u;
    }
    let done = collide_members(begin, count, bulk_of(begin, count, part), volume, cell, part);
    count_collisions(done.collisions, cell);
    return done.candidates;
}

// What a cell took, for the weights of the decomposition.
fn tell_candidates(begin: u32, candidates: u32) {
    if (step.peers > 0u) {
        neighbour_count[begin] = candidates;
    }
}
