//! `corpuscle bench`: what a step costs on this device, phase by phase.

use std::fs;

use crate::gpu::Device;
use crate::output::OutputError;
use crate::scene::Method;
use crate::study::StudyError;
use crate::study::bench::{BenchScene, Ceilings, SCENES, measure, report};

use super::CliError;
use super::arguments::BenchArguments;
use super::terminal::say;

pub fn bench(raw: BenchArguments) -> Result<(), CliError> {
    let scenes = raw.scene.iter().map(|name| scene_named(name)).collect::<Result<Vec<_>, _>>()?;
    let methods: Vec<Method> = raw.methods.iter().map(|&name| Method::from(name)).collect();
    if methods.contains(&Method::ControlVolume) {
        return Err(CliError::NothingToBench);
    }
    let device = Device::open(raw.gpu.as_deref())?;
    let ceilings = Ceilings::measure(&device).map_err(StudyError::from)?;
    say(&format!(
        "{}: copies {:.2} GB/s (read and written), {:.1} G operations/s, {:.2} G reads/s of words in a cache, \
         {:.1} M particles/s read, moved and written\n",
        device.adapter().info.name,
        1e-9 * ceilings.copy,
        1e-9 * ceilings.arithmetic,
        1e-9 * ceilings.loads,
        1e-6 * ceilings.flights
    ))?;
    let adapter = device.adapter();
    if adapter.is_cpu() && adapter.has_old_mesa() {
        let driver = &adapter.info.driver_info;
        say(&format!("driver: {driver}; one from 25 on is faster (docs/reference/performance.md, \"Which Mesa\")\n"))?;
    }
    let (mut all, mut failed) = (Vec::new(), Vec::new());
    for scene in scenes {
        for &method in &methods {
            for &particles in &raw.particles {
                // What the device has no room for leaves the others.
                match measure(&device, scene, method, particles, raw.steps) {
                    Ok(measured) => {
                        let table = report::table(&measured, &ceilings);
                        let host = report::host_line(&measured, &device);
                        say(&format!("\n{}\n{table}{host}\n", report::line(&measured, &device)))?;
                        all.push(measured);
                    }
                    Err(error) => {
                        let what = format!("{}, {}, {particles} particles", scene.name, method.name());
                        say(&format!("\n{what}: not measured: {error}\n"))?;
                        failed.push((what, error));
                    }
                }
            }
        }
    }
    if !all.is_empty() {
        say(&format!("\n{}", report::summary(&all, &ceilings, &device)))?;
    }
    if let Some(path) = &raw.json {
        let missing: Vec<(String, String)> =
            failed.iter().map(|(what, error)| (what.clone(), error.to_string())).collect();
        let text = format!("{:#}\n", report::json(&all, &missing, &ceilings, &device));
        fs::write(path, text).map_err(|source| OutputError::Io { action: "write", path: path.clone(), source })?;
    }
    match failed.into_iter().next() {
        None => Ok(()),
        Some((_, error)) => Err(error.into()),
    }
}

fn scene_named(name: &str) -> Result<&'static BenchScene, CliError> {
    let known = || SCENES.iter().map(|scene| scene.name.to_owned()).collect();
    let unknown = || CliError::UnknownCase { asked: name.to_owned(), known: known() };
    SCENES.iter().find(|scene| scene.name == name).ok_or_else(unknown)
}
