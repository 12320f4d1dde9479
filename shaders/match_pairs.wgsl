//! uses: step.wgsl local.wgsl particle.wgsl lists.wgsl on_demand.wgsl chooser.wgsl
//! phase: settle lost
// Settle, part 1: the pairs whose choices are mutual.
//
// Reads `choices`, `sorted`, `marks`; writes `pairs` (indices, lower id first) and their count in `counters`.
// One thread per particle that has just chosen. The pairs are disjoint, so their order in the list does not matter. In the
// extra round that counts lost events the pairs are only counted.

// Rounds of the plan: the round of this number is the extra one.
override ROUNDS: u32;

var<uniform> step: Step;
var<storage, read> stalled: array<u32>;
var<storage, read> sorted: array<Particle>;
var<storage, read> choices: array<vec2<u32>>;
var<storage, read_write> pairs: array<vec2<u32>>;
var<storage, read> marks: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn match_pairs(thread: Thread) {
    let s = chooser(linear(thread));
    if (s == NOBODY || stalled[STALLED] > 0u) {
        return;
    }
    let own_tag = sorted[s].tag;
    let other = choices[s].x;
    if (other == NOBODY) {
        return;
    }
    let other_mark = marks[other];
    let other_choice = choices[other].x;
    let other_tag = sorted[other].tag;
    // Of those who have not chosen in this step the choice says nothing, but of ghosts.
    let has_chosen = (other_mark & ((CHOOSES << (step.round + 1u)) - CHOOSES)) != 0u || (HALO && (other_mark & LAYER) != 0u);
    // bench: mutual
    if (!has_chosen || other_choice != s) {
        return;
    }
    // Where both have just chosen, the lower id speaks for the pair.
    let both = (other_mark & (CHOOSES << step.round)) != 0u;
    let first = id_of(own_tag) < id_of(other_tag);
    if (both && !first) {
        return;
    }
    var counted = true;
    if (HALO) {
        // Farther from the own cells the choices of this round may lack what other devices know.
        let own_layer = marks[s] & LAYER;
        let other_layer = other_mark & LAYER;
        if (min(own_layer, other_layer) > step.reach) {
            return;
        }
        // The owner of the lower id counts the pair.
        counted = select(other_layer, own_layer, first) == 0u;
    }
    if (step.round < ROUNDS) {
        if (!counted) {
            atomicAdd(&counters[FOREIGN], 1u);
        }
        let number = entries_from(step.round, 1u, linear(thread), step.total / 2u);
        pairs[entry_place(number, step.round, linear(thread), step.total / 2u)] = vec2<u32>(select(other, s, first), select(s, other, first));
    } else if (counted) {
        atomicAdd(&counters[step.round], 1u);
    }
}
