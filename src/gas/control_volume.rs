//! The control-volume (0-D) reference: uniform chambers, the curves of the orifices, the holes between.
//!
//! Per chamber: dn_g/dt = inflow + net flow through openings, dU/dt = inflow x h + energy through openings,
//! and -p dV/dt of walls that move, with U = sum n u(T) and p V = n R T; openings by [`discharge`](super::discharge) at the local Knudsen
//! number Kn = lambda / length, lambda from the number density of *particles* (moles / V / nu) on the
//! upstream side: times what makes them more viscous than by it: the reference of what the run itself models (a run that is itself a control volume has Kn = 0). So that nothing jumps where two pressures
//! cross, the two densities are blended while the pressures differ by less than 2 %.
//!
//! Integrated with the classical Runge-Kutta method (RK4), each step against two halves of it, between
//! the kinks of all curves. Invariant: Runge-Kutta keeps linear invariants, and its quadrature is exact for a
//! product of two linear curves, so moles and U = U0 + integral h dm hold to rounding at any step (of gases with
//! constant heat capacities; else, where a temperature of inflow changes, within the tolerance).

use super::curve::{value_held, value_inside};
use super::discharge::{Side, exchange};
use super::{Species, Swept, bends, kinetics, thermo};
use crate::scene::{GAS_CONSTANT, Opening, Orifice, Vent, VentFlow, WallHeat};

/// Error of a step over the chamber's moles or energy.
const TOLERANCE: f64 = 1e-10;
/// The smallest step as a fraction of the stretch between two kinks or output times.
const LEAST_STEP: f64 = 1e-7;
/// Unknowns of a vent.
const VENTED: usize = 3;
const BLENDED_DIFFERENCE: f64 = 0.02;

/// Chambers, what flows into them and what connects them.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlVolume {
    pub gases: Vec<Species>,
    /// m3, by chamber.
    pub volumes: Vec<f64>,
    pub sources: Vec<Source>,
    pub openings: Vec<Opening>,
    pub walls: Vec<HeatedWall>,
    pub vents: Vec<OpenVent>,
    /// What walls that move do to the volumes.
    pub swept: Vec<Swept>,
    pub collisions: Collisions,
}

/// An orifice and the chamber it blows into.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    pub chamber: usize,
    pub orifice: Orifice,
}

/// What decides the Knudsen numbers of holes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Collisions {
    /// Every hole is in the kinetic limit.
    None,
    /// Those of particles of a diameter (m) and an amount (mol).
    /// `cap`: the diameter is at most so many mean spacings of the gas. `cell`: they collide within cells of this edge, m, and are
    /// the more viscous to a hole ([`kinetics::viscosity_of_cells`]); else where they crowd ([`kinetics::viscosity_of_crowds`]).
    Particles { diameter: f64, cap: Option<f64>, cell: Option<f64>, moles_per_particle: f64 },
    /// Those within cells of the same number of particles everywhere: a hole acts on them as on a mean free path of so many mean spacings, into
    /// vacuum and by small differences of pressure.
    Spacings { paths: [f64; 2], moles_per_particle: f64 },
    /// Every hole is in the continuum limit: the gas itself, whose mean free path no vessel sees.
    Continuum,
}

/// The part of a wall in one chamber that exchanges heat.
#[derive(Debug, Clone, PartialEq)]
pub struct HeatedWall {
    pub chamber: usize,
    /// m2.
    pub area: f64,
    pub heat: WallHeat,
}

/// A vent, the chamber that it empties, and its area, m2.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenVent {
    pub chamber: usize,
    pub area: f64,
    pub vent: Vent,
    /// The chamber whose gas is behind it, in place of its external pressure.
    pub behind: Option<usize>,
}

/// Contents of a chamber at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Reservoir {
    /// By gas.
    pub moles: Vec<f64>,
    /// K.
    pub temperature: f64,
}

/// Where an integration starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Beginning {
    /// s.
    pub time: f64,
    /// Moles by gas and internal energy (J) of each chamber.
    pub chambers: Vec<(Vec<f64>, f64)>,
    /// Of each vent that opens at a pressure: whether it has.
    pub open: Vec<bool>,
}

/// A chamber at one time.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// Pa.
    pub pressure: f64,
    /// K.
    pub temperature: f64,
    /// By gas.
    pub moles: Vec<f64>,
    /// Internal energy, J.
    pub energy: f64,
}

/// What has left the chambers since the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Lost {
    /// J, to each of the walls.
    pub heat: Vec<f64>,
    /// Through each of the vents.
    pub vented: Vec<Vented>,
}

/// Through a vent since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Vented {
    /// kg.
    pub mass: f64,
    /// J.
    pub enthalpy: f64,
    /// kg that isentropic flow through its area would have been, open or not.
    pub isentropic: f64,
}

/// A stretch of time without kinks, s.
struct SmoothSpan {
    start: f64,
    end: f64,
    /// Whether each source flows in it.
    flowing: Vec<bool>,
}

impl ControlVolume {
    /// The chambers at each of `times` (s, from 0, in order), starting from `initial` (one per chamber) at
    /// time 0. Outer index: time.
    pub fn solve(&self, initial: &[Reservoir], times: &[f64]) -> Vec<Vec<State>> {
        self.solve_with_losses(initial, times).into_iter().map(|(states, _)| states).collect()
    }

    /// As [`ControlVolume::solve`], and what has left until then.
    pub fn solve_with_losses(&self, initial: &[Reservoir], times: &[f64]) -> Vec<(Vec<State>, Lost)> {
        let chamber = |reservoir: &Reservoir| {
            (reservoir.moles.clone(), thermo::energy(&reservoir.moles, &self.gases, reservoir.temperature))
        };
        let chambers = initial.iter().map(chamber).collect();
        self.solve_from(&Beginning { time: 0.0, chambers, open: vec![false; self.vents.len()] }, times)
    }

    /// From a later state on; `times` are not before it, and what has left is counted from there.
    pub fn solve_from(&self, beginning: &Beginning, times: &[f64]) -> Vec<(Vec<State>, Lost)> {
        let mut contents = Vec::new();
        for (moles, energy) in &beginning.chambers {
            contents.extend_from_slice(moles);
            contents.push(*energy);
        }
        contents.resize(self.lost_at() + self.walls.len() + VENTED * self.vents.len(), 0.0);
        let mut kinks = self.kinks();
        kinks.extend_from_slice(times);
        kinks.sort_by(f64::total_cmp);
        kinks.dedup();
        let mut kinks = kinks.into_iter().filter(|&t| t > beginning.time).peekable();
        let mut now = beginning.time;
        let mut step = f64::INFINITY;
        let mut open = beginning.open.clone();
        let mut states = Vec::with_capacity(times.len());
        for &time in times {
            while let Some(end) = kinks.next_if(|&kink| kink <= time) {
                self.advance(&mut contents, [now, end], &mut step, &mut open);
                now = end;
            }
            let chambers = (0..self.volumes.len()).map(|chamber| self.state(&contents, chamber, time)).collect();
            states.push((chambers, self.lost(&contents)));
        }
        states
    }

    /// Where what has left is in the vector of unknowns: the heat to each wall, then mass, enthalpy and isentropic mass of
    /// each vent.
    fn lost_at(&self) -> usize {
        self.volumes.len() * self.stride()
    }

    fn lost(&self, contents: &[f64]) -> Lost {
        let (heat, vented) = contents[self.lost_at()..].split_at(self.walls.len());
        let vented =
            vented.chunks_exact(VENTED).map(|own| Vented { mass: own[0], enthalpy: own[1], isentropic: own[2] });
        Lost { heat: heat.to_vec(), vented: vented.collect() }
    }

    /// Numbers per chamber in the vector of unknowns: moles of each gas, then U.
    fn stride(&self) -> usize {
        self.gases.len() + 1
    }

    /// Positive times at which a curve bends or ends.
    fn kinks(&self) -> Vec<f64> {
        let curves = self.sources.iter().flat_map(|s| [&s.orifice.mass_flow, &s.orifice.temperature]);
        let vents = self.vents.iter().filter_map(|open| match &open.vent.flow {
            VentFlow::Discharge(curve) => Some(curve),
            VentFlow::DischargeByPressure(_) | VentFlow::LeakVelocity(_) => None,
        });
        let moving = self.swept.iter().flat_map(|swept| bends(&swept.course));
        curves.chain(vents).flat_map(|curve| &curve.points).map(|point| point[0]).chain(moving).collect()
    }

    /// m3.
    pub fn volume(&self, chamber: usize, time: f64) -> f64 {
        self.swept.iter().fold(self.volumes[chamber], |volume, swept| volume + swept.change(chamber, time))
    }

    fn side<'a>(&self, contents: &'a [f64], chamber: usize, time: f64) -> Side<'a> {
        let own = &contents[chamber * self.stride()..(chamber + 1) * self.stride()];
        let (moles, energy) = own.split_at(self.gases.len());
        let temperature = thermo::temperature(moles, &self.gases, energy[0]);
        Side { moles, volume: self.volume(chamber, time), temperature }
    }

    fn state(&self, contents: &[f64], chamber: usize, time: f64) -> State {
        let side = self.side(contents, chamber, time);
        let energy = contents[(chamber + 1) * self.stride() - 1];
        State { pressure: side.pressure(), temperature: side.temperature, moles: side.moles.to_vec(), energy }
    }

    /// Integrates over a stretch without kinks; `step` is the step to try, kept from stretch to stretch.
    /// A vent opens between two steps, of which the one before is so short that it is at most [`LEAST_STEP`] of the stretch late.
    fn advance(&self, contents: &mut Vec<f64>, [start, end]: [f64; 2], step: &mut f64, open: &mut [bool]) {
        let flows = |source: &Source| value_inside(&source.orifice.mass_flow, 0.5 * (start + end)) > 0.0;
        let span = SmoothSpan { start, end, flowing: self.sources.iter().map(flows).collect() };
        let least = LEAST_STEP * (end - start);
        let mut now = start;
        while now < end {
            let last = *step >= end - now;
            let tried = if last { end - now } else { *step };
            self.open_vents(now, contents, open);
            let rate = |time: f64, y: &[f64]| self.rate(time, y, open, &span);
            let whole = runge_kutta(contents, now, tried, &rate);
            let half = runge_kutta(contents, now, 0.5 * tried, &rate);
            let halves = runge_kutta(&half, now + 0.5 * tried, 0.5 * tried, &rate);
            let error = self.error(&whole, &halves) / (15.0 * TOLERANCE);
            if error <= 1.0 && tried > least && self.opens_any(now + tried, &halves, open) {
                *step = 0.5 * tried;
                continue;
            }
            if error <= 1.0 || tried <= least {
                *contents = halves;
                now = if last { end } else { now + tried };
            }
            // A NaN (a step so long that a chamber ran empty) compares false everywhere and shrinks the step.
            let factor = if error > 0.0 {
                0.9 * libm::pow(error, -0.2)
            } else if error == 0.0 {
                4.0
            } else {
                0.1
            };
            if !(last && error <= 1.0) || factor < 1.0 {
                *step = (tried * factor.clamp(0.1, 4.0)).max(least);
            }
        }
    }

    /// Largest difference over the chamber's total moles or energy.
    fn error(&self, a: &[f64], b: &[f64]) -> f64 {
        let mut worst = 0.0;
        // What has left is the integral of what changes these.
        let [a, b] = [a, b].map(|contents| &contents[..self.lost_at()]);
        for (a, b) in a.chunks(self.stride()).zip(b.chunks(self.stride())) {
            let moles: f64 = b[..self.gases.len()].iter().sum();
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                let scale = if index < self.gases.len() { moles } else { b.abs() };
                let error = match scale > 0.0 {
                    true => (a - b).abs() / scale,
                    // An empty chamber that stays so.
                    false if a == b => 0.0,
                    false => f64::NAN,
                };
                if error > worst || error.is_nan() {
                    worst = error;
                }
            }
        }
        worst
    }

    /// Time derivative of the unknowns.
    fn rate(&self, time: f64, contents: &[f64], open: &[bool], span: &SmoothSpan) -> Vec<f64> {
        let stride = self.stride();
        let mut rate = vec![0.0; contents.len()];
        for (Source { chamber, orifice }, _) in self.sources.iter().zip(&span.flowing).filter(|(_, flowing)| **flowing)
        {
            let moles = value_held(&orifice.mass_flow, time) / thermo::molar_mass(&orifice.mixture, &self.gases);
            let temperature = value_held(&orifice.temperature, time);
            for &(gas, fraction) in &orifice.mixture.0 {
                rate[chamber * stride + gas] += moles * fraction;
                rate[(chamber + 1) * stride - 1] += self.gases[gas].enthalpy(moles * fraction, temperature);
            }
        }
        let mut flux = vec![0.0; self.gases.len()];
        for opening in &self.openings {
            let [a, b] = opening.between;
            let (side_a, side_b) = (self.side(contents, a, time), self.side(contents, b, time));
            flux.fill(0.0);
            let knudsen = self.knudsen(side_a, side_b, opening.length);
            let energy = exchange(&self.gases, side_a, side_b, knudsen, &mut flux);
            for (gas, flow) in flux.iter().copied().chain([energy]).enumerate() {
                rate[a * stride + gas] -= opening.area * flow;
                rate[b * stride + gas] += opening.area * flow;
            }
        }
        self.lose(time, contents, open, &mut rate);
        // Where the velocity of a wall jumps a stretch ends: at its end it is that before the jump.
        let SmoothSpan { start, end, .. } = *span;
        let within = time.min(end - 1e-9 * (end - start));
        for chamber in 0..self.volumes.len() {
            let growth: f64 = self.swept.iter().map(|swept| swept.rate(chamber, within)).sum();
            if growth != 0.0 {
                rate[(chamber + 1) * stride - 1] -= self.side(contents, chamber, time).pressure() * growth;
            }
        }
        rate
    }

    fn knudsen(&self, a: Side, b: Side, length: f64) -> f64 {
        let moles_per_particle = match self.collisions {
            Collisions::None => return f64::INFINITY,
            Collisions::Continuum => return 0.0,
            Collisions::Particles { moles_per_particle, .. } | Collisions::Spacings { moles_per_particle, .. } => {
                moles_per_particle
            }
        };
        let density = |side: Side| side.moles.iter().sum::<f64>() / (side.volume * moles_per_particle);
        let (pa, pb) = (a.pressure(), b.pressure());
        let weight = 0.5 + 0.5 * ((pa - pb) / (BLENDED_DIFFERENCE * pa.max(pb))).clamp(-1.0, 1.0);
        let upstream = weight * density(a) + (1.0 - weight) * density(b);
        let (diameter, cap, cell) = match self.collisions {
            Collisions::Particles { diameter, cap, cell, .. } => (diameter, cap, cell),
            Collisions::Spacings { paths: [vacuum, slow], .. } => {
                let ratio = if pa.max(pb) > 0.0 { pa.min(pb) / pa.max(pb) } else { 0.0 };
                let path = vacuum + (slow - vacuum) * (ratio / super::discharge::SMALL_DIFFERENCE).min(1.0);
                return path * kinetics::mean_spacing(upstream) / length;
            }
            Collisions::None | Collisions::Continuum => return 0.0,
        };
        let diameter = kinetics::capped_diameter(diameter, cap, upstream);
        let path = kinetics::mean_free_path(upstream, diameter);
        let viscosity = match cell {
            Some(edge) => kinetics::viscosity_of_cells(edge / path),
            None => kinetics::viscosity_of_crowds(kinetics::occupancy(upstream, diameter)),
        };
        path * viscosity / length
    }
}

fn runge_kutta(y: &[f64], time: f64, step: f64, rate: &dyn Fn(f64, &[f64]) -> Vec<f64>) -> Vec<f64> {
    let moved = |slope: &[f64], by: f64| -> Vec<f64> { y.iter().zip(slope).map(|(y, k)| y + by * k).collect() };
    let k1 = rate(time, y);
    let k2 = rate(time + 0.5 * step, &moved(&k1, 0.5 * step));
    let k3 = rate(time + 0.5 * step, &moved(&k2, 0.5 * step));
    let k4 = rate(time + step, &moved(&k3, step));
    let mean: Vec<f64> = (0..y.len()).map(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0).collect();
    moved(&mean, step)
}

/// Moles of one gas in a chamber: p V / (R T).
pub fn moles_at(pressure: f64, volume: f64, temperature: f64) -> f64 {
    pressure * volume / (GAS_CONSTANT * temperature)
}

mod losses;
#[cfg(test)]
mod tests;
