//! Which walls stop elastic fabric: convex ones without holes, solid or around all of the fabric, by their flat faces. Through all others it passes,
//! which the notes of a scene tell.
//!
//! Nodes stay half the thickness of the fabric before a face. Triangles between them do not know of an edge or a corner of a body.

use glam::DVec3;

use crate::fabric::{MOST_OBSTACLES, Obstacle};
use crate::geometry::Vessel;
use crate::scene::{GasSide, Scene, Shape, Wall};

/// Faces of bodies, at most.
const MOST_FACES: usize = MOST_OBSTACLES as usize;

/// Bodies by their faces at the start, each with the wall that it is of, and the names of walls that are none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Bodies {
    pub faces: Vec<Vec<Obstacle>>,
    pub walls: Vec<usize>,
    pub passed: Vec<String>,
}

impl Bodies {
    /// Those of the walls of a scene, for fabric so thick, m, that has its nodes at these places.
    pub fn of(scene: &Scene, vessel: &Vessel, thickness: f64, nodes: &[[f64; 3]]) -> Bodies {
        let mut bodies = Bodies::default();
        for (index, wall) in scene.walls.iter().enumerate() {
            let found = bodies_of(wall, (vessel, index), 0.5 * thickness, nodes);
            let room = MOST_FACES - bodies.faces.iter().map(Vec::len).sum::<usize>();
            match found {
                Some(found) if found.iter().map(Vec::len).sum::<usize>() <= room => {
                    bodies.walls.extend(vec![index; found.len()]);
                    bodies.faces.extend(found);
                }
                _ => bodies.passed.push(wall.name.clone()),
            }
        }
        bodies
    }

    /// The same from a time on, s, with the velocities that take those that move to where they are at another; `shift_of` is by how much a wall
    /// has moved at a time, m, of one that does.
    pub fn between(
        &self,
        shift_of: impl Fn(usize, f64) -> Option<[f64; 3]>,
        [from, to]: [f64; 2],
    ) -> Vec<Vec<Obstacle>> {
        let at = |(faces, &wall): (&Vec<Obstacle>, &usize)| {
            let Some((here, there)) = shift_of(wall, from).zip(shift_of(wall, to)) else {
                return faces.clone();
            };
            let (here, there) = (DVec3::from(here), DVec3::from(there));
            let velocity = ((there - here) / (to - from)).to_array();
            let moved = |face: &Obstacle| {
                let place = (DVec3::from(face.place) + here).to_array();
                Obstacle { place, velocity, ..*face }
            };
            faces.iter().map(moved).collect()
        };
        self.faces.iter().zip(&self.walls).map(at).collect()
    }

    /// What to know of those that do not stop it.
    pub fn notes(&self) -> Vec<String> {
        let told = |wall: &String| {
            format!(
                "elastic fabric passes through wall `{wall}`: convex walls without holes stop it, {MOST_FACES} flat faces in all, those around the \
                 gas with all of the fabric inside"
            )
        };
        self.passed.iter().map(told).collect()
    }
}

fn bodies_of(wall: &Wall, meshed: (&Vessel, usize), reach: f64, nodes: &[[f64; 3]]) -> Option<Vec<Vec<Obstacle>>> {
    let face = |place: DVec3, normal: DVec3| Obstacle {
        place: (place + reach * normal).to_array(),
        normal: normal.to_array(),
        velocity: [0.0; 3],
        friction: 0.0,
    };
    match &wall.shape {
        Shape::Box { min, max, thickness, holes } => {
            let (min, max) = (DVec3::from(*min), DVec3::from(*max));
            let faces = |sign: f64| {
                DVec3::AXES.into_iter().flat_map(move |axis| [face(min, -sign * axis), face(max, sign * axis)])
            };
            let inside = |node: &[f64; 3]| {
                let node = DVec3::from(*node);
                node.cmpge(min).all() && node.cmple(max).all()
            };
            match (wall.gas, thickness) {
                // Of the room around, each side alone.
                (GasSide::Inside, None) => {
                    nodes.iter().all(inside).then(|| faces(-1.0).map(|side| vec![side]).collect())
                }
                (_, Some(_)) if holes.is_empty() => {
                    nodes.iter().all(inside).then(|| faces(-1.0).map(|side| vec![side]).collect())
                }
                (GasSide::Outside, None) => Some(vec![faces(1.0).collect()]),
                _ => None,
            }
        }
        Shape::Plane { center, normal, u, size, thickness, holes } if holes.is_empty() => {
            let (center, normal, u) = (DVec3::from(*center), DVec3::from(*normal), DVec3::from(*u));
            let axes = [(normal, *thickness), (u, size[0]), (normal.cross(u), size[1])];
            let both = |(axis, width): (DVec3, f64)| {
                [1.0, -1.0].map(|sign| face(center + 0.5 * width * sign * axis, sign * axis))
            };
            Some(vec![axes.into_iter().flat_map(both).collect()])
        }
        Shape::Cylinder { .. } | Shape::Sphere { .. } | Shape::Mesh { .. } => {
            let faces = convex_faces(meshed.0, meshed.1)?;
            let stops = |&(place, normal): &(DVec3, DVec3)| face(place, normal);
            if wall.gas == GasSide::Outside {
                return Some(vec![faces.iter().map(stops).collect()]);
            }
            let before = |(place, normal): &(DVec3, DVec3)| {
                nodes.iter().all(|node| (DVec3::from(*node) - *place).dot(*normal) > 0.0)
            };
            faces.iter().all(before).then(|| faces.iter().map(|side| vec![stops(side)]).collect())
        }
        Shape::Plane { .. } => None,
    }
}

/// How far a corner may be before a face of a convex body, over the extent of the body; and by how much unit normals of one face differ.
const FLAT: f64 = 1e-6;

/// A point and the unit normal towards the gas of each flat face of a wall, if its corners are all behind, or all before, all of them.
fn convex_faces(vessel: &Vessel, wall: usize) -> Option<Vec<(DVec3, DVec3)>> {
    let corner = |vertex: u32| DVec3::from(vessel.vertices[vertex as usize]);
    let triangles = || vessel.triangles.iter().filter(|triangle| triangle.wall as usize == wall);
    let corners: Vec<DVec3> = triangles().flat_map(|triangle| triangle.vertices).map(corner).collect();
    let first = *corners.first()?;
    let room = FLAT * corners.iter().map(|corner| corner.distance(first)).fold(0.0, f64::max);
    let mut faces: Vec<(DVec3, DVec3)> = Vec::new();
    for triangle in triangles() {
        let [a, b, c] = triangle.vertices.map(corner);
        let Some(normal) = (b - a).cross(c - a).try_normalize() else { continue };
        let same =
            |(place, known): &(DVec3, DVec3)| known.distance(normal) < FLAT && (a - *place).dot(normal).abs() < room;
        if !faces.iter().any(same) {
            faces.push((a, normal));
        }
        if faces.len() > MOST_FACES {
            return None;
        }
    }
    let sign = if vessel.walls[wall].cavity { -1.0 } else { 1.0 };
    let is_convex =
        |(place, normal): &(DVec3, DVec3)| corners.iter().all(|corner| sign * (*corner - *place).dot(*normal) < room);
    faces.iter().all(is_convex).then_some(faces)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walls(more: &str) -> Scene {
        let text = format!(
            "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[wall]]\nname = \"room\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [1.0, 1.0, 1.0]\ngas = \"inside\"\n{more}\
             [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             [model]\nparticles = 100\n"
        );
        crate::scene::parse(&text, "test.toml", std::path::Path::new("")).unwrap_or_else(|error| panic!("{error:?}"))
    }

    /// How far a place is before the face of a body that it is farthest before, m.
    fn height(body: &[Obstacle], place: [f64; 3]) -> f64 {
        let above = |face: &Obstacle| (DVec3::from(place) - DVec3::from(face.place)).dot(DVec3::from(face.normal));
        body.iter().map(above).fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn boxes_and_plates_are_bodies_and_round_walls_are_told() {
        let scene = walls(
            "[[wall]]\nname = \"block\"\nshape = \"box\"\nmin = [0.4, 0.4, 0.1]\nmax = [0.6, 0.6, 0.2]\ngas = \"outside\"\n\
             [[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.5, 0.5, 0.7]\nnormal = [0, 1, 1]\nu = [1, 0, 0]\nsize = [0.2, 0.4]\nthickness = 0.01\n\
             [[wall]]\nname = \"ball\"\nshape = \"sphere\"\ncenter = [0.2, 0.2, 0.2]\nradius = 0.05\ngas = \"outside\"\n",
        );
        let vessel = Vessel::build(&scene.walls).expect("a vessel");
        let bodies = Bodies::of(&scene, &vessel, 0.002, &[[0.5; 3]]);
        assert_eq!(bodies.faces.iter().map(Vec::len).collect::<Vec<_>>(), [1, 1, 1, 1, 1, 1, 6, 6]);
        assert_eq!(bodies.passed, ["ball"]);
        assert!(bodies.notes()[0].contains("passes through wall `ball`"), "{:?}", bodies.notes());
        let [block, plate] = [6, 7].map(|k| &bodies.faces[k]);
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
        near(height(block, [0.5, 0.5, 0.3]), 0.1 - 0.001);
        near(height(block, [0.5, 0.5, 0.15]), -0.05 - 0.001);
        near(height(block, [0.3, 0.5, 0.15]), 0.1 - 0.001);
        near(height(plate, [0.5, 0.5, 0.7]), -0.005 - 0.001);
        let along = 0.5 + 0.105 / 2f64.sqrt();
        near(height(plate, [0.5, along, 0.2 + along]), 0.1 - 0.001);
        // Twelve sides and two ends.
        let around = walls(
            "[[wall]]\nname = \"post\"\nshape = \"cylinder\"\nbase = [0.2, 0.2, 0.1]\naxis = [0, 0, 1]\nradius = 0.05\nheight = 0.3\nsegments = 12\n\
             gas = \"outside\"\n",
        );
        let vessel = Vessel::build(&around.walls).expect("a vessel");
        let post = &Bodies::of(&around, &vessel, 0.002, &[[0.5; 3]]).faces[6];
        assert_eq!(post.len(), 14);
        near(height(post, [0.2, 0.2, 0.5]), 0.1 - 0.001);
        // Fabric that is not all in the room is not held in it.
        let outside = Bodies::of(&scene, &vessel, 0.002, &[[0.5; 3], [0.5, 0.5, 1.5]]);
        assert_eq!(outside.passed, ["room", "ball"]);
    }
}
