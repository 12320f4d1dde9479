//! The line charts of a page: which columns, in which colours, dashes and marks, and in words for those who cannot see them.
//!
//! Whose a line is shows in its colour and the shape of its marks, what it stands for in its dashes: each line can be told
//! without colours.

use serde::Serialize;

use super::super::history::History;
use super::columns::{Meaning, Role, charts};

/// More lines of a chart are there, but off at first.
const MOST_ON: usize = 12;

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Figure {
    pub id: String,
    pub title: String,
    /// What a screen reader says.
    pub alt: String,
    pub curves: Vec<Curve>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Curve {
    /// Index of the series on the page, and of the column in it.
    pub series: usize,
    pub column: usize,
    pub label: String,
    pub colour: usize,
    pub dash: &'static str,
    /// Of the marks.
    pub shape: usize,
    pub on: bool,
}

const DASHES: [&str; 4] = ["solid", "dot", "dashdot", "longdash"];

/// Each column of a run in the chart of its quantity.
pub fn of_run(history: &History, meanings: &[Meaning], axis: usize) -> Vec<Figure> {
    charts(meanings, axis)
        .into_iter()
        .map(|group| {
            let mut owners: Vec<&str> = Vec::new();
            let mut components: Vec<&str> = Vec::new();
            let mut curves = Vec::new();
            for &column in &group {
                let meaning = &meanings[column];
                let owner = place(&mut owners, &meaning.owner);
                let component = place(&mut components, &meaning.component);
                curves.push(Curve {
                    series: 0,
                    column,
                    label: meaning.label(),
                    colour: owner,
                    dash: dash(meaning.role, component),
                    shape: owner,
                    on: curves.len() < MOST_ON,
                });
            }
            let spans = group.iter().map(|&column| span(history, meanings, column));
            Figure::new(&meanings[group[0]], "", curves, spans.collect())
        })
        .collect()
}

/// The columns of several runs over each other, a chart for each quantity of each owner. The first has the references.
pub fn of_runs(runs: &[(&History, &[Meaning])], axis: usize) -> Vec<Figure> {
    let (first, meanings) = runs[0];
    let mut figures: Vec<Figure> = Vec::new();
    for group in charts(meanings, axis) {
        let mut owners: Vec<&str> = Vec::new();
        for &column in &group {
            place(&mut owners, &meanings[column].owner);
        }
        for owner in owners {
            let (mut curves, mut spans) = (Vec::new(), Vec::new());
            for &column in group.iter().filter(|&&column| meanings[column].owner == owner) {
                let meaning = &meanings[column];
                let component = group.iter().filter(|&&other| other < column && meanings[other].owner == owner).count();
                let wanted = if meaning.role == Role::Computed { runs.len() } else { 1 };
                for (series, (history, _)) in runs.iter().enumerate().take(wanted) {
                    let head = &first.headers()[column];
                    let Some(own) = history.headers().iter().position(|other| other == head) else { continue };
                    let label =
                        if wanted == 1 { meaning.label() } else { format!("{}: {}", series + 1, meaning.label()) };
                    let dash = dash(meaning.role, if meaning.component.is_empty() { 0 } else { component });
                    curves.push(Curve {
                        series,
                        column: own,
                        label,
                        colour: series,
                        dash,
                        shape: series,
                        on: curves.len() < MOST_ON,
                    });
                    spans.push(span(history, runs[series].1, own));
                }
            }
            let of = if owner.is_empty() { String::new() } else { format!("{owner}: ") };
            figures.push(Figure::new(&meanings[group[0]], &of, curves, spans));
        }
    }
    figures
}

impl Figure {
    /// `of`: whose, before the title.
    pub fn new(meaning: &Meaning, of: &str, curves: Vec<Curve>, spans: Vec<String>) -> Figure {
        let title = format!("{of}{}", meaning.title());
        let told = curves.iter().zip(&spans).map(|(curve, span)| format!("{} {span}", curve.label));
        let alt = format!("Line chart of {title} against time. {}.", told.collect::<Vec<_>>().join("; "));
        let letters = format!("{of}{}", meaning.quantity).to_lowercase();
        let id = letters.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect();
        Figure { id, title, alt, curves }
    }
}

fn place<'a>(known: &mut Vec<&'a str>, name: &'a str) -> usize {
    known.iter().position(|one| *one == name).unwrap_or_else(|| {
        known.push(name);
        known.len() - 1
    })
}

fn dash(role: Role, component: usize) -> &'static str {
    match role {
        Role::Computed => DASHES[component % DASHES.len()],
        Role::Reference | Role::Wanted => "dash",
    }
}

/// In words: from the least to the largest value.
fn span(history: &History, meanings: &[Meaning], column: usize) -> String {
    let values = history.rows().iter().map(|row| row[column]).filter(|value| value.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if low > high {
        return "without values".to_owned();
    }
    let factor = meanings[column].unit.factor;
    format!("from {:.4e} to {:.4e}", low / factor, high / factor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Column;
    use crate::scene::UnitSystem;

    fn run(owners: &[&str]) -> (History, Vec<Meaning>) {
        let mut columns = vec![Column::new("time", "s")];
        for owner in owners {
            for name in ["pressure", "reference_pressure"] {
                columns.push(Column::new(format!("{owner}:{name}"), "pa"));
            }
            columns.extend(["x", "y"].map(|axis| Column::new(format!("{owner}:velocity_{axis}"), "m_s")));
        }
        let mut history = History::new(&columns).unwrap();
        let rows = [1.0, 2.0].map(|time| vec![time; columns.len()]);
        rows.iter().for_each(|row| history.push(row).unwrap());
        let meanings = history.headers().iter().map(|head| Meaning::of(head, UnitSystem::Si)).collect();
        (history, meanings)
    }

    /// No two lines of a chart have the same colour and dashes, or the same marks and dashes.
    #[test]
    fn lines_can_be_told_apart_without_their_colours() {
        let (history, meanings) = run(&["a", "b", "c"]);
        let figures = of_run(&history, &meanings, 0);
        assert_eq!(
            figures.iter().map(|figure| figure.title.as_str()).collect::<Vec<_>>(),
            ["Pressure, Pa", "Velocity, m/s"]
        );
        for figure in &figures {
            let looks: std::collections::HashSet<_> =
                figure.curves.iter().map(|curve| (curve.shape, curve.dash)).collect();
            assert_eq!((figure.curves.len(), looks.len()), (6, 6));
        }
        assert!(figures[0].alt.contains("a, control volume from 1.0000e0 to 2.0000e0"), "{}", figures[0].alt);
    }

    #[test]
    fn runs_lie_over_each_other_and_what_one_lacks_is_left_out() {
        let (one, other) = (run(&["a", "b"]), run(&["a"]));
        let figures = of_runs(&[(&one.0, &one.1), (&other.0, &other.1)], 0);
        let labels = |k: usize| figures[k].curves.iter().map(|curve| curve.label.as_str()).collect::<Vec<_>>();
        assert_eq!(figures[0].title, "a: Pressure, Pa");
        assert_eq!(labels(0), ["1: a", "2: a", "a, control volume"]);
        assert_eq!(labels(1), ["1: b", "b, control volume"]);
        let velocity = figures.iter().find(|figure| figure.title == "a: Velocity, m/s").unwrap();
        assert_eq!(
            velocity.curves.iter().map(|curve| (curve.colour, curve.dash)).collect::<Vec<_>>(),
            [(0, "solid"), (1, "solid"), (0, "dot"), (1, "dot")]
        );
    }
}
