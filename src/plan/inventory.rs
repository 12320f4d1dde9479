//! What a scene holds, in its own units: the box, area and volume of each wall, the gas of each chamber, all gas once it is in, and
//! where vents open. Who reads it sees a wrong unit at a glance; what no vessel has is told besides (`plausible`).
//!
//! All gas at the end: p = n R T / V with T from the energy balance of all gas and all inflow (`Amounts`), no heat lost, vents
//! shut, no work of walls that move.

use super::amounts::{Amounts, Contents};
use super::measured::IN_HOLES;
use super::notes::Shut;
use super::text::{significant, table};
use super::{Measured, MeasuredVent, MeasuredWall, notes, plausible, vent_notes};
use crate::gas::{FlowIntegral, displacement, moles_at, way};
use crate::scene::{Chamber, Curve, Dimension, GAS_CONSTANT, Jet, JetSpeed, Motion, Orifice, Scene, UnitSystem, Vent};

/// Of a solid's volume, from which on it is told how much lies outside of the vessel.
const SHOWN: f64 = 0.01;

/// Share of all that an orifice brings: with less until the end of the run its flow goes on after that.
const CUT: f64 = 0.999;
/// Steps of a slow compression.
const PARTS: u32 = 100;

/// SI, but for what is shown.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Inventory {
    pub units: UnitSystem,
    pub walls: Vec<(String, MeasuredWall)>,
    pub chambers: Vec<(String, Contents)>,
    /// All gas at the end of the run.
    pub end: Contents,
    pub orifices: Vec<(String, Blows)>,
    pub vents: Vec<(String, Opens)>,
    pub motions: Vec<(String, Moves)>,
    /// Values that no vessel has, each with its range and the unit that is likely meant.
    pub doubts: Vec<String>,
    /// What is no warning, and its author may not know.
    pub notes: Vec<String>,
    inflow: bool,
    /// Whether a wall moves.
    pub moves: bool,
    /// Pressure and temperature of all gas at the end with the work of walls that move slowly; none beside an inflow, on whose course it
    /// depends.
    squeezed: Option<[f64; 2]>,
    /// m3 of gas space in no chamber; 0 where it is no more than holes have.
    empty: f64,
}

/// What an orifice brings.
#[derive(Debug, Clone, PartialEq)]
pub struct Blows {
    /// The chamber.
    pub into: String,
    /// kg until the end of the run, and in all.
    pub mass: [f64; 2],
    /// kg/s, at most.
    pub flow: f64,
    /// K, at least and at most.
    pub temperature: [f64; 2],
    pub jet: Option<Jet>,
}

impl Blows {
    fn of(scene: &Scene, orifice: &Orifice, into: Option<usize>) -> Blows {
        let last = orifice.mass_flow.points.last().map_or(0.0, |last| last[0]).max(scene.end_time);
        let range = |curve: &Curve| {
            let values = curve.points.iter().map(|point| point[1]);
            values.fold([f64::INFINITY, 0.0], |[low, high], value| [low.min(value), high.max(value)])
        };
        Blows {
            into: into.map_or(String::new(), |chamber| scene.chambers[chamber].name.clone()),
            mass: [scene.end_time, last].map(|until| FlowIntegral::new(&orifice.mass_flow, until).total()),
            flow: range(&orifice.mass_flow)[1],
            temperature: range(&orifice.temperature),
            jet: orifice.jet,
        }
    }
}

/// How a wall moves until the end of the run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moves {
    /// m along the direction, and to and fro in all.
    pub by: f64,
    pub way: f64,
    pub direction: [f64; 3],
}

impl Moves {
    /// Along the direction in which it has moved at the end.
    fn of(motion: &Motion, end: f64) -> Moves {
        let by = displacement(&motion.course, end);
        let sign = if by < 0.0 { -1.0 } else { 1.0 };
        // Adding 0 leaves no -0.
        let direction = motion.direction.map(|own| sign * own + 0.0);
        Moves { by: by.abs(), way: way(&motion.course, end), direction }
    }
}

/// When a vent opens.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Opens {
    /// Pa.
    pub absolute: f64,
    pub outside: f64,
    /// Whether its chamber has that pressure at the start, or all gas together at the end, closed and without loss of heat.
    pub reached: bool,
}

impl Inventory {
    pub(super) fn of(scene: &Scene, measured: &Measured, amounts: &Amounts) -> Inventory {
        let volumes = measured.chamber_volumes.iter();
        let chambers: Vec<(String, Contents)> = scene
            .chambers
            .iter()
            .zip(volumes)
            .map(|(chamber, &v)| (chamber.name.clone(), at_start(scene, chamber, v)))
            .collect();
        let volume = measured.final_volume();
        let end = Contents {
            volume,
            mass: amounts.mass(scene),
            pressure: amounts.total() * GAS_CONSTANT * amounts.final_temperature / volume,
            temperature: amounts.final_temperature,
        };
        let opens = |(vent, place): (&Vent, &MeasuredVent)| {
            let absolute = vent.external_pressure + vent.opening_pressure;
            let highest = end.pressure.max(scene.chambers[place.chamber].pressure);
            let reached = highest >= absolute || measured.motion.is_some() || measured.inflated.is_some();
            (vent.name.clone(), Opens { absolute, outside: vent.external_pressure, reached })
        };
        let vents: Vec<(String, Opens)> = scene.vents.iter().zip(&measured.vents).map(opens).collect();
        let shut = vents.iter().filter(|(_, opens)| !opens.reached);
        let shut: Vec<(&str, f64)> = shut.map(|(name, opens)| (name.as_str(), opens.absolute)).collect();
        let doubts = plausible::doubts(scene, measured, &end);
        let inflow = amounts.injected.iter().any(|&moles| moles > 0.0);
        let mut notes = notes::of_scene(scene, measured, &Shut { vents: &shut, end: end.pressure });
        let gases = plausible::notes_of_gases(scene).into_iter().chain(plausible::notes_of_flows(scene, amounts));
        let inflators = plausible::notes_of_inflators(scene, &measured.sources);
        let more = gases.chain(inflators).chain(vent_notes::of_vents(scene, measured, &end));
        let more = more.chain(plausible::notes_of_places(scene, measured));
        notes.extend(more.map(|note| scene.lines.told(note)));
        Inventory {
            units: scene.units,
            walls: scene.walls.iter().map(|wall| wall.name.clone()).zip(measured.walls.iter().copied()).collect(),
            chambers,
            end,
            notes,
            motions: scene
                .motions
                .iter()
                .map(|motion| (scene.walls[motion.wall].name.clone(), Moves::of(motion, scene.end_time)))
                .collect(),
            orifices: scene
                .orifices
                .iter()
                .zip(&measured.sources)
                .map(|(orifice, &into)| (orifice.name.clone(), Blows::of(scene, orifice, into)))
                .collect(),
            vents,
            doubts: doubts.into_iter().map(|doubt| scene.lines.told(doubt)).collect(),
            empty: Some(measured.empty_space()).filter(|empty| *empty > IN_HOLES * measured.gas_volume).unwrap_or(0.0),
            moves: measured.motion.is_some(),
            squeezed: measured
                .motion
                // Of fabric it is not known on which chamber it works.
                .filter(|_| !inflow && scene.fabrics.is_empty())
                .map(|_| squeezed(scene, amounts, [measured.gas_volume, volume])),
            inflow,
        }
    }

    fn shown(&self, si: f64, dimension: Dimension) -> String {
        format!("{} {}", significant(si / self.units.factor(dimension)), self.units.symbol(dimension))
    }

    /// Tables of walls, chambers, orifices, vents and walls that move.
    pub fn render(&self) -> String {
        let mut walls = vec![heads(["wall", "box", "area", "volume"])];
        walls.extend(self.walls.iter().map(|(name, wall)| {
            let of = |values: [f64; 3]| values.map(|m| significant(m / self.units.factor(Dimension::Length)));
            let sides = of(std::array::from_fn(|axis| wall.max[axis] - wall.min[axis])).join(" x ");
            let [sides, low] = [sides, of(wall.min).join(", ")];
            let place = format!("{sides} {} from ({low})", self.units.symbol(Dimension::Length));
            let volume = self.shown(wall.volume, Dimension::Volume);
            let outside = match wall.outside {
                share if share > SHOWN => {
                    format!(", {:.0} % of it outside of the vessel", 100.0 * share.min(1.0))
                }
                _ => String::new(),
            };
            let volume = if wall.cavity { volume } else { format!("{volume}, solid{outside}") };
            vec![name.clone(), place, self.shown(wall.area, Dimension::Area), volume]
        }));
        let mut chambers = vec![heads(["chamber", "volume", "mass", "absolute pressure, temperature"])];
        chambers.extend(self.chambers.iter().map(|(name, gas)| self.contents(name.clone(), gas)));
        if self.empty > 0.0 {
            let [volume, litres] = [self.shown(self.empty, Dimension::Volume), significant(1e3 * self.empty)];
            let row =
                ["in no chamber".into(), format!("{volume} ({litres} L)"), String::new(), "empty at the start".into()];
            chambers.push(row.to_vec());
        }
        if self.inflow || self.chambers.len() > 1 {
            let inflow = if self.inflow { " with all inflow" } else { "" };
            chambers.push(self.contents(format!("all gas{inflow}"), &self.end));
        }
        let mut vents = vec![heads(["vent", "opens at", "above the outside (gauge)", ""])];
        vents.extend(self.vents.iter().map(|(name, opens)| {
            let note = if opens.reached { "" } else { "not reached at the start, nor by all gas together" };
            let [absolute, above] =
                [opens.absolute, opens.absolute - opens.outside].map(|p| self.shown(p, Dimension::Pressure));
            let bar = significant(1e-5 * opens.absolute);
            vec![name.clone(), format!("{absolute} ({bar} bar) absolute"), above, note.to_string()]
        }));
        let parts = [walls, chambers, self.of_orifices(), vents, self.of_motions()];
        let tables: Vec<String> = parts.iter().filter(|part| part.len() > 1).map(|part| table(part)).collect();
        tables.join("\n")
    }

    fn of_orifices(&self) -> Vec<Vec<String>> {
        let mut rows = vec![heads(["orifice", "into chamber", "mass until the end, largest flow", "temperature"])];
        rows.extend(self.orifices.iter().map(|(name, blows)| {
            let [until, all] = blows.mass;
            let [low, high] = blows.temperature.map(significant);
            let cut =
                if until < CUT * all { format!(" of {}", self.shown(all, Dimension::Mass)) } else { String::new() };
            let mass =
                format!("{}{cut}, {}", self.shown(until, Dimension::Mass), self.shown(blows.flow, Dimension::MassFlow));
            let temperature = if low == high { format!("{low} K") } else { format!("{low} to {high} K") };
            vec![name.clone(), blows.into.clone(), mass, temperature]
        }));
        if self.orifices.iter().any(|(_, blows)| blows.jet.is_some()) {
            let jets = self.orifices.iter().map(|(_, blows)| blows.jet.map_or(String::new(), |jet| self.jet(jet)));
            rows.iter_mut().zip(std::iter::once("jet".into()).chain(jets)).for_each(|(row, jet)| row.push(jet));
        }
        rows
    }

    fn jet(&self, jet: Jet) -> String {
        let speed = match jet.speed {
            JetSpeed::Mach(mach) => format!("Mach {}", significant(mach)),
            JetSpeed::Velocity(speed) => self.shown(speed, Dimension::Velocity),
        };
        format!("{speed}, cone_angle {} degrees", significant(jet.cone_angle.to_degrees()))
    }

    fn of_motions(&self) -> Vec<Vec<String>> {
        let mut rows = vec![heads(["moving wall", "moves until the end by", "towards", ""])];
        rows.extend(self.motions.iter().map(|(name, moves)| {
            let along = moves.direction.map(significant).join(", ");
            let all = self.shown(moves.way, Dimension::Length);
            let all = if moves.way > 1.001 * moves.by { format!("to and fro {all} in all") } else { String::new() };
            vec![name.clone(), self.shown(moves.by, Dimension::Length), format!("({along})"), all]
        }));
        rows
    }

    fn contents(&self, name: String, gas: &Contents) -> Vec<String> {
        let state = format!("{}, {} K", self.shown(gas.pressure, Dimension::Pressure), significant(gas.temperature));
        let with = self.squeezed.map(|[pressure, temperature]| {
            format!(
                "; {}, {} K with it, if they are slow",
                self.shown(pressure, Dimension::Pressure),
                significant(temperature)
            )
        });
        let without = match with {
            _ if !self.moves => String::new(),
            Some(with) => format!(", without the work of moving walls{with}"),
            None => ", without the work of moving walls, which depends on when gas comes in".to_string(),
        };
        let state =
            if std::ptr::eq(gas, &self.end) { format!("{state} if closed, no heat lost{without}") } else { state };
        let volume = format!("{} ({} L)", self.shown(gas.volume, Dimension::Volume), significant(1e3 * gas.volume));
        vec![name, volume, self.shown(gas.mass, Dimension::Mass), state]
    }
}

/// Pressure and temperature of all initial gas, slowly brought from one volume to another, m3: cv dT/T = -R dV/V.
fn squeezed(scene: &Scene, amounts: &Amounts, [from, to]: [f64; 2]) -> [f64; 2] {
    let moles: Vec<f64> = (0..scene.gases.len()).map(|gas| amounts.initial.iter().map(|own| own[gas]).sum()).collect();
    let total: f64 = moles.iter().sum();
    let part = libm::log(from / to) / f64::from(PARTS);
    let warmer = |temperature: f64, _| {
        let heat: f64 = scene.gases.iter().zip(&moles).map(|(gas, n)| n * gas.heat.molar_cv(temperature)).sum();
        temperature * libm::exp(part * GAS_CONSTANT * total / heat)
    };
    let temperature = (0..PARTS).fold(amounts.initial_temperature, warmer);
    [total * GAS_CONSTANT * temperature / to, temperature]
}

fn heads(names: [&str; 4]) -> Vec<String> {
    names.map(String::from).to_vec()
}

fn at_start(scene: &Scene, chamber: &Chamber, volume: f64) -> Contents {
    let mass = chamber.mixture.molar_mass(&scene.gases) * moles_at(chamber.pressure, volume, chamber.temperature);
    Contents { volume, mass, pressure: chamber.pressure, temperature: chamber.temperature }
}
