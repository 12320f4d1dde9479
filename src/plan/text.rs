//! Numbers and tables as people read them.

pub(super) fn row_of(cells: [&str; 3]) -> Vec<String> {
    cells.map(String::from).to_vec()
}

/// Columns padded to their widest entry; a line per row, all of the same length.
pub(super) fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let widths: Vec<usize> =
        (0..columns).map(|c| rows.iter().map(|row| row[c].chars().count()).max().unwrap_or(0)).collect();
    let mut text = String::new();
    for row in rows {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    text
}

/// 1234567 as "1,234,567".
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Four significant digits, without trailing zeros.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let magnitude = libm::log10(value.abs()).floor() as i32;
    if !(-4..7).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let decimals = (3 - magnitude).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// Up to six digits, without trailing zeros.
pub fn as_written(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exact = format!("{value:.5e}").parse::<f64>().unwrap_or(value);
    if (1e-4..1e7).contains(&exact.abs()) { format!("{exact}") } else { format!("{exact:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        let found = [0.0, 0.12, 0.8571428, 12.3456, 123_456.0, 1e-9, f64::INFINITY].map(significant);
        assert_eq!(found, ["0", "0.12", "0.8571", "12.35", "123456", "1.000e-9", "inf"]);
    }

    #[test]
    fn columns_align() {
        assert_eq!(table(&[["a", "bb", "c"], ["aaa", "b", ""]].map(row_of)), "a    bb  c\naaa  b\n");
    }
}
