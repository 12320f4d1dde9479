//! What the user sees: results on standard output; logs and errors on standard error, with colours only where
//! that is a terminal.

use std::fmt;
use std::io::{ErrorKind, IsTerminal, Write};

use miette::{MietteHandler, MietteHandlerOpts, ReportHandler};
use tracing::Level;

use super::CliError;
use super::arguments::Verbosity;

/// Sets up logs and error reports. To be called once.
pub fn start(verbosity: Verbosity) {
    let level = match verbosity {
        Verbosity::Quiet => Level::ERROR,
        Verbosity::Normal => Level::INFO,
        Verbosity::Verbose => Level::DEBUG,
        Verbosity::All => Level::TRACE,
    };
    let colour = colour();
    tracing_subscriber::fmt()
        .with_max_level(level)
        .with_writer(std::io::stderr)
        .with_ansi(colour)
        .with_target(false)
        .without_time()
        .init();
    // The hook can only be set already by an embedding program.
    let _ = miette::set_hook(Box::new(move |_| Box::new(handler().color(colour).build())));
}

/// An error's own text names its causes.
fn handler() -> MietteHandlerOpts {
    MietteHandlerOpts::new().without_cause_chain().terminal_links(false)
}

/// <https://no-color.org>
fn colour() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Prints a result.
///
/// # Errors
/// If standard output takes no more, unless its reader has simply seen enough.
pub fn say(text: &str) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::StandardOutput(error)),
        _ => Ok(()),
    }
}

/// An error with its place in the scene file and its remedy, in lines of any length.
pub fn report(error: &CliError) -> String {
    struct Shown<'a>(MietteHandler, &'a CliError);
    impl fmt::Display for Shown<'_> {
        fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
            self.0.debug(self.1, to)
        }
    }
    let shown = Shown(handler().color(false).wrap_lines(false).build(), error).to_string();
    // Without what marks it as an error: it follows the name of who has it.
    shown.trim().trim_start_matches("× ").to_owned()
}

/// Prints an error with its place in the scene file and its remedy.
pub fn complain(error: CliError) {
    // If standard error is closed nobody reads it.
    let _ = writeln!(std::io::stderr(), "{:?}", miette::Report::new(error));
}
