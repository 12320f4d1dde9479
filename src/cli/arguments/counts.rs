//! Counts on the command line: whole numbers as people write them, 2000, 2_000 or 2e3.

use std::ops::RangeInclusive;

use crate::simulation::whole_number;

/// Reads a count within a range; the message says what else is wrong than its form.
pub fn count<N: TryFrom<u64>>(range: RangeInclusive<u64>) -> impl Fn(&str) -> Result<N, String> + Clone {
    move |text: &str| {
        let allowed = || match *range.end() {
            u64::MAX => format!("a whole number from {} on", range.start()),
            most => format!("a whole number from {} to {most}", range.start()),
        };
        let number =
            whole_number(text).ok_or_else(|| format!("{}, such as 2000, 2_000 or 2e3, is possible", allowed()))?;
        if !range.contains(&number) {
            return Err(format!("{} is possible", allowed()));
        }
        N::try_from(number).map_err(|_| format!("{} is possible", allowed()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_within_their_range() {
        let few = count::<u32>(1..=8);
        assert_eq!((few("8"), few("8e0")), (Ok(8), Ok(8)));
        assert_eq!(few("9").unwrap_err(), "a whole number from 1 to 8 is possible");
        assert_eq!(few("-3").unwrap_err(), "a whole number from 1 to 8, such as 2000, 2_000 or 2e3, is possible");
        assert!(count::<u64>(1..=u64::MAX)("0").unwrap_err().contains("from 1 on"));
    }
}
