//! What was probably meant by a command line that cannot be read: keys of scenes that are given as options, and scenes without a verb.

use std::ffi::OsString;
use std::path::Path;

use clap::builder::StyledStr;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory};
use serde_json::Value;

use super::arguments::Arguments;
use crate::scene::{key_of_other_name, schema};

/// Tables of a scene, as messages call them, and what the schema calls them.
const TABLES: [(&str, &str); 3] =
    [("", "/properties"), ("[model]", "/$defs/RawModel/properties"), ("[output]", "/$defs/RawOutput/properties")];

/// The error with what was probably meant in place of clap's own guess, where that is known.
pub fn explained(mut error: clap::Error, words: &[OsString]) -> clap::Error {
    let tip = match error.kind() {
        ErrorKind::UnknownArgument => {
            named(&error, ContextKind::InvalidArg).and_then(|option| of_option(&option, words))
        }
        ErrorKind::InvalidSubcommand => named(&error, ContextKind::InvalidSubcommand).and_then(|word| of_verb(&word)),
        _ => None,
    };
    if let Some(tip) = tip {
        let kinds = [ContextKind::SuggestedArg, ContextKind::SuggestedSubcommand, ContextKind::SuggestedValue];
        for kind in kinds {
            error.remove(kind);
        }
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![StyledStr::from(tip)]));
    }
    error
}

fn named(error: &clap::Error, kind: ContextKind) -> Option<String> {
    match error.get(kind)? {
        ContextValue::String(word) => Some(word.clone()),
        _ => None,
    }
}

/// A key of a scene, or what another program calls it.
fn of_option(option: &str, words: &[OsString]) -> Option<String> {
    let word = option.strip_prefix("--")?.split('=').next()?.replace('-', "_");
    let (key, table) = key_of(&word)?;
    let place = if table.is_empty() { "before its tables".into() } else { format!("in {table}") };
    let mut tip = format!("`{key}` is a key of the scene: set it in the file, {place}");
    let command = Arguments::command();
    let own = words.iter().skip(1).find_map(|word| command.find_subcommand(word));
    let option = key.replace('_', "-");
    let verbs: Vec<String> = command
        .get_subcommands()
        .filter(|verb| own.is_none_or(|own| own.get_name() != verb.get_name()) && has(verb, &option))
        .map(|verb| format!("`{}`", verb.get_name()))
        .collect();
    if own.is_some_and(|own| has(own, &option)) {
        tip += &format!(". The option is --{option}");
    } else if !verbs.is_empty() {
        tip += &format!(". The verbs with an option --{option} are {}", verbs.join(", "));
    }
    if key == "end_time" && own.is_some_and(|own| has(own, "steps")) {
        tip += ". Only to end this run sooner: --steps N, or --stop-after WALLTIME, which writes a checkpoint";
    }
    Some(tip)
}

fn has(verb: &Command, option: &str) -> bool {
    verb.get_arguments().any(|argument| argument.get_long() == Some(option))
}

/// The key that is called so, or that other programs call so, and its table.
fn key_of(word: &str) -> Option<(String, &'static str)> {
    let schema = schema();
    let keys = |place: &str| -> Vec<String> {
        let table = schema.pointer(place).and_then(Value::as_object);
        // A list of entries is no value of an option.
        let is_value =
            |entry: &&Value| entry.get("type").and_then(Value::as_str) != Some("array") && entry.get("$ref").is_none();
        let keys = table.into_iter().flatten().filter(|(_, entry)| is_value(entry));
        keys.map(|(key, _)| key.clone()).collect()
    };
    let find = |test: &dyn Fn(&[&str]) -> Option<String>| {
        TABLES.iter().find_map(|(table, place)| {
            let known = keys(place);
            let known: Vec<&str> = known.iter().map(String::as_str).collect();
            Some((test(&known)?, *table))
        })
    };
    find(&|known| known.contains(&word).then(|| word.to_string()))
        .or_else(|| find(&|known| key_of_other_name(word, known).map(str::to_string)))
}

/// A scene where a verb should be.
fn of_verb(word: &str) -> Option<String> {
    let path = Path::new(word);
    let is_scene = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml")) || path.is_file();
    is_scene.then(|| format!("a verb comes first: did you mean `corpuscle run {word}`, or `corpuscle check {word}`?"))
}
