// The same on a GPU, which does atomic operations on one word one after the other: one for all threads that come
// here together. The word must be the same for all of them.

fn counted_up(word: u32, count: u32) -> u32 {
    let before = subgroupExclusiveAdd(count);
    let all = subgroupAdd(count);
    var first = 0u;
    // The first of those that count at all.
    if (count > 0u && before == 0u) {
        first = atomicAdd(&counters[word], all);
    }
    return subgroupMax(first) + before;
}
