//! The tables of a bench, and the same as JSON.

use serde_json::{Value, json};

use crate::gpu::Device;
use crate::output::aligned;

use super::{Ceilings, Measured, OCCUPANCY, ROUNDS, traffic};

/// A run's phases: device time, bytes counted, their rate, and that over the copy's.
pub fn table(measured: &Measured, ceilings: &Ceilings) -> String {
    let Measured { phases, work, .. } = measured;
    let head = ["phase", "device s", "%", "ns/particle-step", "bytes/particle-step", "GB/s", "of the copy"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let total = phases.seconds();
    let per = |value: f64| value / work.particle_steps.max(1.0);
    let mut all = 0.0;
    let mut line = |name: &str, seconds: f64, bytes: Option<f64>| {
        let mut cells = vec![
            name.to_owned(),
            format!("{seconds:.4}"),
            if total > 0.0 { format!("{:.1}", 100.0 * seconds / total) } else { "-".into() },
            format!("{:.3}", 1e9 * per(seconds)),
        ];
        match bytes {
            Some(bytes) if seconds > 0.0 => cells.extend([
                format!("{:.0}", per(bytes)),
                format!("{:.2}", 1e-9 * bytes / seconds),
                format!("{:.1} %", 100.0 * bytes / seconds / ceilings.copy),
            ]),
            _ => cells.extend(["-".to_owned(), "-".to_owned(), "-".to_owned()]),
        }
        rows.push(cells);
    };
    for (name, seconds, _) in &phases.rows {
        let bytes = traffic::bytes(name, measured.method, work);
        all += bytes.unwrap_or(0.0);
        line(name, *seconds, bytes);
    }
    line("all", total, Some(all));
    aligned(&rows)
}

/// A line for each run; the ratio to the target is the last column.
pub fn summary(all: &[Measured], device: &Device) -> String {
    let head = [
        "scene",
        "method",
        "particles",
        "bytes/particle",
        "bytes/cell",
        "M particle-steps/s",
        "target",
        "of the target",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for measured in all {
        let [particles, cells] = measured.buffers.map(|bytes| bytes as f64);
        let target = measured.target(device);
        rows.push(vec![
            measured.scene.to_owned(),
            measured.method.name().to_owned(),
            measured.present.to_string(),
            format!("{:.1}", particles / measured.present.max(1) as f64),
            if measured.cells > 0 { format!("{:.1}", cells / measured.cells as f64) } else { "-".into() },
            format!("{:.2}", 1e-6 * measured.rate()),
            target.map_or_else(|| "-".into(), |target| format!("{:.0}", 1e-6 * target)),
            target.map_or_else(|| "-".into(), |target| format!("{:.3}", measured.rate() / target)),
        ]);
    }
    aligned(&rows)
}

/// The line of a run: what it was, how fast, and over its target.
pub fn line(measured: &Measured, device: &Device) -> String {
    let target = measured.target(device);
    let aim = target.map_or_else(String::new, |target| {
        format!(", {:.3} of the target of {:.3} M", measured.rate() / target, 1e-6 * target)
    });
    let parameters = match (measured.step > 0.0, measured.method.has_rounds()) {
        (true, true) => format!(" (f = {OCCUPANCY}, x = {}, R = {ROUNDS})", measured.step),
        (true, false) => format!(" (f = {OCCUPANCY}, x = {})", measured.step),
        _ => String::new(),
    };
    // Without collisions nothing is sorted.
    let of_cells = match measured.cells {
        0 => String::new(),
        cells => format!(" and {:.1} per cell", measured.buffers[1] as f64 / cells as f64),
    };
    format!(
        "{}, {}{parameters}, {} particles, {} steps: {:.3} M particle-steps/s{aim}; {:.0} bytes of buffers per particle{of_cells}",
        measured.scene,
        measured.method.name(),
        measured.present,
        measured.steps,
        1e-6 * measured.rate(),
        measured.buffers[0] as f64 / measured.present.max(1) as f64,
    )
}

/// All of it; `missing`: runs that could not be measured, and why.
pub fn json(all: &[Measured], missing: &[(String, String)], ceilings: &Ceilings, device: &Device) -> Value {
    let runs = all.iter().map(|measured| {
        let phases = measured.phases.rows.iter().map(|(name, seconds, dispatches)| {
            json!({
                "phase": name,
                "device_seconds": seconds,
                "dispatches": dispatches,
                "bytes": traffic::bytes(name, measured.method, &measured.work),
            })
        });
        json!({
            "scene": measured.scene,
            "method": measured.method.name(),
            "particles": measured.present,
            "occupancy": if measured.step > 0.0 { Some(OCCUPANCY) } else { None },
            "step_over_tau": if measured.step > 0.0 { Some(measured.step) } else { None },
            "rounds": if measured.method.has_rounds() { Some(ROUNDS) } else { None },
            "steps": measured.steps,
            "particle_steps": measured.particle_steps,
            "wall_seconds": measured.seconds,
            "particle_steps_per_second": measured.rate(),
            "target": measured.target(device),
            "collisions": measured.work.collisions,
            "candidates": measured.work.candidates,
            "bounces": measured.work.bounces,
            "particle_buffer_bytes": measured.buffers[0],
            "cell_buffer_bytes": measured.buffers[1],
            "cells": measured.cells,
            "phases": phases.collect::<Vec<_>>(),
        })
    });
    let info = &device.adapter().info;
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "adapter": info.name,
        "driver": format!("{} {}", info.driver, info.driver_info).trim(),
        "software_threads": if device.adapter().is_cpu() { Some(super::threads()) } else { None },
        "copy_bytes_per_second": ceilings.copy,
        "arithmetic_operations_per_second": ceilings.arithmetic,
        "cached_loads_per_second": ceilings.loads,
        "flights_per_second": ceilings.flights,
        "runs": runs.collect::<Vec<_>>(),
        "not_measured": missing.iter().map(|(run, why)| json!({ "run": run, "why": why })).collect::<Vec<_>>(),
    })
}
