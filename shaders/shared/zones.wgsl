//! uses: motions.wgsl has_fabric.wgsl
// Zones of a scene: everything, the chambers, the probes.

struct Zone {
    // Box: corners. Sphere: low is the centre. Cylinder: low is the base.
    low: vec3<u32>,
    kind: u32,
    high: vec3<u32>,
    // Radius of a sphere or a cylinder, m.
    radius: f32,
    // Cylinder: unit axis and height, m.
    axis: vec3<f32>,
    height: f32,
    // Box: the motions that its sides go along with, from 1, four bits for each: low x, y, z, high x, y, z. Inside of fabric: the first of its planes.
    carried: u32,
    // Inside of fabric: how many planes part it from other closed fabric. They are behind the zones; low is a point, and the axis points out.
    planes: u32,
    pad2: u32,
    pad3: u32,
}

const EVERYWHERE: u32 = 0;
const BOX: u32 = 1;
const SPHERE: u32 = 2;
const CYLINDER: u32 = 3;
// What is inside of closed fabric, and in the box of corners.
const INSIDE_FABRIC: u32 = 4;

var<storage, read> zones: array<Zone>;

// How far three sides have moved by the end of the step, each along its axis, quanta.
fn sides_moved(carried: u32) -> vec3<u32> {
    var by = vec3<u32>(0u);
    for (var axis = 0u; axis < 3u; axis++) {
        let m = (carried >> (4u * axis)) & 15u;
        if (m > 0u) {
            let motion = motion_of(m - 1u);
            by[axis] = shifted(bitcast<vec3<u32>>(motion.moved), motion.velocity, step.dt)[axis];
        }
    }
    return by;
}

// Whether a place, inside of closed fabric or not, is in a zone.
fn contains(zone: Zone, p: vec3<u32>, inside: bool) -> bool {
    if (FABRIC && zone.kind == INSIDE_FABRIC) {
        if (!inside || any(p < zone.low) || any(p >= zone.high)) {
            return false;
        }
        for (var k = zone.carried; k < zone.carried + zone.planes; k++) {
            if (dot(between(zones[k].low, p), zones[k].axis) > 0.0) {
                return false;
            }
        }
        return true;
    }
    if (zone.kind == BOX) {
        if (MOVING && zone.carried != 0u) {
            let low = zone.low + sides_moved(zone.carried);
            let high = zone.high + sides_moved(zone.carried >> 12u);
            return all(p >= low) && all(p < high);
        }
        return all(p >= zone.low) && all(p < zone.high);
    }
    // bench: everywhere
    if (zone.kind == EVERYWHERE) {
        return true;
    }
    let d = between(zone.low, p);
    if (zone.kind == SPHERE) {
        return dot(d, d) < zone.radius * zone.radius;
    }
    let along = dot(d, zone.axis);
    let away = d - along * zone.axis;
    return along >= 0.0 && along < zone.height && dot(away, away) < zone.radius * zone.radius;
}

// Whether a chamber before this zone has a place.
fn earlier_has(zone: u32, p: vec3<u32>, inside: bool) -> bool {
    for (var earlier = 1u; earlier < zone; earlier++) {
        if (contains(zones[earlier], p, inside)) {
            return true;
        }
    }
    return false;
}
