//! uses: motions.wgsl body_frame.wgsl turns.wgsl sheets.wgsl particle.wgsl
// Swept tests of a straight flight against the triangles of the walls.
//
// A wall that moves does so along a straight line at one velocity in a step, so in its own frame it is at rest: the
// flight is moved into the wall's body frame and tested there against its triangles. These are in lists of their own, of the
// cells of that frame (body_frame.wgsl).
//
// A triangle stops a particle that moves against its normal and comes from the gas side. Rounding may
// leave a particle less than TOLERANCE behind a wall; moving away it is let go, turning back it is
// stopped at once. A triangle stops flights that come nearer to it than TOLERANCE, so that neighbours
// overlap and no flight passes between them: on its plane it reaches beyond its edges by TOLERANCE over
// the sine of the flight's angle, as far as rounding may move the place of a grazing hit. Of several hits
// the earliest counts, ties by triangle index.
// The edge function is evaluated from the lower vertex id to the higher.

struct Triangle {
    // Corners in quanta, ordered by vertex id.
    a: vec3<u32>,
    // +1 if a, b, c is counter-clockwise seen from the gas, else -1.
    sense: f32,
    b: vec3<u32>,
    // Surface tally of this triangle, or NOBODY.
    surface: u32,
    c: vec3<u32>,
    // What it does to a particle that hits it (`surface_models`), or NOBODY: a mirror.
    surface_model: u32,
    // Unit normal into the gas.
    normal: vec3<f32>,
    // The motion of its wall, or NOBODY: it is at rest.
    motion: u32,
}

// The place of a point at a time of the step in the body frame of a moving wall, in which the wall is where it is at the start
// of the run.
fn in_frame(p: vec3<u32>, motion: Motion, time: f32) -> vec3<u32> {
    return shifted(p - bitcast<vec3<u32>>(motion.moved), -motion.velocity, time);
}

// Whether a moving wall is in one of the 27 cells around in this step.
fn near_moving(c: vec3<u32>) -> bool {
    for (var m = 0u; m < MOTIONS; m++) {
        let motion = motion_of(m);
        if (all(c + 1u >= motion.low) && all(c <= motion.high + 1u)) {
            return true;
        }
    }
    return false;
}

fn touches(cells: Cells, motion: Motion) -> bool {
    return all(cells.high >= motion.low) && all(cells.low <= motion.high);
}

struct Hit {
    time: f32,
    // The triangle of a wall, or of fabric (OF_FABRIC); or NOBODY.
    triangle: u32,
    // How far behind a wall the flight was found to start, m.
    overshoot: f32,
}

override TOLERANCE: f32;

// Of each cell near walls: where its triangles start in `wall_list`, and its clearance, a plane, or SEVERAL and the number of the first of two entries
// that have up to three.
var<storage, read> wall_start: array<vec2<u32>>;
var<storage, read> triangles: array<Triangle>;
// The classes of sixteen cells, two bits each, and how many cells before these are near walls: cut, or beside one that is.
var<storage, read> cell_class: array<vec2<u32>>;

// A bit per cell: whether a wall that can part two points of the gas is in one of the 27 cells around.
// (The surface of a convex cavity cannot.)
var<storage, read> parting: array<u32>;

// Whether a wall, at rest or moving, may part two points of the 27 cells around.
fn wall_may_part(c: vec3<u32>) -> bool {
    let cell = cell_index(c);
    if (((parting[cell >> 5u] >> (cell & 31u)) & 1u) != 0u) {
        return true;
    }
    if (MOVING) {
        return near_moving(c);
    }
    return false;
}

// Marks of a collision cell: what may stand between two of its particles.
const CUT_BY_WALLS: u32 = 0x80000000;
const CUT_BY_FABRIC: u32 = 0x40000000;

// Whether a wall or fabric may.
fn may_part(c: vec3<u32>) -> bool {
    return wall_may_part(c) || (FABRIC && near_fabric(c));
}

fn class_of(cell: u32) -> u32 {
    return class_among(cell_class[cell >> 4u], cell);
}

// The same by the word of its sixteen.
fn class_among(classes: vec2<u32>, cell: u32) -> u32 {
    return (classes.x >> ((cell & 15u) * 2u)) & 3u;
}

// How many cells before this one are near walls: `wall_start` has an entry for each of those alone.
fn near_before(cell: u32) -> u32 {
    return near_among(cell_class[cell >> 4u], cell);
}

fn near_among(classes: vec2<u32>, cell: u32) -> u32 {
    // CLASS_GAS, 1, and CLASS_CUT, 2: of their two bits one is set.
    let near = (classes.x ^ (classes.x >> 1u)) & 0x55555555u;
    return classes.y + countOneBits(near & ((1u << ((cell & 15u) * 2u)) - 1u));
}

// What a step of a clearance is, in cells along a normal of 127.
override CLEARANCE_UNIT: f32;

const SEVERAL: u32 = 0x80;
// All points are before it.
const NO_PLANE: u32 = 0x80000000;

// Whether two points, seen from the middle of a cell, are before a plane.
fn before_plane(plane: u32, from_middle: vec3<f32>, to_middle: vec3<f32>) -> bool {
    let normal = vec3<f32>(bitcast<vec3<i32>>(vec3<u32>(plane << 24u, plane << 16u, plane << 8u)) >> vec3<u32>(24u));
    let least = f32(bitcast<i32>(plane) >> 24u) * (CLEARANCE_UNIT * f32(1u << CELL_BITS));
    return min(dot(normal, from_middle), dot(normal, to_middle)) > least;
}

// Whether the way between two points, the second less than a cell from the first, lies before all planes of which each wall in the 27 cells
// around is behind one. `c` is near walls, the `near`-th that is, and the nearest cell to the first point; of one that is not in it nothing is known.
fn before_walls(c: vec3<u32>, near: u32, p: vec3<u32>, q: vec3<u32>) -> bool {
    let middle = (c << vec3<u32>(CELL_BITS)) + (1u << (CELL_BITS - 1u));
    let from_middle = vec3<f32>(bitcast<vec3<i32>>(p - middle));
    let to_middle = vec3<f32>(bitcast<vec3<i32>>(q - middle));
    if (any(abs(from_middle) > vec3<f32>(f32(1u << (CELL_BITS - 1u))))) {
        return false;
    }
    let plane = wall_start[near].y;
    if ((plane >> 24u) != SEVERAL) {
        return before_plane(plane, from_middle, to_middle);
    }
    let pair = wall_start[plane & 0xffffffu];
    if (!before_plane(pair.x, from_middle, to_middle) || !before_plane(pair.y, from_middle, to_middle)) {
        return false;
    }
    let third = wall_start[(plane & 0xffffffu) + 1u].x;
    return third == NO_PLANE || before_plane(third, from_middle, to_middle);
}

// Whether a point of the triangle's plane (relative to corner a) is at most `reach` outside its edges.
fn within(triangle: Triangle, point: vec3<f32>, ab: vec3<f32>, ac: vec3<f32>, reach: f32) -> bool {
    let bc = ac - ab;
    let n = triangle.normal * triangle.sense;
    return dot(cross(ab, point), n) >= -reach * length(ab)
        && dot(cross(bc, point - ab), n) >= -reach * length(bc)
        && -dot(cross(ac, point), n) >= -reach * length(ac);
}

// The cells that the box around the segment from p to q touches.
struct Cells {
    low: vec3<u32>,
    high: vec3<u32>,
}

fn cells_of(p: vec3<u32>, q: vec3<u32>) -> Cells {
    let a = signed_cell(p);
    let b = signed_cell(q);
    let last = vec3<i32>(i32(CELLS_X), i32(CELLS_Y), i32(CELLS_Z)) - 1;
    let low = clamp(min(a, b), vec3<i32>(0), last);
    let high = clamp(max(a, b), vec3<i32>(0), last);
    return Cells(vec3<u32>(low), vec3<u32>(high));
}

// Where in `wall_list` the triangles of an x-row of cells are: the cells are neighbours in memory, as are their lists.
fn row_list(cells: Cells, y: u32, z: u32) -> vec2<u32> {
    let row = cell_index(vec3<u32>(cells.low.x, y, z));
    let past = row + cells.high.x - cells.low.x + 1u;
    return vec2<u32>(wall_start[near_before(row)].x, wall_start[near_before(past)].x);
}

// Takes the triangle into account as the first wall that a flight meets that is at `from_point` at the time `start`.
fn meet(hit: ptr<function, Hit>, index: u32, from_point: vec3<u32>, v: vec3<f32>, start: f32, end: f32) {
    // (What is left out early is not read.)
    let normal = triangles[index].normal;
    let approach = -dot(v, normal);
    // bench: side
    if (approach <= 0.0) {
        return;
    }
    let a = between(triangles[index].a, from_point);
    let distance = dot(a, normal);
    // From behind the wall it is hit where the flight starts: at a grazing flight the place on
    // the plane, far back, may be on no triangle.
    let delay = max(distance, 0.0) / approach;
    if (distance < -TOLERANCE || delay > end - start) {
        return;
    }
    let triangle = triangles[index];
    let ab = between(triangle.a, triangle.b);
    let ac = between(triangle.a, triangle.c);
    if (!within(triangle, a + v * delay, ab, ac, TOLERANCE * length(v) / approach)) {
        return;
    }
    (*hit).overshoot = max((*hit).overshoot, -distance);
    let time = start + delay;
    if (time < (*hit).time || (time == (*hit).time && index < (*hit).triangle)) {
        (*hit).time = time;
        (*hit).triangle = index;
    }
}

// The first wall or sheet that the flight x0 + v t meets in start <= t < end; `inside` tells the side of closed fabric.
fn first_hit(x0: vec3<u32>, v: vec3<f32>, start: f32, end: f32, inside: bool) -> Hit {
    var hit = Hit(NEVER, NOBODY, 0.0);
    let from_point = shifted(x0, v, start);
    let to_point = shifted(x0, v, end);
    let cells = cells_of(from_point, to_point);
    // bench: plane of cells
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        // bench: row of cells
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            let list = row_list(cells, y, z);
            var k = list.x;
            // bench: triangle
            for (; k < list.y; k++) {
                meet(&hit, wall_list[k], from_point, v, start, end);
            }
            through(k, list.y);
        }
    }
    if (FABRIC) {
        first_sheet(&hit, cells, Leg(from_point, shifted(from_point, v, end - start), v, start, end, inside));
    }
    if (MOVING) {
        for (var m = 0u; m < MOTIONS; m++) {
            let motion = motion_of(m);
            if (touches(cells, motion)) {
                let from_frame = in_frame(from_point, motion, start);
                let body = body_cells(motion, from_frame, in_frame(to_point, motion, end));
                // bench: plane of cells
                for (var z = body.low.z; z <= body.high.z; z++) {
                    // bench: row of cells
                    for (var y = body.low.y; y <= body.high.y; y++) {
                        let list = body_list(motion, body, y, z);
                        var k = list.x;
                        // bench: triangle
                        for (; k < list.y; k++) {
                            meet(&hit, wall_list[k], from_frame, v - motion.velocity, start, end);
                        }
                        through(k, list.y);
                    }
                }
            }
        }
    }
    return hit;
}

// Lists of fabric that a flight may meet something of, and triangles. They are gathered before they are looked at: threads that run together
// then walk all their lists at once, and test their triangles at once.
const MOST_GATHERED: u32 = 8;

struct Gathered {
    count: u32,
    // The first entry of a list and its cell.
    lists: array<vec2<u32>, MOST_GATHERED>,
}

struct Candidates {
    count: u32,
    triangles: array<u32, MOST_GATHERED>,
}

// A flight during a part of the step.
struct Leg {
    from_point: vec3<u32>,
    to_point: vec3<u32>,
    velocity: vec3<f32>,
    start: f32,
    end: f32,
    // The side of closed fabric.
    inside: bool,
}

fn corners_on(leg: Leg, sheet: Sheet) -> Corners {
    return corners_of(nodes_of(sheet), leg.from_point, leg.velocity, leg.start, leg.end);
}

fn is_candidate(candidates: ptr<function, Candidates>, triangle: u32) -> bool {
    var found = false;
    for (var k = 0u; k < (*candidates).count; k++) {
        found = found || (*candidates).triangles[k] == triangle;
    }
    return found;
}

// Takes the candidates into account. Most are known to pass beside; the others are tested.
fn meet_candidates(hit: ptr<function, Hit>, candidates: ptr<function, Candidates>, leg: Leg) {
    var left = 0u;
    for (var k = 0u; k < (*candidates).count; k++) {
        let triangle = (*candidates).triangles[k];
        if (!passes_beside(corners_on(leg, fabric[triangle]))) {
            (*candidates).triangles[left] = triangle;
            left++;
        }
    }
    for (var k = 0u; k < left; k++) {
        let triangle = (*candidates).triangles[k];
        let sheet = fabric[triangle];
        let met = meeting(sheet, corners_on(leg, sheet), leg.inside);
        let time = leg.start + met * (leg.end - leg.start);
        let index = OF_FABRIC | triangle;
        if (met <= 1.0 && (time < (*hit).time || (time == (*hit).time && index < (*hit).triangle))) {
            (*hit).time = time;
            (*hit).triangle = index;
        }
    }
}

// Takes the fabric of lists into account.
fn meet_gathered(hit: ptr<function, Hit>, gathered: ptr<function, Gathered>, leg: Leg) {
    var way: Way;
    var next = 0u;
    var list = 0u;
    // bench: triangle
    while (next != 0u || list < (*gathered).count) {
        var candidates: Candidates;
        while ((next != 0u || list < (*gathered).count) && candidates.count < MOST_GATHERED) {
            if (next == 0u) {
                next = (*gathered).lists[list].x;
                way = way_in(cell_at((*gathered).lists[list].y), leg.from_point, leg.to_point);
                list++;
            }
            let entry = fabric_entries[next - 1u];
            if (passes_box(entry, way) && !is_candidate(&candidates, entry.x)) {
                candidates.triangles[candidates.count] = entry.x;
                candidates.count++;
            }
            next = entry.y;
        }
        meet_candidates(hit, &candidates, leg);
    }
    through(0u, next);
    through(list, (*gathered).count);
}

// The cell behind this one of a box, row by row; behind the last one it is above the box.
fn cell_behind(c: vec3<u32>, cells: Cells) -> vec3<u32> {
    let ends = c == cells.high;
    if (!ends.x) {
        return vec3<u32>(c.x + 1u, c.yz);
    }
    return vec3<u32>(cells.low.x, select(vec2<u32>(c.y + 1u, c.z), vec2<u32>(cells.low.y, c.z + 1u), ends.y));
}

// Takes the fabric in some cells into account.
fn first_sheet(hit: ptr<function, Hit>, cells: Cells, leg: Leg) {
    var c = cells.low;
    while (c.z <= cells.high.z) {
        var gathered: Gathered;
        // bench: row of cells
        while (c.z <= cells.high.z && gathered.count < MOST_GATHERED) {
            let first = first_on_way(c, way_in(c, leg.from_point, leg.to_point));
            if (first != 0u) {
                gathered.lists[gathered.count] = vec2<u32>(first, cell_index(c));
                gathered.count++;
            }
            c = cell_behind(c, cells);
        }
        meet_gathered(hit, &gathered, leg);
    }
    through(c.z, cells.high.z + 1u);
}

// Whether fabric is in some of these cells.
fn any_fabric(cells: Cells) -> bool {
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            for (var x = cells.low.x; x <= cells.high.x; x++) {
                if (fabric_record(vec3<u32>(x, y, z)) != 0u) {
                    return true;
                }
            }
        }
    }
    return false;
}

// Whether a way may meet fabric of a cell that it passes; it may of one without a list here, which the flight then tells.
fn passes_fabric(p: vec3<u32>, q: vec3<u32>) -> bool {
    let cells = cells_of(p, q);
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            for (var x = cells.low.x; x <= cells.high.x; x++) {
                let c = vec3<u32>(x, y, z);
                if (first_on_way(c, way_in(c, p, q)) != 0u || beyond_lists) {
                    return true;
                }
            }
        }
    }
    return false;
}

// Whether fabric lies between two points at a time of the step.
fn blocked_by_fabric(cells: Cells, p: vec3<u32>, q: vec3<u32>, time: f32) -> bool {
    let along = between(p, q);
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            for (var x = cells.low.x; x <= cells.high.x; x++) {
                let c = vec3<u32>(x, y, z);
                let way = way_in(c, p, q);
                var next = first_on_way(c, way);
                while (next != 0u) {
                    let entry = fabric_entries[next - 1u];
                    if (passes_box(entry, way) && !stays_off(entry.x, p, q) && sheet_between(entry.x, p, along, time)) {
                        return true;
                    }
                    next = entry.y;
                }
                through(0u, next);
            }
        }
    }
    return false;
}

// What a flight hits that starts at the time `start`.
fn struck(hit: Hit, x0: vec3<u32>, v: vec3<f32>, start: f32, inside: bool) -> Struck {
    if (FABRIC && (hit.triangle & OF_FABRIC) != 0u) {
        return struck_sheet(hit.triangle & ~OF_FABRIC, x0, v, start, hit.time, inside);
    }
    let triangle = triangles[hit.triangle];
    var velocity = vec3<f32>(0.0);
    if (MOVING && triangle.motion != NOBODY) {
        velocity = motion_of(triangle.motion).velocity;
    }
    return Struck(triangle.normal, triangle.surface, velocity, triangle.surface_model, triangle.motion, 0.0, NOBODY, vec3<f32>(0.0));
}

// Whether a flight may meet a wall. One that does not leave its cell's neighbours meets none if the cell is clear, or if it stays
// before all walls of these.
fn may_hit(x0: vec3<u32>, v: vec3<f32>, start: f32, dt: f32) -> bool {
    let from_point = shifted(x0, v, start);
    let c = nearest_cell(from_point);
    let reach = max(max(abs(v.x), abs(v.y)), abs(v.z)) * (dt - start) * QUANTA;
    // bench: far
    if (reach >= f32(1u << CELL_BITS)) {
        return true;
    }
    let cell = cell_index(c);
    let classes = cell_class[cell >> 4u];
    let around = class_among(classes, cell);
    // bench: around
    if (around == CLASS_SOLID
        || (around != CLASS_CLEAR && !before_walls(c, near_among(classes, cell), from_point, shifted(x0, v, dt)))) {
        return true;
    }
    if (FABRIC && near_fabric(c) && passes_fabric(from_point, shifted(x0, v, dt))) {
        return true;
    }
    if (MOVING) {
        return near_moving(c) && passes_moving(from_point, start, shifted(x0, v, dt), dt);
    }
    return false;
}

// Whether a way passes a cell with a triangle of some moving wall, in that wall's body frame.
fn passes_moving(p: vec3<u32>, start: f32, q: vec3<u32>, end: f32) -> bool {
    for (var m = 0u; m < MOTIONS; m++) {
        let motion = motion_of(m);
        if (any_of_body(motion, body_cells(motion, in_frame(p, motion, start), in_frame(q, motion, end)))) {
            return true;
        }
    }
    return false;
}

// The time of a flight's next wall hit in this step, or NEVER.
fn wall_time(particle: Particle, start: f32, dt: f32) -> f32 {
    if (!may_hit(particle.position, particle.velocity, start, dt)) {
        return NEVER;
    }
    return first_hit(particle.position, particle.velocity, start, dt, is_inside(particle.tag)).time;
}

// Whether the triangle, from either side, lies between two points.
fn parts(index: u32, p: vec3<u32>, q: vec3<u32>, along: vec3<f32>) -> bool {
    return lies_between(triangles[index], p, q, along);
}

fn lies_between(triangle: Triangle, p: vec3<u32>, q: vec3<u32>, along: vec3<f32>) -> bool {
    let a = between(triangle.a, p);
    let before = dot(a, triangle.normal);
    let after = dot(between(triangle.a, q), triangle.normal);
    if ((before > 0.0) == (after > 0.0)) {
        return false;
    }
    let ab = between(triangle.a, triangle.b);
    let ac = between(triangle.a, triangle.c);
    let sine = abs(before - after) / length(along);
    return within(triangle, a + along * (before / (before - after)), ab, ac, TOLERANCE / sine);
}

// Whether a moving wall lies between two points of its frame.
fn blocked_by(motion: Motion, p: vec3<u32>, q: vec3<u32>, along: vec3<f32>) -> bool {
    let body = body_cells(motion, p, q);
    // bench: plane of cells
    for (var z = body.low.z; z <= body.high.z; z++) {
        // bench: row of cells
        for (var y = body.low.y; y <= body.high.y; y++) {
            let list = body_list(motion, body, y, z);
            var k = list.x;
            // bench: triangle
            for (; k < list.y; k++) {
                if (parts(wall_list[k], p, q, along)) {
                    return true;
                }
            }
            through(k, list.y);
        }
    }
    return false;
}

// Whether a wall or fabric, from either side, lies between two points at a time of the step.
fn blocked(p: vec3<u32>, q: vec3<u32>, time: f32) -> bool {
    return blocked_by_wall(p, q, time) || (FABRIC && blocked_by_fabric(cells_of(p, q), p, q, time));
}

fn blocked_by_wall(p: vec3<u32>, q: vec3<u32>, time: f32) -> bool {
    let cells = cells_of(p, q);
    let along = between(p, q);
    // bench: plane of cells
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        // bench: row of cells
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            let list = row_list(cells, y, z);
            var k = list.x;
            // bench: triangle
            for (; k < list.y; k++) {
                if (parts(wall_list[k], p, q, along)) {
                    return true;
                }
            }
            through(k, list.y);
        }
    }
    if (MOVING) {
        for (var m = 0u; m < MOTIONS; m++) {
            let motion = motion_of(m);
            if (touches(cells, motion) && blocked_by(motion, in_frame(p, motion, time), in_frame(q, motion, time), along)) {
                return true;
            }
        }
    }
    return false;
}
