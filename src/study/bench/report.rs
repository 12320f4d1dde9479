//! The tables of a bench, and the same as JSON.

use serde_json::{Value, json};

use crate::gpu::{Device, Operations};
use crate::output::aligned;

use super::{Ceilings, Measured, OCCUPANCY, ROUNDS, host};

/// A run's phases: device time; bytes counted, their rate, and that over the copy's; the same of operations and the ceiling of arithmetic.
pub fn table(measured: &Measured, ceilings: &Ceilings) -> String {
    let head = [
        "phase",
        "device s",
        "%",
        "ns/particle-step",
        "bytes/particle-step",
        "GB/s",
        "of the copy",
        "operations/particle-step",
        "G/s",
        "of the arithmetic",
    ];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    let total: f64 = measured.costs.iter().map(|cost| cost.seconds).sum();
    let per = |value: f64| value / measured.work.particle_steps.max(1.0);
    let rates = |amount: Option<f64>, seconds: f64, ceiling: f64, decimals: usize| match amount {
        Some(amount) if seconds > 0.0 => [
            format!("{:.decimals$}", per(amount)),
            format!("{:.2}", 1e-9 * amount / seconds),
            format!("{:.1} %", 100.0 * amount / seconds / ceiling),
        ],
        _ => ["-", "-", "-"].map(str::to_owned),
    };
    let mut line = |name: &str, seconds: f64, bytes: Option<f64>, operations: Option<f64>| {
        let mut cells = vec![
            name.to_owned(),
            format!("{seconds:.4}"),
            if total > 0.0 { format!("{:.1}", 100.0 * seconds / total) } else { "-".into() },
            format!("{:.3}", 1e9 * per(seconds)),
        ];
        cells.extend(rates(bytes, seconds, ceilings.copy, 1));
        cells.extend(rates(operations, seconds, ceilings.arithmetic, 0));
        rows.push(cells);
    };
    let (mut bytes, mut operations) = (0.0, 0.0);
    for cost in &measured.costs {
        let own = cost.operations.map(Operations::all);
        bytes += cost.bytes.unwrap_or(0.0);
        operations += own.unwrap_or(0.0);
        line(&cost.phase, cost.seconds, cost.bytes, own);
    }
    line("all", total, Some(bytes), Some(operations));
    aligned(&rows)
}

/// A line for each run; the ratio to the target is the last column.
pub fn summary(all: &[Measured], ceilings: &Ceilings, device: &Device) -> String {
    let head = [
        "scene",
        "method",
        "particles",
        "bytes/particle",
        "bytes/cell",
        "collisions/particle-step",
        "M/s at the ceilings",
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
            format!("{:.3}", measured.work.collisions / measured.work.particle_steps.max(1.0)),
            measured.rate_at_ceilings(ceilings).map_or_else(|| "-".into(), |rate| format!("{:.1}", 1e-6 * rate)),
            format!("{:.2}", 1e-6 * measured.rate()),
            target.map_or_else(|| "-".into(), |target| format!("{:.0}", 1e-6 * target)),
            target.map_or_else(|| "-".into(), |target| format!("{:.3}", measured.rate() / target)),
        ]);
    }
    aligned(&rows)
}

/// What a run took of the host's processor.
pub fn host_line(measured: &Measured, device: &Device) -> String {
    measured.host.told(device.adapter().is_cpu())
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
        "{}, {}{parameters}, {} particles, {} steps after {}: {:.3} M particle-steps/s{aim}; {:.0} bytes of buffers per particle{of_cells}",
        measured.scene,
        measured.method.name(),
        measured.present,
        measured.steps,
        measured.warm_steps,
        1e-6 * measured.rate(),
        measured.buffers[0] as f64 / measured.present.max(1) as f64,
    )
}

/// All of it; `missing`: runs that could not be measured, and why.
pub fn json(all: &[Measured], missing: &[(String, String)], ceilings: &Ceilings, device: &Device) -> Value {
    let runs = all.iter().map(|measured| {
        let phases = measured.costs.iter().map(|cost| {
            let rate = |amount: Option<f64>| amount.filter(|_| cost.seconds > 0.0).map(|amount| amount / cost.seconds);
            let operations = cost.operations.map(Operations::all);
            json!({
                "phase": cost.phase,
                "device_seconds": cost.seconds,
                "dispatches": cost.dispatches,
                "bytes": cost.bytes,
                "bytes_per_second": rate(cost.bytes),
                "share_of_copy": rate(cost.bytes).map(|rate| rate / ceilings.copy),
                "floating_operations": cost.operations.map(|operations| operations.floating),
                "integer_operations": cost.operations.map(|operations| operations.integer),
                "operations_per_second": rate(operations),
                "share_of_arithmetic": rate(operations).map(|rate| rate / ceilings.arithmetic),
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
            "steps_before": measured.warm_steps,
            "particle_steps": measured.particle_steps,
            "wall_seconds": measured.seconds,
            "particle_steps_per_second": measured.rate(),
            "particle_steps_per_second_at_ceilings": measured.rate_at_ceilings(ceilings),
            "target": measured.target(device),
            "collisions": measured.work.collisions,
            "candidates": measured.work.candidates,
            "choosers": measured.work.choosers,
            "near_walls": measured.work.near_walls,
            "bounces": measured.work.bounces,
            "host_cores": measured.host.process,
            "host_thread_cores": measured.host.thread,
            "particle_buffer_bytes": measured.buffers[0],
            "cell_buffer_bytes": measured.buffers[1],
            "cells": measured.cells,
            "phases": phases.collect::<Vec<_>>(),
        })
    });
    let info = &device.adapter().info;
    let mut record = host::record();
    let own = json!({
        "adapter": info.name,
        "driver": format!("{} {}", info.driver, info.driver_info).trim(),
        "form": device.variant().name(),
        "software_threads": if device.adapter().is_cpu() { Some(host::threads()) } else { None },
        "copy_bytes_per_second": ceilings.copy,
        "arithmetic_operations_per_second": ceilings.arithmetic,
        "cached_loads_per_second": ceilings.loads,
        "flights_per_second": ceilings.flights,
        "runs": runs.collect::<Vec<_>>(),
        "not_measured": missing.iter().map(|(run, why)| json!({ "run": run, "why": why })).collect::<Vec<_>>(),
    });
    if let (Value::Object(record), Value::Object(own)) = (&mut record, own) {
        record.extend(own);
    }
    record
}
