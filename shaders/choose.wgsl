//! uses: step.wgsl grid.wgsl local.wgsl particle.wgsl lists.wgsl on_demand.wgsl chooser.wgsl cap.wgsl neighbour_list.wgsl listed.wgsl
//! binds: on_demand_dispatches as dispatches
//! phase: choose lost
// Each particle picks its earliest possible collision: at the closest approach, or, of rigid spheres, where they touch
// or at once if they overlap and approach (docs/explanation/method.md, "Collisions").
//
// Reads `sorted`, `flights` and the lists of neighbours behind them; writes `choices` (partner's index or NOBODY, time).
// One thread per entry of `rechoose`: only a particle that may collide can choose anybody, and later only one that
// collided, or whose neighbour did, otherwise than before. Ghosts that wait until they are asked (on_demand.wgsl)
// choose nobody, and are appended to `on_demand` when they are; a second pass is over those. The choice is the minimum over (time, partner id), so it does not depend on
// the order of the candidates. Seen from the other particle of a pair, r and g have the other sign and all that is made of
// them here has the same bits, so that both agree on its time.

// Rigid spheres, the method `hard-sphere`.
override RIGID: bool = false;

var<uniform> step: Step;
var<storage, read> sorted: array<Packed>;
var<storage, read> flights: array<vec4<u32>>;
var<storage, read> neighbour_count: array<u32>;
var<storage, read_write> choices: array<vec2<u32>>;

var<storage, read_write> marks: array<atomic<u32>>;

@compute @workgroup_size(WORKGROUP)
fn choose(thread: Thread) {
    let s = chooser(linear(thread));
    if (s == NOBODY) {
        return;
    }
    if (step.ghosts == GHOSTS_WAIT && waits(atomicLoad(&marks[s]) & LAYER)) {
        return;
    }
    var best = vec2<u32>(NOBODY, 0u);
    var best_time = NEVER;
    var best_id = NOBODY;
    let listed = neighbour_count[s];
    if (listed == 0u) {
        choices[s] = best;
        return;
    }
    let place = sorted[s].position_tag;
    let velocity = sorted[s].motion.xyz;
    let own_flight = flight_of(flights[2u * s]);
    let own_latest = min(step.dt, own_flight.wall);
    var direct = direct_of(s);
    let tail = direct.w;
    // bench: entry
    for (var k = 0u; k < listed; k++) {
        var j = direct.x;
        direct = direct.yzww;
        if (listed > DIRECT && k >= DIRECT - 1u) {
            j = word_at(tail + k);
        }
        let other = sorted[j].position_tag;
        let r = between(place.xyz, other.xyz);
        let g = sorted[j].motion.xyz - velocity;
        let g2 = dot(g, g);
        if (g2 == 0.0) {
            continue;
        }
        var time = -dot(r, g) / g2;
        // Most candidates pass too far away, or not in this step: so much can be told without the other's flight.
        // bench: in time
        if (!RIGID && !(time >= own_flight.start && time < own_latest)) {
            continue;
        }
        let miss = r + g * time;
        let miss2 = dot(miss, miss);
        // bench: near
        if (miss2 >= DIAMETER * DIAMETER) {
            continue;
        }
        let other_flight = flight_of(flights[2u * j]);
        let earliest = max(own_flight.start, other_flight.start);
        let latest = min(own_latest, other_flight.wall);
        if (!RIGID && !(time >= earliest && time < latest)) {
            continue;
        }
        let inside = diameter2(own_flight, other_flight) - miss2;
        if (inside <= 0.0) {
            continue;
        }
        if (RIGID) {
            // Apart from the closest approach on they only move apart.
            let approach = time;
            time = max(approach - sqrt(inside / g2), earliest);
            if (!(approach > earliest && time < latest)) {
                continue;
            }
        }
        if (own_flight.partner == other.w && other_flight.partner == place.w) {
            continue;
        }
        let other_id = id_of(other.w);
        if (time > best_time || (time == best_time && other_id >= best_id)) {
            continue;
        }
        best = vec2<u32>(j, bitcast<u32>(time));
        best_time = time;
        best_id = other_id;
    }
    choices[s] = best;
    if (step.ghosts == GHOSTS_WAIT && best.x != NOBODY && waits(atomicLoad(&marks[best.x]) & LAYER)) {
        if ((atomicOr(&marks[best.x], REQUESTED) & REQUESTED) == 0u) {
            on_demand[append(LIST_ON_DEMAND)] = best.x;
        }
    }
}
