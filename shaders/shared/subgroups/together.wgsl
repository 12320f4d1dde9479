// shared/together.wgsl of adapters with subgroups. (Those that come here may be any of a subgroup: each function is of the threads that
// call it together.)

fn threads_before() -> u32 {
    return subgroupExclusiveAdd(1u);
}

fn threads_together() -> u32 {
    return subgroupAdd(1u);
}

fn of_first(value: u32) -> u32 {
    return subgroupBroadcastFirst(value);
}

fn sum_together(value: u32) -> u32 {
    return subgroupAdd(value);
}

// By halves of the low words, whose sums need no more than a word of up to 128 threads.
fn sum64_together(low: u32, high: u32) -> vec2<u32> {
    let lower = subgroupAdd(low & 0xffffu);
    let upper = subgroupAdd(low >> 16u) + (lower >> 16u);
    return vec2<u32>((lower & 0xffffu) | (upper << 16u), subgroupAdd(high) + (upper >> 16u));
}
