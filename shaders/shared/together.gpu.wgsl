// The same on a GPU, which does atomic operations on one word one after the other: one for all threads that come
// here together. The word must be the same for all of them. That they are still together when the first has counted, in loops and branches of some of them, too, is what drivers do and no
// standard promises: it is seen, and told of.

fn counted_up(word: u32, count: u32) -> u32 {
    let together = subgroupBallot(true);
    let before = subgroupExclusiveAdd(count);
    let all = subgroupAdd(count);
    var first = 0u;
    // The first of those that count at all.
    if (count > 0u && before == 0u) {
        first = atomicAdd(&counters[word], all);
    }
    if (any(subgroupBallot(true) != together)) {
        atomicAdd(&counters[MISPLACED], 1u);
    }
    return subgroupMax(first) + before;
}
