//! uses: step.wgsl local.wgsl lists.wgsl on_demand.wgsl search.wgsl newborn.wgsl walls.wgsl
//! phase: neighbours choose lost
// Completes what `order` and `neighbours` have left incomplete: the flights that may meet a wall, of which it finds when they do; the lists longer than DIRECT, which are
// searched once more, with a tail; and those near walls, from which it takes who stands behind a wall where the flights start.
//
// Reads what the search does, `sorted` and the walls; reads and writes flights and lists in `neighbours`, `neighbour_count`, `marks`; writes `counters`. One thread per
// entry of the list that these have left, or per ghost that was asked and has its list yet to be completed.
//
// Where a tail is, is a matter of the order of the threads; what is in it is not. If there is no room for all, the list keeps what it
// has, and the room that was wanted is kept for the host. A device alone is stalled (STALLED): it leaves `sorted` as it is, from which the
// host goes on with more room. Among others, of whom one alone may be short of room, the interval is run again.
//
// When ghosts are asked rounds may have changed flights, and so the start of the step is taken from `firsts` and `newborns`. The test of a pair
// takes the lower id first, and only pairs near walls are tested, whoever else is in the list: so both sides agree.

var<uniform> step: Step;
var<storage, read> sorted: array<Particle>;
var<storage, read_write> marks: array<u32>;
var<storage, read> firsts: array<Particle>;
var<storage, read> incomplete: array<u32>;
var<storage, read_write> stalled: array<atomic<u32>>;

// Gives a list a tail; false where there is no room for it.
fn lengthen(s: u32) -> bool {
    let stride = arrayLength(&neighbour_count);
    let more = atomicLoad(&neighbour_count[s]) - (DIRECT - 1u);
    let begin = atomicAdd(&counters[LIST_TAILS], more);
    if (begin + more > 4u * arrayLength(&neighbours) - RECORD * stride) {
        atomicMax(&counters[TAILS_WANTED], begin + more);
        if (step.depth == 0u) {
            atomicStore(&stalled[STALLED], step.slot + 1u);
            atomicStore(&stalled[STALLED_PARTICLES], cell_start[step.bins]);
        }
        atomicStore(&neighbour_count[s], DIRECT);
        return false;
    }
    let tail = RECORD * stride + begin - (DIRECT - 1u);
    _ = search(s, DIRECT - 1u, tail);
    put_word(direct_entry(s, DIRECT - 1u), tail);
    return true;
}

// Where a flight starts in this step.
fn first_place(s: u32) -> vec3<u32> {
    if (step.ghosts == GHOSTS_ON_DEMAND) {
        let particle = firsts[s];
        return shifted(particle.position, particle.velocity, birth_time(id_of(particle.tag)));
    }
    return shifted(sorted[s].position, sorted[s].velocity, bitcast<f32>(neighbours[2u * s].x));
}

// Where an entry is of a list with so many and this tail.
fn entry_of(s: u32, k: u32, listed: u32, tail: u32) -> u32 {
    return select(direct_entry(s, k), tail + k, listed > DIRECT && k >= DIRECT - 1u);
}

fn screen(s: u32) {
    let listed = atomicLoad(&neighbour_count[s]);
    let last = direct_entry(s, DIRECT - 1u);
    let tail = word(last);
    let tag = sorted[s].tag;
    let place = first_place(s);
    let midpoint = midpoints[s];
    var kept = 0u;
    var k = 0u;
    for (; k < listed; k++) {
        let j = word(entry_of(s, k, listed, tail));
        var apart = false;
        if (((midpoint | midpoints[j]) & NEAR_WALL) != 0u) {
            let there = first_place(j);
            let first = id_of(tag) < id_of(sorted[j].tag);
            apart = blocked(select(there, place, first), select(place, there, first), 0.0);
        }
        if (!apart) {
            put_word(entry_of(s, kept, listed, tail), j);
            kept++;
        }
    }
    through(k, listed);
    if (listed > DIRECT && kept == DIRECT) {
        // It has no tail any more.
        put_word(last, word(tail + DIRECT - 1u));
    }
    atomicStore(&neighbour_count[s], kept);
}

@compute @workgroup_size(WORKGROUP)
fn complete_lists(thread: Thread) {
    let entry = linear(thread);
    var s = NOBODY;
    if (step.ghosts == GHOSTS_ON_DEMAND) {
        s = on_demand_chooser(entry);
    } else if (entry < atomicLoad(&counters[LIST_INCOMPLETE])) {
        s = incomplete[entry];
    }
    if (s == NOBODY) {
        return;
    }
    // (Ghosts that are asked may have collided since; when they meet a wall they knew before.)
    // bench: near a wall
    if (step.ghosts != GHOSTS_ON_DEMAND && (marks[s] & NEAR) != 0u) {
        atomicAdd(&counters[LIST_NEAR_WALLS], 1u);
        let start = bitcast<f32>(neighbours[2u * s].x);
        let hit = first_hit(sorted[s].position, sorted[s].velocity, start, step.dt, is_inside(sorted[s].tag));
        neighbours[2u * s].y = bitcast<u32>(hit.time);
    }
    // A pass over those that were asked later finds it done.
    let mark = marks[s];
    marks[s] = mark & ~INCOMPLETE;
    var whole = true;
    if ((mark & LONG) != 0u) {
        whole = lengthen(s);
    }
    if (whole && (mark & UNSCREENED) != 0u) {
        screen(s);
    }
    tell_cut_short();
}
