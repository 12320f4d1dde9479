//! uses: step.wgsl counters.wgsl together.wgsl
// Lets particles choose in a round, or again in the next one: each once (local.wgsl). The outermost ghosts never do: they
// have not all their neighbours here.

@group(0) @binding(29) var<storage, read_write> rechoose: array<u32>;
@group(0) @binding(32) var<storage, read_write> layers: array<atomic<u32>>;

// Marks a particle as one that chooses in a round; 1 if it is to be entered in the list.
fn marked(s: u32, round: u32) -> u32 {
    let chooses = CHOOSES << round;
    let mark = atomicOr(&layers[s], chooses);
    return select(0u, 1u, (mark & chooses) == 0u && (mark & LAYER) < max(step.depth, 1u));
}

// The place of the first of so many new entries of the list, which its dispatch covers.
fn choosers_from(round: u32, count: u32) -> u32 {
    let list = LIST_RECHOOSE + round;
    let first = counted_up(list, count);
    let last = first + count - 1u;
    if (count > 0u && (first % WORKGROUP == 0u || first / WORKGROUP != last / WORKGROUP)) {
        cover(list, last / WORKGROUP);
    }
    return first;
}

// Marks the first `count` of four; for each 1 if it is to be entered. (One after the other without a loop: each wants an answer, and can
// be asked before that of the one before.)
fn four_marked(who: vec4<u32>, count: u32, round: u32) -> vec4<u32> {
    var fresh = vec4<u32>(0u);
    if (count > 0u) {
        fresh.x = marked(who.x, round);
    }
    if (count > 1u) {
        fresh.y = marked(who.y, round);
    }
    if (count > 2u) {
        fresh.z = marked(who.z, round);
    }
    if (count > 3u) {
        fresh.w = marked(who.w, round);
    }
    return fresh;
}

// Enters those of four that are to be, from a place on.
fn enter_four(first: u32, who: vec4<u32>, fresh: vec4<u32>) {
    var place = first;
    if (fresh.x > 0u) {
        rechoose[place] = who.x;
    }
    place += fresh.x;
    if (fresh.y > 0u) {
        rechoose[place] = who.y;
    }
    place += fresh.y;
    if (fresh.z > 0u) {
        rechoose[place] = who.z;
    }
    place += fresh.z;
    if (fresh.w > 0u) {
        rechoose[place] = who.w;
    }
}

fn touch(s: u32) {
    let round = step.round + 1u;
    let fresh = marked(s, round);
    let place = choosers_from(round, fresh);
    if (fresh > 0u) {
        rechoose[place] = s;
    }
}
