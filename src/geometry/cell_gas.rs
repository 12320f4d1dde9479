//! The gas of each cell of the grid: its volume and, where walls part it, its parts. The collision rate of the method
//! `cell` is a number of pairs over a volume (method.md, "Collisions"), so what is left of a cell by the walls counts,
//! and gas on the two sides of a plate are two parts.
//!
//! Volumes are those of [`block_volumes`](super::block_volumes) for blocks of one cell, good to about 1e-3 of a cell.
//! A volume below [`LEAST`] of a cell is not known and counts as that: the gas of such cells is less than that share of
//! the cells that walls cut, and collides too rarely there.
//!
//! Of a cell with a wall that can part two of its points, [`CELL_POINTS`] points of a lattice are tried. Points of the gas
//! that see each other, directly or by way of others, are one part; its volume is its share of the points. Where a part
//! is not convex (around the edge of a plate) some pairs of it do not see each other and will not collide: its volume
//! is made smaller by the share of the pairs that do, so that the number of collisions stays that of its gas.
//!
//! Where walls move, the device divides the cells that they may touch anew in each step (`shaders/collide_moved.wgsl`), by
//! the same points; [`still_points`] tells it which of them the walls at rest leave.

use glam::DVec3;

use super::blocks::block_volumes;
use super::sampling::map;
use super::{CellClass, FixedTriangle, Grid, TriangleGrid, Vessel};

/// Share of a cell below which a volume is not known: half the distance of the lines that measure it.
pub const LEAST: f64 = 1.0 / 1974.0;

/// A rank-1 lattice: its points differ in every coordinate.
pub const CELL_POINTS: u64 = 89;
pub const CELL_GENERATOR: [u64; 3] = [1, 33, 21];

#[derive(Debug, Clone, PartialEq)]
pub struct CellGas {
    /// m3, by cell; positive everywhere.
    pub volume: Vec<f64>,
    /// The cells that walls part, in order, with at least one part each.
    pub divided: Vec<(usize, Vec<CellPart>)>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellPart {
    /// A point that sees all of it, or most, m.
    pub place: [f64; 3],
    /// m3.
    pub volume: f64,
}

/// `parts` tells of a triangle of the vessel whether it can part two points of the gas.
pub fn cell_gas(
    vessel: &Vessel,
    grid: &Grid,
    triangles: &TriangleGrid,
    parts: impl Fn(usize) -> bool + Sync,
) -> CellGas {
    let whole = grid.cell * grid.cell * grid.cell;
    let mut volume = block_volumes(vessel, grid, 0);
    for (volume, class) in volume.iter_mut().zip(&triangles.class) {
        *volume = match class {
            CellClass::Clear | CellClass::Gas => whole,
            CellClass::Cut | CellClass::Solid => volume.clamp(LEAST * whole, whole),
        };
    }
    let walls_of = |cell: usize| -> Vec<&FixedTriangle> {
        let near = triangles.in_cell(cell).iter().map(|&k| &triangles.triangles[k as usize]);
        near.filter(|triangle| parts(triangle.source as usize)).collect()
    };
    let cut: Vec<usize> = (0..volume.len()).filter(|&cell| !walls_of(cell).is_empty()).collect();
    let found = map(cut.len(), |k, _| parts_of(vessel, grid, cut[k], volume[cut[k]], &walls_of(cut[k])));
    CellGas { volume, divided: cut.into_iter().zip(found).collect() }
}

/// Which points of the lattice are gas, a bit for each, of each cell (x fastest) in boxes of cells (the first and the
/// last); none of other cells. `triangles` are on the same grid.
pub fn still_points(vessel: &Vessel, grid: &Grid, triangles: &TriangleGrid, boxes: &[[[u32; 3]; 2]]) -> Vec<[u32; 3]> {
    let nx = grid.cells[0] as usize;
    let nxy = nx * grid.cells[1] as usize;
    let place = |cell: usize| [(cell % nx) as u32, (cell % nxy / nx) as u32, (cell / nxy) as u32];
    let inside = |at: [u32; 3]| {
        boxes.iter().any(|[low, high]| (0..3).all(|axis| at[axis] >= low[axis] && at[axis] <= high[axis]))
    };
    let points_of = |cell: usize, gas: &dyn Fn([f64; 3]) -> bool| {
        let mut bits = [0; 3];
        for (i, share) in lattice() {
            let at = std::array::from_fn(|k| grid.origin[k] + (f64::from(place(cell)[k]) + share[k]) * grid.cell);
            bits[i / 32] |= u32::from(gas(at)) << (i % 32);
        }
        bits
    };
    map(triangles.class.len(), |cell, _| match triangles.class[cell] {
        _ if !inside(place(cell)) => [0; 3],
        CellClass::Clear | CellClass::Gas => points_of(cell, &|_| true),
        CellClass::Cut => points_of(cell, &|at| vessel.is_gas(at)),
        CellClass::Solid => [0; 3],
    })
}

/// The points of a cell and their numbers, in its edges.
fn lattice() -> impl Iterator<Item = (usize, [f64; 3])> {
    let share = |i: u64| CELL_GENERATOR.map(|g| ((i * g % CELL_POINTS) as f64 + 0.5) / CELL_POINTS as f64);
    (0..CELL_POINTS).map(move |i| (i as usize, share(i)))
}

fn parts_of(vessel: &Vessel, grid: &Grid, cell: usize, volume: f64, walls: &[&FixedTriangle]) -> Vec<CellPart> {
    let [nx, ny] = [grid.cells[0] as usize, grid.cells[1] as usize];
    let corner = DVec3::new((cell % nx) as f64, (cell / nx % ny) as f64, (cell / nx / ny) as f64);
    let edge = f64::from(1u32 << grid.cell_bits);
    let metres = |p: DVec3| (DVec3::from(grid.origin) + p * grid.quantum()).to_array();
    // In quanta, as the triangles.
    let points: Vec<DVec3> = lattice()
        .map(|(_, share)| (corner + DVec3::from(share)) * edge)
        .filter(|&point| vessel.is_gas(metres(point)))
        .collect();
    if points.is_empty() {
        return vec![CellPart { place: metres((corner + DVec3::splat(0.5)) * edge), volume }];
    }
    let sees = |a: usize, b: usize| !walls.iter().any(|wall| crosses(points[a], points[b], wall));
    // The part of each point: the lowest point that it sees by way of others.
    let mut part: Vec<usize> = (0..points.len()).collect();
    let mut seen = vec![0u32; points.len()];
    for a in 0..points.len() {
        for b in a + 1..points.len() {
            if sees(a, b) {
                seen[a] += 1;
                seen[b] += 1;
                let (low, high) = (part[a].min(part[b]), part[a].max(part[b]));
                part.iter_mut().filter(|own| **own == high).for_each(|own| *own = low);
            }
        }
    }
    let mut first: Vec<usize> = part.clone();
    first.sort_unstable();
    first.dedup();
    let of_part = |first: usize| {
        let members: Vec<usize> = (0..points.len()).filter(|&k| part[k] == first).collect();
        let count = members.len() as f64;
        let middle = members.iter().map(|&k| points[k]).sum::<DVec3>() / count;
        let pairs = members.iter().map(|&k| f64::from(seen[k])).sum::<f64>();
        let visible = if members.len() > 1 { pairs / (count * (count - 1.0)) } else { 1.0 };
        // Who sees most of it; of these the nearest to its middle.
        let best = members.iter().copied().max_by(|&a, &b| {
            let away = |k: usize| points[k].distance_squared(middle);
            seen[a].cmp(&seen[b]).then(away(b).total_cmp(&away(a))).then(b.cmp(&a))
        });
        CellPart {
            place: metres(points[best.unwrap_or(first)]),
            volume: volume * count / points.len() as f64 * visible,
        }
    };
    first.into_iter().map(of_part).collect()
}

/// Whether the segment from p to q (quanta) meets the triangle, its edges included.
fn crosses(p: DVec3, q: DVec3, triangle: &FixedTriangle) -> bool {
    let [a, b, c] = triangle.corners.map(|corner| DVec3::from(corner.map(f64::from)));
    let normal = (b - a).cross(c - a);
    let (before, after) = (normal.dot(p - a), normal.dot(q - a));
    if (before > 0.0) == (after > 0.0) {
        return false;
    }
    let at = p + (q - p) * (before / (before - after));
    let slack = -1e-9 * normal.length_squared();
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| (to - from).cross(at - from).dot(normal) >= slack)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tests::tank;
    use crate::scene::{GasSide, Shape, SurfaceModel, Wall};

    /// A tank of 4 x 3 x 3 dm with a plate across it at x = 0.152, of this thickness and half-height (0.15: to the walls).
    fn plated(thickness: f64, half_height: f64) -> (Vessel, Grid, CellGas) {
        let shape = Shape::Plane {
            center: [0.152, 0.15, 0.15],
            normal: [1.0, 0.0, 0.0],
            u: [0.0, 1.0, 0.0],
            size: [0.3, 2.0 * half_height],
            thickness,
            holes: vec![],
        };
        let (surface, parts) = (SurfaceModel::default(), Vec::new());
        let plate = Wall { name: "plate".into(), shape, gas: GasSide::Both, surface, parts };
        let vessel = Vessel::build(&[tank([0.4, 0.3, 0.3]), plate]).unwrap();
        let grid = Grid::around(vessel.bounds.0, vessel.bounds.1, 0.05).unwrap();
        let triangles = TriangleGrid::build(&vessel, &grid, 1e-6).unwrap();
        let gas = cell_gas(&vessel, &grid, &triangles, |k| vessel.triangles[k].wall == 1);
        (vessel, grid, gas)
    }

    /// Cut by a plate the gas of a cell is in two parts; their volumes are those on its two sides, and all parts of all
    /// cells are all of the gas.
    #[test]
    fn a_plate_parts_the_cells_it_crosses() {
        let (vessel, grid, gas) = plated(0.004, 0.15);
        let of_parts = |parts: &[CellPart]| parts.iter().map(|part| part.volume).sum::<f64>();
        let mut total = gas.volume.iter().sum::<f64>();
        let mut halves = 0;
        for (cell, parts) in &gas.divided {
            total += of_parts(parts) - gas.volume[*cell];
            if let [a, b] = parts[..] {
                halves += 1;
                let low = grid.origin[0] + (cell % grid.cells[0] as usize) as f64 * grid.cell;
                let (left, right) = if a.place[0] < b.place[0] { (a, b) } else { (b, a) };
                assert!(left.place[0] < 0.15 && right.place[0] > 0.154);
                // One lattice point of 89, twice.
                let share = (0.15 - low) / (grid.cell - 0.004);
                let found = left.volume / (left.volume + right.volume);
                assert!((found - share).abs() < 2.0 / 89.0, "{found} of {share}");
            }
        }
        assert!(halves > 30, "{halves}");
        // The floor under the volumes of the cells outside counts for what is too much.
        let outside = gas.volume.iter().filter(|&&v| v < 2.0 * LEAST * grid.cell.powi(3)).sum::<f64>();
        assert!((total - outside - vessel.gas_volume()).abs() < 2e-3 * vessel.gas_volume(), "{total}");
        assert!(gas.volume.iter().all(|&volume| volume > 0.0));
    }

    /// Around the edge of a plate the gas is one part, whose volume tells of the pairs that do not see each other: there
    /// the plate reaches into the cell by 0.4 of it, which hides some 8 % of the pairs.
    #[test]
    fn gas_around_an_edge_is_one_part() {
        let (_, grid, gas) = plated(0.002, 0.07);
        let mut hidden = 0;
        let inside = |cell: usize| gas.volume[cell] > 0.5 * grid.cell.powi(3);
        for (cell, parts) in gas.divided.iter().filter(|(cell, parts)| parts.len() == 1 && inside(*cell)) {
            let share = parts[0].volume / gas.volume[*cell];
            assert!(share > 0.3 && share <= 1.0, "{share}");
            let low = grid.origin[2] + (cell / (grid.cells[0] * grid.cells[1]) as usize) as f64 * grid.cell;
            let reach = (low + grid.cell - 0.08).min(0.22 - low) / grid.cell;
            if reach > 0.3 && reach < 1.0 {
                assert!(share < 0.97, "{share} at {reach}");
                hidden += 1;
            }
        }
        assert!(hidden > 5, "{hidden}");
    }
}
