// The stress of a membrane that bears tension only, by its relaxed (tension-field) energy (Pipkin 1986): the least that it has with any wrinkles,
// W(E) = max over stresses S without compression of S:E - S:C:S/2. It has a potential, which a rule for principal stresses has not.
//
// S^ = D:E is its stress as of an elastic sheet. Without compression in S^ it is the stress. Else it is uniaxial, (e_t/C_t) t t^T along the t that
// maximises e_t/sqrt(C_t) (e_t the strain along t, C_t the compliance), where that is positive; else there is none. Of an isotropic
// one t is along the larger principal strain, and C_t is 1/young. A small share of S^ goes on with it.
//
// Strains and stresses are symmetric: xx, yy, xy. A direction is by its doubled angle, (cos 2a, sin 2a).

struct Elastic {
    // S^: xx by xx, yy by yy, xx by yy, and xy by xy, Pa.
    stiffness: vec4<f32>,
    // C_t in 1/young: a number, that times cos 2a, that times its square.
    compliance: vec3<f32>,
    // Along the fibre, Pa.
    young: f32,
    // The share of S^.
    share: f32,
    // 1: alike in all directions.
    isotropic: u32,
    // By how much lengths of the reference are larger than true at the start of the interval, over these, and how fast that goes to zero and ends
    // there, 1/s; 0: it stays.
    loose: f32,
    tightening: f32,
}

const SLACK: u32 = 0u;
const WRINKLED: u32 = 1u;
const TAUT: u32 = 2u;

struct Tension {
    stress: vec3<f32>,
    // J/m3.
    energy: f32,
    direction: vec2<f32>,
    state: u32,
}

fn contracted(stress: vec3<f32>, strain: vec3<f32>) -> f32 {
    return stress.x * strain.x + stress.y * strain.y + 2.0 * stress.z * strain.z;
}

// t t^T.
fn dyad(direction: vec2<f32>) -> vec3<f32> {
    return 0.5 * vec3<f32>(1.0 + direction.x, 1.0 - direction.x, direction.y);
}

fn as_a_sheet(elastic: Elastic, strain: vec3<f32>) -> vec3<f32> {
    let k = elastic.stiffness;
    return vec3<f32>(k.x * strain.x + k.z * strain.y, k.z * strain.x + k.y * strain.y, 2.0 * k.w * strain.z);
}

fn mean_of(symmetric: vec3<f32>) -> f32 {
    return 0.5 * (symmetric.x + symmetric.y);
}

// What is beside the mean: along d it adds dot(deviator, d).
fn deviator(symmetric: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(0.5 * (symmetric.x - symmetric.y), symmetric.z);
}

fn compliance(elastic: Elastic, direction: vec2<f32>) -> f32 {
    let c = elastic.compliance;
    return c.x + direction.x * (c.y + direction.x * c.z);
}

// Turned by an angle (doubled), |angle| < 1/2.
fn turned(direction: vec2<f32>, angle: f32) -> vec2<f32> {
    let a2 = angle * angle;
    let sine = angle * (1.0 - a2 / 6.0 * (1.0 - a2 / 20.0 * (1.0 - a2 / 42.0)));
    let cosine = 1.0 - 0.5 * a2 * (1.0 - a2 / 12.0 * (1.0 - a2 / 30.0 * (1.0 - a2 / 56.0)));
    return vec2<f32>(direction.x * cosine - direction.y * sine, direction.x * sine + direction.y * cosine);
}

// Of e_t/sqrt(C_t) along a direction: its slope times a positive number, and the change of that, with the doubled angle.
fn slope(elastic: Elastic, mean: f32, other: vec2<f32>, direction: vec2<f32>) -> vec2<f32> {
    let c = elastic.compliance;
    let x = direction.x;
    let y = direction.y;
    let along = dot(other, direction);
    let strain = mean + along;
    let strain1 = other.y * x - other.x * y;
    let bend = c.x + x * (c.y + x * c.z);
    let bend1 = -(c.y + 2.0 * c.z * x) * y;
    let bend2 = -(c.y * x + 2.0 * c.z * (x * x - y * y));
    return vec2<f32>(strain1 * bend - 0.5 * strain * bend1, 0.5 * strain1 * bend1 - along * bend - 0.5 * strain * bend2);
}

const STARTS: u32 = 16u;
const REFINEMENTS: u32 = 8u;
// Between starts: a turn over STARTS.
const BETWEEN: f32 = 0.39269908;
const BETWEEN_COS: f32 = 0.92387953;
const BETWEEN_SIN: f32 = 0.38268343;

// The direction that maximises e_t/sqrt(C_t): from the best of STARTS directions, the fibres' among them, by Newton's steps that stay in a bracket.
fn steepest(elastic: Elastic, mean: f32, other: vec2<f32>) -> vec2<f32> {
    var best = vec2<f32>(1.0, 0.0);
    var most = -1e30;
    var start = best;
    for (var k = 0u; k < STARTS; k += 1u) {
        let here = (mean + dot(other, start)) * inverseSqrt(compliance(elastic, start));
        if (here > most) {
            most = here;
            best = start;
        }
        start = vec2<f32>(start.x * BETWEEN_COS - start.y * BETWEEN_SIN, start.x * BETWEEN_SIN + start.y * BETWEEN_COS);
    }
    var low = -BETWEEN;
    var high = BETWEEN;
    var angle = 0.0;
    var direction = best;
    for (var k = 0u; k < REFINEMENTS; k += 1u) {
        let there = slope(elastic, mean, other, direction);
        if (there.x > 0.0) {
            low = angle;
        } else {
            high = angle;
        }
        // (At the end the step is none, and its place an end of the bracket. Without curvature the quotient is no number, and compares as false.)
        let newton = angle - there.x / there.y;
        angle = select(0.5 * (low + high), newton, there.y < 0.0 && newton >= low && newton <= high);
        direction = turned(best, angle);
    }
    return direction;
}

fn tension(elastic: Elastic, strain: vec3<f32>) -> Tension {
    let sheet = as_a_sheet(elastic, strain);
    let full = 0.5 * contracted(sheet, strain);
    if (mean_of(sheet) >= length(deviator(sheet))) {
        return Tension(sheet, full, vec2<f32>(1.0, 0.0), TAUT);
    }
    let mean = mean_of(strain);
    let other = deviator(strain);
    var direction = vec2<f32>(1.0, 0.0);
    if (elastic.isotropic == 1u) {
        // Under compression that is not the same along both axes, or under one that has no tension.
        // (Scaled first: squares of tiny strains are zero.)
        let size = max(abs(other.x), abs(other.y));
        let scaled = other / size;
        direction = select(direction, scaled / length(scaled), size > 0.0);
    } else {
        direction = steepest(elastic, mean, other);
    }
    let along = mean + dot(other, direction);
    let pull = select(0.0, elastic.young * along / compliance(elastic, direction), along > 0.0);
    let stress = mix(pull * dyad(direction), sheet, elastic.share);
    let energy = mix(0.5 * pull * along, full, elastic.share);
    return Tension(stress, energy, direction, select(SLACK, WRINKLED, along > 0.0));
}

// The part of a rate of strain that is along what bears tension.
fn in_tension(found: Tension, rate: vec3<f32>) -> vec3<f32> {
    if (found.state == TAUT) {
        return rate;
    }
    let along = mean_of(rate) + dot(deviator(rate), found.direction);
    return select(0.0, along, found.state == WRINKLED) * dyad(found.direction);
}
