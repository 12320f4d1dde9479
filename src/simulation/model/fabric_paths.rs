//! The files of a fabric, and how they and its other keys say that its nodes move.

use glam::DVec3;

use super::error::ModelError;
use super::turning;
use crate::geometry::{NodeFrames, TriangleMesh};
use crate::plan::significant;
use crate::scene::{Dimension, Fabric, Turn, UnitSystem};

/// m/s: nodes that are faster have jumped.
const FASTEST_NODE: f64 = 3000.0;

/// A fabric's files, SI.
pub struct Read {
    pub mesh: TriangleMesh,
    pub path: Path,
    /// What is doubtful of them.
    pub notes: Vec<String>,
}

/// How the nodes of a fabric move, SI: from frame to frame, or from the first about an axis.
pub struct Path {
    frames: NodeFrames,
    turn: Option<Turn>,
}

impl Path {
    /// m, at a time, s.
    pub fn at(&self, time: f64) -> Vec<[f64; 3]> {
        match &self.turn {
            None => self.frames.at(time),
            Some(turn) => turning::turned(turn, self.frames.frame(0), time),
        }
    }

    /// m/s.
    pub fn fastest(&self) -> f64 {
        let turning = self.turn.as_ref().map(|turn| turning::fastest(turn, self.frames.frame(0)));
        turning.unwrap_or_else(|| self.frames.top_speed())
    }

    /// When velocities of nodes change, s; none if all rest.
    pub fn bends(&self) -> Vec<f64> {
        match &self.turn {
            None if self.frames.frame_count() > 1 => self.frames.times().to_vec(),
            None => Vec::new(),
            Some(turn) => turning::bends_of(turn),
        }
    }

    /// The corners of what one sweeps that turns, till a time, s, in m.
    pub fn arcs(&self, end: f64) -> Option<[DVec3; 2]> {
        Some(turning::swept(self.turn.as_ref()?, self.frames.frame(0), end))
    }
}

/// # Errors
/// If a file cannot be read, is of another mesh, or has nodes that jump.
pub fn read(fabric: &Fabric, units: UnitSystem) -> Result<Read, ModelError> {
    let refused = |problem: String| ModelError::Fabric { fabric: fabric.name.clone(), problem };
    let mut mesh = TriangleMesh::read(&fabric.mesh).map_err(|error| refused(error.to_string()))?;
    mesh.nodes.iter_mut().flatten().for_each(|x| *x *= fabric.scale);
    if mesh.triangles.is_empty() {
        return Err(refused(format!("{} has no triangle", fabric.mesh.display())));
    }
    let frames = match &fabric.motion {
        None => NodeFrames::new(vec![0.0], vec![mesh.nodes.clone()], Vec::new())
            .map_err(|error| refused(error.to_string()))?,
        Some(path) => {
            let read = NodeFrames::read(path).map_err(|error| refused(error.to_string()))?;
            let told = |error: &dyn std::fmt::Display| refused(format!("{}: {error}", path.display()));
            read.scaled(fabric.scale, units.factor(Dimension::Time)).map_err(|error| told(&error))?
        }
    };
    if frames.node_count() != mesh.nodes.len() {
        return Err(refused(format!(
            "its motion has {} nodes, and its mesh {}: they must be those of one mesh, in one order",
            frames.node_count(),
            mesh.nodes.len()
        )));
    }
    if fabric.external_pressure.is_some() && !mesh.is_closed() {
        return Err(refused(
            "it has an `external_pressure`, and its surface is open: an open sheet has no outside".into(),
        ));
    }
    let mut notes = Vec::new();
    for note in frames.notes(&mesh, FASTEST_NODE).map_err(|error| refused(error.to_string()))? {
        if matches!(note, crate::geometry::FrameNote::Jump { .. }) {
            return Err(refused(note.told(units)));
        }
        notes.push(format!("fabric `{}`: {}", fabric.name, note.told(units)));
    }
    let path = Path { frames, turn: fabric.turn.clone() };
    if fabric.turn.is_some() && path.fastest() > FASTEST_NODE {
        return Err(refused(format!(
            "its `turn` moves a node at {} m/s, more than {FASTEST_NODE} m/s: angles are in radians",
            significant(path.fastest())
        )));
    }
    // Turned outwards once the frames are known to be of it: their file has the triangles as the mesh has them.
    if mesh.is_closed() && mesh.volume() < 0.0 {
        mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    }
    Ok(Read { mesh, path, notes })
}
