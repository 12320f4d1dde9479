//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl newborn.wgsl walls.wgsl lists.wgsl coarse.wgsl cap.wgsl nearness.wgsl halo.wgsl
// Sort, part 2: the particles in canonical order, by (cell, id), and the flights with which they start
// the step.
//
// Reads `slots`, `bins`, `cell_start`, `particles`, `newborns`, `shares`, the classes of the cells and their clearances; writes
// `sorted`, `flights`, `cells`, `middles` (packed mid-step position, with NEAR_WALL and ASTRAY), `layers`, `origins` (the place in
// `particles`), clears what the
// search and the rounds use, and appends those that may meet a wall to `near_walls`. One thread per particle as they lie in
// `particles`. The place of one is its cell's start plus the number of lower ids in the cell: a function of the set, not of any order.

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(2) var<storage, read> particles: array<Packed>;
@group(0) @binding(5) var<storage, read> bins: array<vec2<u32>>;
@group(0) @binding(8) var<storage, read> cell_start: array<u32>;
// Four slots each.
@group(0) @binding(9) var<storage, read> slots: array<vec4<u32>>;
@group(0) @binding(10) var<storage, read_write> sorted: array<Packed>;
@group(0) @binding(11) var<storage, read_write> flights: array<vec4<u32>>;
@group(0) @binding(12) var<storage, read_write> middles: array<u32>;
@group(0) @binding(27) var<storage, read_write> cells: array<u32>;
@group(0) @binding(28) var<storage, read_write> touched: array<u32>;
@group(0) @binding(32) var<storage, read_write> layers: array<u32>;
@group(0) @binding(14) var<storage, read_write> neighbour_count: array<u32>;
@group(0) @binding(44) var<storage, read_write> origins: array<u32>;
@group(0) @binding(24) var<storage, read_write> near_walls: array<u32>;

override ORIFICES: bool = true;
// Pairs are chosen from neighbour lists, in rounds.
override ROUNDS_OF_PAIRS: bool = true;

// The fewest links, at least so many, of a chain from an own particle to a ghost; `step.depth` also where there is none.
fn links_away(middle: u32, cell: vec3<u32>, least: u32) -> u32 {
    let distance2 = from_box2(middle, cell, vec3<i32>(step.own_low), vec3<i32>(step.own_high));
    for (var links = least; links < step.depth; links++) {
        let reach = chain_reach(cell, links);
        if (distance2 < reach * reach) {
            return links;
        }
    }
    return max(least, step.depth);
}

@compute @workgroup_size(WORKGROUP)
fn order(@builtin(global_invocation_id) id: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    let i = linear(id, groups);
    if (ROUNDS_OF_PAIRS || step.peers > 0u) {
        // Places behind the last particle: on a device alone, whose host learns late how many have left through vents, and where
        // particles have been dropped that are nowhere near this device.
        if (i >= cell_start[step.bins] && i < step.total) {
            layers[i] = LAYER;
            if (ROUNDS_OF_PAIRS) {
                neighbour_count[i] = 0u;
            }
        }
    }
    if (i >= step.count + step.newborns + step.arrivals) {
        return;
    }
    let cell = bins[i].x;
    if (cell == NOBODY) {
        return;
    }
    let whole = particles[i];
    let own_id = id_of(whole.place.w);
    let begin = cell_start[cell];
    let end = cell_start[cell + 1u];
    var place = begin;
    for (var k = begin >> 2u; 4u * k < end; k++) {
        let slot = vec4<u32>(4u * k) + vec4<u32>(0u, 1u, 2u, 3u);
        let lower = (slots[k] < vec4<u32>(own_id)) & (slot >= vec4<u32>(begin)) & (slot < vec4<u32>(end));
        place += dot(select(vec4<u32>(0u), vec4<u32>(1u), lower), vec4<u32>(1u));
    }
    sorted[place] = whole;
    let particle = particle_of(whole);
    let place_in_grid = cell_of(cell);
    let middle = shifted(particle.position, particle.velocity * (0.5 * step.dt));
    var mark = 0u;
    if (step.depth > 0u) {
        origins[place] = i;
        mark = layer_of(place_in_grid);
        if (mark > 0u && ROUNDS_OF_PAIRS) {
            mark = links_away(packed(middle), place_in_grid, mark);
        }
        if (mark == 0u && !in_box(place_in_grid, step.inner_low, step.inner_high)) {
            mark = SHARED;
        }
    }
    if (!ROUNDS_OF_PAIRS) {
        if (step.peers > 0u) {
            cells[place] = cell;
            layers[place] = mark;
        }
        return;
    }
    cells[place] = cell;
    var start = 0.0;
    if (ORIFICES) {
        start = birth_time(own_id);
    }
    var flags = select(0u, NEAR_WALL, may_part(place_in_grid));
    flags |= select(0u, ASTRAY, any(signed_cell(middle) != vec3<i32>(place_in_grid)));
    middles[place] = packed(middle) | flags;
    touched[place] = 0u;
    neighbour_count[place] = 0u;
    var share = 0u;
    if (CAPPED) {
        share = shares[block_of(place_in_grid)];
    }
    flights[place] = packed_flight(Flight(start, NEVER, NOBODY, share << SHARE_AT));
    if (may_hit(particle.position, particle.velocity, start, step.dt)) {
        near_walls[append(LIST_NEAR_WALLS)] = place;
        mark |= NEAR;
    }
    layers[place] = mark;
}
