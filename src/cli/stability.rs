//! `corpuscle stability`: maps of where the methods fail.

use std::fs;
use std::path::{Path, PathBuf};

use crate::gpu::Device;
use crate::output::{
    Claim, Content, OutputError, OutputFolder, STABILITY_CHART_FILE, STABILITY_FILE, STABILITY_TABLE_FILE,
};
use crate::study::StudyError;
use crate::study::stability::report::{self, Map};
use crate::study::stability::{AXES, Axis, Effort};

use super::CliError;
use super::arguments::StabilityArguments;
use super::terminal::say;

/// Names all cases.
const ALL: &str = "all";

pub fn stability(raw: StabilityArguments) -> Result<(), CliError> {
    if raw.list {
        let widest = AXES.iter().map(|axis| axis.name.len()).max().unwrap_or(0);
        let lines: String = AXES.iter().map(|axis| format!("{:<widest$}  {}\n", axis.name, axis.what)).collect();
        return say(&lines);
    }
    let axes = chosen(&raw.cases)?;
    let effort = match (raw.quick, raw.full) {
        (true, _) => Effort::Quick,
        (_, true) => Effort::Full,
        _ => Effort::Usual,
    };
    let device = Device::open(raw.gpu.as_deref())?;
    let folder = raw.out.clone().unwrap_or_else(|| Path::new("results").join("stability"));
    // Before the folder is made ready, which removes it.
    let kept =
        if raw.go_on { fs::read_to_string(folder.join(STABILITY_FILE)).unwrap_or_default() } else { String::new() };
    let claim = Claim { content: Content::Stability, scene: None, meshes: &[], inputs: &[], force: raw.force };
    let folder = OutputFolder::create(&folder, &claim)?;
    let info = &device.adapter().info;
    let driver = format!("{} {}", info.driver, info.driver_info);
    let adapter = format!("{} ({})", info.name, driver.trim());
    let mut maps: Vec<Map<'_>> = Vec::new();
    let mut text = String::new();
    for axis in axes {
        let known = report::points_of(&kept, axis, effort);
        let missing = if known.is_some() { &[][..] } else { axis.methods };
        let mut points = known.unwrap_or_default();
        for &method in missing {
            for &value in axis.values(effort) {
                points.push(axis.run(&device, method, value, effort)?);
                tracing::info!("{}: {} at {value} done", axis.name, method.name());
            }
        }
        maps.push((axis, points));
        let map = maps.last().map(report::text).unwrap_or_default() + "\n";
        say(&map)?;
        text += &map;
        // What there is stays, however the rest goes.
        folder.write_text(STABILITY_FILE, &report::csv(&maps).map_err(StudyError::from)?)?;
        folder.write_text(STABILITY_TABLE_FILE, &text)?;
        report::chart(&folder.path().join(STABILITY_CHART_FILE), &maps)?;
        if let Some(path) = &raw.markdown {
            let page = report::page(&maps, &command(&raw), &adapter);
            fs::write(path, page).map_err(|source| OutputError::Io { action: "write", path: path.clone(), source })?;
        }
    }
    say(&format!("{}\n", folder.path().display()))
}

fn chosen(names: &[String]) -> Result<Vec<&'static Axis>, CliError> {
    let known = || AXES.iter().map(|axis| axis.name).chain([ALL]).map(str::to_owned).collect();
    let of_name = |name: &String| {
        let unknown = || CliError::UnknownCase { asked: name.clone(), known: known() };
        AXES.iter().find(|axis| axis.name == name).ok_or_else(unknown)
    };
    let named = names.iter().filter(|name| *name != ALL).map(of_name).collect::<Result<Vec<_>, _>>()?;
    Ok(if named.len() < names.len() { AXES.iter().collect() } else { named })
}

/// As it would be typed.
fn command(raw: &StabilityArguments) -> String {
    let mut words = vec!["corpuscle stability".to_owned()];
    words.extend(raw.cases.iter().cloned());
    words.extend(raw.quick.then(|| "--quick".to_owned()));
    words.extend(raw.full.then(|| "--full".to_owned()));
    words.extend(raw.markdown.as_ref().map(|path: &PathBuf| format!("--markdown {}", path.display())));
    words.join(" ")
}
