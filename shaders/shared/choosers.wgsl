//! uses: step.wgsl counters.wgsl together.wgsl
// The lists of those that choose, one after the other in `rechoose`.

// Whether a thread over a list has an entry: that of its own number.
fn has_entry(thread: u32, round: u32) -> bool {
    return thread < atomicLoad(&counters[LIST_RECHOOSE + round]);
}

// The number of the first of so many new entries of a thread, which the list's dispatch covers.
fn choosers_from(round: u32, count: u32, thread: u32) -> u32 {
    let list = LIST_RECHOOSE + round;
    let first = counted_up(list, count);
    let last = first + count - 1u;
    if (count > 0u && (first % WORKGROUP == 0u || first / WORKGROUP != last / WORKGROUP)) {
        cover(list, last / WORKGROUP);
    }
    return first;
}

// The place of the entry of this number.
fn chooser_place(number: u32, round: u32, thread: u32) -> u32 {
    return number;
}
