//! uses: fabric.wgsl fabric_room.wgsl particle.wgsl lists.wgsl turns.wgsl
//! phase: fabric
// Bounds what fabric there is in each cell by two parallel planes, and tells the cells around that there is some.
//
// The planes' normal is that of the cell's triangle of the lowest number. What a triangle sweeps in the step lies as far from its plane at the start as
// `fabric_swept` has it, and what matters here in the cell, in the box of its entry. With the cell's middle m, the planes' normal n, the
// triangle's t, a point a of its plane and k = n . t a place x has
//
//     n . (x - m) = k t . (a - m) + k t . (x - a) + (n - k t) . (x - m),
//
// of which the last term is at most half a cell times the sum of the vector's sizes. Of each triangle the narrowest of these bounds counts, and
// a margin. A flight that stays on one side of the slab meets no fabric in the cell.
//
// Reads `fabric_swept`; reads and writes `fabric_cells` and `fabric_entries`. One thread per cell that has entries. Neither the least nor the
// largest of some numbers depends on their order.

var<uniform> step: Step;
var<storage, read_write> fabric_cells: array<atomic<u32>>;
var<storage, read> fabric_swept: array<Swept>;

// What a vector's product with any point of a cell is at most, seen from the middle.
fn half_cell(v: vec3<f32>) -> f32 {
    return 0.5 * (abs(v.x) + abs(v.y) + abs(v.z));
}

fn sum_of(v: vec3<f32>) -> f32 {
    return v.x + v.y + v.z;
}

fn margin_of_slab() -> f32 {
    return 1.1 * sheet_margin() / f32(1u << CELL_BITS);
}

// The least and the largest of n . (x - m) that a triangle has in a cell; `box` is that of its entry.
fn bounds_of(entry: vec4<u32>, c: vec3<u32>, n: vec3<f32>) -> vec2<f32> {
    let low = n * bytes_of(entry.z).xyz;
    let high = n * bytes_of(entry.w).xyz;
    let box = vec2<f32>(sum_of(min(low, high)), sum_of(max(low, high))) * (0.5 / BOX_STEPS);
    let swept = fabric_swept[entry.x];
    let k = dot(n, swept.normal);
    let at = k * dot(swept.normal, from_middle(c, swept.corner));
    let away = abs(k) * swept.away / f32(1u << CELL_BITS) + half_cell(n - k * swept.normal);
    return vec2<f32>(max(box.x, at - away) - margin_of_slab(), min(box.y, at + away) + margin_of_slab());
}

fn mark(cell: u32, bits: u32) {
    let word = fabric_bits() + (cell >> 5u);
    atomicOr(&fabric_cells[word], bits << (cell & 31u));
    // What is left of them in the next word.
    let high = select(bits >> (32u - (cell & 31u)), 0u, (cell & 31u) == 0u);
    if (high != 0u) {
        atomicOr(&fabric_cells[word + 1u], high);
    }
}

fn mark_around(c: vec3<u32>) {
    let low = max(c, step.fabric_low + 1u) - 1u;
    let high = min(c + 1u, step.fabric_low + step.fabric_size - 1u);
    let bits = (1u << (high.x - low.x + 1u)) - 1u;
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            mark(fabric_list(vec3<u32>(low.x, y, z)), bits);
        }
    }
}

// The planes' normal, of components from -SLAB_NORMAL to that.
fn normal_of(first: u32) -> vec3<f32> {
    var least = NOBODY;
    var next = first;
    while (next != 0u) {
        least = min(least, fabric_entries[next - 1u].x);
        next = fabric_entries[next - 1u].y;
    }
    through(0u, next);
    return round(fabric_swept[least].normal * SLAB_NORMAL);
}

@compute @workgroup_size(WORKGROUP)
fn bound_fabric(thread: Thread) {
    let listed = linear(thread);
    if (listed >= atomicLoad(&fabric_cells[FABRIC_LISTED])) {
        return;
    }
    let cell = fabric_entries[fabric_room() + listed].w;
    let c = cell_at(cell);
    let first = atomicLoad(&fabric_cells[FABRIC_FIRST + fabric_list(c)]);
    let normal = normal_of(first);
    var ends = vec2<f32>(2.0, -2.0);
    var next = first;
    while (next != 0u) {
        let entry = fabric_entries[next - 1u];
        let bounds = bounds_of(entry, c, normal / SLAB_NORMAL);
        // Else it only comes near the cell.
        if (bounds.x <= bounds.y) {
            ends = vec2<f32>(min(ends.x, bounds.x), max(ends.y, bounds.y));
        }
        next = entry.y;
    }
    through(0u, next);
    let steps = clamp(vec2<f32>(floor(ends.x * SLAB_STEPS), ceil(ends.y * SLAB_STEPS)), vec2<f32>(-32768.0), vec2<f32>(32767.0));
    let planes = (u32(i32(steps.x)) & 0xffffu) | (u32(i32(steps.y)) << 16u);
    fabric_entries[fabric_room() + listed] = vec4<u32>(packed_bytes(vec4<f32>(normal, 0.0)), planes, first, cell);
    atomicStore(&fabric_cells[FABRIC_FIRST + fabric_list(c)], listed + 1u);
    mark_around(c);
    tell_cut_short();
}
