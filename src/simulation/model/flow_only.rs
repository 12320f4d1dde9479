//! A scene whose holes are modelled: of holes that a scene says only the flow matters of (`flow_only`) a part of the scene is
//! made, what is inside of their box, with a `[[vent]]` in their place (docs/explanation/planner.md). What is behind them is
//! left out; only its pressure is left.
//!
//! Nothing that the scene asks to know may be left out, nor a part of a chamber that stays; else the reason is told.

use super::moving::extent;
use super::outlook::source;
use crate::gas::continuum_by_excess;
use crate::geometry::{Vessel, region_bounds};
use crate::plan::{Measured, significant};
use crate::scene::{Curve, Face, GasSide, Hole, Opening, Scene, Shape, Surface, Vent, VentFlow, Wall};

/// Rounding of lengths, and what volumes that are summed along lines may be off, relative.
const ROUNDING: f64 = 1e-6;
const MEASURED: f64 = 1e-4;

/// What is inside of a box, with its holes modelled.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    pub scene: Scene,
    /// The chambers that stayed, by their index in the whole scene.
    pub kept: Vec<usize>,
    /// Of each hole its name, and what stands for it.
    pub holes: Vec<(String, String)>,
    /// The vents that stand for them, by index.
    pub vents: Vec<usize>,
}

/// The box of the holes of which only the flow matters, and those holes; `None` if there are none.
fn box_of(scene: &Scene) -> Option<Result<(usize, Vec<&Hole>), String>> {
    let marked = |wall: &Wall| match &wall.shape {
        Shape::Box { holes, .. } => holes.iter().any(|hole| hole.flow_only),
        _ => false,
    };
    let mut walls = scene.walls.iter().enumerate().filter(|(_, wall)| marked(wall));
    let (index, wall) = walls.next()?;
    if let Some((_, other)) = walls.next() {
        return Some(Err(format!(
            "holes of two walls, \"{}\" and \"{}\", are `flow_only`; one box at a time can be modelled",
            wall.name, other.name
        )));
    }
    let Shape::Box { holes, .. } = &wall.shape else { return None };
    Some(match holes.iter().find(|hole| !hole.flow_only) {
        Some(open) => Err(format!("hole \"{}\" of the same wall is not `flow_only`", open.name)),
        None => Ok((index, holes.iter().collect())),
    })
}

/// The names of the holes of which only the flow matters.
pub fn names(scene: &Scene) -> Vec<String> {
    let holes = scene.walls.iter().flat_map(|wall| match &wall.shape {
        Shape::Box { holes, .. } => holes.as_slice(),
        _ => &[],
    });
    holes.filter(|hole| hole.flow_only).map(|hole| hole.name.clone()).collect()
}

/// The part of the scene that is inside of the box; `None` if the scene has no such holes, or why it cannot be.
pub fn part(scene: &Scene, vessel: &Vessel, measured: &Measured) -> Option<Result<Part, String>> {
    let whole = Whole { scene, vessel, measured };
    Some(match box_of(scene)? {
        Ok(_) if !scene.motions.is_empty() => Err("walls of the scene move".into()),
        Ok((wall, holes)) => Cavity::new(scene, wall).and_then(|cavity| cavity.part(&whole, &holes)),
        Err(why) => Err(why),
    })
}

#[derive(Clone, Copy)]
struct Whole<'a> {
    scene: &'a Scene,
    vessel: &'a Vessel,
    measured: &'a Measured,
}

/// The inside of a hollow box.
struct Cavity {
    wall: usize,
    min: [f64; 3],
    max: [f64; 3],
    /// m, what counts as nothing.
    rounding: f64,
}

impl Cavity {
    fn new(scene: &Scene, wall: usize) -> Result<Cavity, String> {
        let Shape::Box { min, max, .. } = scene.walls[wall].shape else {
            return Err("its wall is no box".into());
        };
        let longest = (0..3).map(|k| max[k] - min[k]).fold(0.0, f64::max);
        Ok(Cavity { wall, min, max, rounding: ROUNDING * longest })
    }

    fn holds(&self, (low, high): ([f64; 3], [f64; 3])) -> bool {
        (0..3).all(|k| low[k] >= self.min[k] - self.rounding && high[k] <= self.max[k] + self.rounding)
    }

    /// Whether nothing of a box is inside.
    fn is_apart_from(&self, (low, high): ([f64; 3], [f64; 3])) -> bool {
        (0..3).any(|k| high[k] <= self.min[k] + self.rounding || low[k] >= self.max[k] - self.rounding)
    }

    /// The walls that stay, by their index in the scene: the box itself, and what is inside of it.
    fn walls(&self, scene: &Scene, vessel: &Vessel) -> Result<Vec<usize>, String> {
        let mut kept = Vec::new();
        for (index, wall) in scene.walls.iter().enumerate() {
            let bounds = extent(vessel, |of, _| of == index);
            let around = (0..3).all(|k| bounds.0[k] < self.min[k] && bounds.1[k] > self.max[k]);
            if index == self.wall || self.holds(bounds) {
                kept.push(index);
            } else if !self.is_apart_from(bounds) && !around {
                return Err(format!("wall \"{}\" reaches into the box", wall.name));
            }
        }
        Ok(kept)
    }

    /// The box without its holes, with gas inside alone.
    fn closed(&self, wall: &Wall) -> Wall {
        let shape = Shape::Box { min: self.min, max: self.max, thickness: None, holes: Vec::new() };
        let mut closed = Wall { shape, gas: GasSide::Inside, ..wall.clone() };
        // The outside of the shell is behind the holes.
        closed.parts.retain(|part| part.face != Face::Outside);
        closed
    }

    fn part(&self, whole: &Whole<'_>, holes: &[&Hole]) -> Result<Part, String> {
        let Whole { scene, vessel, measured } = *whole;
        let own = &scene.walls[self.wall];
        self.check_asked(scene, holes)?;
        let walls = self.walls(scene, vessel)?;
        let renumbered = |index: usize| walls.iter().position(|&kept| kept == index);
        let mut part = scene.clone();
        part.walls = walls
            .iter()
            .map(|&index| if index == self.wall { self.closed(own) } else { scene.walls[index].clone() })
            .collect();
        let inside = Vessel::build(&part.walls).map_err(|error| format!("what is inside is no vessel: {error}"))?;
        let kept = self.chambers(scene, measured, &inside, holes)?;
        part.chambers = kept.iter().map(|&chamber| scene.chambers[chamber].clone()).collect();
        let chamber = |index: usize| kept.iter().position(|&own| own == index);
        part.openings = Vec::new();
        for opening in &scene.openings {
            match opening.between.map(chamber) {
                [Some(a), Some(b)] => part.openings.push(Opening { between: [a, b], ..opening.clone() }),
                [None, None] => {}
                _ => return Err(format!("opening \"{}\" leads out of the box as well", opening.name)),
            }
        }
        part.orifices.retain(|orifice| source(scene, vessel, orifice).and_then(chamber).is_some());
        part.surfaces = Vec::new();
        for surface in &scene.surfaces {
            let wall = renumbered(surface.wall)
                .ok_or_else(|| format!("surface \"{}\" is behind it, and asked for", surface.name))?;
            part.surfaces.push(Surface { wall, ..surface.clone() });
        }
        part.vents = Vec::new();
        for vent in &scene.vents {
            if vent.wall == self.wall {
                return Err(format!("vent \"{}\" is in the same wall", vent.name));
            }
            let Some(wall) = renumbered(vent.wall) else { continue };
            let empties = vent.chamber.map(|index| {
                chamber(index).ok_or_else(|| format!("vent \"{}\" empties a chamber behind it", vent.name))
            });
            part.vents.push(Vent { wall, chamber: empties.transpose()?, ..vent.clone() });
        }
        let wall = renumbered(self.wall).unwrap_or(0);
        let first = part.vents.len();
        for vent in vents(whole, &kept, holes, wall)? {
            if part.vents[..first].iter().any(|other| other.name == vent.name) {
                return Err(format!("a vent has the name of hole \"{}\"", vent.name));
            }
            part.vents.push(vent);
        }
        let words: Result<_, _> = holes.iter().map(|hole| words(whole, &kept, hole)).collect();
        Ok(Part { vents: (first..part.vents.len()).collect(), scene: part, kept, holes: words? })
    }

    /// What is asked for must be inside.
    fn check_asked(&self, scene: &Scene, holes: &[&Hole]) -> Result<(), String> {
        if scene.surfaces.is_empty() && scene.probes.is_empty() {
            return Err("without surfaces and probes all chambers are asked for, also those behind it".into());
        }
        for surface in scene.surfaces.iter().filter(|surface| surface.wall == self.wall) {
            let lost = |face| face == Face::Outside || holes.iter().any(|hole| hole.face == face);
            if surface.face.is_none_or(lost) {
                return Err(format!("surface \"{}\" is on the wall with the hole, or behind it", surface.name));
            }
        }
        match scene.probes.iter().find(|probe| !self.holds(region_bounds(&probe.region))) {
            Some(probe) => Err(format!("probe \"{}\" is behind it, and asked for", probe.name)),
            None => Ok(()),
        }
    }

    /// The chambers that have gas in the vessel of what is inside: all of it, and none outside but in the holes.
    fn chambers(
        &self,
        scene: &Scene,
        measured: &Measured,
        inside: &Vessel,
        holes: &[&Hole],
    ) -> Result<Vec<usize>, String> {
        let Shape::Box { thickness, .. } = scene.walls[self.wall].shape else { return Ok(Vec::new()) };
        let of_holes = measured.openings.iter().filter(|opening| holes.iter().any(|hole| hole.name == opening.name));
        let channels = of_holes.map(|opening| opening.area).sum::<f64>() * thickness.unwrap_or(0.0);
        let all = inside.gas_volume();
        let volumes = inside.chamber_volumes(&scene.chambers);
        let kept: Vec<usize> = (0..volumes.len()).filter(|&chamber| volumes[chamber] > MEASURED * all).collect();
        for &chamber in &kept {
            if measured.chamber_volumes[chamber] > volumes[chamber] + channels + MEASURED * all {
                return Err(format!("chamber \"{}\" is on both sides of it", scene.chambers[chamber].name));
            }
        }
        Ok(kept)
    }
}

/// The opening that a hole is, and the chambers before and behind it.
fn opening_of<'a>(whole: &Whole<'a>, kept: &[usize], hole: &Hole) -> Result<(&'a Opening, [usize; 2]), String> {
    let found = whole.measured.openings.iter().find(|opening| opening.name == hole.name);
    let opening = found.ok_or_else(|| format!("hole \"{}\" does not join two chambers", hole.name))?;
    let [a, b] = opening.between;
    match [a, b].map(|chamber| kept.contains(&chamber)) {
        [true, false] => Ok((opening, [a, b])),
        [false, true] => Ok((opening, [b, a])),
        _ => Err(format!("hole \"{}\" does not lead from a chamber inside to one outside", hole.name)),
    }
}

/// A vent for each face with holes, spread over it.
fn vents(whole: &Whole<'_>, kept: &[usize], holes: &[&Hole], wall: usize) -> Result<Vec<Vent>, String> {
    let mut vents: Vec<Vent> = Vec::new();
    for hole in holes {
        let (opening, [before, behind]) = opening_of(whole, kept, hole)?;
        let outside = whole.scene.chambers[behind].pressure;
        let own = Vent {
            name: hole.name.clone(),
            wall,
            face: Some(hole.face),
            chamber: kept.iter().position(|&chamber| chamber == before),
            disc: None,
            area: Some(opening.area),
            flow: VentFlow::DischargeByPressure(Curve { points: continuum_by_excess(outside) }),
            opening_pressure: 0.0,
            external_pressure: outside,
        };
        match vents.iter_mut().find(|vent| vent.face == own.face) {
            None => vents.push(own),
            Some(vent) if (vent.chamber, vent.external_pressure) == (own.chamber, own.external_pressure) => {
                vent.area = vent.area.map(|area| area + opening.area);
            }
            Some(vent) => {
                return Err(format!("holes \"{}\" and \"{}\" of one face lead to different gas", vent.name, own.name));
            }
        }
    }
    Ok(vents)
}

/// A hole's name, and what stands for it.
fn words(whole: &Whole<'_>, kept: &[usize], hole: &Hole) -> Result<(String, String), String> {
    let (opening, [_, behind]) = opening_of(whole, kept, hole)?;
    let behind = &whole.scene.chambers[behind];
    let what = format!(
        "a [[vent]] of {} m2 over its face, the discharge of a thin orifice, `external_pressure` = {} Pa, in place of \
         chamber `{}`",
        significant(opening.area),
        significant(behind.pressure),
        behind.name
    );
    Ok((hole.name.clone(), what))
}

#[cfg(test)]
mod tests;
