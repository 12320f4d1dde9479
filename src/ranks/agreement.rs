//! Whether all ranks were started with the same facts: version, scene, adapter, driver.

use super::{Communicator, RankError};

/// Values longer than this are shortened in messages, characters.
const LONGEST_VALUE: usize = 80;

/// Collective: every rank's value of each named fact must equal rank 0's, and the names and their order too.
/// Else every rank gets the same error, about the first fact and the first rank that differ.
pub fn agree(comm: &dyn Communicator, facts: &[(&str, String)]) -> Result<(), RankError> {
    let all = comm.all_gather(serde_json::to_vec(facts).map_err(|_| RankError::Garbled { rank: comm.rank() })?)?;
    let read = |rank: usize| -> Result<Vec<(String, String)>, RankError> {
        serde_json::from_slice(&all[rank]).map_err(|_| RankError::Garbled { rank })
    };
    let expected = read(0)?;
    let mut first: Option<(usize, RankError)> = None;
    for rank in 1..all.len() {
        if all[rank] == all[0] {
            continue;
        }
        if let Some((fact, error)) = difference(&expected, &read(rank)?, rank)
            && first.as_ref().is_none_or(|(earlier, _)| fact < *earlier)
        {
            first = Some((fact, error));
        }
    }
    first.map_or(Ok(()), |(_, error)| Err(error))
}

/// The place of the first fact on which rank 0 and `rank` differ, and the error that tells of it.
fn difference(expected: &[(String, String)], found: &[(String, String)], rank: usize) -> Option<(usize, RankError)> {
    let longest = expected.len().max(found.len());
    let at = (0..longest).find(|&at| expected.get(at) != found.get(at))?;
    let (name, expected, found) = match (expected.get(at), found.get(at)) {
        (Some((name, expected)), Some((other, found))) if name == other => {
            (name.clone(), expected.as_str(), found.as_str())
        }
        (expected, found) => {
            let name =
                |fact: Option<&(String, String)>| fact.map_or("nothing more".to_owned(), |(name, _)| name.clone());
            return Some((
                at,
                RankError::Disagreement {
                    name: "facts to compare".to_owned(),
                    expected: name(expected),
                    rank,
                    found: name(found),
                },
            ));
        }
    };
    let (expected, found) = shortened(expected, found);
    Some((at, RankError::Disagreement { name, expected, rank, found }))
}

/// Both values, or if one is long, at most [`LONGEST_VALUE`] characters of each from a little before where they part,
/// with marks of what was left out.
fn shortened(expected: &str, found: &str) -> (String, String) {
    let parting = expected.chars().zip(found.chars()).take_while(|(a, b)| a == b).count();
    let short = |text: &str| text.chars().count() <= LONGEST_VALUE;
    let skipped = if short(expected) && short(found) { 0 } else { parting.saturating_sub(LONGEST_VALUE / 2) };
    let cut = |text: &str| {
        let kept: String = text.chars().skip(skipped).take(LONGEST_VALUE).collect();
        let before = if skipped > 0 { "..." } else { "" };
        let after = if text.chars().count() > skipped + LONGEST_VALUE { "..." } else { "" };
        format!("`{before}{kept}{after}`")
    };
    (cut(expected), cut(found))
}
