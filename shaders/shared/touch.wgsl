//! uses: choosers.wgsl
// Lets particles choose in a round, or again in the next one: each once (local.wgsl). The outermost ghosts never do: they
// have not all their neighbours here.

@group(0) @binding(29) var<storage, read_write> rechoose: array<u32>;
@group(0) @binding(32) var<storage, read_write> layers: array<atomic<u32>>;

fn to_choose(s: u32, round: u32) {
    let chooses = CHOOSES << round;
    let mark = atomicOr(&layers[s], chooses);
    if ((mark & chooses) == 0u && (mark & LAYER) < max(step.depth, 1u)) {
        rechoose[append_chooser(s, round)] = s;
    }
}

// As `append` of lists.wgsl, to the particle's part of the list.
fn append_chooser(s: u32, round: u32) -> u32 {
    let part = part_of_list(s);
    let k = atomicAdd(&counters[length_of_part(part, round)], 1u);
    let group = k / WORKGROUP * LIST_PARTS + part;
    if (k % WORKGROUP == 0u) {
        cover(LIST_RECHOOSE + round, group);
    }
    return group * WORKGROUP + k % WORKGROUP;
}

fn touch(s: u32) {
    to_choose(s, step.round + 1u);
}
