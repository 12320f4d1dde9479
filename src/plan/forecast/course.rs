//! The course of the run in a control volume: what the chambers go through, before any particle.
//!
//! Chambers that touch without a wall are one here. Equations and integration are those of [`ControlVolume`]; the
//! limit of infinitely many particles has its holes in the continuum (or, of free flight, in the kinetic limit), a run
//! of particles has them at the Knudsen number of the particles (docs/explanation/method.md, "Openings").

use super::outlook::Outlook;
use crate::gas::{Collisions, ControlVolume, HeatedWall, OpenVent, Reservoir, Source, Species, State, thermo};
use crate::plan::Measured;
use crate::plan::amounts::Amounts;
use crate::plan::population::openings;
use crate::scene::{GAS_CONSTANT, Opening, Scene};

/// Means over the rows are taken over so many at most: a solution costs as much as the times it is wanted at.
const MOST_TIMES: u32 = 2000;

/// Groups of chambers, and what flows between them.
#[derive(Debug, Clone)]
pub struct Course {
    /// The group of each chamber.
    pub group: Vec<usize>,
    /// m3 of each group.
    pub volumes: Vec<f64>,
    pub control: ControlVolume,
    pub initial: Vec<Reservoir>,
    /// Middles of the rows of the history, s; of very many rows those of as many equal stretches as [`MOST_TIMES`].
    pub times: Vec<f64>,
    /// Of a row, s.
    pub window: f64,
}

/// A group in a row, as the noise needs it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// Pa.
    pub pressure: f64,
    /// K.
    pub temperature: f64,
    /// mol of all gases.
    pub moles: f64,
    /// kT/m of the mean gas, m2/s2.
    pub thermal_square: f64,
    /// Internal degrees of freedom of the mean gas.
    pub spin_dof: f64,
}

impl Moment {
    pub fn gamma(&self) -> f64 {
        (5.0 + self.spin_dof) / (3.0 + self.spin_dof)
    }

    /// sqrt(kT/m), m/s.
    pub fn thermal_speed(&self) -> f64 {
        self.thermal_square.sqrt()
    }
}

impl Course {
    pub fn new(
        scene: &Scene,
        measured: &Measured,
        outlook: &Outlook,
        species: &[Species],
        amounts: &Amounts,
    ) -> Course {
        let group = groups(scene.chambers.len(), &outlook.borders);
        let count = group.iter().max().map_or(0, |last| last + 1);
        let mut volumes = vec![0.0; count];
        let mut moles = vec![vec![0.0; species.len()]; count];
        let mut energies = vec![0.0; count];
        for (index, chamber) in scene.chambers.iter().enumerate() {
            let own = group[index];
            volumes[own] += measured.chamber_volumes[index];
            energies[own] += thermo::energy(&amounts.initial[index], species, chamber.temperature);
            for (sum, amount) in moles[own].iter_mut().zip(&amounts.initial[index]) {
                *sum += amount;
            }
        }
        let reservoirs = moles.into_iter().zip(&energies);
        let initial = reservoirs
            .map(|(moles, energy)| Reservoir { temperature: thermo::temperature(&moles, species, *energy), moles })
            .collect();
        let between = |opening: &Opening| opening.between.map(|chamber| group[chamber]);
        let control = ControlVolume {
            gases: species.to_vec(),
            volumes: volumes.clone(),
            sources: sources(scene, outlook, &group),
            openings: openings(scene, measured)
                .filter(|opening| between(opening)[0] != between(opening)[1])
                .map(|opening| Opening { between: between(opening), ..opening.clone() })
                .collect(),
            walls: heated(scene, outlook, &group),
            vents: vents(scene, measured, &group),
            // Scenes with walls that move are refused before.
            swept: Vec::new(),
            collisions: Collisions::Continuum,
        };
        let rows = scene.output.rows.max(1);
        let window = scene.end_time / f64::from(rows);
        let times = times(scene.end_time, rows);
        Course { group, volumes, control, initial, times, window }
    }

    /// The groups in every row, with holes as `collisions` has them. Outer index: row.
    pub fn solve(&self, collisions: Collisions) -> Vec<Vec<State>> {
        ControlVolume { collisions, ..self.control.clone() }.solve(&self.initial, &self.times)
    }

    /// The same with every hole `factor` times as large, in the continuum.
    pub fn with_holes_of(&self, factor: f64) -> Vec<Vec<State>> {
        let mut control = self.control.clone();
        control.openings.iter_mut().for_each(|opening| opening.area *= factor);
        control.solve(&self.initial, &self.times)
    }

    pub fn moments(&self, states: &[Vec<State>]) -> Vec<Vec<Moment>> {
        states.iter().map(|row| row.iter().map(|state| self.moment(state)).collect()).collect()
    }

    fn moment(&self, state: &State) -> Moment {
        let moles: f64 = state.moles.iter().sum();
        let gases = &self.control.gases;
        let mass: f64 = state.moles.iter().zip(gases).map(|(n, gas)| n * gas.molar_mass).sum();
        let capacity = thermo::heat_capacity(&state.moles, gases, state.temperature);
        Moment {
            pressure: state.pressure,
            temperature: state.temperature,
            moles,
            thermal_square: GAS_CONSTANT * state.temperature * moles / mass,
            spin_dof: (2.0 * capacity / (moles * GAS_CONSTANT) - 3.0).max(0.0),
        }
    }
}

/// The group of each chamber, numbered in the order of their first chambers.
fn groups(chambers: usize, borders: &[[usize; 2]]) -> Vec<usize> {
    let mut first: Vec<usize> = (0..chambers).collect();
    // As often as a chain of chambers can be long.
    for _ in 0..chambers {
        for &[a, b] in borders {
            let least = first[a].min(first[b]);
            (first[a], first[b]) = (least, least);
        }
    }
    let mut names: Vec<usize> = first.clone();
    names.sort_unstable();
    names.dedup();
    first.iter().map(|own| names.iter().position(|name| name == own).unwrap_or(0)).collect()
}

fn sources(scene: &Scene, outlook: &Outlook, group: &[usize]) -> Vec<Source> {
    let orifices = scene.orifices.iter().zip(&outlook.sources);
    orifices
        .filter_map(|(orifice, chamber)| Some(Source { chamber: group[(*chamber)?], orifice: orifice.clone() }))
        .collect()
}

fn heated(scene: &Scene, outlook: &Outlook, group: &[usize]) -> Vec<HeatedWall> {
    let walls = outlook.heated.iter().filter_map(|seen| {
        let heat = scene.surface_model(seen.surface).heat?;
        Some(HeatedWall { chamber: group[seen.chamber], area: seen.area, heat })
    });
    walls.collect()
}

fn vents(scene: &Scene, measured: &Measured, group: &[usize]) -> Vec<OpenVent> {
    let places = scene.vents.iter().zip(&measured.vents);
    let open = places.map(|(vent, place)| OpenVent {
        chamber: group[place.chamber],
        area: vent.area.unwrap_or(place.area),
        vent: vent.clone(),
        behind: None,
    });
    open.collect()
}

/// The middles of the rows, or of as many equal stretches as there may be times, s.
fn times(end_time: f64, rows: u32) -> Vec<f64> {
    let count = rows.min(MOST_TIMES);
    (0..count).map(|k| end_time * (f64::from(k) + 0.5) / f64::from(count)).collect()
}

#[cfg(test)]
mod tests {
    use super::{MOST_TIMES, groups, times};

    #[test]
    fn many_rows_are_few_times() {
        assert_eq!(times(2.0, 4), [0.25, 0.75, 1.25, 1.75]);
        let few = times(1.0, 1_000_000);
        assert_eq!(few.len(), MOST_TIMES as usize);
        assert!((few.iter().sum::<f64>() / f64::from(MOST_TIMES) - 0.5).abs() < 1e-12);
    }

    #[test]
    fn chambers_that_touch_are_one() {
        assert_eq!(groups(4, &[]), [0, 1, 2, 3]);
        assert_eq!(groups(5, &[[3, 4], [1, 3]]), [0, 1, 2, 1, 1]);
    }
}
