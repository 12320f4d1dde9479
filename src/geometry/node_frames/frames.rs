//! Where the nodes of a mesh are over time: straight and uniform from frame to frame.
//!
//! Before the first frame the nodes rest where it has them, after the last where that has them. At the time of a frame they
//! are just where it has them, and the velocity is that after it.

use super::error::FrameFault;
use crate::geometry::TriangleMesh;
use glam::DVec3;

#[derive(Debug, Clone, PartialEq)]
pub struct NodeFrames {
    /// s, strictly increasing, at least one.
    times: Vec<f64>,
    /// m, frame by frame.
    positions: Vec<[f64; 3]>,
    /// Nodes in a frame, at least one.
    nodes: usize,
    /// The mesh whose nodes they are; empty if nothing says so.
    triangles: Vec<[u32; 3]>,
}

/// Between which frames a time is.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Moment {
    /// At rest in a frame, before the first or from the last on.
    Rest(usize),
    /// So far, from 0 to below 1, from a frame to the next.
    Between(usize, f64),
}

impl NodeFrames {
    /// `frames`: the nodes (m) at each of `times` (s). `triangles` may be empty.
    pub fn new(
        times: Vec<f64>,
        frames: Vec<Vec<[f64; 3]>>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<NodeFrames, FrameFault> {
        let nodes = frames.first().ok_or(FrameFault::NoFrame)?.len();
        if let Some((frame, other)) = frames.iter().enumerate().find(|(_, other)| other.len() != nodes) {
            return Err(FrameFault::NodeCount { frame, found: other.len(), expected: nodes });
        }
        NodeFrames::of_parts(times, frames.concat(), nodes, triangles)
    }

    /// The same with the nodes of all frames in one list.
    pub(super) fn of_parts(
        times: Vec<f64>,
        positions: Vec<[f64; 3]>,
        nodes: usize,
        triangles: Vec<[u32; 3]>,
    ) -> Result<NodeFrames, FrameFault> {
        if times.is_empty() {
            return Err(FrameFault::NoFrame);
        }
        if nodes == 0 {
            return Err(FrameFault::NoNode);
        }
        if times.len() * nodes != positions.len() {
            return Err(FrameFault::TimeCount { times: times.len(), frames: positions.len() / nodes });
        }
        for (frame, &found) in times.iter().enumerate() {
            let before = frame.checked_sub(1).map(|before| times[before]);
            if !found.is_finite() || before.is_some_and(|before| found <= before) {
                return Err(FrameFault::Time { frame, found, before });
            }
        }
        if let Some(k) = positions.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
            return Err(FrameFault::NotFinite { frame: k / nodes, node: k % nodes, found: positions[k] });
        }
        let flat = triangles.as_flattened();
        if let Some(k) = flat.iter().position(|&v| v as usize >= nodes) {
            return Err(FrameFault::NoSuchNode { triangle: k / 3, found: flat[k].into(), nodes });
        }
        Ok(NodeFrames { times, positions, nodes, triangles })
    }

    /// s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    pub fn frame_count(&self) -> usize {
        self.times.len()
    }

    pub fn node_count(&self) -> usize {
        self.nodes
    }

    /// Empty if the file has none.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The nodes of a frame, m.
    pub fn frame(&self, frame: usize) -> &[[f64; 3]] {
        &self.positions[frame * self.nodes..(frame + 1) * self.nodes]
    }

    pub(super) fn positions(&self) -> &[[f64; 3]] {
        &self.positions
    }

    fn moment(&self, time: f64) -> Moment {
        // Frames that have begun; not a number is before all.
        let begun = self.times.partition_point(|&own| own <= time);
        match begun {
            0 => Moment::Rest(0),
            all if all == self.times.len() => Moment::Rest(all - 1),
            _ => {
                let (from, to) = (self.times[begun - 1], self.times[begun]);
                Moment::Between(begun - 1, (time - from) / (to - from))
            }
        }
    }

    /// The nodes at a time (s), m.
    pub fn at(&self, time: f64) -> Vec<[f64; 3]> {
        match self.moment(time) {
            Moment::Rest(frame) => self.frame(frame).to_vec(),
            Moment::Between(frame, share) => self
                .pairs(frame)
                .map(|(a, b)| std::array::from_fn(|axis| a[axis] + (b[axis] - a[axis]) * share))
                .collect(),
        }
    }

    /// The velocities of the nodes at a time (s), m/s: at the time of a frame those after it.
    pub fn velocity(&self, time: f64) -> Vec<[f64; 3]> {
        match self.moment(time) {
            Moment::Rest(_) => vec![[0.0; 3]; self.nodes],
            Moment::Between(frame, _) => {
                let span = self.span(frame);
                self.pairs(frame).map(|(a, b)| std::array::from_fn(|axis| (b[axis] - a[axis]) / span)).collect()
            }
        }
    }

    /// Each node in a frame and in the next.
    pub(super) fn pairs(&self, frame: usize) -> impl Iterator<Item = (&[f64; 3], &[f64; 3])> {
        self.frame(frame).iter().zip(self.frame(frame + 1))
    }

    /// From a frame to the next, s.
    pub(super) fn span(&self, frame: usize) -> f64 {
        self.times[frame + 1] - self.times[frame]
    }

    /// The corners of the box that no node leaves at any time, m.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let bounds = self.positions.iter().map(|&p| DVec3::from(p));
        let (low, high) = bounds.fold(start, |(low, high), p| (low.min(p), high.max(p)));
        [low.to_array(), high.to_array()]
    }

    /// The greatest speed of any node, m/s.
    pub fn top_speed(&self) -> f64 {
        let fastest = |frame: usize| {
            let way = self.pairs(frame).map(|(a, b)| DVec3::from(*a).distance(DVec3::from(*b))).fold(0.0, f64::max);
            way / self.span(frame)
        };
        (1..self.frame_count()).map(|next| fastest(next - 1)).fold(0.0, f64::max)
    }

    /// With lengths and times multiplied: from the units of a file to SI, or back.
    ///
    /// # Errors
    /// Factors that leave no finite positions or no increasing times.
    pub fn scaled(self, length: f64, time: f64) -> Result<NodeFrames, FrameFault> {
        let NodeFrames { mut times, mut positions, nodes, triangles } = self;
        times.iter_mut().for_each(|own| *own *= time);
        positions.as_flattened_mut().iter_mut().for_each(|x| *x *= length);
        NodeFrames::of_parts(times, positions, nodes, triangles)
    }

    /// That they are of a mesh: as many nodes, and the same triangles if the frames have any.
    pub fn check_mesh(&self, mesh: &TriangleMesh) -> Result<(), FrameFault> {
        let (found, expected) = (self.nodes, mesh.nodes.len());
        if found != expected {
            return Err(FrameFault::OtherNodes { found, expected });
        }
        if self.triangles.is_empty() {
            return Ok(());
        }
        let (found, expected) = (self.triangles.len(), mesh.triangles.len());
        if found != expected {
            return Err(FrameFault::OtherTriangles { found, expected });
        }
        let pairs = self.triangles.iter().zip(&mesh.triangles).enumerate();
        match pairs.map(|(k, (own, of_mesh))| (k, *own, *of_mesh)).find(|(_, own, of_mesh)| own != of_mesh) {
            None => Ok(()),
            Some((triangle, found, expected)) => Err(FrameFault::OtherConnectivity { triangle, found, expected }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two() -> NodeFrames {
        let frames = vec![vec![[0.0; 3], [1.0; 3]], vec![[0.3, 0.0, 0.0], [1.0; 3]], vec![[0.3, -0.4, 0.0], [7.0; 3]]];
        NodeFrames::new(vec![1.0, 1.1, 1.3], frames, Vec::new()).unwrap()
    }

    #[test]
    fn nodes_move_straight_between_frames_and_rest_beyond_them() {
        let frames = two();
        for (frame, &time) in frames.times().iter().enumerate() {
            assert_eq!(frames.at(time), frames.frame(frame), "exactly");
        }
        for (time, frame) in [(f64::NEG_INFINITY, 0), (0.0, 0), (1.3, 2), (99.0, 2), (f64::NAN, 0)] {
            assert_eq!((frames.at(time), frames.velocity(time)), (frames.frame(frame).to_vec(), vec![[0.0; 3]; 2]));
        }
        let near = |a: [f64; 3], b: [f64; 3]| DVec3::from(a).distance(DVec3::from(b)) < 1e-12;
        assert!(near(frames.at(1.05)[0], [0.15, 0.0, 0.0]) && near(frames.at(1.25)[0], [0.3, -0.3, 0.0]));
        // At the time of a frame the velocity is that after it.
        assert!(near(frames.velocity(1.0)[0], [3.0, 0.0, 0.0]) && near(frames.velocity(1.1)[0], [0.0, -2.0, 0.0]));
        assert!((frames.top_speed() - 30.0 * 3f64.sqrt()).abs() < 1e-9);
        assert_eq!(frames.bounds(), [[0.0, -0.4, 0.0], [7.0; 3]]);
    }

    /// The velocity is the slope of the positions within an interval.
    #[test]
    fn the_velocity_is_the_slope() {
        let frames = two();
        for time in [1.01, 1.09, 1.11, 1.29] {
            let (before, after) = (frames.at(time - 1e-4), frames.at(time + 1e-4));
            for (k, v) in frames.velocity(time).into_iter().enumerate() {
                let slope = (DVec3::from(after[k]) - DVec3::from(before[k])) / 2e-4;
                assert!(slope.distance(DVec3::from(v)) < 1e-9);
            }
        }
    }

    #[test]
    fn frames_that_do_not_fit_are_refused() {
        let one = || vec![[0.0; 3]; 3];
        let new = |times: &[f64], frames: Vec<Vec<[f64; 3]>>| {
            NodeFrames::new(times.to_vec(), frames, vec![[0, 1, 2]]).unwrap_err().to_string()
        };
        assert_eq!(new(&[], vec![]), "found no frame, expected at least one");
        assert_eq!(new(&[0.0], vec![vec![]]), "found no node, expected at least one");
        let words = "frame 1: found 2 nodes, expected 3 as in frame 0";
        assert_eq!(new(&[0.0, 1.0], vec![one(), vec![[0.0; 3]; 2]]), words);
        assert_eq!(new(&[0.0], vec![one(), one()]), "found 1 times, expected one for each of the 2 frames");
        let words = "frame 1: found the time 2, expected a finite one after 2, that of the frame before";
        assert_eq!(new(&[2.0, 2.0], vec![one(), one()]), words);
        assert_eq!(new(&[f64::NAN], vec![one()]), "frame 0: found the time NaN, expected a finite one");
        let mut bad = one();
        bad[2][1] = f64::INFINITY;
        let words = "frame 1, node 2: found [0.0, inf, 0.0], expected finite numbers";
        assert_eq!(new(&[0.0, 1.0], vec![one(), bad]), words);
        let error = NodeFrames::new(vec![0.0], vec![one()], vec![[0, 1, 2], [0, 3, 2]]).unwrap_err();
        assert_eq!(error.to_string(), "triangle 1: found node 3, expected one of the 3 from 0 on");
    }

    #[test]
    fn frames_are_of_their_mesh_only() {
        let mesh = crate::geometry::MeshShape::Teabag { side: 1.0, elements: 2, gap: 0.1 }.mesh([0.0; 3]).unwrap();
        let of = |triangles: Vec<[u32; 3]>| NodeFrames::new(vec![0.0], vec![mesh.nodes.clone()], triangles).unwrap();
        assert_eq!(of(mesh.triangles.clone()).check_mesh(&mesh), Ok(()));
        assert_eq!(of(Vec::new()).check_mesh(&mesh), Ok(()));
        let mut turned = mesh.triangles.clone();
        turned[3].swap(0, 1);
        assert!(matches!(of(turned).check_mesh(&mesh), Err(FrameFault::OtherConnectivity { triangle: 3, .. })));
        let fewer = of(mesh.triangles[1..].to_vec());
        assert_eq!(fewer.check_mesh(&mesh), Err(FrameFault::OtherTriangles { found: 15, expected: 16 }));
        assert_eq!(two().check_mesh(&mesh), Err(FrameFault::OtherNodes { found: 2, expected: 10 }));
    }

    #[test]
    fn units_scale_lengths_and_times() {
        let scaled = two().scaled(1e-3, 1e-3).unwrap();
        assert!(scaled.times().iter().zip(two().times()).all(|(own, before)| (own * 1e3 / before - 1.0).abs() < 1e-15));
        assert!((scaled.top_speed() / two().top_speed() - 1.0).abs() < 1e-9);
        assert!(two().scaled(1.0, 0.0).is_err() && two().scaled(f64::NAN, 1.0).is_err());
    }
}
