// The walls that move, in each step of an interval.

// Where a wall that moves is in a step.
struct Motion {
    // Since the start of the run, at the start of the step, quanta.
    moved: vec3<i32>,
    // Where in `wall_list` it says where the triangles begin of each cell of its box (body_frame.wgsl).
    cells: u32,
    // m/s.
    velocity: vec3<f32>,
    // The same of each row of these cells along x, with each triangle once.
    rows: u32,
    // The cells that it touches in this step.
    low: vec3<u32>,
    pad: u32,
    high: vec3<u32>,
    pad2: u32,
    // The box of cells around it in its body frame: the first, and how many there are.
    body_low: vec3<u32>,
    pad3: u32,
    body_size: vec3<u32>,
    pad4: u32,
}

// Whether walls move, and how many do. Else not a line more is compiled than walls at rest need.
override MOVING: bool = false;
override MOTIONS: u32 = 0;
// Motions of a step, at most.
const MOST_MOTIONS: u32 = 4;
var<uniform> motions: array<Motion, 128>;

fn motion_of(m: u32) -> Motion {
    return motions[step.slot * MOST_MOTIONS + m];
}

// Whether a moving wall may touch a cell in this step.
fn in_motion(c: vec3<u32>, motion: Motion) -> bool {
    return all(c >= motion.low) && all(c <= motion.high);
}
