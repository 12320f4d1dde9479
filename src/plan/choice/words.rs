//! A plan, its error and its cost in words.

use super::possible::Possible;
use crate::plan::forecast::{Cause, ColumnForecast, worst};
use crate::plan::text::{grouped, significant};
use crate::scene::Method;

/// A plan in a few words.
pub fn words(plan: &Possible) -> String {
    match plan.candidate.method {
        Method::ControlVolume => "control-volume".into(),
        method => format!("{} with {} particles", method.name(), grouped(plan.candidate.particles as u64)),
    }
}

/// What keeps the best plan from being better.
pub fn shortfall(plan: &Possible) -> String {
    let column = worst(&plan.columns);
    let cause = column.and_then(ColumnForecast::main_cause).map_or("nothing", Cause::name);
    let name = column.map_or("", |column| column.name.as_str());
    format!("{}, is {} off in {name} ({cause})", words(plan), significant(plan.error))
}

pub(super) fn percent(error: f64) -> String {
    format!("{} %", significant(100.0 * error))
}

/// A time for people.
pub(super) fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 0.005 => "less than 0.01 s".to_string(),
        s if s < 120.0 => format!("{} s", significant((100.0 * s).round() / 100.0)),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
