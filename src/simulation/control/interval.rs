//! One interval of steps: what it needs to run, and to run again. Its step size is fixed, its newborns are
//! known, and its tallies are read one interval late.

use std::cmp::Ordering;

use crate::gas::{Inflow, Newborn};
use crate::plan::Plan;
use crate::subdomain::{GpuNewborn, GpuParticle, Newborns, Scales, StateError, Tables, Tallies};

/// The steps of an interval.
#[derive(Debug, Clone, Copy)]
pub struct Span {
    /// s.
    pub start: f64,
    pub end: f64,
    pub first_step: u64,
    pub steps: u32,
}

/// An interval as it was decided.
pub struct Interval {
    /// s.
    pub start: f64,
    pub dt: f64,
    pub first_step: u64,
    pub steps: u32,
    /// Whether each step adds to the zones.
    pub tallied: Vec<bool>,
    /// Newborns of each step, on this rank and on all.
    pub newborns_of: Vec<u32>,
    pub entering: Vec<u32>,
    pub newborns: Vec<GpuNewborn>,
    /// Id of the first newborn on this rank, and the distance of two.
    pub first_id: u32,
    pub stride: u32,
    /// Momentum that the newborns bring, kg m/s.
    pub momentum: [f64; 3],
    /// Energy that the newborns of each step bring, J.
    pub energy: Vec<f64>,
    /// Particles that have entered by its end, on all ranks, the initial ones with them.
    pub particles: u64,
    /// What the host tells the device of it.
    pub tables: Tables,
    /// The mean volumes of its tallied steps where walls move, m3: of the chambers, then the probes.
    pub volumes: Vec<f64>,
    /// If it goes on where the device had stalled: how many of its first steps are done, and what they tallied.
    pub done: Option<(u32, Box<Tallies>)>,
}

impl Interval {
    /// Takes the newborns of the interval from the inflow; `inside` tells of orifices whether they are inside of closed fabric.
    pub fn new(
        plan: &Plan,
        inflow: &mut Inflow,
        span: &Span,
        deal: Deal,
        inside: &[bool],
    ) -> Result<Interval, StateError> {
        let &Span { start, end, first_step, steps } = span;
        let dt = (end - start) / f64::from(steps);
        let scales = Scales::new(plan);
        let born: Vec<Newborn> = inflow.take_until(end);
        let mut interval = Interval {
            start,
            dt,
            first_step,
            steps,
            tallied: about_the_middle(steps, plan.tally_every),
            newborns_of: vec![0; steps as usize],
            entering: vec![0; steps as usize],
            newborns: Vec::with_capacity(born.len()),
            first_id: born.first().map_or(0, |newborn| newborn.particle.id),
            stride: 1,
            momentum: [0.0; 3],
            energy: vec![0.0; steps as usize],
            tables: Tables::default(),
            volumes: Vec::new(),
            done: None,
            particles: plan.initial_particles + inflow.entered_by_gas().iter().sum::<u64>(),
        };
        if let Deal::ById { rank, ranks } = deal {
            interval.stride = ranks;
            interval.first_id += (rank + ranks - interval.first_id % ranks) % ranks;
        }
        for newborn in &born {
            let k = (((newborn.time - start) / dt) as usize).min(steps as usize - 1);
            let late = (newborn.time - start - k as f64 * dt).clamp(0.0, dt);
            interval.entering[k] += 1;
            let mut on_device = GpuNewborn::from_host(&newborn.particle, late, &plan.grid, &scales)?;
            if inside.get(newborn.orifice).is_some_and(|&inside| inside) {
                on_device.particle.tag |= GpuParticle::INSIDE;
            }
            let particle = &on_device.particle;
            let mass = plan.gases[usize::from(newborn.particle.gas)].molar_mass * plan.moles_per_particle;
            let mut speed2 = 0.0;
            for (total, v) in interval.momentum.iter_mut().zip(particle.velocity) {
                *total += mass * f64::from(v);
                speed2 += f64::from(v) * f64::from(v);
            }
            interval.energy[k] += 0.5 * mass * speed2 + scales.reference_mass * f64::from(particle.spin);
            if deal.takes(newborn.particle.id) {
                interval.newborns_of[k] += 1;
                interval.newborns.push(on_device);
            }
        }
        Ok(interval)
    }

    /// Those who enter in it.
    pub fn entering(&self) -> Newborns<'_> {
        Newborns { of_step: &self.newborns_of, list: &self.newborns, first_id: self.first_id, stride: self.stride }
    }

    /// The times at which its tallies of the zones are taken, s, of an interval that starts at `start`.
    pub fn tallied_at(&self, start: f64) -> impl Iterator<Item = f64> {
        (1u32..).zip(&self.tallied).filter(|(_, tallied)| **tallied).map(move |(k, _)| start + f64::from(k) * self.dt)
    }

    /// How many of its steps add to the zones.
    pub fn samples(&self) -> u32 {
        self.tallied.iter().map(|&tallied| u32::from(tallied)).sum()
    }

    /// The energy that the newborns had brought since its start, J, summed over the steps that add to the zones;
    /// and all that they brought.
    pub fn energy_tallied(&self) -> (f64, f64) {
        let (mut brought, mut summed) = (0.0, 0.0);
        for (energy, &tallied) in self.energy.iter().zip(&self.tallied) {
            brought += energy;
            if tallied {
                summed += brought;
            }
        }
        (summed, brought)
    }
}

/// To whom the newborns go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Deal {
    /// Every rank looks at all of them.
    All,
    /// By id: this rank of so many.
    ById { rank: u32, ranks: u32 },
}

impl Deal {
    fn takes(self, id: u32) -> bool {
        match self {
            Deal::All => true,
            Deal::ById { rank, ranks } => id % ranks == rank,
        }
    }
}

/// Which of so many steps add to the zones, at their end: one in `every`, at least one, and so that the mean of their times is the
/// middle of the interval, as it is of what walls and vents tally in every step. (Of a single step it is its end.) One in 0 is none.
fn about_the_middle(steps: u32, every: u32) -> Vec<bool> {
    if every <= 1 {
        return vec![every == 1; steps as usize];
    }
    let mut tallied = vec![false; steps as usize];
    let count = ((steps + every / 2) / every).min(steps / 2).max(1);
    for k in 0..count {
        // The middle of the k-th of as many equal parts, rounded towards the ends; that of all is the middle one's.
        let (place, parts) = (steps * (2 * k + 1), 2 * count);
        let (before, after) = (place / parts, place.div_ceil(parts));
        let ends = match (2 * k + 1).cmp(&count) {
            Ordering::Less => [before; 2],
            Ordering::Equal => [before, after],
            Ordering::Greater => [after; 2],
        };
        for end in ends.into_iter().filter(|&end| end > 0) {
            tallied[end as usize - 1] = true;
        }
    }
    tallied
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The times of the tallies of the zones have the middle of the interval as their mean, whatever its length, and are as
    /// many as asked.
    #[test]
    fn tallies_lie_about_the_middle() {
        let of = |steps: u32, every: u32| -> Vec<u32> {
            let tallied = about_the_middle(steps, every);
            assert_eq!(tallied.len(), steps as usize);
            (1..=steps).filter(|&k| tallied[k as usize - 1]).collect()
        };
        assert_eq!(of(32, 8), [4, 12, 20, 28]);
        assert_eq!(of(16, 8), [4, 12]);
        assert_eq!(of(5, 8), [2, 3]);
        assert_eq!(of(1, 8), [1]);
        assert_eq!(of(4, 1), [1, 2, 3, 4], "every one, whose mean is half a step late");
        assert_eq!(of(4, 0), [0; 0]);
        for every in 2..=8 {
            for steps in 2..=70 {
                let found = of(steps, every);
                let mean = f64::from(found.iter().sum::<u32>()) / found.len() as f64;
                assert!((mean - 0.5 * f64::from(steps)).abs() < 1e-9, "{steps}, {every}: {found:?}");
                let wanted = f64::from(steps) / f64::from(every);
                assert!((found.len() as f64 - wanted).abs() < 2.0, "{steps}, {every}: {found:?}");
            }
        }
    }
}
