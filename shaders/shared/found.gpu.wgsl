// The same on a GPU, for which each of these steps is a wait: all four partners take each of them before any takes the next.

struct Taken {
    fresh: u32,
    collides: bool,
}

fn velocity_of(j: u32, there: bool) -> vec3<f32> {
    var velocity = vec3<f32>(0.0);
    if (there) {
        velocity = sorted[j].motion.xyz;
    }
    return velocity;
}

fn listed_if(j: u32, there: bool) -> Listed {
    if (!HALO || step.depth == 0u) {
        return Listed(there, there);
    }
    var listed = Listed(false, false);
    if (there) {
        listed = listed_of(j);
    }
    return listed;
}

// A new place in the list of j.
fn place_in_list(j: u32, theirs: Listed) -> u32 {
    var place = 0u;
    if (theirs.all) {
        place = atomicAdd(&neighbour_count[j], 1u);
    }
    return place;
}

fn mark_if(j: u32, collides: bool) -> u32 {
    var fresh = 0u;
    if (collides) {
        fresh = marked(j, 0u);
    }
    return fresh;
}

fn enter_pair(s: u32, own: Listed, own_place: u32, j: u32, theirs: Listed, their_place: u32, near_wall: bool) {
    if (own.all) {
        enter(s, own_place, j);
        if (near_wall) {
            to_complete(s, UNSCREENED);
        }
    } else if (own.some && theirs.all) {
        note(s, j);
    }
    if (theirs.all) {
        enter(j, their_place, s);
        if (near_wall) {
            to_complete(j, UNSCREENED);
        }
    } else if (theirs.some && own.all) {
        note(j, s);
    }
}

fn take_found(s: u32, own: Listed, middle: u32, partners: vec4<u32>, places: vec4<u32>, found: u32) -> Taken {
    let there = vec4<bool>(true, found > 1u, found > 2u, found > 3u);
    let velocity0 = velocity_of(partners.x, there.x);
    let velocity1 = velocity_of(partners.y, there.y);
    let velocity2 = velocity_of(partners.z, there.z);
    let velocity3 = velocity_of(partners.w, there.w);
    let velocity = sorted[s].motion.xyz;
    let theirs0 = listed_if(partners.x, there.x);
    let theirs1 = listed_if(partners.y, there.y);
    let theirs2 = listed_if(partners.z, there.z);
    let theirs3 = listed_if(partners.w, there.w);
    var own_place = 0u;
    if (own.all) {
        own_place = atomicAdd(&neighbour_count[s], found);
    }
    let place0 = place_in_list(partners.x, theirs0);
    let place1 = place_in_list(partners.y, theirs1);
    let place2 = place_in_list(partners.z, theirs2);
    let place3 = place_in_list(partners.w, theirs3);
    let collide = there & vec4<bool>(
        may_collide(middle, places.x, velocity0 - velocity),
        may_collide(middle, places.y, velocity1 - velocity),
        may_collide(middle, places.z, velocity2 - velocity),
        may_collide(middle, places.w, velocity3 - velocity),
    );
    let fresh0 = mark_if(partners.x, collide.x && theirs0.all);
    let fresh1 = mark_if(partners.y, collide.y && theirs1.all);
    let fresh2 = mark_if(partners.z, collide.z && theirs2.all);
    let fresh3 = mark_if(partners.w, collide.w && theirs3.all);
    let near_wall = ((vec4<u32>(middle) | places) & vec4<u32>(NEAR_WALL)) != vec4<u32>(0u);
    enter_pair(s, own, own_place, partners.x, theirs0, place0, near_wall.x);
    if (there.y) {
        enter_pair(s, own, own_place + 1u, partners.y, theirs1, place1, near_wall.y);
    }
    if (there.z) {
        enter_pair(s, own, own_place + 2u, partners.z, theirs2, place2, near_wall.z);
    }
    if (there.w) {
        enter_pair(s, own, own_place + 3u, partners.w, theirs3, place3, near_wall.w);
    }
    return Taken(fresh0 | (fresh1 << 1u) | (fresh2 << 2u) | (fresh3 << 3u), own.all && any(collide));
}
