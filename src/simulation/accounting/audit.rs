//! The account of a run: what entered, what is there, what was lost.
//!
//! It starts at time 0, or, of a refined state, at the moment of the refinement: then what had entered `before` counts as
//! there from the start.

use serde::{Deserialize, Serialize};

use super::averages::Averages;
use crate::gas::Inflow;
use crate::geometry::{Bag, Vessel};
use crate::output::{Audit, AuditLimits, CaughtFlights, CollisionCells, FabricAccount, PassedParticles, PhaseTable};
use crate::plan::Plan;
use crate::scene::Method;
use crate::simulation::accounting::phases::{once_an_interval, order_of};
use crate::simulation::control::interval::Interval;
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::control::surface_states::SurfaceStates;
use crate::simulation::model::build::Model;
use crate::subdomain::{GpuParticle, Scales, Tallies, Walls};

/// The same limit as that of the audit at the end.
const ENERGY_ERROR: f64 = 1e-4;

pub struct Account {
    scales: Scales,
    molar_masses: Vec<f64>,
    moles_per_particle: f64,
    counted: AccountState,
}

/// What there is at the end of a run.
pub struct AtEnd<'a> {
    /// Of all particles, and of nothing else.
    pub tallies: &'a Tallies,
    pub inflow: &'a Inflow,
    /// Particles that were found in no gas.
    pub outside: u64,
    /// Of elastic fabric, if there is any, but for what it has from the gas.
    pub fabric: Option<FabricAccount>,
    pub averages: &'a Averages,
    pub surface_states: &'a SurfaceStates<'a>,
}

/// Totals of all gas, SI.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct State {
    number: u64,
    mass: f64,
    momentum: [f64; 3],
    energy: f64,
}

/// What orifices had brought before the account started, SI.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Entered {
    number: u64,
    mass: f64,
    energy: f64,
}

/// All that an account has counted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AccountState {
    start: State,
    before: Entered,
    injected_momentum: [f64; 3],
    /// By the newborns of the intervals read, J.
    energy_entered: f64,
    pub particles: u64,
    /// The particles of each step, summed.
    pub particle_steps: u64,
    pub collisions: u64,
    pub bounces: u64,
    pub step_range: [f64; 2],
    steps: u64,
    lost: u64,
    sampled: u64,
    truncated: u64,
    caught: u64,
    /// With the method `half-turn`: particles that flew on alone, that collided without a velocity gradient, and groups that walls made.
    free_flights: u64,
    unfitted: u64,
    cut_groups: u64,
    overshoot: u32,
    /// The most particles on the wrong side of closed fabric at a time when this was counted, and all particles then; `None` if it
    /// never was.
    passed: Option<[u64; 2]>,
    /// What walls took and vents let out in the intervals read, J and particles.
    energy_lost: f64,
    left: u64,
    /// Of each vent: hits that let a particle out, and hits whose probability was clipped.
    clipped: Vec<[u64; 2]>,
    /// Phase, seconds, dispatch groups.
    phases: Vec<(String, f64, u64)>,
}

impl AccountState {
    /// Particles that have left by the end of the last interval read.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Of each vent: hits that let a particle out, and hits whose probability was clipped.
    pub fn clipped(&self) -> &[[u64; 2]] {
        &self.clipped
    }
}

impl Account {
    pub fn new(plan: &Plan) -> Account {
        let counted = AccountState {
            start: State::default(),
            before: Entered::default(),
            injected_momentum: [0.0; 3],
            energy_entered: 0.0,
            particles: plan.initial_particles,
            particle_steps: 0,
            collisions: 0,
            bounces: 0,
            step_range: [f64::INFINITY, 0.0],
            steps: 0,
            lost: 0,
            sampled: 0,
            truncated: 0,
            caught: 0,
            free_flights: 0,
            unfitted: 0,
            cut_groups: 0,
            overshoot: 0,
            passed: None,
            energy_lost: 0.0,
            left: 0,
            clipped: Vec::new(),
            phases: Vec::new(),
        };
        Account {
            scales: Scales::new(plan),
            molar_masses: plan.gases.iter().map(|gas| gas.molar_mass).collect(),
            moles_per_particle: plan.moles_per_particle,
            counted,
        }
    }

    /// Zone 0 holds everything.
    fn totals(&self, tallies: &Tallies) -> State {
        let mut state = State::default();
        for (zone, molar_mass) in tallies.zones.iter().zip(&self.molar_masses) {
            let mass = molar_mass * self.moles_per_particle;
            state.number += zone.number.unsigned_abs();
            state.mass += mass * zone.number as f64;
            for (total, velocity) in state.momentum.iter_mut().zip(zone.velocity) {
                *total += mass * velocity as f64 / self.scales.velocity;
            }
            let spin = self.scales.reference_mass * zone.spin as f64;
            state.energy += (mass * zone.kinetic as f64 + spin) / self.scales.energy;
        }
        state
    }

    pub fn start(&mut self, tallies: &Tallies) {
        self.counted.start = self.totals(tallies);
    }

    /// Starts the account with these particles, after what this inflow has let in.
    pub fn start_with(&mut self, particles: &[GpuParticle], inflow: &Inflow) {
        let reference_mass = self.scales.reference_mass;
        let mut start = State { number: particles.len() as u64, ..State::default() };
        for particle in particles {
            let mass = self.molar_masses[usize::from(particle.gas())] * self.moles_per_particle;
            let velocity = particle.velocity.map(f64::from);
            start.mass += mass;
            for (total, v) in start.momentum.iter_mut().zip(velocity) {
                *total += mass * v;
            }
            let kinetic = 0.5 * mass * velocity.iter().map(|v| v * v).sum::<f64>();
            start.energy += kinetic + reference_mass * f64::from(particle.spin);
        }
        self.counted.particles = start.number;
        self.counted.start = start;
        self.counted.before = self.entered(inflow);
    }

    fn entered(&self, inflow: &Inflow) -> Entered {
        let by_gas = inflow.entered_by_gas();
        let mass = by_gas.iter().zip(&self.molar_masses).map(|(&n, mass)| n as f64 * mass * self.moles_per_particle);
        Entered {
            number: by_gas.iter().sum(),
            mass: mass.sum(),
            // What an orifice still owes is not in yet; it owes nothing once its flow has ended.
            energy: inflow.enthalpy() - inflow.debt(),
        }
    }

    /// The energy that walls took, also as work, and vents let out in an interval, J, and what its tallies of the zones miss of it, summed
    /// over them.
    fn lost(&self, tallies: &Tallies) -> (f64, f64) {
        let surface_models = tallies.surface_models.iter().map(|placed| (placed.energy, placed.tallied));
        let vents = tallies.vents.iter().map(|vent| (vent.energy, vent.tallied));
        let (energy, tallied) = surface_models
            .chain(vents)
            .chain(tallies.works.iter().map(|work| (work.energy, work.tallied)))
            .fold((0i128, 0i128), |(energy, tallied), (e, t)| (energy + i128::from(e), tallied + i128::from(t)));
        let unit = self.scales.reference_mass / self.scales.energy;
        (energy as f64 * unit, tallied as f64 * unit)
    }

    /// What must hold after every interval, of all ranks together; how far the energy is off, relative.
    pub fn check(&mut self, tallies: &Tallies, interval: &Interval) -> Result<f64, String> {
        let counters = &tallies.counters;
        let found: u64 = tallies.blocks.iter().map(|block| block.number).sum();
        let expected = i128::from(interval.particles) - i128::from(self.counted.left + left(tallies));
        if counters.capacity_failed > 0 || i128::from(found) != expected {
            return Err(format!("{found} particles are there, {expected} should be"));
        }
        if counters.missing > 0 {
            return Err(format!("{} updates of ghosts were for particles that are not there", counters.missing));
        }
        if counters.cut_short > 0 {
            return Err(format!(
                "the driver ended loops of {} threads too soon, as Mesa's lavapipe of 22.3 does after 65,535 turns and that of \
                 25.0 does not: take a newer driver, or fewer particles or triangles in a cell",
                counters.cut_short
            ));
        }
        if counters.misplaced > 0 {
            return Err(format!(
                "{} entries of lists found no place: the driver runs threads apart that count together, or a list has too little \
                 room; please report this, with the output of `corpuscle adapters`",
                counters.misplaced
            ));
        }
        if counters.tally_overflow > 0 {
            let squeezed = if tallies.works.is_empty() { "" } else { ", as of gas that a moving wall leaves no room" };
            return Err(format!(
                "{} values were beyond the range of a tally: speeds or energies far above the plan's{squeezed}",
                counters.tally_overflow
            ));
        }
        if counters.outside > 0 {
            return Err(format!("particles were found outside the vessel ({} times in these steps)", counters.outside));
        }
        let (since, brought) = interval.energy_tallied();
        let samples = f64::from(interval.samples());
        let had = samples * (self.counted.start.energy + self.counted.energy_entered) + since;
        let (lost, missed) = self.lost(tallies);
        let expected = had - samples * self.counted.energy_lost - missed;
        self.counted.energy_entered += brought;
        self.counted.energy_lost += lost;
        let energy = self.totals(tallies).energy;
        // Of all that there ever was, since little may be left.
        let scale = had.max(expected);
        if (energy - expected).abs() > ENERGY_ERROR * scale {
            return Err(format!(
                "the energy is {energy:.6e} J where {expected:.6e} J should be, summed over {samples} steps"
            ));
        }
        // An interval of few steps may have no sample.
        Ok(if scale > 0.0 { (energy - expected) / scale } else { 0.0 })
    }

    pub fn add(&mut self, plan: &Plan, tallies: &Tallies, interval: &Interval, timed: &[(&'static str, f64)]) {
        let counters = &tallies.counters;
        let steps = u64::from(interval.steps);
        let mut present =
            interval.particles - self.counted.left - interval.entering.iter().map(|&born| u64::from(born)).sum::<u64>();
        for born in &interval.entering {
            present += u64::from(*born);
            self.counted.particle_steps += present;
        }
        self.counted.left += left(tallies);
        self.counted.particles = interval.particles - self.counted.left;
        self.counted.clipped.resize(tallies.vents.len(), [0; 2]);
        for sums in [&tallies.vents, &tallies.passages] {
            for (counted, vent) in self.counted.clipped.iter_mut().zip(sums) {
                counted[0] += vent.left.iter().sum::<i64>().unsigned_abs();
                counted[1] += vent.clipped.unsigned_abs();
            }
        }
        self.counted.steps += steps;
        // A pair that a wall parted was settled without a collision.
        self.counted.collisions += counters.collisions - u64::from(counters.blocked);
        self.counted.bounces += u64::from(counters.bounces);
        self.counted.lost += u64::from(counters.lost);
        self.counted.sampled += match plan.method {
            // All steps are watched for candidates that were left out.
            Method::Cell => counters.collisions,
            _ => u64::from(counters.sampled),
        };
        self.counted.truncated += u64::from(counters.truncated);
        self.counted.caught += u64::from(counters.caught);
        self.counted.free_flights += u64::from(counters.free_flights);
        self.counted.unfitted += u64::from(counters.unfitted);
        self.counted.cut_groups += u64::from(counters.cut_groups);
        self.counted.overshoot = self.counted.overshoot.max(counters.overshoot);
        self.counted.step_range =
            [self.counted.step_range[0].min(interval.dt), self.counted.step_range[1].max(interval.dt)];
        for (total, own) in self.counted.injected_momentum.iter_mut().zip(interval.momentum) {
            *total += own;
        }
        // One step was timed; a tally is in fewer steps than the rest.
        for &(name, seconds) in timed {
            let share = match name {
                "tally" => u64::from(interval.samples()),
                name if once_an_interval(name) => 1,
                _ => steps,
            };
            match self.counted.phases.iter_mut().find(|(known, ..)| known == name) {
                Some((_, total, count)) => {
                    *total += seconds * share as f64;
                    *count += share;
                }
                None => self.counted.phases.push((name.to_owned(), seconds * share as f64, share)),
            }
        }
    }

    /// Particles on the wrong side of closed fabric, and all particles, at a time.
    pub fn passed(&mut self, now: [u64; 2]) {
        let most = self.counted.passed.unwrap_or(now);
        // By their share: one is among fewer particles at the start.
        let is_more = now[0] * most[1] > most[0] * now[1] || most[1] == 0;
        self.counted.passed = Some(if is_more { now } else { most });
    }

    pub fn state(&self) -> &AccountState {
        &self.counted
    }

    /// # Errors
    /// If no run of this plan can have counted this; then nothing is changed.
    pub fn restore(&mut self, plan: &Plan, state: &AccountState) -> Result<(), RunStateError> {
        let initial = state.start.number.checked_sub(state.before.number);
        if initial != Some(plan.initial_particles) {
            let found = initial.unwrap_or(0);
            return Err(RunStateError::differs("particles at the start", found, plan.initial_particles));
        }
        if state.particles > plan.particles {
            return Err(RunStateError::Impossible { what: "there are more particles than in the whole run" });
        }
        self.counted.clone_from(state);
        Ok(())
    }

    pub fn phases(&self) -> PhaseTable {
        let mut rows = self.counted.phases.clone();
        rows.sort_by_key(|(name, ..)| order_of(name));
        PhaseTable { rows, steps: self.counted.steps, particle_steps: self.counted.particle_steps }
    }

    /// The account at the end.
    pub fn close(&self, model: &Model, at_end: &AtEnd<'_>) -> Audit {
        let &AtEnd { tallies, inflow, outside, fabric, averages, surface_states } = at_end;
        let end = self.totals(tallies);
        let plan = &model.plan;
        let (entered, before) = (self.entered(inflow), self.counted.before);
        let surfaces = !model.scene.surfaces.is_empty();
        let (particles_vented, mass_vented, enthalpy_vented) = averages.total_vented();
        let clipped = model.scene.vents.iter().zip(&self.counted.clipped);
        let events = (self.counted.lost + self.counted.sampled) as f64;
        Audit {
            particles_initial: self.counted.start.number,
            particles_injected: entered.number - before.number,
            particles_vented,
            particles_inside: end.number - outside,
            particles_outside: outside,
            passed: self.counted.passed.map(|[particles, of]| PassedParticles {
                particles,
                of,
                elastic: model.fabric.is_elastic(),
            }),
            through_fabric: averages.total_through_fabric().map(|(particles, mass, _)| (particles, mass)),
            mass_start: self.counted.start.mass,
            mass_injected: entered.mass - before.mass,
            mass_vented,
            mass_end: end.mass,
            momentum_start: self.counted.start.momentum,
            momentum_injected: self.counted.injected_momentum,
            momentum_to_walls: surfaces.then(|| averages.total_impulse()),
            momentum_end: end.momentum,
            energy_start: self.counted.start.energy,
            enthalpy_injected: entered.energy - before.energy,
            enthalpy_vented,
            work_by_walls: (!model.moving.is_empty() || !model.fabric.is_empty()).then(|| averages.total_work()),
            fabric: fabric.map(|account| FabricAccount {
                from_gas: -averages.total_work_of_fabric(),
                ledger: account.ledger + averages.total_recoil(),
                ..account
            }),
            heat_to_walls: model.scene.has_heat().then(|| averages.total_heat()),
            clipped_vents: clipped
                .map(|(vent, [left, clipped])| (vent.name.clone(), *clipped as f64 / (*left).max(1) as f64))
                .collect(),
            clipped_surfaces: surface_states.beyond(),
            energy_end: end.energy,
            collision_cells: (plan.method == Method::HalfTurn).then(|| CollisionCells {
                free_flights: self.counted.free_flights as f64 / self.counted.particle_steps.max(1) as f64,
                unfitted: self.counted.unfitted as f64 / self.counted.particle_steps.max(1) as f64,
                cut_groups: self.counted.cut_groups as f64 / self.counted.steps.max(1) as f64,
            }),
            lost_collision_fraction: (plan.method != Method::None && events > 0.0)
                .then(|| self.counted.lost as f64 / events),
            wall_overshoot: f64::from(self.counted.overshoot) * plan.grid.quantum(),
            truncated_flights: self.counted.truncated,
            caught_flights: model.fabric.is_elastic().then(|| CaughtFlights {
                flights: self.counted.caught,
                share: self.counted.caught as f64 / self.counted.particle_steps.max(1) as f64,
            }),
            overflows: Vec::new(),
        }
    }
}

/// Particles that left the run in an interval.
fn left(tallies: &Tallies) -> u64 {
    tallies.vents.iter().flat_map(|vent| vent.left).sum::<i64>().unsigned_abs()
}

/// What an audit of a run of this plan lets pass. Walls let a particle be behind them by their tolerance, which
/// grows with the vessel (and the device rounds what it found up to a quantum).
pub fn audit_limits(plan: &Plan) -> AuditLimits {
    let wall_overshoot = (1.0 + 1e-6) * Walls::tolerance(&plan.grid) + plan.grid.quantum();
    AuditLimits { wall_overshoot, ..AuditLimits::default() }
}

/// Particles that are in no gas, nor within the tolerance of a wall: each has passed a closed mesh.
pub fn count_outside(vessel: &Vessel, plan: &Plan, particles: &[GpuParticle]) -> u64 {
    let reach = 2.0 * Walls::tolerance(&plan.grid);
    let outside = particles.iter().filter(|particle| {
        let place = plan.grid.to_metres(particle.position);
        if vessel.is_gas(place) {
            return false;
        }
        (0..6).all(|side| {
            let mut near = place;
            near[side / 2] += if side % 2 == 0 { reach } else { -reach };
            !vessel.is_gas(near)
        })
    });
    outside.count() as u64
}

/// Particles whose tag says another side of closed fabric than the parity of its triangles beyond them, none of which is within
/// reach of rounding.
pub fn count_passed(bags: &[Option<Bag>], plan: &Plan, particles: &[GpuParticle]) -> u64 {
    let inside = |place: [f64; 3]| bags.iter().flatten().any(|bag| bag.contains(place));
    let reach = 4.0 * plan.grid.quantum();
    let passed = particles.iter().filter(|particle| {
        let place = plan.grid.to_metres(particle.position);
        let is_wrong = |place| inside(place) != particle.is_inside();
        is_wrong(place)
            && (0..6).all(|side| {
                let mut near = place;
                near[side / 2] += if side % 2 == 0 { reach } else { -reach };
                is_wrong(near)
            })
    });
    passed.count() as u64
}

#[cfg(test)]
mod tests;
