//! Regions of a scene (boxes, spheres, cylinders) and the gas in them.
//!
//! The gas volume of a region is its own volume times the gas-filled share of the length of 2^18 lines along x
//! through it (R2 sequence over the region's y-z rectangle, exact along each line). A region wholly in the gas
//! has a share of exactly one; of one that walls cut, the share errs by 1e-5 to 1e-4.

use super::Vessel;
use super::bag::Bag;
use super::sampling::{Line, r2, sum};
use super::vessel::VOLUME_LINES;
use crate::scene::{Chamber, Region};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;

/// Boundary included.
pub fn region_contains(region: &Region, p: [f64; 3]) -> bool {
    match region {
        Region::Box { min, max } => (0..3).all(|axis| min[axis] <= p[axis] && p[axis] <= max[axis]),
        Region::Sphere { center, radius } => DVec3::from(p).distance_squared(DVec3::from(*center)) <= radius * radius,
        Region::Cylinder { base, axis, radius, height } => {
            let (offset, axis) = (DVec3::from(p) - DVec3::from(*base), DVec3::from(*axis));
            let level = offset.dot(axis);
            (0.0..=*height).contains(&level) && (offset - axis * level).length_squared() <= radius * radius
        }
    }
}

/// m3, gas or not.
pub fn region_volume(region: &Region) -> f64 {
    match region {
        Region::Box { min, max } => (0..3).map(|axis| (max[axis] - min[axis]).max(0.0)).product(),
        Region::Sphere { radius, .. } => 4.0 / 3.0 * PI * radius * radius * radius,
        Region::Cylinder { radius, height, .. } => PI * radius * radius * height,
    }
}

/// Smallest and largest coordinates, m.
pub fn region_bounds(region: &Region) -> ([f64; 3], [f64; 3]) {
    match region {
        Region::Box { min, max } => (*min, *max),
        Region::Sphere { center, radius } => (center.map(|c| c - radius), center.map(|c| c + radius)),
        Region::Cylinder { base, axis, radius, height } => {
            let reach = axis.map(|a| radius * (1.0 - a * a).max(0.0).sqrt());
            let end = |k: usize| base[k] + axis[k] * height;
            (
                std::array::from_fn(|k| base[k].min(end(k)) - reach[k]),
                std::array::from_fn(|k| base[k].max(end(k)) + reach[k]),
            )
        }
    }
}

/// The x-interval of the region on the line through (y, z); regions are convex, so there is at most one.
fn interval(region: &Region, y: f64, z: f64) -> Option<(f64, f64)> {
    let (low, high) = match region {
        Region::Box { min, max } => {
            let within = min[1] <= y && y <= max[1] && min[2] <= z && z <= max[2];
            within.then_some((min[0], max[0]))?
        }
        Region::Sphere { center, radius } => {
            let rest = radius * radius - DVec2::new(y - center[1], z - center[2]).length_squared();
            (rest > 0.0).then(|| (center[0] - rest.sqrt(), center[0] + rest.sqrt()))?
        }
        Region::Cylinder { base, axis, radius, height } => {
            let axis = DVec3::from(*axis);
            // Of the point of the line level with the base.
            let offset = DVec3::new(0.0, y - base[1], z - base[2]);
            let caps = between(0.0, *height, offset.dot(axis), axis.x)?;
            // |(o + s x) - ((o + s x).a) a|^2 = r^2, quadratic in s.
            let (direction, start) = (DVec3::X - axis * axis.x, offset - axis * offset.dot(axis));
            let (a, half_b) = (direction.length_squared(), direction.dot(start));
            let c = start.length_squared() - radius * radius;
            let side = if a < 1e-14 {
                (c <= 0.0).then_some((f64::NEG_INFINITY, f64::INFINITY))?
            } else {
                let root = half_b * half_b - a * c;
                (root > 0.0).then(|| ((-half_b - root.sqrt()) / a, (-half_b + root.sqrt()) / a))?
            };
            (base[0] + caps.0.max(side.0), base[0] + caps.1.min(side.1))
        }
    };
    (high > low).then_some((low, high))
}

/// Where low <= start + s slope <= high.
fn between(low: f64, high: f64, start: f64, slope: f64) -> Option<(f64, f64)> {
    if slope.abs() < 1e-14 {
        return (low <= start && start <= high).then_some((f64::NEG_INFINITY, f64::INFINITY));
    }
    let (a, b) = ((low - start) / slope, (high - start) / slope);
    Some((a.min(b), a.max(b)))
}

impl Vessel {
    /// m3 of gas in a region; accuracy at the head of this module.
    pub fn gas_volume_in(&self, region: &Region) -> f64 {
        self.gas_volume_apart(region, &[])
    }

    /// m3 of gas of each chamber. Earlier chambers come first where regions overlap; a chamber without a
    /// region has what the earlier ones leave.
    pub fn chamber_volumes(&self, chambers: &[Chamber]) -> Vec<f64> {
        let mut volumes: Vec<f64> = Vec::with_capacity(chambers.len());
        let mut earlier: Vec<&Region> = Vec::new();
        for chamber in chambers {
            volumes.push(match &chamber.region {
                None if chamber.inside.is_some() => self.bag_of(chamber).map_or(0.0, |bag| self.gas_volume_inside(bag)),
                Some(region) => self.gas_volume_apart(region, &earlier),
                None => (self.gas_volume() - volumes.iter().sum::<f64>()).max(0.0),
            });
            earlier.extend(&chamber.region);
        }
        volumes
    }

    /// m3 of gas in closed fabric: exact where no solid is near, else summed along lines.
    pub fn gas_volume_inside(&self, bag: &Bag) -> f64 {
        let near = |wall: usize| {
            let (low, high) = self.extent_of(wall);
            low.cmple(bag.bounds.1.into()).all() && high.cmpge(bag.bounds.0.into()).all()
        };
        if !(0..self.walls.len()).any(|wall| !self.walls[wall].cavity && near(wall)) {
            return bag.volume;
        }
        let (low, high) = bag.bounds;
        let [gas, all] = sum(VOLUME_LINES, |i, line| {
            let [u, v] = r2(i);
            let (y, z) = (low[1] + u * (high[1] - low[1]), low[2] + v * (high[2] - low[2]));
            bag.within(y, z).into_iter().fold([0.0; 2], |[gas, all], part| {
                [gas + self.gas_length([y, z], part, &[], line), all + (part.1 - part.0)]
            })
        });
        if all > 0.0 { bag.volume * gas / all } else { 0.0 }
    }

    /// The closed fabric that a chamber is the inside of.
    pub fn bag_of(&self, chamber: &Chamber) -> Option<&Bag> {
        self.bags.get(chamber.inside?)?.as_ref()
    }

    /// Whether a point of the gas is of a chamber, if of no earlier one.
    pub fn is_of(&self, chamber: &Chamber, point: [f64; 3]) -> bool {
        match &chamber.region {
            Some(region) => region_contains(region, point),
            None if chamber.inside.is_some() => self.bag_of(chamber).is_some_and(|bag| bag.contains(point)),
            None => true,
        }
    }

    /// Gas in `region` and in none of `others`.
    fn gas_volume_apart(&self, region: &Region, others: &[&Region]) -> f64 {
        let (low, high) = region_bounds(region);
        let (from, to) = self.bounds;
        // A box stays a box when cut to the vessel; another shape loses its closed volume.
        let clipped = match region {
            Region::Box { .. } => Region::Box {
                min: std::array::from_fn(|k| low[k].max(from[k])),
                max: std::array::from_fn(|k| high[k].min(to[k])),
            },
            other => other.clone(),
        };
        let whole = matches!(clipped, Region::Box { .. }) || (1..3).all(|k| low[k] >= from[k] && high[k] <= to[k]);
        let min: [f64; 2] = std::array::from_fn(|k| low[k + 1].max(from[k + 1]));
        let size: [f64; 2] = std::array::from_fn(|k| (high[k + 1].min(to[k + 1]) - min[k]).max(0.0));
        let [gas, all] = sum(VOLUME_LINES, |i, line| {
            let [u, v] = r2(i);
            let (y, z) = (min[0] + u * size[0], min[1] + v * size[1]);
            match interval(&clipped, y, z) {
                Some(part) => [self.gas_length([y, z], part, others, line), part.1 - part.0],
                None => [0.0; 2],
            }
        });
        if all <= 0.0 || gas <= 0.0 {
            return 0.0;
        }
        if whole { region_volume(&clipped) * (gas / all) } else { size[0] * size[1] * gas / VOLUME_LINES as f64 }
    }

    /// Length of gas along a line within `part`, outside `others`.
    fn gas_length(&self, [y, z]: [f64; 2], part: (f64, f64), others: &[&Region], line: &mut Line) -> f64 {
        self.gas_along(y, z, line);
        let Line { gas, spare, .. } = line;
        for other in others {
            if let Some((low, high)) = interval(other, y, z) {
                spare.clear();
                spare.extend(gas.iter().flat_map(|&(a, b)| [(a, b.min(low)), (a.max(high), b)]).filter(|(a, b)| b > a));
                std::mem::swap(gas, spare);
            }
        }
        gas.iter().map(|&(a, b)| (b.min(part.1) - a.max(part.0)).max(0.0)).sum()
    }
}
