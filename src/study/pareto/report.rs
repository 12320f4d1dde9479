//! What a chart says: `pareto.csv`, the tables and conclusions of `pareto.txt`, and the drawing.

use std::path::Path;

use crate::output::{Group, Mark, OutputError, PALETTE, Scatter, Shape, figure, grouped, scatter_chart};
use crate::scene::Method;
use crate::study::report::table;

use super::front::front;
use super::{Point, Timed, Trials};

/// All that was measured of a case, and what stands on its front.
pub struct Chart<'a> {
    pub name: &'a str,
    pub trials: &'a Trials,
    pub points: Vec<Point>,
    /// Indices of points, by rising cost.
    pub front: Vec<usize>,
    /// Particles that a plan without any wish takes, where that is more than is run here.
    pub unwished_particles: Option<u64>,
    pub adapter: String,
    pub command: String,
    pub seeds: u32,
}

/// The indices of the points that no other setting within its limits beats.
pub fn front_of(points: &[Point]) -> Vec<usize> {
    let places: Vec<[f64; 2]> =
        points.iter().map(|point| point.place().filter(|_| !point.beyond).unwrap_or([f64::NAN; 2])).collect();
    front(&places)
}

const HEADER: [&str; 23] = [
    "method",
    "particles",
    "occupancy",
    "step",
    "rounds",
    "error",
    "error_se",
    "error_of_mean",
    "seconds",
    "seconds_min",
    "seconds_max",
    "timed",
    "seeds",
    "steps",
    "particle_steps",
    "lost",
    "warnings",
    "beyond_limits",
    "front",
    "default",
    "step_asked",
    "trouble",
    "warning_texts",
];

impl Chart<'_> {
    /// A row per setting; blank where there is no number.
    ///
    /// # Errors
    /// If a text does not fit a table: never.
    pub fn csv(&self) -> Result<String, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(HEADER)?;
        let optional = |value: Option<f64>| value.map(|value| value.to_string()).unwrap_or_default();
        for (index, point) in self.points.iter().enumerate() {
            let [seconds, least, most] = point.cost().map_or([None; 3], |cost| cost.map(Some));
            writer.write_record([
                point.method.name().to_owned(),
                point.particles.to_string(),
                point.occupancy.to_string(),
                point.step.to_string(),
                point.rounds.to_string(),
                optional(point.error()),
                optional(point.standard_error()),
                optional(point.error_of_mean),
                optional(seconds),
                optional(least),
                optional(most),
                point.timed.name().to_owned(),
                point.seconds.len().to_string(),
                point.steps.to_string(),
                point.particle_steps.to_string(),
                optional(point.lost),
                point.warnings.len().to_string(),
                u8::from(point.beyond).to_string(),
                u8::from(self.front.contains(&index)).to_string(),
                u8::from(point.unwished).to_string(),
                optional(point.setting.step),
                point.trouble.clone().unwrap_or_default(),
                point.warnings.join("; "),
            ])?;
        }
        let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// # Errors
    /// If the file cannot be written.
    pub fn draw(&self, path: &Path) -> Result<(), OutputError> {
        let logarithm = |point: &Point| (point.particles.max(1) as f64).ln();
        let drawn = || self.points.iter().filter(|point| point.place().is_some());
        let low = drawn().map(logarithm).fold(f64::INFINITY, f64::min);
        let high = drawn().map(logarithm).fold(f64::NEG_INFINITY, f64::max);
        let size = |point: &Point| if high > low { (logarithm(point) - low) / (high - low) } else { 0.5 };
        let mark = |point: &Point| {
            let place = point.place()?;
            Some(Mark { place, bar: point.standard_error(), size: size(point), hollow: point.beyond })
        };
        let groups = self.methods().into_iter().map(|method| {
            let (colour, shape) = style(method);
            let marks = self.points.iter().filter(|point| point.method == method).filter_map(mark).collect();
            Group { name: method.name().to_owned(), colour, shape, marks }
        });
        let timed = match drawn().map(|point| point.timed).find(|timed| *timed != Timed::Device) {
            Some(_) => "time from submission to done, s",
            None => "device time, s",
        };
        let bars = if self.seeds > 1 { "; bars: standard error of the mean" } else { "" };
        let mut notes =
            vec![format!("larger: more particles; hollow: beyond the limits of its method, not on the front{bars}")];
        if let Some(particles) = self.unwished_particles {
            notes.push(format!(
                "the default takes {} particles; shown: the same with {}",
                grouped(particles),
                grouped(self.trials.most_particles)
            ));
        }
        let defaults = self.points.iter().filter(|point| point.unwished);
        let scatter = Scatter {
            title: format!("{}: error against cost ({})", self.name, self.adapter),
            x_label: timed.to_owned(),
            y_label: self.trials.error.clone(),
            groups: groups.collect(),
            front: self.front.iter().filter_map(|&index| self.points[index].place()).collect(),
            ringed: defaults.filter_map(Point::place).collect(),
            ring_name: "the default".to_owned(),
            notes,
        };
        scatter_chart(path, &scatter)
    }

    /// The methods with a point, in the order of the first.
    fn methods(&self) -> Vec<Method> {
        let mut found = Vec::new();
        for point in self.points.iter().filter(|point| point.place().is_some()) {
            if !found.contains(&point.method) {
                found.push(point.method);
            }
        }
        found
    }

    /// The tables and what they say.
    pub fn text(&self) -> String {
        let seeds = if self.seeds > 1 {
            format!("{} seeds each: mean and standard error, median of the seconds", self.seeds)
        } else {
            "one seed each".to_owned()
        };
        let mut text = format!(
            "# {}: error against cost\n\n{}\n\n{} settings on {}, {seeds}. `{}`\n",
            self.name,
            self.trials.about,
            self.points.len(),
            self.adapter,
            self.command
        );
        text += "\n## The front\n\nNo setting within the limits of its method has less error at no more cost.\n\n";
        text += &self.rows(&self.front);
        let levels = self.levels();
        if !levels.is_empty() {
            text += "\n## Seconds for an error\n\nOf the cheapest setting within its limits that has at most this error.\n\n";
            text += &self.levels_table(&levels);
        }
        text += &self.means();
        text += "\n## What follows\n\n";
        for line in self.conclusions(&levels) {
            text += &format!("- {line}\n");
        }
        let failed: Vec<usize> = (0..self.points.len()).filter(|&k| self.points[k].trouble.is_some()).collect();
        if !failed.is_empty() {
            text += "\n## Without an error\n\n";
            for index in failed {
                let point = &self.points[index];
                text += &format!("- {}: {}\n", described(point), point.trouble.as_deref().unwrap_or_default());
            }
        }
        text
    }

    fn rows(&self, indices: &[usize]) -> String {
        let head = ["seconds", "error", "std error", "method", "particles", "f", "x", "rounds", "lost", "warnings"];
        let row = |&index: &usize| {
            let point = &self.points[index];
            let number = |value: f64| if value > 0.0 { figure(value, 3) } else { "-".to_owned() };
            vec![
                point.cost().map_or_else(|| "-".to_owned(), |[median, ..]| figure(median, 3)),
                point.error().map_or_else(|| "-".to_owned(), |error| figure(error, 3)),
                point.standard_error().map_or_else(|| "-".to_owned(), |error| figure(error, 3)),
                point.method.name().to_owned() + if point.unwished { " (default)" } else { "" },
                grouped(point.particles),
                number(point.occupancy),
                number(point.step),
                if point.rounds > 0 { point.rounds.to_string() } else { "-".to_owned() },
                point.lost.map_or_else(|| "-".to_owned(), |lost| format!("{:.1} %", 100.0 * lost)),
                point.warnings.len().to_string(),
            ]
        };
        table(&head.map(str::to_owned), &indices.iter().map(row).collect::<Vec<_>>())
    }

    /// The front of each method by the error of the mean over the seeds and the seconds of all seeds; empty with one seed.
    fn means(&self) -> String {
        let place = |point: &Point| Some([point.seconds.iter().sum(), point.error_of_mean.filter(|_| !point.beyond)?]);
        let front_of_method = |method: Method| {
            let own = |point: &Point| place(point).filter(|_| point.method == method).unwrap_or([f64::NAN; 2]);
            front(&self.points.iter().map(own).collect::<Vec<_>>())
        };
        let row = |index: usize| {
            let point = &self.points[index];
            let figure = |value: f64| figure(value, 3);
            let [seconds, error] = place(point)?;
            Some(vec![figure(seconds), figure(error), described(point)])
        };
        let rows: Vec<Vec<String>> = self.methods().into_iter().flat_map(front_of_method).filter_map(row).collect();
        if rows.is_empty() {
            return String::new();
        }
        format!(
            "\n## The mean of the {} seeds\n\nError of the mean, and seconds of all seeds together: the front of each \
             method.\n\n{}",
            self.seeds,
            table(&["seconds", "error", "setting"].map(str::to_owned), &rows)
        )
    }

    /// Round errors between the least and the largest of the front.
    fn levels(&self) -> Vec<f64> {
        let errors: Vec<f64> = self.front.iter().filter_map(|&index| self.points[index].error()).collect();
        let (Some(least), Some(most)) =
            (errors.iter().copied().reduce(f64::min), errors.iter().copied().reduce(f64::max))
        else {
            return Vec::new();
        };
        round_numbers(least, most)
    }

    /// The cheapest setting within its limits that has at most this error, of one method or of all.
    fn cheapest(&self, error: f64, method: Option<Method>) -> Option<&Point> {
        let good = self.points.iter().filter(|point| {
            !point.beyond
                && method.is_none_or(|method| point.method == method)
                && point.place().is_some_and(|[_, own]| own <= error)
        });
        let seconds = |point: &Point| point.place().map_or(f64::INFINITY, |[seconds, _]| seconds);
        good.min_by(|a, b| seconds(a).total_cmp(&seconds(b)))
    }

    fn levels_table(&self, levels: &[f64]) -> String {
        let methods = self.methods();
        let head: Vec<String> = std::iter::once("error at most".to_owned())
            .chain(methods.iter().map(|method| method.name().to_owned()))
            .collect();
        let row = |&level: &f64| {
            let cell = |method: &Method| {
                let place = self.cheapest(level, Some(*method)).and_then(Point::place);
                place.map_or_else(|| "-".to_owned(), |[seconds, _]| figure(seconds, 3))
            };
            std::iter::once(short(level)).chain(methods.iter().map(cell)).collect()
        };
        table(&head, &levels.iter().map(row).collect::<Vec<_>>())
    }

    fn conclusions(&self, levels: &[f64]) -> Vec<String> {
        let mut lines = Vec::new();
        let winners: Vec<(f64, &Point)> =
            levels.iter().filter_map(|&level| Some((level, self.cheapest(level, None)?))).collect();
        // Neighbouring levels that one method wins make one line; it tells of the least error.
        for run in winners.chunk_by(|a, b| a.1.method == b.1.method) {
            let ((most, _), (least, best)) = (run[0], run[run.len() - 1]);
            let range = if most > least {
                format!("errors from {} down to {} are", short(most), short(least))
            } else {
                format!("an error of {} is", short(least))
            };
            let others = self.methods().into_iter().filter(|method| *method != best.method);
            let next = others.filter_map(|method| self.cheapest(least, Some(method)));
            let seconds = |point: &Point| point.place().map_or(f64::INFINITY, |[seconds, _]| seconds);
            let next = next.min_by(|a, b| seconds(a).total_cmp(&seconds(b)));
            let margin = match (next.and_then(Point::place), best.place()) {
                (Some([other, _]), Some([own, _])) => format!(
                    "; `{}` takes {} times as long for it",
                    next.map_or("", |point| point.method.name()),
                    figure(other / own, 3)
                ),
                _ => "; no other method gets there within these ranges".to_owned(),
            };
            let last = if most > least { ", for the least of them by" } else { ", by" };
            let name = best.method.name();
            lines.push(format!("{range} cheapest with `{name}`{last} {}{margin}", described(best)));
        }
        for method in self.methods() {
            let best = |beyond: bool| {
                let own = self.points.iter().filter(|point| point.method == method && point.beyond == beyond);
                own.filter_map(|point| Some((point, point.error()?))).min_by(|a, b| a.1.total_cmp(&b.1))
            };
            match (best(false), best(true)) {
                (Some((point, error)), _) => {
                    lines.push(format!(
                        "the least error of `{}` is {}, by {}",
                        method.name(),
                        figure(error, 3),
                        described(point)
                    ));
                }
                (None, Some((point, error))) => lines.push(format!(
                    "all settings of `{}` are beyond its limits; their least error is {}, by {}",
                    method.name(),
                    figure(error, 3),
                    described(point)
                )),
                (None, None) => {}
            }
        }
        lines.extend(self.points.iter().filter(|point| point.unwished).filter_map(|point| self.about_default(point)));
        let beyond = self.points.iter().filter(|point| point.beyond).count();
        if beyond > 0 {
            let are = if beyond == 1 { "setting is" } else { "settings are" };
            lines.push(format!(
                "{beyond} {are} beyond the limits of the method: a step too long for its rounds or for a cell, more than 3 % of \
                 the collisions lost, or an audit that failed"
            ));
        }
        if self.points.iter().any(|point| point.timed == Timed::Host) {
            lines.push(
                "`control-volume` is the reference itself: no error by definition, and no device time".to_owned(),
            );
        }
        if self.seeds == 1 {
            lines.push(
                "one seed: noise has no error bar, and orders points that differ by less than it; see --repeat".into(),
            );
        }
        lines
    }

    fn about_default(&self, point: &Point) -> Option<String> {
        let [seconds, error] = point.place()?;
        let share = self
            .cheapest(error, None)
            .filter(|other| *other != point)
            .and_then(|other| Some((other, other.place()?[0])))
            .map_or_else(
                || "nothing as good is cheaper".to_owned(),
                |(other, own)| format!("{} does it in {} of the time", described(other), figure(own / seconds, 3)),
            );
        let taken = self.unwished_particles.map_or_else(String::new, |particles| {
            format!(", where a plan without any wish takes {} particles, more than is run here", grouped(particles))
        });
        let bar = point.standard_error().map_or_else(String::new, |bar| format!(" +- {}", figure(bar, 3)));
        Some(format!(
            "the default is {}{taken}: error {}{bar} in {} s; {share}",
            described(point),
            figure(error, 3),
            figure(seconds, 3)
        ))
    }
}

/// A setting in words.
fn described(point: &Point) -> String {
    let mut words = Vec::new();
    if point.particles > 0 {
        words.push(format!("N = {}", grouped(point.particles)));
    }
    if point.occupancy > 0.0 {
        words.push(format!("f = {}", figure(point.occupancy, 3)));
    }
    // (Of a gas without diameters it is no number of collisions.)
    if point.step > 0.0 && point.method != Method::HalfTurn {
        words.push(format!("x = {}", figure(point.step, 3)));
    }
    if point.rounds > 0 {
        words.push(format!("R = {}", point.rounds));
    }
    let name = format!("`{}`", point.method.name());
    if words.is_empty() { name } else { format!("{name} ({})", words.join(", ")) }
}

fn style(method: Method) -> ([u8; 3], Shape) {
    match method {
        Method::ClosestApproach => (PALETTE[0], Shape::Circle),
        Method::Cell => (PALETTE[1], Shape::Square),
        Method::HardSphere => (PALETTE[2], Shape::Triangle),
        Method::HalfTurn => (PALETTE[4], Shape::Diamond),
        Method::None => (PALETTE[3], Shape::Diamond),
        Method::ControlVolume => (PALETTE[6], Shape::Cross),
    }
}

/// 1, 2 and 5 times powers of ten from `most` down to `least`, and the next above both.
fn round_numbers(least: f64, most: f64) -> Vec<f64> {
    if !(least > 0.0 && most.is_finite()) {
        return Vec::new();
    }
    let exponents = (least.log10().floor() as i32..=most.log10().ceil() as i32).rev();
    let all = exponents.flat_map(|exponent| [5.0, 2.0, 1.0].map(|factor| factor * 10f64.powi(exponent)));
    all.filter(|level| *level >= least && *level < 2.5 * most).collect()
}

/// A round number as short as it can be.
fn short(value: f64) -> String {
    let decimals = (-value.log10().floor()).clamp(0.0, 12.0) as usize;
    format!("{value:.decimals$}")
}
