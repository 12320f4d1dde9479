//! `corpuscle pareto`: error against device time, over methods and settings.

use std::path::Path;

use crate::gpu::Device;
use crate::output::{Claim, Content, OutputFolder, PARETO_CHART_FILE, PARETO_FILE, PARETO_TABLE_FILE};
use crate::scene::Method;
use crate::study::StudyError;
use crate::study::pareto::report::{Chart, front_of};
use crate::study::pareto::{CASES, Case, Extent, Trials, measure};

use super::CliError;
use super::arguments::{MethodName, ParetoArguments};
use super::terminal::say;

pub fn pareto(raw: ParetoArguments) -> Result<(), CliError> {
    let Some(name) = raw.case.as_ref() else {
        let widest = CASES.iter().map(|case| case.name.len()).max().unwrap_or(0);
        let lines: String = CASES.iter().map(|case| format!("{:<widest$}  {}\n", case.name, case.law)).collect();
        return say(&lines);
    };
    let known = || CASES.iter().map(|case| case.name.to_owned()).collect();
    let unknown = || CliError::UnknownCase { asked: name.clone(), known: known() };
    let case = CASES.iter().find(|case| case.name == name).ok_or_else(unknown)?;
    let extent = match (raw.quick, raw.full) {
        (true, _) => Extent::Quick,
        (_, true) => Extent::Full,
        _ => Extent::Normal,
    };
    let mut trials = (case.trials)(extent)?;
    let default = trials.unwished()?;
    keep(&mut trials, case, &raw.methods)?;
    let mut settings = trials.settings.clone();
    // The place of the default is wanted whatever the methods are.
    settings.push(default.0);
    let device = Device::open(raw.gpu.as_deref())?;
    let path = raw.out.clone().unwrap_or_else(|| Path::new("results").join(format!("pareto-{}", case.name)));
    let claim = Claim { content: Content::Pareto, scene: None, meshes: &[], inputs: &[], force: raw.force };
    let folder = OutputFolder::create(&path, &claim)?;
    let mut chart = Chart {
        name: case.name,
        trials: &trials,
        points: Vec::new(),
        front: Vec::new(),
        unwished_particles: default.1,
        adapter: device.adapter().info.name.clone(),
        command: command(case, &raw),
        seeds: raw.repeat,
    };
    for (index, setting) in settings.iter().enumerate() {
        tracing::info!("{} of {}: {setting}", index + 1, settings.len());
        chart.points.push(measure(&device, &trials, setting, raw.repeat)?);
        // What is known stays known if the program is stopped.
        chart.front = front_of(&chart.points);
        folder.write_text(PARETO_FILE, &chart.csv().map_err(StudyError::from)?)?;
    }
    let text = chart.text();
    folder.write_text(PARETO_TABLE_FILE, &text)?;
    chart.draw(&folder.path().join(PARETO_CHART_FILE))?;
    say(&text)?;
    say(&format!("{}\n", folder.path().display()))
}

/// Leaves the settings of these methods; all if none is named.
fn keep(trials: &mut Trials, case: &Case, names: &[MethodName]) -> Result<(), CliError> {
    let wanted: Vec<Method> = names.iter().map(|&name| Method::from(name)).collect();
    let known = trials.methods();
    if let Some(method) = wanted.iter().find(|method| !known.contains(method)) {
        let known = known.iter().map(|method| method.name()).collect();
        return Err(CliError::MethodOfCase { case: case.name.to_owned(), method: method.name(), known });
    }
    if !wanted.is_empty() {
        trials.settings.retain(|setting| setting.method.is_some_and(|method| wanted.contains(&method)));
    }
    Ok(())
}

/// As it would be typed.
fn command(case: &Case, raw: &ParetoArguments) -> String {
    let mut words = vec![format!("corpuscle pareto {}", case.name)];
    if !raw.methods.is_empty() {
        let names: Vec<&str> = raw.methods.iter().map(|&name| Method::from(name).name()).collect();
        words.push(format!("--methods {}", names.join(",")));
    }
    words.extend((raw.repeat > 1).then(|| format!("--repeat {}", raw.repeat)));
    words.extend(raw.quick.then(|| "--quick".to_owned()));
    words.extend(raw.full.then(|| "--full".to_owned()));
    words.join(" ")
}

impl From<MethodName> for Method {
    fn from(name: MethodName) -> Method {
        match name {
            MethodName::ClosestApproach => Method::ClosestApproach,
            MethodName::HardSphere => Method::HardSphere,
            MethodName::Cell => Method::Cell,
            MethodName::HalfTurn => Method::HalfTurn,
            MethodName::None => Method::None,
            MethodName::ControlVolume => Method::ControlVolume,
        }
    }
}
