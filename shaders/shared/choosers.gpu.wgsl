//! uses: step.wgsl counters.wgsl together.wgsl list_parts.wgsl
// The same in LIST_PARTS parts, each with a length of its own: a GPU counts up one word once in two nanoseconds, also where it does so once for all threads that
// run together. Workgroups of those who append take turns, and so do those of the parts' entries in `rechoose`. A part has room for its share of the
// particles; what it has no room for goes to the next that has.

// (All parts together have more room than there are particles.)
fn room_of_part() -> u32 {
    return (step.total / (WORKGROUP * LIST_PARTS) + 1u) * WORKGROUP;
}

fn part_of_thread(thread: u32) -> u32 {
    return (thread / WORKGROUP) % LIST_PARTS;
}

// The workgroup for the entry of this number.
fn group_of_entry(number: u32, part: u32) -> u32 {
    return number / WORKGROUP * LIST_PARTS + part;
}

fn has_entry(thread: u32, round: u32) -> bool {
    let number = thread / (WORKGROUP * LIST_PARTS) * WORKGROUP + thread % WORKGROUP;
    let length = atomicLoad(&counters[length_of_part(part_of_thread(thread), round)]);
    return number < min(length, room_of_part());
}

fn choosers_from(round: u32, count: u32, thread: u32) -> u32 {
    let part = part_of_thread(thread);
    let first = counted_up(length_of_part(part, round), count);
    let last = first + count - 1u;
    if (count > 0u && (first % WORKGROUP == 0u || first / WORKGROUP != last / WORKGROUP)) {
        cover(LIST_RECHOOSE + round, group_of_entry(min(last, room_of_part() - 1u), part));
    }
    return first;
}

fn chooser_place(number: u32, round: u32, thread: u32) -> u32 {
    let room = room_of_part();
    var part = part_of_thread(thread);
    var found = number;
    for (var turn = 0u; turn < LIST_PARTS && found >= room; turn++) {
        part = (part + 1u) % LIST_PARTS;
        found = atomicAdd(&counters[length_of_part(part, round)], 1u);
        if (found < room) {
            cover(LIST_RECHOOSE + round, group_of_entry(found, part));
        }
    }
    return group_of_entry(found, part) * WORKGROUP + found % WORKGROUP;
}
