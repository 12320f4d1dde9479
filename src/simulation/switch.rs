//! When a run of particles goes on as a control volume (specification, section 6, point 5: right where pressures are
//! uniform), and with what.
//!
//! Uniform are pressures that differ from that of their chamber by no more than noise: over the time asked for, the mean
//! deviation of every probe and surface is within three standard errors, those of hits on the surface and of what wanders in
//! and out of the probe. Decided by rows of the history, which are the same on any number of ranks.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::gas::{Beginning, kinetics};
use crate::plan::{Plan, noise_of_hits, noise_of_zone};
use crate::scene::Switch;
use crate::subdomain::{Scales, Tallies};

use super::SimulationError;
use super::averages::Row;
use super::model::Model;
use super::uniform::Known;

const STANDARD_ERRORS: f64 = 3.0;

/// What a row knows of uniformity.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Deviations {
    pub window: [f64; 2],
    /// Of each probe, then of each surface: how far the pressure is from that of the chamber, relative, and its variance.
    pub of_places: Vec<[f64; 2]>,
}

/// What it remembers of the rows, oldest first.
pub type SwitchState = Vec<Deviations>;

pub struct Switching<'a> {
    model: &'a Model,
    /// `None` in a run that stays one of particles.
    asked: Option<(Switch, Known)>,
    recent: VecDeque<Deviations>,
}

impl<'a> Switching<'a> {
    /// # Errors
    /// If the run is to switch, and a probe or a surface lies in no chamber.
    pub fn new(model: &'a Model) -> Result<Switching<'a>, SimulationError> {
        let asked = model.scene.model.switch.map(|switch| Ok::<_, SimulationError>((switch, Known::of(model)?)));
        Ok(Switching { model, asked: asked.transpose()?, recent: VecDeque::new() })
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

    pub fn state(&self) -> SwitchState {
        self.recent.iter().cloned().collect()
    }

    pub fn restore(&mut self, state: &SwitchState) {
        self.recent = state.iter().cloned().collect();
    }

    /// Takes a row in, and says whether the pressures have been uniform for as long as was asked.
    pub fn row(&mut self, row: &Row) -> bool {
        let Some((Switch::WhenUniform { lasting }, known)) = &self.asked else { return false };
        let lasting = *lasting;
        let of_places = deviations(&self.model.plan, known, row);
        self.recent.push_back(Deviations { window: row.window, of_places });
        let reaches = |recent: &VecDeque<Deviations>, from: usize| {
            recent.get(from).is_some_and(|first| row.window[1] - first.window[0] >= lasting * (1.0 - 1e-9))
        };
        while reaches(&self.recent, 1) {
            self.recent.pop_front();
        }
        reaches(&self.recent, 0) && self.excess().is_some_and(|excess| excess <= 1.0)
    }

    /// The largest mean deviation over what noise allows; none without places.
    fn excess(&self) -> Option<f64> {
        self.means()
            .map(|[mean, error]| mean.abs() / (STANDARD_ERRORS * error))
            .reduce(|a, b| if a >= b { a } else { b })
    }

    /// Mean deviation of each place and its standard error; NaN where one is not known.
    fn means(&self) -> impl Iterator<Item = [f64; 2]> {
        let places = self.recent.front().map_or(0, |row| row.of_places.len());
        (0..places).map(|place| {
            let (mut time, mut sum, mut variance) = (0.0, 0.0, 0.0);
            for row in &self.recent {
                let length = row.window[1] - row.window[0];
                let [deviation, own] = row.of_places[place];
                time += length;
                sum += length * deviation;
                variance += length * length * own;
            }
            [sum / time, variance.sqrt() / time]
        })
    }

    /// Why the run goes on without particles from `time` (s) on.
    pub fn why(&self, time: f64) -> String {
        match self.asked {
            Some((Switch::WhenUniform { .. }, _)) => {
                let from = self.recent.front().map_or(0.0, |row| row.window[0]);
                let noise = self.means().map(|[_, error]| error).fold(0.0, f64::max);
                format!(
                    "the pressures of all probes and surfaces were those of their chambers within their noise, at most \
                     {:.2} %, from {:.4} ms to {:.4} ms",
                    100.0 * noise,
                    1e3 * from,
                    1e3 * time
                )
            }
            _ => "asked for".to_owned(),
        }
    }
}

fn deviations(plan: &Plan, known: &Known, row: &Row) -> Vec<[f64; 2]> {
    let window = row.window[1] - row.window[0];
    let probes = known.probes.iter().zip(&row.probes).map(|(&chamber, probe)| {
        let whole = &row.chambers[chamber];
        let [own, all] = [probe, whole].map(|zone| zone.particles.iter().sum::<f64>());
        let mass: f64 = whole.particles.iter().zip(&plan.gases).map(|(n, gas)| n * gas.molar_mass).sum();
        let thermal_speed = kinetics::thermal_square(whole.temperature, mass / all).sqrt();
        let variance = noise_of_zone(own, all, probe.volume, thermal_speed, window);
        [probe.pressure / whole.pressure - 1.0, variance]
    });
    let surfaces = known.surfaces.iter().zip(&row.surfaces).map(|(faces, surface)| {
        let pressed: f64 = faces.iter().map(|face| face.area * row.chambers[face.chamber].pressure).sum();
        let area: f64 = faces.iter().map(|face| face.area).sum();
        [surface.pressure * area / pressed - 1.0, noise_of_hits(surface.hits as f64)]
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
    let mut chambers: Vec<(Vec<f64>, f64)> = (0..plan.chambers.len()).map(|chamber| zone(chamber + 1)).collect();
    let share = |all: f64, there: f64| if there > 0.0 { all / there } else { 1.0 };
    let of_energy = share(energy, chambers.iter().map(|(_, energy)| energy).sum());
    let of_gas: Vec<f64> =
        (0..gases).map(|gas| share(all[gas], chambers.iter().map(|(moles, _)| moles[gas]).sum())).collect();
    for (moles, energy) in &mut chambers {
        moles.iter_mut().zip(&of_gas).for_each(|(moles, share)| *moles *= share);
        *energy *= of_energy;
    }
    Beginning { time, chambers, open }
}
