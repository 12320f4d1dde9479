// The lists of sharded_lists.wgsl have one shard.

fn empty_shards(thread: u32) {
}
