//! uses: stretches.wgsl
// Whether the first of `choose` empties the cells for the next step, on a device alone; else they are cleared from the host.
fn choose_empties() -> bool {
    return few_stretches();
}
