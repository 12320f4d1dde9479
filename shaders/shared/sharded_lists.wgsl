//! uses: step.wgsl together.wgsl
// Lists that many threads append to: of those that choose, and of pairs. A list has one shard, or several (the variant for GPUs).

// A thread over a list has the entry of its own place; its number in its shard, and how many the shard has. `most` is how many entries the list has
// at most.
fn number_in_shard(thread: u32) -> u32 {
    return thread;
}

fn entries_in_shard(thread: u32, list: u32, most: u32) -> u32 {
    return atomicLoad(&counters[list]);
}

// The number of the first of so many new entries of a thread, which the list's dispatch covers.
fn entries_from(list: u32, count: u32, thread: u32, most: u32) -> u32 {
    let first = counted_up(list, count);
    let last = first + count - 1u;
    if (count > 0u && (first % WORKGROUP == 0u || first / WORKGROUP != last / WORKGROUP)) {
        cover(list, last / WORKGROUP);
    }
    return first;
}

// The place of the entry of this number.
fn entry_place(number: u32, list: u32, thread: u32, most: u32) -> u32 {
    return number;
}

// Tells of how many entries a shard has, to who asks for those of all shards: once for each, by the thread of its first entry.
fn tell_entries(list: u32, count: u32) {
}
