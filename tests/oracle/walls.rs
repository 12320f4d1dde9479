//! Straight flights among triangles, in f64.

use super::vector::{Vector, along, cross, dot, minus, norm, scaled, unit};

/// Corners counter-clockwise seen from the gas.
pub type Triangle = [Vector; 3];

pub fn normal(t: &Triangle) -> Vector {
    unit(cross(minus(t[1], t[0]), minus(t[2], t[0])))
}

/// How far inside its edges a point of a triangle's plane is, m; negative outside.
pub fn inset(t: &Triangle, p: Vector) -> f64 {
    let n = normal(t);
    (0..3)
        .map(|k| {
            let edge = minus(t[(k + 1) % 3], t[k]);
            dot(cross(edge, minus(p, t[k])), n) / norm(edge)
        })
        .fold(f64::INFINITY, f64::min)
}

/// A crossing of the plane of a triangle.
#[derive(Debug, Clone, Copy)]
pub struct Crossing {
    pub triangle: usize,
    pub time: f64,
    /// How near the flight's line passes the edges, m, negative outside: the [`inset`] of the point of crossing
    /// times the sine of the angle between flight and plane.
    pub inset: f64,
    /// Speed against the normal.
    pub approach: f64,
}

/// All planes that the flight x + v t, t from 0, meets from their gas side, behind them by less than `behind`.
pub fn crossings(triangles: &[Triangle], x: Vector, v: Vector, behind: f64) -> Vec<Crossing> {
    let mut found = Vec::new();
    for (triangle, t) in triangles.iter().enumerate() {
        let n = normal(t);
        let approach = -dot(v, n);
        let distance = dot(minus(x, t[0]), n);
        if approach > 0.0 && distance >= -behind {
            let time = distance / approach;
            let sine = approach / norm(v);
            found.push(Crossing { triangle, time, inset: inset(t, along(x, v, time)) * sine, approach });
        }
    }
    found
}

/// Whether the segment p-q crosses a triangle, from either side: `Some` if it surely does or does not,
/// `None` if an end is within `slack` of a plane that it may cross, or its line within `slack` of an edge.
pub fn parted(triangles: &[Triangle], p: Vector, q: Vector, slack: f64) -> Option<bool> {
    let mut unsure = false;
    for t in triangles {
        let n = normal(t);
        let (before, after) = (dot(minus(p, t[0]), n), dot(minus(q, t[0]), n));
        if before.abs() < slack || after.abs() < slack {
            unsure |= inset(t, along(p, n, -before)) > -2.0 * norm(minus(q, p)) - slack;
            continue;
        }
        if (before > 0.0) == (after > 0.0) {
            continue;
        }
        let sine = (before - after).abs() / norm(minus(q, p));
        let at = inset(t, along(p, minus(q, p), before / (before - after))) * sine;
        if at > slack {
            return Some(true);
        }
        unsure |= at > -slack;
    }
    if unsure { None } else { Some(false) }
}

/// Solid angle of a triangle seen from a point over 4 pi (Van Oosterom and Strackee 1983). Its sum over walls
/// whose normals point into the gas is -1 in the gas and 0 elsewhere.
pub fn winding(triangles: &[Triangle], p: Vector) -> f64 {
    let total: f64 = triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|corner| minus(corner, p));
            let (la, lb, lc) = (norm(a), norm(b), norm(c));
            let volume = dot(a, cross(b, c));
            let rest = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
            2.0 * volume.atan2(rest)
        })
        .sum();
    total / (4.0 * std::f64::consts::PI)
}

/// Distance of a point from a triangle (Ericson 2005, by clamping to edges).
pub fn distance(t: &Triangle, p: Vector) -> f64 {
    let n = normal(t);
    let height = dot(minus(p, t[0]), n);
    if inset(t, along(p, n, -height)) >= 0.0 {
        return height.abs();
    }
    (0..3)
        .map(|k| {
            let edge = minus(t[(k + 1) % 3], t[k]);
            let share = (dot(minus(p, t[k]), edge) / dot(edge, edge)).clamp(0.0, 1.0);
            norm(minus(p, along(t[k], edge, share)))
        })
        .fold(f64::INFINITY, f64::min)
}

/// A point that is outside the gas by more than `slack`.
pub fn lost(triangles: &[Triangle], p: Vector, slack: f64) -> bool {
    (winding(triangles, p) + 1.0).abs() > 0.5 && triangles.iter().all(|t| distance(t, p) > slack)
}

/// v reflected off a plane.
pub fn reflected(v: Vector, n: Vector) -> Vector {
    along(v, n, -2.0 * dot(v, n))
}

/// Where a specular flight in the box `low`..`high` ends, with its velocity and the number of hits: each axis
/// by itself is a triangle wave.
pub fn reflect_in_box(x: Vector, v: Vector, time: f64, low: Vector, high: Vector) -> (Vector, Vector, u32) {
    let mut hits = 0;
    let (mut place, mut velocity) = (x, v);
    for k in 0..3 {
        let size = high[k] - low[k];
        let flown = (x[k] + v[k] * time - low[k]) / size;
        let image = flown.floor();
        hits += image.abs() as u32;
        let odd = image.rem_euclid(2.0) == 1.0;
        let rest = flown - image;
        place[k] = low[k] + size * if odd { 1.0 - rest } else { rest };
        velocity[k] = if odd { -v[k] } else { v[k] };
    }
    (place, velocity, hits)
}

/// A flight of up to `time` off every triangle on its way: place, velocity, and which triangles it hit; `None`
/// if it comes within `slack` of an edge.
pub fn bounced(
    triangles: &[Triangle],
    x: Vector,
    v: Vector,
    time: f64,
    slack: f64,
) -> Option<(Vector, Vector, Vec<usize>)> {
    let (mut place, mut velocity, mut left, mut hits) = (x, v, time, Vec::new());
    let mut last = usize::MAX;
    loop {
        let mut ahead = crossings(triangles, place, velocity, slack);
        ahead.retain(|c| c.triangle != last && c.time < left && c.inset > -slack);
        let Some(hit) = ahead.iter().min_by(|a, b| a.time.total_cmp(&b.time)).copied() else {
            return Some((along(place, velocity, left), velocity, hits));
        };
        if hit.inset < slack
            || ahead.iter().any(|c| c.triangle != hit.triangle && (c.time - hit.time) * norm(velocity) < slack)
        {
            return None;
        }
        place = along(place, velocity, hit.time);
        velocity = reflected(velocity, normal(&triangles[hit.triangle]));
        left -= hit.time;
        last = hit.triangle;
        hits.push(hit.triangle);
    }
}

/// Corners of an axis-aligned box as scaled unit corners, for aiming at.
pub fn corner(low: Vector, high: Vector, which: usize) -> Vector {
    std::array::from_fn(|k| if which >> k & 1 == 1 { high[k] } else { low[k] })
}

/// The point at barycentric weights `w` (not normalised) of a triangle.
pub fn point_on(t: &Triangle, w: Vector) -> Vector {
    let sum = w[0] + w[1] + w[2];
    scaled(along(along(scaled(t[0], w[0]), t[1], w[1]), t[2], w[2]), 1.0 / sum)
}
