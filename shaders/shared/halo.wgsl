// Who is needed as a ghost, and in how many links of a chain a ghost may be away from the own particles.
//
// What the own particles do in the rounds between two exchanges depends on chains of particles, each in the list of
// neighbours of the one before, of `step.depth` links at most (ARCHITECTURE.md, "Among ranks"). A link is no longer than
// either of its particles reaches (nearness.wgsl), and each leads to the same cell or one beside it. So what is n links
// away is in the n layers of cells around the own ones, and nearer to them than its own reach and n - 1 of the widest
// reach within n - 1 cells. By this count a particle's neighbours are one link farther at most, as in a chain: what is
// settled n links away is known to n + 2. Mid-step points are those of the search, in integers, so all devices agree.

// What is left of the cross-section in each coarse block.
var<storage, read> cross_section_shares: array<u32>;

// The least integer of which the square is at least x.
fn root_up(x: i32) -> i32 {
    var root = i32(sqrt(f32(max(x, 0))));
    while (root * root < x) {
        root++;
    }
    while (root > 0 && (root - 1) * (root - 1) >= x) {
        root--;
    }
    return root;
}

// The most that is left of a cross-section within so many cells around a cell.
fn most_share(cell: vec3<u32>, around: u32) -> u32 {
    let low = (max(cell, vec3<u32>(around)) - around) >> vec3<u32>(BLOCK_BITS);
    let high = min(cell + around, vec3<u32>(CELLS_X, CELLS_Y, CELLS_Z) - 1u) >> vec3<u32>(BLOCK_BITS);
    var most = 0u;
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            for (var x = low.x; x <= high.x; x++) {
                most = max(most, cross_section_shares[(z * BLOCKS_Y + y) * BLOCKS_X + x]);
            }
        }
    }
    return most;
}

// How far, in 1/128 cells, a particle of this cell may be from the own cells of a chain of so many links.
fn chain_reach(cell: vec3<u32>, links: u32) -> i32 {
    var own = FULL_SHARE;
    var widest = FULL_SHARE;
    if (CAPPED) {
        own = cross_section_shares[block_of(cell)];
        widest = most_share(cell, links - 1u);
    }
    return root_up(near2(own)) + (i32(links) - 1) * root_up(near2(widest));
}

// The square of the distance of a point, packed, from a box of cells, low <= c < high, in 1/128 cells. Beyond the border of
// the grid cells go on: `nearest_cell` counts what is there as theirs.
fn from_box2(midpoint: u32, cell: vec3<u32>, low: vec3<i32>, high: vec3<i32>) -> i32 {
    let corner = vec3<i32>(cell) * 128;
    let part = vec3<i32>(vec3<u32>(midpoint, midpoint >> 10u, midpoint >> 20u) & vec3<u32>(1023u));
    let at = corner + extractBits(part - corner, 0u, 10u);
    let last = vec3<i32>(i32(CELLS_X), i32(CELLS_Y), i32(CELLS_Z)) - 1;
    let below = select(low * 128 - at, vec3<i32>(0), low <= vec3<i32>(1));
    let above = select(at + 1 - high * 128, vec3<i32>(0), high >= last);
    let away = max(max(below, above), vec3<i32>(0));
    return dot(away, away);
}
