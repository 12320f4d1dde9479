// What a thread is told of itself. (A kernel whose threads wait for each other names what it wants of this itself: only so is it known to
// be the same for all of a workgroup.)

struct Thread {
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_id) local: vec3<u32>,
}

// Its number in its workgroup.
fn lane_of(thread: Thread) -> u32 {
    return thread.local.x;
}
