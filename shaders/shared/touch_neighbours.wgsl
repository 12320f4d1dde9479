//! uses: turns.wgsl
// Lets those choose again who have a particle in their lists of neighbours: they are in its own list.

var<storage, read> neighbour_count: array<u32>;

// How many entries of a list a turn reads: in the first those that are not in the tail, then four of it at a time.
fn read_of(listed: u32, turn: u32) -> u32 {
    if (turn == 0u) {
        return select(listed, DIRECT - 1u, listed > DIRECT);
    }
    return select(0u, min(listed - min(4u * turn - 1u, listed), 4u), listed > DIRECT);
}

// And which: `count` of them count.
fn four_of(direct: vec4<u32>, count: u32, turn: u32) -> vec4<u32> {
    if (turn == 0u || count == 0u) {
        return direct;
    }
    let at = direct.w + 4u * turn - 1u;
    let last = at + count - 1u;
    return vec4<u32>(word_at(at), word_at(min(at + 1u, last)), word_at(min(at + 2u, last)), word_at(min(at + 3u, last)));
}

fn ones(four: vec4<u32>) -> u32 {
    return four.x + four.y + four.z + four.w;
}

// Those in two lists, which are as long, and of which this is in the record.
fn touch_neighbours(listed_s: u32, direct_s: vec4<u32>, listed_t: u32, direct_t: vec4<u32>, thread: u32) {
    let round = step.round + 1u;
    let most = max(listed_s, listed_t);
    let turns = select(1u, 1u + most / 4u, most > DIRECT);
    var turn = 0u;
    // bench: touched
    for (; turn < turns; turn++) {
        let read_s = read_of(listed_s, turn);
        let read_t = read_of(listed_t, turn);
        let four_s = four_of(direct_s, read_s, turn);
        let four_t = four_of(direct_t, read_t, turn);
        let fresh_s = four_marked(four_s, read_s, round);
        let fresh_t = four_marked(four_t, read_t, round);
        let first = choosers_from(round, ones(fresh_s) + ones(fresh_t), thread);
        enter_four(round, first, four_s, fresh_s, thread);
        enter_four(round, first + ones(fresh_s), four_t, fresh_t, thread);
    }
    through(turn, turns);
}
