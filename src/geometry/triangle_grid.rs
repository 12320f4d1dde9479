//! The triangles on the cell grid: corners in the fixed point of positions, and which cells each one touches.
//!
//! A triangle is listed in every cell whose box, grown by a margin on all sides, it touches (separating axes,
//! Akenine-Moeller 2001, with a tolerance of 1e-9 cells: never too few). Each axis bounds a linear function of
//! the cell's centre, so a row of cells along x costs one intersection of intervals, however long it is.
//!
//! A wall that moves is in lists of its own, in its body frame ([`Body`]): what comes near it looks there from its frame.
//!
//! Invariants: no fixed triangle is degenerate or turned over by the rounding; shared vertices keep one id and
//! the same corners; each list is in ascending order; a class other than `Cut` means an empty list.

use std::ops::Range;

use super::GeometryError;
use super::Grid;
use super::Vessel;
use super::error::Places;
use glam::DVec3;

/// Slack of the overlap test in cells; coordinates up to 2^15 cells carry rounding errors near 1e-11.
const SLACK: f64 = 1e-9;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedTriangle {
    /// Quanta of the grid, non-negative; counter-clockwise seen from the gas.
    pub corners: [[i32; 3]; 3],
    /// Vertex ids, those of `Vessel::vertices`.
    pub ids: [u32; 3],
    /// Unit normal of the fixed corners, into the gas.
    pub normal: [f32; 3],
    /// Index in `Vessel::triangles`.
    pub source: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CellClass {
    /// Gas, and no triangle in any of the 27 cells around.
    Clear,
    /// No triangle, wholly gas.
    Gas,
    /// Has triangles.
    Cut,
    /// No triangle, wholly outside the gas.
    Solid,
}

#[derive(Debug, Clone)]
pub struct TriangleGrid {
    /// One for each of the vessel's triangles, in its order.
    pub triangles: Vec<FixedTriangle>,
    /// The triangles of cell `c` are `list[start[c]..start[c + 1]]`.
    pub start: Vec<u32>,
    pub list: Vec<u32>,
    /// One per cell.
    pub class: Vec<CellClass>,
    /// The walls that move.
    pub bodies: Vec<Body>,
}

/// Which triangles are listed where: those of place `i` are `list[start[i]..start[i + 1]]`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Lists {
    pub start: Vec<u32>,
    pub list: Vec<u32>,
}

/// A wall that moves, in its body frame: where it is at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// The first cell of the box around its triangles, and the cells of the box by axis.
    pub low: [u32; 3],
    pub size: [u32; 3],
    /// The triangles in each cell of the box, x fastest.
    pub cells: Lists,
    /// The triangles whose boxes touch each row of cells along x, y fastest, each once: marked with [`EARLIER_Y`] and [`EARLIER_Z`]
    /// if the box touches the row before along that axis too.
    pub rows: Lists,
}

/// Marks beside the number of a triangle in the lists of rows.
pub(super) const EARLIER_Y: u32 = 1 << 31;
pub(super) const EARLIER_Z: u32 = 1 << 30;

impl Lists {
    /// `each` tells of every triangle in ascending order the places that list it, the same each time.
    fn of(places: usize, each: impl Fn(&mut dyn FnMut(u32, Range<usize>))) -> Result<Lists, GeometryError> {
        let mut sizes = vec![0u64; places];
        each(&mut |_, at| sizes[at].iter_mut().for_each(|n| *n += 1));
        let entries: u64 = sizes.iter().sum();
        if u32::try_from(entries).is_err() {
            return Err(GeometryError::TooMany { count: entries as usize });
        }
        let mut start = Vec::with_capacity(places + 1);
        let mut total = 0u32;
        start.push(0);
        start.extend(sizes.iter().map(|&n| {
            total += n as u32;
            total
        }));
        let mut next = start.clone();
        let mut list = vec![0; total as usize];
        each(&mut |triangle, at| {
            for n in &mut next[at] {
                list[*n as usize] = triangle;
                *n += 1;
            }
        });
        Ok(Lists { start, list })
    }

    /// Triangles (indices) listed in a place.
    pub fn of_place(&self, place: usize) -> &[u32] {
        &self.list[self.start[place] as usize..self.start[place + 1] as usize]
    }
}

impl Body {
    fn new(own: &[(usize, &Footprint)]) -> Result<Body, GeometryError> {
        if let Some((last, _)) = own.last().filter(|(last, _)| *last >= EARLIER_Z as usize) {
            return Err(GeometryError::TooMany { count: *last });
        }
        let ends = |axis: usize, end: usize| own.iter().map(move |(_, footprint)| footprint.range[axis][end]);
        let low: [u32; 3] = std::array::from_fn(|axis| ends(axis, 0).min().unwrap_or(0));
        let size: [u32; 3] = std::array::from_fn(|axis| ends(axis, 1).max().map_or(0, |high| high - low[axis] + 1));
        let [nx, ny, nz] = size.map(|n| n as usize);
        let row = |y: u32, z: u32| (z - low[2]) as usize * ny + (y - low[1]) as usize;
        let cells = Lists::of(nx * ny * nz, |list| {
            for (triangle, footprint) in own {
                footprint.rows(|xs, y, z| {
                    let at = row(y, z) * nx;
                    list(*triangle as u32, at + (xs.start - low[0]) as usize..at + (xs.end - low[0]) as usize);
                });
            }
        })?;
        let rows = Lists::of(ny * nz, |list| {
            for (triangle, footprint) in own {
                let [_, ys, zs] = footprint.range;
                for (z, y) in (zs[0]..=zs[1]).flat_map(|z| (ys[0]..=ys[1]).map(move |y| (z, y))) {
                    let marks = if y > ys[0] { EARLIER_Y } else { 0 } | if z > zs[0] { EARLIER_Z } else { 0 };
                    list(*triangle as u32 | marks, row(y, z)..row(y, z) + 1);
                }
            }
        })?;
        Ok(Body { low, size, cells, rows })
    }
}

/// The walls of a vessel that move.
pub struct MovingWalls<'a> {
    /// The vessel without them.
    pub still: &'a Vessel,
    pub count: usize,
    /// The number of a wall among them.
    pub number: &'a dyn Fn(usize) -> Option<usize>,
}

impl TriangleGrid {
    /// `margin` (m) grows every cell. Fails where a triangle lies outside the grid or loses its area to rounding.
    pub fn build(vessel: &Vessel, grid: &Grid, margin: f64) -> Result<TriangleGrid, GeometryError> {
        let none = MovingWalls { still: vessel, count: 0, number: &|_| None };
        TriangleGrid::build_still(vessel, grid, margin, &none)
    }

    /// The same for a vessel with walls that move: each of these is a body of its own, and cells have the class that
    /// they have without them.
    pub fn build_still(
        vessel: &Vessel,
        grid: &Grid,
        margin: f64,
        moving: &MovingWalls<'_>,
    ) -> Result<TriangleGrid, GeometryError> {
        let triangles = (0..vessel.triangles.len())
            .map(|source| fix(vessel, grid, source))
            .collect::<Result<Vec<FixedTriangle>, GeometryError>>()?;
        let footprints: Vec<Footprint> = triangles.iter().map(|t| Footprint::new(t, grid, margin)).collect();
        let of = |wanted: Option<usize>| {
            let own = |(k, _): &(usize, _)| (moving.number)(vessel.triangles[*k].wall as usize) == wanted;
            footprints.iter().enumerate().filter(own).collect::<Vec<(usize, &Footprint)>>()
        };
        let still_walls = of(None);
        let Lists { start, list } = Lists::of(grid.cell_count(), |list| {
            for (triangle, footprint) in &still_walls {
                footprint.rows(|xs, y, z| {
                    let row = grid.cell_index([0, y, z]);
                    list(*triangle as u32, row + xs.start as usize..row + xs.end as usize);
                });
            }
        })?;
        let bodies = (0..moving.count).map(|k| Body::new(&of(Some(k)))).collect::<Result<_, _>>()?;
        let class = classify(moving.still, grid, &start);
        Ok(TriangleGrid { triangles, start, list, class, bodies })
    }

    /// Triangles (indices) listed in a cell.
    pub fn in_cell(&self, cell: usize) -> &[u32] {
        &self.list[self.start[cell] as usize..self.start[cell + 1] as usize]
    }
}

fn fix(vessel: &Vessel, grid: &Grid, source: usize) -> Result<FixedTriangle, GeometryError> {
    let triangle = &vessel.triangles[source];
    let metres = triangle.vertices.map(|v| vessel.vertices[v as usize]);
    let name = || {
        let wall = format!("wall `{}`", vessel.walls[triangle.wall as usize].name);
        (wall, Places::of(std::iter::once(metres.map(DVec3::from).to_vec()), ""))
    };
    let mut corners = [[0; 3]; 3];
    for (corner, position) in corners.iter_mut().zip(metres) {
        let Some(fixed) = grid.to_fixed(position) else {
            let (wall, place) = name();
            return Err(GeometryError::OutsideGrid { wall, place });
        };
        // Below 2^31 by the grid's invariant.
        *corner = fixed.map(|q| q as i32);
    }
    let edge =
        |k: usize| -> [i128; 3] { std::array::from_fn(|a| i128::from(corners[k][a]) - i128::from(corners[0][a])) };
    let (u, v) = (edge(1), edge(2));
    let cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let normal = DVec3::from(cross.map(|c| c as f64));
    let [a, b, c] = metres.map(DVec3::from);
    // Zero, or turned over.
    if normal.dot((b - a).cross(c - a)) <= 0.0 {
        let (wall, place) = name();
        return Err(GeometryError::DegenerateOnGrid { wall, place, quantum: grid.quantum() });
    }
    let normal = normal.normalize().to_array().map(|n| n as f32);
    Ok(FixedTriangle { corners, ids: triangle.vertices, normal, source: source as u32 })
}

/// The cells a triangle touches, as limits on their centres, in units of cells.
struct Footprint {
    /// First and last cell per axis.
    range: [[u32; 2]; 3],
    /// low <= axis . centre <= high.
    limits: Vec<(DVec3, f64, f64)>,
}

impl Footprint {
    fn new(triangle: &FixedTriangle, grid: &Grid, margin: f64) -> Footprint {
        let per_cell = f64::from(1u32 << grid.cell_bits);
        let corners = triangle.corners.map(|c| DVec3::from(c.map(|q| f64::from(q) / per_cell)));
        let half = 0.5 + margin.max(0.0) / grid.cell + SLACK;
        let range = std::array::from_fn(|axis| {
            let (low, high) = extent(&corners, DVec3::AXES[axis]);
            let last = f64::from(grid.cells[axis] - 1);
            // Cell i has its centre at i + 1/2.
            [(low - half - 0.5).ceil(), (high + half - 0.5).floor()].map(|i| i.clamp(0.0, last) as u32)
        });
        let edges = [corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]];
        let mut limits = Vec::with_capacity(10);
        let crossed = edges.iter().flat_map(|edge| DVec3::AXES.map(|axis| axis.cross(*edge)));
        for axis in std::iter::once(edges[0].cross(edges[1])).chain(crossed) {
            // An edge along a coordinate axis gives no third direction.
            if let Some(axis) = axis.try_normalize() {
                let (low, high) = extent(&corners, axis);
                let reach = half * axis.abs().element_sum() + SLACK;
                limits.push((axis, low - reach, high + reach));
            }
        }
        Footprint { range, limits }
    }

    /// Calls `visit` with each run of touched cells along x, and its y and z.
    fn rows(&self, mut visit: impl FnMut(Range<u32>, u32, u32)) {
        let [xs, ys, zs] = self.range;
        for z in zs[0]..=zs[1] {
            for y in ys[0]..=ys[1] {
                let (mut first, mut last) = (f64::from(xs[0]), f64::from(xs[1]));
                for (axis, low, high) in &self.limits {
                    let rest = axis.y * (f64::from(y) + 0.5) + axis.z * (f64::from(z) + 0.5);
                    if axis.x == 0.0 {
                        if rest < *low || rest > *high {
                            last = -1.0;
                        }
                    } else {
                        let (a, b) = ((low - rest) / axis.x - 0.5, (high - rest) / axis.x - 0.5);
                        first = first.max(a.min(b));
                        last = last.min(a.max(b));
                    }
                }
                let (first, last) = (first.ceil(), last.floor());
                if first <= last {
                    visit(first as u32..last as u32 + 1, y, z);
                }
            }
        }
    }
}

fn extent(corners: &[DVec3; 3], axis: DVec3) -> (f64, f64) {
    let [a, b, c] = corners.map(|p| p.dot(axis));
    (a.min(b).min(c), a.max(b).max(c))
}

fn classify(vessel: &Vessel, grid: &Grid, start: &[u32]) -> Vec<CellClass> {
    let [nx, ny, nz] = grid.cells;
    let strides = [1, nx as usize, nx as usize * ny as usize];
    let mut class = vec![CellClass::Cut; grid.cell_count()];
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let cell = grid.cell_index([x, y, z]);
                if start[cell + 1] > start[cell] {
                    continue;
                }
                // Two empty neighbours lie on the same side of every wall, so only one in each patch is asked.
                let behind = [x, y, z].into_iter().zip(strides).filter(|&(i, _)| i > 0).map(|(_, s)| class[cell - s]);
                let known = behind.into_iter().find(|&c| c != CellClass::Cut);
                class[cell] = known.unwrap_or_else(|| {
                    let centre = [x, y, z].map(|i| f64::from(i) + 0.5);
                    let at = std::array::from_fn(|a| grid.origin[a] + centre[a] * grid.cell);
                    if vessel.is_gas(at) { CellClass::Gas } else { CellClass::Solid }
                });
            }
        }
    }
    let near_cut = near_cut(grid, &class);
    for (class, near) in class.iter_mut().zip(near_cut) {
        if *class == CellClass::Gas && !near {
            *class = CellClass::Clear;
        }
    }
    class
}

/// Does the cell or one of the 26 around it have triangles (or lie outside the grid)? One axis at a time.
fn near_cut(grid: &Grid, class: &[CellClass]) -> Vec<bool> {
    let mut near: Vec<bool> = class.iter().map(|&c| c == CellClass::Cut).collect();
    let strides = [1, grid.cells[0] as usize, grid.cells[0] as usize * grid.cells[1] as usize];
    for (stride, n) in strides.into_iter().zip(grid.cells.map(|n| n as usize)) {
        near = (0..near.len())
            .map(|cell| {
                let i = cell / stride % n;
                i == 0 || i == n - 1 || near[cell] || near[cell - stride] || near[cell + stride]
            })
            .collect();
    }
    near
}
