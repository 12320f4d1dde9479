//! Text to raw types: what TOML and serde complain about, said in the words of all other problems.

use serde::Deserialize;
use toml::de::{DeTable, DeValue};

use super::errors::{Problem, list, quote};
use super::raw::RawScene;

/// Reads the text, or says what about its form is wrong.
pub(super) fn read(text: &str) -> Result<RawScene, Problem> {
    let document = DeTable::parse(text).map_err(|error| {
        // A syntax error at the end of the text has an empty span there.
        let span = error.span().unwrap_or(text.len()..text.len());
        let problem = Problem::syntax(&span, error.message());
        let is_value = text.get(..span.start).is_some_and(|before| before.trim_end().ends_with('='));
        match bare_value(text.get(span).unwrap_or_default()).filter(|_| is_value) {
            Some(hint) => problem.hint(&hint),
            None => problem,
        }
    })?;
    // Serde would read the fields of a table from a list in their order.
    for key in ["model", "output"] {
        if let Some(list) = document.get_ref().get(key).filter(|value| matches!(value.get_ref(), DeValue::Array(_))) {
            let problem = Problem::value(&list.span(), "a list", format!("one table: [{key}]"));
            return Err(problem.hint("double brackets begin an entry of a list, and of this table there is one"));
        }
    }
    RawScene::deserialize(toml::Deserializer::from(document)).map_err(|error| reworded(&error))
}

/// What is probably meant by a value that TOML cannot read: a text without its quotes, or a number with a unit.
fn bare_value(value: &str) -> Option<String> {
    let value = value.trim();
    let number = value.split_whitespace().next()?;
    let starts_as_number = number.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '-' | '+' | '.'));
    let is_word =
        |text: &str| text.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | ' ' | '.' | '/'));
    if starts_as_number && value != number && number.parse::<f64>().is_ok() {
        return Some(format!(
            "a number has no unit here, so write {number}: `units` sets that of all numbers of the file"
        ));
    }
    (value.starts_with(|c: char| c.is_ascii_alphabetic()) && is_word(value))
        .then(|| format!("a text has quotes: \"{value}\""))
}

/// Serde's messages have fixed forms, which `serde::de::Error` documents by its default methods.
fn reworded(error: &toml::de::Error) -> Problem {
    let span = error.span().unwrap_or(0..0);
    let message = error.message();
    let names = backticked(message);
    if let Some(rest) = message.strip_prefix("unknown field ") {
        let known = after_expected(rest);
        let unknown = names.first().copied().unwrap_or_default();
        return Problem::value(&span, format!("the unknown key {}", quote(unknown)), list(known.iter().copied()))
            .meant(unknown, known);
    }
    if let Some(rest) = message.strip_prefix("unknown variant ") {
        let known = after_expected(rest);
        let unknown = names.first().copied().unwrap_or_default();
        return Problem::value(&span, quote(unknown), list(known.iter().copied())).meant(unknown, known);
    }
    if message.starts_with("missing field ") {
        let key = names.first().copied().unwrap_or_default();
        return Problem::missing(&span, key, "a value: the key is required");
    }
    for prefix in ["invalid type: ", "invalid value: ", "invalid length "] {
        if let Some((found, expected)) = message.strip_prefix(prefix).and_then(|rest| rest.split_once(", expected ")) {
            let found = if prefix == "invalid length " { format!("an array of {found}") } else { plain(found) };
            let problem = Problem::value(&span, &found, plain(expected));
            let list_wanted = found == "a table" && expected.contains("sequence");
            let whole = found.strip_prefix("the number ").filter(|_| expected == "i64");
            let whole = whole
                .and_then(|number| number.parse::<f64>().ok())
                .filter(|number| number.fract() == 0.0 && number.abs() < 9e15);
            return match whole {
                Some(number) => problem.hint(&format!("without a point or an exponent: {number}")),
                None if list_wanted => problem.hint("a list of tables has double brackets: [[...]]"),
                None if expected.contains("sequence") => {
                    problem.hint("a list has brackets; a curve is a list of points: [[0.0, 1.0], [0.01, 1.0]]")
                }
                None => problem,
            };
        }
    }
    if message.starts_with("wanted exactly 1 element") {
        // The one enum with contents in the format is the region.
        return Problem::value(
            &span,
            "a table that has not exactly one key",
            "exactly one of `box`, `sphere`, `cylinder`",
        );
    }
    if message.contains("overflow") {
        return Problem::value(&span, "a number too large to be held", "a finite number");
    }
    Problem::value(&span, "a value of another form", message)
}

fn backticked(message: &str) -> Vec<&str> {
    message.split('`').skip(1).step_by(2).collect()
}

fn after_expected(message: &str) -> Vec<&str> {
    message.rsplit_once(", expected ").map(|(_, known)| backticked(known)).unwrap_or_default()
}

/// Serde's names of types in plain words.
fn plain(words: &str) -> String {
    let words = match words {
        "f64" => "a number",
        "i64" => "a whole number",
        "map" => "a table",
        "a map" => "a table",
        "sequence" => "an array",
        "a sequence" => "an array",
        other => other,
    };
    if words.starts_with("struct ") {
        return "a table".to_string();
    }
    let words = words.replace('`', "").replace(" as i128", "");
    for (serde, ours) in [
        ("floating point ", "the number "),
        ("integer ", "the number "),
        ("string ", "the text "),
        ("boolean ", "the truth value "),
    ] {
        if let Some(rest) = words.strip_prefix(serde) {
            return format!("{ours}{rest}");
        }
    }
    words
}
