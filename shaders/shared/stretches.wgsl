// Stretches of cells, of as many chunks as a workgroup has threads.

// Cells of a chunk, a multiple of 32.
override CHUNK: u32;
// So few are summed by each chunk (scan_cells.wgsl).
override FEW_STRETCHES: u32;

fn few_stretches() -> bool {
    return step.bins / (CHUNK * WORKGROUP) < FEW_STRETCHES;
}
