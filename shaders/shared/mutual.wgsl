//! uses: step.wgsl local.wgsl particle.wgsl
// Whether a choice is mutual, of one that has just chosen. (What uses this has `mark_of`, `tag_of` and `among_others`.)

var<storage, read> choices: array<vec2<u32>>;

struct Mutual {
    // The lower id first.
    pair: vec2<u32>,
    // This thread speaks for the pair: each that is settled here has one.
    found: bool,
    // This device counts it.
    counted: bool,
}

fn mutual(s: u32) -> Mutual {
    let none = Mutual(vec2<u32>(NOBODY), false, false);
    let own_tag = tag_of(s);
    let other = choices[s].x;
    if (other == NOBODY) {
        return none;
    }
    let other_mark = mark_of(other);
    let other_choice = choices[other].x;
    let other_tag = tag_of(other);
    // Of those who have not chosen in this step the choice says nothing, but of ghosts.
    let has_chosen = (other_mark & ((CHOOSES << (step.round + 1u)) - CHOOSES)) != 0u || (among_others() && (other_mark & LAYER) != 0u);
    // bench: mutual
    if (!has_chosen || other_choice != s) {
        return none;
    }
    // Where both have just chosen, the lower id speaks for the pair.
    let both = (other_mark & (CHOOSES << step.round)) != 0u;
    let first = id_of(own_tag) < id_of(other_tag);
    if (both && !first) {
        return none;
    }
    var counted = true;
    if (among_others()) {
        // Farther from the own cells the choices of this round may lack what other devices know.
        let own_layer = mark_of(s) & LAYER;
        let other_layer = other_mark & LAYER;
        if (min(own_layer, other_layer) > step.reach) {
            return none;
        }
        // The owner of the lower id counts the pair.
        counted = select(other_layer, own_layer, first) == 0u;
    }
    return Mutual(vec2<u32>(select(other, s, first), select(s, other, first)), true, counted);
}
