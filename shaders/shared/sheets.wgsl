//! uses: fabric.wgsl turns.wgsl
// Swept tests of a straight flight against triangles that deform (docs/dev/walls.md).
//
// Seen from the particle, the corners of a triangle fly straight, r_i(u) = a_i + w_i u, u from 0 to 1 over the flight. The signed volume
// f = -r_a . [(r_b - r_a) x (r_c - r_a)] is a cubic in u: the distance from the triangle's plane times twice its area. With the
// sign of the particle's own side it is g. A flight meets the triangle where g falls to SHEET_GAP times that area, or to 0, at a place on it; or at once, if
// it starts nearer than that and comes nearer. So no flight ends nearer to a sheet than rounding could take for the other side.
//
// The own side is that of the particle's tag where fabric is closed, else that on which the flight starts. Neighbours overlap, since sheets reach beyond their
// edges by SHEET_REACH gaps, over the sine of the flight's angle to them. Of several hits the earliest counts, ties by triangle.

var<storage, read> fabric_cells: array<u32>;
var<storage, read> fabric_entries: array<vec4<u32>>;
var<storage, read> fabric_swept: array<Swept>;

// In place of a triangle's number: that of fabric.
const OF_FABRIC: u32 = 0x80000000;

// A triangle seen from a particle during its flight: corners, m, and how far they come in the flight.
struct Corners {
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
    wa: vec3<f32>,
    wb: vec3<f32>,
    wc: vec3<f32>,
}

// A place on a triangle: its normal, not of unit length; the weights of its corners.
struct OnSheet {
    normal: vec3<f32>,
    weights: vec3<f32>,
    within: bool,
}

// Whether the way between two points stays on one side of all that a triangle sweeps in the step.
fn stays_off(triangle: u32, p: vec3<u32>, q: vec3<u32>) -> bool {
    let swept = fabric_swept[triangle];
    let a = dot(swept.normal, vec3<f32>(bitcast<vec3<i32>>(p - swept.corner)));
    let b = dot(swept.normal, vec3<f32>(bitcast<vec3<i32>>(q - swept.corner)));
    return min(a, b) > swept.away || max(a, b) < -swept.away;
}

// A node in the step: where it is at the start, and its velocity, m/s.
struct Node {
    place: vec3<u32>,
    velocity: vec3<f32>,
}

fn node_of(node: u32) -> Node {
    let place = node_before(node);
    return Node(place, between(place, node_after(node)) / step.dt);
}

struct Nodes {
    a: Node,
    b: Node,
    c: Node,
}

fn nodes_of(sheet: Sheet) -> Nodes {
    return Nodes(node_of(sheet.a), node_of(sheet.b), node_of(sheet.c));
}

// Where a node is at a time of the step, seen from a point.
fn node_from(node: Node, p: vec3<u32>, time: f32) -> vec3<f32> {
    return between(p, node.place) + node.velocity * time;
}

fn corners_of(nodes: Nodes, p: vec3<u32>, v: vec3<f32>, start: f32, end: f32) -> Corners {
    let span = end - start;
    return Corners(
        node_from(nodes.a, p, start),
        node_from(nodes.b, p, start),
        node_from(nodes.c, p, start),
        (nodes.a.velocity - v) * span,
        (nodes.b.velocity - v) * span,
        (nodes.c.velocity - v) * span,
    );
}

// The place of the particle on the triangle when a share of the flight is done; `way` is how far it comes, seen from the triangle.
fn on_sheet(corners: Corners, u: f32) -> OnSheet {
    let a = corners.a + corners.wa * u;
    let b = corners.b + corners.wb * u;
    let c = corners.c + corners.wc * u;
    let normal = cross(b - a, c - a);
    let size2 = dot(normal, normal);
    if (size2 == 0.0) {
        return OnSheet(normal, vec3<f32>(0.0), false);
    }
    let areas = vec3<f32>(dot(cross(b, c), normal), dot(cross(c, a), normal), dot(cross(a, b), normal));
    let weights = areas / (areas.x + areas.y + areas.z);
    let way = corners.wa * weights.x + corners.wb * weights.y + corners.wc * weights.z;
    let size = sqrt(size2);
    // Over the sine of the angle.
    let reach = SHEET_REACH * SHEET_GAP * size * min(length(way) * size / max(abs(dot(way, normal)), 1e-30), 1e4);
    let edges = vec3<f32>(length(c - b), length(a - c), length(b - a));
    return OnSheet(normal, weights, all(areas >= -reach * edges));
}

fn cubic(g: vec4<f32>, u: f32) -> f32 {
    return g.x + u * (g.y + u * (g.z + u * g.w));
}

// The zeros of a cubic's slope, g.y + 2 g.z u + 3 g.w u^2, in order; beyond 1 where there are none.
fn bends_of(g: vec4<f32>) -> vec2<f32> {
    let discriminant = g.z * g.z - 3.0 * g.w * g.y;
    if (discriminant < 0.0) {
        return vec2<f32>(2.0);
    }
    let root = sqrt(discriminant);
    let q = -(g.z + select(-root, root, g.z >= 0.0));
    let one = select(q / (3.0 * g.w), 2.0, g.w == 0.0);
    let other = select(g.y / q, 2.0, q == 0.0);
    return vec2<f32>(min(one, other), max(one, other));
}

// As near a zero is found.
const NEAR_ZERO: f32 = 1.2e-7;

// Where a cubic falls to zero between two places between which it has no bend, above zero at the first: a place behind it. A straight line between both tells
// nearly where; that is tried on both sides. However it bends, the stretch is halved as well.
fn fall_between(g: vec4<f32>, from_u: f32, to_u: f32) -> f32 {
    var low = vec2<f32>(from_u, cubic(g, from_u));
    var high = vec2<f32>(to_u, cubic(g, to_u));
    for (var k = 0u; k < 24u && high.x - low.x > NEAR_ZERO; k++) {
        let guess = low.x + (high.x - low.x) * (low.y / (low.y - high.y));
        let tried = vec3<f32>(max(guess - 0.5 * NEAR_ZERO, low.x), min(guess + 0.5 * NEAR_ZERO, high.x), 0.5 * (low.x + high.x));
        for (var place = 0u; place < 3u; place++) {
            let u = tried[place];
            let value = vec2<f32>(u, cubic(g, u));
            if (u > low.x && u < high.x) {
                low = select(low, value, value.y > 0.0);
                high = select(value, high, value.y > 0.0);
            }
        }
    }
    return high.x;
}

// The first u in 0 .. 1 at which a cubic falls below zero, or 2. Between its bends it rises or falls throughout.
fn first_fall(g: vec4<f32>) -> f32 {
    let bends = bends_of(g);
    let first = select(0.0, bends.x, bends.x > 0.0 && bends.x < 1.0);
    let second = select(first, bends.y, bends.y > first && bends.y < 1.0);
    let values = vec4<f32>(g.x, cubic(g, first), cubic(g, second), cubic(g, 1.0));
    var stretch = vec2<f32>(second, 1.0);
    if (values.x > 0.0 && values.y <= 0.0) {
        stretch = vec2<f32>(0.0, first);
    } else if (values.y > 0.0 && values.z <= 0.0) {
        stretch = vec2<f32>(first, second);
    } else if (values.z <= 0.0 || values.w > 0.0) {
        return 2.0;
    }
    return fall_between(g, stretch.x, stretch.y);
}

// The signed volume's coefficients.
fn signed_volume(corners: Corners) -> vec4<f32> {
    let e1 = corners.b - corners.a;
    let e2 = corners.c - corners.a;
    let d1 = corners.wb - corners.wa;
    let d2 = corners.wc - corners.wa;
    let n0 = cross(e1, e2);
    let n1 = cross(e1, d2) + cross(d1, e2);
    let n2 = cross(d1, d2);
    return -vec4<f32>(
        dot(corners.a, n0),
        dot(corners.wa, n0) + dot(corners.a, n1),
        dot(corners.wa, n1) + dot(corners.a, n2),
        dot(corners.wa, n2),
    );
}

// +1 where the particle's side of a sheet is that of its normal, else -1. `volume` is that at the start of its flight.
fn own_side(sheet: Sheet, inside: bool, volume: f32) -> f32 {
    if (sheet.closed != 0u) {
        return select(1.0, -1.0, inside);
    }
    return select(-1.0, 1.0, volume >= 0.0);
}

// Whether all corners stay on one side of the particle along a direction, and farther than fabric is listed or f32 may be wrong by.
fn apart(corners: Corners, direction: vec3<f32>) -> bool {
    let before = vec3<f32>(dot(corners.a, direction), dot(corners.b, direction), dot(corners.c, direction));
    let after = before + vec3<f32>(dot(corners.wa, direction), dot(corners.wb, direction), dot(corners.wc, direction));
    let margin = length(direction) * (f32(SHEET_MARGIN) * SHEET_GAP + 1e-6 * (manhattan(corners.a) + manhattan(corners.wa)));
    let least = min(before, after);
    let most = max(before, after);
    return min(min(least.x, least.y), least.z) > margin || max(max(most.x, most.y), most.z) < -margin;
}

// Whether a triangle passes beside the particle: along its normal at the start, or across one of its edges.
fn passes_beside(corners: Corners) -> bool {
    let ab = corners.b - corners.a;
    let ac = corners.c - corners.a;
    let normal = cross(ab, ac);
    return apart(corners, normal)
        || apart(corners, cross(normal, ab))
        || apart(corners, cross(normal, ac))
        || apart(corners, cross(normal, ac - ab));
}

// What share of a flight is done when it meets a triangle, or 2.
fn meeting(sheet: Sheet, corners: Corners, inside: bool) -> f32 {
    let volume = signed_volume(corners);
    let side = own_side(sheet, inside, volume.x);
    let g = volume * side;
    let size = length(cross(corners.b - corners.a, corners.c - corners.a));
    let gap = SHEET_GAP * size;
    if (g.x - (abs(g.y) + abs(g.z) + abs(g.w)) > gap) {
        return 2.0;
    }
    if (g.x <= gap && g.x >= -SHEET_BEHIND * gap) {
        let place = on_sheet(corners, 0.0);
        let way = corners.wa * place.weights.x + corners.wb * place.weights.y + corners.wc * place.weights.z;
        // The triangle comes nearer.
        if (place.within && dot(way, place.normal) * side > 0.0) {
            return 0.0;
        }
    }
    // Where it comes near, and if that is beyond the edges where it passes the plane.
    let near = first_fall(g - vec4<f32>(gap, 0.0, 0.0, 0.0));
    if (near <= 1.0 && on_sheet(corners, near).within) {
        return near;
    }
    let across = first_fall(g);
    if (across <= 1.0 && on_sheet(corners, across).within) {
        return across;
    }
    return 2.0;
}

// What is hit: a wall or fabric.
struct Struck {
    // The unit normal to the side of the particle.
    normal: vec3<f32>,
    surface: u32,
    // The velocity of the surface at that place, m/s.
    velocity: vec3<f32>,
    surface_model: u32,
    // The tally of its work, or NOBODY: it is at rest.
    work: u32,
    // How far from the surface the particle is left, m: of a wall, on it.
    lift: f32,
    // Of fabric: the triangle, or NOBODY, and the weights of its nodes at that place.
    sheet: u32,
    weights: vec3<f32>,
}

// A flight of x0 + v t from `start` on, at the time at which it meets a triangle of fabric.
fn struck_sheet(index: u32, x0: vec3<u32>, v: vec3<f32>, start: f32, time: f32, inside: bool) -> Struck {
    let sheet = fabric[index];
    let moving = nodes_of(sheet);
    let flight = corners_of(moving, shifted(x0, v, start), v, start, step.dt);
    let side = own_side(sheet, inside, signed_volume(flight).x);
    let here = corners_of(moving, shifted(x0, v, time), v, time, time + step.dt);
    let place = on_sheet(here, 0.0);
    let normal = side * normalize(place.normal);
    let velocity = moving.a.velocity * place.weights.x
        + moving.b.velocity * place.weights.y
        + moving.c.velocity * place.weights.z;
    // The side that the normal points to first.
    let surface = select(sheet.surface + select(1u, 0u, side > 0.0), NOBODY, sheet.surface == NOBODY);
    let model = select(sheet.surface_model + select(1u, 0u, side > 0.0), NOBODY, sheet.surface_model == NOBODY);
    let lift = SHEET_GAP + dot(here.a, normal);
    return Struck(normal, surface, velocity, model, sheet.work, lift, index, place.weights);
}

// That a flight came to a cell in which no triangles are listed here: the interval must run again with more.
var<private> beyond_lists: bool;

// The record of a cell, from 1, or 0: it has no fabric.
fn fabric_record(c: vec3<u32>) -> u32 {
    if (!has_fabric_list(c)) {
        beyond_lists = true;
        return 0u;
    }
    return fabric_cells[FABRIC_FIRST + fabric_list(c)];
}

fn manhattan(v: vec3<f32>) -> f32 {
    return abs(v.x) + abs(v.y) + abs(v.z);
}

// A way between two points, seen from the middle of a cell, in cells.
struct Way {
    from_end: vec3<f32>,
    to_end: vec3<f32>,
}

fn way_in(c: vec3<u32>, p: vec3<u32>, q: vec3<u32>) -> Way {
    return Way(from_middle(c, p), from_middle(c, q));
}

// What f32 may be wrong by in places of a way, and the margin in which fabric is listed.
fn way_margin(way: Way) -> f32 {
    return 1e-6 * (manhattan(way.from_end) + manhattan(way.to_end)) + sheet_margin() / f32(1u << CELL_BITS);
}

// Whether a way, whose box touches the cell, does: else the cross product with it of its middle is too large.
fn touches_cell(way: Way) -> bool {
    let along = way.to_end - way.from_end;
    let moment = abs(cross(0.5 * (way.from_end + way.to_end), along));
    let margin = way_margin(way);
    let far = manhattan(way.from_end) + manhattan(way.to_end);
    return all(moment <= (0.5 + margin) * (vec3<f32>(manhattan(along)) - abs(along)) + margin * far);
}

fn record_at(listed: u32) -> vec4<u32> {
    return fabric_entries[arrayLength(&fabric_entries) / 2u + listed - 1u];
}

// The first entry of a cell, from 1, that a way may meet, or 0: also where it stays on one side of the cell's slab.
fn first_on_way(c: vec3<u32>, way: Way) -> u32 {
    if (!touches_cell(way)) {
        return 0u;
    }
    let listed = fabric_record(c);
    if (listed == 0u) {
        return 0u;
    }
    let record = record_at(listed);
    let slab = slab_of(record.xy);
    let ends = vec2<f32>(dot(slab.normal, way.from_end), dot(slab.normal, way.to_end));
    let margin = way_margin(way);
    let passes = min(ends.x, ends.y) <= slab.high + margin && max(ends.x, ends.y) >= slab.low - margin;
    return select(0u, record.z, passes);
}

// Whether a way passes an entry's box.
fn passes_box(entry: vec4<u32>, way: Way) -> bool {
    let low = bytes_of(entry.z).xyz * (0.5 / BOX_STEPS);
    let high = bytes_of(entry.w).xyz * (0.5 / BOX_STEPS);
    let margin = vec3<f32>(way_margin(way));
    return all(max(way.from_end, way.to_end) + margin >= low) && all(min(way.from_end, way.to_end) - margin <= high);
}

// Whether fabric may be in one of the 27 cells around.
fn near_fabric(c: vec3<u32>) -> bool {
    let o = c - step.fabric_low;
    let last = vec3<u32>(CELLS_X, CELLS_Y, CELLS_Z) - 1u;
    // What is beyond the outermost cells with lists they do not know.
    if (any(o >= step.fabric_size) || any((o == vec3<u32>(0u)) & (c != vec3<u32>(0u))) || any((o == step.fabric_size - 1u) & (c != last))) {
        return true;
    }
    let cell = fabric_list(c);
    return ((fabric_cells[fabric_bits() + (cell >> 5u)] >> (cell & 31u)) & 1u) != 0u;
}

// Whether a triangle of fabric, from either side, lies between two points at a time of the step.
fn sheet_between(index: u32, p: vec3<u32>, along: vec3<f32>, time: f32) -> bool {
    let moving = nodes_of(fabric[index]);
    let a = node_from(moving.a, p, time);
    let b = node_from(moving.b, p, time);
    let c = node_from(moving.c, p, time);
    let normal = cross(b - a, c - a);
    let before = dot(a, normal);
    let after = dot(a - along, normal);
    if ((before > 0.0) == (after > 0.0)) {
        return false;
    }
    let place = along * (before / (before - after));
    let areas = vec3<f32>(
        dot(cross(b - place, c - place), normal),
        dot(cross(c - place, a - place), normal),
        dot(cross(a - place, b - place), normal),
    );
    let size = length(normal);
    let reach = SHEET_REACH * SHEET_GAP * size * min(length(along) * size / max(abs(before - after), 1e-30), 1e4);
    return all(areas >= -reach * vec3<f32>(length(c - b), length(a - c), length(b - a)));
}
