//! The Pareto front: what nothing else beats in cost and error at once.

/// The indices of the points (cost, error) that no other point beats, by rising cost: another point beats one if it has
/// neither more cost nor more error, and less of one of them. A point whose cost or error is no number beats none and is
/// not on the front. Of equal points all are.
pub fn front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&index| points[index].iter().all(|value| value.is_finite())).collect();
    order.sort_by(|&a, &b| {
        let ([cost_a, error_a], [cost_b, error_b]) = (points[a], points[b]);
        cost_a.total_cmp(&cost_b).then(error_a.total_cmp(&error_b)).then(a.cmp(&b))
    });
    let mut on: Vec<usize> = Vec::new();
    for index in order {
        let beaten =
            on.last().is_some_and(|&last| points[last][1] <= points[index][1] && points[last] != points[index]);
        if !beaten {
            on.push(index);
        }
    }
    on
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_point_that_another_beats_is_not_on_the_front() {
        let points = [[1.0, 5.0], [2.0, 3.0], [2.0, 4.0], [3.0, 3.0], [0.5, 9.0], [4.0, 1.0], [f64::NAN, 0.0]];
        assert_eq!(front(&points), [4, 0, 1, 5]);
        assert_eq!(front(&[[1.0, 1.0], [1.0, 1.0], [1.0, f64::INFINITY]]), [0, 1]);
        assert!(front(&[]).is_empty());
    }

    /// -0 and 0 are one number, however they are sorted.
    #[test]
    fn the_sign_of_zero_beats_nothing() {
        assert_eq!(front(&[[0.0, 1.0], [-0.0, 1.0]]).len(), 2);
    }

    fn beats(a: [f64; 2], b: [f64; 2]) -> bool {
        a[0] <= b[0] && a[1] <= b[1] && a != b
    }

    proptest! {
        /// Few values, so that ties are common.
        #[test]
        fn the_front_is_what_nothing_beats(points in prop::collection::vec(prop::array::uniform2(0u8..12), 0..40)) {
            let points: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::from)).collect();
            let found = front(&points);
            let mut sorted = found.clone();
            sorted.sort_unstable();
            let expected: Vec<usize> = (0..points.len())
                .filter(|&index| !points.iter().any(|&other| beats(other, points[index])))
                .collect();
            prop_assert_eq!(sorted, expected);
            let steps = found.windows(2).map(|pair| [points[pair[0]], points[pair[1]]]);
            for [a, b] in steps {
                prop_assert!(a == b || (a[0] < b[0] && a[1] > b[1]));
            }
        }

        /// Whatever the order of the points, the same are on it.
        #[test]
        fn the_order_of_the_points_does_not_matter(
            points in prop::collection::vec(prop::array::uniform2(0u8..9), 1..30),
            turn in 0usize..30,
        ) {
            let points: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::from)).collect();
            let mut turned = points.clone();
            turned.rotate_left(turn % points.len());
            let values = |all: &[[f64; 2]]| front(all).into_iter().map(|index| all[index]).collect::<Vec<_>>();
            prop_assert_eq!(values(&points), values(&turned));
        }
    }
}
