//! uses: particle.wgsl newborn.wgsl
// The newborns of a step are put into the slots behind those in use by who looks at the slots first: `bin`, without collisions `advect`.

// Puts the newborn of a slot there; false where there is no room for it, which is counted, and the host stops the run.
fn enter(slot: u32) -> bool {
    return enter_among(slot, step.newborns);
}

// Of so many from this step's first on.
fn enter_among(slot: u32, entering: u32) -> bool {
    if (!ORIFICES || slot - step.count >= entering) {
        return true;
    }
    if (slot >= step.capacity) {
        atomicAdd(&counters[CAPACITY_FAILED], 1u);
        return false;
    }
    particles[slot] = packed_of(newborns[step.newborn_offset + slot - step.count].particle);
    return true;
}
