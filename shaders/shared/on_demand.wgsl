// Which ghosts choose partners.
//
// The choice of a ghost in the outermost layer that chooses at all matters only if a particle farther in has
// chosen it. So such ghosts may wait until they are asked: when the others have chosen, a second pass
// searches (neighbours_on_demand.wgsl, of integers) and screens the neighbours of those asked for the first time, and has all that were
// ever asked in this step choose (both by the same pipelines, so that no driver rounds otherwise). A choice is a function of the state, so
// it does not matter when, or whether, it is made.

var<storage, read_write> on_demand: array<u32>;

// Whether a particle of this layer waits until it is asked.
fn waits(layer: u32) -> bool {
    return step.ghosts == GHOSTS_WAIT && layer + 1u == step.depth;
}

// Whether particles of this layer have lists of neighbours from the search on: the outermost ghosts have not all their neighbours
// here, and choose nobody; others may have to be asked before.
fn has_list_at(layer: u32) -> bool {
    return layer < step.depth && !waits(layer);
}

// Whether particles of this layer list those who have them in their lists, as far as there is room without a tail: the outermost
// ghosts, so that what others did to them is told to whom it concerns (receive.wgsl).
fn notes_at(layer: u32) -> bool {
    return step.ghosts == GHOSTS_ALL && layer == step.depth;
}

// The particle of a thread in the pass over those that were asked, or NOBODY.
fn on_demand_chooser(thread: u32) -> u32 {
    if (thread >= atomicLoad(&counters[LIST_ON_DEMAND])) {
        return NOBODY;
    }
    return on_demand[thread];
}
