//! `corpuscle completions`: from the same definition as the help.

use clap::CommandFactory;

use super::CliError;
use super::arguments::{Arguments, CompletionsArguments};
use super::terminal::say;

pub fn completions(raw: CompletionsArguments) -> Result<(), CliError> {
    let mut text = Vec::new();
    clap_complete::generate(raw.shell, &mut Arguments::command(), "corpuscle", &mut text);
    say(&String::from_utf8_lossy(&text))
}
