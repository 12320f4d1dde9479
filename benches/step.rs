//! What a step costs on this machine's adapter, phase by phase: `cargo bench --bench step`.
//!
//! Gas at rest at occupancy 0.12 with the plan's own step and rounds. The phases are timed on the device;
//! the total is wall time, so it holds what lies between the phases too. Prints a table of particle-steps
//! per second and writes it as a chart to `docs/figures/step.svg`.
//!
//! `-- 100000 1000000` chooses the numbers of particles, `-- --steps N` the steps of each (default 64).

use std::path::Path;
use std::time::Instant;

use corpuscle::gpu::Device;
use corpuscle::simulation::{Model, Options, Outcome, Simulation};
use plotters::prelude::*;

/// SPARTA (24 Sep 2025) measured on one Zen 5 core, particle-steps per second: free flight, and collisions with particles sorted every 10 steps (ten per cell, 0.07 collisions per particle-step).
const SPARTA: [(&str, f64); 2] = [("SPARTA free flight, 1 core", 46.9e6), ("SPARTA collisions, 1 core", 18.4e6)];

struct Measured {
    particles: u64,
    /// Particle-steps per second of wall time.
    rate: f64,
    outcome: Outcome,
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut sizes = Vec::new();
    let mut steps = 64;
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            // Given by cargo.
            "--bench" => {}
            "--steps" => steps = arguments.next().ok_or("--steps needs a number")?.parse()?,
            number => sizes.push(number.parse()?),
        }
    }
    if sizes.is_empty() {
        sizes = vec![100_000, 1_000_000];
    }
    let device = Device::open(None)?;
    println!("adapter: {}", device.adapter().info.name);
    let mut all = Vec::new();
    for particles in sizes {
        let measured = measure(&device, particles, steps)?;
        print(&measured);
        all.push(measured);
    }
    let path = Path::new("docs/figures/step.svg");
    chart(path, &device.adapter().info.name, &all)?;
    println!("chart: {}", path.display());
    Ok(())
}

fn measure(device: &Device, particles: u64, steps: u64) -> Result<Measured, Box<dyn std::error::Error>> {
    let mut scene = corpuscle::scene::load(Path::new("scenes/box.toml"))?;
    scene.model.particles = Some(particles);
    scene.model.occupancy = Some(0.12);
    scene.output.snapshots = 0;
    let model = Model::new(scene)?;
    let run = |steps| -> Result<(Outcome, f64), Box<dyn std::error::Error>> {
        let options = Options { stop_after_steps: Some(steps), ..Options::default() };
        let simulation = Simulation::new(&model, device, options)?;
        let start = Instant::now();
        let outcome = simulation.run(&mut ())?;
        Ok((outcome, start.elapsed().as_secs_f64()))
    };
    // The first interval pays for the compilation of the kernels.
    run(1)?;
    let (outcome, seconds) = run(steps)?;
    let rate = outcome.particle_steps as f64 / seconds;
    Ok(Measured { particles, rate, outcome })
}

fn print(measured: &Measured) {
    let Measured { particles, rate, outcome } = measured;
    println!("\n{particles} particles, {} steps: {:.3} M particle-steps/s", outcome.steps, rate / 1e6);
    let per_particle = outcome.collisions as f64 * 2.0 / outcome.particle_steps as f64;
    println!("{per_particle:.3} collisions per particle-step, energy error {:+.1e}", outcome.audit.energy_error());
    print!("{}", outcome.phases.render(outcome.stepping_seconds));
}

/// One bar per phase, total and peer: M particle-steps per second, on a logarithmic axis.
fn chart(path: &Path, adapter: &str, all: &[Measured]) -> Result<(), Box<dyn std::error::Error>> {
    let mut bars: Vec<(String, f64, RGBColor)> = Vec::new();
    for measured in all {
        let size = format!("{} k", measured.particles / 1000);
        for (phase, seconds, _) in &measured.outcome.phases.rows {
            let rate = measured.outcome.phases.particle_steps as f64 / seconds;
            bars.push((format!("{size}: {phase}"), rate / 1e6, RGBColor(120, 160, 200)));
        }
        bars.push((format!("{size}: whole step"), measured.rate / 1e6, RGBColor(20, 80, 150)));
    }
    for (name, rate) in SPARTA {
        bars.push((name.to_string(), rate / 1e6, RGBColor(190, 120, 60)));
    }
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let height = 24 * bars.len() as u32 + 110;
    let root = SVGBackend::new(path, (860, height)).into_drawing_area();
    root.fill(&WHITE)?;
    root.draw(&Text::new(format!("Particle-steps per second by phase, {adapter}"), (20, 16), ("sans-serif", 18)))?;
    let (left, right, low, high) = (250.0, 760.0, -1.0_f64, 4.0_f64);
    let place = |rate: f64| left + (right - left) * ((rate.log10() - low) / (high - low)).clamp(0.0, 1.0);
    let bottom = height as i32 - 44;
    for decade in -1..=4 {
        let x = place(10f64.powi(decade)) as i32;
        root.draw(&PathElement::new(vec![(x, 46), (x, bottom)], RGBColor(220, 220, 220)))?;
        root.draw(&Text::new(format!("{}", 10f64.powi(decade)), (x - 8, bottom + 6), ("sans-serif", 13)))?;
    }
    let axis = "million particle-steps per second (whole step: wall time; phases: device time)";
    root.draw(&Text::new(axis, (left as i32, bottom + 24), ("sans-serif", 13)))?;
    for (k, (name, rate, colour)) in bars.iter().enumerate() {
        let y = 52 + 24 * k as i32;
        root.draw(&Text::new(name.clone(), (20, y), ("sans-serif", 13)))?;
        let end = place(*rate) as i32;
        root.draw(&Rectangle::new([(left as i32, y), (end, y + 16)], colour.filled()))?;
        root.draw(&Text::new(format!("{rate:.2}"), (end + 6, y + 1), ("sans-serif", 13)))?;
    }
    root.present()?;
    Ok(())
}
