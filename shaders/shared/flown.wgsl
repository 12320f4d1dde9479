//! uses: step.wgsl grid.wgsl
// The cell in which a particle is counted in a step.

// What part of the step's flight is flown to the place that decides the cell.
override FLOWN: f32 = 0.5;

fn flown_cell(place: vec3<u32>, velocity: vec3<f32>) -> vec3<u32> {
    return nearest_cell(shifted(place, velocity, FLOWN * step.dt));
}

// The border layer of the box has no bins to fill.
fn has_bin(cell: vec3<u32>) -> bool {
    return all(cell - step.low - 1u < step.size - 2u);
}
