//! What a run says at its beginning and at its end.

use std::fmt::Write;

use crate::gpu::AdapterDescription;
use crate::output::grouped;
use crate::simulation::{Continued, Model, Outcome};

pub(super) fn heading(adapter: &AdapterDescription, model: &Model) -> String {
    let plan = &model.plan;
    let AdapterDescription { index, info, .. } = adapter;
    let driver = format!("{} {}", info.driver, info.driver_info);
    format!(
        "{}: {} particles, {} cells\nadapter {index}: {} ({}, {})\n",
        model.scene.title,
        grouped(plan.particles),
        grouped(plan.grid.cell_count() as u64),
        info.name,
        info.backend,
        driver.trim(),
    )
}

/// The account of what a control volume did after the particles; nothing of a run that stayed one of particles.
pub(super) fn continued(model: &Model, outcome: &Outcome) -> String {
    let of = |continued: &Continued| {
        let [from, until] = [outcome.time, continued.until].map(|time| 1e3 * time);
        format!(
            "\nfrom {from:.4} ms to {until:.4} ms as a control volume: {}\n{}",
            continued.why,
            continued.audit.render()
        )
    };
    match &outcome.continued {
        Some(continued) => of(continued),
        None if model.scene.model.switch.is_some() && outcome.time >= model.plan.end_time => {
            "\nno control volume took over: the pressures were not uniform for so long before the end\n".to_owned()
        }
        None => String::new(),
    }
}

/// What the whole run has done, without wall times.
pub(super) fn totals(outcome: &Outcome) -> String {
    let [shortest, longest] = outcome.step_range.map(|step| 1e6 * step);
    // Where all particles of a cell collide at once nobody counts pairs.
    let collisions = match outcome.audit.collision_cells {
        None => format!("{} collisions, ", grouped(outcome.collisions)),
        Some(_) => String::new(),
    };
    format!(
        "{:.4} ms in {} steps of {shortest:.3} to {longest:.3} us, {collisions}{} bounces off walls\n",
        1e3 * outcome.time,
        grouped(outcome.steps),
        grouped(outcome.bounces),
    )
}

/// What has left its limits, a line each.
pub(super) fn warned(outcome: &Outcome) -> String {
    outcome.warnings.iter().map(|told| format!("warning {told}\n")).collect()
}

/// The audit, the phase table and the totals.
pub(super) fn summary(model: &Model, outcome: &Outcome, vents: &str) -> String {
    let mut text = format!("\n{}{}\n", outcome.audit.render(), continued(model, outcome));
    if outcome.phases.rows.is_empty() {
        text += "This device does not time its phases.\n";
    } else {
        text += &outcome.phases.render(outcome.stepping_seconds);
    }
    text += "\n";
    text += &totals(outcome);
    text += vents;
    text += &warned(outcome);
    if outcome.repeated > 0 {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "steps were run again {} times, with more room for neighbour lists", outcome.repeated);
    }
    let traffic = &outcome.traffic;
    if traffic.steps > 0 {
        let per_step = |count: f64| count / traffic.steps as f64;
        let _ = writeln!(
            text,
            "rank 0 per step: {:.1} messages, {:.1} kB sent, {:.0} of {:.0} particles from other ranks, {:.2} ms until \
             packed, {:.2} ms for the others' messages",
            per_step(traffic.messages as f64),
            per_step(1e-3 * traffic.bytes as f64),
            per_step(traffic.arrived as f64),
            per_step(traffic.present as f64),
            per_step(1e3 * traffic.device_seconds),
            per_step(1e3 * traffic.waiting_seconds),
        );
        let _ = writeln!(text, "{} rebalances", outcome.rebalances);
    }
    text
}
