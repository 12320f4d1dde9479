//! A plane for each cell near walls that all walls in it and the 26 cells around lie behind, so that a flight whose ends are
//! both before it meets none: a line that starts and ends on one side of a plane does not cross it.
//!
//! One word a cell: three signed bytes of a normal, its largest component 127 or -127, and the least of normal . (place -
//! middle of the cell), in [`CLEARANCE_UNIT`] cells. All is rounded away from the walls. Of the normals of these walls and the mean of
//! them it is the one that leaves the middle of the cell farthest before the plane: beside one flat wall that wall, to less than a
//! tenth of a cell; along an edge a chamfer; and no help between two walls that face each other.

use glam::DVec3;

use super::sampling::map;
use super::{CellClass, FixedTriangle, Grid, TriangleGrid};

/// What one step of the least is, in cells along a normal of 127. No place of the 27 cells has more than 1.5 x 3 x 127 = 571.5.
pub const CLEARANCE_UNIT: f64 = 5.0;
/// No place is before a plane with this least: 635.
const NOWHERE: i8 = 127;
/// Of a least, more than rounding of f32 makes of it.
const SLACK: f64 = 0.01;
/// So many triangles around a cell and directions of them are looked at, and where there are more triangles, no place is before a
/// plane: what it costs to find planes stays a small part of a set-up, whatever the mesh.
const MOST_TRIANGLES: usize = 64;
const MOST_NORMALS: usize = 8;

/// One of each cell that is [`CellClass::Gas`] or [`CellClass::Cut`], in order. `margin` (m) must be that with which the lists were built.
pub fn clearances(triangles: &TriangleGrid, grid: &Grid, margin: f64) -> Vec<u32> {
    let near: Vec<usize> = (0..triangles.class.len())
        .filter(|&cell| matches!(triangles.class[cell], CellClass::Gas | CellClass::Cut))
        .collect();
    map(near.len(), |k, _| clearance(triangles, grid, margin / grid.cell, near[k]))
}

fn clearance(triangles: &TriangleGrid, grid: &Grid, margin: f64, cell: usize) -> u32 {
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
    let nowhere = encoded(DVec3::ZERO, f64::from(NOWHERE));
    if near.len() > MOST_TRIANGLES {
        return nowhere;
    }
    let middle = DVec3::from(place.map(|i| i as f64 + 0.5));
    let near: Vec<&FixedTriangle> = near.iter().map(|&k| &triangles.triangles[k as usize]).collect();
    let mut corners = Vec::new();
    for triangle in &near {
        let per_cell = f64::from(1u32 << grid.cell_bits);
        let drawn = triangle.corners.map(|corner| DVec3::from(corner.map(|q| f64::from(q) / per_cell)) - middle);
        corners.extend(clipped(drawn.to_vec(), 1.5 + margin));
    }
    // Beside a wall that none of these cells lists (the end of the grid) nothing is known.
    let mut best = (f64::INFINITY, nowhere);
    let mut normals: Vec<DVec3> = Vec::new();
    for normal in near.iter().map(|triangle| DVec3::from(triangle.normal.map(f64::from))) {
        if !normals.contains(&normal) {
            normals.push(normal);
        }
    }
    let mean: DVec3 = normals.iter().sum();
    normals.truncate(MOST_NORMALS);
    normals.push(mean);
    for normal in normals {
        let normal = (normal * (127.0 / normal.abs().max_element())).round();
        let farthest = corners.iter().map(|corner| corner.dot(normal)).fold(f64::NEG_INFINITY, f64::max);
        let least = ((farthest + margin * normal.length()) / CLEARANCE_UNIT + SLACK).ceil();
        let depth = least / normal.length();
        if least < f64::from(NOWHERE) && depth < best.0 {
            best = (depth, encoded(normal, least.max(-127.0)));
        }
    }
    best.1
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
