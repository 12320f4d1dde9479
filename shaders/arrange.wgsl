//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl motions.wgsl body_frame.wgsl cell_gas.wgsl members.wgsl lay.wgsl
//! phase: sort
// Sort of the method `cell`: the particles to the places of their cells, in the order of the threads where `collide` puts so few in
// order by itself; those of other cells are listed. A particle lies in the cell of its bin, so its place tells which that is.
//
// Reads `bins`, `cell_start`, `particles`, `cell_volume`, `motions` and `wall_list`; writes `sorted` (lay.wgsl), of cells of more than MEMBERS and of
// the listed `slots`, and appends to `crowded`. One thread per particle as they lie in `particles`.

var<storage, read> bins: array<vec2<u32>>;
var<storage, read> cell_start: array<u32>;
var<storage, read_write> slots: array<u32>;
var<storage, read_write> crowded: array<u32>;

// Walls part the gas of some cell.
override DIVIDED_GAS: bool = true;

// Whether other kernels work on a cell as well, which want its particles in order.
fn divided_or_moved(cell: vec3<u32>) -> bool {
    if (moving_in(cell)) {
        return true;
    }
    return DIVIDED_GAS && (cell_volume[cell_index(cell)] & DIVIDED) != 0u;
}

@compute @workgroup_size(WORKGROUP)
fn arrange(thread: Thread) {
    let i = linear(thread);
    if (step.peers > 0u) {
        lay_nobody(i, cell_start[step.bins]);
    }
    if (i >= step.count + step.newborns + step.arrivals) {
        return;
    }
    let bin = bins[i];
    if (bin.x == NOBODY) {
        return;
    }
    let begin = cell_start[bin.x];
    let place = begin + bin.y;
    let end = cell_start[bin.x + 1u];
    let listed = !fits_a_thread(begin, end) || divided_or_moved(nearest_cell(particles[i].position_tag.xyz));
    if (listed || end - begin > MEMBERS) {
        slots[place] = id_of(particles[i].position_tag.w);
    }
    if (listed) {
        crowded[append(LIST_CROWDED)] = i;
        return;
    }
    lay(i, place, bin.x);
}
