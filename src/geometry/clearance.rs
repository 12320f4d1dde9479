//! Up to [`PLANES`] planes for each cell near walls, of which each wall in it and the 26 cells around lies behind one, so that a flight whose ends are
//! both before all of them meets none: a line that starts and ends on one side of a plane does not cross it.
//!
//! A plane is one word: three signed bytes of a normal, its largest component 127 or -127, and the least of normal . (place -
//! middle of the cell), in [`CLEARANCE_UNIT`] cells. All is rounded away from the walls. Alone it is, of the normals of these walls and the mean of
//! them, the one that leaves the middle of the cell farthest before the plane: beside one flat wall that wall, to less than a
//! tenth of a cell; along an edge a chamfer. Where more of the cell lies before several, one or two are planes that walls lie in, and the
//! last is the best of the walls that are not behind these: in an edge or a corner, or between two walls that face each other, the walls themselves.

use glam::DVec3;

use super::sampling::map;
use super::{CellClass, Grid, TriangleGrid};

/// What one step of the least is, in cells along a normal of 127. No place of the 27 cells has more than 1.5 x 3 x 127 = 571.5.
pub const CLEARANCE_UNIT: f64 = 5.0;
/// No place is before this plane: 0 > 635.
const NOWHERE: u32 = 0x7f00_0000;
/// The leasts of planes are less than this, and more than that of [`NO_PLANE`].
const LEASTS: f64 = 127.0;
/// All places are before this one.
pub const NO_PLANE: u32 = 0x8000_0000;
/// Planes of a cell.
pub const PLANES: usize = 3;
/// Of a least, more than rounding of f32 makes of it.
const SLACK: f64 = 0.01;
/// So many triangles around a cell and directions of them are looked at, and where there are more triangles, no place is before a
/// plane: what it costs to find planes stays a small part of a set-up, whatever the mesh.
const MOST_TRIANGLES: usize = 64;
const MOST_NORMALS: usize = 8;
/// And so many planes that walls lie in.
const MOST_FACES: usize = 6;

/// The planes of a cell, [`NO_PLANE`] behind the last, and the one that all walls are behind, [`NOWHERE`] if there is none.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Clearance {
    pub planes: [u32; PLANES],
    pub alone: u32,
}

/// One of each cell that is [`CellClass::Gas`] or [`CellClass::Cut`], in order. `margin` (m) must be that with which the lists were built.
pub fn clearances(triangles: &TriangleGrid, grid: &Grid, margin: f64) -> Vec<Clearance> {
    let near: Vec<usize> = (0..triangles.class.len())
        .filter(|&cell| matches!(triangles.class[cell], CellClass::Gas | CellClass::Cut))
        .collect();
    map(near.len(), |k, _| clearance(triangles, grid, margin / grid.cell, near[k]))
}

fn clearance(triangles: &TriangleGrid, grid: &Grid, margin: f64, cell: usize) -> Clearance {
    let [nx, ny, _] = grid.cells.map(|n| n as usize);
    let place = [cell % nx, cell / nx % ny, cell / nx / ny];
    let mut near: Vec<u32> = Vec::new();
    for around in 0..27 {
        let offsets = [around % 3, around / 3 % 3, around / 9];
        let at: [usize; 3] = std::array::from_fn(|axis| (place[axis] + offsets[axis]).wrapping_sub(1));
        if (0..3).all(|axis| at[axis] < grid.cells[axis] as usize) {
            near.extend(triangles.in_cell(grid.cell_index(at.map(|i| i as u32))));
        }
    }
    near.sort_unstable();
    near.dedup();
    let nowhere = Clearance { planes: [NOWHERE, NO_PLANE, NO_PLANE], alone: NOWHERE };
    if near.len() > MOST_TRIANGLES {
        return nowhere;
    }
    let middle = DVec3::from(place.map(|i| i as f64 + 0.5));
    let per_cell = f64::from(1u32 << grid.cell_bits);
    let mut walls: Vec<(DVec3, Vec<DVec3>)> = Vec::new();
    for triangle in near.iter().map(|&k| &triangles.triangles[k as usize]) {
        let corners = triangle.corners.map(|corner| DVec3::from(corner.map(|q| f64::from(q) / per_cell)) - middle);
        let seen = clipped(corners.to_vec(), 1.5 + margin);
        // What of it is seen from another cell of these alone is too far away.
        if !seen.is_empty() {
            walls.push((DVec3::from(triangle.normal.map(f64::from)), seen));
        }
    }
    // Beside a wall that none of these cells lists (the end of the grid) nothing is known.
    Around::new(&walls, margin).planes().unwrap_or(nowhere)
}

/// Which of the walls around a cell: a bit of each.
type Set = u64;

fn set_of(walls: impl Iterator<Item = bool>) -> Set {
    walls.enumerate().fold(0, |set, (k, is_in)| set | Set::from(is_in) << k)
}

/// A plane that the walls of some set lie behind.
#[derive(Clone, Copy)]
struct Plane {
    normal: DVec3,
    least: f64,
}

/// The walls around a cell, and the directions that planes may have.
struct Around {
    margin: f64,
    normals: Vec<DVec3>,
    /// By direction and wall, how far it reaches along that.
    heights: Vec<Vec<f64>>,
    /// By direction the walls that face it by less than a right angle.
    facing: Vec<Set>,
    /// The walls that face in the direction, and those behind their plane, these included; of the mean direction none.
    faces: Vec<(Set, Set)>,
    all: Set,
}

impl Around {
    /// Of walls with their normals and their corners, as far as they are near.
    fn new(walls: &[(DVec3, Vec<DVec3>)], margin: f64) -> Around {
        let mut normals: Vec<DVec3> = Vec::new();
        for (normal, _) in walls {
            if !normals.contains(normal) {
                normals.push(*normal);
            }
        }
        let mean: DVec3 = normals.iter().sum();
        normals.truncate(MOST_NORMALS);
        let same = |normal: &DVec3| set_of(walls.iter().map(|(own, _)| own == normal));
        let own: Vec<Set> = normals.iter().map(same).collect();
        normals.push(mean);
        let scaled = normals.iter().map(|normal| (normal * (127.0 / normal.abs().max_element())).round());
        let normals: Vec<DVec3> = scaled.filter(|normal| normal.is_finite()).collect();
        let height = |normal: DVec3, corners: &[DVec3]| corners.iter().map(|c| c.dot(normal)).fold(f64::MIN, f64::max);
        let heights: Vec<Vec<f64>> =
            normals.iter().map(|&n| walls.iter().map(|(_, corners)| height(n, corners)).collect()).collect();
        let faces = own
            .into_iter()
            .zip(&heights)
            .map(|(own, heights)| {
                let top = highest(heights, own);
                (own, set_of(heights.iter().map(|&height| height <= top)))
            })
            .collect();
        let facing = normals.iter().map(|n| set_of(walls.iter().map(|(own, _)| own.dot(*n) > 0.0))).collect();
        Around { margin, normals, heights, facing, faces, all: set_of(walls.iter().map(|_| true)) }
    }

    /// The plane of this direction behind which these walls lie, if there is one. Where the first of them does not face the direction, what is before the plane
    /// is behind that wall, and so no gas: there is none.
    fn behind(&self, direction: usize, walls: Set) -> Option<Plane> {
        let (normal, heights) = (self.normals[direction], &self.heights[direction]);
        let first = highest(heights, walls);
        if highest(heights, walls & self.facing[direction]) < first {
            return None;
        }
        let farthest = first + self.margin * normal.length();
        let least = (farthest / CLEARANCE_UNIT + SLACK).ceil().max(-LEASTS);
        (least < LEASTS).then_some(Plane { normal, least })
    }

    /// The plane behind which these walls lie, from which the middle of the cell is farthest.
    fn best(&self, walls: Set) -> Option<Plane> {
        let depth = |plane: &Plane| plane.least / plane.normal.length();
        let planes = (0..self.normals.len()).filter_map(|direction| self.behind(direction, walls));
        planes.min_by(|a, b| depth(a).total_cmp(&depth(b)))
    }

    /// The planes of these faces, and the best of the other walls.
    fn after(&self, faces: &[usize]) -> Option<Vec<Plane>> {
        let mut left = self.all;
        let mut planes = Vec::with_capacity(PLANES);
        for &face in faces {
            planes.push(self.behind(face, self.faces[face].0)?);
            left &= !self.faces[face].1;
        }
        if left != 0 {
            planes.push(self.best(left)?);
        }
        Some(planes)
    }

    /// One, or as many as leave more of the cell free.
    fn planes(&self) -> Option<Clearance> {
        if self.all == 0 {
            return None;
        }
        let count = self.faces.len().min(MOST_FACES);
        let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| [a, b]));
        let ways = std::iter::once(vec![]).chain((0..count).map(|a| vec![a])).chain(pairs.map(|pair| pair.to_vec()));
        let mut chosen = (0, None);
        for planes in ways.filter_map(|faces| self.after(&faces)) {
            let free = places_before(&planes);
            if chosen.1.is_none() || free > chosen.0 {
                chosen = (free, Some(planes));
            }
            if chosen.0 == PLACES.pow(3) {
                break;
            }
        }
        let encoded = |plane: Plane| encoded(plane.normal, plane.least);
        let mut planes = [NO_PLANE; PLANES];
        planes.iter_mut().zip(chosen.1?).for_each(|(word, plane)| *word = encoded(plane));
        Some(Clearance { planes, alone: self.best(self.all).map_or(NOWHERE, encoded) })
    }
}

/// Places along an axis of a cell that are looked at.
const PLACES: usize = 4;

/// How many of them lie before all planes.
fn places_before(planes: &[Plane]) -> usize {
    let at = |k: usize| (k as f64 + 0.5) / PLACES as f64 - 0.5;
    let places =
        (0..PLACES.pow(3)).map(|k| DVec3::new(at(k % PLACES), at(k / PLACES % PLACES), at(k / PLACES / PLACES)));
    let before = |place: DVec3, plane: &Plane| place.dot(plane.normal) > plane.least * CLEARANCE_UNIT;
    places.filter(|&place| planes.iter().all(|plane| before(place, plane))).count()
}

fn highest(heights: &[f64], walls: Set) -> f64 {
    heights.iter().enumerate().filter(|(k, _)| walls >> k & 1 == 1).map(|(_, &height)| height).fold(f64::MIN, f64::max)
}

fn encoded(normal: DVec3, least: f64) -> u32 {
    let [x, y, z] = normal.to_array().map(|c| u32::from(c as i8 as u8));
    x | y << 8 | z << 16 | u32::from(least as i8 as u8) << 24
}

/// The part of a convex polygon in the cube of this half edge around the origin (Sutherland and Hodgman 1974).
fn clipped(mut polygon: Vec<DVec3>, half: f64) -> Vec<DVec3> {
    for outward in DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]) {
        let beyond = |point: DVec3| point.dot(outward) - half;
        let mut kept = Vec::with_capacity(polygon.len() + 1);
        for (k, &to) in polygon.iter().enumerate() {
            let from = polygon[(k + polygon.len() - 1) % polygon.len()];
            let (before, after) = (beyond(from), beyond(to));
            if (before > 0.0) != (after > 0.0) {
                kept.push(from + (to - from) * (before / (before - after)));
            }
            if after <= 0.0 {
                kept.push(to);
            }
        }
        polygon = kept;
    }
    polygon
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_are_clipped_to_the_cube() {
        let large = vec![DVec3::new(-9.0, -9.0, 0.5), DVec3::new(9.0, -9.0, 0.5), DVec3::new(0.0, 9.0, 0.5)];
        let square = clipped(large, 1.0);
        assert_eq!(square.len(), 4, "{square:?}");
        for corner in square {
            assert_eq!(corner.abs(), DVec3::new(1.0, 1.0, 0.5));
        }
        assert!(clipped(vec![DVec3::splat(2.0), DVec3::new(3.0, 2.0, 0.0), DVec3::new(2.0, 3.0, 0.0)], 1.0).is_empty());
    }

    #[test]
    fn words_hold_signed_bytes() {
        assert_eq!(encoded(DVec3::new(-127.0, 0.0, 1.0), -2.0), 0xfe01_0081);
    }
}
