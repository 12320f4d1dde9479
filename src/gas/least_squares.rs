//! Least squares with weights that may not be negative (Lawson and Hanson 1974, "Solving Least Squares Problems",
//! chapter 23), for small systems.

/// A residual, or a gain by one more column, this small beside b is none.
const SMALL: f64 = 1e-9;
const SMALLEST_GRADIENT: f64 = 1e-11;

/// x >= 0 that makes |A x - b| least; `columns` are those of A.
pub fn non_negative(columns: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    // Columns of unit length: weights of high powers are far from those of low ones.
    let lengths: Vec<f64> = columns.iter().map(|column| dot(column, column).sqrt()).collect();
    let unit: Vec<Vec<f64>> = columns
        .iter()
        .zip(&lengths)
        .map(|(column, length)| column.iter().map(|value| if *length > 0.0 { value / length } else { 0.0 }).collect())
        .collect();
    let size = dot(right, right).sqrt();
    let mut x = vec![0.0; unit.len()];
    let mut passive: Vec<usize> = Vec::new();
    // Each turn lets one column in; a few leave again.
    for _ in 0..3 * unit.len() {
        let residual = residual(&unit, &x, right);
        if dot(&residual, &residual).sqrt() <= SMALL * size {
            break;
        }
        let candidates = (0..unit.len()).filter(|column| !passive.contains(column) && lengths[*column] > 0.0);
        let gradients = candidates.map(|column| (column, dot(&unit[column], &residual)));
        let Some((entering, gradient)) = gradients.max_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        if gradient <= SMALLEST_GRADIENT * size {
            break;
        }
        passive.push(entering);
        loop {
            let solution = solve(&unit, &passive, right);
            if solution.iter().all(|value| *value > 0.0) {
                x.fill(0.0);
                for (&column, value) in passive.iter().zip(solution) {
                    x[column] = value;
                }
                break;
            }
            // As far towards it as no weight turns negative; those that become zero leave.
            let steps = passive.iter().zip(&solution).filter(|(_, value)| **value <= 0.0);
            let steps = steps.map(|(&column, value)| x[column] / (x[column] - value));
            let step = steps.fold(1.0, f64::min).max(0.0);
            for (&column, value) in passive.iter().zip(&solution) {
                x[column] += step * (value - x[column]);
            }
            let before = passive.len();
            passive.retain(|&column| x[column] > 1e-14);
            if passive.len() == before || passive.is_empty() {
                // Rounding: the last to enter has nothing to give.
                passive.retain(|&column| column != entering);
                break;
            }
        }
        if !passive.contains(&entering) {
            x[entering] = 0.0;
            break;
        }
    }
    x.iter().zip(lengths).map(|(value, length)| if length > 0.0 { value / length } else { 0.0 }).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn residual(columns: &[Vec<f64>], x: &[f64], right: &[f64]) -> Vec<f64> {
    let mut left = right.to_vec();
    for (column, weight) in columns.iter().zip(x).filter(|(_, weight)| **weight != 0.0) {
        for (value, own) in left.iter_mut().zip(column) {
            *value -= weight * own;
        }
    }
    left
}

/// The least squares of some of the columns, by Gram and Schmidt, twice over for the digits.
fn solve(columns: &[Vec<f64>], chosen: &[usize], right: &[f64]) -> Vec<f64> {
    let mut basis: Vec<Vec<f64>> = Vec::with_capacity(chosen.len());
    let mut triangle = vec![vec![0.0; chosen.len()]; chosen.len()];
    for (index, &column) in chosen.iter().enumerate() {
        let mut own = columns[column].clone();
        for _ in 0..2 {
            for (row, direction) in basis.iter().enumerate() {
                let part = dot(direction, &own);
                triangle[row][index] += part;
                for (value, along) in own.iter_mut().zip(direction) {
                    *value -= part * along;
                }
            }
        }
        let length = dot(&own, &own).sqrt();
        triangle[index][index] = length;
        basis.push(own.iter().map(|value| if length > 0.0 { value / length } else { 0.0 }).collect());
    }
    let mut solution = vec![0.0; chosen.len()];
    for row in (0..chosen.len()).rev() {
        let known: f64 = (row + 1..chosen.len()).map(|column| triangle[row][column] * solution[column]).sum();
        let pivot = triangle[row][row];
        // A column that adds no direction of its own gets no weight.
        solution[row] = if pivot > 1e-13 { (dot(&basis[row], right) - known) / pivot } else { 0.0 };
    }
    solution
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_without_negative_weights_is_found() {
        let columns = [vec![1.0, 2.0, 3.0, 4.0], vec![1.0, 0.0, -1.0, 0.5], vec![0.0, 1.0, 0.0, 2.0]];
        let expected = [0.5, 2.0, 0.25];
        let right: Vec<f64> = (0..4).map(|row| (0..3).map(|k| expected[k] * columns[k][row]).sum()).collect();
        for (found, expected) in non_negative(&columns, &right).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12);
        }
    }

    /// Where the free solution has a negative weight, the conditions of Karush, Kuhn and Tucker hold.
    #[test]
    fn a_weight_that_would_be_negative_is_zero_and_the_rest_are_optimal() {
        let columns = [vec![1.0, 1.0, 1.0], vec![0.0, 1.0, 2.0]];
        let right = [3.0, 2.0, 0.0];
        let x = non_negative(&columns, &right);
        assert_eq!(x[1], 0.0);
        assert!((x[0] - 5.0 / 3.0).abs() < 1e-12);
        let gradient = dot(&columns[1], &residual(&columns, &x, &right));
        assert!(gradient < 0.0);
        // The check can fail: turned round, the same column is wanted.
        assert!(non_negative(&columns, &[0.0, 2.0, 3.0])[1] > 0.1);
    }
}
