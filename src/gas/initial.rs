//! The gas at rest at the start of a run.
//!
//! Positions are uniform in each chamber (rejection from its bounding box); velocities Maxwell, spin energy
//! Gamma(zeta/2) kT (specification, section 1) or as its modes have it ([`Species`]). Then each chamber is made exact: its total momentum is
//! shifted to zero and its translational energy scaled to 3/2 N kT by one factor for all its gases (several
//! factors would bring the momentum back), and the spin energy of each gas to its mean. A chamber with a
//! single particle keeps its momentum: it could not have the energy otherwise.
//!
//! Invariants: ids are 0.. in the order chamber, gas, particle; each particle's draws depend on its id only.

use super::{Draws, Particle, Purpose, Species};
use crate::scene::GAS_CONSTANT;

/// One chamber to be filled.
pub struct Filling<'a> {
    /// Particles of each gas.
    pub counts: &'a [u64],
    /// K.
    pub temperature: f64,
    /// A box that contains the chamber, m; the tighter, the fewer tries.
    pub min: [f64; 3],
    pub max: [f64; 3],
    /// Whether a point belongs to the chamber (asked before `is_gas`, which may be dearer).
    pub in_chamber: &'a dyn Fn([f64; 3]) -> bool,
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

/// All particles of the chambers, SI. `gases` gives the molar masses, `is_gas` whether a point is in the
/// gas space.
pub fn fill(
    chambers: &[Filling],
    gases: &[Species],
    is_gas: &dyn Fn([f64; 3]) -> bool,
    moles_per_particle: f64,
    seed: u64,
) -> Result<Vec<Particle>, FillError> {
    let mut particles: Vec<Particle> = Vec::new();
    for (index, chamber) in chambers.iter().enumerate() {
        let first = particles.len();
        for (gas, (&count, species)) in chamber.counts.iter().zip(gases).enumerate() {
            let thermal_energy = moles_per_particle * GAS_CONSTANT * chamber.temperature;
            let thermal_speed = (thermal_energy / (species.molar_mass * moles_per_particle)).sqrt();
            for _ in 0..count {
                let id = u32::try_from(particles.len()).map_err(|_| FillError::TooMany)?;
                let position =
                    place(chamber, is_gas, seed, id).ok_or(FillError::NoRoom { chamber: index, tries: MOST_TRIES })?;
                let mut draws = Draws::new(seed, Purpose::InitialState, id);
                let velocity = [(); 3].map(|()| thermal_speed * draws.normal());
                let spin_energy = species.draw_spin(thermal_energy, chamber.temperature, &mut draws);
                particles.push(Particle { id, gas: gas as u8, position, velocity, spin_energy });
            }
        }
        let own = &mut particles[first..];
        stop_drift(own, gases);
        make_energy_exact(own, gases, moles_per_particle, chamber.temperature);
    }
    Ok(particles)
}

/// A uniform point of the chamber's gas.
fn place(chamber: &Filling, is_gas: &dyn Fn([f64; 3]) -> bool, seed: u64, id: u32) -> Option<[f64; 3]> {
    let mut draws = Draws::new(seed, Purpose::InitialPosition, id);
    for _ in 0..MOST_TRIES {
        let point: [f64; 3] =
            std::array::from_fn(|axis| chamber.min[axis] + (chamber.max[axis] - chamber.min[axis]) * draws.uniform());
        if (chamber.in_chamber)(point) && is_gas(point) {
            return Some(point);
        }
    }
    None
}

/// Subtracts the velocity of the centre of mass.
fn stop_drift(particles: &mut [Particle], gases: &[Species]) {
    if particles.len() < 2 {
        return;
    }
    let mut mass = 0.0;
    let mut momentum = [0.0; 3];
    for particle in &*particles {
        let own = gases[usize::from(particle.gas)].molar_mass;
        mass += own;
        for (sum, speed) in momentum.iter_mut().zip(particle.velocity) {
            *sum += own * speed;
        }
    }
    for particle in particles {
        for (speed, sum) in particle.velocity.iter_mut().zip(momentum) {
            *speed -= sum / mass;
        }
    }
}

fn make_energy_exact(particles: &mut [Particle], gases: &[Species], moles_per_particle: f64, temperature: f64) {
    let thermal_energy = moles_per_particle * GAS_CONSTANT * temperature;
    let mut translational = 0.0;
    let mut spin = vec![0.0; gases.len()];
    let mut count = vec![0u64; gases.len()];
    for particle in &*particles {
        let gas = usize::from(particle.gas);
        let mass = gases[gas].molar_mass * moles_per_particle;
        translational += 0.5 * mass * particle.velocity.iter().map(|v| v * v).sum::<f64>();
        spin[gas] += particle.spin_energy;
        count[gas] += 1;
    }
    let ratio = |wanted: f64, found: f64| if found > 0.0 { wanted / found } else { 0.0 };
    let speed_factor = ratio(1.5 * particles.len() as f64 * thermal_energy, translational).sqrt();
    for particle in particles {
        let gas = usize::from(particle.gas);
        particle.velocity = particle.velocity.map(|v| v * speed_factor);
        let wanted = 0.5 * gases[gas].spin_energy_dof(temperature) * count[gas] as f64 * thermal_energy;
        particle.spin_energy *= ratio(wanted, spin[gas]);
    }
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
            min: [0.0; 3],
            max: [1.0, 1.0, 2.0],
            in_chamber,
        };
        let chambers = [chamber(counts[0], 300.0, &left as _), chamber(counts[1], 600.0, &right as _)];
        fill(&chambers, &gases(), &|p| p[2] > 1.0, 1e-6, 3)
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
        let chamber =
            Filling { counts: &[1, 0], temperature: 300.0, min: [0.0; 3], max: [1.0; 3], in_chamber: &nowhere };
        let found = fill(&[chamber], &gases(), &|_| true, 1e-6, 3);
        assert_eq!(found, Err(FillError::NoRoom { chamber: 0, tries: MOST_TRIES }));
    }
}
