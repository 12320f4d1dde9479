// The lists of parted_lists.wgsl have one part.

fn empty_parts(thread: u32) {
}
