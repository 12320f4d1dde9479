//! `bounce` at walls that are no mirrors, against the distributions and sums that its surface_models stand for.

use corpuscle::subdomain::{GpuFlight, GpuGas, GpuParticle, GpuStep, GpuSurfaceModel, GpuVent};

use crate::neighbour_lists::put_flights;
use crate::oracle::random::Stream;
use crate::rig::*;

const DT: f32 = 3e-5;
/// Spin of two, of five degrees of freedom (a shape of 1 and of 2.5), of .8 (the boost) and none.
const GASES: [GpuGas; 4] = [
    GpuGas { mass: 1.0, exchange: 0.4, inverse_beta: 1.0, inverse_beta1: 0.5 },
    GpuGas { mass: 0.5, exchange: 0.4, inverse_beta: 0.4, inverse_beta1: 0.2857 },
    GpuGas { mass: 0.25, exchange: 0.4, inverse_beta: 2.5, inverse_beta1: 0.714 },
    GpuGas { mass: 0.125, exchange: 0.0, inverse_beta: 0.0, inverse_beta1: 1.0 },
];
/// kT_w over the reference mass, (m/s)^2.
const THERMAL: f32 = 9e4;
const ENERGY_SCALE: f64 = 0.1;

/// A world whose walls all have surface_model 0.
fn not_a_mirror() -> World {
    let mut world = World::plain();
    for triangle in &mut world.walls.triangles {
        triangle.surface_model = 0;
    }
    world
}

/// Particles that hit the wall at x = low after 9/10 of the step, near its middle, and then no other.
fn towards_a_wall(world: &World, count: usize) -> Vec<GpuParticle> {
    let mut stream = Stream::new(31);
    let mut particles = world.particles(&mut stream, count, 100.0);
    for (k, particle) in particles.iter_mut().enumerate() {
        let speed = 300.0 + 400.0 * stream.uniform();
        particle.velocity[0] = -speed as f32;
        particle.tag = GpuParticle::tag((k % 4) as u8, particle.id());
        let middle = |axis: usize| 0.5 * (world.low[axis] + world.high[axis]);
        let x = world.low[0] + 0.9 * f64::from(DT) * speed;
        particle.position = world.fixed([x, middle(1) + 0.005 * stream.uniform(), middle(2)]);
    }
    particles
}

fn bounce(
    world: &World,
    particles: &[GpuParticle],
    surface_model: GpuSurfaceModel,
    vents: &[GpuVent],
    tallies_left: u32,
) -> Rig {
    let flights: Vec<GpuFlight> = free_flights(particles.len());
    let mut rig = Rig::new(world);
    let constants = [
        ("SURFACE_MODELS", 1.0),
        ("VENTS", f64::from(u8::from(!vents.is_empty()))),
        ("SURFACES", 0.0),
        ("SURFACE_MODELS_AT", SURFACE_WORDS as f64),
        ("VENTS_AT", (SURFACE_WORDS + SURFACE_MODEL_WORDS) as f64),
        ("ENERGY_SCALE", ENERGY_SCALE),
        ("SEED_LOW", 5.0),
    ];
    for (name, value) in constants {
        rig.constant(name, value);
    }
    rig.gases(&GASES);
    rig.put("sorted", particles);
    put_flights(&mut rig, &flights);
    rig.put("bouncing", &(0..particles.len() as u32).collect::<Vec<_>>());
    rig.put("surface_models", &[surface_model]);
    if !vents.is_empty() {
        rig.put("vents", vents);
    }
    rig.put("surface_sums", &vec![0u32; SURFACE_WORDS + SURFACE_MODEL_WORDS + VENT_WORDS * vents.len().max(1)]);
    rig.set_counter(LIST_BOUNCE, particles.len() as u32);
    rig.step(GpuStep { count: particles.len() as u32, dt: DT, index: 3, tallies_left, ..GpuStep::default() });
    rig.run("bounce", particles.len());
    rig
}

fn full() -> GpuSurfaceModel {
    GpuSurfaceModel {
        thermal: THERMAL,
        accommodation: 1.0,
        friction: 0.0,
        first_vent: 0,
        end_vent: 1,
        ..GpuSurfaceModel::default()
    }
}

fn sum_at(words: &[u32], slot: usize) -> f64 {
    (u64::from(words[slot]) | u64::from(words[slot + 1]) << 32).cast_signed() as f64
}

fn energy(particle: &GpuParticle) -> f64 {
    let mass = f64::from(GASES[usize::from(particle.gas())].mass);
    0.5 * mass * particle.velocity.map(|v| f64::from(v).powi(2)).iter().sum::<f64>() + f64::from(particle.spin)
}

/// Largest distance of the values' distribution from a cumulative one, over 1 / sqrt(count).
fn kolmogorov(values: &mut [f64], cumulative: impl Fn(f64) -> f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let count = values.len() as f64;
    let off = |(k, &value): (usize, &f64)| {
        let expected = cumulative(value);
        (expected - k as f64 / count).abs().max((expected - (k + 1) as f64 / count).abs())
    };
    values.iter().enumerate().map(off).fold(0.0, f64::max) * count.sqrt()
}

/// Beyond this a distribution differs, by chance once in two thousand (Kolmogorov).
const DIFFERS: f64 = 2.03;

/// The standard normal distribution function, by its derivative (trapezoidal rule).
fn normal_cumulative(x: f64) -> f64 {
    let steps = 400;
    let h = x / f64::from(steps);
    let density = |t: f64| (-0.5 * t * t).exp() / (2.0 * std::f64::consts::PI).sqrt();
    0.5 + (0..steps).map(|k| 0.5 * h * (density(f64::from(k) * h) + density(f64::from(k + 1) * h))).sum::<f64>()
}

/// What leaves an accommodating wall has P(v_n < v) = 1 - exp(-m v^2 / 2kT), normal components across, and a spin
/// of mean zeta/2 kT and variance zeta/2 (kT)^2; what it brought more than that is in the surface_model's tally.
#[test]
fn an_accommodating_wall_emits_a_maxwell_flux_of_its_temperature() {
    let world = not_a_mirror();
    let particles = towards_a_wall(&world, 8000);
    let rig = bounce(&world, &particles, full(), &[], 3);
    assert_eq!(rig.counter(BOUNCES), 8000, "each hits once");
    let after: Vec<GpuParticle> = rig.get("particles", particles.len());
    for (gas, table) in GASES.iter().enumerate() {
        let own: Vec<&GpuParticle> = after.iter().filter(|p| usize::from(p.gas()) == gas).collect();
        let speed = f64::from(THERMAL / table.mass).sqrt();
        let component = |axis: usize| own.iter().map(|p| f64::from(p.velocity[axis]) / speed).collect::<Vec<f64>>();
        let flux = |v: f64| if v > 0.0 { 1.0 - (-0.5 * v * v).exp() } else { 0.0 };
        assert!(kolmogorov(&mut component(0), flux) < DIFFERS);
        for axis in [1, 2] {
            assert!(kolmogorov(&mut component(axis), normal_cumulative) < DIFFERS);
        }
        // The check can fail: 6 % in speed are seen.
        let mut faster: Vec<f64> = component(0).iter().map(|v| 1.06 * v).collect();
        assert!(kolmogorov(&mut faster, flux) > DIFFERS);
        // Components are independent: no correlation above 4.5 standard errors.
        let product: f64 = component(1).iter().zip(component(2)).map(|(a, b)| a * b).sum();
        assert!(product.abs() < 4.5 * (own.len() as f64).sqrt());
        let spins: Vec<f64> = own.iter().map(|p| f64::from(p.spin / THERMAL)).collect();
        if table.exchange == 0.0 {
            assert!(spins.iter().all(|&spin| spin == 0.0));
            continue;
        }
        let shape = 1.0 / f64::from(table.inverse_beta);
        let count = spins.len() as f64;
        let mean = spins.iter().sum::<f64>() / count;
        let variance = spins.iter().map(|spin| (spin - shape).powi(2)).sum::<f64>() / count;
        // Of a gamma variate: variance = shape, fourth central moment 3 shape^2 + 6 shape.
        assert!((mean - shape).abs() < 4.5 * (shape / count).sqrt(), "{mean} {shape}");
        let error = ((2.0 * shape * shape + 6.0 * shape) / count).sqrt();
        assert!((variance - shape).abs() < 4.5 * error, "{variance} {shape}");
    }
    let taken: f64 = particles.iter().map(energy).sum::<f64>() - after.iter().map(energy).sum::<f64>();
    let words: Vec<u32> = rig.get("surface_sums", SURFACE_WORDS + SURFACE_MODEL_WORDS);
    let tally = sum_at(&words, SURFACE_WORDS) / ENERGY_SCALE;
    let scale: f64 = particles.iter().map(energy).sum();
    // Half a unit a hit at most, and f32's rounding of each.
    let allowed = 8000.0 * 0.5 / ENERGY_SCALE + 8.0 * U * scale;
    assert!((tally - taken).abs() < allowed, "{tally} {taken}");
    assert!(allowed < 1e-3 * taken.abs() && taken < 0.0, "the check can fail: the wall gave {taken}");
    assert_eq!(sum_at(&words, SURFACE_WORDS + 2), 3.0 * sum_at(&words, SURFACE_WORDS));
}

/// A share of the hits takes the temperature of the wall; the others are mirrored.
#[test]
fn a_share_of_the_hits_is_accommodated() {
    let world = not_a_mirror();
    let particles = towards_a_wall(&world, 8000);
    let rig = bounce(&world, &particles, GpuSurfaceModel { accommodation: 0.3, ..full() }, &[], 0);
    let after: Vec<GpuParticle> = rig.get("particles", particles.len());
    let mirrored = |(old, new): &(&GpuParticle, &GpuParticle)| (new.velocity[0] + old.velocity[0]).abs() < 1e-3;
    let share = 1.0 - particles.iter().zip(&after).filter(mirrored).count() as f64 / 8000.0;
    // Binomial: .3 +- .0051.
    assert!((share - 0.3).abs() < 4.5 * (0.21f64 / 8000.0).sqrt(), "{share}");
    // Without tallies to come, nothing is weighted with them.
    let words: Vec<u32> = rig.get("surface_sums", SURFACE_WORDS + SURFACE_MODEL_WORDS);
    assert_eq!(sum_at(&words, SURFACE_WORDS + 2), 0.0);
    assert!(sum_at(&words, SURFACE_WORDS) != 0.0);
}

/// Through a vent passes a share beta m |v_n| of what hits its place; it is gone, and its number and energy are tallied.
#[test]
fn a_vent_passes_in_proportion_to_mass_and_normal_speed() {
    let world = not_a_mirror();
    let particles = towards_a_wall(&world, 8000);
    let beta = 1e-3;
    // Half the particles hit within the disc.
    let place = |p: &GpuParticle| world.metres(p.position)[1] + f64::from(p.velocity[1]) * 0.9 * f64::from(DT);
    let middle = 0.5 * (world.low[1] + world.high[1]);
    let center = [world.low[0], middle - 0.0175, 0.5 * (world.low[2] + world.high[2])];
    let vent = GpuVent { center: world.fixed(center), radius2: 0.02f32 * 0.02, beta, index: 0, ..GpuVent::default() };
    let mirror = GpuSurfaceModel {
        thermal: 0.0,
        accommodation: 0.0,
        friction: 0.0,
        first_vent: 0,
        end_vent: 1,
        ..GpuSurfaceModel::default()
    };
    let rig = bounce(&world, &particles, mirror, &[vent], 2);
    let after: Vec<GpuParticle> = rig.get("particles", particles.len());
    let gone = |k: usize| after[k].tag == NOBODY;
    let (mut expected, mut variance, mut energy_out) = (0.0, 0.0, 0.0);
    let (mut inside, mut left) = (0.0, [0u32; 4]);
    for (k, particle) in particles.iter().enumerate() {
        let z = world.metres(particle.position)[2] + f64::from(particle.velocity[2]) * 0.9 * f64::from(DT);
        let away2 = (place(particle) - center[1]).powi(2) + (z - center[2]).powi(2);
        let holds = away2 < 0.02f64.powi(2);
        if (away2.sqrt() - 0.02).abs() < 1e-6 {
            continue;
        }
        assert!(holds || !gone(k), "outside of the disc");
        if holds {
            let mass = f64::from(GASES[usize::from(particle.gas())].mass);
            let p = (f64::from(beta) * mass * -f64::from(particle.velocity[0])).min(1.0);
            inside += 1.0;
            expected += p;
            variance += p * (1.0 - p);
        }
        if gone(k) {
            left[usize::from(particle.gas())] += 1;
            energy_out += energy(particle);
        }
    }
    let found: u32 = left.iter().sum();
    assert!((f64::from(found) - expected).abs() < 4.5 * f64::sqrt(variance), "{found} {expected}");
    // The check can fail: a fifth more would be seen.
    assert!(0.2 * expected > 4.5 * f64::sqrt(variance));
    assert!(inside > 2000.0 && inside < 7000.0, "{inside}");
    let words: Vec<u32> = rig.get("surface_sums", SURFACE_WORDS + SURFACE_MODEL_WORDS + VENT_WORDS);
    let at = SURFACE_WORDS + SURFACE_MODEL_WORDS;
    assert!((sum_at(&words, at + 4) - inside).abs() < 3.0);
    assert_eq!(sum_at(&words, at + 6), 0.0, "no probability above one");
    for (word, left) in words[at + 8..].iter().zip(left) {
        assert!(word.abs_diff(left) < 2);
    }
    let tally = sum_at(&words, at) / ENERGY_SCALE;
    assert!((tally / energy_out - 1.0).abs() < 2e-3, "{tally} {energy_out}");
    assert_eq!(sum_at(&words, at + 2), 2.0 * sum_at(&words, at));
    // A beta ten times as large is clipped for the heaviest gas.
    let clipped = bounce(&world, &particles, mirror, &[GpuVent { beta: 10.0 * beta, ..vent }], 0);
    let words: Vec<u32> = clipped.get("surface_sums", SURFACE_WORDS + SURFACE_MODEL_WORDS + VENT_WORDS);
    assert!(sum_at(&words, at + 6) > 500.0);
}

/// A rough wall sends a share of the hits off by the cosine law, P(cos < c) = c^2, to every side alike, with the speed and the
/// spin that they had; the others are mirrored. It takes no heat.
#[test]
fn a_rough_wall_scatters_by_the_cosine_law_and_keeps_the_speed() {
    let world = not_a_mirror();
    let particles = towards_a_wall(&world, 8000);
    let speed = |p: &GpuParticle| p.velocity.map(|v| f64::from(v).powi(2)).iter().sum::<f64>().sqrt();
    for friction in [1.0f32, 0.4] {
        let rough = GpuSurfaceModel { accommodation: 0.0, friction, ..full() };
        let rig = bounce(&world, &particles, rough, &[], 3);
        let after: Vec<GpuParticle> = rig.get("particles", particles.len());
        let words: Vec<u32> = rig.get("surface_sums", SURFACE_WORDS + SURFACE_MODEL_WORDS);
        assert_eq!(sum_at(&words, SURFACE_WORDS), 0.0, "no heat");
        for (old, new) in particles.iter().zip(&after) {
            assert!((speed(new) / speed(old) - 1.0).abs() < 8.0 * U);
            assert!((f64::from(new.spin) - f64::from(old.spin)).abs() < 32.0 * U * energy(old));
        }
        let mirrored = |(old, new): &(&GpuParticle, &GpuParticle)| (new.velocity[0] + old.velocity[0]).abs() < 1e-3;
        let share = 1.0 - particles.iter().zip(&after).filter(mirrored).count() as f64 / 8000.0;
        let expected = f64::from(friction);
        assert!((share - expected).abs() <= 4.5 * (expected * (1.0 - expected) / 8000.0).sqrt() + 1e-3, "{share}");
        let scattered: Vec<&GpuParticle> =
            particles.iter().zip(&after).filter(|pair| !mirrored(pair)).map(|(_, new)| new).collect();
        let cosine = |p: &&GpuParticle| f64::from(p.velocity[0]) / speed(p);
        let mut cosines: Vec<f64> = scattered.iter().map(cosine).collect();
        assert!(kolmogorov(&mut cosines, |c| c.clamp(0.0, 1.0).powi(2)) < DIFFERS);
        let angle = |p: &&GpuParticle| f64::from(p.velocity[2]).atan2(f64::from(p.velocity[1]));
        let mut angles: Vec<f64> = scattered.iter().map(angle).collect();
        let around = |a: f64| 0.5 + a / (2.0 * std::f64::consts::PI);
        assert!(kolmogorov(&mut angles, around) < DIFFERS);
        // The check can fail: a steeper law is seen where all are scattered.
        if friction == 1.0 {
            let mut steeper: Vec<f64> = cosines.iter().map(|c| c.powf(0.85)).collect();
            assert!(kolmogorov(&mut steeper, |c| c.clamp(0.0, 1.0).powi(2)) > DIFFERS);
        }
    }
    // Beside accommodation it is a share of what is left.
    let both = GpuSurfaceModel { accommodation: 0.5, friction: 0.5, ..full() };
    let rig = bounce(&world, &particles, both, &[], 0);
    let after: Vec<GpuParticle> = rig.get("particles", particles.len());
    let kept = |(old, new): &(&GpuParticle, &GpuParticle)| (speed(new) / speed(old) - 1.0).abs() < 1e-6;
    let mirrored = |(old, new): &(&GpuParticle, &GpuParticle)| (new.velocity[0] + old.velocity[0]).abs() < 1e-3;
    let count = |what: &dyn Fn(&(&GpuParticle, &GpuParticle)) -> bool| {
        particles.iter().zip(&after).filter(|pair| what(pair)).count() as f64 / 8000.0
    };
    assert!((count(&kept) - 0.5).abs() < 4.5 * 0.5 / 8000f64.sqrt());
    assert!((count(&mirrored) - 0.25).abs() < 4.5 * (0.1875f64 / 8000.0).sqrt());
}
