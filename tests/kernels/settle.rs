//! `settle` against the f64 collision (docs/explanation/method.md, "Collisions").

use std::collections::BTreeSet;

use corpuscle::scene::{GasSide, Shape};
use corpuscle::subdomain::{FULL_SHARE, GpuFlight, GpuGas, GpuParticle};

use crate::choose::{Cloud, DT};
use crate::oracle::collision::{Draws, Gas, Meeting, closest_approach, collide, meeting};
use crate::oracle::random::Stream;
use crate::oracle::vector::{Vector, along, dot, minus, norm, scaled};
use crate::oracle::walls::parted;
use crate::rig::*;

pub const ROUND: u32 = 1;
const SEED: [u32; 2] = [0x1234_5678, 0x9abc_de04];

/// Two gases of masses 1 and 1/7 with two and three internal degrees of freedom.
fn gases() -> [Gas; 2] {
    [
        Gas { exchange: f64::from(0.6f32), ..Gas::with_collision_number(1.0, 2.0, 5.0) },
        Gas { mass: f64::from(1.0f32 / 7.0), exchange: f64::from(0.8f32), degrees: 3.0, modes: &[] },
    ]
}

fn table() -> [GpuGas; 2] {
    gases().map(|gas| GpuGas {
        mass: gas.mass as f32,
        exchange: gas.exchange as f32,
        inverse_beta: (2.0 / gas.degrees) as f32,
        inverse_beta1: (2.0 / (gas.degrees + 2.0)) as f32,
    })
}

/// Disjoint pairs that may meet within the tank, lower id first, with the f32 time of their closest approach.
pub fn meetings(cloud: &Cloud) -> Vec<(usize, usize, f32)> {
    let mut taken = BTreeSet::new();
    let mut pairs = Vec::new();
    for (s, list) in cloud.lists.iter().enumerate() {
        for &j in list {
            let other = j as usize;
            let (i, j) = cloud.pair(s, other);
            let inside = |x: Vector| (0..3).all(|k| x[k] > cloud.world.low[k] && x[k] < cloud.world.high[k]);
            if let Some(time) = meeting(&i, &j, [0.0; 3], cloud.diameter(s, other), f64::from(DT))
                && inside(along(i.x0, i.v, time))
                && inside(along(j.x0, j.v, time))
                && !taken.contains(&s)
                && !taken.contains(&other)
            {
                taken.extend([s, other]);
                let own_first = cloud.particles[s].id() == i.id;
                pairs.push((if own_first { s } else { other }, if own_first { other } else { s }, time as f32));
            }
        }
    }
    pairs
}

/// kT_ref over the reference mass of the gases with modes, (m/s)^2: energies of the cloud are of this order.
const THERMAL: f64 = 160_000.0;

/// The first of the gases with a heat capacity that grows with the temperature, the second as it is.
fn curved() -> [Gas; 2] {
    let [first, second] = gases();
    [Gas { modes: &[[0.5, 0.0, 1.0], [0.25, 1.0, 2.0], [0.03125, 3.0, 4.0], [0.001953125, 7.0, 8.0]], ..first }, second]
}

/// The device's table of modes.
fn mode_rows() -> Vec<[f32; 4]> {
    let mut table = vec![[-1e30, 0.0, 1.0, 1.0]; 1024];
    for (gas, rows) in curved().iter().zip(table.chunks_exact_mut(32)) {
        let row =
            |[weight, power, beta]: [f64; 3]| [weight.ln(), power, 1.0 / beta, 1.0 / (beta + 1.0)].map(|x| x as f32);
        let beta = 0.5 * gas.degrees;
        let modes = if gas.modes.is_empty() { vec![[1.0, 0.0, beta]] } else { gas.modes.to_vec() };
        for (own, mode) in rows.iter_mut().zip(modes) {
            *own = row(mode);
        }
    }
    table
}

fn settle(cloud: &Cloud, pairs: &[(usize, usize, f32)], spin: bool) -> Rig {
    settle_with(cloud, pairs, spin, false)
}

fn settle_with(cloud: &Cloud, pairs: &[(usize, usize, f32)], spin: bool, curves: bool) -> Rig {
    let rig = prepared(cloud, pairs, spin, curves);
    rig.run("settle", pairs.len());
    rig
}

pub fn prepared(cloud: &Cloud, pairs: &[(usize, usize, f32)], spin: bool, curves: bool) -> Rig {
    let mut rig = cloud.rig();
    let mut choices = vec![[NOBODY, 0u32]; cloud.particles.len()];
    for &(i, j, time) in pairs {
        choices[i] = [j as u32, time.to_bits()];
        choices[j] = [i as u32, time.to_bits()];
    }
    rig.constant("SPIN", f64::from(u8::from(spin)));
    rig.constant("SEED_LOW", f64::from(SEED[0]));
    rig.constant("SEED_HIGH", f64::from(SEED[1]));
    rig.gases(&table());
    if curves {
        rig.constant("CURVES", 1.0);
        rig.constant("MODES", 4.0);
        rig.constant("INVERSE_THERMAL", 1.0 / THERMAL);
        rig.uniform("modes", &mode_rows());
    }
    rig.put("choices", &choices);
    rig.put("pairs", &pairs.iter().map(|&(i, j, _)| [i as u32, j as u32]).collect::<Vec<_>>());
    rig.set_sharded(ROUND as usize, pairs.len());
    rig.step(cloud.step(ROUND));
    rig
}

/// Collisions of pairs faster than the limit are counted, by the owner of the lower id.
#[test]
fn fast_pairs_are_counted_by_the_owner_of_the_lower_id() {
    let mut stream = Stream::new(67);
    let cloud = Cloud::new(&mut stream, World::plain(), 3000, 1.0);
    let pairs = meetings(&cloud);
    let speed2 = |i: usize, j: usize| {
        let [v, w] = [i, j].map(|k| cloud.particles[k].velocity.map(f64::from));
        dot(minus(v, w), minus(v, w))
    };
    let mut speeds: Vec<f64> = pairs.iter().map(|&(i, j, _)| speed2(i, j)).collect();
    speeds.sort_by(f64::total_cmp);
    let limit = 0.5 * (speeds[pairs.len() / 2] + speeds[pairs.len() / 2 - 1]);
    let layers: Vec<u32> = (0..cloud.particles.len()).map(|_| stream.below(2)).collect();
    let mut rig = prepared(&cloud, &pairs, false, false);
    rig.constant("FASTEST2", limit);
    rig.put("marks", &layers);
    rig.run("settle", pairs.len());
    let counted = pairs.iter().filter(|&&(i, j, _)| layers[i] == 0 && speed2(i, j) > limit).count();
    assert_eq!(rig.counter(FAST_PAIRS) as usize, counted);
    assert!(counted > 20 && counted < pairs.len() / 2 - 20, "{counted} of {}", pairs.len());
}

/// What is off in one pair, in units of its bound: velocity, spin, place at the meeting.
fn deviation(
    cloud: &Cloud,
    &(s, t, time): &(usize, usize, f32),
    after: &[GpuParticle],
    key: [u32; 2],
    spin: bool,
) -> f64 {
    let gases = gases().map(|gas| if spin { gas } else { Gas { degrees: 0.0, ..gas } });
    deviation_of(cloud, &(s, t, time), after, key, gases)
}

fn deviation_of(
    cloud: &Cloud,
    &(s, t, time): &(usize, usize, f32),
    after: &[GpuParticle],
    key: [u32; 2],
    gases: [Gas; 2],
) -> f64 {
    let spin = gases[0].degrees > 0.0;
    let (mut i, mut j) = (cloud.body(s), cloud.body(t));
    let (_, miss) = closest_approach(&i, &j, [0.0; 3]).unwrap();
    let (r, g) = (minus(j.x0, i.x0), minus(j.v, i.v));
    let reduced = gases[i.gas].mass * gases[j.gas].mass / (gases[i.gas].mass + gases[j.gas].mass);
    let energy = 0.5 * reduced * dot(g, g) + i.spin + j.spin;
    let places = [along(i.x0, i.v, f64::from(time)), along(j.x0, j.v, f64::from(time))];
    let diameter = cloud.diameter(s, t);
    let draws = Draws::of(77, ROUND, [i.id, j.id], key);
    let meeting = Meeting { image: [0.0; 3], time: f64::from(time), diameter };
    collide(&mut i, &mut j, meeting, &gases, &draws);
    // The miss vector errs by 16 u |r|. It turns g' by that over sigma, and by more near b = sigma, where
    // sin chi = 2 sqrt(b2 (1 - b2)) is steep; powers of f32 cost up to 64 u of the energy.
    let b = (norm(miss) / diameter).min(1.0);
    let error = 16.0 * U * norm(r) / diameter;
    let steep = (1.0 - b * b).max(error).sqrt();
    let speed = (2.0 * energy / reduced).sqrt();
    let mut worst = 0.0f64;
    for (body, index, place) in [(&i, s, places[0]), (&j, t, places[1])] {
        let found = after[index];
        let share = reduced / gases[body.gas].mass;
        let turned = share * speed * error * (4.0 + 4.0 / steep);
        let exchanged =
            if spin { 64.0 * U * energy / (reduced * norm(minus(j.v, i.v)).max(1e-3)) * share } else { 0.0 };
        let velocity_bound = turned + exchanged + 8.0 * U * (norm(body.v) + speed);
        worst = worst.max(norm(minus(found.velocity.map(f64::from), body.v)) / velocity_bound);
        worst =
            worst.max((f64::from(found.spin) - body.spin).abs() / (128.0 * U * energy + velocity_bound * 1e-3 * speed));
        let there = along(cloud.world.metres(found.position), found.velocity.map(f64::from), f64::from(time));
        let place_bound = 2.0 * cloud.world.grid.quantum() + 16.0 * U * speed * f64::from(DT);
        worst = worst.max(norm(minus(there, place)) / place_bound);
    }
    worst
}

/// Velocities, spins and places after a collision are those of f64 with the same random numbers; momentum and
/// energy are kept to the rounding of the state; the virial is zero to 1e-6.
#[test]
fn collisions_are_those_of_f64_and_conserve() {
    for (spin, capped) in [(true, false), (false, false), (true, true)] {
        let mut stream = Stream::new(32);
        let mut cloud = Cloud::new(&mut stream, World::plain(), 1600, 0.9);
        if capped {
            cloud.cap(&mut stream);
        }
        let pairs = meetings(&cloud);
        assert!(pairs.len() > if capped { 100 } else { 200 }, "{} pairs", pairs.len());
        let rig = settle(&cloud, &pairs, spin);
        let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
        let blocked = rig.counter(BLOCKED);
        assert_eq!(blocked, 0);
        assert_eq!(rig.counter(32), pairs.len() as u32, "collisions are counted");
        let (mut sum, mut scale, mut other_key) = (0.0, 0.0, 0);
        for pair in &pairs {
            let off = deviation(&cloud, pair, &after, SEED, spin);
            assert!(off < 1.0, "spin {spin}, capped {capped}: {off} of the bound");
            other_key += usize::from(deviation(&cloud, pair, &after, [SEED[0] + 1, SEED[1]], spin) > 1.0);
            let (s, t, _) = *pair;
            let mass = |k: usize| gases()[usize::from(cloud.particles[k].gas())].mass;
            let v = |p: &GpuParticle| p.velocity.map(f64::from);
            let momentum = |p: &[GpuParticle]| along(scaled(v(&p[s]), mass(s)), v(&p[t]), mass(t));
            let energy = |p: &[GpuParticle]| {
                [s, t].map(|k| 0.5 * mass(k) * dot(v(&p[k]), v(&p[k])) + f64::from(p[k].spin)).iter().sum::<f64>()
            };
            // Four roundings of each velocity component.
            let size =
                [s, t].map(|k| mass(k) * (norm(v(&after[k])) + norm(v(&cloud.particles[k])))).iter().sum::<f64>();
            assert!(norm(minus(momentum(&after), momentum(&cloud.particles))) < 4.0 * U * size);
            let kept = energy(&after) / energy(&cloud.particles) - 1.0;
            assert!(kept.abs() < if spin { 16.0 * U } else { 64.0 * U }, "{kept}");
            // The virial, with r at the meeting in f64.
            let (i, j) = (cloud.body(s), cloud.body(t));
            let (_, miss) = closest_approach(&i, &j, [0.0; 3]).unwrap();
            let change: Vector = minus(minus(v(&after[t]), v(&after[s])), minus(j.v, i.v));
            sum += dot(miss, change);
            scale += norm(miss) * norm(change);
        }
        assert!((sum / scale).abs() < 1e-6, "virial {}", sum / scale);
        // The check can fail: another seed gives other sides to half the pairs, and other exchanges.
        assert!(other_key > pairs.len() / 3, "{other_key} of {}", pairs.len());
    }
}

/// With modes a collision is that of f64 with the same random numbers, but for pairs whose draw falls between two modes
/// within rounding; they differ from those of a constant heat capacity.
#[test]
fn exchanges_with_modes_are_those_of_f64() {
    let mut stream = Stream::new(35);
    let cloud = Cloud::new(&mut stream, World::plain(), 1600, 0.9);
    let pairs = meetings(&cloud);
    let scaled = |gas: Gas| {
        // The oracle takes energies over kT_ref: the weights take up the rest.
        let modes: Vec<[f64; 3]> =
            gas.modes.iter().map(|[weight, power, beta]| [weight * THERMAL.powf(-power), *power, *beta]).collect();
        Gas { modes: modes.leak(), ..gas }
    };
    let gases = curved().map(scaled);
    let rig = settle_with(&cloud, &pairs, true, true);
    let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
    let off = pairs.iter().filter(|pair| deviation_of(&cloud, pair, &after, SEED, gases) >= 1.0).count();
    assert!(off <= 1, "{off} of {} pairs", pairs.len());
    let constant = pairs.iter().filter(|pair| deviation(&cloud, pair, &after, SEED, true) >= 1.0).count();
    assert!(constant > pairs.len() / 5, "{constant} of {}", pairs.len());
}

/// How many collide in a round is counted once, for the run and for the sample of lost collisions, in every variant of the kernels.
#[test]
fn the_collisions_of_a_round_are_counted_in_every_form() {
    let cloud = Cloud::new(&mut Stream::new(35), World::plain(), 1600, 0.9);
    let pairs = meetings(&cloud);
    for variant in variants() {
        let mut rig = prepared(&cloud, &pairs, true, false);
        rig.variant = variant;
        rig.set_sharded(ROUND as usize, pairs.len());
        rig.run("settle", pairs.len());
        let counted = [rig.counter(COLLISIONS_LOW), rig.counter(ROUND as usize)];
        assert_eq!(counted, [pairs.len() as u32; 2], "{variant:?}");
    }
    // In several parts of a list.
    assert!(pairs.len() > 64, "{}", pairs.len());
}

/// After a collision both flights start at the meeting, name each other, and all their neighbours choose
/// again, each once; nobody else changes.
#[test]
fn those_near_a_collision_choose_again() {
    let mut stream = Stream::new(33);
    let mut cloud = Cloud::new(&mut stream, World::plain(), 1600, 0.9);
    let pairs: Vec<_> = meetings(&cloud).into_iter().take(20).collect();
    for flight in &mut cloud.flights {
        flight.collisions = 3 | FULL_SHARE << 16;
    }
    let rig = settle(&cloud, &pairs, true);
    let flights: Vec<GpuFlight> = crate::neighbour_lists::flights(&rig, cloud.particles.len());
    let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
    let mut again = BTreeSet::new();
    let mut collided = BTreeSet::new();
    for &(i, j, time) in &pairs {
        for (own, other) in [(i, j), (j, i)] {
            let flight = flights[own];
            assert_eq!(
                (flight.start, flight.partner, flight.collisions),
                (time, cloud.particles[other].tag, 4 | FULL_SHARE << 16)
            );
            again.extend(cloud.lists[own].iter().copied());
            collided.insert(own);
        }
    }
    assert_eq!(rig.choosers(ROUND as usize + 1, cloud.particles.len()), again.into_iter().collect::<Vec<_>>());
    let unchanged = |s: usize| after[s] == cloud.particles[s] && flights[s] == cloud.flights[s];
    assert!((0..cloud.particles.len()).all(|s| unchanged(s) != collided.contains(&s)));
}

/// The tank with a plate across its middle.
pub fn parted_tank() -> World {
    let plate = Shape::Plane {
        center: [0.03, 0.035, 0.04],
        normal: [1.0, 0.0, 0.0],
        u: [0.0, 1.0, 0.0],
        size: [0.06, 0.07],
        thickness: 0.001,
        holes: vec![],
    };
    World::new(&[tank([0.06, 0.07, 0.08]), wall(plate, GasSide::Both)], 0.01)
}

/// A pair that a wall parts where it would meet does not collide; the two and all their neighbours choose again. (Whom
/// one of the two met before may meet it again. Choices must follow from the state alone: on several devices others
/// are asked to choose too. Runs on 3 subdomains had parted from those on one by eight particles near a vent.)
#[test]
fn a_wall_between_a_pair_stops_the_collision() {
    let world = parted_tank();
    let mut stream = Stream::new(34);
    let cloud = Cloud::new(&mut stream, world, 1600, 0.9);
    let pairs = meetings(&cloud);
    let rig = settle(&cloud, &pairs, true);
    let after: Vec<GpuParticle> = rig.get("sorted", cloud.particles.len());
    let flights: Vec<GpuFlight> = crate::neighbour_lists::flights(&rig, cloud.particles.len());
    let slack = 4.0 * cloud.world.walls.tolerance;
    let (mut blocked, mut met) = (0, 0);
    let mut again = BTreeSet::new();
    for &(s, t, time) in &pairs {
        again.extend([s as u32, t as u32]);
        again.extend(cloud.lists[s].iter().chain(&cloud.lists[t]).copied());
        let place = |k: usize| along(cloud.body(k).x0, cloud.body(k).v, f64::from(time));
        let collided = after[s].velocity != cloud.particles[s].velocity;
        if let Some(parted) = parted(&cloud.world.triangles, place(s), place(t), slack) {
            assert_eq!(collided, !parted);
        }
        if !collided {
            assert_eq!([after[s], after[t]], [cloud.particles[s], cloud.particles[t]]);
            assert_eq!(flights[s], GpuFlight { partner: after[t].tag, ..cloud.flights[s] });
            assert_eq!(flights[t], GpuFlight { partner: after[s].tag, ..cloud.flights[t] });
        }
        blocked += u32::from(!collided);
        met += u32::from(collided);
    }
    assert_eq!(rig.counter(BLOCKED), blocked);
    assert_eq!(rig.choosers(ROUND as usize + 1, cloud.particles.len()), again.into_iter().collect::<Vec<_>>());
    // The check can fail: both happen.
    assert!(blocked > 5 && met > 100, "{blocked} blocked, {met} met");
}

/// Where there is one gas only, kernels do not look at tags for it: nothing else changes.
#[test]
fn one_gas_alone_is_the_first_of_the_table() {
    let mut stream = Stream::new(71);
    let mut cloud = Cloud::new(&mut stream, World::plain(), 1000, 1.0);
    let settled = |cloud: &Cloud, gases: f64| {
        let pairs = meetings(cloud);
        let mut rig = prepared(cloud, &pairs, true, false);
        rig.constant("GASES", gases);
        rig.run("settle", pairs.len());
        rig.get::<u32>("sorted", 8 * cloud.particles.len())
    };
    assert_ne!(settled(&cloud, 1.0), settled(&cloud, 2.0), "of two gases tags are needed");
    cloud.particles.iter_mut().for_each(|particle| particle.tag &= 0x0fff_ffff);
    assert_eq!(settled(&cloud, 1.0), settled(&cloud, 2.0));
}
