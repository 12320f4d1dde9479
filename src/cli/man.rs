//! `corpuscle man`: the man pages, and the reference page of the documents, from the same definition as the help.

use clap::CommandFactory;

use super::CliError;
use super::arguments::{Arguments, ManArguments};
use super::reference;
use super::terminal::say;

/// In the foot of every page.
const SOURCE: &str = concat!("corpuscle ", env!("CARGO_PKG_VERSION"));

pub fn man(raw: ManArguments) -> Result<(), CliError> {
    let mut command = Arguments::command();
    // Gives the verbs their full names and the options that all share.
    command.build();
    if raw.markdown {
        return say(&reference::page(&command));
    }
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
    clap_mangen::Man::new(page).source(SOURCE).render(&mut text).map_err(CliError::StandardOutput)?;
    say(&String::from_utf8_lossy(&text))
}
