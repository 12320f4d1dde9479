//! Cases can be planned, seeds differ in nothing else, and a report says what its numbers say.

use super::report::{Chart, front_of};
use super::*;
use crate::scene::Method;

/// The settings of every case can be planned, the corners of every method's widest ranges and of the narrowest at least: none is charted as a failure
/// that is none of the method's.
#[test]
fn the_settings_of_every_case_have_plans() {
    for case in CASES {
        for extent in [Extent::Quick, Extent::Full] {
            let trials = (case.trials)(extent).unwrap();
            assert!(trials.methods().len() >= 3, "{}", case.name);
            for method in trials.methods() {
                let own: Vec<&Setting> = trials.settings.iter().filter(|own| own.method == Some(method)).collect();
                for setting in [own[0], own[own.len() - 1]] {
                    if let Err(error) = (trials.model)(setting, 0) {
                        panic!("{}: {setting}: {error}", case.name);
                    }
                    assert!(setting.particles.is_none_or(|particles| particles <= trials.most_particles));
                }
            }
            trials.unwished().unwrap();
        }
    }
}

/// Seeds differ, and nothing else does.
#[test]
fn another_seed_is_another_sample_of_the_same_plan() {
    for case in CASES {
        let trials = (case.trials)(Extent::Quick).unwrap();
        let of_seed = |seed| (trials.model)(&trials.settings[0], seed).unwrap().plan;
        let (first, mut third) = (of_seed(0), of_seed(2));
        assert_eq!(third.seed, first.seed + 2, "{}", case.name);
        third.seed = first.seed;
        assert_eq!(third, first, "{}", case.name);
    }
}

fn point(method: Method, particles: u64, seconds: f64, errors: &[f64]) -> Point {
    let setting = Setting { method: Some(method), particles: Some(particles), step: Some(0.3), ..Setting::default() };
    Point { errors: errors.to_vec(), seconds: vec![seconds; errors.len().max(1)], ..Point::new(&setting, None, None) }
}

fn report(points: Vec<Point>, seeds: u32, check: impl Fn(&Chart<'_>)) {
    let trials = sod::trials(Extent::Quick).unwrap();
    check(&Chart {
        name: "sod",
        trials: &trials,
        front: front_of(&points),
        points,
        unwished_particles: Some(14_932),
        adapter: "a device".into(),
        command: "corpuscle pareto sod".into(),
        seeds,
    });
}

/// Of hand-made numbers: `cell` is the cheapest down to .05, closest approach below; what is beyond its limits beats all and
/// is not on the front, nor is what has no error.
#[test]
fn a_report_says_what_its_numbers_say() {
    let points = vec![
        point(Method::Cell, 1000, 1.0, &[0.09]),
        point(Method::Cell, 4000, 2.0, &[0.045]),
        point(Method::ClosestApproach, 4000, 8.0, &[0.04]),
        point(Method::ClosestApproach, 16_000, 16.0, &[0.018]),
        Point { beyond: true, ..point(Method::HardSphere, 1000, 0.1, &[0.001]) },
        Point { trouble: Some("no plan".into()), ..point(Method::None, 1000, 0.1, &[]) },
        Point { setting: Setting::default(), unwished: true, ..point(Method::ClosestApproach, 4000, 10.0, &[0.045]) },
    ];
    report(points, 1, |chart| {
        assert_eq!(chart.front, [0, 1, 2, 3]);
        let text = chart.text();
        for part in [
            "errors from 0.2 down to 0.05 are cheapest with `cell`, for the least of them by `cell` (N = 4,000)",
            "`closest-approach` takes 4.00 times as long for it",
            "an error of 0.02 is cheapest with `closest-approach`, by `closest-approach` (N = 16,000); no other method",
            "all settings of `hard-sphere` are beyond its limits; their least error is 0.00100",
            "14,932 particles, more than is run here: error 0.0450 in 10.0 s; `cell` (N = 4,000) does it in 0.200 of the time",
            "1 setting is beyond",
            "one seed",
            "`none` (N = 1,000): no plan",
        ] {
            assert!(text.contains(part), "{part}:\n{text}");
        }
        let table = chart.csv().unwrap();
        assert_eq!(table.lines().count(), 8);
        let widths: Vec<usize> = table.lines().map(|line| line.split(',').count()).collect();
        assert!(widths.iter().all(|width| *width == widths[0]), "{table}");
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("pareto.svg");
        chart.draw(&path).unwrap();
        let svg = std::fs::read_to_string(path).unwrap();
        assert!(svg.contains("the default takes 14,932 particles") && !svg.contains("bars:"));
    });
}

/// Several seeds have their standard error; without any point there is still a report.
#[test]
fn a_report_has_error_bars_and_may_be_empty() {
    let two = Point { error_of_mean: Some(0.07), ..point(Method::Cell, 1000, 1.5, &[0.08, 0.1]) };
    report(vec![two], 2, |chart| {
        let text = chart.text();
        // Of both seeds together.
        assert!(text.contains("The mean of the 2 seeds") && text.contains("0.0700") && text.contains("3.00"), "{text}");
        // sd .01414, over sqrt 2.
        assert!(text.contains("2 seeds each") && text.contains("0.0100") && !text.contains("one seed"), "{text}");
    });
    report(Vec::new(), 1, |chart| {
        assert!(chart.text().contains("0 settings") && chart.front.is_empty());
    });
}
