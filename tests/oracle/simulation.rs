//! Whole steps of the closest-approach method (docs/explanation/method.md, "Collisions") in a box, f64, O(N^2).

use super::collision::{Body, Draws, Gas, Meeting, collide};
use super::pairing::{Candidates, choices, mutual};
use super::random::Stream;
use super::vector::{Vector, along, dot, minus, norm};
use super::walls::reflect_in_box;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Boundary {
    Periodic,
    Specular,
}

/// A box from the origin. Units are the caller's.
pub struct Simulation {
    pub bodies: Vec<Body>,
    pub gases: Vec<Gas>,
    pub size: Vector,
    pub boundary: Boundary,
    pub diameter: f64,
    pub rounds: u32,
    pub dt: f64,
    pub key: [u32; 2],
    /// Steps taken.
    pub steps: u32,
    pub collisions: u64,
    /// Pairs still mutually eligible after the last round.
    pub lost: u64,
    /// Normal impulse that the walls received, all faces together.
    pub impulse: f64,
    /// The largest |r . (g' - g)| / (|r| |g|) of a collision.
    pub virial: f64,
}

impl Simulation {
    /// `counts` bodies of each gas at kT = 1, uniform in the box, total momentum zero.
    pub fn new(counts: &[usize], gases: &[Gas], size: Vector, boundary: Boundary, seed: u32) -> Simulation {
        let mut stream = Stream::new(seed);
        let mut bodies = Vec::new();
        for (gas, &count) in counts.iter().enumerate() {
            for _ in 0..count {
                let speed = (1.0 / gases[gas].mass).sqrt();
                bodies.push(Body {
                    id: bodies.len() as u32,
                    gas,
                    x0: std::array::from_fn(|k| size[k] * stream.uniform()),
                    v: stream.normals().map(|v| v * speed),
                    spin: stream.half_chi_square(gases[gas].degrees as u32),
                    start: 0.0,
                    wall: f64::INFINITY,
                    partner: None,
                });
            }
        }
        let mut simulation = Simulation {
            bodies,
            gases: gases.to_vec(),
            size,
            boundary,
            diameter: 0.0,
            rounds: 0,
            dt: 0.0,
            key: [seed, 4],
            steps: 0,
            collisions: 0,
            lost: 0,
            impulse: 0.0,
            virial: 0.0,
        };
        let total = simulation.momentum();
        let mass: f64 = simulation.bodies.iter().map(|b| simulation.gases[b.gas].mass).sum();
        for body in &mut simulation.bodies {
            body.v = along(body.v, total, -1.0 / mass);
        }
        simulation
    }

    /// Sets diameter, rounds and step for an occupancy f and x = dt/tau at the present mean kinetic energy (of
    /// a single gas).
    pub fn collide_at(&mut self, occupancy: f64, x: f64, rounds: u32) {
        let density = self.bodies.len() as f64 / self.volume();
        self.diameter = (6.0 * occupancy / (std::f64::consts::PI * density)).cbrt();
        self.rounds = rounds;
        self.dt = x / self.rate_theory();
    }

    pub fn volume(&self) -> f64 {
        self.size.iter().product()
    }

    /// n pi sigma^2 gbar, gbar = sqrt(16 kT / (pi m)), kT = 2 Wk / 3 N: collisions of one particle per time.
    pub fn rate_theory(&self) -> f64 {
        let n = self.bodies.len() as f64;
        let thermal = 2.0 * self.kinetic() / (3.0 * n) / self.gases[0].mass;
        let relative = (16.0 * thermal / std::f64::consts::PI).sqrt();
        n / self.volume() * std::f64::consts::PI * self.diameter * self.diameter * relative
    }

    /// Collisions of one particle per time since the start.
    pub fn rate(&self) -> f64 {
        2.0 * self.collisions as f64 / (self.bodies.len() as f64 * self.dt * f64::from(self.steps))
    }

    /// Wk.
    pub fn kinetic(&self) -> f64 {
        self.bodies.iter().map(|b| 0.5 * self.gases[b.gas].mass * dot(b.v, b.v)).sum()
    }

    /// Ws.
    pub fn spin(&self) -> f64 {
        self.bodies.iter().map(|b| b.spin).sum()
    }

    pub fn momentum(&self) -> Vector {
        self.bodies.iter().fold([0.0; 3], |sum, b| along(sum, b.v, self.gases[b.gas].mass))
    }

    /// Mean normal pressure on the walls since the start (specular walls).
    pub fn wall_pressure(&self) -> f64 {
        let [x, y, z] = self.size;
        self.impulse / (f64::from(self.steps) * self.dt * 2.0 * (x * y + y * z + z * x))
    }

    pub fn step(&mut self) {
        for body in &mut self.bodies {
            body.start = 0.0;
            body.partner = None;
        }
        for k in 0..self.bodies.len() {
            self.bodies[k].wall = self.wall_time(&self.bodies[k]);
        }
        let candidates = self.candidates();
        for round in 0..self.rounds {
            let chosen = choices(&self.bodies, &candidates, self.diameter, self.dt);
            for (time, candidate) in mutual(&chosen) {
                self.settle(candidates[candidate], time, round);
            }
        }
        let chosen = choices(&self.bodies, &candidates, self.diameter, self.dt);
        self.lost += mutual(&chosen).len() as u64;
        self.fly();
        self.steps += 1;
    }

    /// Every pair that may meet: its mid-step points are nearer than sqrt(sigma^2 + (g_max dt/2)^2), with g_max
    /// twice the largest speed in the box (a pair may be given others' velocities in the rounds), of the nearest
    /// image in a periodic box.
    fn candidates(&self) -> Candidates {
        let fastest = self.bodies.iter().map(|b| norm(b.v)).fold(0.0, f64::max);
        let reach2 = self.diameter.powi(2) + (fastest * self.dt).powi(2);
        let middles: Vec<Vector> = self.bodies.iter().map(|b| along(b.x0, b.v, 0.5 * self.dt)).collect();
        let mut pairs = Vec::new();
        for j in 0..middles.len() {
            'pairs: for i in 0..j {
                let d = minus(middles[j], middles[i]);
                let (mut image, mut distance2) = ([0.0; 3], 0.0);
                // Most are too far apart along the first axis.
                for k in 0..3 {
                    if self.boundary == Boundary::Periodic {
                        image[k] = -self.size[k] * (d[k] / self.size[k]).round();
                    }
                    distance2 += (d[k] + image[k]).powi(2);
                    if distance2 >= reach2 {
                        continue 'pairs;
                    }
                }
                pairs.push((i, j, image));
            }
        }
        pairs
    }

    fn settle(&mut self, (i, j, image): (usize, usize, Vector), time: f64, round: u32) {
        let (mut first, mut second) = (self.bodies[i], self.bodies[j]);
        let draws = Draws::of(self.steps, round, [first.id, second.id], self.key);
        let meeting = Meeting { image, time, diameter: self.diameter };
        let virial = collide(&mut first, &mut second, meeting, &self.gases, &draws);
        self.virial = self.virial.max(virial.abs());
        first.partner = Some(second.id);
        second.partner = Some(first.id);
        first.wall = self.wall_time(&first);
        second.wall = self.wall_time(&second);
        self.bodies[i] = first;
        self.bodies[j] = second;
        self.collisions += 1;
    }

    fn wall_time(&self, body: &Body) -> f64 {
        if self.boundary == Boundary::Periodic {
            return f64::INFINITY;
        }
        let times = (0..3).map(|k| {
            let face = if body.v[k] > 0.0 { self.size[k] } else { 0.0 };
            if body.v[k] == 0.0 { f64::INFINITY } else { (face - body.x0[k]) / body.v[k] }
        });
        times.fold(f64::INFINITY, f64::min).max(body.start)
    }

    /// To the end of the step, from each body's start.
    fn fly(&mut self) {
        for body in &mut self.bodies {
            match self.boundary {
                Boundary::Periodic => {
                    let end = along(body.x0, body.v, self.dt);
                    body.x0 = std::array::from_fn(|k| end[k].rem_euclid(self.size[k]));
                }
                Boundary::Specular => {
                    let from = along(body.x0, body.v, body.start);
                    let (x, v, _) = reflect_in_box(from, body.v, self.dt - body.start, [0.0; 3], self.size);
                    let unfolded = along(from, body.v, self.dt - body.start);
                    for ((end, size), speed) in unfolded.into_iter().zip(self.size).zip(body.v.map(f64::abs)) {
                        let hits = (end / size).floor().abs();
                        self.impulse += hits * 2.0 * self.gases[body.gas].mass * speed;
                    }
                    body.x0 = x;
                    body.v = v;
                }
            }
        }
    }
}
