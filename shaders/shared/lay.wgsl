// What the sort of the methods `cell` and `half-turn` leaves of a particle: its state, and among other devices its cell
// and its marks; and what it leaves behind the last one.

var<uniform> step: Step;
var<storage, read> particles: array<Packed>;
var<storage, read_write> sorted: array<Packed>;
var<storage, read_write> cells: array<u32>;
var<storage, read_write> marks: array<u32>;

fn lay(i: u32, place: u32, cell: u32) {
    sorted[place] = particles[i];
    if (step.peers > 0u) {
        cells[place] = cell;
        // Collisions within cells want no ghosts.
        marks[place] = 0u;
    }
}

// Among other devices, of a place that may be behind the last particle: some have been dropped that are nowhere near
// this device. `end`: where the bins end.
fn lay_nobody(i: u32, end: u32) {
    if (i >= end && i < step.total) {
        marks[i] = LAYER;
    }
}
