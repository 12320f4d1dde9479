//! `corpuscle verify`: the reference cases, and whether they hold here.

use std::fs;
use std::path::Path;

use crate::gpu::Device;
use crate::output::{OutputError, line_chart};
use crate::study::StudyError;
use crate::study::verify::page::Page;
use crate::study::verify::{CASES, Case, Effort, Findings, all_cases, report, run_cases};

use super::CliError;
use super::arguments::VerifyArguments;
use super::terminal::say;

/// Where the charts of a page are, beside it.
const FIGURES: &str = "figures";

pub fn verify(raw: VerifyArguments) -> Result<(), CliError> {
    let cases = chosen(&raw)?;
    // A page that cannot be kept is told before any case.
    let before = match &raw.markdown {
        Some(path) if raw.keep => Some(kept(path)?),
        _ => None,
    };
    if raw.list {
        let widest = cases.iter().map(|case| case.name.len()).max().unwrap_or(0);
        let lines: String = cases.iter().map(|case| format!("{:<widest$}  {}\n", case.name, case.law)).collect();
        return say(&lines);
    }
    let effort = if raw.full { Effort::Full } else { Effort::Quick };
    // A device that is not there is told before any case; each worker opens its own.
    let info = Device::open(raw.gpu.as_deref())?.adapter().info.clone();
    say(&report::head())?;
    let mut outcomes: Vec<(&Case, Findings)> = Vec::new();
    let mut failed: Vec<(&Case, StudyError)> = Vec::new();
    let open = || Device::open(raw.gpu.as_deref());
    run_cases(&cases, effort, raw.jobs as usize, open, |case, found| -> Result<(), CliError> {
        match found {
            Ok(found) => {
                say(&report::lines(case, &found.checks))?;
                outcomes.push((case, found));
            }
            Err(error) => {
                say(&report::failed(case, &error.to_string()))?;
                failed.push((case, error));
            }
        }
        Ok(())
    })?;
    if let Some(path) = &raw.markdown {
        let reasons: Vec<(&Case, String)> = failed.iter().map(|(case, error)| (*case, error.to_string())).collect();
        let driver = format!("{} {}", info.driver, info.driver_info);
        let device = format!("{} ({})", info.name, driver.trim());
        let mut page = Page::new(&outcomes, &reasons, &command(&raw), &device, FIGURES);
        if let Some(before) = before {
            page = page.in_place_of(before).map_err(|error| CliError::Page { path: path.clone(), error })?;
        }
        let io = |action, path: &Path, source| OutputError::Io { action, path: path.to_path_buf(), source };
        fs::write(path, page.text()).map_err(|source| io("write", path, source))?;
        let figures = path.parent().unwrap_or(Path::new("")).join(FIGURES);
        fs::create_dir_all(&figures).map_err(|source| io("create", &figures, source))?;
        for chart in outcomes.iter().flat_map(|(_, found)| &found.charts) {
            let path = figures.join(report::file(chart));
            line_chart(&path, &chart.title, chart.x_label, chart.y_label, &chart.series)?;
        }
    }
    let tally = report::Tally::of(&outcomes);
    say(&format!("{}\n", tally.in_words(failed.len())))?;
    let mut errors: Vec<CliError> = failed.into_iter().map(|(_, error)| error.into()).collect();
    if tally.failed() > 0 {
        errors.push(CliError::Verification { failed: tally.failed(), checks: tally.all });
    }
    worst(errors)
}

/// What cannot be trusted is worse than what could not be done; it has the highest code.
fn worst(errors: Vec<CliError>) -> Result<(), CliError> {
    errors.into_iter().max_by_key(CliError::exit_code).map_or(Ok(()), Err)
}

/// The named ones; of none those of laws, and the others where there is time for them.
fn chosen(raw: &VerifyArguments) -> Result<Vec<&'static Case>, CliError> {
    let known = || all_cases().map(|case| case.name.to_owned()).collect();
    let of_name = |name: &String| {
        let unknown = || CliError::UnknownCase { asked: name.clone(), known: known() };
        all_cases().find(|case| case.name == name).ok_or_else(unknown)
    };
    match raw.cases.as_slice() {
        [] if raw.full || raw.list => Ok(all_cases().collect()),
        [] => Ok(CASES.iter().collect()),
        names => names.iter().map(of_name).collect(),
    }
}

fn kept(path: &Path) -> Result<Page, CliError> {
    let text = fs::read_to_string(path).map_err(|source| OutputError::Io {
        action: "read",
        path: path.to_path_buf(),
        source,
    })?;
    Page::read(&text).map_err(|error| CliError::Page { path: path.to_path_buf(), error })
}

/// As it would be typed.
fn command(raw: &VerifyArguments) -> String {
    let mut words = vec!["corpuscle verify".to_owned()];
    words.extend(raw.cases.iter().cloned());
    words.push(if raw.full { "--full" } else { "--quick" }.to_owned());
    words.extend(raw.markdown.as_ref().map(|path| format!("--markdown {}", path.display())));
    words.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::GpuError;

    /// A check that does not pass is not hidden by a case that had no device, nor the other way round if all pass.
    #[test]
    fn the_worst_of_all_is_told() {
        let trouble = || CliError::Study(StudyError::from(GpuError::NoAdapter));
        let wrong = || CliError::Verification { failed: 1, checks: 2 };
        let code = |errors| worst(errors).map_err(|error| error.exit_code());
        assert_eq!(code(vec![trouble(), wrong()]), Err(4));
        assert_eq!(code(vec![wrong(), trouble()]), Err(4));
        assert_eq!(code(vec![trouble()]), Err(3));
        assert_eq!(code(Vec::new()), Ok(()));
    }
}
