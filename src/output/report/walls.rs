//! The walls of a page's three-dimensional view: the triangles of `walls.vtp`, wall by wall.
//!
//! Meshes of more than [`MOST_TRIANGLES`] are made coarser: vertices in one cube of a grid become one, and triangles that lose
//! their area go. The page says so.

use std::collections::HashMap;
use std::path::Path;

use super::super::OutputError;
use super::super::snapshot_read::SnapshotSurfaces;

/// Of all walls together.
const MOST_TRIANGLES: usize = 120_000;

#[derive(Debug, Clone, PartialEq)]
pub struct WallMesh {
    pub name: String,
    /// m.
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Walls {
    pub meshes: Vec<WallMesh>,
    /// Triangles that there were, if there are fewer now.
    pub coarser_than: Option<usize>,
}

impl Walls {
    /// Of the folder of a run; none if it has no such file.
    ///
    /// # Errors
    /// If the file is broken.
    pub fn read(run: &Path) -> Result<Walls, OutputError> {
        let Some(read) = SnapshotSurfaces::walls(run)? else { return Ok(Walls::default()) };
        let SnapshotSurfaces { mut vertices, mut triangles, owners: mut walls, names } = read;
        let before = triangles.len();
        while triangles.len() > MOST_TRIANGLES {
            (vertices, triangles, walls) = coarser(&vertices, &triangles, &walls);
        }
        let count = walls.iter().max().map_or(0, |last| *last as usize + 1);
        let meshes = (0..count).map(|index| {
            let own = triangles.iter().zip(&walls).filter(|(_, wall)| **wall as usize == index);
            let name = names.get(index).cloned().unwrap_or_else(|| format!("wall {index}"));
            mesh(name, &vertices, own.map(|(triangle, _)| *triangle))
        });
        Ok(Walls { meshes: meshes.collect(), coarser_than: (triangles.len() < before).then_some(before) })
    }

    /// Lowest and highest corner, m.
    pub fn corners(&self) -> Option<[[f64; 3]; 2]> {
        let points = || self.meshes.iter().flat_map(|mesh| &mesh.vertices);
        points().next()?;
        let end = |pick: fn(f64, f64) -> f64, start: f64| {
            points().fold([start; 3], |end, point| std::array::from_fn(|axis| pick(end[axis], point[axis])))
        };
        Some([end(f64::min, f64::INFINITY), end(f64::max, f64::NEG_INFINITY)])
    }
}

/// With the vertices that its triangles have.
fn mesh(name: String, vertices: &[[f64; 3]], triangles: impl Iterator<Item = [u32; 3]>) -> WallMesh {
    let mut places = HashMap::new();
    let mut mesh = WallMesh { name, vertices: Vec::new(), triangles: Vec::new() };
    for triangle in triangles {
        let own = triangle.map(|vertex| {
            *places.entry(vertex).or_insert_with(|| {
                mesh.vertices.push(vertices[vertex as usize]);
                mesh.vertices.len() as u32 - 1
            })
        });
        mesh.triangles.push(own);
    }
    mesh
}

type Mesh = (Vec<[f64; 3]>, Vec<[u32; 3]>, Vec<u32>);

/// Vertices of a cube become one of them; cubes so that about half of the vertices stay.
fn coarser(vertices: &[[f64; 3]], triangles: &[[u32; 3]], walls: &[u32]) -> Mesh {
    let longest = (0..3)
        .map(|axis| {
            let values = || vertices.iter().map(|vertex| vertex[axis]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        })
        .fold(0.0, f64::max);
    // A surface of n vertices crosses about n squares: cubes of such an edge.
    let mut edge = longest / (vertices.len() as f64).sqrt();
    loop {
        let mut cubes = HashMap::new();
        let mut kept: Vec<[f64; 3]> = Vec::new();
        let place: Vec<u32> = vertices
            .iter()
            .map(|vertex| {
                let cube = vertex.map(|x| (x / edge).floor() as i64);
                *cubes.entry(cube).or_insert_with(|| {
                    kept.push(*vertex);
                    kept.len() as u32 - 1
                })
            })
            .collect();
        let moved = triangles.iter().map(|triangle| triangle.map(|vertex| place[vertex as usize]));
        let flat = |[a, b, c]: [u32; 3]| a == b || b == c || c == a;
        let (left, own): (Vec<[u32; 3]>, Vec<u32>) =
            moved.zip(walls.iter().copied()).filter(|(triangle, _)| !flat(*triangle)).unzip();
        if left.len() <= triangles.len() * 3 / 4 {
            return (kept, left, own);
        }
        edge *= 1.5;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{SnapshotWriter, TriangleSet};

    /// A square of n x n squares, each of two triangles.
    fn square(n: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
        let point = |i: u32, j: u32| [f64::from(i) / f64::from(n), f64::from(j) / f64::from(n), 0.0];
        let vertices = (0..=n).flat_map(|j| (0..=n).map(move |i| point(i, j))).collect();
        let corner = |i: u32, j: u32| j * (n + 1) + i;
        let pair = |(i, j): (u32, u32)| {
            [
                [corner(i, j), corner(i + 1, j), corner(i, j + 1)],
                [corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)],
            ]
        };
        (vertices, (0..n).flat_map(|j| (0..n).map(move |i| (i, j))).flat_map(pair).collect())
    }

    fn written(n: u32) -> Walls {
        let dir = tempfile::tempdir().unwrap();
        let (vertices, triangles) = square(n);
        let walls: Vec<u32> = (0..triangles.len()).map(|k| u32::from(k > triangles.len() / 2)).collect();
        let names = ["left", "right"].map(str::to_owned);
        let set = TriangleSet { vertices: &vertices, triangles: &triangles, owners: &walls, names: &names };
        SnapshotWriter::create(dir.path()).unwrap().write_walls(set).unwrap();
        Walls::read(dir.path()).unwrap()
    }

    #[test]
    fn walls_come_apart_by_name() {
        let walls = written(4);
        assert_eq!(walls.coarser_than, None);
        assert_eq!(walls.meshes.iter().map(|mesh| mesh.name.as_str()).collect::<Vec<_>>(), ["left", "right"]);
        assert_eq!(walls.meshes.iter().map(|mesh| mesh.triangles.len()).sum::<usize>(), 32);
        assert_eq!(walls.corners(), Some([[0.0; 3], [1.0, 1.0, 0.0]]));
    }

    #[test]
    fn a_fine_mesh_becomes_coarser_and_keeps_its_extent() {
        let walls = written(300);
        let triangles: usize = walls.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
        assert_eq!(walls.coarser_than, Some(180_000));
        assert!((20_000..=MOST_TRIANGLES).contains(&triangles), "{triangles}");
        let [low, high] = walls.corners().unwrap();
        assert!(low.iter().all(|x| x.abs() < 0.02) && high[0] > 0.98 && high[1] > 0.98);
        assert_eq!(Walls::read(tempfile::tempdir().unwrap().path()).unwrap(), Walls::default());
    }
}
