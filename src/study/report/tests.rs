use super::*;

fn measured(devices: usize, strategy: Strategy, seconds: f64, efficiency: f64) -> Measured {
    Measured {
        devices,
        strategy,
        seconds: [seconds, 0.9 * seconds, 1.1 * seconds],
        turns: 3,
        steps: 100,
        particle_steps: 1e6,
        efficiency,
        speed_up: efficiency * devices as f64,
        waiting: None,
    }
}

fn point(devices: usize, strategy: Strategy, work: Option<f64>, time: f64) -> Point {
    Point {
        devices,
        strategy,
        steps: 1000.0,
        particles: 5e5,
        owned: work.map(|work| 0.8 * work),
        work,
        halo: work.map(|_| 0.25),
        owned_imbalance: work.map(|_| 1.1),
        work_imbalance: work.map(|_| 1.2),
        after: None,
        own: 0.75 * time,
        messages: 0.25 * time,
        time,
        gpu: work.map(|work| 1e-9 * work),
    }
}

#[test]
fn the_measured_table_has_the_form_of_the_published_one() {
    let all = [
        measured(1, Strategy::Off, 8.0, 1.0),
        measured(2, Strategy::Off, 6.0, 0.667),
        measured(2, Strategy::Dynamic, 4.4, 0.909),
    ];
    let text = measured_table(&all);
    let rows: Vec<Vec<&str>> =
        text.lines().map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect();
    assert_eq!(
        rows[0],
        [
            "devices",
            "s, static, equal boxes",
            "s, dynamic RCB",
            "speed-up, static, equal boxes",
            "speed-up, dynamic RCB",
            "efficiency, static, equal boxes",
            "efficiency, dynamic RCB"
        ]
    );
    assert_eq!(rows[2], ["1", "8.00", "8.00", "1.00", "1.00", "100 %", "100 %"]);
    assert_eq!(rows[3], ["2", "6.00", "4.40", "1.33", "1.82", "67 %", "91 %"]);
    assert!(text.lines().all(|line| line.chars().count() == text.lines().next().unwrap().chars().count()));
}

#[test]
fn modelled_speed_ups_are_over_the_fewest_devices_of_the_strategy() {
    let all = [
        point(12, Strategy::Off, Some(600.0), 0.6),
        point(12, Strategy::Dynamic, Some(500.0), 0.5),
        point(24, Strategy::Off, Some(400.0), 0.4),
        point(24, Strategy::Dynamic, Some(250.0), 0.4),
    ];
    let work = work_table(&all);
    let last: Vec<&str> = work.lines().last().unwrap().split('|').map(str::trim).collect();
    assert_eq!(last[1..8], ["24", "1.50", "2.00", "1.50", "2.00", "1.200", "1.200"]);
    let time = time_table(&all, &[]);
    let last: Vec<&str> = time.lines().last().unwrap().split('|').map(str::trim).collect();
    assert_eq!(last[1..8], ["24", "400", "400", "1.50", "1.25", "25 %", "25 %"]);
    assert!(gpu_table(&all).contains("2.00"));
    // Real runs stand beside, for as many steps.
    let time = time_table(&all, &[measured(24, Strategy::Dynamic, 43.0, 1.0)]);
    let last: Vec<&str> = time.lines().last().unwrap().split('|').map(str::trim).collect();
    assert_eq!(last[7..10], ["25 %", "-", "430"], "{time}");
    // Twice the particles in the same time are twice as fast.
    let mut weak = all;
    weak[2..].iter_mut().for_each(|point| point.particles *= 2.0);
    assert_eq!(speed_up(&weak, &|p| p.work, &weak[3]), Some(4.0));
    // A count without work is no base for it.
    let mut with_one = vec![point(1, Strategy::Off, None, 5.0)];
    with_one.extend(all);
    assert_eq!(speed_up(&with_one, &|p| p.work, &all[3]), Some(2.0));
    assert_eq!(speed_up(&with_one, &|p| Some(p.time), &all[3]), Some(12.5));
    assert!(work_table(&with_one).lines().nth(2).unwrap().contains(" - "));
}

#[test]
fn every_row_of_the_csv_has_its_columns_and_says_whether_it_is_measured() {
    let text = csv(
        &[measured(1, Strategy::Off, 8.0, 1.0)],
        &[point(12, Strategy::Off, Some(600.0), 0.6), point(24, Strategy::Off, Some(400.0), 0.4)],
    );
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    assert!(rows.iter().all(|row| row.len() == rows[0].len()), "{text}");
    let value = |row: usize, name: &str| {
        rows[row][rows[0].iter().position(|head| *head == name).unwrap_or_else(|| panic!("{name}"))]
    };
    assert_eq!((value(1, "kind"), value(1, "seconds"), value(1, "ms_per_step")), ("measured", "8", "80"));
    assert_eq!((value(1, "work_max"), value(2, "work_max"), value(2, "turns")), ("", "600", ""));
    assert_eq!((value(3, "kind"), value(3, "work_speed_up"), value(3, "owned_speed_up")), ("modelled", "1.5", "1.5"));
    assert!((value(3, "efficiency").parse::<f64>().unwrap() - 0.75).abs() < 1e-12);
    let number = |name| value(3, name).parse::<f64>().unwrap();
    for (name, expected) in [("own_ms", 300.0), ("messages_ms", 100.0), ("seconds", 400.0)] {
        assert!((number(name) / expected - 1.0).abs() < 1e-12, "{name} {}", number(name));
    }
}

#[test]
fn the_model_stands_beside_the_runs_that_it_is_of() {
    let points = [point(1, Strategy::Off, None, 0.08), point(2, Strategy::Dynamic, Some(1.0), 0.05)];
    let runs = [measured(1, Strategy::Off, 8.0, 1.0), measured(2, Strategy::Dynamic, 4.0, 1.0)];
    let text = validation_table(&points, &runs).unwrap();
    let last: Vec<&str> = text.lines().last().unwrap().split('|').map(str::trim).collect();
    assert_eq!(last[1..6], ["2", "dynamic", "50.0", "40.0", "1.25"]);
    assert_eq!(text.lines().count(), 4);
    assert_eq!(validation_table(&points, &[measured(4, Strategy::Off, 1.0, 1.0)]), None);
}

#[test]
fn the_charts_say_what_is_measured_and_what_is_modelled() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("sweep.svg");
    measured_chart(&path, "Tank", &[measured(1, Strategy::Off, 8.0, 1.0), measured(2, Strategy::Off, 6.0, 0.6)])
        .unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(["Tank: speed-up, measured", "ideal", "static, equal boxes"].iter().all(|part| text.contains(part)));
    let points = [point(12, Strategy::Dynamic, Some(2.0), 0.2), point(24, Strategy::Dynamic, Some(1.0), 0.15)];
    modelled_chart(&path, "Tank", &points).unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(["modelled", "work: dynamic RCB", "time: dynamic RCB"].iter().all(|part| text.contains(part)));
}
