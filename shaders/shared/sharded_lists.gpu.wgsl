//! uses: step.wgsl together.wgsl list_shards.wgsl
// The same in LIST_SHARDS shards, each with a length of its own: a GPU counts up one word for one group of threads that run together after the other. Threads of one group must have numbers
// of one workgroup. Workgroups of those who append take turns, and so do those of the shards' entries in the list. A shard has room for its share of the
// entries; what it has no room for goes to the next that has, and is not counted where it came from. (All together have more room than there are entries, so each finds a place: one that does not is told of.)

fn room_of_shard(most: u32) -> u32 {
    return (most / (WORKGROUP * LIST_SHARDS) + 1u) * WORKGROUP;
}

fn shard_of_thread(thread: u32) -> u32 {
    return (thread / WORKGROUP) % LIST_SHARDS;
}

// The workgroup for the entry of this number.
fn group_of_entry(number: u32, shard: u32) -> u32 {
    return number / WORKGROUP * LIST_SHARDS + shard;
}

fn number_in_shard(thread: u32) -> u32 {
    return thread / (WORKGROUP * LIST_SHARDS) * WORKGROUP + thread % WORKGROUP;
}

fn entries_in_shard(thread: u32, list: u32, most: u32) -> u32 {
    return min(atomicLoad(&counters[length_of_shard(shard_of_thread(thread), list)]), room_of_shard(most));
}

fn entries_from(list: u32, count: u32, thread: u32, most: u32) -> u32 {
    let shard = shard_of_thread(thread);
    let first = counted_up(length_of_shard(shard, list), count);
    let last = first + count - 1u;
    if (count > 0u && (first % WORKGROUP == 0u || first / WORKGROUP != last / WORKGROUP)) {
        cover(list, group_of_entry(min(last, room_of_shard(most) - 1u), shard));
    }
    return first;
}

fn entry_place(number: u32, list: u32, thread: u32, most: u32) -> u32 {
    let room = room_of_shard(most);
    var shard = shard_of_thread(thread);
    var found = number;
    for (var turn = 0u; turn < LIST_SHARDS && found >= room; turn++) {
        atomicSub(&counters[length_of_shard(shard, list)], 1u);
        shard = (shard + 1u) % LIST_SHARDS;
        found = atomicAdd(&counters[length_of_shard(shard, list)], 1u);
        if (found < room) {
            cover(list, group_of_entry(found, shard));
        }
    }
    if (found >= room) {
        atomicAdd(&counters[MISPLACED], 1u);
    }
    return group_of_entry(found, shard) * WORKGROUP + found % WORKGROUP;
}

// (The word that is the length of a list of one shard.)
fn tell_entries(list: u32, count: u32) {
    atomicAdd(&counters[list], count);
}
