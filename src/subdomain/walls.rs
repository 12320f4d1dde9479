//! The walls as the device sees them: triangles in quanta, and the lists of the cells they touch.

use std::collections::HashMap;

use crate::geometry::{CellClass, Clearance, Grid, Lists, NO_PLANE, TriangleGrid, clearances};

use super::layout::{GpuMotion, GpuTriangle};

/// No surface tally.
const NOBODY: u32 = u32::MAX;

/// Marks the number of an entry that has several planes, which no plane is: a normal with this least is none but `NO_PLANE`.
const SEVERAL: u32 = NO_PLANE;
/// Entries with several planes, at most: beside curved walls few cells have theirs in common. Cells beyond have one.
const MOST_SEVERAL: usize = 1 << 20;

/// How far behind a wall a particle may be by rounding, and how far a triangle reaches beyond its edges,
/// as a share of the longest side of the vessel. f32 sums of coordinates err by some 1e-7 of it.
const TOLERANCE: f64 = 1e-6;

pub struct Walls {
    pub triangles: Vec<GpuTriangle>,
    /// First entry in `list` of each cell that has walls or is beside one that has, and its
    /// [`clearance`](crate::geometry::clearances), where it has several planes `SEVERAL` and the number of the entry that has them; and the end. Behind these,
    /// in two entries each, such planes, those that cells have in common once.
    pub start: Vec<[u32; 2]>,
    /// Triangles by cell; behind them those of each wall that moves, by cell and by row, and where these begin.
    pub list: Vec<u32>,
    /// The classes of sixteen cells each, two bits per cell, and how many cells before them are near walls. One more than there
    /// are such sixteens, for the cell behind the last.
    pub class: Vec<[u32; 2]>,
    /// A bit per cell: whether a wall that can part two points of the gas is in one of the 27 cells around.
    pub parting: Vec<u32>,
    /// The walls that move.
    pub bodies: Vec<BodyLists>,
    /// m.
    pub tolerance: f64,
}

/// The cells of a wall that moves in its body frame, and where in `list` its lists are: place `i` has the triangles from the word at `list[at + i]` up to
/// that at `list[at + i + 1]`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BodyLists {
    /// The first cell of the box around it, and the cells of the box by axis.
    low: [u32; 3],
    size: [u32; 3],
    /// Of its cells, x fastest, and of its rows of cells along x.
    cells: u32,
    rows: u32,
}

impl BodyLists {
    /// What the shaders are told of the wall in a step.
    pub fn complete(&self, motion: GpuMotion) -> GpuMotion {
        GpuMotion { body_low: self.low, body_size: self.size, cells: self.cells, rows: self.rows, ..motion }
    }
}

impl Walls {
    /// The tolerance of walls on this grid, m; also the margin with which triangles are put into cells.
    pub fn tolerance(grid: &Grid) -> f64 {
        let cells = f64::from(grid.cells.iter().copied().max().unwrap_or(1));
        TOLERANCE * cells * grid.cell
    }

    /// `triangle_grid` was built with the margin [`Walls::tolerance`]. `patch` is the surface tally of each triangle of
    /// the vessel; empty if nothing is tallied. `surface_model` is its surface model; empty if all walls are mirrors. `parts` tells of a
    /// triangle of the vessel whether it can part two points of the gas: those of the surface of a convex cavity cannot.
    pub fn new(
        triangle_grid: &TriangleGrid,
        grid: &Grid,
        patch: &[u32],
        surface_model: &[u32],
        parts: impl Fn(usize) -> bool,
    ) -> Walls {
        let triangles = triangle_grid
            .triangles
            .iter()
            .map(|triangle| {
                let mut order = [0, 1, 2];
                order.sort_by_key(|&corner| triangle.ids[corner]);
                let corner = |k: usize| triangle.corners[order[k]].map(|quanta| quanta as u32);
                let even = matches!(order, [0, 1, 2] | [1, 2, 0] | [2, 0, 1]);
                GpuTriangle {
                    a: corner(0),
                    sense: if even { 1.0 } else { -1.0 },
                    b: corner(1),
                    surface: patch.get(triangle.source as usize).copied().unwrap_or(NOBODY),
                    c: corner(2),
                    surface_model: surface_model.get(triangle.source as usize).copied().unwrap_or(NOBODY),
                    normal: triangle.normal,
                    motion: NOBODY,
                }
            })
            .collect();
        let mut class = vec![[0u32; 2]; triangle_grid.class.len() / 16 + 1];
        let mut start = Vec::new();
        for (cell, kind) in triangle_grid.class.iter().enumerate() {
            let bits = match kind {
                CellClass::Clear => 0,
                CellClass::Gas => 1,
                CellClass::Cut => 2,
                CellClass::Solid => 3,
            };
            if cell % 16 == 0 {
                class[cell / 16][1] = start.len() as u32;
            }
            class[cell / 16][0] |= bits << (2 * (cell % 16));
            if matches!(kind, CellClass::Gas | CellClass::Cut) {
                start.push([triangle_grid.start[cell], 0]);
            }
        }
        if triangle_grid.class.len().is_multiple_of(16) {
            class[triangle_grid.class.len() / 16][1] = start.len() as u32;
        }
        let tolerance = Walls::tolerance(grid);
        let clearances = clearances(triangle_grid, grid, tolerance);
        start.extend(triangle_grid.start.last().map(|end| [*end, 0]));
        let mut known = HashMap::new();
        let most = (start.len() + MOST_SEVERAL).min(1 << 24);
        for (near, Clearance { planes, alone }) in clearances.into_iter().enumerate() {
            let [first, second, third] = planes;
            start[near][1] = match known.get(&planes) {
                _ if second == NO_PLANE => first,
                Some(&entry) => entry,
                None if start.len() + 2 <= most => {
                    let entry = SEVERAL | start.len() as u32;
                    start.extend([[first, second], [third, NO_PLANE]]);
                    *known.entry(planes).or_insert(entry)
                }
                None => alone,
            };
        }
        Walls {
            triangles,
            start,
            list: triangle_grid.list.clone(),
            class,
            parting: parting(triangle_grid, grid, parts),
            bodies: Vec::new(),
            tolerance,
        }
    }
}

impl Walls {
    /// With the walls that move, and which of them each triangle of the vessel is of, if any.
    pub fn moving(mut self, triangle_grid: &TriangleGrid, motion: impl Fn(usize) -> Option<usize>) -> Walls {
        for (own, fixed) in self.triangles.iter_mut().zip(&triangle_grid.triangles) {
            own.motion = motion(fixed.source as usize).map_or(NOBODY, |motion| motion as u32);
        }
        for body in &triangle_grid.bodies {
            let [cells, rows] = [&body.cells, &body.rows].map(|lists| self.append(lists));
            self.bodies.push(BodyLists { low: body.low, size: body.size, cells, rows });
        }
        self
    }

    /// Where in `list` the lists begin.
    fn append(&mut self, lists: &Lists) -> u32 {
        let entries = self.list.len() as u32;
        self.list.extend(&lists.list);
        let place = self.list.len() as u32;
        self.list.extend(lists.start.iter().map(|start| entries + start));
        place
    }
}

fn parting(triangle_grid: &TriangleGrid, grid: &Grid, parts: impl Fn(usize) -> bool) -> Vec<u32> {
    let mut bits = vec![0u32; grid.cell_count().div_ceil(32)];
    let [nx, ny, nz] = grid.cells;
    for z in 0..nz {
        for y in 0..ny {
            for x in 0..nx {
                let cell = grid.cell_index([x, y, z]);
                let divides = triangle_grid
                    .in_cell(cell)
                    .iter()
                    .any(|&t| parts(triangle_grid.triangles[t as usize].source as usize));
                if !divides {
                    continue;
                }
                for around in 0..27 {
                    let at = [x + around % 3, y + around / 3 % 3, z + around / 9];
                    if (0..3).all(|axis| at[axis] >= 1 && at[axis] <= grid.cells[axis]) {
                        let near = grid.cell_index(at.map(|c| c - 1));
                        bits[near / 32] |= 1 << (near % 32);
                    }
                }
            }
        }
    }
    bits
}

#[cfg(test)]
mod tests {
    use crate::geometry::Vessel;
    use crate::scene;
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;

    /// The cells before a cell that are near walls, as in `shaders/shared/walls.wgsl`.
    fn near_before(class: &[[u32; 2]], cell: usize) -> usize {
        let [bits, before] = class[cell / 16];
        let near = (bits ^ (bits >> 1)) & 0x5555_5555;
        (before + (near & ((1 << (cell % 16 * 2)) - 1)).count_ones()) as usize
    }

    /// Each cell's triangles are found by how many cells before it are near walls; behind the last cell is the end.
    #[test]
    fn the_lists_of_cells_near_walls_are_found_by_their_number() {
        let text = include_str!("../../scenes/tank.toml");
        let vessel = Vessel::build(&scene::parse(text, "tank.toml", Path::new("")).unwrap().walls).unwrap();
        let (low, high) = vessel.bounds;
        // Numbers of cells that fill the sixteens, and that do not.
        let mut filled = [false; 2];
        for edge in (10..30).map(|k| f64::from(k) * 1e-3) {
            let grid = Grid::around(low, high, edge).unwrap();
            let built = TriangleGrid::build(&vessel, &grid, Walls::tolerance(&grid)).unwrap();
            let walls = Walls::new(&built, &grid, &[], &[], |_| true);
            let (mut listed, mut near) = (0, 0);
            for cell in 0..grid.cell_count() {
                let ends = [cell, cell + 1].map(|cell| walls.start[near_before(&walls.class, cell)][0] as usize);
                assert_eq!(&walls.list[ends[0]..ends[1]], built.in_cell(cell), "cell {cell}");
                listed += usize::from(ends[0] < ends[1]);
                near += usize::from(matches!(built.class[cell], CellClass::Gas | CellClass::Cut));
            }
            // An entry for each cell near walls, and the end; behind it those of several planes, two each.
            let several = walls.start[..near].iter().filter(|[_, plane]| plane >> 24 == SEVERAL >> 24);
            let numbers: BTreeSet<usize> = several.map(|[_, plane]| (plane & 0xff_ffff) as usize).collect();
            assert!(
                !numbers.is_empty()
                    && numbers.iter().eq((near + 1..walls.start.len()).step_by(2).collect::<Vec<_>>().iter())
            );
            assert!(numbers.iter().all(|&at| walls.start[at][1] != NO_PLANE && walls.start[at + 1][1] == NO_PLANE));
            assert!(listed > 0 && listed < near && near < grid.cell_count());
            filled[usize::from(grid.cell_count().is_multiple_of(16))] = true;
        }
        assert_eq!(filled, [true; 2]);
    }
}
