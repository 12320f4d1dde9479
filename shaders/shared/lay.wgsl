// What the sort of the method `cell` leaves of a particle: its state, and among other devices its cell and its marks.

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
