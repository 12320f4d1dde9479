//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl cap.wgsl nearness.wgsl neighbour_list.wgsl
// The search for the particles near enough to collide with a particle in this step, whatever the rounds do to
// their velocities: mid-step points nearer than `near2` says, in the longest steps the cell edge (which the plan makes at
// least sqrt(sigma^2 + (g_max dt/2)^2), specification, section 2); by up to two units of packing more. Cells that lie
// farther away are passed over.
//
// Reads `middles`, `cells`, `cell_start`, where the diameter is capped `flights`; writes `neighbours`.

@group(0) @binding(8) var<storage, read> cell_start: array<u32>;
@group(0) @binding(11) var<storage, read> flights: array<Flight>;
@group(0) @binding(12) var<storage, read> middles: array<u32>;
@group(0) @binding(13) var<storage, read_write> neighbours: array<u32>;
@group(0) @binding(14) var<storage, read_write> neighbour_count: array<u32>;
@group(0) @binding(27) var<storage, read> cells: array<u32>;

struct Found {
    count: u32,
    // NEAR_WALL of the particle and of all that were found.
    flags: u32,
}

// How far a point at `at` within its cell, in 1/128 of it, is at least from points in the cell before (-1), its own, or
// the next (1).
fn gap(at: i32, side: i32) -> i32 {
    return select(select(0, at + 1, side < 0), 128 - at, side > 0);
}

// Writes what it finds: the first `direct` interleaved, the others, where there is a tail, there.
fn search(s: u32, direct: u32, tail: u32) -> Found {
    let middle = middles[s];
    let corner = cells[s] - step.size.x * step.size.y - step.size.x - 1u;
    let stride = arrayLength(&neighbour_count);
    var share = FULL_SHARE;
    if (CAPPED) {
        share = share_of(flights[s]);
    }
    let own_near2 = near2(share);
    let at = vec3<i32>(vec3<u32>(middle, middle >> 10u, middle >> 20u) & vec3<u32>(127u));
    let before = gap(at.x, -1) * gap(at.x, -1);
    let after = gap(at.x, 1) * gap(at.x, 1);
    let astray = (middle & ASTRAY) != 0u;
    var found = 0u;
    var flags = middle;
    for (var row = 0u; row < 9u; row++) {
        let y = gap(at.y, i32(row % 3u) - 1);
        let z = gap(at.z, i32(row / 3u) - 1);
        let left = select(own_near2 - y * y - z * z, own_near2, astray);
        if (left <= 0) {
            continue;
        }
        // Rows of three cells, neighbours in memory, without those too far away; the border layer makes every index valid.
        let first = corner + (row / 3u) * step.size.x * step.size.y + (row % 3u) * step.size.x;
        let end = cell_start[first + select(2u, 3u, after < left || astray)];
        for (var j = cell_start[first + select(1u, 0u, before < left || astray)]; j < end; j++) {
            let other = middles[j];
            let distance2 = packed_distance2(middle, other);
            // Of the pair's diameter, so that either is in the other's list.
            if (distance2 < own_near2 && j != s && (!CAPPED || distance2 < near2(share_of(flights[j])))) {
                flags |= other;
                if (found < direct || tail != NOBODY) {
                    neighbours[select(tail + found, found * stride + s, found < direct)] = j;
                }
                found++;
            }
        }
    }
    return Found(found, flags);
}
