//! Membranes that move: waves, a sheet that wrinkles freely, a taut one that swings for long.

use std::f64::consts::PI;

use glam::DVec3;

use crate::fabric::{Elasticity, Material, Obstacle};
use crate::gpu::Device;
use crate::study::StudyError;

use super::sheet::{DENSITY, FABRIC, Run, Sheet, YOUNG};
use super::stretched::scatter;
use crate::study::verify::damped_wave::fit;
use crate::study::verify::{Check, Effort, Findings};

/// Without damping: energies must stay.
pub const UNDAMPED: Material = Material { damping: 0.0, ..FABRIC };

/// A standing wave of stretching in a taut strip, so many elements long, without Poisson's ratio.
pub fn wave(device: &Device, elements: u32) -> Result<Check, StudyError> {
    let length = 1.0;
    let (squares, edge) = ([elements, 1], length / f64::from(elements));
    let speed = (YOUNG / DENSITY).sqrt();
    let mut sheet = Sheet::rectangle(squares, edge);
    let elasticity = Elasticity::Isotropic { young: YOUNG, poisson: 0.0 };
    sheet.material = Material { elasticity, ..UNDAMPED };
    sheet.fix(|p| p.x < 1e-9 || p.x > length - 1e-9);
    let shape: Vec<f64> = sheet.mesh.nodes.iter().map(|node| (PI * node[0] / length).sin()).collect();
    sheet.velocities = shape.iter().map(|s| DVec3::X * (1e-4 * speed * s)).collect();
    sheet.moved(|_, p| p.with_x(1.0005 * p.x));
    let run = sheet.run(device, 1.0)?;
    let period = 2.0 * length / speed;
    // Some 250 points in three periods.
    let between = ((0.012 * period / run.dt) as u32).max(1);
    let mut series = Vec::new();
    while series.last().is_none_or(|&(time, _)| time < 3.0) {
        run.steps(between)?;
        let time = f64::from(between) * (series.len() + 1) as f64 * run.dt / period;
        let places = run.places()?;
        let off = places.iter().zip(&run.mesh.nodes).map(|(now, start)| now.x - start[0]);
        series.push((time, off.zip(&shape).map(|(off, s)| off * s).sum::<f64>()));
    }
    let [frequency, _] = fit(&series, 2.0 * PI);
    Ok(Check::of(format!("speed/root(E/rho), {elements} elements"), 1.0, (frequency / (2.0 * PI), 0.0), 0.02))
}

pub fn waves(device: &Device, _: Effort) -> Result<Findings, StudyError> {
    Ok(vec![wave(device, 200)?].into())
}

/// A free sheet of 0.4 m a side that is drawn apart, springs back, and crumples.
pub fn crumpling(squares: u32) -> Sheet {
    let side: f64 = 0.4;
    let mut sheet = Sheet::rectangle([squares; 2], side / f64::from(squares));
    // Where a wrinkle is wrong, Poisson's ratio shows it.
    let elasticity = Elasticity::Isotropic { young: YOUNG, poisson: 0.45 };
    sheet.material = Material { elasticity, ..UNDAMPED };
    sheet.room = 0.3;
    let nodes = sheet.mesh.nodes.iter().zip(0..);
    let velocity = |(node, k): (&[f64; 3], u32)| {
        let [x, y] = [node[0], node[1]].map(|at| 20.0 * (at - 0.5 * side));
        DVec3::new(x, y, 0.0) + DVec3::new(scatter(k, 5), scatter(k, 6), scatter(k, 7))
    };
    sheet.velocities = nodes.map(velocity).collect();
    sheet
}

pub const CRUMPLING_TIME: f64 = 0.03;

/// The relative change of a sheet's energy over its first step: of motion and of strain.
fn change(run: &Run<'_>, steps: u32) -> Result<(f64, f64), StudyError> {
    run.steps(1)?;
    let start = run.energies()?;
    run.steps(steps)?;
    let end = run.energies()?;
    Ok((end.balance() - start.balance(), start.kinetic))
}

pub fn crumple(device: &Device, _: Effort) -> Result<Findings, StudyError> {
    let run = crumpling(20).run(device, 1.0)?;
    let (change, kinetic) = change(&run, (CRUMPLING_TIME / run.dt) as u32)?;
    let name = "change over 30 ms/energy";
    Ok(vec![Check::of(name, 0.0, (change / kinetic, 0.0), 5e-3)].into())
}

/// A taut sheet that swings for 20,000 steps, with so many waves a side.
pub fn swing(device: &Device, half_waves: u32) -> Result<Check, StudyError> {
    let (squares, edge) = (10, 0.04);
    let side = f64::from(squares) * edge;
    let mut sheet = Sheet::rectangle([squares; 2], edge);
    sheet.material = UNDAMPED;
    sheet.fix(|p| [p.x, p.y].iter().any(|&x| x < 1e-9 || x > side - 1e-9));
    let number = PI * f64::from(half_waves) / side;
    let mode = |p: &[f64; 3]| (number * p[0]).sin() * (number * p[1]).sin();
    sheet.velocities = sheet.mesh.nodes.iter().map(|p| DVec3::Z * mode(p)).collect();
    sheet.moved(|_, p| 1.005 * p);
    let run = sheet.run(device, 1.0)?;
    let (change, kinetic) = change(&run, 20_000)?;
    let name = "change over 20,000 steps/energy of motion";
    Ok(Check::of(name, 0.0, (change / kinetic, 0.0), 1e-4))
}

pub fn taut(device: &Device, _: Effort) -> Result<Findings, StudyError> {
    Ok(vec![swing(device, 1)?].into())
}

/// How far a sheet slides that lies on a plane with friction, m: v^2/(2 mu g).
pub fn slid(device: &Device, friction: f64) -> Result<f64, StudyError> {
    let mut sheet = Sheet::rectangle([4; 2], 0.05);
    sheet.velocities = vec![SLIDE_VELOCITY * DVec3::X; sheet.mesh.nodes.len()];
    sheet.gravity = [0.0, 0.0, -SLIDE_GRAVITY];
    let run = sheet.run(device, 1.0)?;
    let plane = Obstacle { place: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [0.0; 3], friction };
    run.membrane.set_obstacles(device, &[plane])?;
    let time = SLIDE_VELOCITY / (friction * SLIDE_GRAVITY);
    run.steps((1.1 * time / run.dt) as u32)?;
    let ways = run.places()?.into_iter().zip(&run.mesh.nodes).map(|(end, start)| end.x - start[0]);
    Ok(ways.sum::<f64>() / run.mesh.nodes.len() as f64)
}

const SLIDE_VELOCITY: f64 = 0.25;
const SLIDE_GRAVITY: f64 = 10.0;

pub fn slides(device: &Device, _: Effort) -> Result<Findings, StudyError> {
    let check = |friction: f64| {
        let way = SLIDE_VELOCITY * SLIDE_VELOCITY / (2.0 * friction * SLIDE_GRAVITY);
        let found = slid(device, friction)?;
        Ok(Check::of(format!("way with friction {friction}, m"), way, (found, 0.0), 0.01 * way))
    };
    [0.1, 0.3].into_iter().map(check).collect()
}
