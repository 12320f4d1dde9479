//! uses: step.wgsl sharded_lists.wgsl particle.wgsl
// Kernels that could be one are, in plans of few particles on a GPU, where a dispatch takes as long as what it does.

override MERGED: bool = false;

// Where the list of those that choose in a round begins. `settle_chosen` reads that of one round while it fills that of the next: then they take turns in two halves.
fn first_place_of(round: u32) -> u32 {
    return select(0u, (round & 1u) * (arrayLength(&rechoose) / 2u), MERGED);
}

// The particle of a thread over that list, or NOBODY.
fn listed_chooser(thread: u32) -> u32 {
    if (number_in_shard(thread) >= entries_in_shard(thread, LIST_RECHOOSE + step.round, step.total)) {
        return NOBODY;
    }
    return rechoose[first_place_of(step.round) + thread];
}
