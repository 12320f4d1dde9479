//! uses: stretches.wgsl
// Whether `advect` empties the cells for the next step, on a device alone; else they are cleared from the host.
fn advect_empties() -> bool {
    return few_stretches();
}
