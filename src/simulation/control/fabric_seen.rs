//! What vents on fabric ask of where it is and of the hits on it: the area of their triangles, and the pressures on both sides of an open
//! sheet. The same on any number of ranks: nodes and the sums of hits are.

use glam::DVec3;

use super::window::Window;
use crate::simulation::model::build::Model;
use crate::subdomain::{Scales, Tallies};

/// m2 of some sets of triangles, whose nodes are at these places, m.
pub fn areas_of(triangles: &[[u32; 3]], sets: &[Vec<u32>], nodes: &[[f64; 3]]) -> Vec<f64> {
    let area = |&triangle: &u32| {
        let [a, b, c] = triangles[triangle as usize].map(|node| DVec3::from(nodes[node as usize]));
        0.5 * (b - a).cross(c - a).length()
    };
    sets.iter().map(|own| own.iter().map(area).sum()).collect()
}

/// Hits from which on those of an interval tell the pressure on a side alone: to a per cent or two.
const ENOUGH: f64 = 4096.0;

/// Pa on the sides of an open sheet, the one that its normals point to first, by the hits of an interval, and how much
/// that counts beside what was seen before; none before the first.
pub fn side_pressures(
    model: &Model,
    scales: &Scales,
    (tallies, sheet): (&Tallies, usize),
    window: &Window<'_>,
) -> Option<[[f64; 2]; 2]> {
    let duration = window.span[1] - window.span[0];
    let own: Vec<u32> = model.fabric.all[sheet].triangles.clone().map(|triangle| triangle as u32).collect();
    let area =
        areas_of(&model.fabric.triangles, &[own], if window.nodes.is_empty() { return None } else { window.nodes })[0];
    // The sides of fabric stand behind the patches of walls.
    let first = tallies.surfaces.len().checked_sub(2 * model.fabric.all.len())? + 2 * sheet;
    let unit = scales.reference_mass / scales.velocity;
    let side = |side: usize| {
        let sum = &tallies.surfaces[first + side];
        [sum.normal as f64 * unit / (area * duration), (sum.hits as f64 / ENOUGH).min(1.0)]
    };
    (duration > 0.0 && area > 0.0).then(|| [side(0), side(1)])
}
