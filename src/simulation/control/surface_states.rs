//! What the walls that are no mirrors do in an interval: the share of the hits that take the temperature of the
//! wall, and the probability of passing a vent (docs/explanation/method.md, "Walls").
//!
//! Both follow from the gas of a wall's chamber, as the integer tallies of an earlier interval have it: the same on
//! any number of ranks. A vent passes P = beta |v_n|, beta = 2 G / p for the flux G; for a mixture beta in proportion to
//! the molar mass, since the flux of a gas is beta p_s / 2 and what leaves must have the composition of what is there.
//! G is corrected by what the vent owes, the mass that should have left till then less that which has, and by how much more
//! or less than its beta would let out of a gas at rest the vent lately let out of the gas before it, which flows. Without the
//! latter a vent would for ever owe what makes up for it, some intervals' flow in proportion.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::gas::Species;
use crate::gas::vent::{LocalGas, flux, opens};
use crate::gas::wall_heat::accommodation;
use crate::scene::{GAS_CONSTANT, HeatTransfer, Vent};
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::model::build::Model;
use crate::simulation::model::vent_places::Beyond;
use crate::subdomain::{GpuSurfaceModel, GpuVent, Scales, Tables, Tallies, ZoneSum};

/// A vent pays what it owes within so many intervals of its flow, or while so many particles leave.
const PAID_IN: f64 = 8.0;
const PAID_BY: f64 = 32.0;
/// Its flow is raised to so many times what the gas gives it, at most.
const MOST_RAISED: f64 = 4.0;
/// It is learnt over so many particles at least, and as many intervals as it pays in, what a beta lets out; a beta is corrected
/// by it so many times at most.
const LEARNT_BY: f64 = 256.0;
const MOST_CORRECTED: f64 = 2.0;

/// The gas of a chamber, and what each vent owes, at the end of an interval.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SeenGas {
    chambers: Vec<ChamberGas>,
    vents: Vec<VentSeen>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct ChamberGas {
    /// mol/m3 of each gas.
    moles: Vec<f64>,
    /// K, translational.
    temperature: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct VentSeen {
    open: bool,
    /// kg; negative if too much has left.
    owed: f64,
    /// kg that have lately left, and that its beta would have let out of a gas at rest in the state of the chamber.
    left: f64,
    at_rest: f64,
}

impl VentSeen {
    /// Takes in what left in an interval, and what of a gas at rest would have; `particle` is the mass of one, kg.
    fn learn(&mut self, left: f64, at_rest: f64, particle: f64) {
        self.left += left;
        self.at_rest += at_rest;
        let most = (PAID_IN * at_rest).max(LEARNT_BY * particle);
        let kept = (most / self.at_rest).min(1.0);
        if kept < 1.0 {
            self.left *= kept;
            self.at_rest *= kept;
        }
    }

    /// How many times as much leaves as of a gas at rest; one before anything is known.
    fn eagerness(&self, particle: f64) -> f64 {
        let unknown = (LEARNT_BY * particle - self.at_rest).max(0.0) / PAID_IN;
        ((self.left + unknown) / (self.at_rest + unknown)).clamp(1.0 / MOST_CORRECTED, MOST_CORRECTED)
    }
}

/// What a run remembers of them.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SurfaceMemory {
    latest: SeenGas,
    current: SeenGas,
    /// Of each placed surface model, the largest share of accommodation that its coefficient has asked for.
    most_asked: Vec<f64>,
}

/// What a vent should pass in an interval, kg, and what isentropic flow through its area would.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct VentTarget {
    pub mass: f64,
    pub isentropic: f64,
}

/// When and how an interval was tallied.
#[derive(Debug, Clone, Copy)]
pub struct Window<'a> {
    /// Its start and end, s.
    pub span: [f64; 2],
    pub samples: u32,
    /// The mean ones of the chambers where walls move, m3.
    pub volumes: &'a [f64],
    /// What the device had of the vents.
    pub vents: &'a [GpuVent],
}

pub struct SurfaceStates<'a> {
    model: &'a Model,
    species: Vec<Species>,
    scales: Scales,
    state: SurfaceMemory,
}

impl<'a> SurfaceStates<'a> {
    pub fn new(model: &'a Model) -> SurfaceStates<'a> {
        let most_asked = vec![0.0; model.surface_models.placed.len()];
        SurfaceStates {
            model,
            species: model.plan.species(),
            scales: Scales::new(&model.plan),
            state: SurfaceMemory { most_asked, ..SurfaceMemory::default() },
        }
    }

    pub fn state(&self) -> &SurfaceMemory {
        &self.state
    }

    /// # Errors
    /// If the state is of another scene; then nothing is changed.
    pub fn restore(&mut self, state: &SurfaceMemory) -> Result<(), RunStateError> {
        let (chambers, vents) = (self.model.plan.chambers.len(), self.model.scene.vents.len());
        let mut lengths = vec![("surface models of walls", state.most_asked.len(), self.state.most_asked.len())];
        // Where all walls are mirrors nothing is seen.
        for seen in [&state.latest, &state.current].into_iter().filter(|seen| **seen != SeenGas::default()) {
            lengths.push(("chambers", seen.chambers.len(), chambers));
            lengths.push(("vents", seen.vents.len(), vents));
            let gases = seen.chambers.iter().map(|gas| ("gases", gas.moles.len(), self.model.plan.gases.len()));
            lengths.extend(gases);
        }
        for (what, found, expected) in lengths {
            if found != expected {
                return Err(RunStateError::differs(what, found as u64, expected as u64));
            }
        }
        self.state.clone_from(state);
        Ok(())
    }

    /// kg/mol, of the gas whose mass is the reference.
    fn heaviest(&self) -> f64 {
        self.scales.reference_mass / self.model.plan.moles_per_particle
    }

    fn mirrors(&self) -> bool {
        self.model.surface_models.placed.is_empty()
    }

    /// Takes the tallies of an interval; intervals come in their order. Also tells what its
    /// vents should have passed, by the gas that was there (and not by that of the interval before last, whose state they
    /// followed: so a vessel that empties fast does not lose more than it should).
    pub fn see(&mut self, tallies: &Tallies, window: Window<'_>) -> (SeenGas, Vec<VentTarget>) {
        let Window { span: [start, end], samples, volumes, vents } = window;
        if self.mirrors() {
            return (SeenGas::default(), Vec::new());
        }
        let model = self.model;
        if samples > 0 {
            let gases = model.plan.gases.len();
            self.state.latest.chambers = (0..model.plan.chambers.len())
                .map(|chamber| {
                    let zones = &tallies.zones[(chamber + 1) * gases..(chamber + 2) * gases];
                    let initial = model.plan.chambers[chamber].volume;
                    self.chamber(zones, f64::from(samples), volumes.get(chamber).copied().unwrap_or(initial))
                })
                .collect();
        }
        self.state.latest.vents.resize(model.scene.vents.len(), VentSeen::default());
        let wanted: Vec<VentTarget> =
            (0..model.scene.vents.len()).map(|index| self.flow(&self.state.latest, index, start, end).0).collect();
        for (index, target) in wanted.iter().enumerate() {
            let mut seen = self.state.latest.vents[index];
            let place = &model.surface_models.vents[index];
            let gas = self.local(&self.state.latest, place.chamber);
            let vent = self.vent_against(&self.state.latest, index);
            seen.open = opens(&vent, seen.open, gas.map_or(0.0, |gas| gas.pressure));
            let (mass, left) = (target.mass, self.left(tallies, index));
            let most = MOST_RAISED * (PAID_IN * mass).max(PAID_BY * self.scales.reference_mass);
            seen.owed = (seen.owed + mass - left).clamp(-most, most);
            let tally = self.tally_of(index);
            let beta = vents.iter().find(|known| known.index == tally).map_or(0.0, |known| known.beta.into());
            let unit = |gas: LocalGas| 0.5 * gas.pressure * gas.molar_mass * place.area * (end - start);
            seen.learn(left, beta * gas.map_or(0.0, unit) / self.heaviest(), self.scales.reference_mass);
            self.state.latest.vents[index] = seen;
        }
        (self.state.latest.clone(), wanted)
    }

    /// The state of the start of a run, before any interval.
    pub fn start(&mut self, at_start: &Tallies) {
        let window = Window { span: [0.0; 2], samples: 1, volumes: &[], vents: &[] };
        self.state.current = self.see(at_start, window).0;
    }

    /// The pressure of the chamber that a vent empties, Pa, by the tallies that were seen last; before fabric with gas behind it that
    /// which drives the flow, above the vent's external pressure.
    pub fn pressure_before(&self, index: usize) -> f64 {
        let seen = &self.state.latest;
        let pressure = |chamber| self.local(seen, chamber).map_or(0.0, |gas| gas.pressure);
        let vent = &self.model.scene.vents[index];
        pressure(self.model.surface_models.vents[index].chamber) + vent.external_pressure
            - self.vent_against(seen, index).external_pressure
    }

    /// A vent of the scene against the gas that is behind it.
    fn vent_against(&self, seen: &SeenGas, index: usize) -> Cow<'a, Vent> {
        let vent = &self.model.scene.vents[index];
        let Beyond::Gas(chamber) = self.model.surface_models.vents[index].beyond else { return Cow::Borrowed(vent) };
        let behind = chamber.and_then(|chamber| self.local(seen, chamber)).map_or(0.0, |gas| gas.pressure);
        Cow::Owned(Vent { external_pressure: behind, ..vent.clone() })
    }

    /// Of each vent, whether it has opened.
    pub fn open_vents(&self) -> Vec<bool> {
        let seen = &self.state.latest.vents;
        (0..self.model.scene.vents.len()).map(|index| seen.get(index).is_some_and(|vent| vent.open)).collect()
    }

    /// From now on the walls follow this state.
    pub fn follow(&mut self, seen: SeenGas) {
        if !self.mirrors() {
            self.state.current = seen;
        }
    }

    fn chamber(&self, zones: &[ZoneSum], samples: f64, volume: f64) -> ChamberGas {
        let plan = &self.model.plan;
        let (mut mass, mut kinetic, mut total, mut momentum) = (0.0, 0.0, 0.0, [0.0; 3]);
        let mut moles = Vec::with_capacity(zones.len());
        for (zone, gas) in zones.iter().zip(&plan.gases) {
            let number = zone.number as f64 / samples * plan.moles_per_particle;
            moles.push(number / volume);
            total += number;
            mass += gas.molar_mass * number;
            let own = gas.molar_mass * plan.moles_per_particle / samples;
            kinetic += own * zone.kinetic as f64 / self.scales.energy;
            for (sum, velocity) in momentum.iter_mut().zip(zone.velocity) {
                *sum += own * velocity as f64 / self.scales.velocity;
            }
        }
        if total <= 0.0 {
            return ChamberGas { moles, temperature: 0.0 };
        }
        let bulk = 0.5 * momentum.iter().map(|p| p * p).sum::<f64>() / mass;
        ChamberGas { moles, temperature: (kinetic - bulk).max(0.0) / (1.5 * total * GAS_CONSTANT) }
    }

    fn local(&self, seen: &SeenGas, chamber: usize) -> Option<LocalGas> {
        let gas = seen.chambers.get(chamber)?;
        LocalGas::new(&self.species, &gas.moles, gas.temperature)
    }

    /// The number of a vent's tally on the device.
    fn tally_of(&self, vent: usize) -> u32 {
        let first = if self.passes(vent) { self.model.scene.vents.len() } else { 0 };
        (first + vent) as u32
    }

    fn passes(&self, vent: usize) -> bool {
        self.model.surface_models.vents[vent].beyond != Beyond::Nothing
    }

    /// Mass that has left its side through a vent, kg.
    fn left(&self, tallies: &Tallies, vent: usize) -> f64 {
        let plan = &self.model.plan;
        let sums = if self.passes(vent) { &tallies.passages } else { &tallies.vents };
        let left = sums.get(vent).map(|sum| sum.left).unwrap_or_default();
        plan.gases.iter().zip(left).map(|(gas, n)| gas.molar_mass * plan.moles_per_particle * n as f64).sum()
    }

    /// What the walls do from `start` to `end`, s.
    pub fn tables(&mut self, start: f64, end: f64) -> Tables {
        let mut tables = Tables::default();
        if self.mirrors() {
            return tables;
        }
        let model = self.model;
        let betas: Vec<f64> =
            (0..model.scene.vents.len()).map(|index| self.flow(&self.state.current, index, start, end).1).collect();
        let heaviest = self.heaviest();
        for (index, placed) in model.surface_models.placed.iter().enumerate() {
            let first_vent = tables.vents.len() as u32;
            for &vent in &placed.vents {
                let (center, radius2) = self.disc(vent);
                let (beta, index, passes) = (betas[vent] as f32, self.tally_of(vent), u32::from(self.passes(vent)));
                tables.vents.push(GpuVent { center, radius2, beta, index, passes, pad: 0 });
            }
            let surface = model.scene.surface_model(placed.surface);
            let (mut thermal, mut share) = (0.0, 0.0);
            if let Some(heat) = &surface.heat {
                thermal = GAS_CONSTANT * heat.temperature / heaviest;
                let gas = placed.chamber.and_then(|chamber| self.state.current.chambers.get(chamber));
                share = match (gas, heat.transfer) {
                    (Some(gas), _) => accommodation(heat, &self.species, &gas.moles, gas.temperature),
                    (None, HeatTransfer::Accommodation(share)) if placed.chamber.is_none() => share,
                    (None, _) => 0.0,
                };
                // In an empty chamber any coefficient is too large, and nothing hits the wall.
                if share.is_finite() && matches!(heat.transfer, HeatTransfer::Coefficient(_)) {
                    self.state.most_asked[index] = self.state.most_asked[index].max(share);
                }
            }
            tables.surface_models.push(GpuSurfaceModel {
                thermal: thermal as f32,
                accommodation: share.min(1.0) as f32,
                friction: surface.friction as f32,
                first_vent,
                end_vent: tables.vents.len() as u32,
                // Of zones the first is everything.
                zone: placed.next.and(placed.chamber).map_or(0, |chamber| chamber as u32 + 1),
                next: placed.next.unwrap_or(0) as u32,
            });
        }
        tables
    }

    /// Centre in quanta and the square of the radius, m2, of a vent's place. (Of fabric it is a set of triangles, whose surface model no
    /// other has.)
    fn disc(&self, index: usize) -> ([u32; 3], f32) {
        let grid = &self.model.plan.grid;
        let vent = &self.model.scene.vents[index];
        match &vent.disc {
            Some(disc) if self.model.scene.fabric_at(vent.wall).is_none() => {
                let quanta = |axis: usize| ((disc.center[axis] - grid.origin[axis]) / grid.quantum()).round() as i64;
                (std::array::from_fn(|axis| quanta(axis) as u32), (0.25 * disc.diameter * disc.diameter) as f32)
            }
            _ => ([0; 3], -1.0),
        }
    }

    /// What a vent should pass of the gas of a state, and its beta for the reference mass, s/m.
    fn flow(&self, state: &SeenGas, index: usize, start: f64, end: f64) -> (VentTarget, f64) {
        let model = self.model;
        let (vent, place) = (self.vent_against(state, index), &model.surface_models.vents[index]);
        let Some(gas) = self.local(state, place.chamber) else {
            return (VentTarget::default(), 0.0);
        };
        let seen = state.vents.get(index).copied().unwrap_or_default();
        let area = vent.area.unwrap_or(place.area);
        let over = area * (end - start);
        let isentropic = over * gas.isentropic_flux(vent.external_pressure);
        if !seen.open {
            return (VentTarget { mass: 0.0, isentropic }, 0.0);
        }
        let flux = flux(&vent, &gas, 0.5 * (start + end));
        let wanted = VentTarget { mass: over * flux, isentropic };
        let within = (PAID_IN * wanted.mass).max(PAID_BY * self.scales.reference_mass);
        let raised = (1.0 + seen.owed / within) / seen.eagerness(self.scales.reference_mass);
        let beta = 2.0 * flux * area / place.area / gas.pressure * self.heaviest() / gas.molar_mass;
        (wanted, beta * raised.clamp(0.0, MOST_RAISED))
    }

    /// The walls whose coefficient asked for more than all hits can give, with how many times as much.
    pub fn beyond(&self) -> Vec<(String, f64)> {
        let mut beyond: Vec<(String, f64)> = Vec::new();
        for (placed, &asked) in self.model.surface_models.placed.iter().zip(&self.state.most_asked) {
            if asked > 1.0 {
                let name = self.model.scene.surface_name(placed.surface);
                match beyond.iter_mut().find(|(known, _)| *known == name) {
                    Some((_, most)) => *most = most.max(asked),
                    None => beyond.push((name, asked)),
                }
            }
        }
        beyond
    }
}

#[cfg(test)]
mod tests;
