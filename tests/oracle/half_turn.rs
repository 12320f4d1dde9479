//! Collision cells and the half-turn of their particles, in f64 (docs/explanation/method.md).

use crate::oracle::vector::{Vector, dot, minus, norm};

/// A particle: mass, place, velocity.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    pub mass: f64,
    pub place: Vector,
    pub velocity: Vector,
}

/// What the half-turn makes of the velocities of particles without spin, and how clearly: how much the largest and the smallest stress differ from the
/// middle one, over their sum, or how far the heat flux is from right angles with their axes (its cosine), whichever is least.
pub fn turned(bodies: &[Body]) -> (Vec<Vector>, f64) {
    let mass: f64 = bodies.iter().map(|body| body.mass).sum();
    let mean = |of: fn(&Body) -> Vector| -> Vector {
        std::array::from_fn(|k| bodies.iter().map(|body| body.mass * of(body)[k]).sum::<f64>() / mass)
    };
    let (middle, flow) = (mean(|body| body.place), mean(|body| body.velocity));
    let product = |of: &dyn Fn(&Body) -> [Vector; 2]| -> [Vector; 3] {
        std::array::from_fn(|i| {
            std::array::from_fn(|j| bodies.iter().map(|body| body.mass * of(body)[0][i] * of(body)[1][j]).sum::<f64>())
        })
    };
    let places = product(&|body| [minus(body.place, middle); 2]);
    let slopes = product(&|body| [minus(body.velocity, flow), minus(body.place, middle)]);
    let third = (0..3).map(|k| places[k][k]).sum::<f64>() / 3.0;
    let fitted = bodies.len() >= 6 && determinant(&places) > 1e-4 * third.powi(3);
    // G S = B, S symmetric: each row of G solves S g = b.
    let gradient = if fitted { slopes.map(|row| solve(&places, row)) } else { [[0.0; 3]; 3] };
    let swept = |body: &Body| -> Vector {
        let away = minus(body.place, middle);
        std::array::from_fn(|k| flow[k] + dot(gradient[k], away))
    };
    let rest: Vec<Vector> = bodies.iter().map(|body| minus(body.velocity, swept(body))).collect();
    let mut stress = [[0.0; 3]; 3];
    let mut flux = [0.0; 3];
    for (body, c) in bodies.iter().zip(&rest) {
        for i in 0..3 {
            flux[i] += body.mass * dot(*c, *c) * c[i];
            for j in 0..3 {
                stress[i][j] += body.mass * c[i] * c[j];
            }
        }
    }
    let (values, axes) = principal(stress);
    let sign = if dot(flux, axes[0]) * dot(flux, axes[2]) >= 0.0 { 1.0 } else { -1.0 };
    let axis: Vector = std::array::from_fn(|k| (axes[0][k] - sign * axes[2][k]) / 2f64.sqrt());
    let after = bodies.iter().zip(&rest).map(|(body, c)| {
        let along = dot(axis, *c);
        let base = swept(body);
        std::array::from_fn(|k| base[k] + 2.0 * along * axis[k] - c[k])
    });
    let sum: f64 = values.iter().sum();
    let cosine = |axis: Vector| dot(flux, axis).abs() / norm(flux);
    let apart = (values[0] - values[1]).min(values[1] - values[2]) / sum;
    (after.collect(), apart.min(cosine(axes[0])).min(cosine(axes[2])))
}

fn determinant(m: &[Vector; 3]) -> f64 {
    let cofactor = |i: usize, j: usize| m[1][i] * m[2][j] - m[1][j] * m[2][i];
    m[0][0] * cofactor(1, 2) - m[0][1] * cofactor(0, 2) + m[0][2] * cofactor(0, 1)
}

/// Cramer's rule.
fn solve(m: &[Vector; 3], b: Vector) -> Vector {
    let whole = determinant(m);
    std::array::from_fn(|column| {
        let mut replaced = *m;
        (0..3).for_each(|row| replaced[row][column] = b[row]);
        determinant(&replaced) / whole
    })
}

/// Eigenvalues, the largest first, and unit eigenvectors of a symmetric matrix: of (m - shift)^k what is left of a vector is its largest axis.
fn principal(m: [Vector; 3]) -> (Vector, [Vector; 3]) {
    let times = |m: &[Vector; 3], v: Vector| -> Vector { std::array::from_fn(|k| dot(m[k], v)) };
    let unit = |v: Vector| -> Vector { v.map(|x| x / norm(v)) };
    let trace = m[0][0] + m[1][1] + m[2][2];
    let power = |m: &[Vector; 3]| {
        let mut v = unit([0.5, 0.7, 0.9]);
        for _ in 0..4000 {
            v = unit(times(m, v));
        }
        v
    };
    let first = power(&m);
    // The smallest of m is the largest of trace - m.
    let turned: [Vector; 3] =
        std::array::from_fn(|i| std::array::from_fn(|j| if i == j { trace } else { 0.0 } - m[i][j]));
    let last = power(&turned);
    let second = [
        first[1] * last[2] - first[2] * last[1],
        first[2] * last[0] - first[0] * last[2],
        first[0] * last[1] - first[1] * last[0],
    ];
    let value = |v: Vector| dot(v, times(&m, v));
    ([value(first), value(second), value(last)], [first, second, last])
}

/// The bin of a cell, counted from the first of the box, in tiles of 4^3 cells, so many along each axis; `turn`: which axis is halved last.
pub fn tiled_bin(cell: [u32; 3], tiles: [u32; 3], turn: usize) -> usize {
    let tile = cell.map(|at| at / 4);
    let before = ((tile[2] * tiles[1] + tile[1]) * tiles[0] + tile[0]) as usize;
    let mut place = 0;
    // From the first halving to the last: halves of the tile along the third axis, the second, the first, then quarters.
    for half in [2, 1] {
        for axis in [2, 1, 0] {
            place = 2 * place + (cell[(axis + turn) % 3] % 4 / half % 2) as usize;
        }
    }
    64 * before + place
}

/// The collision cells of a tile with so many particles in each bin: first bin and number of bins of each.
pub fn collision_cells(counts: &[u32], most: u32) -> Vec<(usize, usize)> {
    if counts.len() == 1 || counts.iter().sum::<u32>() <= most {
        return vec![(0, counts.len())];
    }
    let half = counts.len() / 2;
    let mut cells = collision_cells(&counts[..half], most);
    cells.extend(collision_cells(&counts[half..], most).iter().map(|&(first, bins)| (half + first, bins)));
    cells
}
