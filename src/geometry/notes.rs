//! What is not wrong with the walls but worth to know before a run: what of meshes was mended, solids that overlap, and
//! separate spaces of gas.
//!
//! Where no walls overlap, each connected surface bounds its own places: a space of gas has one surface around it, with
//! its normals (into the gas) inwards. So there are as many spaces as surfaces of negative volume that gas lies before.

use super::closed::signed_volume;
use super::vessel::bounds_of;
use super::{Triangle, Vessel};
use crate::scene::UnitSystem;
use glam::DVec3;

/// How far before a triangle the gas is looked for, over its longest edge.
const BEFORE: f64 = 1e-4;
/// Share of what a surface encloses from which on a body within it leaves a shell.
const SHELL: f64 = 0.8;

/// A space without gas within a shell of gas.
pub struct Hollow {
    pub wall: usize,
    /// m3.
    pub volume: f64,
    low: DVec3,
    high: DVec3,
}

impl Vessel {
    /// A sentence each; lengths in the scene's units.
    pub fn notes(&self, units: UnitSystem) -> Vec<String> {
        let (factor, symbol) = units.length();
        let mut notes = Vec::new();
        for wall in &self.walls {
            if let Some(mended) = &wall.mended {
                let counted = [
                    (mended.welded, "corners welded"),
                    (mended.flat, "triangles without area left out"),
                    (mended.split, "edges split at a neighbour's corners"),
                ];
                let done: Vec<String> =
                    counted.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
                let within = format!("{:.1e} {symbol}", mended.tolerance / factor);
                notes.push(format!("wall `{}`: its mesh was mended within {within}: {}", wall.name, done.join(", ")));
            }
            if let Some(overlaps) = &wall.overlaps {
                let first = overlaps.first.clone().told_in(units);
                notes.push(format!(
                    "wall `{}`: its solids overlap ({} pairs of triangles cross, first {first}); together they are one solid",
                    wall.name, overlaps.count
                ));
            }
        }
        match self.gas_spaces() {
            Some(count) if count > 1 => notes.push(format!("{count} separate gas spaces: no gas flows between them")),
            _ => {}
        }
        notes
    }

    /// How many spaces of gas no gas flows between; `None` where walls overlap.
    pub fn gas_spaces(&self) -> Option<usize> {
        if self.overlaps() || self.walls.iter().any(|wall| wall.overlaps.is_some()) {
            return None;
        }
        let vertices: Vec<DVec3> = self.vertices.iter().map(|&v| DVec3::from(v)).collect();
        let surfaces = self.surfaces(|_| true);
        Some(surfaces.iter().filter(|own| signed_volume(&vertices, own) < 0.0 && self.faces_gas(own)).count())
    }

    /// The largest space without gas that the surface of a wall with the gas inside has within it, if nearly all of what it encloses is that:
    /// its gas is a shell.
    pub fn hollow(&self, wall: usize) -> Option<Hollow> {
        if !self.walls[wall].cavity {
            return None;
        }
        let vertices: Vec<DVec3> = self.vertices.iter().map(|&v| DVec3::from(v)).collect();
        let surfaces = self.surfaces(|triangle| triangle.wall as usize == wall);
        let measured = surfaces.iter().map(|own| (signed_volume(&vertices, own), own));
        let (volume, own) = measured.clone().max_by(|a, b| a.0.total_cmp(&b.0))?;
        let around = measured.map(|(volume, _)| -volume).fold(0.0, f64::max);
        let (low, high) = bounds_of(&own.iter().flatten().map(|&v| vertices[v as usize]).collect::<Vec<_>>());
        (volume > SHELL * around && around > 0.0).then_some(Hollow { wall, volume, low, high })
    }

    /// The hollow that holds a place, m.
    pub fn hollow_at(&self, place: [f64; 3]) -> Option<Hollow> {
        let hollows = (0..self.walls.len()).filter_map(|wall| self.hollow(wall));
        let p = DVec3::from(place);
        let mut around = hollows.filter(|own| own.low.cmple(p).all() && p.cmple(own.high).all());
        around.find(|own| self.depth_of(own.wall, place) > 0)
    }

    /// The triangles of each connected surface of some triangles.
    fn surfaces(&self, counts: impl Fn(&Triangle) -> bool) -> Vec<Vec<[u32; 3]>> {
        let mut root: Vec<u32> = (0..self.vertices.len() as u32).collect();
        fn find(root: &mut [u32], v: u32) -> u32 {
            let mut at = v;
            while root[at as usize] != at {
                root[at as usize] = root[root[at as usize] as usize];
                at = root[at as usize];
            }
            at
        }
        for triangle in self.triangles.iter().filter(|triangle| counts(triangle)) {
            let [a, b, c] = triangle.vertices.map(|v| find(&mut root, v));
            let least = a.min(b).min(c);
            [a, b, c].iter().for_each(|&v| root[v as usize] = least);
        }
        let mut place = vec![None; self.vertices.len()];
        let mut surfaces: Vec<Vec<[u32; 3]>> = Vec::new();
        for triangle in self.triangles.iter().filter(|triangle| counts(triangle)) {
            let own = find(&mut root, triangle.vertices[0]) as usize;
            let surface = *place[own].get_or_insert_with(|| {
                surfaces.push(Vec::new());
                surfaces.len() - 1
            });
            surfaces[surface].push(triangle.vertices);
        }
        surfaces
    }

    /// Whether gas lies before the largest triangle of a surface.
    fn faces_gas(&self, surface: &[[u32; 3]]) -> bool {
        let corners = surface.iter().map(|t| t.map(|v| DVec3::from(self.vertices[v as usize])));
        let doubled = |[a, b, c]: &[DVec3; 3]| (*b - *a).cross(*c - *a).length();
        let largest = corners.max_by(|p, q| doubled(p).total_cmp(&doubled(q)));
        largest.is_some_and(|[a, b, c]| {
            let normal = (b - a).cross(c - a).normalize_or_zero();
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            self.is_gas(((a + b + c) / 3.0 + BEFORE * longest * normal).to_array())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{hollow_box, sphere, tank};
    use super::*;
    use crate::scene::GasSide;

    fn spaces(walls: &[crate::scene::Wall]) -> Option<usize> {
        Vessel::build(walls).unwrap().gas_spaces()
    }

    #[test]
    fn what_is_closed_off_is_a_space_of_its_own() {
        let ball = sphere("ball", [0.2; 3], 0.1, 2, GasSide::Outside);
        let shell = hollow_box([0.4; 3], [0.6; 3], 0.01);
        assert_eq!(spaces(&[tank([1.0; 3])]), Some(1));
        assert_eq!(spaces(&[tank([1.0; 3]), ball.clone()]), Some(1));
        assert_eq!(spaces(&[tank([1.0; 3]), ball.clone(), shell.clone()]), Some(2));
        // What a ball fills has no gas.
        let full = sphere("full", [0.5; 3], 0.3, 2, GasSide::Outside);
        assert_eq!(spaces(&[tank([1.0; 3]), full, shell]), None);
        let told = Vessel::build(&[tank([1.0; 3]), hollow_box([0.4; 3], [0.6; 3], 0.01)]).unwrap();
        assert_eq!(told.notes(UnitSystem::Si), ["2 separate gas spaces: no gas flows between them"]);
    }
}
