//! uses: fabric.wgsl particle.wgsl lists.wgsl
//! phase: fabric
// Lists the triangles of fabric by the cells that they may touch in the step.
//
// A cell is touched if it overlaps the box around the triangle at the start and at the end, and lies as near to the triangle's plane as its
// corners come in the step. More cells than need be change nothing: who finds a triangle there does not hit it.
//
// Reads `nodes` and `fabric`; writes `fabric_planes`, and `fabric_cells`, which the host has cleared. One thread per triangle. The order of a cell's entries
// is that of the threads; of several hits the earliest counts, ties by triangle.

var<uniform> step: Step;
var<storage, read_write> fabric_cells: array<atomic<u32>>;
var<storage, read_write> fabric_planes: array<vec4<f32>>;

// The first and the last cell of a box, m around it included.
struct Reach {
    low: vec3<u32>,
    high: vec3<u32>,
}

fn reach_of(low: vec3<i32>, high: vec3<i32>, origin: vec3<u32>) -> Reach {
    let margin = vec3<i32>(i32(ceil(f32(SHEET_MARGIN) * SHEET_GAP * QUANTA)));
    let last = vec3<i32>(i32(CELLS_X), i32(CELLS_Y), i32(CELLS_Z)) - 1;
    let a = clamp(signed_cell(origin + bitcast<vec3<u32>>(low - margin)), vec3<i32>(0), last);
    let b = clamp(signed_cell(origin + bitcast<vec3<u32>>(high + margin)), vec3<i32>(0), last);
    return Reach(vec3<u32>(a), vec3<u32>(b));
}

fn mark(cell: u32, bits: u32) {
    let word = fabric_bits() + (cell >> 5u);
    let low = bits << (cell & 31u);
    if ((atomicLoad(&fabric_cells[word]) & low) != low) {
        atomicOr(&fabric_cells[word], low);
    }
    // What is left of them in the next word.
    let high = select(bits >> (32u - (cell & 31u)), 0u, (cell & 31u) == 0u);
    if (high != 0u && (atomicLoad(&fabric_cells[word + 1u]) & high) != high) {
        atomicOr(&fabric_cells[word + 1u], high);
    }
}

fn mark_around(c: vec3<u32>) {
    let low = max(c, vec3<u32>(1u)) - 1u;
    let high = min(c + 1u, vec3<u32>(CELLS_X, CELLS_Y, CELLS_Z) - 1u);
    let bits = (1u << (high.x - low.x + 1u)) - 1u;
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            mark(cell_index(vec3<u32>(low.x, y, z)), bits);
        }
    }
}

fn enter(cell: u32, triangle: u32) {
    let entry = atomicAdd(&fabric_cells[FABRIC_ENTRIES], 1u);
    let place = fabric_entries() + 2u * entry;
    if (place + 2u > arrayLength(&fabric_cells)) {
        atomicAdd(&counters[MISPLACED], 1u);
        return;
    }
    atomicStore(&fabric_cells[place], triangle);
    atomicStore(&fabric_cells[place + 1u], atomicExchange(&fabric_cells[FABRIC_FIRST + cell], entry + 1u));
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
    var farthest = 0.0;
    for (var k = 0u; k < 3u; k++) {
        let before = bitcast<vec3<i32>>(node_before(corners[k]) - origin);
        let after = bitcast<vec3<i32>>(node_after(corners[k]) - origin);
        low = min(low, min(before, after));
        high = max(high, max(before, after));
        farthest = max(farthest, length(vec3<f32>(after - before)));
    }
    let cells = reach_of(low, high, origin);
    let edge = f32(1u << CELL_BITS);
    let normal = cross(between(origin, node_before(sheet.b)), between(origin, node_before(sheet.c)));
    let size = length(normal);
    let n = select(normal / size, vec3<f32>(0.0), size == 0.0);
    let away = farthest + f32(SHEET_MARGIN) * SHEET_GAP * QUANTA;
    // (Of a triangle without area nothing is left out.)
    fabric_planes[triangle] = vec4<f32>(n, select(away * QUANTUM, 1e30, size == 0.0));
    // From the plane at the start to where a cell's middle may be, quanta; the last share is for rounding.
    let slab = 0.5 * edge * (abs(n.x) + abs(n.y) + abs(n.z)) * 1.001 + away;
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            for (var x = cells.low.x; x <= cells.high.x; x++) {
                let c = vec3<u32>(x, y, z);
                let middle = (c << vec3<u32>(CELL_BITS)) + (1u << (CELL_BITS - 1u));
                if (abs(dot(n, vec3<f32>(bitcast<vec3<i32>>(middle - origin)))) <= slab) {
                    enter(cell_index(c), triangle);
                    mark_around(c);
                }
            }
        }
    }
}
