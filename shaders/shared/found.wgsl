// What the search does with the partners that it has found for a particle (neighbours.wgsl): enters each pair in both lists, and marks those that may collide.

struct Taken {
    // Of the partners those that choose and are in no list yet, a bit for each.
    fresh: u32,
    // Whether the particle itself may collide with one.
    collides: bool,
}

fn take_found(s: u32, own: Listed, middle: u32, found_partners: vec4<u32>, found_places: vec4<u32>, found: u32) -> Taken {
    var partners = found_partners;
    var places = found_places;
    var taken = Taken(0u, false);
    let velocity = sorted[s].motion.xyz;
    var own_place = 0u;
    if (own.all) {
        own_place = atomicAdd(&neighbour_count[s], found);
    }
    var p = 0u;
    for (; p < found; p++) {
        let j = partners.x;
        let other = places.x;
        partners = partners.yzww;
        places = places.yzww;
        let near_wall = ((middle | other) & NEAR_WALL) != 0u;
        let collide = may_collide(middle, other, sorted[j].motion.xyz - velocity);
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
