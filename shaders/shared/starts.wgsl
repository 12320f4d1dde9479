//! uses: starts_of_chunk.wgsl
// Where the particles of a thread's chunk of cells start, of which `before` are before it and `own` in it.
fn write_starts(thread: Thread, chunk: u32, before: u32, own: u32) {
    write_starts_of_chunk(chunk, before, own);
}
