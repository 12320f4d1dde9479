//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl entering.wgsl walls.wgsl binned.wgsl
//! phase: advect
// Flies the particles that meet no wall to the end of the step, without collisions the newborns too, which it puts behind the others; and on a
// device alone counts the particles of the cells for the step that follows in the interval, and puts its newborns behind the others.
//
// Reads `sorted` and in `particles` the flights (without collisions the particles, and `newborns`), the classes and clearances of the cells and `motions`; writes `bins`, `cell_counts`, `particles` (where they were in `sorted`; dead slots in place of ghosts), and appends
// those that meet a wall, or without rounds may meet one or enter in this step (noted in `marks`), to `bouncing`. One thread per
// particle, which writes its own slot, and for each of those newborns.

override ROUNDS_OF_PAIRS: bool = true;
override VENTS: bool = true;

var<uniform> step: Step;
var<storage, read> stalled: array<u32>;
var<storage, read> step_state: array<u32>;
var<storage, read_write> particles: array<Packed>;
var<storage, read> sorted: array<Packed>;
var<storage, read_write> marks: array<u32>;
var<storage, read_write> bouncing: array<u32>;

@compute @workgroup_size(WORKGROUP)
fn advect(thread: Thread) {
    let s = linear(thread);
    let alone = step_state[INTERVAL_STEPS] > 0u;
    let stalled_here = ROUNDS_OF_PAIRS && stalled[STALLED] > 0u;
    if (bins_next() && s < step.total + step.next_newborns && (stalled_here || s >= step.total)) {
        // Those who enter in the step that follows; on a device that is stalled nobody.
        if (!stalled_here && enter_among(s, step.newborns + step.next_newborns)) {
            bin_next(s, particles[s].position_tag.xyz, particles[s].motion.xyz);
        } else {
            bin_nobody(s);
        }
    }
    if (s >= step.total || stalled_here) {
        return;
    }
    var place: vec4<u32>;
    var motion: vec4<f32>;
    var mark = 0u;
    if (COLLISIONS) {
        if (ROUNDS_OF_PAIRS || !alone) {
            mark = marks[s];
        }
        // A slot behind the last particle, or a ghost.
        let nobody = select(s >= step_state[PRESENT], (mark & LAYER) != 0u, !alone);
        if (nobody) {
            particles[s].position_tag.w = NOBODY;
            if (bins_next()) {
                bin_nobody(s);
            }
            return;
        }
        place = sorted[s].position_tag;
        motion = sorted[s].motion;
    } else {
        if (!enter(s)) {
            return;
        }
        place = particles[s].position_tag;
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
            meets_wall = flight_of(particles[s].position_tag).wall < step.dt;
        }
    } else {
        // (What enters in this step, which is rare, starts at a time of its own.)
        meets_wall = is_newborn(id_of(place.w)) || may_hit(position, velocity, 0.0, step.dt);
    }
    if (meets_wall) {
        if (COLLISIONS && !ROUNDS_OF_PAIRS) {
            if (!alone) {
                marks[s] |= NEAR;
            }
            atomicAdd(&counters[LIST_NEAR_WALLS], 1u);
        }
        bouncing[append(LIST_BOUNCE)] = s;
        return;
    }
    let end = shifted(position, velocity, step.dt);
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
        particles[s].position_tag = vec4<u32>(end, place.w);
    }
}
