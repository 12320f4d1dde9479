//! uses: step.wgsl sharded_lists.wgsl
// Lets particles choose in a round, or again in the next one: each once (local.wgsl). The outermost ghosts never do: they
// have not all their neighbours here.

var<storage, read_write> rechoose: array<u32>;
var<storage, read_write> marks: array<atomic<u32>>;

// Marks a particle as one that chooses in a round; 1 if it is to be entered in the list.
fn marked(s: u32, round: u32) -> u32 {
    let chooses = CHOOSES << round;
    let mark = atomicOr(&marks[s], chooses);
    return select(0u, 1u, (mark & chooses) == 0u && (mark & LAYER) < max(step.depth, 1u));
}

fn choosers_from(round: u32, count: u32, thread: u32) -> u32 {
    return entries_from(LIST_RECHOOSE + round, count, thread, step.total);
}

fn chooser_place(number: u32, round: u32, thread: u32) -> u32 {
    return entry_place(number, LIST_RECHOOSE + round, thread, step.total);
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

// Enters those of four that are to be, from a number on.
fn enter_four(round: u32, first: u32, who: vec4<u32>, fresh: vec4<u32>, thread: u32) {
    var number = first;
    if (fresh.x > 0u) {
        rechoose[chooser_place(number, round, thread)] = who.x;
    }
    number += fresh.x;
    if (fresh.y > 0u) {
        rechoose[chooser_place(number, round, thread)] = who.y;
    }
    number += fresh.y;
    if (fresh.z > 0u) {
        rechoose[chooser_place(number, round, thread)] = who.z;
    }
    number += fresh.z;
    if (fresh.w > 0u) {
        rechoose[chooser_place(number, round, thread)] = who.w;
    }
}

fn touch(s: u32, thread: u32) {
    let round = step.round + 1u;
    let fresh = marked(s, round);
    let number = choosers_from(round, fresh, thread);
    if (fresh > 0u) {
        rechoose[chooser_place(number, round, thread)] = s;
    }
}
