//! Boxes around what a view shows.

/// Lowest and highest corner of points; `None` without any.
pub fn of<'a>(points: impl Iterator<Item = &'a [f64; 3]>) -> Option<[[f64; 3]; 2]> {
    points.map(|point| [*point, *point]).reduce(around)
}

/// The box around two boxes.
pub fn around([low, high]: [[f64; 3]; 2], [other_low, other_high]: [[f64; 3]; 2]) -> [[f64; 3]; 2] {
    let of = |pick: fn(f64, f64) -> f64, a: [f64; 3], b: [f64; 3]| std::array::from_fn(|axis| pick(a[axis], b[axis]));
    [of(f64::min, low, other_low), of(f64::max, high, other_high)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_is_around_all_points() {
        assert_eq!(of([].iter()), None);
        let points = [[1.0, -2.0, 0.0], [0.0, 5.0, 0.0], [0.5, 0.0, 3.0]];
        assert_eq!(of(points.iter()), Some([[0.0, -2.0, 0.0], [1.0, 5.0, 3.0]]));
    }
}
