// The place of a particle among those of its cell, by id.

var<storage, read> cell_start: array<u32>;
// Four slots each.
var<storage, read> slots: array<vec4<u32>>;

// Its cell's start plus the number of lower ids in the cell, whatever order the slots have.
fn place_by_id(cell: u32, own_id: u32) -> u32 {
    let begin = cell_start[cell];
    let end = cell_start[cell + 1u];
    var place = begin;
    // bench: lower ids
    for (var k = begin >> 2u; 4u * k < end; k++) {
        let slot = vec4<u32>(4u * k) + vec4<u32>(0u, 1u, 2u, 3u);
        let lower = (slots[k] < vec4<u32>(own_id)) & (slot >= vec4<u32>(begin)) & (slot < vec4<u32>(end));
        place += dot(select(vec4<u32>(0u), vec4<u32>(1u), lower), vec4<u32>(1u));
    }
    return place;
}
