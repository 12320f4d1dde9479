//! `choose` against the f64 rule 3 (docs/explanation/method.md, "Collisions").

use corpuscle::subdomain::{FULL_SHARE, GpuFlight, GpuParticle, GpuStep};

use crate::neighbour_lists::{put_flights, put_lists};
use crate::oracle::collision::{Body, closest_approach, meeting};
use crate::oracle::random::Stream;
use crate::oracle::vector::{minus, norm};
use crate::rig::*;

pub const DIAMETER: f64 = 0.005;
pub const DT: f32 = 1e-5;
pub const LIST: usize = 64;

/// A cloud of particles with flights, and the lists of those within the edge of a cell.
pub struct Cloud {
    pub world: World,
    pub particles: Vec<GpuParticle>,
    pub flights: Vec<GpuFlight>,
    pub lists: Vec<Vec<u32>>,
    /// The diameter of each is that of the share in its flight.
    pub capped: bool,
}

impl Cloud {
    /// `edge` is the part of the world (about its middle) that the cloud takes up.
    pub fn new(stream: &mut Stream, world: World, count: usize, edge: f64) -> Cloud {
        let mut particles = world.particles(stream, count, 400.0);
        for particle in &mut particles {
            let at = world.metres(particle.position);
            let middle = |k: usize| 0.5 * (world.low[k] + world.high[k]);
            particle.position = world.fixed(std::array::from_fn(|k| middle(k) + edge * (at[k] - middle(k))));
        }
        let cells = world.cells();
        let midpoints: Vec<[u32; 3]> = particles.iter().map(|p| cells.middle(p.position, p.velocity, DT)).collect();
        let near = |i: usize, j: usize| i != j && cells.nearer_than_a_cell(midpoints[i], midpoints[j]);
        let lists: Vec<Vec<u32>> =
            (0..count).map(|i| (0..count).filter(|&j| near(i, j)).map(|j| j as u32).collect()).collect();
        assert!(lists.iter().all(|list| list.len() <= LIST), "room for all neighbours");
        Cloud { world, flights: free_flights(count), particles, lists, capped: false }
    }

    pub fn rig(&self) -> Rig {
        let count = self.particles.len();
        let mut rig = Rig::new(&self.world);
        rig.constant("DIAMETER", DIAMETER);
        rig.constant("CAPPED", f64::from(u8::from(self.capped)));
        rig.put("sorted", &self.particles);
        put_flights(&mut rig, &self.flights);
        put_lists(&mut rig, &self.lists);
        // All of them choose in the first round.
        rig.put("rechoose", &(0..(count + 64 * LIST_SHARDS) as u32).collect::<Vec<_>>());
        rig.set_choosers(0, count);
        rig
    }

    pub fn step(&self, round: u32) -> GpuStep {
        GpuStep { count: self.particles.len() as u32, index: 77, dt: DT, round, ..GpuStep::default() }
    }

    /// Gives every particle a share of the cross-section, from a fiftieth to all.
    pub fn cap(&mut self, stream: &mut Stream) {
        self.capped = true;
        for flight in &mut self.flights {
            flight.collisions |= (1 + FULL_SHARE - stream.below(FULL_SHARE - FULL_SHARE / 50)).min(FULL_SHARE) << 16;
        }
    }

    /// The smaller of the two diameters, m.
    pub fn diameter(&self, s: usize, j: usize) -> f64 {
        if !self.capped {
            return DIAMETER;
        }
        let share = |s: usize| f64::from(self.flights[s].collisions >> 16) / f64::from(FULL_SHARE);
        DIAMETER * share(s).min(share(j)).sqrt()
    }

    pub fn body(&self, s: usize) -> Body {
        let (p, f) = (self.particles[s], self.flights[s]);
        Body {
            id: p.id(),
            gas: usize::from(p.gas()),
            x0: self.world.metres(p.position),
            v: p.velocity.map(f64::from),
            spin: f64::from(p.spin),
            start: f64::from(f.start),
            wall: f64::from(f.wall),
            partner: (f.partner != NOBODY).then_some(f.partner & GpuParticle::ID_MASK),
        }
    }

    /// The two in the order of their ids.
    pub fn pair(&self, s: usize, j: usize) -> (Body, Body) {
        let (a, b) = (self.body(s), self.body(j));
        if a.id < b.id { (a, b) } else { (b, a) }
    }

    /// How far f32 may be off a pair's time: r errs by 3 u |r|, g by u |g|, the dot products and the quotient
    /// by a few u more of |r| / |g|.
    pub fn time_error(&self, s: usize, j: usize) -> f64 {
        let (i, j) = self.pair(s, j);
        16.0 * U * norm(minus(j.x0, i.x0)) / norm(minus(j.v, i.v)) + 4.0 * U * f64::from(DT)
    }
}

/// What the f64 rule says of a pair, given how far f32 may be off.
enum Verdict {
    Surely(f64),
    Perhaps(f64),
    Never,
}

fn verdict(cloud: &Cloud, s: usize, partner: usize) -> Verdict {
    let (i, j) = cloud.pair(s, partner);
    let Some((time, miss)) = closest_approach(&i, &j, [0.0; 3]) else { return Verdict::Never };
    let error = cloud.time_error(s, partner);
    let miss_error = 16.0 * U * norm(minus(j.x0, i.x0));
    let latest = f64::from(DT).min(i.wall).min(j.wall);
    let room = (time - i.start.max(j.start)).min(latest - time);
    // Pairs that have just collided are told apart exactly.
    let diameter = cloud.diameter(s, partner);
    let barred = i.partner == Some(j.id) && j.partner == Some(i.id);
    if barred || room < -error || norm(miss) - diameter > miss_error {
        Verdict::Never
    } else if room > error && diameter - norm(miss) > miss_error {
        assert_eq!(meeting(&i, &j, [0.0; 3], diameter, f64::from(DT)), Some(time));
        Verdict::Surely(time)
    } else {
        Verdict::Perhaps(time)
    }
}

/// Choices that are not those of f64, and how many had to be just so: the reference's margins were clear.
fn wrong(cloud: &Cloud, choices: &[[u32; 2]], these: &[u32]) -> (usize, usize) {
    let (mut wrong, mut clear) = (0, 0);
    for &s in these {
        let s = s as usize;
        let mut open: Vec<(f64, u32, bool)> = Vec::new();
        for &j in &cloud.lists[s] {
            match verdict(cloud, s, j as usize) {
                Verdict::Surely(time) => open.push((time, j, true)),
                Verdict::Perhaps(time) => open.push((time, j, false)),
                Verdict::Never => {}
            }
        }
        let [partner, bits] = choices[s];
        let error = |j: u32| cloud.time_error(s, j as usize);
        let latest = open.iter().filter(|o| o.2).map(|o| o.0 + error(o.1)).fold(f64::INFINITY, f64::min);
        let fine = if partner == NOBODY {
            latest == f64::INFINITY
        } else {
            let time = f64::from(f32::from_bits(bits));
            open.iter().any(|o| o.1 == partner && (o.0 - time).abs() <= error(partner)) && time <= latest
        };
        wrong += usize::from(!fine);
        let early = open.iter().filter(|o| o.0 - error(o.1) <= latest).count();
        clear += usize::from(early == 1 && open.iter().all(|o| o.2));
    }
    (wrong, clear)
}

/// A cloud in which some flights start late, end at a wall, or have just had a partner.
fn busy_cloud(seed: u32) -> Cloud {
    let mut stream = Stream::new(seed);
    let mut cloud = Cloud::new(&mut stream, World::plain(), 1200, 1.0);
    for s in 0..cloud.particles.len() {
        if stream.below(3) == 0 {
            cloud.flights[s].start = 0.5 * DT * stream.uniform() as f32;
        }
        if stream.below(3) == 0 {
            cloud.flights[s].wall = DT * stream.uniform() as f32;
        }
        if let (0, Some(&j)) = (stream.below(2), cloud.lists[s].first()) {
            cloud.flights[s].partner = cloud.particles[j as usize].tag;
            if stream.below(3) > 0 {
                cloud.flights[j as usize].partner = cloud.particles[s].tag;
            }
        }
    }
    cloud
}

/// The partner is the f64 rule's wherever its margins are beyond f32, never one it forbids, and the time is
/// that of the closest approach within the bound; in the first round for all, later for those on the list.
#[test]
fn choices_are_those_of_the_rule() {
    let mut cloud = busy_cloud(30);
    let count = cloud.particles.len();
    let all: Vec<u32> = (0..count as u32).collect();
    for round in [0, 2] {
        let mut rig = cloud.rig();
        let some: Vec<u32> =
            if round == 0 { all.clone() } else { all.iter().copied().filter(|s| s % 3 == 1).collect() };
        let before = vec![[7u32, 7]; count];
        rig.put("choices", &before);
        rig.put("rechoose", &some);
        rig.set_choosers(round as usize, some.len());
        rig.step(cloud.step(round));
        rig.run("choose", some.len());
        let choices: Vec<[u32; 2]> = rig.get("choices", count);
        let (off, clear) = wrong(&cloud, &choices, &some);
        assert_eq!(off, 0, "round {round}");
        let chosen = some.iter().filter(|&&s| choices[s as usize][0] != NOBODY).count();
        assert!(clear > chosen / 2 && chosen > some.len() / 5, "{clear} clear, {chosen} chosen of {}", some.len());
        assert!((0..count).all(|s| some.contains(&(s as u32)) || choices[s] == before[s]));
        if round == 0 {
            // The check can fail: flights that start later have fewer choices.
            for flight in &mut cloud.flights {
                flight.start += 0.1 * DT;
            }
            assert!(wrong(&cloud, &choices, &some).0 > chosen / 50);
        }
    }
}

/// Where the diameter is capped that of a pair is the smaller of its two.
#[test]
fn choices_follow_the_smaller_diameter() {
    let mut cloud = busy_cloud(31);
    let count = cloud.particles.len();
    let all: Vec<u32> = (0..count as u32).collect();
    let choices = |cloud: &Cloud| -> Vec<[u32; 2]> {
        let mut rig = cloud.rig();
        rig.put("choices", &vec![[7u32, 7]; count]);
        rig.step(cloud.step(0));
        rig.run("choose", count);
        rig.get("choices", count)
    };
    let uncapped = choices(&cloud);
    for flight in &mut cloud.flights {
        flight.collisions = FULL_SHARE << 16;
    }
    cloud.capped = true;
    assert_eq!(choices(&cloud), uncapped, "all of the cross-section is all of it to the bit");
    for flight in &mut cloud.flights {
        flight.collisions = 0;
    }
    cloud.cap(&mut Stream::new(41));
    let capped = choices(&cloud);
    let (off, clear) = wrong(&cloud, &capped, &all);
    let chosen = capped.iter().filter(|choice| choice[0] != NOBODY).count();
    assert_eq!(off, 0);
    assert!(clear > chosen / 2 && chosen > count / 8, "{clear} clear, {chosen} chosen of {count}");
    // The check can fail: without shares they are others.
    assert!(wrong(&cloud, &uncapped, &all).0 > chosen / 10);
}
