//! The three-dimensional view of a page: walls, fabric and particles in the units of the scene, packed.

use serde::Serialize;

use super::super::error::OutputError;
use super::super::history::History;
use super::cloud::{Cloud, steps};
use super::columns::Unit;
use super::record::Record;
use super::surfaces::{SurfaceMesh, Surfaces};
use super::{extent, packed};
use crate::scene::{Scene, UnitSystem};

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct View {
    pub length: &'static str,
    pub velocity: &'static str,
    pub time: &'static str,
    /// Corners of the box that positions are steps of.
    low: [f64; 3],
    high: [f64; 3],
    gases: Vec<String>,
    speed: [f64; 2],
    temperature: [f64; 2],
    /// None of a run on one device.
    subdomains: u32,
    walls: Vec<PackedSurface>,
    /// Whether any snapshot has fabric.
    pub has_fabric: bool,
    frames: Vec<PackedFrame>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct PackedSurface {
    name: String,
    vertices: String,
    triangles: String,
    /// How far it has moved, by frame; empty of one that rests.
    shifts: Vec<[f64; 3]>,
}

/// A snapshot; what it shows of its fabric has the same names at all times.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct PackedFrame {
    time: f64,
    count: u64,
    position: String,
    speed: String,
    temperature: String,
    gas: String,
    subdomain: String,
    fabric: Vec<PackedSurface>,
}

/// A view, or why there is none, and what is to be said of it.
pub struct Viewed {
    pub view: Option<View>,
    /// What is not shown, in words.
    pub notes: Vec<String>,
}

impl Viewed {
    /// # Errors
    /// If the walls or the list of snapshots are broken.
    pub fn of(record: &Record) -> Result<Viewed, OutputError> {
        let molar_masses: Vec<f64> = record.scene.gases.iter().map(|gas| gas.molar_mass).collect();
        let cloud = Cloud::read(&record.path, &molar_masses)?;
        let walls = Surfaces::walls(&record.path)?;
        let mut notes: Vec<String> = cloud.unreadable.iter().map(|why| format!("left out: {why}")).collect();
        let fabric = cloud.frames.iter().map(|frame| frame.fabric.corners());
        let corners = [cloud.corners(), walls.corners()].into_iter().chain(fabric).flatten();
        let Some([low, high]) = corners.reduce(extent::around) else {
            notes.push("The folder has no snapshots: `snapshots` in [output] says how many there shall be.".to_owned());
            return Ok(Viewed { view: None, notes });
        };
        if cloud.share < 1.0 {
            let shown = 100.0 * cloud.share;
            notes.push(format!("A sample is shown, the same {shown:.2} % of the particles in every snapshot."));
        }
        if cloud.frames.len() + cloud.unreadable.len() < cloud.snapshots {
            notes.push(format!("{} of {} snapshots are shown.", cloud.frames.len(), cloud.snapshots));
        }
        if let Some(triangles) = walls.coarser_than {
            notes.push(format!("The walls are drawn coarser than their {triangles} triangles."));
        }
        if let Some(triangles) = cloud.frames.iter().find_map(|frame| frame.fabric.coarser_than) {
            notes.push(format!("The fabric is drawn coarser than its {triangles} triangles."));
        }
        let view = View::new(record, &cloud, &walls, [low, high]);
        Ok(Viewed { view: Some(view), notes })
    }
}

impl View {
    fn new(record: &Record, cloud: &Cloud, walls: &Surfaces, [low, high]: [[f64; 3]; 2]) -> View {
        let system: UnitSystem = record.scene.units;
        let [length, velocity, time] = [Unit::length(system), Unit::velocity(system), Unit::time(system)];
        let in_unit = |range: [f64; 2], unit: Unit| range.map(|end| end / unit.factor);
        let [speed, temperature] = [cloud.range(|frame| &frame.speed), cloud.range(|frame| &frame.temperature)];
        let ranks = cloud.frames.iter().flat_map(|frame| &frame.subdomain).max().map_or(0, |last| last + 1);
        let times: Vec<f64> = cloud.frames.iter().map(|frame| frame.time).collect();
        let surface = |mesh: &SurfaceMesh, shifts: Vec<[f64; 3]>| PackedSurface {
            name: mesh.name.clone(),
            vertices: packed::floats(mesh.vertices.iter().flatten().map(|x| x / length.factor)),
            triangles: packed::words(mesh.triangles.iter().flatten().copied()),
            shifts: shifts.into_iter().map(|shift| shift.map(|x| x / length.factor)).collect(),
        };
        let wall =
            |(index, mesh): (usize, &SurfaceMesh)| surface(mesh, shifts(&record.scene, &record.history, index, &times));
        let frames = cloud.frames.iter().map(|frame| PackedFrame {
            time: frame.time / time.factor,
            count: frame.count,
            position: packed::shorts(
                frame
                    .position
                    .iter()
                    .flat_map(|p| [0, 1, 2].map(|axis| packed::step(p[axis], [low[axis], high[axis]]))),
            ),
            speed: steps(&frame.speed, speed),
            temperature: steps(&frame.temperature, temperature),
            gas: packed::bytes(frame.gas.clone()),
            subdomain: packed::shorts(frame.subdomain.iter().map(|&rank| rank.min(u32::from(u16::MAX)) as u16)),
            fabric: frame.fabric.meshes.iter().map(|mesh| surface(mesh, Vec::new())).collect(),
        });
        View {
            length: length.symbol,
            velocity: velocity.symbol,
            time: time.symbol,
            low: low.map(|x| x / length.factor),
            high: high.map(|x| x / length.factor),
            gases: cloud.gases.clone(),
            speed: in_unit(speed, velocity),
            temperature,
            subdomains: if cloud.has_subdomains() { ranks } else { 0 },
            walls: walls.meshes.iter().enumerate().map(wall).collect(),
            has_fabric: cloud.frames.iter().any(|frame| !frame.fabric.meshes.is_empty()),
            frames: frames.collect(),
        }
    }
}

/// How far a wall has moved at these times, by the history, m; empty of one that rests.
fn shifts(scene: &Scene, history: &History, wall: usize, times: &[f64]) -> Vec<[f64; 3]> {
    let Some(motion) = scene.motions.iter().find(|motion| motion.wall == wall) else { return Vec::new() };
    let head = format!("{}:displacement_m", scene.walls[wall].name);
    let Some(points) = history.points("time_s", &head).filter(|points| !points.is_empty()) else { return Vec::new() };
    // It starts where it is drawn, before the middle of the first row.
    let points: Vec<[f64; 2]> = std::iter::once([0.0, 0.0]).chain(points).collect();
    let at = |time: f64| {
        let next = points.partition_point(|point| point[0] < time);
        match (next.checked_sub(1).map(|k| points[k]), points.get(next)) {
            (Some([early, low]), Some(&[late, high])) => low + (high - low) * (time - early) / (late - early),
            (Some([_, last]), None) => last,
            (None, _) => 0.0,
        }
    };
    times.iter().map(|&time| motion.direction.map(|x| x * at(time))).collect()
}
