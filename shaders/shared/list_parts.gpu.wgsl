// They have several.

fn length_of_part(part: u32, list: u32) -> u32 {
    return PARTS_OF_LISTS + part * PART_WORDS + list;
}

// Empties the parts: the share of a thread of LISTS.
fn empty_parts(thread: u32) {
    for (var part = 0u; part < LIST_PARTS; part++) {
        atomicStore(&counters[length_of_part(part, thread)], 0u);
    }
}
