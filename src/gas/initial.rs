//! The gas at rest at the start of a run.
//!
//! Positions are uniform in each chamber (drawn in a box around it, or in the bag that it is the inside of, and rejected
//! where they are not of its gas); velocities Maxwell, spin energy
//! Gamma(zeta/2) kT (method.md, "The gas") or as its modes have it ([`Species`]). Then each chamber is made exact: its total momentum is
//! shifted to zero and its translational energy scaled to 3/2 N kT by one factor for all its gases (several
//! factors would bring the momentum back), and the spin energy of each gas to its mean. A chamber with a
//! single particle keeps its momentum: it could not have the energy otherwise.
//!
//! Invariants: ids are 0.. in the order chamber, gas, particle; each particle's draws depend on its id only. So any part
//! of the gas can be sampled without the rest, once what makes each chamber exact is known, and has the same bits.

use std::ops::Range;

use super::{Draws, Particle, Purpose, Species};
use crate::scene::GAS_CONSTANT;

/// One chamber to be filled.
pub struct Filling<'a> {
    /// Particles of each gas.
    pub counts: &'a [u64],
    /// K.
    pub temperature: f64,
    pub space: Space<'a>,
    /// Whether a point belongs to the chamber (asked before `is_gas`, which may be dearer).
    pub in_chamber: &'a dyn Fn([f64; 3]) -> bool,
}

/// What contains a chamber, in which places are drawn; the tighter, the fewer tries.
#[derive(Clone, Copy)]
pub enum Space<'a> {
    /// m.
    Box { min: [f64; 3], max: [f64; 3] },
    /// The uniform point of it for four numbers between 0 and 1, m.
    Solid(&'a dyn Fn([f64; 4]) -> [f64; 3]),
}

impl Space<'_> {
    fn point(&self, draws: &mut Draws) -> [f64; 3] {
        match self {
            Space::Box { min, max } => {
                std::array::from_fn(|axis| min[axis] + (max[axis] - min[axis]) * draws.uniform())
            }
            Space::Solid(point) => point(std::array::from_fn(|_| draws.uniform())),
        }
    }
}

/// Tries per particle before a chamber is taken for empty.
const MOST_TRIES: u32 = 100_000;

#[derive(Debug, Clone, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum FillError {
    #[error("no gas found in chamber {chamber} (counted from 0) after {tries} random points")]
    #[diagnostic(help(
        "its region must overlap the gas space by a fair part of its bounding box; look at the walls around it"
    ))]
    NoRoom { chamber: usize, tries: u32 },
    #[error("the initial gas has more particles than a 32-bit id can name")]
    TooMany,
}

/// The gas of all chambers, SI.
pub struct InitialGas<'a> {
    pub chambers: &'a [Filling<'a>],
    /// Their molar masses, and how they take up energy.
    pub gases: &'a [Species],
    /// Whether a point is in the gas space.
    pub is_gas: &'a dyn Fn([f64; 3]) -> bool,
    pub moles_per_particle: f64,
    pub seed: u64,
}

/// What makes a chamber exact, the same for all its particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Correction {
    drift: [f64; 3],
    speed_factor: f64,
    /// By gas.
    spin_factors: Vec<f64>,
}

/// What is sampled of a particle but its place.
#[derive(Debug, Clone, Copy)]
struct Motion {
    gas: u8,
    velocity: [f64; 3],
    spin_energy: f64,
}

/// Particles of one gas in one chamber.
struct Batch {
    chamber: usize,
    gas: u8,
    ids: Range<u32>,
}

impl InitialGas<'_> {
    /// All particles.
    ///
    /// # Errors
    /// If a chamber has no room, or ids do not suffice.
    pub fn all(&self) -> Result<Vec<Particle>, FillError> {
        let mut particles: Vec<Particle> = Vec::new();
        let batches = self.batches()?;
        for of_chamber in batches.chunk_by(|a, b| a.chamber == b.chamber) {
            let first = particles.len();
            for batch in of_chamber {
                for id in batch.ids.clone() {
                    particles.push(self.draw(batch, id)?);
                }
            }
            let own = &mut particles[first..];
            let motion = |p: &Particle| Motion { gas: p.gas, velocity: p.velocity, spin_energy: p.spin_energy };
            let correction = self.correction(of_chamber[0].chamber, || own.iter().map(motion));
            own.iter_mut().for_each(|particle| correction.apply(particle));
        }
        Ok(particles)
    }

    /// Finds a place for the first particle of each gas in each chamber: where there is one, the others find theirs too.
    ///
    /// # Errors
    /// As [`InitialGas::all`].
    pub fn find_room(&self) -> Result<(), FillError> {
        self.batches()?.iter().try_for_each(|batch| self.draw(batch, batch.ids.start).map(|_| ()))
    }

    /// What makes each chamber exact: draws how all of its particles move, twice, and keeps none.
    ///
    /// # Errors
    /// If ids do not suffice.
    pub fn corrections(&self) -> Result<Vec<Correction>, FillError> {
        let batches = self.batches()?;
        let of_chamber = |chamber: usize| {
            let own = || batches.iter().filter(move |batch| batch.chamber == chamber);
            let draw = |batch: &'_ Batch| (batch.gas, batch.ids.clone());
            let motions = || own().map(draw).flat_map(|(gas, ids)| ids.map(move |id| self.motion(chamber, gas, id)));
            self.correction(chamber, motions)
        };
        Ok((0..self.chambers.len()).map(of_chamber).collect())
    }

    /// The particles with these ids, by id, one after the other.
    ///
    /// # Errors
    /// As [`InitialGas::all`].
    pub fn part(
        &self,
        corrections: &[Correction],
        ids: Range<u32>,
    ) -> Result<impl Iterator<Item = Result<Particle, FillError>>, FillError> {
        let wanted = move |batch: Batch| {
            let own = batch.ids.start.max(ids.start)..batch.ids.end.min(ids.end);
            own.map(move |id| {
                let mut particle = self.draw(&batch, id)?;
                corrections[batch.chamber].apply(&mut particle);
                Ok(particle)
            })
        };
        Ok(self.batches()?.into_iter().flat_map(wanted))
    }

    /// In the order of ids.
    fn batches(&self) -> Result<Vec<Batch>, FillError> {
        let mut batches = Vec::new();
        let mut next = 0_u32;
        for (chamber, filling) in self.chambers.iter().enumerate() {
            for (gas, &count) in filling.counts.iter().take(self.gases.len()).enumerate() {
                let end = u32::try_from(count).ok().and_then(|count| next.checked_add(count));
                let end = end.ok_or(FillError::TooMany)?;
                batches.push(Batch { chamber, gas: gas as u8, ids: next..end });
                next = end;
            }
        }
        Ok(batches)
    }

    /// A particle of a chamber that is not exact yet.
    fn draw(&self, batch: &Batch, id: u32) -> Result<Particle, FillError> {
        let chamber = batch.chamber;
        let place = place(&self.chambers[chamber], self.is_gas, self.seed, id);
        let position = place.ok_or(FillError::NoRoom { chamber, tries: MOST_TRIES })?;
        let Motion { gas, velocity, spin_energy } = self.motion(chamber, batch.gas, id);
        Ok(Particle { id, gas, position, velocity, spin_energy })
    }

    fn motion(&self, chamber: usize, gas: u8, id: u32) -> Motion {
        let (species, temperature) = (&self.gases[usize::from(gas)], self.chambers[chamber].temperature);
        let thermal_energy = self.moles_per_particle * GAS_CONSTANT * temperature;
        let thermal_speed = (thermal_energy / (species.molar_mass * self.moles_per_particle)).sqrt();
        let mut draws = Draws::new(self.seed, Purpose::InitialState, id);
        let velocity = [(); 3].map(|()| thermal_speed * draws.normal());
        let spin_energy = species.draw_spin(thermal_energy, temperature, &mut draws);
        Motion { gas, velocity, spin_energy }
    }

    /// From the motions of all of a chamber, by id: sums depend on the order.
    fn correction<I: Iterator<Item = Motion>>(&self, chamber: usize, motions: impl Fn() -> I) -> Correction {
        let drift = self.drift(motions());
        let temperature = self.chambers[chamber].temperature;
        let thermal_energy = self.moles_per_particle * GAS_CONSTANT * temperature;
        let mut translational = 0.0;
        let mut spin = vec![0.0; self.gases.len()];
        let mut count = vec![0_u64; self.gases.len()];
        for motion in motions() {
            let gas = usize::from(motion.gas);
            let mass = self.gases[gas].molar_mass * self.moles_per_particle;
            let speeds: [f64; 3] = std::array::from_fn(|axis| motion.velocity[axis] - drift[axis]);
            translational += 0.5 * mass * speeds.iter().map(|v| v * v).sum::<f64>();
            spin[gas] += motion.spin_energy;
            count[gas] += 1;
        }
        let ratio = |wanted: f64, found: f64| if found > 0.0 { wanted / found } else { 0.0 };
        let spin_factor = |(gas, species): (usize, &Species)| {
            let wanted = 0.5 * species.spin_energy_dof(temperature) * count[gas] as f64 * thermal_energy;
            ratio(wanted, spin[gas])
        };
        let number = count.iter().sum::<u64>() as f64;
        Correction {
            drift,
            speed_factor: ratio(1.5 * number * thermal_energy, translational).sqrt(),
            spin_factors: self.gases.iter().enumerate().map(spin_factor).collect(),
        }
    }

    /// The velocity of the centre of mass; none of a particle alone.
    fn drift(&self, motions: impl Iterator<Item = Motion>) -> [f64; 3] {
        let (mut number, mut mass, mut momentum) = (0_u64, 0.0, [0.0; 3]);
        for motion in motions {
            let own = self.gases[usize::from(motion.gas)].molar_mass;
            number += 1;
            mass += own;
            for (sum, speed) in momentum.iter_mut().zip(motion.velocity) {
                *sum += own * speed;
            }
        }
        if number < 2 { [0.0; 3] } else { momentum.map(|sum| sum / mass) }
    }
}

impl Correction {
    fn apply(&self, particle: &mut Particle) {
        for (speed, drift) in particle.velocity.iter_mut().zip(self.drift) {
            *speed = (*speed - drift) * self.speed_factor;
        }
        particle.spin_energy *= self.spin_factors[usize::from(particle.gas)];
    }
}

/// A uniform point of the chamber's gas.
fn place(chamber: &Filling, is_gas: &dyn Fn([f64; 3]) -> bool, seed: u64, id: u32) -> Option<[f64; 3]> {
    let mut draws = Draws::new(seed, Purpose::InitialPosition, id);
    for _ in 0..MOST_TRIES {
        let point = chamber.space.point(&mut draws);
        if (chamber.in_chamber)(point) && is_gas(point) {
            return Some(point);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gases() -> Vec<Species> {
        let gas = |molar_mass, spin: f64| Species::constant(molar_mass, 0.5 * (3.0 + spin) * GAS_CONSTANT);
        vec![gas(0.028, 2.0), gas(0.004, 0.0)]
    }

    fn left(point: [f64; 3]) -> bool {
        point[0] < 0.5
    }

    fn right(point: [f64; 3]) -> bool {
        !left(point)
    }

    fn filled(counts: [&[u64]; 2]) -> Result<Vec<Particle>, FillError> {
        let chamber = |counts, temperature, in_chamber| Filling {
            counts,
            temperature,
            space: Space::Box { min: [0.0; 3], max: [1.0, 1.0, 2.0] },
            in_chamber,
        };
        let chambers = [chamber(counts[0], 300.0, &left as _), chamber(counts[1], 600.0, &right as _)];
        gas(&chambers, &gases(), &|p| p[2] > 1.0).all()
    }

    fn gas<'a>(
        chambers: &'a [Filling<'a>],
        gases: &'a [Species],
        is_gas: &'a dyn Fn([f64; 3]) -> bool,
    ) -> InitialGas<'a> {
        InitialGas { chambers, gases, is_gas, moles_per_particle: 1e-6, seed: 3 }
    }

    /// Whatever the parts, they are those of the whole to the last bit; without what makes it exact they are not.
    #[test]
    fn any_part_is_as_it_is_in_the_whole() {
        let chamber = |counts, temperature, in_chamber| Filling {
            counts,
            temperature,
            space: Space::Box { min: [0.0; 3], max: [1.0, 1.0, 2.0] },
            in_chamber,
        };
        let counts: [&[u64]; 3] = [&[300, 50], &[0, 1], &[0, 70]];
        let chambers = [
            chamber(counts[0], 300.0, &left as _),
            chamber(counts[1], 450.0, &left as _),
            chamber(counts[2], 600.0, &right as _),
        ];
        let (gases, anywhere) = (gases(), |_: [f64; 3]| true);
        let gas = gas(&chambers, &gases, &anywhere);
        let (all, corrections) = (gas.all().unwrap(), gas.corrections().unwrap());
        for size in [1, 7, 50, 1000] {
            let starts = (0..all.len() as u32).step_by(size);
            let parts = starts.flat_map(|start| gas.part(&corrections, start..start + size as u32).unwrap());
            assert!(parts.collect::<Result<Vec<_>, _>>().unwrap() == all, "parts of {size}");
        }
        let inexact = vec![Correction { drift: [0.0; 3], speed_factor: 1.0, spin_factors: vec![1.0; 2] }; 3];
        let parts = gas.part(&inexact, 0..u32::MAX).unwrap();
        assert!(parts.collect::<Result<Vec<_>, _>>().unwrap() != all);
    }

    /// (momentum per particle over m c0, translational energy over 3/2 N kT, spin over zeta/2 N kT).
    fn figures(particles: &[Particle], temperature: f64) -> (f64, f64, f64) {
        let kt = 1e-6 * GAS_CONSTANT * temperature;
        let (mut p, mut translational, mut spin, mut spin_wanted) = ([0.0; 3], 0.0, 0.0, 0.0);
        for particle in particles {
            let gas = &gases()[usize::from(particle.gas)];
            let mass = gas.molar_mass * 1e-6;
            for (sum, speed) in p.iter_mut().zip(particle.velocity) {
                *sum += mass * speed;
                translational += 0.5 * mass * speed * speed;
            }
            spin += particle.spin_energy;
            spin_wanted += 0.5 * gas.spin_dof(temperature) * kt;
        }
        let n = particles.len() as f64;
        let scale = n * (kt * 0.028e-6).sqrt();
        (p.iter().map(|p| p.abs()).fold(0.0, f64::max) / scale, translational / (1.5 * n * kt), spin / spin_wanted)
    }

    #[test]
    fn chambers_are_at_rest_with_exact_energy() {
        let particles = filled([&[3000, 500], &[100, 0]]).unwrap();
        assert!(particles.iter().enumerate().all(|(i, p)| p.id as usize == i));
        let (a, b) = particles.split_at(3500);
        assert!(a.iter().all(|p| left(p.position) && p.position[2] > 1.0));
        assert!(b.iter().all(|p| right(p.position) && p.gas == 0));
        for (part, temperature) in [(a, 300.0), (b, 600.0)] {
            let (momentum, translational, spin) = figures(part, temperature);
            assert!(momentum < 1e-15, "{momentum}");
            assert!((translational - 1.0).abs() < 1e-12 && (spin - 1.0).abs() < 1e-12);
        }
        // The check can fail: half of a chamber is not exact.
        let (momentum, translational, _) = figures(&a[..1000], 300.0);
        assert!(momentum > 1e-4 && (translational - 1.0).abs() > 1e-6);
    }

    /// Speeds of one component are normal: kurtosis 3, within 5 standard errors sqrt(24/N).
    #[test]
    fn velocities_are_maxwellian() {
        let particles = filled([&[20_000, 0], &[0, 0]]).unwrap();
        let moment = |power: i32| particles.iter().map(|p| p.velocity[0].powi(power)).sum::<f64>() / 20_000.0;
        let kurtosis = moment(4) / moment(2).powi(2);
        assert!((kurtosis - 3.0).abs() < 5.0 * (24.0f64 / 20_000.0).sqrt(), "{kurtosis}");
        let flat = 9.0 / 5.0;
        assert!((flat - 3.0f64).abs() > 5.0 * (24.0f64 / 20_000.0).sqrt());
    }

    #[test]
    fn a_single_particle_has_its_energy() {
        let particles = filled([&[1, 0], &[0, 1]]).unwrap();
        let (_, translational, spin) = figures(&particles[..1], 300.0);
        assert!((translational - 1.0).abs() < 1e-12 && (spin - 1.0).abs() < 1e-12);
        assert_eq!(particles[1].spin_energy, 0.0);
    }

    #[test]
    fn a_chamber_without_gas_space_is_an_error() {
        let nowhere = |_: [f64; 3]| false;
        let chamber = Filling {
            counts: &[1, 0],
            temperature: 300.0,
            space: Space::Box { min: [0.0; 3], max: [1.0; 3] },
            in_chamber: &nowhere,
        };
        let (chambers, gases) = ([chamber], gases());
        let gas = gas(&chambers, &gases, &|_| true);
        assert_eq!(gas.all(), Err(FillError::NoRoom { chamber: 0, tries: MOST_TRIES }));
        assert_eq!(gas.find_room(), gas.all().map(|_| ()));
    }
}
