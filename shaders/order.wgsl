//! uses: step.wgsl grid.wgsl midpoint.wgsl local.wgsl particle.wgsl newborn.wgsl walls.wgsl lists.wgsl coarse.wgsl cap.wgsl nearness.wgsl halo.wgsl
//! binds: rechoose_dispatches as dispatches
//! phase: sort
// Sort: the particles to the places of their cells, in the order in which `bin` has counted them.
//
// Reads `bins`, `cell_start`, `particles`, `newborns`, `cross_section_shares`, the classes of the cells and their clearances; writes
// `sorted`, `cells`, `midpoints` (packed mid-step position, with NEAR_WALL and ASTRAY), `marks`, where ghosts wait until they are asked also
// `firsts`, marks those that may meet a wall and appends them to `incomplete`, for `complete_lists`, and clears what the search and the rounds use. One thread per particle as they lie in
// `particles`. In which order the particles of a cell lie is a matter of the order of the threads; nothing that follows asks for it.

var<uniform> step: Step;
var<storage, read> particles: array<Packed>;
var<storage, read> bins: array<vec2<u32>>;
var<storage, read> cell_start: array<u32>;
var<storage, read_write> sorted: array<Packed>;
var<storage, read_write> midpoints: array<u32>;
var<storage, read_write> cells: array<u32>;
var<storage, read_write> marks: array<u32>;
var<storage, read_write> neighbour_count: array<u32>;
var<storage, read_write> firsts: array<Packed>;
var<storage, read_write> incomplete: array<u32>;

// The fewest links, at least so many, of a chain from an own particle to a ghost; `step.depth` also where there is none.
fn links_away(midpoint: u32, cell: vec3<u32>, least: u32) -> u32 {
    let distance2 = from_box2(midpoint, cell, vec3<i32>(step.own_low), vec3<i32>(step.own_high));
    for (var links = least; links < step.depth; links++) {
        let reach = chain_reach(cell, links);
        if (distance2 < reach * reach) {
            return links;
        }
    }
    return max(least, step.depth);
}

@compute @workgroup_size(WORKGROUP)
fn order(thread: Thread) {
    let i = linear(thread);
    // Places behind the last particle: on a device alone, whose host learns late how many have left through vents, and where
    // particles have been dropped that are nowhere near this device.
    if (i >= cell_start[step.bins] && i < step.total) {
        marks[i] = LAYER;
        neighbour_count[i] = 0u;
    }
    if (i >= step.count + step.newborns + step.arrivals) {
        return;
    }
    let bin = bins[i];
    let cell = bin.x;
    if (cell == NOBODY) {
        return;
    }
    let whole = particles[i];
    let own_id = id_of(whole.position_tag.w);
    let place = cell_start[cell] + bin.y;
    sorted[place] = whole;
    let particle = particle_of(whole);
    let midpoint = midpoint_of(particle.position, particle.velocity);
    // That of its bin, but where a driver rounds otherwise here than in `bin`.
    let place_in_grid = nearest_cell(midpoint);
    var mark = 0u;
    if (step.depth > 0u) {
        if (step.ghosts == GHOSTS_WAIT) {
            firsts[place] = whole;
        }
        mark = layer_of(place_in_grid);
        if (mark > 0u) {
            mark = links_away(packed(midpoint), place_in_grid, mark);
        }
        if (mark == 0u && !in_box(place_in_grid, step.inner_low, step.inner_high)) {
            mark = SHARED;
        }
    }
    cells[place] = cell;
    var flags = select(0u, NEAR_WALL, may_part(place_in_grid));
    flags |= select(0u, ASTRAY, any(signed_cell(midpoint) != vec3<i32>(place_in_grid)) || local_index(place_in_grid) != cell);
    midpoints[place] = packed(midpoint) | flags;
    neighbour_count[place] = 0u;
    if (may_hit(particle.position, particle.velocity, birth_time(own_id), step.dt)) {
        mark |= NEAR;
        incomplete[append(LIST_INCOMPLETE)] = place;
    }
    marks[place] = mark;
}
