//! uses: step.wgsl local.wgsl flown.wgsl
// Counting the particles of the cells where they fly, for the step that follows, on a device alone. (`bin` counts those of the first step of an interval.)

override COLLISIONS: bool = true;

var<storage, read_write> bins: array<vec2<u32>>;
// Zero before the first of a step: cleared when the starts that the scan puts there are done with (clear_cells.wgsl).
var<storage, read_write> cell_counts: array<atomic<u32>>;

fn bins_next() -> bool {
    return COLLISIONS && step.slot + 1u < step_state[INTERVAL_STEPS];
}

fn bin_nobody(i: u32) {
    bins[i] = vec2<u32>(NOBODY, 0u);
}

// The bin of a cell in the step that follows. (On a device alone every cell has one in any lattice.)
fn next_index(cell: vec3<u32>) -> u32 {
    if (TILED) {
        return tiled_index(cell, step.low + shift_of(step.next_lattice) - shift_of(step.lattice), step.next_lattice);
    }
    return local_index(cell);
}

fn bin_next(i: u32, place: vec3<u32>, velocity: vec3<f32>) {
    let cell = flown_cell(place, velocity);
    if (has_bin(cell)) {
        let index = next_index(cell);
        bins[i] = vec2<u32>(index, atomicAdd(&cell_counts[index], 1u));
    } else {
        bin_nobody(i);
    }
}
