//! The walls that move: where they are at a time, and how much room each chamber and probe has meanwhile.
//!
//! A place is a function of the clock alone, made on the host in f64: the same on any number of ranks, and nothing that a
//! checkpoint must remember. In a step a wall has one velocity, that which takes it from its place at the start to that
//! at the end.
//!
//! A side of a chamber's box that lies in a moving wall goes along with it, so that chambers before and behind a piston
//! stay apart.

use super::error::ModelError;
use super::fabric::Surfaces;
use super::sides_of_walls::{home, is_in, on_both_sides};
use crate::gas::{Swept, bends, displacement, turns, velocity};
use crate::geometry::{Bag, Grid, Vessel, region_bounds};
use crate::plan::MeasuredMotion;
use crate::scene::{Chamber, Course, Curve, Face, MOST_MOTIONS, Motion, Region, Scene};
use crate::subdomain::{GpuMotion, Walls};

/// A chamber may not be squeezed to less than this share of its volume.
const LEAST_SHARE: f64 = 1e-3;
/// Volumes are taken as linear in the displacement where their middle is so near to it, over the volume of all gas.
const LINEAR: f64 = 1e-4;
const MOST_HALVINGS: u32 = 5;
/// Times of a run at which it is looked on which sides of closed fabric walls are.
const LOOKS: u32 = 32;

#[derive(Debug, Clone, Default)]
pub struct Moving {
    bodies: Vec<Body>,
    /// Of the chambers, then the probes.
    pub swept: Vec<Swept>,
    /// Of each chamber the motions that its sides go along with: `carried` of `shaders/shared/zones.wgsl`.
    pub carried: Vec<u32>,
    /// Of surfaces that deform: the times at which they were measured, s, and their fastest node, m/s.
    deformed: (Vec<f64>, f64),
    /// Elastic fabric does: how its chambers share the room is not known before the run.
    gives_way: bool,
    /// The corners of all that the walls sweep, m.
    bounds: Option<([f64; 3], [f64; 3])>,
    end_time: f64,
}

#[derive(Debug, Clone)]
struct Body {
    motion: Motion,
    name: String,
    /// At the start, m.
    low: [f64; 3],
    high: [f64; 3],
    /// The least and the largest displacement of the run, m.
    range: [f64; 2],
    /// In a scene with closed fabric: the chamber that it is in at the start, whose room it takes.
    home: Option<usize>,
}

impl Body {
    fn shift(&self, moved: f64) -> [f64; 3] {
        self.motion.direction.map(|along| along * moved)
    }

    /// The corners of what it sweeps between two displacements, m.
    fn sweep(&self, between: [f64; 2]) -> ([f64; 3], [f64; 3]) {
        let [a, b] = between.map(|moved| self.shift(moved));
        (
            std::array::from_fn(|axis| self.low[axis] + a[axis].min(b[axis])),
            std::array::from_fn(|axis| self.high[axis] + a[axis].max(b[axis])),
        )
    }
}

fn overlap(a: &([f64; 3], [f64; 3]), b: &([f64; 3], [f64; 3])) -> bool {
    (0..3).all(|axis| a.0[axis] <= b.1[axis] && b.0[axis] <= a.1[axis])
}

impl Moving {
    /// # Errors
    /// If a wall encloses the gas, sweeps over an orifice or a vent, squeezes a chamber to nothing, or two of them
    /// claim one side of a chamber.
    pub fn new(scene: &Scene, vessel: &Vessel) -> Result<Moving, ModelError> {
        if scene.motions.is_empty() {
            return Ok(Moving::default());
        }
        let bodies = scene.motions.iter().map(|motion| body(scene, vessel, motion)).collect::<Result<Vec<_>, _>>()?;
        let mut bounds = vessel.bounds;
        for body in &bodies {
            let (low, high) = body.sweep(body.range);
            for axis in 0..3 {
                bounds.0[axis] = bounds.0[axis].min(low[axis]);
                bounds.1[axis] = bounds.1[axis].max(high[axis]);
            }
        }
        let mut moving = Moving {
            carried: scene.chambers.iter().map(|chamber| carried(chamber, &bodies)).collect::<Result<_, _>>()?,
            bodies,
            swept: Vec::new(),
            deformed: (Vec::new(), 0.0),
            gives_way: false,
            bounds: Some(bounds),
            end_time: scene.end_time,
        };
        moving.refuse_swept_places(scene, vessel)?;
        let initial = moving.volumes_at(scene, vessel, (0, 0.0))?;
        for index in 0..moving.bodies.len() {
            let swept = moving.measure(scene, vessel, index, &initial)?;
            moving.swept.push(swept);
        }
        // (What fabric leaves of chambers is not known yet.)
        if scene.fabrics.is_empty() {
            moving.refuse_squeezed(scene, &initial)?;
        }
        Ok(moving)
    }

    /// Walls stay on their sides of closed fabric; elastic fabric gives way to them.
    fn refuse_crossed(&self, scene: &Scene, vessel: &Vessel, fabric: &Surfaces) -> Result<(), ModelError> {
        let rigid: Vec<usize> =
            (0..fabric.all.len()).filter(|&index| fabric.all[index].closed && !fabric.all[index].elastic).collect();
        if self.is_empty() || rigid.is_empty() {
            return Ok(());
        }
        let sides = |time: f64| -> Result<Vec<Option<bool>>, ModelError> {
            let (there, bags) = (self.vessel_at(vessel, time), fabric.bags(time)?);
            let bags: Vec<&Bag> = rigid.iter().filter_map(|&index| bags[index].as_ref()).collect();
            let of_body = |body: &Body| bags.iter().map(|bag| is_in(&there, body.motion.wall, bag)).collect::<Vec<_>>();
            Ok(self.bodies.iter().flat_map(of_body).collect())
        };
        let start = sides(0.0)?;
        let even = (1..=LOOKS).map(|k| scene.end_time * f64::from(k) / f64::from(LOOKS));
        for time in even.chain(self.moments()) {
            let now = sides(time)?;
            if let Some(place) = now.iter().zip(&start).position(|(now, start)| now.is_none() || now != start) {
                let (body, fabric) = (&self.bodies[place / rigid.len()], rigid[place % rigid.len()]);
                return Err(on_both_sides(scene, body.motion.wall, fabric, Some(time)));
            }
        }
        Ok(())
    }

    /// Takes in what surfaces that deform leave of the volumes of chambers, linear between the moments at which they are measured.
    ///
    /// # Errors
    /// If a chamber is squeezed to nothing.
    pub fn deform(&mut self, scene: &Scene, vessel: &Vessel, fabric: &Surfaces) -> Result<(), ModelError> {
        if fabric.is_empty() {
            return Ok(());
        }
        self.bounds = Some(fabric.bounds(self.bounds(vessel)));
        self.end_time = scene.end_time;
        self.refuse_crossed(scene, vessel, fabric)?;
        // (What elastic fabric encloses, a run measures.)
        if fabric.is_elastic() {
            self.deformed.1 = fabric.fastest();
            self.gives_way = true;
            return Ok(());
        }
        if fabric.moments.len() > 1 {
            self.follow(scene, fabric);
        }
        let volumes = vessel.chamber_volumes(&scene.chambers);
        let probes = scene.probes.iter().map(|probe| vessel.gas_volume_in(&probe.region));
        self.refuse_squeezed(scene, &volumes.into_iter().chain(probes).collect::<Vec<_>>())
    }

    fn follow(&mut self, scene: &Scene, fabric: &Surfaces) {
        let initial = fabric.measures(0.0);
        let change = |time: f64| -> Vec<f64> {
            let now = fabric.measures(time);
            let grown: Vec<f64> = now.iter().zip(&initial).map(|([now, _], [initial, _])| now - initial).collect();
            Surfaces::gained(scene, &grown)
        };
        self.swept.push(Swept {
            // Displaced by a metre a second: volumes are by time.
            course: Course::Displacement(Curve { points: vec![[0.0, 0.0], [scene.end_time, scene.end_time]] }),
            at: fabric.moments.clone(),
            change: fabric.moments.iter().map(|&time| change(time)).collect(),
        });
        self.deformed = (fabric.moments.clone(), fabric.fastest());
    }

    /// Whether the volumes of chambers change.
    pub fn changes_volumes(&self) -> bool {
        !self.swept.is_empty()
    }

    pub fn is_empty(&self) -> bool {
        self.bodies.is_empty()
    }

    /// What is doubtful of them: the room that each takes is measured with the others where they are at the start.
    pub fn notes(&self) -> Vec<String> {
        let swept: Vec<_> = self.bodies.iter().map(|body| (body, body.sweep(body.range))).collect();
        let pairs = swept.iter().enumerate().flat_map(|(k, one)| swept[k + 1..].iter().map(move |other| (one, other)));
        let told = |((one, _), (other, _)): (&(&Body, _), &(&Body, _))| {
            format!(
                "what the walls `{}` and `{}` sweep may overlap: where it does, volumes are too small and pressures too large",
                one.name, other.name
            )
        };
        pairs.filter(|((_, one), (_, other))| overlap(one, other)).map(|(one, other)| told((one, other))).collect()
    }

    pub fn count(&self) -> usize {
        self.bodies.len()
    }

    /// The corners of all walls and of all that they sweep, m.
    pub fn bounds(&self, vessel: &Vessel) -> ([f64; 3], [f64; 3]) {
        self.bounds.unwrap_or(vessel.bounds)
    }

    /// The motion of a wall.
    pub fn motion_of(&self, wall: usize) -> Option<usize> {
        self.bodies.iter().position(|body| body.motion.wall == wall)
    }

    /// The vector by which a wall has moved at a time, s, in m; none of one at rest.
    pub fn shift_of(&self, wall: usize, time: f64) -> Option<[f64; 3]> {
        let body = &self.bodies[self.motion_of(wall)?];
        Some(body.shift(displacement(&body.motion.course, time)))
    }

    /// How far each wall has moved, m, and how fast it moves, m/s.
    pub fn courses(&self, time: f64) -> Vec<[f64; 2]> {
        let course = |body: &Body| [displacement(&body.motion.course, time), velocity(&body.motion.course, time)];
        self.bodies.iter().map(course).collect()
    }

    /// The walls as they are at a time, s; not measured.
    pub fn vessel_at(&self, vessel: &Vessel, time: f64) -> Vessel {
        let moved: Vec<f64> = self.courses(time).into_iter().map(|[moved, _]| moved).collect();
        self.vessel_moved(vessel, &moved)
    }

    /// The walls with each of the moving ones so far along its direction, m; not measured.
    pub fn vessel_moved(&self, vessel: &Vessel, moved: &[f64]) -> Vessel {
        let mut by = vec![[0.0; 3]; vessel.walls.len()];
        for (body, &moved) in self.bodies.iter().zip(moved) {
            by[body.motion.wall] = body.shift(moved);
        }
        vessel.moved(&by)
    }

    /// The chambers with their sides where the walls that they lie in have gone.
    fn chambers_moved(&self, scene: &Scene, moved: &[f64]) -> Vec<Chamber> {
        let mut chambers = scene.chambers.clone();
        for (chamber, carried) in chambers.iter_mut().zip(&self.carried) {
            if let Some(Region::Box { min, max }) = &mut chamber.region {
                for axis in 0..3 {
                    for (side, corner) in [(axis, &mut *min), (axis + 3, &mut *max)] {
                        if let Some(motion) = ((carried >> (4 * side)) & 15).checked_sub(1) {
                            let motion = motion as usize;
                            corner[axis] += self.bodies[motion].shift(moved[motion])[axis];
                        }
                    }
                }
            }
        }
        chambers
    }

    /// The volumes of the chambers, then of the probes, with one body displaced, m3.
    fn volumes_at(&self, scene: &Scene, vessel: &Vessel, (body, place): (usize, f64)) -> Result<Vec<f64>, ModelError> {
        let mut moved = vec![0.0; self.bodies.len()];
        moved[body] = place;
        let there = self.vessel_moved(vessel, &moved).measured()?;
        let mut volumes = if vessel.bags.is_empty() {
            there.chamber_volumes(&self.chambers_moved(scene, &moved))
        } else {
            // (The bags are those of the start, and may have made way.)
            let mut volumes = vessel.chamber_volumes(&scene.chambers);
            if let Some(home) = self.bodies[body].home {
                volumes[home] += there.gas_volume() - vessel.gas_volume();
            }
            volumes
        };
        volumes.extend(scene.probes.iter().map(|probe| there.gas_volume_in(&probe.region)));
        Ok(volumes)
    }

    fn measure(&self, scene: &Scene, vessel: &Vessel, index: usize, initial: &[f64]) -> Result<Swept, ModelError> {
        let body = &self.bodies[index];
        let at = |place: f64| -> Result<(f64, Vec<f64>), ModelError> {
            let volumes = self.volumes_at(scene, vessel, (index, place))?;
            Ok((place, volumes.iter().zip(initial).map(|(own, initial)| own - initial).collect()))
        };
        let all: f64 = initial.iter().sum();
        let [low, high] = body.range;
        // A wall that stays where it is has two places nevertheless.
        let high = if high > low { high } else { low + 1e-6 };
        let mut found = vec![at(low)?];
        let mut pending = vec![(at(high)?, 0)];
        while let Some((end, halvings)) = pending.pop() {
            let start = found[found.len() - 1].clone();
            let middle = at(0.5 * (start.0 + end.0))?;
            let off = |zone: usize| (middle.1[zone] - 0.5 * (start.1[zone] + end.1[zone])).abs();
            if halvings >= MOST_HALVINGS || (0..initial.len()).all(|zone| off(zone) <= LINEAR * all) {
                found.extend([middle, end]);
            } else {
                pending.push((end, halvings + 1));
                pending.push((middle, halvings + 1));
            }
        }
        let (at, change) = found.into_iter().unzip();
        Ok(Swept { course: body.motion.course.clone(), at, change })
    }

    fn refuse_swept_places(&self, scene: &Scene, vessel: &Vessel) -> Result<(), ModelError> {
        for body in &self.bodies {
            let swept = body.sweep(body.range);
            for orifice in &scene.orifices {
                let radius = (orifice.area / std::f64::consts::PI).sqrt();
                // The half-extents of the disc.
                let reach = orifice.direction.map(|n| radius * (1.0 - n * n).max(0.0).sqrt());
                let disc = (
                    std::array::from_fn(|axis| orifice.position[axis] - reach[axis]),
                    std::array::from_fn(|axis| orifice.position[axis] + reach[axis]),
                );
                if overlap(&swept, &disc) {
                    let what = format!("orifice \"{}\"", orifice.name);
                    return Err(ModelError::Swept { what, wall: body.name.clone() });
                }
            }
            for vent in &scene.vents {
                let own = |wall, face| wall == vent.wall && (vent.face.is_none() || vent.face == face);
                let (mut low, mut high) = extent(vessel, own);
                // What of the wall lies in the sphere, the corners of both.
                if let Some(disc) = &vent.disc {
                    for axis in 0..3 {
                        low[axis] = low[axis].max(disc.center[axis] - 0.5 * disc.diameter);
                        high[axis] = high[axis].min(disc.center[axis] + 0.5 * disc.diameter);
                    }
                }
                let place = (low, high);
                if overlap(&swept, &place) {
                    let what = format!("vent \"{}\"", vent.name);
                    return Err(ModelError::Swept { what, wall: body.name.clone() });
                }
            }
        }
        Ok(())
    }

    fn refuse_squeezed(&self, scene: &Scene, initial: &[f64]) -> Result<(), ModelError> {
        for time in self.moments() {
            let volumes = self.volumes(initial, time);
            for (chamber, (now, start)) in scene.chambers.iter().zip(volumes.iter().zip(initial)) {
                if *now < LEAST_SHARE * start {
                    return Err(ModelError::Squeezed { chamber: chamber.name.clone(), share: now / start, time });
                }
            }
        }
        Ok(())
    }

    /// Times at which volumes may be largest or smallest, s.
    fn moments(&self) -> Vec<f64> {
        let turns = self.bodies.iter().flat_map(|body| turns(&body.motion.course));
        let within = turns.chain(self.deformed.0.iter().copied()).filter(|&time| time > 0.0 && time < self.end_time);
        within.chain([0.0, self.end_time]).collect()
    }

    /// The volumes at a time, s, of zones that have `initial` at the start, m3.
    pub fn volumes(&self, initial: &[f64], time: f64) -> Vec<f64> {
        let volume = |(zone, initial): (usize, &f64)| {
            self.swept.iter().fold(*initial, |volume, swept| volume + swept.change(zone, time)).max(0.0)
        };
        initial.iter().enumerate().map(volume).collect()
    }

    /// Times at which a velocity bends or jumps, s.
    pub fn bends(&self) -> Vec<f64> {
        self.bodies.iter().flat_map(|body| bends(&body.motion.course)).collect()
    }

    /// What the plan must know of it; `initial` are the volumes of the chambers, m3.
    pub fn measured(&self, initial: &[f64]) -> Option<MeasuredMotion> {
        if !self.changes_volumes() && self.deformed.1 == 0.0 {
            return None;
        }
        let all = |time: f64| self.volumes(initial, time).iter().sum::<f64>();
        let share = |time: f64| {
            if self.gives_way {
                return (all(time) / initial.iter().sum::<f64>()).max(LEAST_SHARE);
            }
            let now = self.volumes(initial, time);
            now.iter().zip(initial).map(|(now, initial)| now / initial).fold(1.0, f64::min)
        };
        let fastest = |time: f64| self.courses(time).iter().map(|[_, velocity]| velocity.abs()).fold(0.0, f64::max);
        let moments = self.moments();
        let bends = self.bends().into_iter().filter(|&time| time < self.end_time);
        Some(MeasuredMotion {
            final_gas_volume: all(self.end_time),
            least_share: moments.iter().map(|&time| share(time)).fold(1.0, f64::min),
            fastest: bends.chain([0.0, self.end_time]).map(fastest).fold(self.deformed.1, f64::max),
        })
    }

    /// Where the walls are in each of the steps of an interval.
    pub fn steps(&self, grid: &Grid, start: f64, dt: f64, steps: u32) -> Vec<GpuMotion> {
        if self.is_empty() {
            return Vec::new();
        }
        let mut table = Vec::with_capacity(steps as usize * MOST_MOTIONS);
        for k in 0..steps {
            let from = start + f64::from(k) * dt;
            let step = |body: &Body| placed(body, grid, [from, from + dt]);
            table.extend(self.bodies.iter().map(step));
            table.resize((k as usize + 1) * MOST_MOTIONS, GpuMotion::default());
        }
        table
    }

    /// Of each wall the box of cells that it may touch in the run: the first and the last.
    pub fn swept_cells(&self, grid: &Grid) -> Vec<[[u32; 3]; 2]> {
        self.bodies.iter().map(|body| cells_swept(body, grid, body.range)).collect()
    }

    /// Where they are at one moment, s.
    pub fn at(&self, grid: &Grid, time: f64) -> Vec<GpuMotion> {
        self.bodies.iter().map(|body| GpuMotion { velocity: [0.0; 3], ..placed(body, grid, [time, time]) }).collect()
    }

    /// The mean volumes over the steps of an interval that are tallied, m3; empty where nothing moves or is tallied.
    pub fn mean_volumes(&self, initial: &[f64], times: impl Iterator<Item = f64>) -> Vec<f64> {
        if !self.changes_volumes() {
            return Vec::new();
        }
        let mut sum = vec![0.0; initial.len()];
        let mut count = 0.0;
        for time in times {
            for (sum, volume) in sum.iter_mut().zip(self.volumes(initial, time)) {
                *sum += volume;
            }
            count += 1.0;
        }
        if count > 0.0 { sum.into_iter().map(|sum| sum / count).collect() } else { Vec::new() }
    }
}

fn placed(body: &Body, grid: &Grid, [from, to]: [f64; 2]) -> GpuMotion {
    let between = [from, to].map(|time| displacement(&body.motion.course, time));
    let [low, high] = cells_swept(body, grid, between);
    GpuMotion {
        moved: body.shift(between[0]).map(|way| (way / grid.quantum()).round() as i32),
        velocity: body.shift((between[1] - between[0]) / (to - from).max(f64::MIN_POSITIVE)).map(|v| v as f32),
        low,
        high,
        ..GpuMotion::default()
    }
}

/// The first and the last cell of the box around what a wall sweeps between two displacements.
fn cells_swept(body: &Body, grid: &Grid, between: [f64; 2]) -> [[u32; 3]; 2] {
    let (low, high) = body.sweep(between);
    let margin = 2.0 * Walls::tolerance(grid);
    let cell = |place: f64, axis: usize| {
        let last = f64::from(grid.cells[axis] - 1);
        ((place - grid.origin[axis]) / grid.cell).floor().clamp(0.0, last) as u32
    };
    [
        std::array::from_fn(|axis| cell(low[axis] - margin, axis)),
        std::array::from_fn(|axis| cell(high[axis] + margin, axis)),
    ]
}

fn body(scene: &Scene, vessel: &Vessel, motion: &Motion) -> Result<Body, ModelError> {
    let name = scene.walls[motion.wall].name.clone();
    if vessel.walls[motion.wall].cavity {
        return Err(ModelError::MovingCavity { wall: name });
    }
    let (low, high) = extent(vessel, |wall, _| wall == motion.wall);
    let inside = turns(&motion.course).into_iter().filter(|&time| time > 0.0 && time < scene.end_time);
    let places = inside.chain([0.0, scene.end_time]).map(|time| displacement(&motion.course, time));
    let range = places.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
    Ok(Body { motion: motion.clone(), home: home(scene, vessel, motion.wall)?, name, low, high, range })
}

/// The corners of some triangles, m.
pub fn extent(vessel: &Vessel, own: impl Fn(usize, Option<Face>) -> bool) -> ([f64; 3], [f64; 3]) {
    let mut corners = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for triangle in vessel.triangles.iter().filter(|triangle| own(triangle.wall as usize, triangle.face)) {
        for vertex in triangle.vertices.map(|vertex| vessel.vertices[vertex as usize]) {
            for (axis, place) in vertex.into_iter().enumerate() {
                corners.0[axis] = corners.0[axis].min(place);
                corners.1[axis] = corners.1[axis].max(place);
            }
        }
    }
    corners
}

/// The motions that the sides of a chamber's box go along with.
fn carried(chamber: &Chamber, bodies: &[Body]) -> Result<u32, ModelError> {
    let Some(region @ Region::Box { .. }) = &chamber.region else { return Ok(0) };
    let (low, high) = region_bounds(region);
    let mut carried = 0;
    for side in 0..6 {
        let axis = side % 3;
        let place = if side < 3 { low[axis] } else { high[axis] };
        let mut face = (low, high);
        (face.0[axis], face.1[axis]) = (place, place);
        let here = bodies
            .iter()
            .enumerate()
            .filter(|(_, body)| body.motion.direction[axis] != 0.0 && overlap(&face, &(body.low, body.high)));
        let here: Vec<usize> = here.map(|(index, _)| index).collect();
        match here[..] {
            [] => {}
            [one] => carried |= (one as u32 + 1) << (4 * side),
            [one, other, ..] => {
                let walls = format!("\"{}\" and \"{}\"", bodies[one].name, bodies[other].name);
                return Err(ModelError::SideOfTwo { chamber: chamber.name.clone(), walls });
            }
        }
    }
    Ok(carried)
}

#[cfg(test)]
mod tests;
