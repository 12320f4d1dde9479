//! uses: counters.wgsl
// The parts of the lists of those that choose (choosers.wgsl).

const LIST_PARTS: u32 = 16;

fn length_of_part(part: u32, round: u32) -> u32 {
    return CHOOSERS + part * PART_WORDS + round;
}

// Empties the parts: the share of a thread of LISTS.
fn empty_parts(thread: u32) {
    for (var word = thread; word < LIST_PARTS * MOST_LISTS; word += LISTS) {
        atomicStore(&counters[length_of_part(word / MOST_LISTS, word % MOST_LISTS)], 0u);
    }
}
