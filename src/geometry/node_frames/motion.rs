//! Motion of a mesh's nodes to try prescribed motion with.

use super::frames::NodeFrames;
use crate::geometry::{MeshError, TriangleMesh};
use glam::DVec3;
use std::f64::consts::TAU;

/// What frames with their nodes may hold, 6 GiB in f64.
const MOST_POSITIONS: usize = 1 << 28;
const MOST_FRAMES: usize = 100_000;
const MOST_FACTOR: f64 = 100.0;
/// m/s.
const FASTEST: f64 = 1e5;
/// s.
const LONGEST: f64 = 1e4;
/// Of the least distance between two nodes: how far from its start a node is shaken if nothing is asked for.
const AMPLITUDE: f64 = 0.2;
/// Directions that are tried before a node goes back towards its start.
const TRIES: u32 = 64;

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Motion {
    /// From frame to frame each node moves at `speed` (m/s) into a direction by chance, never farther from its start than
    /// `amplitude` (m).
    Shake { speed: f64, amplitude: Option<f64>, seed: u64 },
    /// All nodes move straight to so many times their distance from the middle of the mesh's box.
    Scale { factor: f64 },
}

impl Motion {
    fn name(self) -> &'static str {
        match self {
            Motion::Shake { .. } => "shake",
            Motion::Scale { .. } => "scale",
        }
    }

    /// `count` frames of a mesh from the time 0 to `until` (s), at equal distances.
    pub fn frames(self, mesh: &TriangleMesh, count: usize, until: f64) -> Result<NodeFrames, MeshError> {
        let within = |what, value: f64, most: f64, unit: &str| {
            if value > 0.0 && value <= most {
                return Ok(());
            }
            Err(self.refused(what, format!("{value} {unit}"), format!("a number above 0, to {most} {unit}")))
        };
        within("the end", until, LONGEST, "s")?;
        let most = MOST_FRAMES.min(MOST_POSITIONS / mesh.nodes.len().max(1)).max(2);
        if !(2..=most).contains(&count) {
            return Err(self.refused("frames", count.to_string(), format!("2 to {most}")));
        }
        let times: Vec<f64> = (0..count).map(|k| until * (k as f64 / (count - 1) as f64)).collect();
        let frames = match self {
            Motion::Shake { speed, amplitude, seed } => {
                within("the speed", speed, FASTEST, "m/s")?;
                let amplitude = amplitude.unwrap_or_else(|| AMPLITUDE * mesh.least_distance());
                let way = speed * until / (count - 1) as f64;
                if !(amplitude >= way && amplitude.is_finite()) {
                    let needed = (speed * until / amplitude).ceil() + 1.0;
                    let more = if needed <= most as f64 { format!(", or {needed} frames") } else { String::new() };
                    let expected = format!("at least the way from frame to frame, {way:.3e} m{more}");
                    return Err(self.refused("the amplitude", format!("{amplitude:.3e} m"), expected));
                }
                shaken(mesh, &times, Walk { speed, amplitude, seed })
            }
            Motion::Scale { factor } => {
                within("the factor", factor, MOST_FACTOR, "times")?;
                let middle = DVec3::from(mesh.middle());
                let at = |time: &f64| {
                    let grown = 1.0 + (factor - 1.0) * (time / until);
                    mesh.places().iter().map(|&p| (middle + (p - middle) * grown).to_array()).collect()
                };
                times.iter().map(at).collect()
            }
        };
        let triangles = mesh.triangles.clone();
        NodeFrames::new(times, frames, triangles)
            .map_err(|fault| self.refused("its frames", fault.to_string(), "frames of a mesh".into()))
    }

    fn refused(self, what: &'static str, found: String, expected: String) -> MeshError {
        MeshError::Number { shape: self.name(), what, found, expected }
    }
}

struct Walk {
    speed: f64,
    amplitude: f64,
    seed: u64,
}

fn shaken(mesh: &TriangleMesh, times: &[f64], walk: Walk) -> Vec<Vec<[f64; 3]>> {
    let start = mesh.places();
    let mut away = vec![DVec3::ZERO; start.len()];
    let mut frames = vec![mesh.nodes.clone()];
    for (frame, pair) in times.windows(2).enumerate() {
        let way = walk.speed * (pair[1] - pair[0]);
        for (node, away) in away.iter_mut().enumerate() {
            let mut draws = Draws::new(walk.seed, [frame as u64, node as u64]);
            let tried = (0..TRIES).map(|_| *away + draws.direction() * way);
            let back = || *away - away.try_normalize().unwrap_or(DVec3::X) * way;
            *away = tried.into_iter().find(|place| place.length() <= walk.amplitude).unwrap_or_else(back);
        }
        frames.push(start.iter().zip(&away).map(|(place, away)| (*place + *away).to_array()).collect());
    }
    frames
}

/// SplitMix64 (Steele, Lea and Flood 2014), of a stream for each node and frame.
struct Draws(u64);

impl Draws {
    fn new(seed: u64, keys: [u64; 2]) -> Draws {
        let mut draws = Draws(seed);
        for key in keys {
            draws.0 = draws.next() ^ key;
        }
        draws
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        mixed ^ (mixed >> 31)
    }

    /// In (0, 1).
    fn uniform(&mut self) -> f64 {
        ((self.next() >> 12) as f64 + 0.5) / (1u64 << 52) as f64
    }

    /// Of any direction alike.
    fn direction(&mut self) -> DVec3 {
        let (z, angle) = (2.0 * self.uniform() - 1.0, TAU * self.uniform());
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * libm::cos(angle), r * libm::sin(angle), z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::MeshShape;

    fn bag() -> TriangleMesh {
        MeshShape::Teabag { side: 0.5, elements: 10, gap: 0.01 }.mesh([0.2, 0.0, 0.0]).unwrap()
    }

    fn mean(frames: &NodeFrames, of: impl Fn(usize, DVec3) -> f64) -> f64 {
        let all = (0..frames.frame_count())
            .flat_map(|frame| frames.frame(frame).iter().enumerate().map(|(node, p)| (node, DVec3::from(*p))));
        all.map(|(node, place)| of(node, place)).sum::<f64>() / (frames.frame_count() * frames.node_count()) as f64
    }

    /// Nodes move at just the speed, stay near their places, drift nowhere, and are others with another seed.
    #[test]
    fn shaken_nodes_keep_speed_and_amplitude() {
        let mesh = bag();
        let shake = |seed| Motion::Shake { speed: 20.0, amplitude: None, seed }.frames(&mesh, 101, 5e-3).unwrap();
        let frames = shake(1);
        assert_eq!((frames.frame(0), frames.triangles()), (&mesh.nodes[..], &mesh.triangles[..]));
        for frame in 0..100 {
            for (a, b) in frames.pairs(frame) {
                let speed = DVec3::from(*a).distance(DVec3::from(*b)) / frames.span(frame);
                assert!((speed / 20.0 - 1.0).abs() < 1e-9, "{speed}");
            }
        }
        let away = |node: usize, place: DVec3| place.distance(DVec3::from(mesh.nodes[node]));
        for frame in 0..101 {
            let nodes = frames.frame(frame).iter().enumerate();
            assert!(nodes.into_iter().all(|(node, p)| away(node, DVec3::from(*p)) <= 0.002 * (1.0 + 1e-9)));
        }
        assert!(mean(&frames, away) > 8e-4);
        for axis in 0..3 {
            let drift = mean(&frames, |node, place| place[axis] - mesh.nodes[node][axis]);
            assert!(drift.abs() < 1e-4, "{axis}: {drift}");
        }
        assert_eq!(frames, shake(1));
        assert_ne!(frames, shake(2));
    }

    #[test]
    fn a_scaled_mesh_shrinks_linearly_about_its_middle() {
        let mesh = bag();
        let frames = Motion::Scale { factor: 0.25 }.frames(&mesh, 4, 3e-3).unwrap();
        let scaled = |time: f64| TriangleMesh { nodes: frames.at(time), ..mesh.clone() };
        for (time, factor) in [(0.0, 1.0), (1e-3, 0.75), (1.5e-3, 0.625), (3e-3, 0.25), (9.0, 0.25f64)] {
            let volume = scaled(time).volume() / mesh.volume();
            assert!((volume / factor.powi(3) - 1.0).abs() < 1e-9, "{time}: {volume}");
            assert!((scaled(time).middle()[0] - 0.2).abs() < 1e-12);
        }
    }

    #[test]
    fn motion_that_cannot_be_is_refused() {
        let mesh = bag();
        let shake = |speed, amplitude| Motion::Shake { speed, amplitude, seed: 1 };
        let refused = |motion: Motion, count, until| motion.frames(&mesh, count, until).unwrap_err().to_string();
        assert!(refused(shake(-1.0, None), 10, 1.0).contains("shake: the speed: found -1 m/s"));
        assert!(refused(shake(1.0, None), 1, 1.0).contains("shake: frames: found 1, expected 2 to 100000"));
        assert!(refused(shake(1.0, None), 10, f64::NAN).contains("the end: found NaN s"));
        let words =
            "the amplitude: found 2.000e-3 m, expected at least the way from frame to frame, 1.111e-2 m, or 51 frames";
        assert!(refused(shake(10.0, None), 10, 1e-2).contains(words));
        assert!(shake(10.0, None).frames(&mesh, 52, 1e-2).is_ok());
        assert!(refused(shake(1.0, Some(f64::INFINITY)), 10, 1e-3).contains("found inf m"));
        assert!(refused(Motion::Scale { factor: 0.0 }, 2, 1.0).contains("scale: the factor: found 0 times"));
    }
}
