//! Named parts of walls and fabrics, the key `face`: faces of primitives, and what mesh files name.
//!
//! What parts a mesh has is known once its file is read, which is not this layer's: here each name that the scene uses of
//! it gets a number, in the order of the file.

use super::errors::{Problem, list, quote};
use super::names::Names;
use super::raw::{RawScene, RawShape, RawWall};
use super::raw_values::At;
use super::types::Face;

/// The names that the scene uses, of each wall.
pub(super) struct Parts<'a> {
    walls: &'a [At<RawWall>],
    used: Vec<Vec<String>>,
    /// And of each fabric.
    used_of_fabrics: Vec<Vec<String>>,
}

impl<'a> Parts<'a> {
    pub fn collect(raw: &'a RawScene, walls: &Names, fabrics: &Names) -> Parts<'a> {
        let mut used: Vec<Vec<String>> = vec![Vec::new(); raw.wall.len()];
        let of_surfaces = raw.surface.iter().map(|at| (&at.value.wall, &at.value.face));
        let of_vents = raw.vent.iter().filter_map(|at| Some((at.value.wall.as_ref()?, &at.value.face)));
        let mut add = |wall: usize, face: &At<String>| {
            if !used[wall].contains(&face.value) {
                used[wall].push(face.value.clone());
            }
        };
        for (wall, face) in of_surfaces.chain(of_vents) {
            // Walls that are not there are reported where they are looked up.
            if let (Ok(wall), Some(face)) = (walls.find(wall), face) {
                add(wall, face);
            }
        }
        for (wall, raw) in raw.wall.iter().enumerate() {
            raw.value.part.iter().for_each(|part| add(wall, &part.value.face));
        }
        let mut used_of_fabrics: Vec<Vec<String>> = vec![Vec::new(); raw.fabric.len()];
        let mut add = |fabric: usize, face: &At<String>| {
            if !used_of_fabrics[fabric].contains(&face.value) {
                used_of_fabrics[fabric].push(face.value.clone());
            }
        };
        for vent in raw.vent.iter().map(|at| &at.value) {
            let index = vent.fabric.as_ref().and_then(|name| fabrics.find(name).ok());
            if let (Some(index), Some(face)) = (index, &vent.face) {
                add(index, face);
            }
        }
        for (fabric, raw) in raw.fabric.iter().enumerate() {
            raw.value.part.iter().for_each(|part| add(fabric, &part.value.face));
        }
        Parts { walls: &raw.wall, used, used_of_fabrics }
    }

    /// The names used of a fabric.
    pub fn of_fabric(&self, fabric: usize) -> Vec<String> {
        self.used_of_fabrics[fabric].clone()
    }

    /// The part of a fabric that is called so; whether its mesh has it is known once that is read.
    pub fn find_of_fabric(&self, given: &At<String>, fabric: usize) -> Result<Face, Problem> {
        if given.value.is_empty() {
            return Err(Problem::value(&given.span, "an empty name", "the name of a part of the mesh"));
        }
        let part = self.used_of_fabrics[fabric].iter().position(|used| *used == given.value);
        Ok(Face::Part(part.unwrap_or_default() as u32))
    }

    /// The names used of a wall that is a mesh.
    pub fn of_mesh(&self, wall: usize) -> Vec<String> {
        self.used[wall].clone()
    }

    /// The part of a wall that is called so.
    pub fn find(&self, given: &At<String>, wall: usize) -> Result<Face, Problem> {
        self.find_or(given, wall, "leave `face` out to take all of the wall")
    }

    /// The same with another hint where there is none.
    pub fn find_or(&self, given: &At<String>, wall: usize, hint: &str) -> Result<Face, Problem> {
        let raw = &self.walls[wall].value;
        let (name, wall_name) = (given.value.as_str(), &raw.name.value);
        let (known, shape) = names_of(raw);
        if raw.shape.value == RawShape::Mesh && !name.is_empty() {
            let part = self.used[wall].iter().position(|used| used == name);
            return Ok(Face::Part(part.unwrap_or_default() as u32));
        }
        if let Some((_, face)) = known.iter().find(|(own, _)| *own == name) {
            return Ok(*face);
        }
        let names = || known.iter().map(|(own, _)| *own);
        let found = format!("{} of the wall {wall_name:?}, which is a {shape}", quote(name));
        let problem = match raw.shape.value {
            RawShape::Mesh => Problem::value(&given.span, "an empty name", "the name of a part of the mesh"),
            _ if known.is_empty() => Problem::value(&given.span, found, format!("no `face` of a {shape}")),
            _ => Problem::value(&given.span, found, format!("a face of a {shape}: {}", list(names()))),
        };
        let of_other = |other: &&At<RawWall>| names_of(&other.value).0.iter().any(|(own, _)| *own == name);
        match self.walls.iter().find(of_other) {
            Some(other) if raw.shape.value != RawShape::Mesh => {
                let other = quote(&other.value.name.value);
                let has = format!("the wall {other} has a face {}, if that wall is meant; else {hint}", quote(name));
                Err(problem.hint(&has))
            }
            _ => Err(problem.hint(hint).meant(name, names())),
        }
    }
}

/// The names of the parts of a shape, but those of a mesh, and what it is called.
fn names_of(wall: &RawWall) -> (&'static [(&'static str, Face)], &'static str) {
    const BOX: [(&str, Face); 7] = [
        ("-x", Face::Box { axis: 0, positive: false }),
        ("+x", Face::Box { axis: 0, positive: true }),
        ("-y", Face::Box { axis: 1, positive: false }),
        ("+y", Face::Box { axis: 1, positive: true }),
        ("-z", Face::Box { axis: 2, positive: false }),
        ("+z", Face::Box { axis: 2, positive: true }),
        ("outside", Face::Outside),
    ];
    match wall.shape.value {
        RawShape::Box if wall.thickness.is_some() => (&BOX, "box with a thickness"),
        RawShape::Box => (&BOX[..6], "box"),
        RawShape::Plane => (&[("front", Face::Front), ("back", Face::Back), ("rim", Face::Rim)], "plane"),
        RawShape::Cylinder => (&[("base", Face::Base), ("top", Face::Top), ("side", Face::Side)], "cylinder"),
        RawShape::Sphere => (&[], "sphere"),
        RawShape::Mesh => (&[], "mesh"),
    }
}
