//! uses: zones.wgsl
// What walls that are no mirrors do: by wall and chamber, for the length of an interval.

struct SurfaceModel {
    // R T_w over the molar mass of the reference gas, (m/s)^2.
    thermal: f32,
    // Share of the hits that leave with the temperature of the wall.
    accommodation: f32,
    // Share of the others that leave in a random direction with the speed they had.
    friction: f32,
    // Its entries of `vents`.
    first_vent: u32,
    end_vent: u32,
    // The zone of the chamber whose gas it meets, if the gas before its triangles is that of several; else 0.
    zone: u32,
    // What they are before the gas of another.
    next: u32,
}

// A place of a wall, or of fabric, that lets gas out.
struct Vent {
    // Quanta.
    center: vec3<u32>,
    // m2; negative: all that has the surface model.
    radius2: f32,
    // Probability of passing, per normal speed (s/m) and mass over the reference mass.
    beta: f32,
    // Its tally.
    index: u32,
    // 1: to the other side of fabric, else out of the run.
    passes: u32,
    pad: u32,
}

var<storage, read> surface_models: array<SurfaceModel>;
var<storage, read> vents: array<Vent>;

// Key of the draws at walls: as SEED_HIGH, with their purpose.
override WALL_SEED_HIGH: u32;

// Blocks of random words that one hit may use up; the hits of a flight in a step are numbered from 1.
const BLOCKS_PER_HIT: u32 = 32;

fn wall_draw(tag: u32, hit: u32, block: u32) -> vec4<u32> {
    let counter = vec4<u32>(step.index, hit * BLOCKS_PER_HIT + block, id_of(tag), 0u);
    return philox(counter, vec2<u32>(SEED_LOW, WALL_SEED_HIGH));
}

// Off a wall, to the gas before a place on it, quanta.
const BEFORE: f32 = 1024.0;

// The surface model of a triangle at a place of it: where it borders on several chambers that of the one before the place.
fn surface_model_at(first: u32, place: vec3<u32>, normal: vec3<f32>, inside: bool) -> u32 {
    var model = first;
    var zone = surface_models[model].zone;
    if (zone != 0u) {
        let p = shifted(place, normal, BEFORE * QUANTUM);
        while (zone != 0u && (!contains(zones[zone], p, inside) || earlier_has(zone, p, inside))) {
            model = surface_models[model].next;
            zone = surface_models[model].zone;
        }
    }
    return model;
}

// The vent of a surface model that a place lies in, or NOBODY; of several the first.
fn vent_at(surface_model: SurfaceModel, place: vec3<u32>) -> u32 {
    for (var v = surface_model.first_vent; v < surface_model.end_vent; v++) {
        let away = between(vents[v].center, place);
        if (vents[v].radius2 < 0.0 || dot(away, away) <= vents[v].radius2) {
            return v;
        }
    }
    return NOBODY;
}

// Two standard normal numbers (Box and Muller 1958).
fn normals(a: u32, b: u32) -> vec2<f32> {
    let angle = 6.2831853 * unit_interval(b);
    return sqrt(-2.0 * log(unit_interval(a))) * vec2<f32>(cos(angle), sin(angle));
}

// The velocity of a particle that leaves with the temperature of the wall (docs/explanation/method.md,
// "Walls"): v_n = sqrt(-2 kT/m ln U) along the normal, normal distributions across it; `thermal` is kT/m.
fn emitted(normal: vec3<f32>, thermal: f32, tag: u32, hit: u32, word: u32) -> vec3<f32> {
    let draw = wall_draw(tag, hit, 1u);
    // Three normal numbers less their part along the normal are two across it, whatever the axes.
    let any = vec3<f32>(normals(draw.x, draw.y), normals(draw.z, draw.w).x);
    let across = any - dot(any, normal) * normal;
    return sqrt(thermal) * (across + sqrt(-2.0 * log(unit_interval(word))) * normal);
}

// A direction into the gas by the cosine law, P(cos < c) = c^2: that of a gas at rest, whatever the speed.
fn scattered(normal: vec3<f32>, tag: u32, hit: u32, word: u32) -> vec3<f32> {
    let draw = wall_draw(tag, hit, 1u);
    let any = vec3<f32>(normals(draw.x, draw.y), normals(draw.z, draw.w).x);
    let across = any - dot(any, normal) * normal;
    let cosine2 = unit_interval(word);
    return sqrt(cosine2) * normal + (sqrt(max(1.0 - cosine2, 0.0)) / max(length(across), 1e-30)) * across;
}

// A gamma variate of unit scale (Marsaglia and Tsang 2000, with their boost for shapes below one).
fn gamma_variate(shape: f32, tag: u32, hit: u32) -> f32 {
    var boost = 1.0;
    var d = shape - 1.0 / 3.0;
    if (shape < 1.0) {
        boost = pow(unit_interval(wall_draw(tag, hit, 2u).x), 1.0 / shape);
        d += 1.0;
    }
    let c = 1.0 / sqrt(9.0 * d);
    // More than 19 attempts in 20 are accepted, so the last of these is never refused in practice.
    for (var block = 3u; block < BLOCKS_PER_HIT; block++) {
        let draw = wall_draw(tag, hit, block);
        let x = normals(draw.x, draw.y).x;
        let root = 1.0 + c * x;
        let v = root * root * root;
        if (root > 0.0 && log(unit_interval(draw.z)) < 0.5 * x * x + d - d * v + d * log(v)) {
            return boost * d * v;
        }
    }
    return boost * d;
}
