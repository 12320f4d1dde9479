//! uses: grid.wgsl motions.wgsl
// The body frame of a moving wall is that in which it stays where it is at the start of the run. Lists of its triangles in each
// cell of a box around it there (src/geometry/triangle_grid.rs).

// Of the walls at rest the triangles of the cells near walls (walls.wgsl), behind them those of each moving wall, first the triangles,
// then of each cell where these begin, in words of this list; and the same of its rows of cells along x.
var<storage, read> wall_list: array<u32>;

// The cells of a moving wall's box that the box around a way in its body frame touches, from the first of them on; maybe none.
struct BodyCells {
    low: vec3<i32>,
    high: vec3<i32>,
}

fn body_cells(motion: Motion, p: vec3<u32>, q: vec3<u32>) -> BodyCells {
    let first = bitcast<vec3<i32>>(motion.body_low);
    let a = signed_cell(p) - first;
    let b = signed_cell(q) - first;
    return BodyCells(max(min(a, b), vec3<i32>(0)), min(max(a, b), bitcast<vec3<i32>>(motion.body_size) - 1));
}

// Where in `wall_list` the triangles are of the cells in a row of them.
fn body_list(motion: Motion, cells: BodyCells, y: i32, z: i32) -> vec2<u32> {
    let size = bitcast<vec3<i32>>(motion.body_size);
    let row = motion.cells + u32((z * size.y + y) * size.x);
    // (A row without a cell, which may lie beyond the box, is not looked for.)
    let empty = cells.low.x > cells.high.x;
    let begin = row + select(u32(cells.low.x), 0u, empty);
    return vec2<u32>(wall_list[begin], wall_list[select(row + u32(cells.high.x) + 1u, begin, empty)]);
}

// Whether any of the cells has a triangle.
fn any_of_body(motion: Motion, cells: BodyCells) -> bool {
    // bench: plane of cells
    for (var z = cells.low.z; z <= cells.high.z; z++) {
        // bench: row of cells
        for (var y = cells.low.y; y <= cells.high.y; y++) {
            let list = body_list(motion, cells, y, z);
            if (list.x < list.y) {
                return true;
            }
        }
    }
    return false;
}

// How far the place of a cell in the frame of a moving wall may be off, in edges: the way is rounded to quanta.
const PLACE_OFF: f32 = 5e-5;

// The cells of a moving wall's box that a cell's place in its body frame touches, and a little more.
fn body_around(c: vec3<u32>, motion: Motion) -> BodyCells {
    let corner = (c << vec3<u32>(CELL_BITS)) - bitcast<vec3<u32>>(motion.moved);
    let off = vec3<u32>(u32(PLACE_OFF * f32(1u << CELL_BITS)));
    return body_cells(motion, corner - off, corner + (1u << CELL_BITS) + off);
}

// Whether a moving wall may be in a cell at the start of this step.
fn moving_in(c: vec3<u32>) -> bool {
    if (MOVING) {
        for (var m = 0u; m < MOTIONS; m++) {
            let motion = motion_of(m);
            if (in_motion(c, motion) && any_of_body(motion, body_around(c, motion))) {
                return true;
            }
        }
    }
    return false;
}
