//! uses: step.wgsl grid.wgsl local.wgsl walls.wgsl parts.wgsl cell_gas.wgsl
//! phase: collide
// The collisions of the method `cell`, in cells that walls which move may touch in this step: each part of the gas by
// itself, with the volumes of the moment.
//
// Collisions are at the start of the step, where the walls are at `moved`. Of a lattice of points in the cell those are
// gas that are in no wall at rest (`still_gas`) and of which a ray along x leaves no moving wall more often than it enters
// one. A point that no place before it sees is a place itself; what it sees is of its part, and parts that share a point
// are one. The volume of a part is its share of the points, and smaller by the share of pairs of points that do not see
// each other, as that of a part at rest (src/geometry/cell_gas.rs). A particle is of the part of the first place that it
// sees, or if it sees none, of that of the nearest.
//
// All of it is a function of the cell and of where the walls are in the step: the same on every device that owns the
// cell. A pair that a wall parts does not collide, whatever the parts are.
//
// Reads `moved`, `cell_start`, `cell_volume`, `still_gas`, `motions` and the walls; reads and writes `sorted`, the
// part of each particle in `marks`, and of its own cell `order_by_id`. One workgroup per entry of `moved`, whose threads share the points and the particles
// (a software device gives up loops that are too long); the first of them collides. Each works on its own cell; what is
// shared are sets and sums of integers, which have no order.

var<storage, read> moved: array<u32>;
var<storage, read> still_gas: array<StillGas>;

// The points of a cell, a rank-1 lattice, at most 96.
override CELL_POINTS: u32;
override GENERATOR_Y: u32;
override GENERATOR_Z: u32;

// Gas that is in more parts than this counts as that of the nearest.
const MOST_PARTS: u32 = 8;
// Pairs of points whose sight of each other is tried: each with three others.
const PAIRINGS: vec3<u32> = vec3<u32>(3, 20, 47);

// Moving triangles that may be in the cell, and those that lie on it or beyond it along x. Where there are more of either than there is
// room for, the walls' own lists are gone through. (No more than 512, the room; a test gives less.)
override MOST_LISTED: u32 = 512;
var<workgroup> close: array<u32, 512>;
var<workgroup> close_count: atomic<u32>;
var<workgroup> ahead: array<u32, 512>;
var<workgroup> ahead_count: atomic<u32>;
// Sets of points, three words each: the gas, and what each place sees.
var<workgroup> gas: array<atomic<u32>, 3>;
var<workgroup> seen: array<atomic<u32>, 24>;
// Whether there are points that no place sees.
var<workgroup> more: u32;
// Of each part the pairs of points that were tried, and those of them that see each other.
var<workgroup> tried: array<atomic<u32>, 16>;

// The cell, and whether walls at rest may part its gas.
var<private> here: vec3<u32>;
var<private> still_parts: bool;
var<private> places: array<vec3<u32>, 8>;
var<private> part_of_place: array<u32, 8>;
var<private> place_count: u32;

fn hidden(s: u32, t: u32) -> bool {
    let q = sorted[t].position_tag.xyz;
    return !clear_of(Ways(sorted[s].position_tag.xyz, q, q, q), vec3<bool>(true, false, false)).x;
}

// In the lists of rows: the triangle's number, and whether it is also in the row before along y and along z.
const NUMBER: u32 = 0x3fffffff;
const EARLIER_Y: u32 = 0x80000000;
const EARLIER_Z: u32 = 0x40000000;

// Finds `close` and `ahead`, by all threads.
fn gather(thread: u32) {
    // A little more than half the edge, for rounding.
    let half = (0.5 + PLACE_OFF) * f32(1u << CELL_BITS) * QUANTUM + TOLERANCE;
    let middle = (here << vec3<u32>(CELL_BITS)) + vec3<u32>(1u << (CELL_BITS - 1u));
    for (var m = 0u; m < MOTIONS; m++) {
        let motion = motion_of(m);
        if (!in_motion(here, motion)) {
            continue;
        }
        let from_middle = middle - bitcast<vec3<u32>>(motion.moved);
        let drawn = body_around(here, motion);
        for (var z = drawn.low.z; z <= drawn.high.z; z++) {
            for (var y = drawn.low.y; y <= drawn.high.y; y++) {
                let row = row_of(motion, y, z);
                let earlier = earlier_marks(drawn, y, z);
                let end = wall_list[row + 1u];
                var k = wall_list[row] + thread;
                for (; k < end; k += WORKGROUP) {
                    let entry = wall_list[k];
                    if ((entry & earlier) == 0u) {
                        sort_in(entry & NUMBER, from_middle, half);
                    }
                }
                through(k, end);
            }
        }
    }
}

// What marks the triangles of a row that are in one before it among these, too: the first of its rows counts.
fn earlier_marks(drawn: BodyCells, y: i32, z: i32) -> u32 {
    return select(0u, EARLIER_Y, y > drawn.low.y) | select(0u, EARLIER_Z, z > drawn.low.z);
}

// Where in `wall_list` it says where the triangles of a row begin.
fn row_of(motion: Motion, y: i32, z: i32) -> u32 {
    return motion.rows + u32(z * bitcast<vec3<i32>>(motion.body_size).y + y);
}

// Puts a triangle into `ahead` and `close`, if it is. `from_middle` is the middle of the cell in its frame.
fn sort_in(index: u32, from_middle: vec3<u32>, half: f32) {
    let triangle = triangles[index];
    let a = between(from_middle, triangle.a);
    let b = between(from_middle, triangle.b);
    let c = between(from_middle, triangle.c);
    let low = min(a, min(b, c));
    let high = max(a, max(b, c));
    if (any(low.yz > vec2<f32>(half)) || any(high.yz < vec2<f32>(-half)) || high.x < -half) {
        return;
    }
    let k = atomicAdd(&ahead_count, 1u);
    if (k < MOST_LISTED) {
        ahead[k] = index;
    }
    let size = abs(triangle.normal);
    if (low.x <= half && abs(dot(triangle.normal, a)) <= half * (size.x + size.y + size.z)) {
        let l = atomicAdd(&close_count, 1u);
        if (l < MOST_LISTED) {
            close[l] = index;
        }
    }
}

// Of three points of the cell, which are in a wall that moves. (Three at a time, here and below: what a thread reads of a triangle serves
// all of them.)
fn in_wall(p0: vec3<u32>, p1: vec3<u32>, p2: vec3<u32>) -> vec3<bool> {
    var depth = vec3<i32>(0);
    let count = atomicLoad(&ahead_count);
    if (count <= MOST_LISTED) {
        var k = 0u;
        for (; k < count; k++) {
            let triangle = triangles[ahead[k]];
            let way = bitcast<vec3<u32>>(motion_of(triangle.motion).moved);
            depth += crossings(triangle, p0 - way, p1 - way, p2 - way);
        }
        through(k, count);
        return depth > vec3<i32>(0);
    }
    for (var m = 0u; m < MOTIONS; m++) {
        let motion = motion_of(m);
        if (!in_motion(here, motion)) {
            continue;
        }
        let way = bitcast<vec3<u32>>(motion.moved);
        let drawn = body_around(here, motion);
        for (var z = drawn.low.z; z <= drawn.high.z; z++) {
            for (var y = drawn.low.y; y <= drawn.high.y; y++) {
                let row = row_of(motion, y, z);
                let earlier = earlier_marks(drawn, y, z);
                let end = wall_list[row + 1u];
                var k = wall_list[row];
                for (; k < end; k++) {
                    let entry = wall_list[k];
                    if ((entry & earlier) == 0u) {
                        depth += crossings(triangles[entry & NUMBER], p0 - way, p1 - way, p2 - way);
                    }
                }
                through(k, end);
            }
        }
    }
    return depth > vec3<i32>(0);
}

// Of three points in a wall's frame, whether the ray along x leaves the wall through a triangle (1), or enters it (-1).
fn crossings(triangle: Triangle, p0: vec3<u32>, p1: vec3<u32>, p2: vec3<u32>) -> vec3<i32> {
    return vec3<i32>(crossing(triangle, p0), crossing(triangle, p1), crossing(triangle, p2));
}

fn crossing(triangle: Triangle, q: vec3<u32>) -> i32 {
    let a = between(q, triangle.a);
    let b = between(q, triangle.b);
    let c = between(q, triangle.c);
    // From the lower vertex id to the higher: two triangles agree on their edge.
    let ab = turn(a, b);
    if (ab != turn(b, c) || ab == turn(a, c)) {
        return 0;
    }
    let facing = select(-triangle.sense, triangle.sense, ab);
    return select(0, select(-1, 1, facing > 0.0), dot(triangle.normal, a) * facing > 0.0);
}

fn turn(a: vec3<f32>, b: vec3<f32>) -> bool {
    return a.y * b.z - a.z * b.y >= 0.0;
}

// Three ways from a point of the cell to others.
struct Ways {
    p: vec3<u32>,
    q0: vec3<u32>,
    q1: vec3<u32>,
    q2: vec3<u32>,
}

// Which of the open ways a triangle leaves open. `way` is that of its wall since it was drawn.
fn left_open(triangle: Triangle, way: vec3<u32>, ways: Ways, open: vec3<bool>) -> vec3<bool> {
    let p = ways.p - way;
    return vec3<bool>(
        open.x && !lies_between(triangle, p, ways.q0 - way, between(ways.p, ways.q0)),
        open.y && !lies_between(triangle, p, ways.q1 - way, between(ways.p, ways.q1)),
        open.z && !lies_between(triangle, p, ways.q2 - way, between(ways.p, ways.q2)),
    );
}

// After a loop that goes on while k < end and a way is open.
fn through_ways(k: u32, end: u32, open: vec3<bool>) {
    if (any(open)) {
        through(k, end);
    }
}

// Which of the wanted ways have no wall across them.
fn clear_of(ways: Ways, wanted: vec3<bool>) -> vec3<bool> {
    var open = wanted;
    let count = atomicLoad(&close_count);
    if (count <= MOST_LISTED) {
        var k = 0u;
        for (; k < count && any(open); k++) {
            let triangle = triangles[close[k]];
            open = left_open(triangle, bitcast<vec3<u32>>(motion_of(triangle.motion).moved), ways, open);
        }
        through_ways(k, count, open);
    } else {
        for (var m = 0u; m < MOTIONS; m++) {
            let motion = motion_of(m);
            if (!in_motion(here, motion)) {
                continue;
            }
            let way = bitcast<vec3<u32>>(motion.moved);
            let drawn = body_around(here, motion);
            for (var z = drawn.low.z; z <= drawn.high.z; z++) {
                for (var y = drawn.low.y; y <= drawn.high.y; y++) {
                    let list = body_list(motion, drawn, y, z);
                    var k = list.x;
                    for (; k < list.y && any(open); k++) {
                        open = left_open(triangles[wall_list[k]], way, ways, open);
                    }
                    through_ways(k, list.y, open);
                }
            }
        }
    }
    if (still_parts) {
        let list = row_list(Cells(here, here), here.y, here.z);
        var k = list.x;
        for (; k < list.y && any(open); k++) {
            open = left_open(triangles[wall_list[k]], vec3<u32>(0u), ways, open);
        }
        through_ways(k, list.y, open);
    }
    return open;
}

fn point(k: u32) -> vec3<u32> {
    let share = vec3<u32>(k, k * GENERATOR_Y, k * GENERATOR_Z) % CELL_POINTS;
    return (here << vec3<u32>(CELL_BITS)) + (2u * share + 1u) * ((1u << CELL_BITS) / (2u * CELL_POINTS));
}

// Sets of points: a bit for each.
fn has(points: vec3<u32>, k: u32) -> bool {
    return ((points[k >> 5u] >> (k & 31u)) & 1u) != 0u;
}

fn size_of(points: vec3<u32>) -> f32 {
    let bits = countOneBits(points);
    return f32(bits.x + bits.y + bits.z);
}

fn all_gas() -> vec3<u32> {
    return vec3<u32>(atomicLoad(&gas[0]), atomicLoad(&gas[1]), atomicLoad(&gas[2]));
}

fn seen_by(place: u32) -> vec3<u32> {
    return vec3<u32>(atomicLoad(&seen[3u * place]), atomicLoad(&seen[3u * place + 1u]), atomicLoad(&seen[3u * place + 2u]));
}

fn count_true(which: vec3<bool>) -> u32 {
    let ones = select(vec3<u32>(0u), vec3<u32>(1u), which);
    return ones.x + ones.y + ones.z;
}

// The number of the first point of a set that is not empty.
fn lowest(points: vec3<u32>) -> u32 {
    if (points.x != 0u) {
        return countTrailingZeros(points.x);
    }
    if (points.y != 0u) {
        return 32u + countTrailingZeros(points.y);
    }
    return 64u + countTrailingZeros(points.z);
}

// Parts that share a point are one, with the number of the lowest place.
fn merge() {
    for (var a = 0u; a < place_count; a++) {
        part_of_place[a] = a;
    }
    for (var a = 0u; a < place_count; a++) {
        for (var b = a + 1u; b < place_count; b++) {
            if (any((seen_by(a) & seen_by(b)) != vec3<u32>(0u))) {
                let low = min(part_of_place[a], part_of_place[b]);
                let high = max(part_of_place[a], part_of_place[b]);
                for (var k = 0u; k < place_count; k++) {
                    part_of_place[k] = select(part_of_place[k], low, part_of_place[k] == high);
                }
            }
        }
    }
}

// MOST_PARTS of a point that is of none.
fn part_of_point(k: u32) -> u32 {
    for (var place = 0u; place < place_count; place++) {
        if (has(seen_by(place), k)) {
            return part_of_place[place];
        }
    }
    return MOST_PARTS;
}

fn part_of(place: vec3<u32>) -> u32 {
    var nearest = 0u;
    var least = NEVER;
    for (var k = 0u; k < place_count; k += 3u) {
        let ways = Ways(place, places[k], places[min(k + 1u, MOST_PARTS - 1u)], places[min(k + 2u, MOST_PARTS - 1u)]);
        let seen = clear_of(ways, vec3<u32>(k, k + 1u, k + 2u) < vec3<u32>(place_count));
        for (var n = 0u; n < 3u; n++) {
            if (seen[n]) {
                return part_of_place[k + n];
            }
        }
    }
    for (var k = 0u; k < place_count; k++) {
        let away = between(place, places[k]);
        if (dot(away, away) < least) {
            nearest = part_of_place[k];
            least = dot(away, away);
        }
    }
    return nearest;
}

fn volume_of(part: u32) -> f32 {
    let entry = cell_volume[cell_index(here)];
    // The box around a wall is larger than the wall.
    if (atomicLoad(&close_count) == 0u && (entry & DIVIDED) == 0u) {
        return bitcast<f32>(entry);
    }
    let still = still_gas[cell_index(here)];
    var points = vec3<u32>(0u);
    for (var k = 0u; k < place_count; k++) {
        points |= select(vec3<u32>(0u), seen_by(k), part_of_place[k] == part);
    }
    if (all(points == vec3<u32>(0u))) {
        // A gap without a point has half of one's share, in the mean.
        let edge = f32(1u << CELL_BITS) * QUANTUM;
        return 0.5 * edge * edge * edge / f32(CELL_POINTS);
    }
    let pairs = f32(atomicLoad(&tried[2u * part]));
    let seeing = f32(atomicLoad(&tried[2u * part + 1u]));
    let visible = select(1.0, max(seeing, 1.0) / max(pairs, 1.0), pairs > 0.0);
    return still.volume * (size_of(points) / size_of(still.points)) * visible;
}

@compute @workgroup_size(WORKGROUP)
fn collide_moved(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let place_in_list = group.x + group.y * groups.x;
    let listed = place_in_list < atomicLoad(&counters[LIST_MOVED]);
    // (All threads reach the barriers.)
    let bin = moved[select(0u, place_in_list, listed)];
    here = cell_of(bin);
    let cell = cell_index(here);
    still_parts = ((parting[cell >> 5u] >> (cell & 31u)) & 1u) != 0u;
    gather(thread);
    workgroupBarrier();
    let still_points = still_gas[cell].points;
    for (var k = 3u * thread; k < CELL_POINTS; k += 3u * WORKGROUP) {
        let inside = in_wall(point(k), point(k + 1u), point(k + 2u));
        for (var n = 0u; n < 3u; n++) {
            if (k + n < CELL_POINTS && has(still_points, k + n) && !inside[n]) {
                atomicOr(&gas[(k + n) >> 5u], 1u << ((k + n) & 31u));
            }
        }
    }
    workgroupBarrier();
    let points = all_gas();
    var rest = points;
    place_count = 0u;
    for (var place = 0u; place < MOST_PARTS; place++) {
        if (thread == 0u) {
            more = u32(any(rest != vec3<u32>(0u)));
        }
        if (workgroupUniformLoad(&more) == 0u) {
            break;
        }
        let own = point(lowest(rest));
        places[place] = own;
        place_count = place + 1u;
        for (var k = 3u * thread; k < CELL_POINTS; k += 3u * WORKGROUP) {
            let ways = Ways(own, point(k), point(k + 1u), point(k + 2u));
            let wanted = vec3<bool>(has(points, k), has(points, k + 1u), has(points, k + 2u));
            let clear = clear_of(ways, wanted);
            for (var n = 0u; n < 3u; n++) {
                if (clear[n] || (wanted[n] && k + n == lowest(rest))) {
                    atomicOr(&seen[3u * place + ((k + n) >> 5u)], 1u << ((k + n) & 31u));
                }
            }
        }
        workgroupBarrier();
        rest &= ~seen_by(place);
    }
    merge();
    for (var k = thread; k < CELL_POINTS; k += WORKGROUP) {
        let part = part_of_point(k);
        let others = (PAIRINGS * k + 1u) % CELL_POINTS;
        let parts_there = vec3<u32>(part_of_point(others.x), part_of_point(others.y), part_of_point(others.z));
        let of_part = (others != vec3<u32>(k)) & (parts_there == vec3<u32>(part));
        if (part < MOST_PARTS && any(of_part)) {
            atomicAdd(&tried[2u * part], count_true(of_part));
            let ways = Ways(point(k), point(others.x), point(others.y), point(others.z));
            atomicAdd(&tried[2u * part + 1u], count_true(clear_of(ways, of_part)));
        }
    }
    if (place_count == 0u) {
        places[0] = (here << vec3<u32>(CELL_BITS)) + vec3<u32>(1u << (CELL_BITS - 1u));
        part_of_place[0] = 0u;
        place_count = 1u;
    }
    let begin = cell_start[bin];
    let end = select(begin, last_of(begin, cell_start[bin + 1u]), listed);
    var s = begin + thread;
    for (; s < end; s += WORKGROUP) {
        put_in_part(s, part_of(sorted[s].position_tag.xyz));
    }
    through(s, end);
    storageBarrier();
    workgroupBarrier();
    if (thread > 0u || !listed) {
        tell_cut_short();
        return;
    }
    var candidates = 0u;
    var part = 0u;
    for (; part < place_count; part++) {
        candidates += collide_part(begin, end, volume_of(part), cell, part);
    }
    through(part, place_count);
    tell_candidates(begin, candidates);
    tell_cut_short();
}
