//! uses: step.wgsl grid.wgsl local.wgsl motions.wgsl body_frame.wgsl dsmc.wgsl cell_gas.wgsl members.wgsl
//! phase: collide
// The collisions of the method `cell`, in cells of up to MEMBERS particles that no wall parts.
//
// The particles of a bin lie in its cell, so the first one's place tells which it is.
//
// Reads `cell_start`, `cell_volume`, `motions`, `wall_list`; reads and writes `sorted`, appends the cells that walls part
// to `divided`, those that moving walls may touch to `moved`, others of more particles to `crowds`, and among other devices leaves the
// number of a cell's candidates with its first particle, in `neighbour_count`, for the balance. One thread per cell; each works on its
// own particles, in order of their ids, in which these need not lie. Collisions are at the start of the step, where positions hold and no particle has met a wall.

var<storage, read_write> neighbour_count: array<u32>;
var<storage, read_write> divided: array<u32>;
var<storage, read_write> moved: array<u32>;
var<storage, read_write> crowds: array<u32>;

// The numbers of a cell's particles by their ids, the first eight and the others.
var<private> by_id: vec2<u32>;

fn member(begin: u32, k: u32, part: u32) -> u32 {
    return begin + extractBits(select(by_id.y, by_id.x, k < 8u), NUMBER_BITS * (k & 7u), NUMBER_BITS);
}

// The id, and below it the number.
fn key(begin: u32, count: u32, k: u32) -> u32 {
    var found = NOBODY;
    if (k < count) {
        found = (sorted[begin + k].position_tag.w << NUMBER_BITS) | k;
    }
    return found;
}

fn exchange(a: ptr<function, u32>, b: ptr<function, u32>) {
    let lower = min(*a, *b);
    *b = max(*a, *b);
    *a = lower;
}

fn numbers(keys: vec4<u32>) -> u32 {
    let number = extractBits(keys, 0u, NUMBER_BITS);
    return dot(number, vec4<u32>(1u, 1u << NUMBER_BITS, 1u << (2u * NUMBER_BITS), 1u << (3u * NUMBER_BITS)));
}

// Finds the order by id of up to MEMBERS particles: a network of exchanges (Batcher, 1968), so that no thread waits for another.
fn put_in_order(begin: u32, count: u32) {
    var key0 = key(begin, count, 0u);
    var key1 = key(begin, count, 1u);
    var key2 = key(begin, count, 2u);
    var key3 = key(begin, count, 3u);
    var key4 = key(begin, count, 4u);
    var key5 = key(begin, count, 5u);
    var key6 = key(begin, count, 6u);
    var key7 = key(begin, count, 7u);
    var key8 = key(begin, count, 8u);
    var key9 = key(begin, count, 9u);
    var key10 = key(begin, count, 10u);
    var key11 = key(begin, count, 11u);
    exchange(&key0, &key8); exchange(&key1, &key9); exchange(&key2, &key10); exchange(&key3, &key11);
    exchange(&key0, &key4); exchange(&key1, &key5); exchange(&key2, &key6); exchange(&key3, &key7);
    exchange(&key4, &key8); exchange(&key5, &key9); exchange(&key6, &key10); exchange(&key7, &key11);
    exchange(&key0, &key2); exchange(&key1, &key3); exchange(&key4, &key6); exchange(&key5, &key7);
    exchange(&key8, &key10); exchange(&key9, &key11);
    exchange(&key2, &key8); exchange(&key3, &key9);
    exchange(&key2, &key4); exchange(&key3, &key5); exchange(&key6, &key8); exchange(&key7, &key9);
    exchange(&key0, &key1); exchange(&key2, &key3); exchange(&key4, &key5); exchange(&key6, &key7);
    exchange(&key8, &key9); exchange(&key10, &key11);
    exchange(&key1, &key8); exchange(&key3, &key10);
    exchange(&key1, &key4); exchange(&key3, &key6); exchange(&key5, &key8); exchange(&key7, &key10);
    exchange(&key1, &key2); exchange(&key3, &key4); exchange(&key5, &key6); exchange(&key7, &key8);
    exchange(&key9, &key10);
    let third = numbers(vec4<u32>(key8, key9, key10, key11));
    let second = numbers(vec4<u32>(key4, key5, key6, key7));
    let first = numbers(vec4<u32>(key0, key1, key2, key3));
    by_id = vec2<u32>(first | (second << (4u * NUMBER_BITS)), third);
}

// Zero behind the last.
fn velocity(begin: u32, count: u32, k: u32) -> vec3<f32> {
    var found = vec3<f32>(0.0);
    if (k < count) {
        found = sorted[member(begin, k, 0u)].motion.xyz;
    }
    return found;
}

fn away2(velocity: vec3<f32>, mean: vec3<f32>, there: bool) -> f32 {
    let away = velocity - mean;
    return select(0.0, dot(away, away), there);
}

// As `bulk_of`, of up to MEMBERS particles, each read once.
fn bulk_of_few(begin: u32, count: u32) -> Bulk {
    let v0 = velocity(begin, count, 0u);
    let v1 = velocity(begin, count, 1u);
    let v2 = velocity(begin, count, 2u);
    let v3 = velocity(begin, count, 3u);
    let v4 = velocity(begin, count, 4u);
    let v5 = velocity(begin, count, 5u);
    let v6 = velocity(begin, count, 6u);
    let v7 = velocity(begin, count, 7u);
    let v8 = velocity(begin, count, 8u);
    let v9 = velocity(begin, count, 9u);
    let v10 = velocity(begin, count, 10u);
    let v11 = velocity(begin, count, 11u);
    var bulk = Bulk(vec3<f32>(0.0), 0.0);
    bulk.mean += v0;
    bulk.mean += v1;
    bulk.mean += v2;
    bulk.mean += v3;
    bulk.mean += v4;
    bulk.mean += v5;
    bulk.mean += v6;
    bulk.mean += v7;
    bulk.mean += v8;
    bulk.mean += v9;
    bulk.mean += v10;
    bulk.mean += v11;
    bulk.mean /= f32(count);
    bulk.farthest2 = max(bulk.farthest2, away2(v0, bulk.mean, 0u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v1, bulk.mean, 1u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v2, bulk.mean, 2u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v3, bulk.mean, 3u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v4, bulk.mean, 4u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v5, bulk.mean, 5u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v6, bulk.mean, 6u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v7, bulk.mean, 7u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v8, bulk.mean, 8u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v9, bulk.mean, 9u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v10, bulk.mean, 10u < count));
    bulk.farthest2 = max(bulk.farthest2, away2(v11, bulk.mean, 11u < count));
    return bulk;
}

fn hidden(s: u32, t: u32) -> bool {
    return false;
}

// The place among the cells of a workgroup: each eight in a row go on in another of 16 parts. Gas may be in one part of the space alone,
// and a software device gives each of its threads a stretch of workgroups.
const NEAR_GROUPS: u32 = 8;
const PARTS: u32 = 16;

fn place_of(group: u32, groups: u32) -> u32 {
    let length = groups / (PARTS * NEAR_GROUPS);
    let eight = group / NEAR_GROUPS;
    let place = ((eight % PARTS) * length + eight / PARTS) * NEAR_GROUPS + group % NEAR_GROUPS;
    return select(group, place, group < PARTS * NEAR_GROUPS * length);
}

@compute @workgroup_size(WORKGROUP)
fn collide(thread: Thread) {
    let bin = place_of(group_of(thread), groups_of(thread)) * WORKGROUP + lane_of(thread);
    if (bin >= step.bins) {
        return;
    }
    let begin = cell_start[bin];
    let bin_end = cell_start[bin + 1u];
    var candidates = 0u;
    // bench: shared
    if (bin_end > begin + 1u) {
        let here = nearest_cell(sorted[begin].position_tag.xyz);
        let cell = cell_index(here);
        let entry = cell_volume[cell];
        var count = bin_end - begin;
        if (moving_in(here)) {
            moved[append_group(LIST_MOVED)] = bin;
        } else if ((entry & DIVIDED) != 0u) {
            divided[append(LIST_DIVIDED)] = bin;
        } else {
            // bench: in order
            if (count <= MEMBERS) {
                put_in_order(begin, count);
                while (count > 0u && is_newborn(id_of(sorted[member(begin, count - 1u, 0u)].position_tag.w))) {
                    count--;
                }
                // bench: colliding
                if (count > 1u) {
                    let bulk = bulk_of_few(begin, count);
                    let done = collide_members(begin, count, bulk, bitcast<f32>(entry), cell, 0u);
                    candidates = done.candidates;
                    count_collisions(done.collisions, cell);
                }
            } else {
                crowds[append(LIST_CROWDS)] = bin;
            }
        }
    }
    if (step.peers > 0u) {
        for (var s = begin; s < bin_end; s++) {
            neighbour_count[s] = select(0u, candidates, s == begin);
        }
    }
}
