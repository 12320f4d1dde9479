//! uses: step.wgsl grid.wgsl particle.wgsl add64.wgsl motions.wgsl zones.wgsl
//! binds: zone_sums as sums
//! phase: tally
// Sums particle number, velocity, kinetic and spin energy of each gas in each zone (all, chambers,
// probes).
//
// Reads `particles`, `zones`; writes the integer tally `sums`. A workgroup takes a chunk of particles (y),
// one zone (x) and two gases (z); each thread adds its own, then the workgroup, then the zone's sums. (The zones of one chunk are
// next to each other, not the chunks of one zone: some zones have much to do and others nothing, and a software device gives each of its
// threads a stretch of workgroups.) Where chambers have all of the gas, the last has what the others leave of the whole: it is not
// looked for in the space. Fixed-point integers with a carry: the sums do not depend on order. A value
// out of range is counted, and the host stops the run.

override GASES: u32;
// Zones 1 .. CHAMBERS are chambers: of several that hold a particle the first has it.
override CHAMBERS: u32;
// Velocity and specific energy to tally units.
override VELOCITY_SCALE: f32;
override ENERGY_SCALE: f32;
override CHUNK_LOOPS: u32 = 32;

const ENERGY_RANGE: f32 = 4.29e9;

var<uniform> step: Step;
var<storage, read> stalled: array<u32>;
var<storage, read> particles: array<Packed>;
var<storage, read_write> counters: array<atomic<u32>>;
var<storage, read_write> sums: array<atomic<u32>>;

// Of one gas, then of the other.
var<workgroup> shared_sums: array<atomic<u32>, 2u * ZONE_WORDS>;

struct Sums {
    number: u32,
    x: vec2<u32>,
    y: vec2<u32>,
    z: vec2<u32>,
    kinetic: vec2<u32>,
    spin: vec2<u32>,
}

// Whether an earlier chamber has what lies in this zone too.
fn taken(zone: u32, place: vec4<u32>) -> bool {
    if (zone > CHAMBERS) {
        return false;
    }
    return earlier_has(zone, place.xyz, is_inside(place.w));
}

fn share64(slot: u32, value: vec2<u32>) {
    let old = atomicAdd(&shared_sums[slot], value.x);
    atomicAdd(&shared_sums[slot + 1u], value.y + select(0u, 1u, old + value.x < old));
}

fn plus(sum: vec2<u32>, low: u32, high: u32) -> vec2<u32> {
    let total = sum.x + low;
    return vec2<u32>(total, sum.y + high + select(0u, 1u, total < low));
}

fn plus_signed(sum: vec2<u32>, value: i32) -> vec2<u32> {
    return plus(sum, bitcast<u32>(value), select(0u, 0xffffffffu, value < 0));
}

fn added(sums: Sums, velocity: vec3<i32>, kinetic: u32, spin: u32) -> Sums {
    return Sums(
        sums.number + 1u,
        plus_signed(sums.x, velocity.x),
        plus_signed(sums.y, velocity.y),
        plus_signed(sums.z, velocity.z),
        plus(sums.kinetic, kinetic, 0u),
        plus(sums.spin, spin, 0u),
    );
}

fn share(gas: u32, sums: Sums) {
    if (sums.number > 0u) {
        let slot = gas * ZONE_WORDS;
        share64(slot + ZONE_NUMBER, vec2<u32>(sums.number, 0u));
        share64(slot + ZONE_VELOCITY, sums.x);
        share64(slot + ZONE_VELOCITY + 2u, sums.y);
        share64(slot + ZONE_VELOCITY + 4u, sums.z);
        share64(slot + ZONE_KINETIC, sums.kinetic);
        share64(slot + ZONE_SPIN, sums.spin);
    }
}

@compute @workgroup_size(WORKGROUP)
fn tally(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(local_invocation_index) thread: u32,
) {
    let zone = group.x;
    let chambers_have_all = CHAMBERS > 0u && zones[CHAMBERS].kind == EVERYWHERE;
    if (zone == CHAMBERS && chambers_have_all) {
        return;
    }
    if (thread < 2u * ZONE_WORDS) {
        atomicStore(&shared_sums[thread], 0u);
    }
    workgroupBarrier();
    let first_gas = 2u * group.z;
    // Once, not for each particle.
    let here = zones[zone];
    let count = select(step.total, 0u, stalled[STALLED] > 0u);
    var sums_of_first = Sums();
    var sums_of_second = Sums();
    // bench: particle
    for (var k = 0u; k < CHUNK_LOOPS; k++) {
        let i = (group.y * CHUNK_LOOPS + k) * WORKGROUP + thread;
        if (i >= count) {
            break;
        }
        let place = particles[i].position_tag;
        if (place.w == NOBODY) {
            continue;
        }
        let gas = gas_of(place.w) - first_gas;
        if (gas >= 2u) {
            continue;
        }
        // bench: inside
        if (!contains(here, place.xyz, is_inside(place.w)) || taken(zone, place)) {
            continue;
        }
        let motion = particles[i].motion;
        let v = motion.xyz;
        let velocity = v * VELOCITY_SCALE;
        let kinetic = 0.5 * dot(v, v) * ENERGY_SCALE;
        let spin = motion.w * ENERGY_SCALE;
        if (any(abs(velocity) >= vec3<f32>(1073741824.0)) || kinetic >= ENERGY_RANGE || spin >= ENERGY_RANGE) {
            atomicAdd(&counters[TALLY_OVERFLOW], 1u);
            continue;
        }
        let units = rounded(velocity);
        let kinetic_units = rounded_unsigned(kinetic);
        let spin_units = rounded_unsigned(spin);
        if (GASES == 1u || gas == 0u) {
            sums_of_first = added(sums_of_first, units, kinetic_units, spin_units);
        } else {
            sums_of_second = added(sums_of_second, units, kinetic_units, spin_units);
        }
    }
    share(0u, sums_of_first);
    if (GASES > 1u) {
        share(1u, sums_of_second);
    }
    workgroupBarrier();
    let gas = first_gas + thread / (ZONE_WORDS / 2u);
    if (thread < ZONE_WORDS && gas < GASES) {
        let low = atomicLoad(&shared_sums[2u * thread]);
        let high = atomicLoad(&shared_sums[2u * thread + 1u]);
        let word = 2u * (thread % (ZONE_WORDS / 2u));
        add64((zone * GASES + gas) * ZONE_WORDS + word, low, high);
        if (chambers_have_all && zone < CHAMBERS) {
            let left = select(negated(vec2<u32>(low, high)), vec2<u32>(low, high), zone == 0u);
            add64((CHAMBERS * GASES + gas) * ZONE_WORDS + word, left.x, left.y);
        }
    }
}
