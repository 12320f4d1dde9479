//! uses: step.wgsl local.wgsl lists.wgsl asked.wgsl search.wgsl
//! phase: choose lost
// The neighbour lists of the ghosts that were asked (asked.wgsl), as far as they are short (search.wgsl).
//
// Reads what the search does; reads and writes `layers`; writes `neighbours` and `neighbour_count`. One thread per ghost that was asked, which writes its
// own list: the others, who may be searching as well, leave it alone.

var<uniform> step: Step;
var<storage, read_write> layers: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn neighbours_asked(thread: Thread) {
    let s = asked_of(linear(thread));
    if (s == NOBODY || (layers[s] & SEARCHED) != 0u) {
        return;
    }
    let found = search(s, DIRECT, NOBODY);
    atomicStore(&neighbour_count[s], found.count);
    tell_cut_short();
    let walls = found.count > 0u && (found.flags & NEAR_WALL) != 0u;
    layers[s] |= SEARCHED | select(0u, UNSCREENED, walls) | select(0u, LONG, found.count > DIRECT);
}
