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
// The unit normal of each triangle at the start of the step, and how far from that plane it comes in the step, m (list_fabric.wgsl).
var<storage, read> fabric_planes: array<vec4<f32>>;

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

// Whether a flight, of which two points are given that it flies between, stays on one side of all that a triangle sweeps in the step.
fn stays_off(triangle: u32, node: u32, p: vec3<u32>, q: vec3<u32>) -> bool {
    let plane = fabric_planes[triangle];
    let corner = node_before(node);
    let ends = vec2<f32>(dot(plane.xyz, between(corner, p)), dot(plane.xyz, between(corner, q)));
    return min(ends.x, ends.y) > plane.w || max(ends.x, ends.y) < -plane.w;
}

// How far a node comes in the step, m.
fn node_way(node: u32) -> vec3<f32> {
    return between(node_before(node), node_after(node));
}

// The velocity of a node, m/s.
fn node_velocity(node: u32) -> vec3<f32> {
    return node_way(node) / step.dt;
}

// Where a node is at a time of the step, seen from a point.
fn node_from(node: u32, p: vec3<u32>, time: f32) -> vec3<f32> {
    return between(p, node_before(node)) + node_velocity(node) * time;
}

fn corners_of(sheet: Sheet, p: vec3<u32>, v: vec3<f32>, start: f32, end: f32) -> Corners {
    let span = end - start;
    return Corners(
        node_from(sheet.a, p, start),
        node_from(sheet.b, p, start),
        node_from(sheet.c, p, start),
        (node_velocity(sheet.a) - v) * span,
        (node_velocity(sheet.b) - v) * span,
        (node_velocity(sheet.c) - v) * span,
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

// The first u in 0 .. 1 at which a cubic falls below zero, or 2. Between the zeros of its slope it rises or falls throughout; there it is
// bracketed and halved.
fn first_fall(g: vec4<f32>) -> f32 {
    // Zeros of g.y + 2 g.z u + 3 g.w u^2, in order.
    var bends = vec2<f32>(2.0);
    let discriminant = g.z * g.z - 3.0 * g.w * g.y;
    if (discriminant >= 0.0) {
        let root = sqrt(discriminant);
        let q = -(g.z + select(-root, root, g.z >= 0.0));
        let one = select(q / (3.0 * g.w), 2.0, g.w == 0.0);
        let other = select(g.y / q, 2.0, q == 0.0);
        bends = vec2<f32>(min(one, other), max(one, other));
    }
    var low = 0.0;
    var at_low = g.x;
    for (var stretch = 0u; stretch < 3u; stretch++) {
        var high = 1.0;
        if (stretch < 2u) {
            high = bends[stretch];
            if (!(high > low && high < 1.0)) {
                continue;
            }
        }
        let at_high = cubic(g, high);
        if (at_low > 0.0 && at_high <= 0.0) {
            for (var k = 0u; k < 24u; k++) {
                let middle = 0.5 * (low + high);
                if (cubic(g, middle) > 0.0) {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            return high;
        }
        low = high;
        at_low = at_high;
    }
    return 2.0;
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
    let flight = corners_of(sheet, shifted(x0, v, start), v, start, step.dt);
    let side = own_side(sheet, inside, signed_volume(flight).x);
    let here = corners_of(sheet, shifted(x0, v, time), v, time, time + step.dt);
    let place = on_sheet(here, 0.0);
    let normal = side * normalize(place.normal);
    let velocity = node_velocity(sheet.a) * place.weights.x
        + node_velocity(sheet.b) * place.weights.y
        + node_velocity(sheet.c) * place.weights.z;
    // The side that the normal points to first.
    let surface = select(sheet.surface + select(1u, 0u, side > 0.0), NOBODY, sheet.surface == NOBODY);
    let lift = SHEET_GAP + dot(here.a, normal);
    return Struck(normal, surface, velocity, sheet.surface_model, sheet.work, lift, index, place.weights);
}

fn first_of_cell(c: vec3<u32>) -> u32 {
    return fabric_cells[FABRIC_FIRST + cell_index(c)];
}

// An entry: a triangle, and the next entry.
fn fabric_entry(entry: u32) -> vec2<u32> {
    let place = fabric_entries() + 2u * (entry - 1u);
    return vec2<u32>(fabric_cells[place], fabric_cells[place + 1u]);
}

// Whether fabric may be in one of the 27 cells around.
fn near_fabric(c: vec3<u32>) -> bool {
    let cell = cell_index(c);
    return ((fabric_cells[fabric_bits() + (cell >> 5u)] >> (cell & 31u)) & 1u) != 0u;
}

// Whether a triangle of fabric, from either side, lies between two points at a time of the step.
fn sheet_between(index: u32, p: vec3<u32>, along: vec3<f32>, time: f32) -> bool {
    let sheet = fabric[index];
    let a = node_from(sheet.a, p, time);
    let b = node_from(sheet.b, p, time);
    let c = node_from(sheet.c, p, time);
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
