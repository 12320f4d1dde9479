//! What the user sees: results on standard output; logs and errors on standard error, with colours only where
//! that is a terminal, or as `--color` says; and the log file of a run, which has what is told, with times.
//!
//! Nothing ends because what it says cannot be written: a disc is full, a reader has gone. Only of verbs that do nothing but
//! print is it an error.

use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use clap::ColorChoice;
use miette::{MietteHandler, MietteHandlerOpts, ReportHandler};
use tracing::Level;
use tracing_subscriber::filter::{FilterExt, LevelFilter, filter_fn};
use tracing_subscriber::fmt as log;
use tracing_subscriber::layer::{Layer, SubscriberExt};
use tracing_subscriber::util::SubscriberInitExt;

use super::CliError;
use super::arguments::Verbosity;
pub use crate::output::LOG_ONLY;

/// Sets up logs and error reports. To be called once.
pub fn start(verbosity: Verbosity, colour: bool) {
    let level = match verbosity {
        Verbosity::Quiet => Level::WARN,
        Verbosity::Normal => Level::INFO,
        Verbosity::Verbose => Level::DEBUG,
        Verbosity::All => Level::TRACE,
    };
    let seen = log::layer()
        .with_writer(|| StandardError)
        .with_ansi(colour)
        .with_target(false)
        .without_time()
        .with_filter(LevelFilter::from_level(level).and(filter_fn(|event| event.target() != LOG_ONLY)));
    let kept = log::layer()
        .with_writer(|| LogFile)
        .with_ansi(false)
        .with_target(false)
        .with_filter(LevelFilter::from_level(level.max(Level::INFO)));
    // It can only be set already by an embedding program, as can the hook.
    let _ = tracing_subscriber::registry().with(seen).with(kept).try_init();
    let _ = miette::set_hook(Box::new(move |_| Box::new(handler().color(colour).build())));
    let _ = COLOUR.set(colour);
}

static COLOUR: OnceLock<bool> = OnceLock::new();

/// Whether standard error has colours.
pub fn colour() -> bool {
    COLOUR.get().copied().unwrap_or(false)
}

/// The same as it is asked for; else where standard error is a terminal, by <https://no-color.org>.
pub fn wanted_colour(choice: ColorChoice) -> bool {
    match choice {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => {
            io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
        }
    }
}

/// An error's own text names its causes. Its lines are as long as they are: paths in it stay whole, also for those who search.
fn handler() -> MietteHandlerOpts {
    MietteHandlerOpts::new().without_cause_chain().terminal_links(false).wrap_lines(false)
}

/// What cannot be written there is lost.
struct StandardError;

impl Write for StandardError {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let _ = io::stderr().write_all(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let _ = io::stderr().flush();
        Ok(())
    }
}

/// Where the log of the run goes.
enum Kept {
    /// What was told before the run had its folder.
    Early(Vec<u8>),
    In(File),
}

static LOG: Mutex<Kept> = Mutex::new(Kept::Early(Vec::new()));
/// More is not kept of what was told before.
const MOST_EARLY: usize = 1 << 20;

fn kept() -> MutexGuard<'static, Kept> {
    LOG.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Also logs to the file, behind what it has. That it cannot be written is warned of.
pub fn log_to(path: &Path) {
    let opened = OpenOptions::new().append(true).create(true).open(path);
    match opened {
        Ok(mut file) => {
            let mut kept = kept();
            if let Kept::Early(bytes) = &*kept {
                let _ = file.write_all(bytes);
            }
            *kept = Kept::In(file);
        }
        Err(error) => tracing::warn!("cannot write {}: {error}", path.display()),
    }
}

struct LogFile;

impl Write for LogFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut *kept() {
            Kept::Early(early) if early.len() + bytes.len() > MOST_EARLY => {}
            Kept::Early(early) => early.extend_from_slice(bytes),
            Kept::In(file) => drop(file.write_all(bytes)),
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Prints a result.
///
/// # Errors
/// If standard output takes no more, unless its reader has simply seen enough.
pub fn say(text: &str) -> Result<(), CliError> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(CliError::StandardOutput(error)),
        _ => Ok(()),
    }
}

/// Prints what also stands in the files of a run: that it cannot be printed is no reason to stop.
pub fn tell(text: &str) {
    if let Err(error) = say(text) {
        tracing::warn!("{error}");
    }
}

/// An error with its place in the scene file and its remedy.
pub fn report(error: &CliError) -> String {
    struct Shown<'a>(MietteHandler, &'a CliError);
    impl fmt::Display for Shown<'_> {
        fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
            self.0.debug(self.1, to)
        }
    }
    let shown = Shown(handler().color(false).build(), error).to_string();
    // Without what marks it as an error: it follows the name of who has it.
    shown.trim().trim_start_matches("× ").to_owned()
}

/// Puts an error into the log of the run.
pub fn keep(error: &CliError) {
    tracing::error!(target: LOG_ONLY, "{}", report(error));
}

/// Prints an error with its place in the scene file and its remedy; the log of the run has it, too.
pub fn complain(error: CliError) {
    keep(&error);
    // If standard error is closed nobody reads it.
    let _ = writeln!(io::stderr(), "{:?}", miette::Report::new(error));
}
