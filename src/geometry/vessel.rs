//! All walls of a scene as one triangle mesh, and where the gas is.
//!
//! Every wall is a solid: what its closed surface encloses, or for a cavity wall (gas inside) all that lies
//! outside the surface. Gas is where no solid is: `solid_depth` counts the solids that hold a point.
//!
//! Gas volume. Over the box B around all walls, with depth d(x): 1[d = 0] = (1 - d) + max(d - 1, 0). The
//! integral of the first term is exact by the divergence theorem, V_B (1 - cavities) + sum of cavity volumes -
//! sum of solid volumes; the second, the overlap of solids, is zero unless solids overlap, and is then summed
//! along lines. So walls that do not overlap leave an exact volume, and a plate let into a wall costs an error
//! of its hidden rim only. Gas is in all cavities: solids beyond the box that all cavities share count for nothing, and where solids overlap by
//! more than a little the gas in that box is summed along lines instead.
//!
//! Invariants: every wall is watertight and consistently oriented, normals point into the gas, the gas is
//! bounded and its volume positive.

use super::GeometryError;
use super::bag::Bag;
use super::error::Places;
use super::lines::{Crossing, LineIndex, intervals};
use super::sampling::{Line, r2, sum};
use super::wall_mesh::{FoundHole, Mended};
use crate::scene::Face;
use glam::DVec3;

/// Lines that look for overlaps, and those that measure them.
pub(super) const SEARCH_LINES: u64 = 1 << 14;
pub(super) const VOLUME_LINES: u64 = 1 << 18;

/// Volumes and lengths below this fraction of the vessel's are rounding.
pub(super) const ROUNDING: f64 = 1e-12;
/// Of the gas: where solids overlap by more, the gas is summed and not the overlap.
const LITTLE: f64 = 0.01;
/// Lines that measure how much of a solid lies outside of the cavity.
const SHARE_LINES: u64 = 1 << 12;
/// Corners of a solid that are looked at first.
const MOST_CORNERS: usize = 256;
/// And where the box that solids reach, around that of the gas, is larger than it by more than this.
const FAR: f64 = 8.0;

#[derive(Debug, Clone)]
pub struct Vessel {
    /// m.
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<Triangle>,
    pub holes: Vec<FoundHole>,
    /// In the scene's order.
    pub walls: Vec<WallInfo>,
    /// Smallest and largest coordinates of all vertices, m.
    pub bounds: ([f64; 3], [f64; 3]),
    /// By fabric, the closed ones at the start of the run.
    pub bags: Vec<Option<Bag>>,
    lines: LineIndex,
    cavities: i32,
    gas_volume: f64,
    overlap: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Counter-clockwise seen from the gas.
    pub vertices: [u32; 3],
    /// Index of the wall.
    pub wall: u32,
    /// The part that it is of: a face of a box; of a hollow box a face of the cavity, or its outside (the walls of its holes have
    /// none); of a mesh the parts that the scene names.
    pub face: Option<Face>,
}

/// Solids of one wall that overlap each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlaps {
    /// Pairs of triangles that cross.
    pub count: usize,
    pub first: Places,
}

#[derive(Debug, Clone, PartialEq)]
pub struct WallInfo {
    pub name: String,
    /// m2, all of the surface.
    pub area: f64,
    /// m3, positive: what the surface encloses, solid or (of a cavity) not.
    pub volume: f64,
    /// The gas is inside: the solid is all that lies outside the surface.
    pub cavity: bool,
    /// What of a mesh file had to be mended.
    pub mended: Option<Mended>,
    /// Where solids of a mesh file overlap.
    pub overlaps: Option<Overlaps>,
}

impl Vessel {
    /// Walls that are meshed: where the gas is, but not how much.
    pub(super) fn unmeasured(
        vertices: &[DVec3],
        triangles: Vec<Triangle>,
        holes: Vec<FoundHole>,
        walls: Vec<WallInfo>,
    ) -> Vessel {
        let (min, max) = bounds_of(vertices);
        Vessel {
            lines: LineIndex::new(vertices, triangles.iter().map(|t| (t.vertices, t.wall)), min, max),
            vertices: vertices.iter().map(|v| v.to_array()).collect(),
            triangles,
            holes,
            cavities: walls.iter().filter(|w| w.cavity).count() as i32,
            walls,
            bounds: (min.to_array(), max.to_array()),
            bags: Vec::new(),
            gas_volume: 0.0,
            overlap: 0.0,
        }
    }

    /// The same walls, each moved by its vector, m; where the gas is, but not how much.
    pub fn moved(&self, by: &[[f64; 3]]) -> Vessel {
        let mut moved = self.clone();
        for triangle in &self.triangles {
            for vertex in triangle.vertices.map(|vertex| vertex as usize) {
                // Walls share no vertices, so it does not matter that triangles do.
                let way = by[triangle.wall as usize];
                moved.vertices[vertex] = std::array::from_fn(|axis| self.vertices[vertex][axis] + way[axis]);
            }
        }
        for hole in &mut moved.holes {
            let way = by[hole.wall as usize];
            for place in std::iter::once(&mut hole.center).chain(&mut hole.outline) {
                *place = std::array::from_fn(|axis| place[axis] + way[axis]);
            }
        }
        moved.index(|_| true);
        moved
    }

    /// The vessel without some of its walls, none of them a cavity: where there would be gas, but not how much. Triangles
    /// and vertices keep their places in their lists.
    pub fn without(&self, left_out: impl Fn(usize) -> bool) -> Vessel {
        let mut rest = self.clone();
        for (_, wall) in rest.walls.iter_mut().enumerate().filter(|(wall, _)| left_out(*wall)) {
            wall.volume = 0.0;
        }
        rest.index(|wall| !left_out(wall));
        rest
    }

    /// Measures a moved vessel.
    ///
    /// # Errors
    /// If there is no gas left.
    pub fn measured(mut self) -> Result<Vessel, GeometryError> {
        self.measure()?;
        Ok(self)
    }

    fn index(&mut self, kept: impl Fn(usize) -> bool) {
        let vertices: Vec<DVec3> = self.vertices.iter().map(|&vertex| DVec3::from(vertex)).collect();
        let (min, max) = bounds_of(&vertices);
        let triangles = self.triangles.iter().filter(|triangle| kept(triangle.wall as usize));
        self.lines = LineIndex::new(&vertices, triangles.map(|t| (t.vertices, t.wall)), min, max);
        self.bounds = (min.to_array(), max.to_array());
    }

    /// The number of solids that hold the point (m): zero in the gas.
    pub fn solid_depth(&self, p: [f64; 3]) -> i32 {
        let mut depth = self.cavities;
        self.lines.cross(p[1], p[2], |c| {
            if c.x > p[0] {
                depth += c.sign;
            }
        });
        depth
    }

    /// Calls `visit` with each crossing of the line along x through a point.
    pub(super) fn lines_through(&self, p: [f64; 3], visit: impl FnMut(Crossing)) {
        self.lines.cross(p[1], p[2], visit);
    }

    pub fn is_gas(&self, p: [f64; 3]) -> bool {
        self.solid_depth(p) == 0
    }

    /// The x-intervals (m) of gas along the line through (y, z), in order.
    pub fn gas_intervals(&self, y: f64, z: f64) -> Vec<(f64, f64)> {
        let mut line = Line::default();
        self.gas_along(y, z, &mut line);
        line.gas
    }

    /// The same into `line.gas`.
    pub(super) fn gas_along(&self, y: f64, z: f64, line: &mut Line) {
        self.crossings(y, z, &mut line.crossings);
        intervals(&line.crossings, self.cavities, |depth| depth == 0, &mut line.gas);
    }

    /// All crossings of a line, sorted by x.
    pub(super) fn crossings(&self, y: f64, z: f64, out: &mut Vec<Crossing>) {
        out.clear();
        self.lines.cross(y, z, |c| out.push(c));
        out.sort_by(|a, b| a.x.total_cmp(&b.x).then((a.wall, a.sign).cmp(&(b.wall, b.sign))));
    }

    /// m3; exact unless walls overlap (see the head of this module).
    pub fn gas_volume(&self) -> f64 {
        self.gas_volume
    }

    /// Do solids overlap? Found by lines: overlaps of less than about 1e-4 of the vessel's cross-section are
    /// missed, as is their share of the volume.
    pub fn overlaps(&self) -> bool {
        self.overlap > 0.0
    }

    /// Line `i` of the sequence over the bounds: (y, z).
    pub(super) fn place(&self, i: u64) -> [f64; 2] {
        let (min, max) = self.bounds;
        let [u, v] = r2(i);
        [min[1] + u * (max[1] - min[1]), min[2] + v * (max[2] - min[2])]
    }

    pub(super) fn measure(&mut self) -> Result<(), GeometryError> {
        let of_walls: Vec<Extent> = (0..self.walls.len()).map(|wall| self.extent_of(wall)).collect();
        let shared = self.walls.iter().zip(&of_walls).filter(|(wall, _)| wall.cavity).map(|(_, extent)| *extent);
        let bounds = (DVec3::from(self.bounds.0), DVec3::from(self.bounds.1));
        let shared = shared.fold(bounds, |all, one| meet(&all, &one));
        if !has_room(&shared) {
            return Err(GeometryError::NoGas);
        }
        // A wall that is left out has no volume.
        let counts = |wall: usize| {
            let info = &self.walls[wall];
            info.cavity || info.volume > 0.0 && has_room(&meet(&of_walls[wall], &shared))
        };
        let counted: Vec<bool> = (0..self.walls.len()).map(counts).collect();
        let counting = || of_walls.iter().zip(&counted).filter(|(_, counts)| **counts).map(|(extent, _)| *extent);
        let around = counting().reduce(|all, one| join(&all, &one)).unwrap_or(bounds);
        let all = volume_of(&around);
        let overlap = |lines: u64| {
            self.along_lines(&around, lines, |line| {
                line.crossings.retain(|crossing| counted[crossing.wall as usize]);
                self.overlap_length(&line.crossings, &around)
            })
        };
        // Of solids that reach far out few lines meet the gas.
        let solids = of_walls.iter().enumerate().filter(|(wall, _)| counted[*wall] && !self.walls[*wall].cavity);
        let reached = solids.fold(shared, |all, (_, one)| join(&all, one));
        let far = volume_of(&reached) > FAR * volume_of(&shared);
        let seen = overlap(SEARCH_LINES);
        let overlap = if seen > ROUNDING * all && !far { overlap(VOLUME_LINES) } else { seen };
        let total = |cavity: bool| {
            let walls = self.walls.iter().zip(&counted).filter(|(wall, counts)| **counts && wall.cavity == cavity);
            walls.map(|(wall, _)| wall.volume).sum::<f64>()
        };
        let mut volume = all * f64::from(1 - self.cavities) + total(true) - total(false) + overlap;
        if far || overlap > LITTLE * volume {
            volume = self.along_lines(&shared, VOLUME_LINES, |line| {
                intervals(&line.crossings, self.cavities, |depth| depth == 0, &mut line.gas);
                line.gas.iter().map(|(from, to)| to - from).sum()
            });
        }
        if volume.is_nan() || volume <= ROUNDING * all {
            return Err(GeometryError::NoGas);
        }
        self.overlap = overlap;
        self.gas_volume = volume;
        Ok(())
    }

    /// The integral over a box of what `length` makes of the crossings of each of so many lines through it.
    fn along_lines(&self, extent: &Extent, lines: u64, length: impl Fn(&mut Line) -> f64 + Sync) -> f64 {
        let (min, size) = (extent.0, extent.1 - extent.0);
        let [sum] = sum(lines, |i, line| {
            let [u, v] = r2(i);
            self.crossings(min.y + u * size.y, min.z + v * size.z, &mut line.crossings);
            [length(line)]
        });
        size.y * size.z * sum / lines as f64
    }

    /// The share of a solid's volume that lies outside of a cavity (where there are several: of any), known to about .01 by lines;
    /// 0 of a cavity.
    pub fn outside_share(&self, wall: usize) -> f64 {
        let info = &self.walls[wall];
        if info.cavity || info.volume <= 0.0 {
            return 0.0;
        }
        // One whose corners are all within is taken for within.
        let own = self.triangles.iter().filter(|triangle| triangle.wall as usize == wall).flat_map(|t| t.vertices);
        if own.take(MOST_CORNERS).all(|corner| self.is_enclosed(self.vertices[corner as usize])) {
            return 0.0;
        }
        let outside = self.along_lines(&self.extent_of(wall), SHARE_LINES, |line| {
            let (mut own, mut around, mut length) = (0, self.cavities, 0.0);
            for pair in line.crossings.windows(2) {
                let crossed = pair[0].wall as usize;
                own -= if crossed == wall { pair[0].sign } else { 0 };
                around -= if self.walls[crossed].cavity { pair[0].sign } else { 0 };
                length += if own > 0 && around > 0 { pair[1].x - pair[0].x } else { 0.0 };
            }
            length
        });
        outside / info.volume
    }

    /// Whether all cavities hold the point, m.
    fn is_enclosed(&self, p: [f64; 3]) -> bool {
        let mut outside = self.cavities;
        self.lines.cross(p[1], p[2], |c| {
            if c.x > p[0] && self.walls[c.wall as usize].cavity {
                outside += c.sign;
            }
        });
        outside == 0
    }

    pub(super) fn extent_of(&self, wall: usize) -> Extent {
        let own = self.triangles.iter().filter(|triangle| triangle.wall as usize == wall);
        let corners: Vec<DVec3> =
            own.flat_map(|triangle| triangle.vertices).map(|v| DVec3::from(self.vertices[v as usize])).collect();
        bounds_of(&corners)
    }

    /// Integral of max(depth - 1, 0) along a line through a box.
    fn overlap_length(&self, crossings: &[Crossing], extent: &Extent) -> f64 {
        let (min, max) = (extent.0.x, extent.1.x);
        let mut depth = self.cavities;
        let mut from = min;
        let mut length = 0.0;
        for c in crossings {
            length += f64::from((depth - 1).max(0)) * (c.x - from);
            depth -= c.sign;
            from = c.x;
        }
        length + f64::from((depth - 1).max(0)) * (max - from)
    }
}

/// Low and high corner of a box, m.
type Extent = (DVec3, DVec3);

fn meet(a: &Extent, b: &Extent) -> Extent {
    (a.0.max(b.0), a.1.min(b.1))
}

fn join(a: &Extent, b: &Extent) -> Extent {
    (a.0.min(b.0), a.1.max(b.1))
}

fn has_room(extent: &Extent) -> bool {
    extent.0.cmplt(extent.1).all()
}

fn volume_of(extent: &Extent) -> f64 {
    (extent.1 - extent.0).element_product()
}

pub(super) fn bounds_of(vertices: &[DVec3]) -> (DVec3, DVec3) {
    let far = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    vertices.iter().fold(far, |(min, max), v| (min.min(*v), max.max(*v)))
}
