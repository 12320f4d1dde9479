//! uses: step.wgsl together.wgsl list_parts.wgsl
// The same in LIST_PARTS parts, each with a length of its own: a GPU counts up one word for one group of threads that run together after the other. Threads of one group must have numbers
// of one workgroup. Workgroups of those who append take turns, and so do those of the parts' entries in the list. A part has room for its share of the
// entries; what it has no room for goes to the next that has, and is not counted where it came from. (All together have more room than there are entries, so each finds a place: one that does not is told of.)

fn room_of_part(most: u32) -> u32 {
    return (most / (WORKGROUP * LIST_PARTS) + 1u) * WORKGROUP;
}

fn part_of_thread(thread: u32) -> u32 {
    return (thread / WORKGROUP) % LIST_PARTS;
}

// The workgroup for the entry of this number.
fn group_of_entry(number: u32, part: u32) -> u32 {
    return number / WORKGROUP * LIST_PARTS + part;
}

fn number_in_part(thread: u32) -> u32 {
    return thread / (WORKGROUP * LIST_PARTS) * WORKGROUP + thread % WORKGROUP;
}

fn entries_in_part(thread: u32, list: u32, most: u32) -> u32 {
    return min(atomicLoad(&counters[length_of_part(part_of_thread(thread), list)]), room_of_part(most));
}

fn entries_from(list: u32, count: u32, thread: u32, most: u32) -> u32 {
    let part = part_of_thread(thread);
    let first = counted_up(length_of_part(part, list), count);
    let last = first + count - 1u;
    if (count > 0u && (first % WORKGROUP == 0u || first / WORKGROUP != last / WORKGROUP)) {
        cover(list, group_of_entry(min(last, room_of_part(most) - 1u), part));
    }
    return first;
}

fn entry_place(number: u32, list: u32, thread: u32, most: u32) -> u32 {
    let room = room_of_part(most);
    var part = part_of_thread(thread);
    var found = number;
    for (var turn = 0u; turn < LIST_PARTS && found >= room; turn++) {
        atomicSub(&counters[length_of_part(part, list)], 1u);
        part = (part + 1u) % LIST_PARTS;
        found = atomicAdd(&counters[length_of_part(part, list)], 1u);
        if (found < room) {
            cover(list, group_of_entry(found, part));
        }
    }
    if (found >= room) {
        atomicAdd(&counters[MISPLACED], 1u);
    }
    return group_of_entry(found, part) * WORKGROUP + found % WORKGROUP;
}

// (The word that is the length of a list of one part.)
fn tell_entries(list: u32, count: u32) {
    atomicAdd(&counters[list], count);
}
