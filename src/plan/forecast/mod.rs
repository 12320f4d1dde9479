//! How wrong a run will be, before it is made.
//!
//! The measure: of a pressure column of `history.csv` (chambers, surfaces, probes) the root mean square over the rows of
//! the difference to the same column of infinitely many particles, over that column's mean; of a plan that of its worst
//! column of those that the scene asks to know: its surfaces and probes, or if it has neither its chambers. (The others are
//! forecast too.) Where gas
//! is released without a wall the profile of the density counts as a column (mean |rho - exact| over fiftieths of the
//! longest edge, over the mean density). The limit of infinitely many particles is the gas in the continuum; of the method
//! `none` it is free flight.
//!
//! The parts of an error are independent, or their signs unknown: they add in quadrature. Each is a function with its
//! source in [`noise`] and [`bias`].

mod bias;
mod columns;
mod course;
pub(super) mod noise;
mod outlook;
mod rows;

pub use bias::DISCHARGE_UNKNOWN;
pub use columns::{Alternative, Cause, ColumnForecast, Forecast, Part, worst};
pub use outlook::{Modelled, Outlook, SeenHeat, SeenProbe, SeenSurface};

use super::Measured;
use super::amounts::Amounts;
use super::resolution::cell_edge;
use super::warnings::lost_events;
use crate::gas::{Collisions, FlowIntegral, Species, State, kinetics, thermo};
use crate::scene::{Method, Scene};
use course::{Course, Moment};
use rows::{Row, windows};

/// Gas on two sides of an open border is released if it differs by more than this.
const RELEASED: f64 = 1e-3;

/// A run that may be chosen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    pub method: Method,
    /// At the end of the run, as in a plan.
    pub particles: f64,
    /// n pi sigma^3 / 6 at the mean density at the end.
    pub occupancy: f64,
    pub rounds: u32,
    /// x = dt/tau of its largest step.
    pub collisions_per_step: f64,
    /// s of an interval of its largest step, the shortest row.
    pub interval: f64,
}

/// What a control volume makes of a scene's pressures, in the continuum: by row of the history, of each chamber.
pub fn pressures(
    scene: &Scene,
    measured: &Measured,
    outlook: &Outlook,
    species: &[Species],
    amounts: &Amounts,
) -> Vec<Vec<f64>> {
    let course = Course::new(scene, measured, outlook, species, amounts);
    let rows = course.solve(Collisions::Continuum);
    rows.iter().map(|row| course.group.iter().map(|&group| row[group].pressure).collect()).collect()
}

/// All that forecasts of one scene share.
pub struct Forecaster<'a> {
    scene: &'a Scene,
    measured: &'a Measured,
    outlook: &'a Outlook,
    course: Course,
    total: f64,
    /// The limit of infinitely many particles, of gas that collides; of free flight.
    limit: [Vec<Vec<State>>; 2],
    /// By row, moles that vents have let out.
    left: Vec<f64>,
}

impl<'a> Forecaster<'a> {
    pub fn new(
        scene: &'a Scene,
        measured: &'a Measured,
        outlook: &'a Outlook,
        species: &[Species],
        amounts: &Amounts,
    ) -> Forecaster<'a> {
        let course = Course::new(scene, measured, outlook, species, amounts);
        let limit = [Collisions::Continuum, Collisions::None].map(|collisions| course.solve(collisions));
        let left = left(scene, species, amounts, &course, &limit[0]);
        Forecaster { scene, measured, outlook, course, total: amounts.total(), limit, left }
    }

    /// Whether gas that differs touches without a wall: no control volume knows what it does.
    pub fn is_release(&self) -> bool {
        self.density_step() > 0.0
    }

    /// Whether chambers touch without a wall.
    pub fn has_open_borders(&self) -> bool {
        !self.outlook.borders.is_empty()
    }

    /// Largest difference of the densities of chambers that touch, over the mean; 0 if their pressures agree.
    fn density_step(&self) -> f64 {
        let density = |chamber: usize| {
            let chamber = &self.scene.chambers[chamber];
            chamber.pressure / chamber.temperature
        };
        let whole: f64 = (0..self.scene.chambers.len())
            .map(|chamber| density(chamber) * self.measured.chamber_volumes[chamber] / self.measured.gas_volume)
            .sum();
        let step = |&[a, b]: &[usize; 2]| {
            let (p, q) = (self.scene.chambers[a].pressure, self.scene.chambers[b].pressure);
            if (p / q - 1.0).abs() < RELEASED { 0.0 } else { (density(a) - density(b)).abs() / whole }
        };
        self.outlook.borders.iter().map(step).fold(0.0, f64::max)
    }

    /// Every column of a run of this candidate.
    pub fn columns(&self, candidate: &Candidate) -> Vec<ColumnForecast> {
        if candidate.method == Method::ControlVolume {
            return self.uniform_columns();
        }
        let run = Run::new(self, candidate);
        let chambers_count = self.chambers_count();
        let chambers = self.scene.chambers.iter().enumerate().map(|(index, chamber)| {
            let group = self.course.group[index];
            let noise =
                run.rms(|row| run.common(row, group) + run.part(row, group, self.measured.chamber_volumes[index]));
            ColumnForecast::new(format!("chamber {}", chamber.name), chambers_count, run.parts(noise, &[(group, 1.0)]))
        });
        let surfaces = self.scene.surfaces.iter().zip(&self.outlook.surfaces).map(|(surface, seen)| {
            let area: f64 = seen.faces.iter().map(|face| face.1).sum();
            let faces: Vec<(usize, f64)> =
                seen.faces.iter().map(|&(chamber, own)| (self.course.group[chamber], own / area)).collect();
            let noise = run.rms(|row| {
                let of_face = |&(group, share): &(usize, f64)| {
                    let variance = run.common(row, group) + run.wall(row, group, share * area, seen.whole);
                    share * share * run.weight(row, group) * variance
                };
                faces.iter().map(of_face).sum()
            });
            ColumnForecast::new(format!("surface {}", surface.name), true, run.parts(noise, &faces))
        });
        let probes = self.scene.probes.iter().zip(&self.outlook.probes).map(|(probe, seen)| {
            let group = self.course.group[seen.chamber];
            let noise =
                run.rms(|row| run.weight(row, group) * (run.common(row, group) + run.part(row, group, seen.volume)));
            ColumnForecast::new(format!("probe {}", probe.name), true, run.parts(noise, &[(group, 1.0)]))
        });
        let mut columns: Vec<ColumnForecast> = chambers.chain(surfaces).chain(probes).collect();
        let step = self.density_step();
        if step > 0.0 && candidate.method != Method::None {
            let spacing = libm::cbrt(self.measured.gas_volume / candidate.particles);
            let longest = (0..3).map(|k| self.measured.bounds_max[k] - self.measured.bounds_min[k]).fold(0.0, f64::max);
            let path = bias::effective_path(candidate.method, candidate.occupancy) * spacing / longest;
            // What was measured of the others has their noise in it, which is less than half of it.
            let noise = if candidate.method == Method::HalfTurn { noise::of_profile(candidate.particles) } else { 0.0 };
            let parts = vec![(Cause::Noise, noise), (Cause::Fronts, bias::of_fronts(path, step))];
            columns.push(ColumnForecast::new("profile".into(), true, parts));
        }
        columns
    }

    /// Of a group, by its first chamber.
    fn modelled(&self, group: usize) -> Modelled {
        let first = self.course.group.iter().position(|&own| own == group);
        first.and_then(|chamber| self.outlook.modelled.get(chamber).copied()).unwrap_or_default()
    }

    /// Chambers are what a scene asks to know that says nothing else.
    fn chambers_count(&self) -> bool {
        self.scene.surfaces.is_empty() && self.scene.probes.is_empty()
    }

    fn uniform_columns(&self) -> Vec<ColumnForecast> {
        let (course, limit) = (&self.course, &self.limit[0]);
        let moments = course.moments(limit);
        let coefficients = bias::of_coefficients(course, limit);
        let chambers_count = self.chambers_count();
        let rms = |of_row: &dyn Fn(usize) -> f64| {
            ((0..limit.len()).map(|row| of_row(row).powi(2)).sum::<f64>() / limit.len() as f64).sqrt()
        };
        let local = |name: String, group: usize, area: f64| {
            let mean = moments.iter().map(|row| row[group].pressure).sum::<f64>() / moments.len() as f64;
            let jets = rms(&|row| bias::thrust(course, &moments, row, group) / (mean * area));
            let transit =
                rms(&|row| bias::of_transit(course, &moments, row, group) * moments[row][group].pressure / mean);
            let parts =
                vec![(Cause::Coefficients, coefficients[group]), (Cause::Transit, transit), (Cause::Jets, jets)];
            ColumnForecast::new(name, true, parts)
        };
        let chambers = self.scene.chambers.iter().enumerate().map(|(index, chamber)| {
            let group = course.group[index];
            // Energy of motion in flight, half the thrust over the length of the group, is no pressure yet.
            let area = libm::pow(course.volumes[group], 2.0 / 3.0);
            let mean = moments.iter().map(|row| row[group].pressure).sum::<f64>() / moments.len() as f64;
            let jets = rms(&|row| {
                let here = &moments[row][group];
                0.5 * (here.gamma() - 1.0) * bias::thrust(course, &moments, row, group) / (mean * area)
            });
            let parts = vec![(Cause::Coefficients, coefficients[group]), (Cause::Jets, jets)];
            ColumnForecast::new(format!("chamber {}", chamber.name), chambers_count, parts)
        });
        let surfaces = self.scene.surfaces.iter().zip(&self.outlook.surfaces).filter_map(|(surface, seen)| {
            let area: f64 = seen.faces.iter().map(|face| face.1).sum();
            let most = seen.faces.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
            Some(local(format!("surface {}", surface.name), course.group[most.0], area))
        });
        let probes = self.scene.probes.iter().zip(&self.outlook.probes).map(|(probe, seen)| {
            let area = libm::pow(seen.volume, 2.0 / 3.0);
            local(format!("probe {}", probe.name), course.group[seen.chamber], area)
        });
        chambers.chain(surfaces).chain(probes).collect()
    }
}

/// Moles that have left through vents till each row.
fn left(scene: &Scene, species: &[Species], amounts: &Amounts, course: &Course, states: &[Vec<State>]) -> Vec<f64> {
    let entered = |time: f64| -> f64 {
        let of_orifice = |orifice: &crate::scene::Orifice| {
            FlowIntegral::new(&orifice.mass_flow, time).total() / thermo::molar_mass(&orifice.mixture, species)
        };
        scene.orifices.iter().map(of_orifice).sum()
    };
    let rows = course.times.iter().zip(states).map(|(time, groups)| {
        let here: f64 = groups.iter().flat_map(|state| &state.moles).sum();
        (amounts.initial_total() + entered(*time) - here).max(0.0)
    });
    if scene.vents.is_empty() { vec![0.0; states.len()] } else { rows.collect() }
}

/// A candidate's run: the course that its holes give, and the scatter about it.
struct Run<'a> {
    forecaster: &'a Forecaster<'a>,
    moments: Vec<Vec<Moment>>,
    /// By group, relative.
    holes: Vec<f64>,
    method: Method,
    diameter: f64,
    occupancy: f64,
    /// Share of collisions.
    lost: f64,
    collision_number: f64,
    /// s in which energy between translation and spin is forgotten, where that follows from no collision time.
    spin_memory: Option<f64>,
    moles_per_particle: f64,
    /// The lengths of its rows, s, and their shares of all rows: they are of whole intervals, the last of what is left.
    windows: Vec<(f64, f64)>,
}

impl<'a> Run<'a> {
    fn new(forecaster: &'a Forecaster<'a>, candidate: &Candidate) -> Run<'a> {
        let Candidate { method, particles, occupancy, rounds, collisions_per_step, interval } = *candidate;
        let course = &forecaster.course;
        let density = particles / forecaster.measured.gas_volume;
        let moles_per_particle = forecaster.total / particles;
        let limit = &forecaster.limit[usize::from(method == Method::None)];
        let unchanged = method == Method::None || course.control.openings.is_empty();
        let (states, holes) = if unchanged {
            (None, vec![0.0; course.volumes.len()])
        } else {
            let diameter = kinetics::diameter(density, occupancy);
            let cell = (method == Method::Cell).then(|| cell_edge(density, diameter));
            // Measured biases belong to the diameter of the mean gas.
            let states = course.solve(match method {
                Method::HalfTurn => Collisions::Spacings { paths: kinetics::HALF_TURN_PATHS, moles_per_particle },
                _ => Collisions::Particles { diameter, cap: None, cell, moles_per_particle },
            });
            let holes = bias::differences(&states, limit);
            (Some(states), holes)
        };
        Run {
            forecaster,
            moments: course.moments(states.as_ref().unwrap_or(limit)),
            holes,
            method,
            diameter: match method {
                Method::None => 0.0,
                // That of the mean free path of the mean gas.
                Method::HalfTurn => kinetics::diameter_of_path(
                    density,
                    bias::effective_path(method, occupancy) * kinetics::mean_spacing(density),
                ),
                _ => kinetics::diameter(density, occupancy),
            },
            occupancy,
            lost: if method.has_rounds() { lost_events(collisions_per_step, rounds) } else { 0.0 },
            collision_number: forecaster.scene.model.collision_number.unwrap_or(5.0),
            spin_memory: (method == Method::HalfTurn).then_some(noise::HALF_TURN_MEMORY * interval),
            moles_per_particle,
            windows: windows(forecaster.scene.end_time, course.window, interval),
        }
    }

    /// Root of the mean over the rows of a variance.
    fn rms(&self, variance: impl Fn(Row) -> f64) -> f64 {
        let rows = self.moments.len();
        let of = |&(window, share): &(f64, f64)| {
            share * (0..rows).map(|index| variance(Row { index, window })).sum::<f64>() / rows as f64
        };
        self.windows.iter().filter(|(_, share)| *share > 0.0).map(of).sum::<f64>().sqrt()
    }

    /// From a variance over the square of a row's pressure to one over that of the mean pressure.
    fn weight(&self, row: Row, group: usize) -> f64 {
        let mean = self.moments.iter().map(|groups| groups[group].pressure).sum::<f64>() / self.moments.len() as f64;
        (self.moments[row.index][group].pressure / mean).powi(2)
    }

    /// The parts of a column that sees groups in these shares.
    fn parts(&self, noise: f64, shares: &[(usize, f64)]) -> Vec<(Cause, f64)> {
        let mean = |of: &dyn Fn(usize) -> f64| shares.iter().map(|&(group, share)| share * of(group)).sum::<f64>();
        let last = self.moments.len() - 1;
        let rigid =
            if self.method == Method::HardSphere { kinetics::rigid_compressibility(self.occupancy) - 1.0 } else { 0.0 };
        vec![
            (Cause::Noise, noise),
            (Cause::Holes, mean(&|group| self.holes[group])),
            (Cause::LostCollisions, mean(&|group| bias::of_lost(self.lost, self.moments[last][group].spin_dof))),
            (Cause::RigidSpheres, rigid),
            (Cause::LeftOut, mean(&|group| self.forecaster.modelled(group).left_out)),
            (Cause::Coefficients, mean(&|group| self.forecaster.modelled(group).coefficients)),
        ]
    }

    fn particles(&self, row: Row, group: usize) -> f64 {
        self.moments[row.index][group].moles / self.moles_per_particle
    }

    fn collision_time(&self, row: Row, group: usize) -> f64 {
        let density = self.particles(row, group) / self.forecaster.course.volumes[group];
        kinetics::collision_time(density, self.diameter, self.moments[row.index][group].thermal_square)
    }

    /// Of all gas of a group.
    fn common(&self, row: Row, group: usize) -> f64 {
        let Forecaster { course, left, .. } = self.forecaster;
        let (here, particles) = (&self.moments[row.index][group], self.particles(row, group));
        let (time, window, volume) = (course.times[row.index], row.window, course.volumes[group]);
        let all: f64 = (0..course.volumes.len()).map(|other| self.particles(row, other)).sum();
        let mean_speed = kinetics::mean_speed(here.thermal_square);
        let touching = course.control.openings.iter().filter(|opening| opening.between.contains(&group));
        let exchanged = |opening: &crate::scene::Opening| {
            let [a, b] = opening.between.map(|group| course.volumes[group]);
            0.25 * mean_speed * opening.area * (1.0 / a + 1.0 / b)
        };
        let rate: f64 = touching.map(exchanged).sum();
        let relaxation = self.collision_number * self.collision_time(row, group) / (1.0 + here.spin_dof / 3.0);
        let memory = self.spin_memory.unwrap_or(relaxation);
        let at_start = |group: usize| course.initial[group].moles.iter().sum::<f64>() / self.moles_per_particle;
        let numbers = noise::Exchange {
            here: particles,
            all,
            here_at_start: at_start(group),
            all_at_start: (0..course.volumes.len()).map(at_start).sum(),
            share: volume / course.volumes.iter().sum::<f64>(),
        };
        let factor = if self.method == Method::None { 5.0 / 3.0 } else { here.gamma() };
        let (moles, spin_dof) = (here.moles, here.spin_dof);
        let gas = noise::HeatedGas { volume, moles, spin_dof, thermal_speed: here.thermal_speed() };
        let walls = course.control.walls.iter().filter(|wall| wall.chamber == group);
        let heat = walls.map(|wall| noise::heat_rate(wall.heat.transfer, wall.area, &gas));
        let vents = course.control.vents.iter().filter(|vent| vent.chamber == group).count() as f64;
        let share = vents / course.control.vents.len().max(1) as f64;
        noise::of_spin(particles, here.spin_dof, memory, time, window)
            + noise::of_exchange(&numbers, factor, rate, time, window)
            + noise::of_vents(share * left[row.index] / self.moles_per_particle, particles, here.spin_dof)
            + noise::of_heat(particles, here.spin_dof, heat.sum(), time, window)
    }

    /// Of a part of a group's space.
    fn part(&self, row: Row, group: usize, volume: f64) -> f64 {
        let course = &self.forecaster.course;
        let share = (volume / course.volumes[group]).min(1.0);
        let all = self.particles(row, group);
        noise::of_zone(share * all, all, volume, self.moments[row.index][group].thermal_speed(), row.window)
    }

    /// Of a wall of a group.
    fn wall(&self, row: Row, group: usize, area: f64, whole: bool) -> f64 {
        let course = &self.forecaster.course;
        let (here, particles) = (&self.moments[row.index][group], self.particles(row, group));
        let depth = course.volumes[group] / area;
        let hits = 0.25 * particles / depth * kinetics::mean_speed(here.thermal_square) * row.window;
        let face = noise::of_face(whole, depth, here.thermal_speed(), row.window, particles);
        let axis = if whole { 0.0 } else { noise::of_axis(particles, self.collision_time(row, group), row.window) };
        noise::of_hits(hits).min(face + axis)
    }
}
