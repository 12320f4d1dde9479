//! `corpuscle mesh`: makes meshes and motion of their nodes, converts and checks their files.

use std::fmt::Write;
use std::path::Path;

use super::CliError;
use super::arguments::{MeshArguments, MotionArguments, ShapeArguments};
use super::terminal::say;
use crate::geometry::{FrameFault, MeshShape, Motion, NodeFrames, NodeFramesError, Precision, TriangleMesh};
use crate::output::grouped;
use crate::scene::{Dimension, UnitSystem};

const SHAPES: [&str; 4] = ["teabag", "cushion", "cylinder", "sphere"];
/// m: a mesh that is larger, or smaller, is probably in other units.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = 1e-3..=20.0;
/// Of side or radius.
const GAP: f64 = 0.01;

pub fn mesh(raw: MeshArguments) -> Result<(), CliError> {
    let (mesh, frames) = content(&raw)?;
    say(&described(&mesh, &raw))?;
    if let Some(frames) = &frames {
        say(&course(frames, &mesh, &raw)?)?;
    }
    for path in &raw.out {
        write(path, &mesh, frames.as_ref(), raw.units)?;
        say(&format!("written {}\n", path.display()))?;
    }
    Ok(())
}

/// The mesh, in SI, and the motion of its nodes, if there is any.
fn content(raw: &MeshArguments) -> Result<(TriangleMesh, Option<NodeFrames>), CliError> {
    let path = Path::new(&raw.source);
    let [length, time] = [Dimension::Length, Dimension::Time].map(|quantity| raw.units.factor(quantity));
    if SHAPES.contains(&raw.source.as_str()) {
        let shape = shape(&raw.source, &raw.shape, length)?;
        let mesh = shape.mesh(raw.shape.center.map_or([0.0; 3], |point| point.0).map(|x| x * length))?;
        let frames = motion(&mesh, raw)?;
        return Ok((mesh, frames));
    }
    let is_mesh =
        path.extension().is_some_and(|ending| ["obj", "stl"].iter().any(|own| ending.eq_ignore_ascii_case(own)));
    if is_mesh {
        refuse_others(&raw.source, &given(&raw.shape), &[])?;
        let mut mesh = TriangleMesh::read(path)?;
        mesh.nodes.as_flattened_mut().iter_mut().for_each(|x| *x *= length);
        let frames = motion(&mesh, raw)?;
        Ok((mesh, frames))
    } else if NodeFrames::is_file(path) {
        let MotionArguments { shake, scale_to, frames, until, .. } = &raw.motion;
        let of_motion = [
            ("--shake", shake.is_some()),
            ("--scale-to", scale_to.is_some()),
            ("--frames", frames.is_some()),
            ("--until", until.is_some()),
        ];
        refuse_others(&raw.source, &[&given(&raw.shape)[..], &of_motion].concat(), &["--speed-limit"])?;
        let frames = NodeFrames::read(path)?.scaled(length, time).map_err(fault_of(path))?;
        let (nodes, triangles) = (frames.frame(0).to_vec(), frames.triangles().to_vec());
        let parts = vec![None; triangles.len()];
        Ok((TriangleMesh { nodes, triangles, parts, names: Vec::new() }, Some(frames)))
    } else {
        Err(CliError::MeshSource { found: raw.source.clone(), shapes: SHAPES.to_vec() })
    }
}

fn fault_of(path: &Path) -> impl FnOnce(FrameFault) -> NodeFramesError {
    move |fault| NodeFramesError::Frames { path: path.into(), file: None, fault }
}

/// `unit`: m per unit of length.
fn shape(name: &str, raw: &ShapeArguments, unit: f64) -> Result<MeshShape, CliError> {
    let takes: &[&'static str] = match name {
        "teabag" => &["--side", "--elements", "--gap"],
        "cushion" => &["--radius", "--rings", "--gap"],
        "cylinder" => &["--radius", "--height", "--around", "--along", "--closed"],
        _ => &["--radius", "--subdivisions"],
    };
    let own = [&["--center"], takes].concat();
    refuse_others(name, &given(raw), &own)?;
    let length = |option: &'static str, value: Option<f64>| {
        value.map(|value| value * unit).ok_or_else(|| CliError::MeshNeeds { source_name: name.into(), option })
    };
    let gap = |extent: f64| raw.gap.map_or(GAP * extent, |gap| gap * unit);
    Ok(match name {
        "teabag" => {
            let side = length("--side", raw.side)?;
            MeshShape::Teabag { side, elements: raw.elements.unwrap_or(20), gap: gap(side) }
        }
        "cushion" => {
            let radius = length("--radius", raw.radius)?;
            MeshShape::Cushion { radius, rings: raw.rings.unwrap_or(12), gap: gap(radius) }
        }
        "cylinder" => MeshShape::Cylinder {
            radius: length("--radius", raw.radius)?,
            height: length("--height", raw.height)?,
            around: raw.around.unwrap_or(48),
            along: raw.along,
            closed: raw.closed,
        },
        _ => MeshShape::Sphere { radius: length("--radius", raw.radius)?, subdivisions: raw.subdivisions.unwrap_or(3) },
    })
}

/// The options of shapes, and whether they are given.
fn given(raw: &ShapeArguments) -> [(&'static str, bool); 11] {
    [
        ("--center", raw.center.is_some()),
        ("--side", raw.side.is_some()),
        ("--elements", raw.elements.is_some()),
        ("--gap", raw.gap.is_some()),
        ("--radius", raw.radius.is_some()),
        ("--rings", raw.rings.is_some()),
        ("--height", raw.height.is_some()),
        ("--around", raw.around.is_some()),
        ("--along", raw.along.is_some()),
        ("--closed", raw.closed),
        ("--subdivisions", raw.subdivisions.is_some()),
    ]
}

fn refuse_others(source: &str, given: &[(&'static str, bool)], takes: &[&'static str]) -> Result<(), CliError> {
    match given.iter().find(|(option, is_given)| *is_given && !takes.contains(option)) {
        None => Ok(()),
        Some((option, _)) => {
            let takes = takes.to_vec();
            Err(CliError::MeshOption { source_name: source.into(), option, takes })
        }
    }
}

fn motion(mesh: &TriangleMesh, raw: &MeshArguments) -> Result<Option<NodeFrames>, CliError> {
    let MotionArguments { shake, amplitude, seed, scale_to, frames, until, .. } = raw.motion;
    let factor = |quantity| raw.units.factor(quantity);
    let motion = match (shake, scale_to) {
        (Some(speed), _) => Motion::Shake {
            speed: speed * factor(Dimension::Velocity),
            amplitude: amplitude.map(|amplitude| amplitude * factor(Dimension::Length)),
            seed: seed.unwrap_or(1),
        },
        (None, Some(factor)) => Motion::Scale { factor },
        (None, None) => {
            let limit = ("--speed-limit", raw.motion.speed_limit.is_some());
            let asked = [("--frames", frames.is_some()), ("--until", until.is_some()), limit];
            refuse_others("a mesh without --shake or --scale-to", &asked, &[])?;
            return Ok(None);
        }
    };
    let until = until.unwrap_or_default() * factor(Dimension::Time);
    Ok(Some(motion.frames(mesh, frames.unwrap_or_default(), until)?))
}

fn described(mesh: &TriangleMesh, raw: &MeshArguments) -> String {
    let of = |quantity: Dimension, value: f64| {
        format!("{:.6e} {}", value / raw.units.factor(quantity), raw.units.symbol(quantity))
    };
    let closed = if mesh.is_closed() { "closed" } else { "open" };
    let mut text = format!(
        "{}: {} nodes, {} triangles, {closed}, area {}",
        raw.source,
        grouped(mesh.nodes.len() as u64),
        grouped(mesh.triangles.len() as u64),
        of(Dimension::Area, mesh.area())
    );
    if mesh.is_closed() {
        let _ = write!(text, ", volume {}", of(Dimension::Volume, mesh.volume()));
    }
    text.push('\n');
    for part in mesh.measures().iter().filter(|_| !mesh.names.is_empty()) {
        let name = if part.name.is_empty() { "(no part)" } else { &part.name };
        let triangles = grouped(part.triangles as u64);
        let (area, volume) = (of(Dimension::Area, part.area), of(Dimension::Volume, part.volume));
        let _ = writeln!(text, "  {name}: {triangles} triangles, area {area}, its share of the volume {volume}");
    }
    let [low, high] = mesh.bounds();
    let extent = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    if !PLAUSIBLE.contains(&extent) {
        let _ = writeln!(text, "note: the mesh extends over {extent:.4e} m: is that meant, or are --units others?");
    }
    text
}

/// What frames do, and what is doubtful in them.
fn course(frames: &NodeFrames, mesh: &TriangleMesh, raw: &MeshArguments) -> Result<String, CliError> {
    let units = raw.units;
    let of =
        |quantity: Dimension, value: f64| format!("{:.4e} {}", value / units.factor(quantity), units.symbol(quantity));
    let place = |point: [f64; 3]| format!("({})", point.map(|x| format!("{:.4e}", x / units.length().0)).join(", "));
    let times = frames.times();
    let [low, high] = frames.bounds();
    let mut text = format!(
        "{} frames from {} to {}, top speed {}, within {} to {} {}\n",
        grouped(frames.frame_count() as u64),
        of(Dimension::Time, times[0]),
        of(Dimension::Time, times[times.len() - 1]),
        of(Dimension::Velocity, frames.top_speed()),
        place(low),
        place(high),
        units.length().1
    );
    let limit = raw.motion.speed_limit.map_or(f64::INFINITY, |limit| limit * units.factor(Dimension::Velocity));
    let notes = frames.notes(mesh, limit).map_err(fault_of(Path::new(&raw.source)))?;
    for note in notes {
        let _ = writeln!(text, "note: {}", note.told(units));
    }
    Ok(text)
}

fn write(path: &Path, mesh: &TriangleMesh, frames: Option<&NodeFrames>, units: UnitSystem) -> Result<(), CliError> {
    let [length, time] = [Dimension::Length, Dimension::Time].map(|quantity| units.factor(quantity));
    if !NodeFrames::is_file(path) {
        if mesh.triangles.is_empty() {
            let (found, expected) = ("nodes without triangles", "a mesh, or a file for frames");
            return Err(CliError::MeshOutput { path: path.into(), found, expected });
        }
        return Ok(mesh.write(path, length)?);
    }
    let Some(frames) = frames else {
        let (found, expected) = ("a mesh without motion", "--shake or --scale-to, or a file for a mesh");
        return Err(CliError::MeshOutput { path: path.into(), found, expected });
    };
    let scaled = frames.clone().scaled(1.0 / length, 1.0 / time).map_err(fault_of(path))?;
    Ok(scaled.write(path, Precision::Double)?)
}
