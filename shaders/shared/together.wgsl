// Counting up a word that many threads count up, such as the length of a list.

// Adds `count` to a counter; what it was before those of this thread.
fn counted_up(word: u32, count: u32) -> u32 {
    if (count == 0u) {
        return 0u;
    }
    return atomicAdd(&counters[word], count);
}
