//! uses: stretches.wgsl four_starts.wgsl starts_of_chunk.wgsl
// The same on a GPU: the threads that run together do their chunks together, four after four, so that what they read and write at a time lies together. Not where
// these chunks are not one behind the other.
fn write_starts(thread: Thread, chunk: u32, before_chunk: u32, own: u32) {
    let first = subgroupMin(chunk);
    let threads = subgroupAdd(1u);
    let lane = subgroupExclusiveAdd(1u);
    if (!subgroupAll(chunk == first + lane)) {
        write_starts_of_chunk(chunk, before_chunk, own);
        return;
    }
    var before = subgroupMin(before_chunk);
    let begin = first * (CHUNK / 4u) + lane;
    for (var turn = 0u; turn < CHUNK / 4u; turn += 4u) {
        let four = begin + turn * threads;
        let counts0 = cell_start[four];
        let counts1 = cell_start[four + threads];
        let counts2 = cell_start[four + 2u * threads];
        let counts3 = cell_start[four + 3u * threads];
        let all0 = counts0.x + counts0.y + counts0.z + counts0.w;
        let all1 = counts1.x + counts1.y + counts1.z + counts1.w;
        let all2 = counts2.x + counts2.y + counts2.z + counts2.w;
        let all3 = counts3.x + counts3.y + counts3.z + counts3.w;
        cell_start[four] = starts_of(counts0, before + subgroupExclusiveAdd(all0)).starts;
        before += subgroupAdd(all0);
        cell_start[four + threads] = starts_of(counts1, before + subgroupExclusiveAdd(all1)).starts;
        before += subgroupAdd(all1);
        cell_start[four + 2u * threads] = starts_of(counts2, before + subgroupExclusiveAdd(all2)).starts;
        before += subgroupAdd(all2);
        cell_start[four + 3u * threads] = starts_of(counts3, before + subgroupExclusiveAdd(all3)).starts;
        before += subgroupAdd(all3);
    }
}
