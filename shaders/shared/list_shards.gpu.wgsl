// They have several.

fn length_of_shard(shard: u32, list: u32) -> u32 {
    return LENGTHS_OF_SHARDS + shard * SHARD_WORDS + list;
}

// Empties the shards: the share of a thread of LISTS.
fn empty_shards(thread: u32) {
    for (var shard = 0u; shard < LIST_SHARDS; shard++) {
        atomicStore(&counters[length_of_shard(shard, thread)], 0u);
    }
}
