//! The surfaces of a page's three-dimensional view: walls as they are drawn, and the fabric at each snapshot.
//!
//! Meshes of too many triangles are made coarser: vertices in one cube of a grid become one, and triangles that lose their
//! area go. The page says so.

use std::collections::HashMap;
use std::path::Path;

use super::super::OutputError;
use super::super::snapshot_read::{SnapshotEntry, SnapshotSurfaces};
use super::extent;

/// Of all walls together, and of the fabric in all snapshots together.
const MOST_TRIANGLES: usize = 120_000;
const MOST_FABRIC: usize = 300_000;

#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceMesh {
    pub name: String,
    /// m.
    pub vertices: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
}

#[derive(Debug, Clone, PartialEq, Default)]
pub struct Surfaces {
    pub meshes: Vec<SurfaceMesh>,
    /// Triangles that there were, if there are fewer now.
    pub coarser_than: Option<usize>,
}

impl Surfaces {
    /// Of the folder of a run; none if it has no such file.
    ///
    /// # Errors
    /// If the file is broken.
    pub fn walls(run: &Path) -> Result<Surfaces, OutputError> {
        Ok(SnapshotSurfaces::walls(run)?.map_or_else(Surfaces::default, |read| Surfaces::of(read, MOST_TRIANGLES)))
    }

    /// The fabric beside one of so many snapshots; none if there is none.
    ///
    /// # Errors
    /// If the file is broken.
    pub fn fabric(entry: &SnapshotEntry, snapshots: usize) -> Result<Surfaces, OutputError> {
        let most = MOST_FABRIC / snapshots.max(1);
        Ok(SnapshotSurfaces::fabric(entry)?.map_or_else(Surfaces::default, |read| Surfaces::of(read, most)))
    }

    fn of(read: SnapshotSurfaces, most: usize) -> Surfaces {
        let SnapshotSurfaces { mut vertices, mut triangles, mut owners, names } = read;
        let before = triangles.len();
        while triangles.len() > most {
            (vertices, triangles, owners) = coarser(&vertices, &triangles, &owners);
        }
        let count = owners.iter().max().map_or(0, |last| *last as usize + 1);
        let meshes = (0..count).map(|index| {
            let own = triangles.iter().zip(&owners).filter(|(_, owner)| **owner as usize == index);
            let name = names.get(index).cloned().unwrap_or_else(|| format!("surface {index}"));
            mesh(name, &vertices, own.map(|(triangle, _)| *triangle))
        });
        Surfaces { meshes: meshes.collect(), coarser_than: (triangles.len() < before).then_some(before) }
    }

    /// Lowest and highest corner, m.
    pub fn corners(&self) -> Option<[[f64; 3]; 2]> {
        extent::of(self.meshes.iter().flat_map(|mesh| &mesh.vertices))
    }
}

/// With the vertices that its triangles have.
fn mesh(name: String, vertices: &[[f64; 3]], triangles: impl Iterator<Item = [u32; 3]>) -> SurfaceMesh {
    let mut places = HashMap::new();
    let mut mesh = SurfaceMesh { name, vertices: Vec::new(), triangles: Vec::new() };
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
    use crate::output::{SnapshotWriter, TriangleSet, snapshots_of};

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

    fn written(n: u32) -> Surfaces {
        let dir = tempfile::tempdir().unwrap();
        let (vertices, triangles) = square(n);
        let walls: Vec<u32> = (0..triangles.len()).map(|k| u32::from(k > triangles.len() / 2)).collect();
        let names = ["left", "right"].map(str::to_owned);
        let set = TriangleSet { vertices: &vertices, triangles: &triangles, owners: &walls, names: &names };
        SnapshotWriter::create(dir.path()).unwrap().write_walls(set).unwrap();
        Surfaces::walls(dir.path()).unwrap()
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
        assert_eq!(Surfaces::walls(tempfile::tempdir().unwrap().path()).unwrap(), Surfaces::default());
    }
    /// All snapshots together have a bound: of many each has fewer.
    #[test]
    fn fabric_of_many_snapshots_is_coarser_and_keeps_its_fold() {
        let dir = tempfile::tempdir().unwrap();
        let (mut vertices, triangles) = square(80);
        vertices.iter_mut().for_each(|vertex| vertex[2] = (vertex[0] - 0.5).abs());
        let names = ["cloth".to_owned()];
        let owners = vec![0; triangles.len()];
        let set = TriangleSet { vertices: &vertices, triangles: &triangles, owners: &owners, names: &names };
        let mut writer = SnapshotWriter::create(dir.path()).unwrap();
        writer.write(0.0, &[]).unwrap();
        writer.write_fabric(set, None).unwrap();
        let entry = snapshots_of(dir.path()).unwrap().remove(0);
        let few = Surfaces::fabric(&entry, 20).unwrap();
        assert_eq!((few.coarser_than, few.meshes[0].triangles.len()), (None, 12_800));
        let many = Surfaces::fabric(&entry, 60).unwrap();
        let left = many.meshes[0].triangles.len();
        assert!(many.coarser_than == Some(12_800) && (1000..=5000).contains(&left), "{left}");
        let [low, high] = many.corners().unwrap();
        assert!(low[2] < 0.05 && high[2] > 0.45 && many.meshes[0].name == "cloth");
    }
}
