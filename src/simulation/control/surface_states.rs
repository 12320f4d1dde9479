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
use crate::simulation::control::fabric_seen::{areas_of, side_pressures};
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::control::vent_seen::{MOST_RAISED, PAID_BY, PAID_IN, VentSeen};
use crate::simulation::control::window::Window;
use crate::simulation::model::build::Model;
use crate::simulation::model::vent_places::Beyond;
use crate::subdomain::{GpuSurfaceModel, GpuVent, Scales, Tables, Tallies, ZoneSum};

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

impl SeenGas {
    /// Whether an open sheet has more pressure on the side that its normals point away from.
    fn flows_outwards(&self, vent: usize) -> bool {
        self.vents.get(vent).is_some_and(|vent| vent.sides[1] > vent.sides[0])
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
        let Window { span: [start, end], samples, volumes, vents, .. } = window;
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
        self.see_fabric(tallies, &window);
        let wanted: Vec<VentTarget> =
            (0..model.scene.vents.len()).map(|index| self.flow(&self.state.latest, index, start, end).0).collect();
        for (index, target) in wanted.iter().enumerate() {
            let mut seen = self.state.latest.vents[index];
            let (gas, vent) = self.before(&self.state.latest, index);
            seen.open = opens(&vent, seen.open, gas.map_or(0.0, |gas| gas.pressure));
            let (mass, left) = (target.mass, self.left(tallies, index));
            let most = MOST_RAISED * (PAID_IN * mass).max(PAID_BY * self.scales.reference_mass);
            seen.owed = (seen.owed + mass - left).clamp(-most, most);
            let tally = self.tally_of(index);
            // (Of the two sides of an open sheet one has none.)
            let own = vents.iter().filter(|known| known.index == tally).map(|known| f64::from(known.beta));
            let beta = own.fold(0.0, f64::max);
            let area = self.place_area(&self.state.latest, index);
            let unit = |gas: LocalGas| 0.5 * gas.pressure * gas.molar_mass * area * (end - start);
            seen.learn(left, beta * gas.map_or(0.0, unit) / self.heaviest(), self.scales.reference_mass);
            self.state.latest.vents[index] = seen;
        }
        (self.state.latest.clone(), wanted)
    }

    /// What of the vents on fabric follows from where that is, and from the hits on its sides.
    fn see_fabric(&mut self, tallies: &Tallies, window: &Window<'_>) {
        let model = self.model;
        if !model.surface_models.has_vents_on_fabric() {
            return;
        }
        if !window.nodes.is_empty() {
            let areas = areas_of(&model.fabric.triangles, &model.surface_models.vent_triangles, window.nodes);
            for (vent, area) in self.state.latest.vents.iter_mut().zip(areas) {
                vent.area = area;
            }
        }
        for index in 0..model.scene.vents.len() {
            let place = &model.surface_models.vents[index];
            let Some(sheet) = place.open_sheet else { continue };
            let at_rest = self.local(&self.state.latest, place.chamber).map_or(0.0, |gas| gas.pressure);
            let vent = &mut self.state.latest.vents[index];
            match side_pressures(model, &self.scales, (tallies, sheet), window) {
                // What is around it before any hit was counted.
                None => vent.sides = [at_rest; 2],
                Some(now) => {
                    vent.sides.iter_mut().zip(now).for_each(|(side, [now, share])| *side += share * (now - *side));
                }
            }
        }
    }

    /// The state of the start of a run, before any interval.
    pub fn start(&mut self, at_start: &Tallies) {
        let window = Window { span: [0.0; 2], samples: 1, volumes: &[], vents: &[], nodes: &[] };
        self.state.current = self.see(at_start, window).0;
    }

    /// The pressure of the chamber that a vent empties, Pa, by the tallies that were seen last; before fabric with gas behind it that
    /// which drives the flow, above the vent's external pressure.
    pub fn pressure_before(&self, index: usize) -> f64 {
        let (gas, vent) = self.before(&self.state.latest, index);
        gas.map_or(0.0, |gas| gas.pressure) + self.model.scene.vents[index].external_pressure - vent.external_pressure
    }

    /// The gas that a vent lets out, and the vent against what is behind it.
    fn before(&self, seen: &SeenGas, index: usize) -> (Option<LocalGas>, Cow<'a, Vent>) {
        let (vent, place) = (&self.model.scene.vents[index], &self.model.surface_models.vents[index]);
        let gas = self.local(seen, place.chamber);
        let against = |external_pressure: f64| Cow::Owned(Vent { external_pressure, ..vent.clone() });
        if place.open_sheet.is_some() {
            // The gas of the chamber, as dense as the pressure on each side has it.
            let [outer, inner] = seen.vents.get(index).map_or([0.0; 2], |vent| vent.sides);
            return (gas.map(|gas| LocalGas { pressure: outer.max(inner), ..gas }), against(outer.min(inner)));
        }
        let Beyond::Gas(chamber) = place.beyond else { return (gas, Cow::Borrowed(vent)) };
        let behind = chamber.and_then(|chamber| self.local(seen, chamber)).map_or(0.0, |gas| gas.pressure);
        (gas, against(behind))
    }

    /// m2, of a vent's place as it was seen.
    fn place_area(&self, seen: &SeenGas, index: usize) -> f64 {
        let area = seen.vents.get(index).map_or(0.0, |vent| vent.area);
        if area > 0.0 { area } else { self.model.surface_models.vents[index].area }
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
                let lets_out = model.surface_models.vents[vent].open_sheet.is_none()
                    || placed.inner == self.state.current.flows_outwards(vent);
                let beta = if lets_out { betas[vent] as f32 } else { 0.0 };
                let (index, passes) = (self.tally_of(vent), u32::from(self.passes(vent)));
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
        let (gas, vent) = self.before(state, index);
        let Some(gas) = gas.filter(|gas| gas.pressure > 0.0) else {
            return (VentTarget::default(), 0.0);
        };
        let seen = state.vents.get(index).copied().unwrap_or_default();
        let place_area = self.place_area(state, index);
        let area = vent.area.unwrap_or(place_area);
        let over = area * (end - start);
        let isentropic = over * gas.isentropic_flux(vent.external_pressure);
        if !seen.open {
            return (VentTarget { mass: 0.0, isentropic }, 0.0);
        }
        let flux = flux(&vent, &gas, 0.5 * (start + end));
        let wanted = VentTarget { mass: over * flux, isentropic };
        let within = (PAID_IN * wanted.mass).max(PAID_BY * self.scales.reference_mass);
        let raised = (1.0 + seen.owed / within) / seen.eagerness(self.scales.reference_mass);
        let beta = 2.0 * flux * area / place_area / gas.pressure * self.heaviest() / gas.molar_mass;
        (wanted, beta * raised.clamp(0.0, MOST_RAISED))
    }

    /// The titles of the surfaces whose coefficient asked for more than all hits can give, with how many times as much.
    pub fn beyond(&self) -> Vec<(String, f64)> {
        let mut beyond: Vec<(String, f64)> = Vec::new();
        for (placed, &asked) in self.model.surface_models.placed.iter().zip(&self.state.most_asked) {
            if asked > 1.0 {
                let title = self.model.scene.surface_title(placed.surface);
                match beyond.iter_mut().find(|(known, _)| *known == title) {
                    Some((_, most)) => *most = most.max(asked),
                    None => beyond.push((title, asked)),
                }
            }
        }
        beyond
    }
}

#[cfg(test)]
mod tests;
