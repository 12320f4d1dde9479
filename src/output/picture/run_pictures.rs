//! Pictures of a run, from what it has left in its folder.

use std::collections::BTreeMap;
use std::path::Path;

use glam::DVec3;

use super::super::local_temperature::local_temperatures;
use super::annotation::round_below;
use super::colours::{Colour, FABRIC, WALL, of_kind, viridis};
use super::error::PictureError;
use super::model::{Key, LengthUnit, Pane, Picture, Scale};
use super::surface::Surface;
use crate::gas::displacement;
use crate::output::{SCENE_FILE, Snapshot, SnapshotEntry, SnapshotSurfaces, check_marker, grouped, snapshots_of};
use crate::scene::{Scene, load};

/// What the colours of the particles say.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colouring {
    Gas,
    Speed,
    Temperature,
    Subdomain,
}

/// How fabric is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FabricLook {
    /// With the gas behind it.
    Clear,
    /// With its folds.
    Opaque,
    Left,
}

/// Of 255.
const WALL_OPACITY: u8 = 22;
const FABRIC_OPACITY: u8 = 48;

/// Of all values so many, in shares, lie within the ends of the colours.
const WITHIN: [f64; 2] = [0.01, 0.99];

/// A run that has written snapshots.
pub struct RunPictures {
    scene: Scene,
    walls: Option<SnapshotSurfaces>,
    snapshots: Vec<SnapshotEntry>,
}

/// What the pictures of a series have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    pub colouring: Colouring,
    pub key: Key,
    most_particles: usize,
}

/// The kind or the value of each particle.
enum Marks {
    Kinds(Vec<usize>),
    Values(Vec<f64>),
}

impl RunPictures {
    /// # Errors
    /// If the folder is no run's, or has no snapshots.
    pub fn open(folder: &Path) -> Result<RunPictures, PictureError> {
        check_marker(folder)?;
        let snapshots = snapshots_of(folder)?;
        if snapshots.is_empty() {
            return Err(PictureError::NoSnapshots { path: folder.to_path_buf() });
        }
        let scene = load(&folder.join(SCENE_FILE))?;
        Ok(RunPictures { scene, walls: SnapshotSurfaces::walls(folder)?, snapshots })
    }

    /// In the order of time; at least one.
    pub fn snapshots(&self) -> &[SnapshotEntry] {
        &self.snapshots
    }

    /// The snapshot nearest to a time, s, and whether that is within half of what lies between two snapshots.
    pub fn nearest(&self, time: f64) -> (usize, bool) {
        let off = |index: &usize| (self.snapshots[*index].time - time).abs();
        let nearest = (0..self.snapshots.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
        let first_and_last = [0, self.snapshots.len() - 1].map(|index| self.snapshots[index].time);
        let interval = (first_and_last[1] - first_and_last[0]) / (self.snapshots.len() - 1).max(1) as f64;
        // Times are rounded where they are written and typed.
        (nearest, off(&nearest) <= 0.5 * interval * (1.0 + 1e-6))
    }

    /// What pictures of these snapshots have in common, so that a colour means the same on all of them.
    ///
    /// # Errors
    /// If a snapshot cannot be read, or has not what the colours shall say.
    pub fn series(&self, chosen: &[usize], colouring: Colouring) -> Result<Series, PictureError> {
        let (mut most_particles, mut kinds, mut values) = (0, 0, Vec::new());
        let mut names = Vec::new();
        for &index in chosen {
            let snapshot = Snapshot::read(&self.snapshots[index])?;
            most_particles = most_particles.max(snapshot.positions.len());
            match self.marks(&snapshot, index, colouring)? {
                Marks::Kinds(found) => kinds = found.iter().map(|kind| kind + 1).fold(kinds, usize::max),
                Marks::Values(found) => values.extend(found),
            }
            names = snapshot.gas_names;
        }
        let key = match colouring {
            Colouring::Gas => named((0..kinds.max(names.len())).map(|gas| self.gas_name(&names, gas))),
            Colouring::Subdomain => named((0..kinds).map(|owner| format!("subdomain {owner}"))),
            Colouring::Speed => Key::Values(Scale { quantity: "speed, m/s", range: 0.0..ends(values).1 }),
            Colouring::Temperature => {
                let (low, high) = ends(values);
                Key::Values(Scale { quantity: "temperature, K", range: low..high })
            }
        };
        Ok(Series { colouring, key, most_particles })
    }

    fn gas_name(&self, names: &[String], gas: usize) -> String {
        let in_scene = || self.scene.gases.get(gas).map(|gas| gas.name.clone());
        names.get(gas).cloned().or_else(in_scene).unwrap_or_else(|| format!("gas {gas}"))
    }

    /// The picture of a snapshot.
    ///
    /// # Errors
    /// As [`RunPictures::series`].
    pub fn picture(&self, index: usize, series: &Series, fabric: FabricLook) -> Result<Picture, PictureError> {
        let snapshot = Snapshot::read(&self.snapshots[index])?;
        let colours: Vec<Colour> = match (self.marks(&snapshot, index, series.colouring)?, &series.key) {
            (Marks::Values(values), Key::Values(scale)) => {
                values.into_iter().map(|value| viridis(scale.share(value))).collect()
            }
            (Marks::Values(values), _) => vec![of_kind(0); values.len()],
            (Marks::Kinds(kinds), _) => kinds.into_iter().map(of_kind).collect(),
        };
        let places = snapshot.positions.iter().map(|&place| DVec3::from(place));
        let count = grouped(snapshot.positions.len() as u64);
        let walls = self.walls_at(snapshot.time).into_iter();
        let pane = |colour: Colour, opacity: u8| move |surface: Surface| Pane { surface, colour, opacity };
        let mut panes: Vec<Pane> = walls.map(pane(WALL, WALL_OPACITY)).collect();
        let mut meshes = Vec::new();
        match fabric {
            FabricLook::Clear => panes.extend(self.fabric(index)?.into_iter().map(pane(FABRIC, FABRIC_OPACITY))),
            FabricLook::Opaque => meshes = self.fabric(index)?,
            FabricLook::Left => {}
        }
        Ok(Picture {
            title: self.scene.title.clone(),
            caption: format!("{:.3} ms, {count} particles", 1e3 * snapshot.time),
            balls: places.zip(colours).collect(),
            most_balls: series.most_particles,
            meshes,
            panes,
            key: series.key.clone(),
            unit: LengthUnit::Metre,
        })
    }

    fn marks(&self, snapshot: &Snapshot, index: usize, colouring: Colouring) -> Result<Marks, PictureError> {
        let path = || self.snapshots[index].path.clone();
        Ok(match colouring {
            Colouring::Gas => Marks::Kinds(snapshot.gases.iter().map(|&gas| usize::from(gas)).collect()),
            Colouring::Subdomain => {
                let owners = snapshot.subdomains.as_ref();
                let owners = owners.ok_or_else(|| PictureError::NoSubdomains { path: path() })?;
                Marks::Kinds(owners.iter().map(|&owner| owner as usize).collect())
            }
            Colouring::Speed => {
                let speed = |velocity: &[f32; 3]| velocity.map(f64::from).iter().map(|v| v * v).sum::<f64>().sqrt();
                Marks::Values(snapshot.velocities.iter().map(speed).collect())
            }
            Colouring::Temperature => {
                let known = self.scene.gases.len();
                let mass = |gas: u8| {
                    let gas_of_scene = self.scene.gases.get(usize::from(gas));
                    gas_of_scene.map(|gas| gas.molar_mass).ok_or_else(|| PictureError::UnknownGas {
                        path: path(),
                        gas,
                        known,
                    })
                };
                let states = snapshot.positions.iter().zip(&snapshot.velocities).zip(&snapshot.gases);
                let particles = states.map(|((&place, &velocity), &gas)| Ok((place, velocity, mass(gas)?)));
                Marks::Values(local_temperatures(&particles.collect::<Result<Vec<_>, PictureError>>()?))
            }
        })
    }

    /// The walls where they are at a time, s.
    fn walls_at(&self, time: f64) -> Vec<Surface> {
        let mut walls = self.walls.as_ref().map_or(Vec::new(), surfaces_of);
        for (wall, surface) in walls.iter_mut().enumerate() {
            let moved = self.moved(wall, time);
            surface.vertices.iter_mut().for_each(|vertex| *vertex += moved);
        }
        walls
    }

    /// # Errors
    /// If there is no fabric beside a snapshot.
    pub fn check_fabric(&self, index: usize) -> Result<(), PictureError> {
        let none = || PictureError::NoFabric { path: self.snapshots[index].path.clone() };
        SnapshotSurfaces::fabric(&self.snapshots[index])?.map(|_| ()).ok_or_else(none)
    }

    /// The fabric of a snapshot; none of a run without any.
    fn fabric(&self, index: usize) -> Result<Vec<Surface>, PictureError> {
        let fabric = SnapshotSurfaces::fabric(&self.snapshots[index])?;
        Ok(fabric.as_ref().map_or(Vec::new(), surfaces_of))
    }

    /// How far a wall has moved by then, m.
    fn moved(&self, wall: usize, time: f64) -> DVec3 {
        let motion = self.scene.motions.iter().find(|motion| motion.wall == wall);
        motion.map_or(DVec3::ZERO, |motion| DVec3::from(motion.direction) * displacement(&motion.course, time))
    }

    /// What pictures of these snapshots show all together: walls and fabric, and the particles of a run without walls.
    ///
    /// # Errors
    /// If a snapshot cannot be read.
    pub fn places(&self, chosen: &[usize]) -> Result<Vec<DVec3>, PictureError> {
        let mut places = Vec::new();
        for &index in chosen {
            let snapshot = &self.snapshots[index];
            let surfaces = self.walls_at(snapshot.time).into_iter().chain(self.fabric(index)?);
            places.extend(surfaces.flat_map(|surface| surface.vertices));
            if self.walls.is_none() {
                places.extend(Snapshot::read(snapshot)?.positions.into_iter().map(DVec3::from));
            }
        }
        Ok(places)
    }
}

/// The surface of each owner, with its own vertices.
fn surfaces_of(all: &SnapshotSurfaces) -> Vec<Surface> {
    let count = all.owners.iter().map(|&owner| owner as usize + 1).max().unwrap_or(0);
    let mut surfaces = vec![Surface::default(); count];
    let mut own: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for (triangle, &owner) in all.triangles.iter().zip(&all.owners) {
        let Surface { vertices, triangles } = &mut surfaces[owner as usize];
        triangles.push(triangle.map(|vertex| {
            *own.entry((owner, vertex)).or_insert_with(|| {
                vertices.push(DVec3::from(all.vertices[vertex as usize]));
                vertices.len() as u32 - 1
            })
        }));
    }
    surfaces
}

fn named(names: impl Iterator<Item = String>) -> Key {
    Key::Kinds(names.enumerate().map(|(kind, name)| (name, of_kind(kind))).collect())
}

/// Round values below and above nearly all of the values.
fn ends(mut values: Vec<f64>) -> (f64, f64) {
    values.retain(|value| value.is_finite());
    if values.is_empty() {
        return (0.0, 1.0);
    }
    let mut at = |share: f64| {
        let place = (share * (values.len() - 1) as f64).round() as usize;
        *values.select_nth_unstable_by(place, f64::total_cmp).1
    };
    let [low, high] = WITHIN.map(&mut at);
    let step = round_below((0.2 * (high - low)).max(1e-3 * high.abs()).max(f64::MIN_POSITIVE.sqrt()));
    ((low / step).floor() * step, (high / step).ceil().max((low / step).floor() + 1.0) * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_the_colours_are_round_and_leave_out_the_rarest() {
        let mut values: Vec<f64> = (0..1000).map(|k| 300.0 + 0.4 * f64::from(k)).collect();
        values[999] = 1e9;
        assert_eq!(ends(values), (300.0, 700.0));
        assert_eq!(ends(vec![]), (0.0, 1.0));
        for same in [0.0, 300.0, -5.0] {
            let (low, high) = ends(vec![same; 3]);
            assert!(low <= same && same <= high && low < high, "{same}: {low} {high}");
        }
    }
}
