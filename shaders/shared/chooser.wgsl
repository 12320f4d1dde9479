//! uses: step.wgsl sharded_lists.wgsl particle.wgsl
// Who chooses in a round: those of `rechoose`, in the first the particles that may collide at all (neighbours.wgsl), in later ones
// those that a collision may have made choose otherwise; in a second pass, if ghosts wait until they are asked, those that were.

var<storage, read> rechoose: array<u32>;

// The particle of a thread, or NOBODY.
fn chooser(thread: u32) -> u32 {
    if (step.ghosts == GHOSTS_ON_DEMAND) {
        return on_demand_chooser(thread);
    }
    if (number_in_shard(thread) >= entries_in_shard(thread, LIST_RECHOOSE + step.round, step.total)) {
        return NOBODY;
    }
    return rechoose[thread];
}
