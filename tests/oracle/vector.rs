//! Vectors of three f64.

pub type Vector = [f64; 3];

pub fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// a + b s.
pub fn along(a: Vector, b: Vector, s: f64) -> Vector {
    std::array::from_fn(|k| a[k] + b[k] * s)
}

pub fn minus(a: Vector, b: Vector) -> Vector {
    along(a, b, -1.0)
}

pub fn scaled(a: Vector, s: f64) -> Vector {
    a.map(|x| x * s)
}

pub fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

pub fn unit(a: Vector) -> Vector {
    scaled(a, 1.0 / norm(a))
}
