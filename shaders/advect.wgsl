//! uses: step.wgsl lists.wgsl advected.wgsl
//! phase: advect
// Flies the particles that meet no wall to the end of the step, without collisions the newborns too, which it puts behind the others; and on a
// device alone counts the particles of the cells for the step that follows in the interval, and puts its newborns behind the others.
//
// Reads `sorted` and in `particles` the flights (without collisions the particles, and `newborns`), the classes and clearances of the cells and `motions`; writes `bins`, `cell_counts`, `particles` (where they were in `sorted`; dead slots in place of ghosts), and appends
// those that meet a wall, or without rounds may meet one or enter in this step (noted in `marks`), to `bouncing`. One thread per
// particle, which writes its own slot, and for each of those newborns.

var<uniform> step: Step;
var<storage, read_write> bouncing: array<u32>;

fn meet_walls(s: u32) {
    bouncing[append(LIST_BOUNCE)] = s;
}

@compute @workgroup_size(WORKGROUP)
fn advect(thread: Thread) {
    advect_slot(linear(thread));
}
