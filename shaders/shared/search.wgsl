//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl cap.wgsl nearness.wgsl turns.wgsl neighbour_list.wgsl
// The search for the particles near enough to collide with a particle in this step, whatever the rounds do to
// their velocities: mid-step points nearer than `near2` says, in the longest steps the cell edge (which the plan makes at
// least sqrt(sigma^2 + (g_max dt/2)^2), method.md, "Collisions"); by up to two units of packing more. Cells that lie
// farther away are passed over.
//
// Reads `midpoints`, `cells`, `cell_start`, where the diameter is capped the flights in `neighbours`; writes lists in `neighbours`.

var<storage, read> cell_start: array<u32>;
var<storage, read> midpoints: array<u32>;
// By fours, for the sake of flights. (Threads write other words of one four, each by the component alone, as SPIR-V has it.)
var<storage, read_write> neighbours: array<vec4<u32>>;
var<storage, read_write> neighbour_count: array<atomic<u32>>;
var<storage, read> cells: array<u32>;

struct Found {
    count: u32,
    // NEAR_WALL of the particle and of all that were found.
    flags: u32,
}

fn word(place: u32) -> u32 {
    return neighbours[place >> 2u][place & 3u];
}

fn put_word(place: u32, value: u32) {
    neighbours[place >> 2u][place & 3u] = value;
}

// How far a point at `at` within its cell, in 1/128 of it, is at least from points in the cell before (-1), its own, or
// the next (1).
fn gap(at: i32, side: i32) -> i32 {
    return select(select(0, at + 1, side < 0), 128 - at, side > 0);
}

// What is left of the cross-section of a particle (cap.wgsl).
fn share_at(s: u32) -> u32 {
    return neighbours[2u * s].w >> SHARE_AT;
}

// How far a particle looks around itself.
struct Reach {
    // The square of the distance below which it may meet another of its own diameter or more.
    near2: i32,
    // The squares of its distances from the cells before and after its own, along each axis.
    low2: vec3<i32>,
    high2: vec3<i32>,
    // It is beyond its cell: these do not count.
    astray: bool,
}

fn reach_of(s: u32, midpoint: u32) -> Reach {
    var share = FULL_SHARE;
    if (CAPPED) {
        share = share_at(s);
    }
    let at = vec3<i32>(vec3<u32>(midpoint, midpoint >> 10u, midpoint >> 20u) & vec3<u32>(127u));
    let low = vec3<i32>(gap(at.x, -1), gap(at.y, -1), gap(at.z, -1));
    let high = vec3<i32>(gap(at.x, 1), gap(at.y, 1), gap(at.z, 1));
    return Reach(near2(share), low * low, high * high, (midpoint & ASTRAY) != 0u);
}

// A row of three cells, neighbours in memory, without those that are too far away: where it begins, and how many it has.
// `left` is what of `near2` the distance of the row leaves. (Threads that read or not, as it happens, cost a software device more
// than those that read in vain.)
fn row_at(first: u32, left: i32, reach: Reach) -> vec2<u32> {
    let begin = cell_start[first + select(1u, 0u, reach.low2.x < left || reach.astray)];
    let end = cell_start[first + select(2u, 3u, reach.high2.x < left || reach.astray)];
    return vec2<u32>(begin, select(0u, end - begin, left > 0 || reach.astray));
}

// Whether a particle may meet particle j at `other`, by the smaller of the two diameters, so that either is in the other's list.
fn may_meet(midpoint: u32, other: u32, j: u32, own_near2: i32) -> bool {
    let away = packed_between(midpoint, other);
    let distance2 = dot(away, away);
    return distance2 < own_near2 && (!CAPPED || distance2 < near2(share_at(j)));
}

// Looks all around. Writes what it finds: the first `direct` in the record, the others, where there is a tail, there.
fn search(s: u32, direct: u32, tail: u32) -> Found {
    let midpoint = midpoints[s];
    let list = direct_entry(s, 0u);
    let reach = reach_of(s, midpoint);
    let low2 = reach.low2;
    let high2 = reach.high2;
    // The nine rows around. The border layer makes every index valid.
    let y_step = step.size.x;
    let z_step = step.size.x * step.size.y;
    let here = cells[s] - 1u;
    let n = reach.near2;
    let r0 = row_at(here - z_step - y_step, n - low2.z - low2.y, reach);
    let r1 = row_at(here - z_step, n - low2.z, reach);
    let r2 = row_at(here - z_step + y_step, n - low2.z - high2.y, reach);
    let r3 = row_at(here - y_step, n - low2.y, reach);
    let r4 = row_at(here, n, reach);
    let r5 = row_at(here + y_step, n - high2.y, reach);
    let r6 = row_at(here + z_step - y_step, n - high2.z - low2.y, reach);
    let r7 = row_at(here + z_step, n - high2.z, reach);
    let r8 = row_at(here + z_step + y_step, n - high2.z - high2.y, reach);
    // How many candidates there are before the end of each.
    let e0 = r0.y;
    let e1 = e0 + r1.y;
    let e2 = e1 + r2.y;
    let e3 = e2 + r3.y;
    let e4 = e3 + r4.y;
    let e5 = e4 + r5.y;
    let e6 = e5 + r6.y;
    let e7 = e6 + r7.y;
    let e8 = e7 + r8.y;
    var found = 0u;
    var flags = midpoint;
    // One loop over all of them: threads that run together wait for the one with the most candidates, not for the fullest row of each.
    var k = 0u;
    for (; k < e8; k++) {
        var base = r0.x;
        base = select(base, r1.x - e0, k >= e0);
        base = select(base, r2.x - e1, k >= e1);
        base = select(base, r3.x - e2, k >= e2);
        base = select(base, r4.x - e3, k >= e3);
        base = select(base, r5.x - e4, k >= e4);
        base = select(base, r6.x - e5, k >= e5);
        base = select(base, r7.x - e6, k >= e6);
        base = select(base, r8.x - e7, k >= e7);
        let j = base + k;
        let other = midpoints[j];
        if (j != s && may_meet(midpoint, other, j, n)) {
            flags |= other;
            if (found < direct || tail != NOBODY) {
                put_word(select(tail, list, found < direct) + found, j);
            }
            found++;
        }
    }
    through(k, e8);
    return Found(found, flags);
}
