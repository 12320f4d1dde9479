//! uses: fabric.wgsl fabric_room.wgsl particle.wgsl lists.wgsl
//! phase: fabric
// Lists the triangles of fabric by the cells that they may touch in the step.
//
// A cell is touched if it overlaps the box around the triangle at the start and at the end, and lies as near to the triangle's plane as its
// corners come in the step. More cells than need be change nothing: who finds a triangle there does not hit it.
//
// Reads `nodes` and `fabric`; writes `fabric_swept`, `fabric_entries` and `fabric_cells`, which the host has cleared: of a cell with fabric the number
// of the first entry, for `bound_fabric`. One thread per triangle. The order of a cell's entries
// is that of the threads; of several hits the earliest counts, ties by triangle.

var<uniform> step: Step;
var<storage, read_write> fabric_cells: array<atomic<u32>>;
var<storage, read_write> fabric_swept: array<Swept>;

// The first and the last cell of a box, m around it included.
struct Reach {
    low: vec3<u32>,
    high: vec3<u32>,
}

fn reach_of(low: vec3<i32>, high: vec3<i32>, origin: vec3<u32>) -> Reach {
    let last = vec3<i32>(i32(CELLS_X), i32(CELLS_Y), i32(CELLS_Z)) - 1;
    let a = clamp(signed_cell(origin + bitcast<vec3<u32>>(low)), vec3<i32>(0), last);
    let b = clamp(signed_cell(origin + bitcast<vec3<u32>>(high)), vec3<i32>(0), last);
    let first = vec3<i32>(step.fabric_low);
    // (Of none of the cells with lists high is below low.)
    return Reach(vec3<u32>(max(a, first)), vec3<u32>(min(b, first + vec3<i32>(step.fabric_size) - 1)));
}

// Enters a triangle in the list of a cell; `low` and `high` are the corners of a box around it, quanta from the middle.
fn enter(entry: u32, c: vec3<u32>, triangle: u32, low: vec3<i32>, high: vec3<i32>) {
    let next = atomicExchange(&fabric_cells[FABRIC_FIRST + fabric_list(c)], entry + 1u);
    let steps = 2.0 * BOX_STEPS / f32(1u << CELL_BITS);
    let least = clamp(floor(vec3<f32>(low) * steps), vec3<f32>(-BOX_STEPS), vec3<f32>(BOX_STEPS));
    let most = clamp(ceil(vec3<f32>(high) * steps), vec3<f32>(-BOX_STEPS), vec3<f32>(BOX_STEPS));
    let box = vec2<u32>(packed_bytes(vec4<f32>(least, 0.0)), packed_bytes(vec4<f32>(most, 0.0)));
    fabric_entries[entry] = vec4<u32>(triangle, next, box);
    if (next == 0u) {
        let listed = atomicAdd(&fabric_cells[FABRIC_LISTED], 1u);
        fabric_entries[fabric_room() + listed].w = cell_index(c);
    }
}

// A triangle's plane, and how far from it a cell's middle may be, quanta.
struct Plane {
    normal: vec3<f32>,
    corner: vec3<u32>,
    reach: f32,
}

fn middle_of(c: vec3<u32>) -> vec3<u32> {
    return (c << vec3<u32>(CELL_BITS)) + (1u << (CELL_BITS - 1u));
}

fn is_at(plane: Plane, c: vec3<u32>) -> bool {
    return abs(dot(plane.normal, vec3<f32>(bitcast<vec3<i32>>(middle_of(c) - plane.corner)))) <= plane.reach;
}

// How many cells of a box are at a plane.
fn count_of(cells: Reach, plane: Plane) -> u32 {
    var count = 0u;
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            for (var x = cells.low.x; x <= cells.high.x; x++) {
                count += select(0u, 1u, is_at(plane, vec3<u32>(x, y, z)));
            }
        }
    }
    return count;
}

@compute @workgroup_size(WORKGROUP)
fn list_fabric(thread: Thread) {
    let triangle = linear(thread);
    if (triangle >= arrayLength(&fabric)) {
        return;
    }
    let sheet = fabric[triangle];
    let corners = array<u32, 3>(sheet.a, sheet.b, sheet.c);
    let origin = node_before(sheet.a);
    var low = vec3<i32>(0);
    var high = vec3<i32>(0);
    for (var k = 0u; k < 3u; k++) {
        let before = bitcast<vec3<i32>>(node_before(corners[k]) - origin);
        let after = bitcast<vec3<i32>>(node_after(corners[k]) - origin);
        low = min(low, min(before, after));
        high = max(high, max(before, after));
    }
    let margin = vec3<i32>(i32(ceil(sheet_margin())));
    low -= margin;
    high += margin;
    let cells = reach_of(low, high, origin);
    if (any(cells.low > cells.high)) {
        return;
    }
    let normal = cross(between(origin, node_before(sheet.b)), between(origin, node_before(sheet.c)));
    let size = length(normal);
    let n = select(normal / size, vec3<f32>(0.0), size == 0.0);
    var farthest = 0.0;
    for (var k = 0u; k < 3u; k++) {
        let before = bitcast<vec3<i32>>(node_before(corners[k]) - origin);
        let after = bitcast<vec3<i32>>(node_after(corners[k]) - origin);
        farthest = max(farthest, max(abs(dot(n, vec3<f32>(before))), abs(dot(n, vec3<f32>(after)))));
    }
    let away = farthest + sheet_margin();
    // (Of one without area no plane tells anything.)
    fabric_swept[triangle] = Swept(n, select(away, 1e30, size == 0.0), origin, 0u);
    // (The last share is for rounding.)
    let half_cell = 0.5 * f32(1u << CELL_BITS) * (abs(n.x) + abs(n.y) + abs(n.z)) * 1.001;
    let plane = Plane(n, origin, half_cell + away);
    let count = count_of(cells, plane);
    var entry = atomicAdd(&fabric_cells[FABRIC_ENTRIES], count);
    if (entry + count > fabric_room()) {
        atomicAdd(&counters[MISPLACED], count);
        return;
    }
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            for (var x = cells.low.x; x <= cells.high.x; x++) {
                let c = vec3<u32>(x, y, z);
                if (is_at(plane, c)) {
                    let from_middle = bitcast<vec3<i32>>(origin - middle_of(c));
                    enter(entry, c, triangle, from_middle + low, from_middle + high);
                    entry++;
                }
            }
        }
    }
}
