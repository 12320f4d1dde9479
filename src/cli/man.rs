//! `corpuscle man`: from the same definition as the help.

use clap::CommandFactory;

use super::CliError;
use super::arguments::{Arguments, ManArguments};
use super::terminal::say;

pub fn man(raw: ManArguments) -> Result<(), CliError> {
    let mut command = Arguments::command();
    // Gives the verbs their full names and the options that all share.
    command.build();
    let page = match raw.verb {
        None => command,
        Some(asked) => match command.find_subcommand(&asked) {
            Some(verb) => verb.clone(),
            None => {
                let known = command.get_subcommands().map(|verb| verb.get_name().to_owned()).collect();
                return Err(CliError::UnknownVerb { asked, known });
            }
        },
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text).map_err(CliError::StandardOutput)?;
    say(&String::from_utf8_lossy(&text))
}
