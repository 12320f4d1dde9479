//! The method `control-volume`: a run, or the rest of one (`switch`), without particles (method.md, "The method control-volume": right
//! where pressures are uniform).
//!
//! Each chamber is uniform; `reference` has its equations. A row has the state in the middle of its window, and what
//! surfaces received in it by Simpson's rule. A probe shows the chamber that its middle lies in; a surface is pressed
//! by the chambers that its parts face. No device, no ranks, no random numbers: a run takes milliseconds.

use glam::DVec3;

use super::reference::{continued_with_losses, heated_walls, reference_with_losses};
use super::rows::RowObserver;
use crate::gas::{
    Beginning, FlowIntegral, Lost, State, Vented, flow_times_of_temperature, flow_times_temperature, thermo,
};
use crate::output::Audit;
use crate::scene::{SurfaceId, WallHeat};
use crate::simulation::accounting::row::{MotionState, Row, SurfaceState, VentState, WallState, ZoneState};
use crate::simulation::accounting::vent_watch::VentWatch;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::model::facing::Known;

/// Parts of a row over which the work of moving walls is summed.
const WORK_PARTS: u32 = 32;

/// Emits the rows of the whole run and closes its account.
///
/// # Errors
/// If a probe or a surface lies in no chamber, or the observer stops the run.
pub fn run_uniform(model: &Model, observer: &mut dyn RowObserver) -> Result<Audit, SimulationError> {
    let rows = model.scene.output.rows.max(1);
    let bounds: Vec<f64> = (0..=rows).map(|row| model.plan.end_time * f64::from(row) / f64::from(rows)).collect();
    let solved = |times: &[f64]| reference_with_losses(model, times);
    let known = Known::of(&model.scene, &model.vessel)?;
    let watches = vec![VentWatch::default(); model.scene.vents.len()];
    stretch(model, &known, &Solution { solved: &solved, bounds }, Earlier { last: None, watches: &watches }, observer)
}

/// What a control volume goes on from.
pub struct Continuation<'a> {
    /// The state that particles had.
    pub beginning: &'a Beginning,
    /// What they told.
    pub earlier: Earlier<'a>,
}

/// Goes on and emits the rows that end at `ends`, s, which are after the beginning. The audit is that of what follows.
///
/// # Errors
/// If the observer stops the run.
pub fn continue_uniform(
    model: &Model,
    known: &Known,
    from: &Continuation<'_>,
    ends: &[f64],
    observer: &mut dyn RowObserver,
) -> Result<Audit, SimulationError> {
    let bounds = [&[from.beginning.time], ends].concat();
    let solved = |times: &[f64]| continued_with_losses(model, from.beginning, times);
    stretch(model, known, &Solution { solved: &solved, bounds }, from.earlier, observer)
}

/// What came before.
#[derive(Clone, Copy)]
pub struct Earlier<'a> {
    /// The last row, if there was any: its totals go on.
    pub last: Option<&'a Row>,
    /// What was seen of each vent.
    pub watches: &'a [VentWatch],
}

/// States, and what has left since the start, at times that ascend from it.
type Solved<'a> = &'a dyn Fn(&[f64]) -> Vec<(Vec<State>, Lost)>;

/// A time that a control volume is solved for.
struct Solution<'a> {
    solved: Solved<'a>,
    /// The start of the first row and the ends of all, s.
    bounds: Vec<f64>,
}

fn stretch(
    model: &Model,
    known: &Known,
    Solution { solved, bounds }: &Solution<'_>,
    Earlier { last, watches }: Earlier<'_>,
    observer: &mut dyn RowObserver,
) -> Result<Audit, SimulationError> {
    let Model { plan, .. } = model;
    let rows = bounds.len() - 1;
    // Ends and middles of the windows.
    let half = |k: usize| 0.5 * (bounds[k / 2] + bounds[k.div_ceil(2)]);
    let times: Vec<f64> = (0..=2 * rows).map(half).collect();
    let states = solved(&times);
    let heated = heated_walls(model);
    let Known { probes, surfaces } = known;
    let mut received: Vec<[f64; 3]> = match last {
        Some(row) => row.surfaces.iter().map(|surface| surface.impulse).collect(),
        None => vec![[0.0; 3]; surfaces.len()],
    };
    let works = works(model, solved, bounds);
    let mut worked: Vec<f64> = last.map_or_else(Vec::new, |row| row.motions.iter().map(|motion| motion.work).collect());
    worked.resize(model.moving.count(), 0.0);
    let worked_before: f64 = worked.iter().sum();
    let mut watches = watches.to_vec();
    for row in 0..rows {
        for k in 2 * row..=2 * row + 2 {
            watch_vents(model, &mut watches, times[k], &states[k].0, observer);
        }
        let [before, middle, after] = [0, 1, 2].map(|k| &states[2 * row + k].0);
        let [lost_before, lost_after] = [0, 2].map(|k| &states[2 * row + k].1);
        let window = [times[2 * row], times[2 * row + 2]];
        let zones: Vec<ZoneState> =
            (0..plan.chambers.len()).map(|index| zone(model, index, times[2 * row + 1], &middle[index])).collect();
        let pressed = |chamber: usize| {
            (before[chamber].pressure + 4.0 * middle[chamber].pressure + after[chamber].pressure) / 6.0
        };
        let on_surfaces = surfaces.iter().zip(&mut received).map(|(faces, received)| {
            let mut force = DVec3::ZERO;
            let (mut sum, mut area) = (0.0, 0.0);
            for face in faces {
                let pressure = pressed(face.chamber);
                force += pressure * face.outward;
                sum += pressure * face.area;
                area += face.area;
            }
            for (total, own) in received.iter_mut().zip((force * (window[1] - window[0])).to_array()) {
                *total += own;
            }
            SurfaceState { pressure: sum / area, impulse: *received, hits: 0 }
        });
        let on_surfaces = on_surfaces.collect();
        let mut motions = Vec::new();
        for (index, [displacement, velocity]) in model.moving.courses(times[2 * row + 1]).into_iter().enumerate() {
            let own = works[row][index];
            worked[index] += own;
            let power = own / (window[1] - window[0]);
            motions.push(MotionState { displacement, velocity, work: worked[index], power });
        }
        observer.row(&Row {
            time: times[2 * row + 1],
            window,
            step: window[1] - window[0],
            particles: 0,
            probes: probes.iter().map(|&chamber| zones[chamber].clone()).collect(),
            chambers: zones,
            surfaces: on_surfaces,
            walls: walls(model, &heated, window, [lost_before, lost_after], last),
            vents: vents(window, [lost_before, lost_after], last),
            motions,
            fabrics: Vec::new(),
        })?;
        observer.progress(window[1], row as u64 + 1, 0);
    }
    observer.vents(&watches);
    let work = (!model.moving.is_empty()).then(|| worked.iter().sum::<f64>() - worked_before);
    let (end, lost) = &states[states.len() - 1];
    let heat = (!heated.is_empty()).then(|| lost.heat.iter().sum());
    Ok(Audit {
        work_by_walls: work,
        heat_to_walls: heat,
        mass_vented: lost.vented.iter().map(|vent| vent.mass).sum(),
        enthalpy_vented: lost.vented.iter().map(|vent| vent.enthalpy).sum(),
        ..audit(model, &states[0].0, end, [bounds[0], bounds[rows]])
    })
}

/// A vent opens where the line between two states reaches its pressure.
fn watch_vents(model: &Model, watches: &mut [VentWatch], time: f64, states: &[State], observer: &mut dyn RowObserver) {
    for (index, (watch, vent)) in watches.iter_mut().zip(&model.scene.vents).enumerate() {
        if watch.see(vent, [time, states[model.surface_models.vents[index].chamber].pressure], true) {
            observer.vent_opened(index, watch);
        }
    }
}

/// Those that keep a temperature, in the order of the scene; `lost`: until the start and the end of the window.
fn walls(
    model: &Model,
    heated: &[SurfaceId],
    window: [f64; 2],
    lost: [&Lost; 2],
    last: Option<&Row>,
) -> Vec<WallState> {
    let of_surface = |(index, (surface, _)): (usize, (SurfaceId, WallHeat))| {
        let earlier = last.map_or(0.0, |row| row.walls[index].heat);
        let own = heated.iter().enumerate().filter(|(_, of)| **of == surface).map(|(index, _)| index);
        let [before, after] = lost.map(|lost| own.clone().map(|index| lost.heat[index]).sum::<f64>());
        let surface_models = model.surface_models.placed.iter().filter(|placed| placed.surface == surface);
        let area: f64 = surface_models.map(|placed| placed.area).sum();
        WallState::new(earlier + after, after - before, area, window[1] - window[0])
    };
    model.scene.heated_surfaces().enumerate().map(of_surface).collect()
}

/// What passes is what should: there is no particle that could not.
fn vents(window: [f64; 2], [before, after]: [&Lost; 2], last: Option<&Row>) -> Vec<VentState> {
    let of_vent = |(index, (before, after)): (usize, (&Vented, &Vented))| {
        let [earlier, enthalpy] = last.map_or([0.0; 2], |row| [row.vents[index].mass, row.vents[index].enthalpy]);
        let mass = after.mass - before.mass;
        let isentropic = after.isentropic - before.isentropic;
        let mass_flow = mass / (window[1] - window[0]);
        let discharge = if isentropic > 0.0 { mass / isentropic } else { 0.0 };
        VentState {
            mass_flow,
            wanted_mass_flow: mass_flow,
            discharge,
            wanted_discharge: discharge,
            mass: earlier + after.mass,
            enthalpy: enthalpy + after.enthalpy,
        }
    };
    before.vented.iter().zip(&after.vented).enumerate().map(of_vent).collect()
}

/// The work of each moving wall on the gas in each row, J: -p dV, by the mean of p between near times (and not by the
/// integration of the energy, which this is to check).
fn works(model: &Model, solved: Solved<'_>, bounds: &[f64]) -> Vec<Vec<f64>> {
    let moving = &model.moving;
    let rows = bounds.len() - 1;
    if moving.is_empty() {
        return vec![Vec::new(); rows];
    }
    let parts = bounds.windows(2).flat_map(|row| {
        (1..=WORK_PARTS).map(|part| row[0] + (row[1] - row[0]) * f64::from(part) / f64::from(WORK_PARTS))
    });
    let times: Vec<f64> = std::iter::once(bounds[0]).chain(parts).collect();
    let states = solved(&times);
    let mut works = vec![vec![0.0; moving.count()]; rows];
    for (k, (pair, around)) in states.windows(2).zip(times.windows(2)).enumerate() {
        for (work, swept) in works[k / WORK_PARTS as usize].iter_mut().zip(&moving.swept) {
            for (chamber, (before, after)) in pair[0].0.iter().zip(&pair[1].0).enumerate() {
                let growth = swept.change(chamber, around[1]) - swept.change(chamber, around[0]);
                *work -= 0.5 * (before.pressure + after.pressure) * growth;
            }
        }
    }
    works
}

fn zone(model: &Model, chamber: usize, time: f64, state: &State) -> ZoneState {
    let plan = &model.plan;
    let initial = plan.chambers[chamber].volume;
    let volume = model.moving.swept.iter().fold(initial, |volume, swept| volume + swept.change(chamber, time));
    let mass: f64 = state.moles.iter().zip(&plan.gases).map(|(n, gas)| n * gas.molar_mass).sum();
    ZoneState {
        pressure: state.pressure,
        temperature: state.temperature,
        density: mass / volume,
        volume,
        velocity: [0.0; 3],
        particles: state.moles.iter().map(|n| n / plan.moles_per_particle).collect(),
    }
}

/// Of the time between two states.
fn audit(model: &Model, start: &[State], end: &[State], [from, until]: [f64; 2]) -> Audit {
    let Model { scene, plan, .. } = model;
    let species = plan.species();
    let mass = |moles: &[f64]| moles.iter().zip(&species).map(|(n, gas)| n * gas.molar_mass).sum::<f64>();
    let (mut injected, mut enthalpy) = (0.0, 0.0);
    // By the curves themselves, not by the integration that this is to check.
    for orifice in &scene.orifices {
        let molar_mass = thermo::molar_mass(&orifice.mixture, &species);
        let (flow, temperature) = (&orifice.mass_flow, &orifice.temperature);
        injected += FlowIntegral::new(flow, until).total() - FlowIntegral::new(flow, from).total();
        let by = |time: f64| {
            if thermo::is_constant(&orifice.mixture, &species) {
                let specific = thermo::molar_enthalpy(&orifice.mixture, &species, 1.0) / molar_mass;
                specific * flow_times_temperature(flow, temperature, time)
            } else {
                let specific = |t: f64| thermo::molar_enthalpy(&orifice.mixture, &species, t) / molar_mass;
                flow_times_of_temperature(flow, temperature, time, specific)
            }
        };
        enthalpy += by(until) - by(from);
    }
    Audit {
        mass_start: start.iter().map(|state| mass(&state.moles)).sum(),
        mass_injected: injected,
        mass_end: end.iter().map(|state| mass(&state.moles)).sum(),
        energy_start: start.iter().map(|state| state.energy).sum(),
        enthalpy_injected: enthalpy,
        energy_end: end.iter().map(|state| state.energy).sum(),
        ..Audit::default()
    }
}

#[cfg(test)]
mod tests;
