//! uses: starts_of_chunk.wgsl
// The same on a GPU: the threads that run together do their chunks together, four after four, so that what they read and write at a time lies together. Not where
// these chunks are not one behind the other.

// Each thread's four behind those of the threads before it; how many particles are before the next fours.
fn write_fours(four: u32, counts: vec4<u32>, before: u32) -> u32 {
    let all = counts.x + counts.y + counts.z + counts.w;
    cell_start[four] = starts_of(counts, before + subgroupExclusiveAdd(all)).starts;
    return before + subgroupAdd(all);
}

fn write_starts(thread: Thread, chunk: u32, before_chunk: u32, own: u32) {
    let first = subgroupMin(chunk);
    let threads = subgroupAdd(1u);
    let lane = subgroupExclusiveAdd(1u);
    if (!subgroupAll(chunk == first + lane)) {
        write_starts_of_chunk(chunk, before_chunk, own);
        return;
    }
    var before = subgroupMin(before_chunk);
    for (var turn = 0u; turn < CHUNK / 4u; turn += 4u) {
        // (All are read before any is written.)
        let four = first * (CHUNK / 4u) + turn * threads + lane;
        let counts0 = cell_start[four];
        let counts1 = cell_start[four + threads];
        let counts2 = cell_start[four + 2u * threads];
        let counts3 = cell_start[four + 3u * threads];
        before = write_fours(four, counts0, before);
        before = write_fours(four + threads, counts1, before);
        before = write_fours(four + 2u * threads, counts2, before);
        before = write_fours(four + 3u * threads, counts3, before);
    }
}
