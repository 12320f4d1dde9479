//! Mutual choice (docs/explanation/method.md, "Collisions").

use super::collision::{Body, meeting};
use super::vector::Vector;

/// Pairs that may collide in a step: indices (lower id first) and the periodic image of the second.
pub type Candidates = Vec<(usize, usize, Vector)>;

/// The earliest meeting of each body: (time, partner's index, which candidate), ties by the partner's id.
pub fn choices(bodies: &[Body], candidates: &Candidates, diameter: f64, dt: f64) -> Vec<Option<(f64, usize, usize)>> {
    let mut best: Vec<Option<(f64, usize, usize)>> = vec![None; bodies.len()];
    for (k, &(i, j, image)) in candidates.iter().enumerate() {
        let Some(time) = meeting(&bodies[i], &bodies[j], image, diameter, dt) else { continue };
        for (own, other) in [(i, j), (j, i)] {
            let later = best[own].is_some_and(|(t, partner, _)| (t, bodies[partner].id) <= (time, bodies[other].id));
            if !later {
                best[own] = Some((time, other, k));
            }
        }
    }
    best
}

/// The pairs whose choices are mutual: (time, candidate), in the order of the first body.
pub fn mutual(choices: &[Option<(f64, usize, usize)>]) -> Vec<(f64, usize)> {
    let mut pairs = Vec::new();
    for (own, choice) in choices.iter().enumerate() {
        if let Some((time, other, candidate)) = *choice
            && own < other
            && choices[other].is_some_and(|(_, back, _)| back == own)
        {
            pairs.push((time, candidate));
        }
    }
    pairs
}
