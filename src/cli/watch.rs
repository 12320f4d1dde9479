//! `corpuscle watch`: a run that goes on elsewhere, by its files alone.

use std::io::{IsTerminal, stdout};
use std::thread;
use std::time::Duration;

use crate::output::{Progressing, seen};

use super::CliError;
use super::arguments::WatchArguments;
use super::terminal::say;

/// Letters of a line where the terminal does not tell.
const USUAL_WIDTH: usize = 100;
/// Clears a terminal and goes to its first line.
const CLEAR: &str = "\x1b[H\x1b[2J\x1b[3J";

pub fn watch(raw: WatchArguments) -> Result<(), CliError> {
    let terminal = stdout().is_terminal();
    let once = raw.once || !terminal;
    loop {
        let found = seen(&raw.folder)?;
        let text = match &found {
            Some(found) => found.render(width()),
            None => format!("{}: a run that has no history yet\n", raw.folder.display()),
        };
        say(&if once { text } else { format!("{CLEAR}{text}") })?;
        // Who has been stopped may be resumed by another process: the next watch sees it.
        let goes_on = found.is_none_or(|found| matches!(found.state, Progressing::Going(_)));
        if once || !goes_on {
            return Ok(());
        }
        thread::sleep(Duration::from_secs(raw.every));
    }
}

/// Of the terminal, as shells tell it.
fn width() -> usize {
    let told = std::env::var("COLUMNS").ok().and_then(|columns| columns.parse().ok());
    told.filter(|columns| (40..=400).contains(columns)).unwrap_or(USUAL_WIDTH)
}
