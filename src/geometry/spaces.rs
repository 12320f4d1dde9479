//! Spaces of gas that no gas flows between, also where walls overlap: found on a lattice of lines along x.
//!
//! Gas on neighbouring lines is one space where it overlaps in x on all of the finer lines between them. So a body that is thinner than
//! the finer lines are apart may be missed, and a passage that is narrower than the lattice: who asks knows both lengths.

use super::Vessel;
use super::sampling::Line;

/// Lines along each side.
const LINES: usize = 48;
/// Finer lines from one to the next.
const FINER: std::ops::RangeInclusive<f64> = 2.0..=32.0;

/// Low and high end of gas on a line, m.
type Interval = (f64, f64);

pub struct Spaces {
    low: [f64; 2],
    /// From line to line, m.
    step: [f64; 2],
    /// Of each line its gas, with the space that it is of.
    lines: Vec<Vec<(Interval, usize)>>,
    /// m3 of each space.
    pub volumes: Vec<f64>,
}

/// What has been found to be one.
#[derive(Default)]
struct Joined(Vec<u32>);

impl Joined {
    fn add(&mut self) -> u32 {
        self.0.push(self.0.len() as u32);
        self.0.len() as u32 - 1
    }

    fn root(&mut self, of: u32) -> u32 {
        let mut at = of;
        while self.0[at as usize] != at {
            self.0[at as usize] = self.0[self.0[at as usize] as usize];
            at = self.0[at as usize];
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

impl Vessel {
    /// Within a box; `thinnest` of its bodies, m.
    pub fn spaces(&self, (low, high): ([f64; 3], [f64; 3]), thinnest: f64) -> Spaces {
        let step = [1, 2].map(|axis| (high[axis] - low[axis]) / LINES as f64);
        let low = [low[1], low[2]];
        let finer = (2.0 * step[0].max(step[1]) / thinnest).ceil().clamp(*FINER.start(), *FINER.end()) as usize;
        let mut joined = Joined::default();
        let mut room = Line::default();
        // At a place of the lattice, in lines of it.
        let mut gas = |place: [f64; 2], joined: &mut Joined| -> Vec<(Interval, u32)> {
            let at = |k: usize| low[k] + (place[k] + 0.5) * step[k];
            self.gas_along(at(0), at(1), &mut room);
            room.gas.iter().map(|&interval| (interval, joined.add())).collect()
        };
        let place = |line: usize| [(line % LINES) as f64, (line / LINES) as f64];
        let lines: Vec<Vec<(Interval, u32)>> = (0..LINES * LINES).map(|line| gas(place(line), &mut joined)).collect();
        for (line, own) in lines.iter().enumerate() {
            let neighbours = [(0, line + 1, line % LINES + 1 < LINES), (1, line + LINES, line + LINES < lines.len())];
            for (axis, next, _) in neighbours.into_iter().filter(|neighbour| neighbour.2) {
                let mut last = own.clone();
                for k in 1..finer {
                    let mut between = place(line);
                    between[axis] += k as f64 / finer as f64;
                    let between = gas(between, &mut joined);
                    join_overlapping(&mut joined, &last, &between);
                    last = between;
                }
                join_overlapping(&mut joined, &last, &lines[next]);
            }
        }
        let mut spaces = Spaces { low, step, lines: Vec::new(), volumes: Vec::new() };
        let mut numbers = std::collections::HashMap::new();
        for own in &lines {
            let mut numbered = Vec::with_capacity(own.len());
            for &(interval, id) in own {
                let count = spaces.volumes.len();
                let space = *numbers.entry(joined.root(id)).or_insert(count);
                if space == count {
                    spaces.volumes.push(0.0);
                }
                spaces.volumes[space] += (interval.1 - interval.0) * step[0] * step[1];
                numbered.push((interval, space));
            }
            spaces.lines.push(numbered);
        }
        spaces
    }
}

/// Those that overlap in x, on two lines that are next to each other.
fn join_overlapping(joined: &mut Joined, a: &[(Interval, u32)], b: &[(Interval, u32)]) {
    for &((from, to), one) in a {
        for &(_, other) in b.iter().filter(|((low, high), _)| *low < to && from < *high) {
            joined.join(one, other);
        }
    }
}

impl Spaces {
    /// From line to line, m: narrower passages may be missed.
    pub fn spacing(&self) -> f64 {
        self.step[0].max(self.step[1])
    }

    /// The space of a place, by the line that is nearest to it.
    pub fn at(&self, place: [f64; 3]) -> Option<usize> {
        let along = |k: usize| {
            let line = ((place[k + 1] - self.low[k]) / self.step[k]).floor();
            (0.0..LINES as f64).contains(&line).then_some(line as usize)
        };
        let own = &self.lines[along(1)? * LINES + along(0)?];
        own.iter().find(|((from, to), _)| (*from..=*to).contains(&place[0])).map(|(_, space)| *space)
    }

    /// Two that are known to be one.
    pub fn join(&mut self, a: usize, b: usize) {
        if a == b {
            return;
        }
        let (kept, gone) = (a.min(b), a.max(b));
        self.volumes[kept] += std::mem::take(&mut self.volumes[gone]);
        self.lines.iter_mut().flatten().filter(|(_, space)| *space == gone).for_each(|(_, space)| *space = kept);
    }

    /// Middles of the gas on its lines with the volume, m3, that each stands for, and its space.
    pub fn middles(&self) -> impl Iterator<Item = ([f64; 3], f64, usize)> {
        let area = self.step[0] * self.step[1];
        self.lines.iter().enumerate().flat_map(move |(line, own)| {
            let at = |k: usize, line: usize| self.low[k] + (line as f64 + 0.5) * self.step[k];
            let [y, z] = [at(0, line % LINES), at(1, line / LINES)];
            own.iter().map(move |&((from, to), space)| ([0.5 * (from + to), y, z], (to - from) * area, space))
        })
    }

    /// What of the gas on the lines is also gas of others, of the same lattice.
    pub fn keep_common(&mut self, others: &Spaces) {
        for (own, other) in self.lines.iter_mut().zip(&others.lines) {
            let common = |&((from, to), space): &(Interval, usize)| {
                let cut = other.iter().map(move |&((low, high), _)| ((from.max(low), to.min(high)), space));
                cut.filter(|((from, to), _)| from < to).collect::<Vec<_>>()
            };
            *own = own.iter().flat_map(common).collect();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{hollow_box, sphere, tank, wall};
    use super::*;
    use crate::scene::{GasSide, Shape, Wall};

    /// A body across the middle of a box of 1 m, of so many m across.
    fn plate(axis: usize, from: f64, size: f64, thickness: f64) -> Wall {
        let (mut min, mut max) = ([0.5 - 0.5 * size; 3], [0.5 + 0.5 * size; 3]);
        (min[axis], max[axis]) = (from, from + thickness);
        wall("plate", Shape::Box { min, max, thickness: None, holes: vec![] }, GasSide::Outside)
    }

    fn spaces(walls: &[Wall], thinnest: f64) -> Vec<f64> {
        let vessel = Vessel::build(walls).unwrap();
        let mut volumes = vessel.spaces(vessel.bounds, thinnest).volumes;
        volumes.sort_by(f64::total_cmp);
        volumes
    }

    /// A plate that is let into the walls parts the gas; one that leaves a gap does not, nor one with a hole.
    #[test]
    fn what_parts_the_gas_is_seen_from_its_lines() {
        let close = |found: &[f64], expected: &[f64]| {
            found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.1 * b)
        };
        for axis in 0..3 {
            let parted = [tank([1.0; 3]), plate(axis, 0.3, 1.1, 0.01)];
            let found = spaces(&parted, 0.01);
            assert!(close(&found, &[0.295, 0.695]), "{axis} {found:?}");
            let open = [tank([1.0; 3]), plate(axis, 0.3, 0.9, 0.01)];
            assert_eq!(spaces(&open, 0.01).len(), 1, "{axis}");
        }
        let ball = [tank([1.0; 3]), sphere("ball", [0.5; 3], 0.2, 2, GasSide::Outside)];
        assert_eq!(spaces(&ball, 0.4).len(), 1);
        let shell = [tank([1.0; 3]), hollow_box([0.4; 3], [0.6; 3], 0.01)];
        assert!(close(&spaces(&shell, 0.01), &[0.008, 1.0 - 0.22f64.powi(3)]), "{:?}", spaces(&shell, 0.01));
    }

    /// What is gas at both of two moments; places are found in their spaces.
    #[test]
    fn common_gas_and_places() {
        let of = |walls: &[Wall]| {
            let vessel = Vessel::build(walls).unwrap();
            vessel.spaces(([0.0; 3], [1.0; 3]), 0.01)
        };
        let mut first = of(&[tank([1.0; 3]), plate(0, 0.3, 1.1, 0.01)]);
        let sides = [[0.1, 0.5, 0.5], [0.7, 0.5, 0.5]].map(|place| first.at(place));
        assert!(sides[0].is_some() && sides[1].is_some() && sides[0] != sides[1], "{sides:?}");
        assert_eq!(first.at([0.305, 0.5, 0.5]), None);
        first.keep_common(&of(&[tank([1.0; 3]), plate(0, 0.5, 1.1, 0.2)]));
        let volume: f64 = first.middles().map(|(_, volume, _)| volume).sum();
        assert!((volume - 0.79).abs() < 0.01, "{volume}");
    }
}
