//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl newborn.wgsl lists.wgsl asked.wgsl walls.wgsl neighbour_list.wgsl
// Takes from the neighbour lists near walls those that stand behind a wall where their flights start.
//
// Reads `sorted`, `middles`, the flights and the walls; reads and writes the lists of `neighbours`, `neighbour_count`. One thread
// per entry of the list that the search has left in the second words of `choices`, or per ghost that was asked and is not screened yet; rounds may have changed flights by then,
// and so the start of the step is taken from `firsts` and `newborns`. The test of a pair takes the lower id first, and only pairs near
// walls are tested, whoever else is in the list: so both sides agree.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(10) var<storage, read> sorted: array<Particle>;
@group(0) @binding(12) var<storage, read> middles: array<u32>;
@group(0) @binding(13) var<storage, read_write> neighbours: array<u32>;
@group(0) @binding(14) var<storage, read_write> neighbour_count: array<u32>;
@group(0) @binding(15) var<storage, read> choices: array<vec2<u32>>;

@group(0) @binding(32) var<storage, read_write> layers: array<u32>;
@group(0) @binding(44) var<storage, read> firsts: array<Particle>;

// Where a flight starts in this step.
fn first_place(s: u32) -> vec3<u32> {
    if (step.ghosts == GHOSTS_ASKED) {
        let particle = firsts[s];
        return shifted(particle.position, particle.velocity * birth_time(id_of(particle.tag)));
    }
    return shifted(sorted[s].position, sorted[s].velocity * bitcast<f32>(neighbours[RECORD * s]));
}

// Where an entry is of a list with so many and this tail.
fn entry_of(s: u32, k: u32, listed: u32, tail: u32) -> u32 {
    return select(direct_entry(s, k), tail + k, listed > DIRECT && k >= DIRECT - 1u);
}

@compute @workgroup_size(WORKGROUP)
fn screen(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let entry = linear(id, groups);
    var s = NOBODY;
    if (step.ghosts == GHOSTS_ASKED) {
        s = asked_of(entry);
        if (s == NOBODY || (layers[s] & UNSCREENED) == 0u) {
            return;
        }
    } else if (entry < atomicLoad(&counters[LIST_SCREEN])) {
        s = choices[entry].y;
    } else {
        return;
    }
    layers[s] &= ~UNSCREENED;
    let listed = neighbour_count[s];
    let last = direct_entry(s, DIRECT - 1u);
    let tail = neighbours[last];
    let tag = sorted[s].tag;
    let place = first_place(s);
    let middle = middles[s];
    var kept = 0u;
    var k = 0u;
    for (; k < listed; k++) {
        let j = neighbours[entry_of(s, k, listed, tail)];
        var apart = false;
        if (((middle | middles[j]) & NEAR_WALL) != 0u) {
            let there = first_place(j);
            let first = id_of(tag) < id_of(sorted[j].tag);
            apart = blocked(select(there, place, first), select(place, there, first), 0.0);
        }
        if (!apart) {
            neighbours[entry_of(s, kept, listed, tail)] = j;
            kept++;
        }
    }
    through(k, listed);
    tell_cut_short();
    if (listed > DIRECT && kept == DIRECT) {
        // It has no tail any more.
        neighbours[last] = neighbours[tail + DIRECT - 1u];
    }
    neighbour_count[s] = kept;
}
