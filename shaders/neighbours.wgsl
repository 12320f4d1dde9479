//! uses: step.wgsl local.wgsl lists.wgsl on_demand.wgsl search.wgsl sieve.wgsl touch.wgsl first_flight.wgsl
//! binds: rechoose_dispatches as dispatches
//! phase: neighbours
// The flights with which the particles start the step (capped diameters want them sooner, start_flights.wgsl), and the neighbour lists, as far as they
// are short (search.wgsl).
//
// Reads what the search does, `sorted` and `newborns`; reads and writes `marks`; writes `neighbours` and `neighbour_count` (zero before), and of ghosts `choices`, where
// nobody has chosen; appends lists that are longer, or have neighbours that may be
// behind a wall, to `incomplete`, for `complete_lists`, and to `rechoose` those that may collide (sieve.wgsl). One thread per particle, which looks for
// partners from its own place in the order on, and writes each pair it finds into both lists: half of the cells, of the
// candidates, and of the tests of a search all around. The order of a list is that of the threads; what is in it is not.

// Turns that each search takes at least. Until then threads without a candidate look at their own particle: a software device
// guesses wrong, for each of eight threads, who reads and who does not.
const FEWEST_TURNS: u32 = 4;
// Pairs that a thread keeps until it writes them.
const KEPT: u32 = 4;

var<uniform> step: Step;
var<storage, read_write> choices: array<vec2<u32>>;
var<storage, read_write> incomplete: array<u32>;

// Who has a list: of all its neighbours, or only of those who have it in theirs.
struct Listed {
    all: bool,
    some: bool,
}

fn listed_of(s: u32) -> Listed {
    if (!HALO || step.depth == 0u) {
        return Listed(true, true);
    }
    let layer = atomicLoad(&marks[s]) & LAYER;
    let all = has_list_at(layer);
    return Listed(all, all || notes_at(layer));
}

// Marks a list as incomplete. (Who may meet a wall is marked as such, and was appended with the mark.)
fn to_complete(list: u32, mark: u32) {
    if ((atomicOr(&marks[list], mark) & (INCOMPLETE | NEAR)) == 0u) {
        incomplete[append(LIST_INCOMPLETE)] = list;
    }
}

fn enter(list: u32, k: u32, entry: u32) {
    if (k < DIRECT) {
        put_word(direct_entry(list, k), entry);
    } else if (k == DIRECT) {
        to_complete(list, LONG);
    }
}

// As much as there is room for without a tail.
fn note(list: u32, entry: u32) {
    let k = atomicAdd(&neighbour_count[list], 1u);
    if (k < DIRECT) {
        put_word(direct_entry(list, k), entry);
    }
}

// What comes of partners that were found.
struct Taken {
    // Of the partners those that choose and are in no list yet, a bit for each.
    fresh: u32,
    // Whether the particle itself may collide with one.
    collides: bool,
}

fn take_found(s: u32, velocity: vec3<f32>, own: Listed, midpoint: u32, found_partners: vec4<u32>, found_places: vec4<u32>, found: u32) -> Taken {
    var partners = found_partners;
    var places = found_places;
    var taken = Taken(0u, false);
    var own_place = 0u;
    if (own.all) {
        own_place = atomicAdd(&neighbour_count[s], found);
    }
    var p = 0u;
    // bench: found
    for (; p < found; p++) {
        let j = partners.x;
        let other = places.x;
        partners = partners.yzww;
        places = places.yzww;
        let near_wall = ((midpoint | other) & NEAR_WALL) != 0u;
        let collide = may_collide(midpoint, other, sorted[j].motion.xyz - velocity);
        let theirs = listed_of(j);
        if (own.all) {
            enter(s, own_place + p, j);
            if (near_wall) {
                to_complete(s, UNSCREENED);
            }
            taken.collides = taken.collides || collide;
        } else if (own.some && theirs.all) {
            note(s, j);
        }
        if (theirs.all) {
            enter(j, atomicAdd(&neighbour_count[j], 1u), s);
            if (near_wall) {
                to_complete(j, UNSCREENED);
            }
            if (collide) {
                taken.fresh |= marked(j, 0u) << p;
            }
        } else if (theirs.some && own.all) {
            note(j, s);
        }
    }
    through(p, found);
    return taken;
}

// Enters a particle, and of four those that have a bit, in the list of those that choose.
fn list_choosers(s: u32, own: u32, four: vec4<u32>, bits: u32) {
    let first = choosers_from(0u, own + countOneBits(bits), s);
    if (own > 0u) {
        rechoose[chooser_place(first, 0u, s)] = s;
    }
    enter_four(0u, first + own, four, (vec4<u32>(bits) >> vec4<u32>(0u, 1u, 2u, 3u)) & vec4<u32>(1u), s);
}

@compute @workgroup_size(WORKGROUP)
fn neighbours_of(thread: Thread) {
    let s = linear(thread);
    // The slots behind the last cell's hold no particle.
    if (s >= min(step.total, cell_start[step.bins])) {
        return;
    }
    if (HALO && step.depth > 0u && (atomicLoad(&marks[s]) & LAYER) != 0u) {
        choices[s].x = NOBODY;
    }
    if (!CAPPED) {
        neighbours[2u * s] = first_flight(s, 0u);
    }
    let midpoint = midpoints[s];
    let reach = reach_of(s, midpoint);
    // What comes after it of its own row, and the four rows after that.
    let y_step = step.size.x;
    let z_step = step.size.x * step.size.y;
    let here = cells[s] - 1u;
    let n = reach.near2;
    let r0 = s + 1u;
    let e0 = cell_start[here + select(2u, 3u, reach.high2.x < n || reach.astray)] - r0;
    let r1 = row_at(here + y_step, n - reach.high2.y, reach);
    let r2 = row_at(here + z_step - y_step, n - reach.high2.z - reach.low2.y, reach);
    let r3 = row_at(here + z_step, n - reach.high2.z, reach);
    let r4 = row_at(here + z_step + y_step, n - reach.high2.z - reach.high2.y, reach);
    // How many candidates there are before the end of each.
    let e1 = e0 + r1.y;
    let e2 = e1 + r2.y;
    let e3 = e2 + r3.y;
    let e4 = e3 + r4.y;
    let turns = max(e4, FEWEST_TURNS);
    let own = listed_of(s);
    let velocity = sorted[s].motion.xyz;
    // Of those that were found last who is to be entered in the list of those that choose, a bit for each; and whether it may itself.
    var last = vec4<u32>(0u);
    var fresh = 0u;
    var chooses = false;
    var k = 0u;
    while (k < turns) {
        var found = 0u;
        var partners = vec4<u32>(0u);
        var places = vec4<u32>(0u);
        // One loop over all rows: threads that run together wait for the one with the most candidates, not for the fullest row of each.
        // bench: candidate
        for (; k < turns && found < KEPT; k++) {
            var base = r0;
            base = select(base, r1.x - e0, k >= e0);
            base = select(base, r2.x - e1, k >= e1);
            base = select(base, r3.x - e2, k >= e2);
            base = select(base, r4.x - e3, k >= e3);
            let j = select(s, base + k, k < e4);
            let other = midpoints[j];
            if (j != s && may_meet(midpoint, other, j, n)) {
                let next = vec4<u32>(found) == vec4<u32>(0u, 1u, 2u, 3u);
                partners = select(partners, vec4<u32>(j), next);
                places = select(places, vec4<u32>(other), next);
                found++;
            }
        }
        // Few of the candidates are near enough: written at once, they are that many writes.
        if (found == 0u) {
            continue;
        }
        if (fresh != 0u) {
            list_choosers(s, 0u, last, fresh);
        }
        last = partners;
        let taken = take_found(s, velocity, own, midpoint, partners, places, found);
        fresh = taken.fresh;
        chooses = chooses || taken.collides;
    }
    through(k, turns);
    // (Threads that run together are together again here, and so count up the list's length together.)
    var own_fresh = 0u;
    if (chooses) {
        own_fresh = marked(s, 0u);
    }
    list_choosers(s, own_fresh, last, fresh);
    tell_cut_short();
}
