//! uses: step.wgsl grid.wgsl
// The cell in which a particle is counted in a step.

// What part of the step's flight is flown to the place that decides the cell.
override FLOWN: f32 = 0.5;

fn flown_cell(place: vec3<u32>, velocity: vec3<f32>) -> vec3<u32> {
    return nearest_cell(shifted(place, velocity, FLOWN * step.dt));
}

// Layers of the box that have no bins to fill.
override BORDER: u32 = 1;

fn has_bin(cell: vec3<u32>) -> bool {
    return all(cell - step.low - BORDER < step.size - 2u * BORDER);
}
