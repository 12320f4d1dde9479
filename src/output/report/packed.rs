//! Numbers as a page holds them: base64 of little-endian arrays, which a browser takes without parsing digits.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// 7 digits of each.
pub fn floats(values: impl Iterator<Item = f64>) -> String {
    bytes(values.flat_map(|value| (value as f32).to_le_bytes()).collect())
}

pub fn shorts(values: impl Iterator<Item = u16>) -> String {
    bytes(values.flat_map(u16::to_le_bytes).collect())
}

pub fn words(values: impl Iterator<Item = u32>) -> String {
    bytes(values.flat_map(u32::to_le_bytes).collect())
}

pub fn bytes(values: Vec<u8>) -> String {
    STANDARD.encode(values)
}

/// The largest of the 16-bit steps that a range is cut into.
pub const STEPS: f64 = 65_535.0;

/// The nearest step of `value` in a range; ends beyond it.
pub fn step(value: f64, [low, high]: [f64; 2]) -> u16 {
    let width = high - low;
    let share = if width > 0.0 { (value - low) / width } else { 0.0 };
    // A NaN becomes 0.
    (STEPS * share.clamp(0.0, 1.0)).round() as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_little_endian() {
        assert_eq!(floats([1.0].into_iter()), "AACAPw==");
        assert_eq!(shorts([1, 256].into_iter()), "AQAAAQ==");
        assert_eq!(words([1].into_iter()), "AQAAAA==");
    }

    #[test]
    fn steps_span_the_range() {
        let range = [-1.0, 3.0];
        assert_eq!([step(-1.0, range), step(3.0, range), step(1.0, range)], [0, 65_535, 32_768]);
        assert_eq!(
            [step(-9.0, range), step(9.0, range), step(f64::NAN, range), step(1.0, [1.0, 1.0])],
            [0, 65_535, 0, 0]
        );
    }
}
