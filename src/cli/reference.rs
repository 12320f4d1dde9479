//! The reference page of the command line, from the same definition as the help: `corpuscle man --markdown`.

use std::collections::BTreeMap;
use std::fmt::Write;

use clap::{Arg, Command};

/// The page. `command` is built, so that its verbs have their full names.
pub fn page(command: &Command) -> String {
    let mut page =
        "# Command line\n\nPrinted by `corpuscle man --markdown`. `corpuscle help VERB` prints one verb.\n\n\
                    | verb | what it does |\n|---|---|\n"
            .to_owned();
    for verb in verbs(command) {
        let _ = writeln!(page, "| [`{0}`](#{0}) | {1} |", verb.get_name(), about(verb));
    }
    page += "\n## Options of every verb\n\n";
    let shared = command.get_arguments().filter(|argument| argument.is_global_set());
    table(&mut page, shared);
    let mut told = BTreeMap::new();
    for verb in verbs(command) {
        section(&mut page, verb, &mut told);
    }
    page
}

fn verbs(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|verb| verb.get_name() != "help" && !verb.is_hide_set())
}

fn about(command: &Command) -> String {
    command.get_about().map(ToString::to_string).unwrap_or_default()
}

/// A verb's own arguments as a table. What an earlier verb has in the same words is named with that verb (`told`).
fn section<'a>(page: &mut String, verb: &'a Command, told: &mut BTreeMap<(String, String), &'a str>) {
    let usage = verb.clone().render_usage().to_string();
    let usage = usage.trim_start_matches("Usage: ");
    let _ = write!(page, "\n## {}\n\n`{usage}`\n", verb.get_name());
    let (mut own, mut before) = (Vec::new(), BTreeMap::<&str, Vec<String>>::new());
    for argument in verb.get_arguments().filter(|argument| is_own(argument)) {
        match told.get(&key(argument)) {
            Some(&first) => before.entry(first).or_default().push(format!("`{}`", name(argument))),
            None => own.push(argument),
        }
    }
    for argument in &own {
        told.insert(key(argument), verb.get_name());
    }
    if !own.is_empty() {
        page.push('\n');
        table(page, own.into_iter());
    }
    for (first, names) in before {
        let _ = write!(page, "\nAs of [`{first}`](#{first}): {}.\n", names.join(", "));
    }
}

fn is_own(argument: &Arg) -> bool {
    let id = argument.get_id().as_str();
    !argument.is_global_set() && !argument.is_hide_set() && id != "help" && id != "version"
}

fn key(argument: &Arg) -> (String, String) {
    (name(argument), meaning(argument))
}

/// As on the command line without its value, a value that stands alone with its name.
fn name(argument: &Arg) -> String {
    argument.get_long().map_or_else(|| argument.to_string(), |long| format!("--{long}"))
}

fn table<'a>(page: &mut String, arguments: impl Iterator<Item = &'a Arg>) {
    page.push_str("| argument | meaning |\n|---|---|\n");
    for argument in arguments {
        let short = argument.get_short().map(|short| format!("`-{short}`, ")).unwrap_or_default();
        let typed = argument.to_string().replace('|', "\\|");
        // A flag that counts is shown as if it took values.
        let typed = if argument.get_action().takes_values() { &typed } else { typed.trim_end_matches("...") };
        let meaning = meaning(argument).replace('|', "\\|").replace('<', "\\<");
        let _ = writeln!(page, "| {short}`{typed}` | {meaning} |");
    }
}

/// Its help, what it may be, and what it is where it is not given.
fn meaning(argument: &Arg) -> String {
    let mut words = argument.get_help().map(ToString::to_string).unwrap_or_default();
    if argument.get_action().takes_values() {
        let values: Vec<String> =
            argument.get_possible_values().iter().map(|value| format!("`{}`", value.get_name())).collect();
        if !values.is_empty() {
            let _ = write!(words, "; {}", values.join(", "));
        }
        let defaults = argument.get_default_values();
        if let (Some(default), false) = (defaults.first(), argument.is_hide_default_value_set()) {
            let _ = write!(words, " [default: {}]", default.to_string_lossy());
        }
    }
    words
}
