//! How children move: Maxwellian about the mean velocity of their group at its temperature, spin as in equilibrium
//! at its internal temperature; then shifted and scaled so that the group keeps its momentum and energies.
//!
//! All per unit of mass of the heaviest gas, as the device stores spin: so nothing depends on how many moles a particle is, and
//! what is kept is momentum and energy per unit of mass (in all, where each parent has as many children as the others).

use crate::gas::{Draws, Purpose, Species, thermo};
use crate::plan::Plan;
use crate::scene::GAS_CONSTANT;
use crate::simulation::refine::RefineReport;
use crate::simulation::refine::lineage::Lineage;
use crate::simulation::refine::places::Places;
use crate::subdomain::GpuParticle;

/// Parents of a gas in a group, at least, for a state of its own: fewer take that of all.
const LEAST_OF_GAS: usize = 8;
/// That a particle's tag can tell apart.
const MOST_GASES: usize = 16;

/// What particles have together, in masses of the heaviest gas.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
struct Sums {
    number: f64,
    mass: f64,
    momentum: [f64; 3],
    /// About the mean velocity.
    thermal: f64,
    spin: f64,
    spin_dof: f64,
    /// By gas.
    numbers: [f64; MOST_GASES],
}

/// Mean velocity, m/s, and kT over the mass of the heaviest gas, (m/s)^2, of translation and of spin.
#[derive(Debug, Clone, Copy, PartialEq)]
struct LocalState {
    velocity: [f64; 3],
    thermal: f64,
    internal: f64,
}

/// A child before it is stored.
struct Child {
    gas: u8,
    id: u32,
    position: [u32; 3],
    velocity: [f64; 3],
    spin: f64,
}

pub struct Split<'a> {
    plan: &'a Plan,
    places: &'a Places<'a>,
    lineage: &'a Lineage,
    /// Mass over that of the heaviest, and zeta, by gas.
    gases: Vec<(f64, f64)>,
    species: Vec<Species>,
    /// K per (m/s)^2 of kT over the heaviest mass.
    kelvin: f64,
}

impl<'a> Split<'a> {
    /// `plan` is that of the refined run.
    pub fn new(plan: &'a Plan, places: &'a Places<'a>, lineage: &'a Lineage) -> Split<'a> {
        let heaviest = plan.gases.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max);
        let gases = plan.gases.iter().map(|gas| (gas.molar_mass / heaviest, gas.spin_dof)).collect();
        Split { plan, places, lineage, gases, species: plan.species(), kelvin: heaviest / GAS_CONSTANT }
    }

    /// Puts the children of a group of parents where their ids are in `into`.
    pub fn group(&self, parents: &[GpuParticle], group: &[u32], into: &mut [GpuParticle], report: &mut RefineReport) {
        let own: Vec<&GpuParticle> = group.iter().map(|&index| &parents[index as usize]).collect();
        let before = self.sums(own.iter().map(|parent| motion(parent)));
        let states: Vec<LocalState> = (0..self.gases.len()).map(|gas| self.state_of(gas, &own, &before)).collect();
        let mut children = Vec::new();
        for (&index, parent) in group.iter().zip(&own) {
            let gas = parent.gas();
            for &id in self.lineage.children(index as usize, gas) {
                children.push(self.child(parent, id, &states[usize::from(gas)], report));
            }
        }
        self.conserve(&before, &mut children);
        let stored = children.iter().map(Child::stored).inspect(|child| into[child.id() as usize] = *child);
        let stored: Vec<GpuParticle> = stored.collect();
        let after = self.sums(stored.iter().map(motion));
        report.groups += 1;
        report.take_errors(&before, &after);
    }

    fn sums(&self, particles: impl Iterator<Item = (u8, [f64; 3], f64)> + Clone) -> Sums {
        let mut sums = Sums::default();
        for (gas, velocity, spin) in particles.clone() {
            let (mass, spin_dof) = self.gases[usize::from(gas)];
            sums.number += 1.0;
            sums.mass += mass;
            sums.momentum = std::array::from_fn(|axis| sums.momentum[axis] + mass * velocity[axis]);
            sums.spin += spin;
            sums.spin_dof += spin_dof;
            sums.numbers[usize::from(gas)] += 1.0;
        }
        let mean = sums.velocity();
        for (gas, velocity, _) in particles {
            let square: f64 = (0..3).map(|axis| (velocity[axis] - mean[axis]).powi(2)).sum();
            sums.thermal += 0.5 * self.gases[usize::from(gas)].0 * square;
        }
        sums
    }

    /// That of its own particles if there are enough, else of all.
    fn state_of(&self, gas: usize, group: &[&GpuParticle], all: &Sums) -> LocalState {
        let of_gas = group.iter().filter(|parent| usize::from(parent.gas()) == gas).map(|parent| motion(parent));
        let own = self.sums(of_gas);
        self.state(if own.number >= LEAST_OF_GAS as f64 { &own } else { all })
    }

    /// A mean of N takes three of the 3 N degrees of freedom.
    fn state(&self, sums: &Sums) -> LocalState {
        let per = |energy: f64, dof: f64| if dof > 0.0 { 2.0 * energy / dof } else { 0.0 };
        let thermal = per(sums.thermal, 3.0 * (sums.number - 1.0));
        let internal = if self.species.iter().all(Species::is_constant) {
            per(sums.spin, sums.spin_dof)
        } else {
            self.internal(sums)
        };
        LocalState { velocity: sums.velocity(), thermal, internal }
    }

    /// kT over the heaviest mass at which particles of these gases have this spin energy.
    fn internal(&self, sums: &Sums) -> f64 {
        let wanted = sums.spin * self.kelvin;
        let present = || self.species.iter().zip(&sums.numbers);
        let excess = |t: f64| present().map(|(gas, n)| 0.5 * n * gas.spin_energy_dof(t) * t).sum::<f64>() - wanted;
        let slope = |t: f64| present().map(|(gas, n)| 0.5 * n * gas.spin_dof(t)).sum::<f64>();
        let mut highest = 1.0;
        // Above all that a gas can be; none of them may have internal energy.
        while excess(highest) < 0.0 && highest < 1e9 {
            highest *= 2.0;
        }
        if wanted > 0.0 && highest < 1e9 { thermo::root(excess, slope, highest) / self.kelvin } else { 0.0 }
    }

    fn child(&self, parent: &GpuParticle, id: u32, local: &LocalState, report: &mut RefineReport) -> Child {
        let gas = parent.gas();
        let (mass, species) = (self.gases[usize::from(gas)].0, &self.species[usize::from(gas)]);
        let grid = &self.plan.grid;
        let sampled = self.places.draw(parent, self.plan.seed, id).and_then(|place| grid.to_fixed(place));
        let position = sampled.unwrap_or_else(|| {
            report.at_parent += 1;
            // Both grids lie around the same walls.
            grid.to_fixed(self.places.metres(parent)).unwrap_or_default()
        });
        let mut draws = Draws::new(self.plan.seed, Purpose::RefinedState, id);
        let speed = (local.thermal / mass).sqrt();
        let velocity = local.velocity.map(|mean| mean + speed * draws.normal());
        Child {
            gas,
            id,
            position,
            velocity,
            spin: species.draw_spin(local.internal, local.internal * self.kelvin, &mut draws),
        }
    }

    /// Gives children the momentum, kinetic and spin energy per mass of their parents.
    fn conserve(&self, before: &Sums, children: &mut [Child]) {
        let sampled = self.sums(children.iter().map(|child| (child.gas, child.velocity, child.spin)));
        let per_mass = sampled.mass / before.mass;
        let ratio = |wanted: f64, found: f64| if found > 0.0 { per_mass * wanted / found } else { 0.0 };
        let (faster, spin) = (ratio(before.thermal, sampled.thermal).sqrt(), ratio(before.spin, sampled.spin));
        let (mean, found) = (before.velocity(), sampled.velocity());
        for child in children {
            child.velocity = std::array::from_fn(|axis| mean[axis] + faster * (child.velocity[axis] - found[axis]));
            child.spin *= spin;
        }
    }
}

impl Sums {
    fn velocity(&self) -> [f64; 3] {
        self.momentum.map(|momentum| if self.mass > 0.0 { momentum / self.mass } else { 0.0 })
    }

    fn energy(&self) -> f64 {
        let bulk: f64 = self.velocity().iter().map(|v| v * v).sum();
        0.5 * self.mass * bulk + self.thermal + self.spin
    }
}

impl Child {
    fn stored(&self) -> GpuParticle {
        GpuParticle {
            position: self.position,
            tag: GpuParticle::tag(self.gas, self.id),
            velocity: self.velocity.map(|v| v as f32),
            spin: self.spin as f32,
        }
    }
}

impl RefineReport {
    fn take_errors(&mut self, before: &Sums, after: &Sums) {
        if after.mass <= 0.0 || before.energy() <= 0.0 {
            return;
        }
        let per_mass = after.mass / before.mass;
        let scale = (2.0 * before.mass * before.energy()).sqrt();
        for axis in 0..3 {
            let error = (after.momentum[axis] / per_mass - before.momentum[axis]).abs() / scale;
            self.momentum_error = self.momentum_error.max(error);
        }
        let error = (after.energy() / per_mass / before.energy() - 1.0).abs();
        self.energy_error = self.energy_error.max(error);
    }
}

/// Gas, velocity and spin energy.
fn motion(particle: &GpuParticle) -> (u8, [f64; 3], f64) {
    (particle.gas(), particle.velocity.map(f64::from), f64::from(particle.spin))
}
