//! uses: step.wgsl local.wgsl lists.wgsl asked.wgsl search.wgsl
// The neighbour lists, as far as they are short (search.wgsl).
//
// Reads what the search does and `layers`; writes `neighbours` and `neighbour_count`, appends longer lists to `long_lists`,
// and to `screened` those with neighbours that may be behind a wall. One thread per particle, or per ghost that was asked
// (asked.wgsl), which writes its own list.

override VENTS: bool = true;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(25) var<storage, read_write> screened: array<u32>;
@group(0) @binding(32) var<storage, read_write> layers: array<u32>;
@group(0) @binding(58) var<storage, read_write> long_lists: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn neighbours_of(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    var s = linear(id, groups);
    let late = HALO && step.ghosts == GHOSTS_ASKED;
    if (late) {
        s = asked_of(s);
        if (s == NOBODY || (layers[s] & SEARCHED) != 0u) {
            return;
        }
    } else if (s >= step.total) {
        return;
    }
    // The outermost ghosts have no neighbours beyond them here, and choose nobody; nor do slots without particle.
    if (VENTS || HALO) {
        let layer = layers[s] & LAYER;
        if ((VENTS || step.depth > 0u) && (layer >= max(step.depth, 1u) || waits(layer))) {
            neighbour_count[s] = 0u;
            return;
        }
    }
    let found = search(s, DIRECT, NOBODY);
    neighbour_count[s] = found.count;
    if (found.count > DIRECT) {
        if (late) {
            // The rounds have their pairs in the first half.
            long_lists[arrayLength(&neighbour_count) + append(LIST_LONG_LATE)] = s;
        } else {
            long_lists[append(LIST_LONG)] = s;
        }
    }
    let walls = found.count > 0u && (found.flags & NEAR_WALL) != 0u;
    if (late) {
        layers[s] |= SEARCHED | select(0u, UNSCREENED, walls);
    } else if (walls) {
        screened[append(LIST_SCREEN)] = s;
    }
}
