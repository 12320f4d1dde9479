//! uses: sharded_lists.wgsl merged.wgsl
// Who chooses in a round: those of `rechoose`, in the first the particles that may collide at all (neighbours.wgsl), in later ones
// those that a collision may have made choose otherwise; in a second pass, if ghosts wait until they are asked, those that were.

var<storage, read> rechoose: array<u32>;

// The particle of a thread, or NOBODY.
fn chooser(thread: u32) -> u32 {
    if (step.ghosts == GHOSTS_ON_DEMAND) {
        return on_demand_chooser(thread);
    }
    return listed_chooser(thread);
}
