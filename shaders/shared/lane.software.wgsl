// The same on a software device: Mesa's (25.0, not 22.3) divides, for each of eight threads, to know which it is in its workgroup, but knows which
// of those that it runs together.

struct Thread {
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(subgroup_id) subgroup: u32,
    @builtin(subgroup_size) size: u32,
    @builtin(subgroup_invocation_id) place: u32,
}

// Subgroups are full where this is used, so each thread of a workgroup has a number of its own.
fn lane_of(thread: Thread) -> u32 {
    return thread.subgroup * thread.size + thread.place;
}
