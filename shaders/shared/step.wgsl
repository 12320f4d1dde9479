// The parameters of one step, and the index of a thread.

struct Step {
    // Particles on the device before this step's newborns.
    count: u32,
    newborns: u32,
    // Where this step's newborns start in the batch's list.
    newborn_offset: u32,
    // Ids of this step's newborns: first .. first + newborns.
    newborn_first_id: u32,
    // Steps since the start of the run: the key of random numbers.
    index: u32,
    // Length of the step, s.
    dt: f32,
    // Round of this dispatch.
    round: u32,
    pad: u32,
}

override WORKGROUP: u32 = 64;

// Dispatches larger than the limit per dimension are folded into two.
fn linear(id: vec3<u32>, groups: vec3<u32>) -> u32 {
    return id.x + id.y * groups.x * WORKGROUP;
}
