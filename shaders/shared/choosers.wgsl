//! uses: step.wgsl counters.wgsl
// The lists of those that choose, in LIST_PARTS parts, so that few threads of a GPU count up the same word: workgroups' worths of particles
// take turns, and so do those of the parts' entries in the list. A part that is shorter than another leaves entries free; none has more than its particles, so the list wants no more room.

override LIST_PARTS: u32 = 1;

// The part of a particle, or of a thread over the list.
fn part_of_list(s: u32) -> u32 {
    return (s / WORKGROUP) % LIST_PARTS;
}

// Where the length of a part is among the counters.
fn length_of_part(part: u32, round: u32) -> u32 {
    return select(CHOOSERS + (part - 1u) * ROUND_WORDS, LIST_RECHOOSE, part == 0u) + round;
}
