//! When a run of particles goes on as a control volume (method.md, "From particles to a control volume": right where pressures are
//! uniform), and with what.
//!
//! Uniform are pressures that differ from that of their chamber by no more than noise. Over the time asked for, of every
//! probe and surface the mean deviation is within three standard errors, those of hits on the surface and of what wanders in
//! and out of the probe, and the rows scatter as noise does (so that no wave passes as its mean). Half a per cent is let pass
//! besides: to that the volumes of probes and the areas of surfaces are known. Decided by rows of the history, which are the
//! same on any number of ranks.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::gas::{Beginning, kinetics};
use crate::plan::{Plan, noise_of_hits, noise_of_zone};
use crate::scene::Switch;
use crate::simulation::accounting::row::Row;
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::model::facing::Known;
use crate::subdomain::{Scales, Tallies};

const STANDARD_ERRORS: f64 = 3.0;
/// To which volumes and areas are known, relative.
const FLOOR: f64 = 0.005;
/// A window that is long against everything that gas forgets in.
const LONG: f64 = 1e6;

/// What a row knows of uniformity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Deviations {
    pub window: [f64; 2],
    /// Of each probe, then of each surface: how far the pressure is from that of the chamber, relative, and one over the
    /// variance of that.
    pub of_places: Vec<[f64; 2]>,
}

/// The rows by which a run switches.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Decided {
    /// s.
    pub window: [f64; 2],
    /// The largest standard error of a place.
    pub noise: f64,
}

/// What it remembers of the rows, oldest first, until it has decided.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct SwitchState {
    pub recent: VecDeque<Deviations>,
    pub decided: Option<Decided>,
}

pub struct Switching<'a> {
    model: &'a Model,
    /// `None` in a run that stays one of particles.
    asked: Option<(Switch, Known)>,
    state: SwitchState,
}

impl<'a> Switching<'a> {
    /// # Errors
    /// If the run is to switch, and a probe or a surface lies in no chamber.
    pub fn new(model: &'a Model) -> Result<Switching<'a>, SimulationError> {
        let asked = model.scene.model.switch.map(|switch| {
            let known = Known::of(&model.scene, &model.vessel)?;
            Ok::<_, SimulationError>((switch, known))
        });
        Ok(Switching { model, asked: asked.transpose()?, state: SwitchState::default() })
    }

    pub fn known(&self) -> Option<&Known> {
        self.asked.as_ref().map(|(_, known)| known)
    }

    /// The time from which on there are no more particles, s; infinite if it is not known beforehand.
    pub fn time(&self) -> f64 {
        match self.asked {
            Some((Switch::At(time), _)) => time,
            _ => f64::INFINITY,
        }
    }

    pub fn state(&self) -> &SwitchState {
        &self.state
    }

    /// # Errors
    /// If the state is of another scene; then nothing is changed.
    pub fn restore(&mut self, state: &SwitchState) -> Result<(), RunStateError> {
        let places = self.model.scene.probes.len() + self.model.scene.surfaces.len();
        for row in &state.recent {
            if row.of_places.len() != places {
                return Err(RunStateError::differs("probes and surfaces", row.of_places.len() as u64, places as u64));
            }
        }
        self.state.clone_from(state);
        Ok(())
    }

    /// Takes a row in, and says whether the pressures have been uniform for as long as was asked. Once they have, no more
    /// rows are taken in.
    pub fn row(&mut self, row: &Row) -> bool {
        let Some((Switch::WhenUniform { lasting }, known)) = &self.asked else { return false };
        if self.state.decided.is_some() {
            return false;
        }
        let lasting = *lasting;
        let of_places = deviations(&self.model.plan, known, row);
        let recent = &mut self.state.recent;
        recent.push_back(Deviations { window: row.window, of_places });
        let reaches = |recent: &VecDeque<Deviations>, from: usize| {
            recent.get(from).is_some_and(|first| row.window[1] - first.window[0] >= lasting * (1.0 - 1e-9))
        };
        while reaches(recent, 1) {
            recent.pop_front();
        }
        let noise = reaches(recent, 0).then(|| uniform(recent)).flatten();
        self.state.decided = noise.map(|noise| Decided { window: [recent[0].window[0], row.window[1]], noise });
        noise.is_some()
    }

    /// Why the run goes on without particles.
    pub fn why(&self) -> String {
        match self.state.decided {
            Some(Decided { window: [from, until], noise }) => format!(
                "the pressures of all probes and surfaces were those of their chambers within their noise, at most {:.2} %, \
                 from {:.4} ms to {:.4} ms",
                100.0 * noise,
                1e3 * from,
                1e3 * until
            ),
            None => "asked for".to_owned(),
        }
    }
}

/// The largest standard error of a place's mean deviation, if all are uniform; nothing else where one is not known.
fn uniform(recent: &VecDeque<Deviations>) -> Option<f64> {
    let mut noise = 0.0f64;
    for place in 0..recent.front()?.of_places.len() {
        let (mut time, mut sum, mut known, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for row in recent {
            let length = row.window[1] - row.window[0];
            let [deviation, weight] = row.of_places[place];
            time += length;
            sum += length * deviation;
            known += weight;
            let beyond = (deviation.abs() - FLOOR).max(0.0);
            // The weight of a probe that fills its chamber is infinite.
            squares += if beyond > 0.0 { beyond * beyond * weight } else { 0.0 };
        }
        let (mean, error, rows) = (sum / time, known.sqrt().recip(), recent.len() as f64);
        let scatters = squares <= rows + STANDARD_ERRORS * (2.0 * rows).sqrt();
        if !(error.is_finite() && mean.abs() <= FLOOR + STANDARD_ERRORS * error && scatters) {
            return None;
        }
        noise = noise.max(error);
    }
    Some(noise)
}

fn deviations(plan: &Plan, known: &Known, row: &Row) -> Vec<[f64; 2]> {
    let window = row.window[1] - row.window[0];
    let probes = known.probes.iter().zip(&row.probes).map(|(&chamber, probe)| {
        let whole = &row.chambers[chamber];
        let [own, all] = [probe, whole].map(|zone| zone.particles.iter().sum::<f64>());
        let mass: f64 = whole.particles.iter().zip(&plan.gases).map(|(n, gas)| n * gas.molar_mass).sum();
        let thermal_speed = kinetics::thermal_square(whole.temperature, mass / all).sqrt();
        // Of a long window, so that short rows, which remember each other, do not count as independent.
        let variance = noise_of_zone(own, all, probe.volume, thermal_speed, LONG) * LONG / window;
        [probe.pressure / whole.pressure - 1.0, variance.recip()]
    });
    let surfaces = known.surfaces.iter().zip(&row.surfaces).map(|(faces, surface)| {
        let pressed: f64 = faces.iter().map(|face| face.area * row.chambers[face.chamber].pressure).sum();
        let area: f64 = faces.iter().map(|face| face.area).sum();
        [surface.pressure * area / pressed - 1.0, noise_of_hits(surface.hits as f64).recip()]
    });
    probes.chain(surfaces).collect()
}

/// The state that particles leave to a control volume: amounts and energy of each chamber. What is in no chamber, as in the
/// thickness of a hole, is shared out in proportion; bulk motion has become heat.
pub fn beginning(model: &Model, tallies: &Tallies, time: f64, open: Vec<bool>) -> Beginning {
    let plan = &model.plan;
    let (gases, scales) = (plan.gases.len(), Scales::new(plan));
    let zone = |zone: usize| {
        let sums = &tallies.zones[zone * gases..(zone + 1) * gases];
        let moles: Vec<f64> = sums.iter().map(|sum| sum.number as f64 * plan.moles_per_particle).collect();
        let energy: f64 = sums
            .iter()
            .zip(&plan.gases)
            .map(|(sum, gas)| {
                let mass = gas.molar_mass * plan.moles_per_particle;
                (mass * sum.kinetic as f64 + scales.reference_mass * sum.spin as f64) / scales.energy
            })
            .sum();
        (moles, energy)
    };
    let (all, energy) = zone(0);
    let alone = |there: f64, all: f64| there <= 0.0 && all > 0.0;
    let mut chambers: Vec<(Vec<f64>, f64)> = (0..plan.chambers.len()).map(|chamber| zone(chamber + 1)).collect();
    let share = |all: f64, there: f64| if there > 0.0 { all / there } else { 1.0 };
    let of_energy = share(energy, chambers.iter().map(|(_, energy)| energy).sum());
    let of_gas: Vec<f64> =
        (0..gases).map(|gas| share(all[gas], chambers.iter().map(|(moles, _)| moles[gas]).sum())).collect();
    for (moles, energy) in &mut chambers {
        moles.iter_mut().zip(&of_gas).for_each(|(moles, share)| *moles *= share);
        *energy *= of_energy;
    }
    // A gas of which all is in no chamber goes to the last, which is the space around the others.
    for gas in 0..gases {
        let there: f64 = chambers.iter().map(|(moles, _)| moles[gas]).sum();
        if let (true, Some((moles, _))) = (alone(there, all[gas]), chambers.last_mut()) {
            moles[gas] = all[gas];
        }
    }
    Beginning { time, chambers, open }
}
