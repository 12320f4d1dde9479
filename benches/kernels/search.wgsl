// The search of neighbours among points that are in the order of their cells: how the cells around are walked, and how
// large they are. Points are three words of 10 bits in one.
//
// Reads `places`, `cells` and `cell_start`; writes `found` and `neighbours` (the k-th of s at k * COUNT + s).

override WORKGROUP: u32 = 64;
override COUNT: u32;
// Cells along an edge, with a border of REACH on either side.
override EDGE: u32;
override REACH: u32;
// Cells next to each other in x as one range, or each by itself.
override ROWS: bool;
override NEAR2: u32;
override LIST: u32;

@group(0) @binding(0) var<storage, read> places: array<u32>;
@group(0) @binding(1) var<storage, read> cells: array<u32>;
@group(0) @binding(2) var<storage, read> cell_start: array<u32>;
@group(0) @binding(3) var<storage, read_write> found: array<u32>;
@group(0) @binding(4) var<storage, read_write> neighbours: array<u32>;

fn distance2(a: u32, b: u32) -> u32 {
    let x = i32(b & 1023u) - i32(a & 1023u);
    let y = i32((b >> 10u) & 1023u) - i32((a >> 10u) & 1023u);
    let z = i32(b >> 20u) - i32(a >> 20u);
    return u32(x * x + y * y + z * z);
}

@compute @workgroup_size(WORKGROUP)
fn search(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let s = id.x + id.y * groups.x * WORKGROUP;
    if (s >= COUNT) {
        return;
    }
    let place = places[s];
    let side = 2u * REACH + 1u;
    let corner = cells[s] - REACH * (EDGE * EDGE + EDGE + 1u);
    let parts = select(side, 1u, ROWS);
    var count = 0u;
    for (var part = 0u; part < side * side * parts; part++) {
        let row = part / parts;
        let first = corner + (row / side) * EDGE * EDGE + (row % side) * EDGE + part % parts;
        let end = cell_start[first + select(1u, side, ROWS)];
        for (var j = cell_start[first]; j < end; j++) {
            if (distance2(place, places[j]) < NEAR2 && j != s) {
                if (count < LIST) {
                    neighbours[count * COUNT + s] = j;
                }
                count++;
            }
        }
    }
    found[s] = count;
}
