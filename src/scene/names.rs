//! Names: what they may look like, that no two are equal, and references to them.

use std::collections::HashMap;
use std::ops::Range;

use super::errors::{Problem, list, quote};
use super::raw_values::At;

/// The names of one list, by place in the file.
pub(super) struct Names<'a> {
    /// What the list holds, in words: "gas".
    kind: &'static str,
    names: Vec<&'a str>,
    index: HashMap<&'a str, usize>,
    /// A name of the list stands twice, so another that is looked for may be the one that it should have been.
    doubled: bool,
}

impl<'a> Names<'a> {
    /// Collects the names of a list; each one that is no name or not the first of its kind is a problem.
    pub fn collect(
        kind: &'static str,
        names: impl IntoIterator<Item = &'a At<String>>,
        problems: &mut Vec<Problem>,
    ) -> Names<'a> {
        let mut all = Names { kind, names: Vec::new(), index: HashMap::new(), doubled: false };
        let mut places: Vec<&Range<usize>> = Vec::new();
        for name in names {
            // A name with a fault still is known, so that what refers to it is not at fault too.
            if let Err(problem) = well_formed(name) {
                problems.push(problem);
            } else if let Some(&first) = all.index.get(name.value.as_str()) {
                let problem = Problem::value(
                    &name.span,
                    format!("{} for the second time", quote(&name.value)),
                    format!("a name that no other {kind} has"),
                );
                problems.push(problem.clash(places[first]));
                all.doubled = true;
            }
            all.index.entry(&name.value).or_insert(all.names.len());
            all.names.push(&name.value);
            places.push(&name.span);
        }
        all
    }

    /// The index of the entry called so.
    pub fn find(&self, name: &At<String>) -> Result<usize, Problem> {
        self.find_str(&name.value, &name.span)
    }

    pub fn find_str(&self, name: &str, span: &Range<usize>) -> Result<usize, Problem> {
        self.index.get(name).copied().ok_or_else(|| {
            let once = |(place, name): (usize, &&'a str)| (self.index.get(*name) == Some(&place)).then_some(*name);
            let known = || self.names.iter().enumerate().filter_map(once);
            let allowed = match self.names.len() {
                0 => format!("the name of a {} (the scene has none)", self.kind),
                _ => format!("the name of a {}: {}", self.kind, list(known())),
            };
            let problem = Problem::value(span, quote(name), allowed).meant(name, known());
            if self.doubled { problem.following() } else { problem }
        })
    }
}

/// Names head columns of history.csv, so they hold nothing that a table needs for itself.
fn well_formed(name: &At<String>) -> Result<(), Problem> {
    let text = &name.value;
    let plain = text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, ' ' | '_' | '-'));
    if plain && !text.is_empty() && text.trim() == text {
        return Ok(());
    }
    let found = if text.is_empty() { "an empty name".to_string() } else { quote(text) };
    let allowed =
        "letters a to z and A to Z, digits, inner spaces, `_` and `-` (names head the columns of history.csv)";
    Err(Problem::value(&name.span, found, allowed))
}
