// The lists of those that choose have one part.

fn empty_parts(thread: u32) {
}
