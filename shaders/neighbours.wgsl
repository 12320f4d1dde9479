//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl counters.wgsl lists.wgsl asked.wgsl cap.wgsl
// Lists the particles near enough to collide with each particle in this step, whatever the rounds do to
// their velocities: mid-step points nearer than the cell edge (which the plan makes at least
// sqrt(sigma^2 + (g_max dt/2)^2), specification, section 2), or by a hundredth more; nearer by what the smaller diameter
// lacks where gas is dense.
//
// Reads `middles`, `cells`, `cell_start`, where the diameter is capped `flights`; writes `neighbours` (the k-th of particle s at k * stride + s)
// and `neighbour_count`, and appends to `screened` whose neighbours may be behind a wall. One thread per
// particle, or per ghost that was asked (asked.wgsl), which writes its own list. Where a list is too short, the longest one wanted is kept, and the
// host runs the interval again with longer lists.

override VENTS: bool = true;
// The square of the largest diameter, in 1/128 cells, rounded down.
override DIAMETER_REACH2: u32;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(8) var<storage, read> cell_start: array<u32>;
@group(0) @binding(11) var<storage, read> flights: array<Flight>;
@group(0) @binding(12) var<storage, read> middles: array<u32>;
@group(0) @binding(13) var<storage, read_write> neighbours: array<u32>;
@group(0) @binding(14) var<storage, read_write> neighbour_count: array<u32>;
@group(0) @binding(25) var<storage, read_write> screened: array<u32>;
@group(0) @binding(27) var<storage, read> cells: array<u32>;
@group(0) @binding(32) var<storage, read_write> layers: array<u32>;

// The square of the distance, in 1/128 cells, up to which a particle with this share of the cross-section may collide.
fn reach2(share: u32) -> i32 {
    return PACKED_REACH2 - i32((DIAMETER_REACH2 * (FULL_SHARE - share)) / FULL_SHARE);
}

@compute @workgroup_size(WORKGROUP)
fn neighbours_of(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    var s = linear(id, groups);
    let late = step.ghosts == GHOSTS_ASKED;
    if (late) {
        s = asked_of(s);
        if (s == NOBODY || (layers[s] & SEARCHED) != 0u) {
            return;
        }
    } else if (s >= step.total) {
        return;
    }
    // The outermost ghosts have no neighbours beyond them here, and choose nobody; nor do slots without particle.
    let layer = layers[s] & LAYER;
    if ((VENTS || step.depth > 0u) && (layer >= max(step.depth, 1u) || waits(layer))) {
        neighbour_count[s] = 0u;
        return;
    }
    let middle = middles[s];
    let corner = cells[s] - step.size.x * step.size.y - step.size.x - 1u;
    let stride = arrayLength(&neighbour_count);
    var share = FULL_SHARE;
    if (CAPPED) {
        share = share_of(flights[s]);
    }
    let own_reach2 = reach2(share);
    var found = 0u;
    var flags = middle;
    for (var row = 0u; row < 9u; row++) {
        // Rows of three cells, neighbours in memory; the border layer makes every index valid.
        let first = corner + (row / 3u) * step.size.x * step.size.y + (row % 3u) * step.size.x;
        let end = cell_start[first + 3u];
        for (var j = cell_start[first]; j < end; j++) {
            let other = middles[j];
            let distance2 = packed_distance2(middle, other);
            // Of the pair's diameter, so that either is in the other's list.
            if (distance2 < own_reach2 && j != s && (!CAPPED || distance2 < reach2(share_of(flights[j])))) {
                flags |= other;
                if (found < step.list) {
                    neighbours[found * stride + s] = j;
                }
                found++;
            }
        }
    }
    neighbour_count[s] = min(found, step.list);
    if (found > step.list) {
        atomicMax(&counters[MOST_NEIGHBOURS], found);
    }
    let walls = found > 0u && (flags & NEAR_WALL) != 0u;
    if (late) {
        layers[s] |= SEARCHED | select(0u, UNSCREENED, walls);
    } else if (walls) {
        screened[append(LIST_SCREEN)] = s;
    }
}
