//! What a sweep found: `sweep.csv`, tables in the form of the published ones, and curves of the speed-up.
//!
//! A speed-up is against the fewest devices, shared in the same way; one device alone stands for every strategy.

use std::path::Path;

use crate::output::{OutputError, PALETTE, Series, line_chart};

use super::Strategy;
use super::launched::Measured;
use super::modelled::Point;

/// What has a place in a sweep.
trait Placed {
    fn devices(&self) -> usize;
    fn strategy(&self) -> Strategy;
}

impl Placed for Measured {
    fn devices(&self) -> usize {
        self.devices
    }

    fn strategy(&self) -> Strategy {
        self.strategy
    }
}

impl Placed for Point {
    fn devices(&self) -> usize {
        self.devices
    }

    fn strategy(&self) -> Strategy {
        self.strategy
    }
}

/// One device is of every strategy.
fn at<T: Placed>(all: &[T], devices: usize, strategy: Strategy) -> Option<&T> {
    all.iter().find(|one| one.devices() == devices && (devices == 1 || one.strategy() == strategy))
}

fn counts<T: Placed>(all: &[T]) -> Vec<usize> {
    let mut counts: Vec<usize> = all.iter().map(Placed::devices).collect();
    counts.sort_unstable();
    counts.dedup();
    counts
}

/// In the order of their first mention; one device alone mentions none, unless there is nothing else.
fn strategies<T: Placed>(all: &[T]) -> Vec<Strategy> {
    let mut found = Vec::new();
    let several = all.iter().filter(|one| one.devices() > 1);
    for one in several.chain(all.iter().filter(|_| all.iter().all(|one| one.devices() == 1))) {
        if !found.contains(&one.strategy()) {
            found.push(one.strategy());
        }
    }
    found
}

/// The first count's value over this one's, with the same strategy, where both have as many particles; by as much more
/// as this one has more.
fn speed_up(points: &[Point], of: &dyn Fn(&Point) -> Option<f64>, point: &Point) -> Option<f64> {
    // One device counts no work: then the fewest that does.
    let base = counts(points).into_iter().filter_map(|devices| at(points, devices, point.strategy));
    let (value, particles) = base.filter_map(|base| Some((of(base)?, base.particles))).next()?;
    Some(value / of(point)? * (point.particles / particles))
}

const CSV_HEADER: &str = "kind,devices,balance,turns,steps,seconds,seconds_min,seconds_max,ms_per_step,\
    particle_steps_per_s,speed_up,efficiency,waiting,owned_max,work_max,owned_speed_up,work_speed_up,\
    owned_imbalance,work_imbalance,weight_imbalance_after,ghosts_per_owned,own_ms,messages_ms,gpu_ms,gpu_speed_up";

/// `sweep.csv`: a row per count and strategy; blank where a column is not of the row's kind.
pub fn csv(measured: &[Measured], points: &[Point]) -> String {
    let mut text = format!("{CSV_HEADER}\n");
    let optional = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
    for m in measured {
        let [median, least, most] = m.seconds;
        let known = [
            "measured".to_owned(),
            m.devices.to_string(),
            m.strategy.name().to_owned(),
            m.turns.to_string(),
            m.steps.to_string(),
            median.to_string(),
            least.to_string(),
            most.to_string(),
            (1e3 * median / m.steps.max(1) as f64).to_string(),
            m.particle_steps.to_string(),
            m.speed_up.to_string(),
            m.efficiency.to_string(),
            optional(m.waiting),
        ];
        let blank = CSV_HEADER.split(',').count() - known.len();
        text += &format!("{}{}\n", known.join(","), ",".repeat(blank));
    }
    for point in points {
        let fewest = counts(points)[0];
        let faster = speed_up(points, &|p| Some(p.time), point);
        let row = [
            "modelled".to_owned(),
            point.devices.to_string(),
            point.strategy.name().to_owned(),
            String::new(),
            point.steps.to_string(),
            (point.time * point.steps).to_string(),
            String::new(),
            String::new(),
            (1e3 * point.time).to_string(),
            String::new(),
            optional(faster),
            optional(faster.map(|faster| faster * fewest as f64 / point.devices as f64)),
            String::new(),
            optional(point.owned),
            optional(point.work),
            optional(speed_up(points, &|p| p.owned, point)),
            optional(speed_up(points, &|p| p.work, point)),
            optional(point.owned_imbalance),
            optional(point.work_imbalance),
            optional(point.after),
            optional(point.halo),
            (1e3 * point.own).to_string(),
            (1e3 * point.messages).to_string(),
            optional(point.gpu.map(|seconds| 1e3 * seconds)),
            optional(speed_up(points, &|p| p.gpu, point)),
        ];
        text += &format!("{}\n", row.join(","));
    }
    text
}

/// A table of Markdown with aligned columns.
pub(super) fn table(head: &[String], rows: &[Vec<String>]) -> String {
    let width = |column: usize| {
        let cells = std::iter::once(&head[column]).chain(rows.iter().map(|row| &row[column]));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0).max(3)
    };
    let widths: Vec<usize> = (0..head.len()).map(width).collect();
    let line = |cells: &[String]| {
        let padded = cells.iter().zip(&widths).map(|(cell, &width)| format!(" {cell:>width$} |"));
        format!("|{}\n", padded.collect::<String>())
    };
    let rule: Vec<String> = widths.iter().map(|&width| format!("{}:", "-".repeat(width - 1))).collect();
    line(head) + &line(&rule) + &rows.iter().map(|row| line(row)).collect::<String>()
}

/// What a column's head begins with, and its cells.
type Quantity<'a, T> = (&'a str, &'a dyn Fn(&T) -> String);

/// A column for each strategy and quantity.
fn pivot<T: Placed>(all: &[T], quantities: &[Quantity<'_, T>]) -> String {
    let strategies = strategies(all);
    let columns =
        || quantities.iter().flat_map(|quantity| strategies.iter().map(move |strategy| (quantity, *strategy)));
    let mut head = vec!["devices".to_owned()];
    head.extend(columns().map(|((name, _), strategy)| format!("{name}{}", strategy.title())));
    let row = |devices: usize| {
        let cell = |((_, value), strategy): (&Quantity<'_, T>, Strategy)| {
            at(all, devices, strategy).map_or_else(|| "-".to_owned(), *value)
        };
        std::iter::once(devices.to_string()).chain(columns().map(cell)).collect()
    };
    let rows: Vec<Vec<String>> = counts(all).into_iter().map(row).collect();
    table(&head, &rows)
}

fn dash(value: Option<f64>, text: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "-".to_owned(), text)
}

/// With three or four figures.
fn figures(value: f64) -> String {
    match value.abs() {
        v if v >= 100.0 => format!("{value:.0}"),
        v if v >= 10.0 => format!("{value:.1}"),
        v if v >= 1.0 => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}

/// Measured: wall time of the steps, and efficiency.
pub fn measured_table(measured: &[Measured]) -> String {
    pivot(
        measured,
        &[
            ("s, ", &|m| figures(m.seconds[0])),
            ("speed-up, ", &|m| format!("{:.2}", m.speed_up)),
            ("efficiency, ", &|m| format!("{:.0} %", 100.0 * m.efficiency)),
        ],
    )
}

/// Modelled from counts: speed-up of the work alone.
pub fn work_table(points: &[Point]) -> String {
    let owned = |point: &Point| dash(speed_up(points, &|p| p.owned, point), |x| format!("{x:.2}"));
    let work = |point: &Point| dash(speed_up(points, &|p| p.work, point), |x| format!("{x:.2}"));
    let excess = |point: &Point| dash(point.work_imbalance, |x| format!("{x:.3}"));
    pivot(points, &[("owned particles, ", &owned), ("work with halo, ", &work), ("work, fullest over mean, ", &excess)])
}

/// Modelled from times measured alone: the time of the run, and its speed-up; beside it, where there are real runs, what
/// they would have taken for as many steps.
pub fn time_table(points: &[Point], measured: &[Measured]) -> String {
    let faster = |point: &Point| dash(speed_up(points, &|p| Some(p.time), point), |x| format!("{x:.2}"));
    let share = |point: &Point| format!("{:.0} %", 100.0 * point.messages / point.time);
    let seconds = |point: &Point| figures(point.time * point.steps);
    let real = |point: &Point| {
        let run = at(measured, point.devices, point.strategy);
        dash(run.map(|run| run.seconds[0] / run.steps.max(1) as f64 * point.steps), figures)
    };
    let modelled: [Quantity<'_, Point>; 3] = [("s, ", &seconds), ("speed-up, ", &faster), ("of it messages, ", &share)];
    let beside: [Quantity<'_, Point>; 1] = [("measured: s, ", &real)];
    pivot(points, &[&modelled[..], if measured.is_empty() { &[] } else { &beside[..] }].concat())
}

/// Modelled on an assumed GPU.
pub fn gpu_table(points: &[Point]) -> String {
    let faster = |point: &Point| dash(speed_up(points, &|p| p.gpu, point), |x| format!("{x:.2}"));
    let seconds = |point: &Point| dash(point.gpu.map(|seconds| seconds * point.steps), figures);
    pivot(points, &[("s, ", &seconds), ("speed-up, ", &faster)])
}

/// The model beside real runs; `None` if no count was both modelled and measured.
pub fn validation_table(points: &[Point], measured: &[Measured]) -> Option<String> {
    let row = |m: &Measured| {
        let modelled = 1e3 * at(points, m.devices, m.strategy)?.time;
        let found = 1e3 * m.seconds[0] / m.steps.max(1) as f64;
        let strategy = if m.devices == 1 { "-" } else { m.strategy.name() };
        let ratio = format!("{:.2}", modelled / found);
        Some(vec![m.devices.to_string(), strategy.to_owned(), figures(modelled), figures(found), ratio])
    };
    let rows: Vec<Vec<String>> = measured.iter().filter_map(row).collect();
    let head = ["devices", "balance", "modelled, ms per step", "measured, ms per step", "modelled over measured"];
    (!rows.is_empty()).then(|| table(&head.map(str::to_owned), &rows))
}

/// A curve of a chart of speed-ups.
struct Curve {
    name: String,
    points: Vec<[f64; 2]>,
}

fn curves<T: Placed>(all: &[T], name: &str, value: &dyn Fn(&T) -> Option<f64>) -> Vec<Curve> {
    let of = |strategy: Strategy| {
        let point = |devices: usize| Some([devices as f64, value(at(all, devices, strategy)?)?]);
        Curve {
            name: format!("{name}{}", strategy.title()),
            points: counts(all).into_iter().filter_map(point).collect(),
        }
    };
    strategies(all).into_iter().map(of).collect()
}

fn chart(path: &Path, title: &str, counts: &[usize], curves: Vec<Curve>) -> Result<(), OutputError> {
    let fewest = counts.first().copied().unwrap_or(1) as f64;
    let ideal = counts.iter().map(|&devices| [devices as f64, devices as f64 / fewest]).collect();
    let mut series = vec![Series { name: "ideal".into(), points: ideal, dashed: true, colour: PALETTE[6] }];
    let colour = |k: usize| PALETTE[k % (PALETTE.len() - 1)];
    let drawn = curves.into_iter().enumerate();
    series.extend(drawn.map(|(k, Curve { name, points })| Series { name, points, dashed: false, colour: colour(k) }));
    line_chart(path, title, "devices", &format!("speed-up over {fewest}"), &series)
}

/// `sweep.svg`: measured.
///
/// # Errors
/// If it cannot be written.
pub fn measured_chart(path: &Path, scene: &str, measured: &[Measured]) -> Result<(), OutputError> {
    let curves = curves(measured, "", &|m: &Measured| Some(m.speed_up));
    chart(path, &format!("{scene}: speed-up, measured"), &counts(measured), curves)
}

/// `sweep_modelled.svg`: modelled, of the work and of the time.
///
/// # Errors
/// If it cannot be written.
pub fn modelled_chart(path: &Path, scene: &str, points: &[Point]) -> Result<(), OutputError> {
    let mut all = curves(points, "work: ", &|p: &Point| speed_up(points, &|p| p.work, p));
    all.extend(curves(points, "time: ", &|p: &Point| speed_up(points, &|p| Some(p.time), p)));
    chart(path, &format!("{scene}: speed-up, modelled"), &counts(points), all)
}

#[cfg(test)]
mod tests;
