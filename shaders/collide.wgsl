//! uses: step.wgsl grid.wgsl local.wgsl motions.wgsl dsmc.wgsl cell_gas.wgsl
// The collisions of the method `cell`, in cells that no wall parts.
//
// Reads `cell_start`, `cell_volume`, `newborns`, `motions`; reads and writes `sorted`, appends the cells that walls part
// to `parted`, those that moving walls may touch to `moved`, and among other devices leaves the number of a cell's candidates with its first particle, in
// `neighbour_count`, for the balance. One thread per cell; each works on its own particles, in order of their ids.
// Collisions are at the start of the step, where positions hold and no particle has met a wall.

@group(0) @binding(14) var<storage, read_write> neighbour_count: array<u32>;
@group(0) @binding(51) var<storage, read_write> parted: array<u32>;
@group(0) @binding(54) var<storage, read_write> moved: array<u32>;

var<workgroup> collisions: atomic<u32>;

fn member(begin: u32, k: u32, part: u32) -> u32 {
    return begin + k;
}

fn hidden(s: u32, t: u32) -> bool {
    return false;
}

fn moves(c: vec3<u32>) -> bool {
    if (MOVING) {
        for (var m = 0u; m < MOTIONS; m++) {
            if (in_motion(c, motion_of(m))) {
                return true;
            }
        }
    }
    return false;
}

// The place among the cells of a workgroup: each eight in a row go on in another of 16 parts. Gas may be in one part of the space alone,
// and a software device gives each of its threads a stretch of workgroups.
const NEAR_GROUPS: u32 = 8;
const PARTS: u32 = 16;

fn place_of(group: u32, groups: u32) -> u32 {
    let length = groups / (PARTS * NEAR_GROUPS);
    let eight = group / NEAR_GROUPS;
    let place = ((eight % PARTS) * length + eight / PARTS) * NEAR_GROUPS + group % NEAR_GROUPS;
    return select(group, place, group < PARTS * NEAR_GROUPS * length);
}

@compute @workgroup_size(WORKGROUP)
fn collide(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) groups: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let bin = place_of(group.x + group.y * groups.x, groups.x * groups.y) * WORKGROUP + thread;
    if (bin < step.bins) {
        let begin = cell_start[bin];
        let bin_end = cell_start[bin + 1u];
        var candidates = 0u;
        if (bin_end > begin + 1u) {
            let place = cell_of(bin);
            let cell = cell_index(place);
            let entry = cell_volume[cell];
            let end = last_of(begin, bin_end);
            if (moves(place)) {
                moved[append_group(LIST_MOVED)] = bin;
            } else if ((entry & PARTED) != 0u) {
                parted[append(LIST_PARTED)] = bin;
            } else if (end > begin + 1u) {
                let done = collide_members(begin, end - begin, bitcast<f32>(entry), cell, 0u);
                candidates = done.candidates;
                if (done.collisions > 0u) {
                    atomicAdd(&collisions, done.collisions);
                }
            }
        }
        if (step.peers > 0u) {
            for (var s = begin; s < bin_end; s++) {
                neighbour_count[s] = select(0u, candidates, s == begin);
            }
        }
    }
    workgroupBarrier();
    if (thread == 0u) {
        let number = atomicLoad(&collisions);
        if (number > 0u) {
            count_collisions(number);
        }
    }
}
