//! Text to raw types: what TOML and serde complain about, said in the words of all other problems.

use std::ops::Range;

use serde::Deserialize;
use toml::de::{DeTable, DeValue};

use super::errors::{Problem, list, quote};
use super::raw::RawScene;
use super::words;

/// Reads the text, or says what about its form is wrong.
pub(super) fn read(text: &str) -> Result<RawScene, Problem> {
    let document = DeTable::parse(text).map_err(|error| {
        // A syntax error at the end of the text has an empty span there.
        let span = error.span().unwrap_or(text.len()..text.len());
        let problem = match (error.message(), text.get(span.clone())) {
            ("duplicate key", Some(key)) => {
                Problem::syntax(&span, &format!("the key {} for the second time", quote(key)))
            }
            (message, _) => Problem::syntax(&span, message),
        };
        match syntax_hint(text, &span) {
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
    RawScene::deserialize(toml::Deserializer::from(document)).map_err(|error| reworded(&error, text))
}

/// The lists of tables of the format.
const LISTS: [&str; 13] = [
    "gas",
    "wall",
    "chamber",
    "opening",
    "orifice",
    "probe",
    "surface",
    "vent",
    "motion",
    "fabric",
    "wall.hole",
    "wall.part",
    "fabric.part",
];

/// What was probably meant where the text stops being TOML.
fn syntax_hint(text: &str, span: &Range<usize>) -> Option<String> {
    let (before, after) = (text.get(..span.start)?, text.get(span.start..)?);
    let start = before.rfind('\n').map_or(0, |end| end + 1);
    let (line_before, line_after) = (text.get(start..span.start)?, after.lines().next().unwrap_or_default());
    if let Some(hint) = decimal_comma(line_before, line_after) {
        return Some(hint);
    }
    if before.trim_end().ends_with('=') {
        return bare_value(text.get(span.clone()).unwrap_or_default());
    }
    let line = format!("{line_before}{line_after}");
    let header = line.trim().strip_prefix('[')?.split(']').next()?.trim().to_string();
    LISTS.contains(&header.as_str()).then(|| doubled(&header))
}

fn doubled(list: &str) -> String {
    format!("each entry of the list `{list}` begins with double brackets: [[{list}]]")
}

/// A comma between digits where no list is, shortly before the place at which the text cannot be read: the character at it, the one
/// before, or that before the digits that were read.
fn decimal_comma(before: &str, after: &str) -> Option<String> {
    let line = format!("{before}{after}");
    let read = before.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    let places = [before.len(), before.len().saturating_sub(1), read.saturating_sub(1)];
    places.into_iter().find_map(|comma| {
        let bytes = line.as_bytes();
        let is_comma = bytes.get(comma) == Some(&b',');
        let whole = bytes[..comma.min(bytes.len())].iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
        let fraction = bytes.iter().skip(comma + 1).take_while(|byte| byte.is_ascii_digit()).count();
        if !is_comma || whole == 0 || fraction == 0 {
            return None;
        }
        let (whole, fraction) = (&line[comma - whole..comma], &line[comma + 1..comma + 1 + fraction]);
        Some(format!("numbers have a decimal point: {whole}.{fraction}, not {whole},{fraction}"))
    })
}

/// Whether an array has as many numbers as are wanted, if some of its commas are decimal ones.
fn commas_in(array: &str, expected: &str) -> bool {
    let wanted = expected.split_whitespace().find_map(|word| word.parse::<usize>().ok());
    let bytes = array.as_bytes();
    let is_decimal = |at: usize| {
        let digit = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_digit);
        bytes[at] == b',' && at > 0 && digit(at - 1) && digit(at + 1)
    };
    let commas = bytes.iter().filter(|&&byte| byte == b',').count();
    let decimal = (0..bytes.len()).filter(|&at| is_decimal(at)).count();
    decimal > 0 && wanted == Some(commas - decimal + 1)
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
fn reworded(error: &toml::de::Error, text: &str) -> Problem {
    let span = error.span().unwrap_or(0..0);
    let message = error.message();
    let names = backticked(message);
    if let Some(rest) = message.strip_prefix("unknown field ") {
        let known = after_expected(rest);
        let unknown = names.first().copied().unwrap_or_default();
        let problem = Problem::value(&span, format!("the unknown key {}", quote(unknown)), list(known.iter().copied()));
        return match words::other_key(unknown, &known) {
            Some(hint) => problem.hint(&hint),
            None => problem.meant(unknown, known),
        };
    }
    if let Some(rest) = message.strip_prefix("unknown variant ") {
        let known = after_expected(rest);
        let unknown = names.first().copied().unwrap_or_default();
        let problem = Problem::value(&span, quote(unknown), list(known.iter().copied()));
        let problem = match words::other_value(unknown, &known) {
            Some(hint) => problem.hint(&hint),
            None => problem,
        };
        return problem.meant(unknown, known);
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
            let header = text.get(span.clone()).map(|header| header.trim_matches(['[', ']', ' ']));
            let list = header.filter(|header| LISTS.contains(header));
            return match whole {
                None if prefix == "invalid length "
                    && commas_in(text.get(span.clone()).unwrap_or_default(), expected) =>
                {
                    problem.hint("numbers have a decimal point: 0.5, not 0,5")
                }
                Some(number) => problem.hint(&format!("without a point or an exponent: {number}")),
                None if list_wanted => problem
                    .hint(&list.map_or_else(|| "a list of tables has double brackets: [[...]]".to_string(), doubled)),
                None if found.starts_with("the text ") && expected == "f64" => {
                    problem.hint("a number has neither quotes nor a unit: it is in the units of the scene")
                }
                None if expected == PAIR && is_curve(text, &span) => problem.hint(
                    "a curve is a list of pairs: [[0.0, 1.0], [0.01, 1.0]], the first of each a time, or a pressure",
                ),
                None if expected.contains("sequence") => {
                    problem.hint("a list has brackets; a curve is a list of points: [[0.0, 1.0], [0.01, 1.0]]")
                }
                None => problem,
            };
        }
    }
    if message.starts_with("wanted exactly 1 element") {
        // The one enum with contents in the format is the region.
        let found = "a table that has not exactly one key";
        return Problem::value(&span, found, "exactly one of `box`, `sphere`, `cylinder`").hint(words::REGION);
    }
    if message.contains("overflow") {
        return Problem::value(&span, "a number too large to be held", "a finite number");
    }
    let found = match text.get(span.clone()) {
        Some(found) if found.starts_with('"') => found.to_string(),
        _ => "a value of another form".to_string(),
    };
    Problem::value(&span, found, message)
}

/// What is expected of a point, in `Numbers`.
const PAIR: &str = "an array of 2 numbers";

/// Whether what lies at the span is of a list of lists, or of a list that has nothing else in it than numbers.
fn is_curve(text: &str, span: &Range<usize>) -> bool {
    let before = text.get(..span.start).unwrap_or_default();
    let line = before.rsplit('\n').next().unwrap_or_default();
    ["mass_flow", "temperature", "discharge", "discharge_by_pressure", "leak_velocity", "velocity", "displacement"]
        .contains(&line.split('=').next().unwrap_or_default().trim())
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
