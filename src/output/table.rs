//! Plain-text tables for the terminal and the report.

/// Lines of the rows with aligned columns: the first to the left, the others to the right.
/// Rows may be of different lengths.
pub fn aligned(rows: &[Vec<String>]) -> String {
    let mut widths: Vec<usize> = Vec::new();
    for row in rows {
        for (column, cell) in row.iter().enumerate() {
            let width = cell.chars().count();
            match widths.get_mut(column) {
                Some(widest) => *widest = width.max(*widest),
                None => widths.push(width),
            }
        }
    }
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, &width)) in row.iter().zip(&widths).enumerate() {
            if column == 0 {
                line += &format!("{cell:<width$}");
            } else {
                line += &format!("  {cell:>width$}");
            }
        }
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// A count with its thousands apart: `1,234,567`.
pub fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A rate with three figures and a metric prefix, to stand before its unit: `12.3 M `.
pub(super) fn metric(value: f64) -> String {
    let (scaled, prefix) = match value.abs() {
        v if v >= 1e9 => (value / 1e9, " G "),
        v if v >= 1e6 => (value / 1e6, " M "),
        v if v >= 1e3 => (value / 1e3, " k "),
        _ => (value, " "),
    };
    let decimals = match scaled.abs() {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        _ => 2,
    };
    format!("{scaled:.decimals$}{prefix}")
}

/// A number with so many significant digits, very small and very large ones with an exponent.
pub fn figure(value: f64, digits: i32) -> String {
    let size = value.abs();
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-4..1e5).contains(&size) {
        let decimals = (digits - 1 - size.log10().floor() as i32).clamp(0, 6) as usize;
        format!("{value:.decimals$}")
    } else {
        format!("{value:.2e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_align_to_the_widest_cell_and_not_to_a_narrower_one() {
        let row = |cells: &[&str]| cells.iter().map(|&c| c.to_owned()).collect::<Vec<_>>();
        let text = aligned(&[row(&["a", "1"]), row(&["bbb", "1000", "x"]), row(&["c"])]);
        assert_eq!(text, "a       1\nbbb  1000  x\nc\n");
    }

    #[test]
    fn numbers_read_at_a_glance() {
        assert_eq!(grouped(0), "0");
        assert_eq!(grouped(999), "999");
        assert_eq!(grouped(1_234_567), "1,234,567");
        assert_eq!(metric(0.5), "0.50 ");
        assert_eq!(metric(12_345.0), "12.3 k ");
        assert_eq!(metric(4e9), "4.00 G ");
    }

    #[test]
    fn figures_have_the_digits_asked_for() {
        for (value, text) in
            [(0.0, "0"), (1.0, "1.000"), (0.00512, "0.005120"), (293.15, "293.1"), (-3.2e-7, "-3.20e-7")]
        {
            assert_eq!(figure(value, 4), text);
        }
        assert_eq!(figure(1.0, 3), "1.00");
    }
}
