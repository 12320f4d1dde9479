//! uses: step.wgsl local.wgsl lists.wgsl on_demand.wgsl search.wgsl
//! phase: choose lost
// The neighbour lists of the ghosts that were asked (on_demand.wgsl), as far as they are short (search.wgsl).
//
// Reads what the search does; reads and writes `marks`; writes `neighbours` and `neighbour_count`. One thread per ghost that was asked, which writes its
// own list: the others, who may be searching as well, leave it alone.

var<uniform> step: Step;
var<storage, read_write> marks: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn neighbours_on_demand(thread: Thread) {
    let s = on_demand_chooser(linear(thread));
    if (s == NOBODY || (marks[s] & SEARCHED) != 0u) {
        return;
    }
    let found = search(s, DIRECT, NOBODY);
    atomicStore(&neighbour_count[s], found.count);
    tell_cut_short();
    let walls = found.count > 0u && (found.flags & NEAR_WALL) != 0u;
    marks[s] |= SEARCHED | select(0u, UNSCREENED, walls) | select(0u, LONG, found.count > DIRECT);
}
