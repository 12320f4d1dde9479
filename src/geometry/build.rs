//! The walls of a scene, each meshed and checked, become one vessel.

use super::GeometryError;
use super::closed::{area, check_closed, signed_volume};
use super::error::Places;
use super::primitives::mesh_of;
use super::sampling::map;
use super::vessel::{ROUNDING, SEARCH_LINES, Triangle, Vessel, WallInfo, bounds_of};
use crate::scene::{GasSide, Shape, Wall};
use glam::DVec3;

impl Vessel {
    /// The mesh of all walls. Mesh files are read here.
    pub fn build(walls: &[Wall]) -> Result<Vessel, GeometryError> {
        let mut vertices: Vec<DVec3> = Vec::new();
        let mut triangles: Vec<Triangle> = Vec::new();
        let (mut holes, mut infos) = (Vec::new(), Vec::new());
        for (index, wall) in walls.iter().enumerate() {
            let subject = subject(wall);
            let cavity = is_cavity(wall, &subject)?;
            let of_wall = |error: GeometryError| error.of_wall(&wall.shape);
            let mut mesh = mesh_of(&wall.shape, index as u32, &subject).map_err(of_wall)?;
            check_closed(&subject, &mesh.vertices, &mesh.triangles).map_err(of_wall)?;
            let volume = signed_volume(&mesh.vertices, &mesh.triangles);
            let (min, max) = bounds_of(&mesh.vertices);
            let size = (max - min).max_element();
            if volume.is_nan() || volume.abs() <= ROUNDING * size * size * size {
                return Err(GeometryError::NoVolume { wall: subject });
            }
            if (volume < 0.0) != cavity {
                mesh.flip();
            }
            infos.push(WallInfo {
                name: wall.name.clone(),
                area: area(&mesh.vertices, &mesh.triangles),
                volume: volume.abs(),
                cavity,
                mended: mesh.mended,
                overlaps: None,
            });
            let first = vertices.len() as u32;
            let count = triangles.len() + mesh.triangles.len() + vertices.len() + mesh.vertices.len();
            if u32::try_from(count).is_err() {
                return Err(GeometryError::TooMany { count });
            }
            vertices.extend(&mesh.vertices);
            triangles.extend(mesh.triangles.iter().zip(&mesh.faces).map(|(t, &face)| Triangle {
                vertices: t.map(|v| v + first),
                wall: index as u32,
                face,
            }));
            holes.append(&mut mesh.holes);
        }
        if !infos.iter().any(|w| w.cavity) {
            return Err(GeometryError::Unbounded);
        }
        let mut vessel = Vessel::unmeasured(&vertices, triangles, holes, infos);
        vessel.find_inside_out(walls)?;
        for (index, wall) in walls.iter().enumerate().filter(|(_, wall)| matches!(wall.shape, Shape::Mesh { .. })) {
            let found = vessel.find_crossings(index, &subject(wall));
            vessel.walls[index].overlaps = found.map_err(|error| error.of_wall(&wall.shape))?;
        }
        vessel.measure()?;
        Ok(vessel)
    }

    /// A wall's own number of solids is nowhere negative, and nowhere above one for a cavity. (Parts of a solid
    /// may overlap: their union is the solid.)
    fn find_inside_out(&self, walls: &[Wall]) -> Result<(), GeometryError> {
        let (min, max) = self.bounds;
        let tolerance = 1e-9 * (max[0] - min[0]);
        let outside: Vec<i32> = self.walls.iter().map(|w| i32::from(w.cavity)).collect();
        let found = map(SEARCH_LINES as usize, |i, line| {
            let [y, z] = self.place(i as u64);
            self.crossings(y, z, &mut line.crossings);
            let mut depth = outside.clone();
            line.crossings.windows(2).find_map(|pair| {
                depth[pair[0].wall as usize] -= pair[0].sign;
                let wall = (0..depth.len()).find(|&w| depth[w] < 0 || depth[w] > 1 && self.walls[w].cavity)?;
                (pair[1].x - pair[0].x > tolerance).then(|| (wall, DVec3::new((pair[0].x + pair[1].x) / 2.0, y, z)))
            })
        });
        match found.into_iter().flatten().next() {
            Some((wall, place)) => {
                let error = GeometryError::InsideOut { wall: subject(&walls[wall]), place: Places::one(place) };
                Err(error.of_wall(&walls[wall].shape))
            }
            None => Ok(()),
        }
    }
}

/// How errors name a wall.
fn subject(wall: &Wall) -> String {
    match &wall.shape {
        Shape::Mesh { path, .. } => format!("wall `{}` ({})", wall.name, path.display()),
        _ => format!("wall `{}`", wall.name),
    }
}

/// Is the solid outside the surface? Shapes with a thickness are solids; mesh files may be either.
fn is_cavity(wall: &Wall, subject: &str) -> Result<bool, GeometryError> {
    let thick = matches!(wall.shape, Shape::Box { thickness: Some(_), .. } | Shape::Plane { .. });
    let (found, allowed) = match (wall.gas, thick) {
        (GasSide::Inside, false) => return Ok(true),
        (GasSide::Outside, _) | (GasSide::Both, true) => return Ok(false),
        (GasSide::Both, false) if matches!(wall.shape, Shape::Mesh { .. }) => return Ok(false),
        (GasSide::Both, false) => ("both", "inside or outside"),
        (GasSide::Inside, true) => ("inside", "both"),
    };
    Err(GeometryError::Side { wall: subject.into(), found, allowed })
}
