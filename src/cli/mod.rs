//! The command line: one file per verb.
//!
//! Raw arguments ([`Arguments`], what was typed) become settings (what is meant: a scene with its overrides, a
//! folder) before anything is done. Results go to standard output, messages to standard error. Exit codes:
//! 0 done, or stopped as asked with a checkpoint; 2 bad input; 3 device trouble; 4 the audit failed; 128 and the number of
//! the signal for which a run has stopped, with a checkpoint.

mod adapters;
mod arguments;
mod bench;
mod check;
mod completions;
mod error;
mod man;
mod mesh;
mod pareto;
mod plan;
mod reference;
mod refine;
mod render;
mod report;
mod resume;
mod run;
mod schema;
mod settings;
mod stability;
mod sweep;
mod terminal;
mod usage;
mod verify;
mod watch;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};

pub use arguments::Arguments;
pub use error::CliError;

use arguments::Verb;

/// Reads the command line, does what it says and tells how it went.
pub fn main() -> ExitCode {
    let words: Vec<_> = std::env::args_os().collect();
    let choice = arguments::colour_of(&words);
    let parsed = Arguments::command().color(choice).try_get_matches_from(&words);
    let arguments = match parsed.and_then(|matches| Arguments::from_arg_matches(&matches)) {
        Ok(arguments) => arguments,
        Err(usage) => {
            // Help and version come this way too. Nobody is left to tell if it cannot be printed.
            let usage = usage::explained(usage, &words);
            let _ = usage.print();
            return ExitCode::from(u8::try_from(usage.exit_code()).unwrap_or(2));
        }
    };
    terminal::start(arguments.verbosity(), terminal::wanted_colour(choice));
    match perform(arguments) {
        Ok(code) => ExitCode::from(code),
        Err(error) => {
            let code = error.exit_code();
            terminal::complain(error);
            ExitCode::from(code)
        }
    }
}

/// Returns the exit code of what was done.
fn perform(arguments: Arguments) -> Result<u8, CliError> {
    let quiet = arguments.quiet;
    if let Some(verb) = arguments.verb.of_one_process()
        && let Some((variable, value)) = crate::ranks::one_of_several()
    {
        return Err(CliError::OneProcess { verb, variable, value });
    }
    let done = match arguments.verb {
        Verb::Run(raw) => return Ok(run::run(raw, quiet)?.exit_code()),
        Verb::Resume(raw) => return Ok(resume::resume(raw, quiet)?.exit_code()),
        Verb::Refine(raw) => refine::refine(raw),
        Verb::Report(raw) => report::report(raw),
        Verb::Watch(raw) => watch::watch(raw),
        Verb::Sweep(raw) => sweep::sweep(raw),
        Verb::Bench(raw) => bench::bench(raw),
        Verb::Render(raw) => render::render(raw),
        Verb::Plan(raw) => plan::plan(raw),
        Verb::Verify(raw) => verify::verify(raw),
        Verb::Pareto(raw) => pareto::pareto(raw),
        Verb::Stability(raw) => stability::stability(raw),
        Verb::Check(raw) => check::check(raw, quiet),
        Verb::Mesh(raw) => mesh::mesh(raw),
        Verb::Schema => schema::schema(),
        Verb::Adapters => adapters::adapters(),
        Verb::Completions(raw) => completions::completions(raw),
        Verb::Man(raw) => man::man(raw),
    };
    done.map(|()| 0)
}
