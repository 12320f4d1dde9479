//! uses: lane.wgsl
// The number of a thread in its dispatch. Dispatches larger than the limit per dimension are folded into two.

override WORKGROUP: u32 = 64;

fn group_of(thread: Thread) -> u32 {
    return thread.group.y * thread.groups.x + thread.group.x;
}

fn linear(thread: Thread) -> u32 {
    return group_of(thread) * WORKGROUP + lane_of(thread);
}

// Workgroups of the dispatch.
fn groups_of(thread: Thread) -> u32 {
    return thread.groups.x * thread.groups.y;
}
