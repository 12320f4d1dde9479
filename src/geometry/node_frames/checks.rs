//! What in frames is doubtful: nodes that jump, triangles that turn over or have no area.

use super::error::FrameFault;
use super::frames::NodeFrames;
use crate::geometry::TriangleMesh;
use crate::geometry::closed::is_flat;
use crate::geometry::error::Places;
use crate::scene::{Dimension, UnitSystem};
use glam::DVec3;
use std::fmt;

/// How often something was found, and where first or worst.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spot {
    /// Cases: each node or triangle counts once for each frame.
    pub count: usize,
    /// Node or triangle.
    pub index: usize,
    pub frame: usize,
    /// s, of the frame.
    pub time: f64,
    /// m: of the node, or the middle of the triangle.
    pub place: [f64; 3],
}

/// Frames and indices count from 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum FrameNote {
    /// Nodes that are faster than a limit on the way to the next frame; the spot is the fastest.
    Jump { spot: Spot, speed: f64, limit: f64 },
    /// Triangles whose normals in a frame and the next are more than a right angle apart; the spot is the first.
    TurnedOver { spot: Spot },
    /// Triangles without area in a frame; the spot is the first.
    Flat { spot: Spot },
}

impl FrameNote {
    /// In words, in the units of a scene.
    pub fn told(&self, units: UnitSystem) -> String {
        let of = |quantity: Dimension, value: f64| {
            format!("{:.4e} {}", value / units.factor(quantity), units.symbol(quantity))
        };
        let at = |spot: &Spot| {
            let place = Places::one(spot.place.into()).told_in(units);
            format!("frame {} (time {}), {place}", spot.frame, of(Dimension::Time, spot.time))
        };
        match self {
            FrameNote::Jump { spot, speed, limit } => format!(
                "{} times a node moves faster than {} to the next frame; fastest is node {} with {}, from {}",
                spot.count,
                of(Dimension::Velocity, *limit),
                spot.index,
                of(Dimension::Velocity, *speed),
                at(spot)
            ),
            FrameNote::TurnedOver { spot } => format!(
                "{} times a triangle turns by more than a right angle to the next frame; first is triangle {} from {}",
                spot.count,
                spot.index,
                at(spot)
            ),
            FrameNote::Flat { spot } => format!(
                "{} times a triangle has no area in a frame; first is triangle {} in {}",
                spot.count,
                spot.index,
                at(spot)
            ),
        }
    }
}

impl fmt::Display for FrameNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.told(UnitSystem::Si))
    }
}

impl NodeFrames {
    /// What is doubtful in frames of a mesh; nodes may move as fast as `limit` (m/s).
    ///
    /// # Errors
    /// They are of another mesh.
    pub fn notes(&self, mesh: &TriangleMesh, limit: f64) -> Result<Vec<FrameNote>, FrameFault> {
        self.check_mesh(mesh)?;
        let triangles = &mesh.triangles;
        Ok([self.jumps(limit), self.turned_over(triangles), self.flat(triangles)].into_iter().flatten().collect())
    }

    fn spot(&self, index: usize, frame: usize, place: DVec3) -> Spot {
        Spot { count: 1, index, frame, time: self.times()[frame], place: place.to_array() }
    }

    fn jumps(&self, limit: f64) -> Option<FrameNote> {
        let mut worst: Option<(Spot, f64)> = None;
        for frame in 1..self.frame_count() {
            let (frame, span) = (frame - 1, self.span(frame - 1));
            for (node, (from, to)) in self.pairs(frame).enumerate() {
                let speed = DVec3::from(*from).distance(DVec3::from(*to)) / span;
                if speed <= limit {
                    continue;
                }
                let count = worst.map_or(1, |(spot, _)| spot.count + 1);
                let (spot, fastest) = worst.get_or_insert((self.spot(node, frame, DVec3::from(*from)), speed));
                if speed > *fastest {
                    (*spot, *fastest) = (self.spot(node, frame, DVec3::from(*from)), speed);
                }
                spot.count = count;
            }
        }
        worst.map(|(spot, speed)| FrameNote::Jump { spot, speed, limit })
    }

    fn turned_over(&self, triangles: &[[u32; 3]]) -> Option<FrameNote> {
        let turns = |frame: usize, t: &[u32; 3]| {
            frame + 1 < self.frame_count() && self.normal(frame, t).dot(self.normal(frame + 1, t)) < 0.0
        };
        self.first(triangles, turns).map(|spot| FrameNote::TurnedOver { spot })
    }

    fn flat(&self, triangles: &[[u32; 3]]) -> Option<FrameNote> {
        self.first(triangles, |frame, t| is_flat(self.corners(frame, t))).map(|spot| FrameNote::Flat { spot })
    }

    /// The first triangle, by frame, of which something is true, with how many there are.
    fn first(&self, triangles: &[[u32; 3]], is_one: impl Fn(usize, &[u32; 3]) -> bool) -> Option<Spot> {
        let mut first: Option<Spot> = None;
        for frame in 0..self.frame_count() {
            for (k, t) in triangles.iter().enumerate().filter(|(_, t)| is_one(frame, t)) {
                match &mut first {
                    Some(spot) => spot.count += 1,
                    None => {
                        let [a, b, c] = self.corners(frame, t);
                        first = Some(self.spot(k, frame, (a + b + c) / 3.0));
                    }
                }
            }
        }
        first
    }

    fn corners(&self, frame: usize, triangle: &[u32; 3]) -> [DVec3; 3] {
        let nodes = self.frame(frame);
        triangle.map(|node| DVec3::from(nodes[node as usize]))
    }

    fn normal(&self, frame: usize, triangle: &[u32; 3]) -> DVec3 {
        let [a, b, c] = self.corners(frame, triangle);
        (b - a).cross(c - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{MeshShape, Motion};

    fn mesh() -> TriangleMesh {
        MeshShape::Sphere { radius: 0.1, subdivisions: 1 }.mesh([0.0; 3]).unwrap()
    }

    fn told(frames: &NodeFrames, limit: f64) -> Vec<String> {
        frames.notes(&mesh(), limit).unwrap().iter().map(FrameNote::to_string).collect()
    }

    #[test]
    fn sound_frames_have_no_notes() {
        let frames = Motion::Shake { speed: 5.0, amplitude: Some(5e-3), seed: 1 }.frames(&mesh(), 20, 0.01).unwrap();
        assert_eq!(told(&frames, 5.001), [""; 0]);
        let [note] = &told(&frames, 4.999)[..] else { panic!() };
        // All nodes in all intervals.
        let count = 19 * mesh().nodes.len();
        assert!(note.starts_with(&format!("{count} times a node moves faster than 4.9990e0 m/s")), "{note}");
    }

    #[test]
    fn jumps_flips_and_flat_triangles_are_found() {
        let mut second = mesh().nodes;
        // Through the middle and out at the other side: its triangles turn over.
        second[7] = second[7].map(|x| -2.0 * x);
        let mut third = second.clone();
        // Onto its neighbour: the two triangles of the edge have no area.
        let t = mesh().triangles[0];
        third[t[0] as usize] = third[t[1] as usize];
        let frames = NodeFrames::new(vec![0.0, 0.1, 0.2], vec![mesh().nodes, second, third], vec![]).unwrap();
        let [jump, turned, flat] = &told(&frames, 2.9)[..] else { panic!("{:?}", told(&frames, 2.9)) };
        assert!(jump.starts_with("1 times a node moves faster than 2.9000e0 m/s"), "{jump}");
        assert!(
            jump.contains("fastest is node 7 with 3.0000e0 m/s, from frame 0 (time 0.0000e0 s), in m: ("),
            "{jump}"
        );
        assert!(turned.contains("turns by more than a right angle") && turned.contains("from frame 0"), "{turned}");
        assert!(flat.starts_with("2 times a triangle has no area") && flat.contains("triangle 0 in frame 2"), "{flat}");
        let note = frames.notes(&mesh(), 2.9).unwrap()[0].told(UnitSystem::KgMmMs);
        assert!(note.contains("3.0000e0 mm/ms") && note.contains("in mm: ("), "{note}");
    }
}
