//! uses: step.wgsl grid.wgsl local.wgsl counters.wgsl lists.wgsl stretches.wgsl entering.wgsl walls.wgsl held.wgsl binned.wgsl
// Flies the particles that meet no wall to the end of the step, without collisions the newborns too, which it puts behind the others; and on a
// device alone counts the particles of the cells for the step that follows in the interval, and puts its newborns behind the others.
//
// Reads `sorted` and in `particles` the flights (without collisions the particles, and `newborns`), the classes and clearances of the cells and `motions`; writes `stretch_sums`, `bins`, `cell_counts`, `particles` (where they were in `sorted`; dead slots in place of ghosts), and appends
// those that meet a wall, or without rounds may meet one or enter in this step (noted in `layers`), to `bouncing`. One thread per
// particle, which writes its own slot, for each of those newborns, and as many as there are stretches of cells.

override ROUNDS_OF_PAIRS: bool = true;
override VENTS: bool = true;

@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(65) var<storage, read> held: array<u32>;
@group(0) @binding(2) var<storage, read_write> particles: array<Packed>;
@group(0) @binding(10) var<storage, read> sorted: array<Packed>;
@group(0) @binding(32) var<storage, read_write> layers: array<u32>;
@group(0) @binding(26) var<storage, read_write> bouncing: array<u32>;
@group(0) @binding(29) var<storage, read_write> stretch_sums: array<u32>;

// The list that the step before has filled.
fn empty_bounces() {
    let list = bounces_of(step.slot + 1u);
    atomicStore(&counters[list], 0u);
    atomicStore(&dispatches[3u * list], 0u);
    atomicStore(&dispatches[3u * list + 1u], 1u);
}

fn empty_sums(thread: u32) {
    if (thread < arrayLength(&stretch_sums)) {
        stretch_sums[thread] = 0u;
    }
}

@compute @workgroup_size(WORKGROUP)
fn advect(thread: Thread) {
    let s = linear(thread);
    if (s == 0u) {
        empty_bounces();
        atomicStore(&counters[COUNT_DROPPED], 0u);
    }
    let alone = held[INTERVAL] > 0u;
    if (COLLISIONS && alone) {
        empty_sums(s);
    }
    let held_back = ROUNDS_OF_PAIRS && held[HELD] > 0u;
    if (bins_next() && s < step.total + step.next_newborns && (held_back || s >= step.total)) {
        // Those who enter in the step that follows; on a device that is held nobody.
        if (!held_back && enter_among(s, step.newborns + step.next_newborns)) {
            bin_next(s, particles[s].place.xyz, particles[s].motion.xyz);
        } else {
            bin_nobody(s);
        }
    }
    if (s >= step.total || held_back) {
        return;
    }
    var place: vec4<u32>;
    var motion: vec4<f32>;
    var mark = 0u;
    if (COLLISIONS) {
        if (ROUNDS_OF_PAIRS || !alone) {
            mark = layers[s];
        }
        // A slot behind the last particle, or a ghost.
        let nobody = select(s >= held[PRESENT], (mark & LAYER) != 0u, !alone);
        if (nobody) {
            particles[s].place.w = NOBODY;
            if (bins_next()) {
                bin_nobody(s);
            }
            return;
        }
        place = sorted[s].place;
        motion = sorted[s].motion;
    } else {
        if (!enter(s)) {
            return;
        }
        place = particles[s].place;
        if (VENTS && place.w == NOBODY) {
            return;
        }
        motion = particles[s].motion;
    }
    let position = place.xyz;
    let velocity = motion.xyz;
    var meets_wall: bool;
    if (ROUNDS_OF_PAIRS) {
        // Its flight, where the particle will be, knows when; of most it is known that they meet none.
        meets_wall = false;
        if ((mark & (NEAR | TURNED_TO_WALL)) != 0u) {
            meets_wall = flight_of(particles[s].place).wall < step.dt;
        }
    } else {
        // (What enters in this step, which is rare, starts at a time of its own.)
        meets_wall = is_newborn(id_of(place.w)) || may_hit(position, velocity, 0.0, step.dt);
    }
    if (meets_wall) {
        if (COLLISIONS && !ROUNDS_OF_PAIRS) {
            if (!alone) {
                layers[s] |= NEAR;
            }
            atomicAdd(&counters[LIST_NEAR_WALLS], 1u);
        }
        bouncing[append(bounces_of(step.slot))] = s;
        return;
    }
    let end = shifted(position, velocity * step.dt);
    if (ROUNDS_OF_PAIRS) {
        let cell = end >> vec3<u32>(CELL_BITS);
        if (!in_grid(cell) || class_of(cell_index(cell)) == CLASS_SOLID) {
            atomicAdd(&counters[OUTSIDE], 1u);
        }
    }
    if (COLLISIONS) {
        particles[s] = Packed(vec4<u32>(end, place.w), motion);
        if (bins_next()) {
            bin_next(s, end, velocity);
        }
    } else {
        particles[s].place = vec4<u32>(end, place.w);
    }
}
