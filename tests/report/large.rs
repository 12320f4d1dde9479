//! What the page of a long run of many particles weighs, and how long it takes to make.

use std::path::Path;
use std::time::Instant;

use corpuscle::output::{Column, History, ParticleRow, SnapshotWriter};

use super::{ROOT, reported};

/// Of the page.
const MOST_BYTES: u64 = 25_000_000;
const MOST_SECONDS: f64 = 20.0;

/// A history of `columns` columns by `rows` rows and snapshots, beside the scene of a box.
fn folder(out: &Path, columns: usize, rows: usize, snapshots: u32, particles: u32) {
    std::fs::copy(Path::new(ROOT).join("scenes/box.toml"), out.join("scene.toml")).unwrap();
    let names = (1..columns).map(|k| Column::new(format!("probe {}:pressure", k), "pa"));
    let columns: Vec<Column> = std::iter::once(Column::new("time", "s")).chain(names).collect();
    let mut history = History::new(&columns).unwrap();
    for row in 0..rows {
        let time = row as f64 / rows as f64;
        let values =
            (1..columns.len()).map(|k| 1e5 * (1.0 + (time * k as f64).sin() + 0.01 * (row as f64 * 1.7).cos()));
        history.push(&std::iter::once(time).chain(values).collect::<Vec<f64>>()).unwrap();
    }
    history.write_csv(&out.join("history.csv")).unwrap();
    let mut writer = SnapshotWriter::create(out).unwrap().naming(["argon".to_owned()]);
    let scattered = |id: u32, by: u32| f64::from(id.wrapping_mul(by) ^ (id >> 7)) / f64::from(u32::MAX);
    for snapshot in 0..snapshots {
        let particles: Vec<ParticleRow> = (0..particles)
            .map(|id| {
                let moved = id.wrapping_add(snapshot.wrapping_mul(977));
                let position = [2_654_435_761, 2_246_822_519, 3_266_489_917].map(|by| 0.2 * scattered(moved, by));
                let velocity = position.map(|x| (5000.0 * x - 500.0) as f32);
                ParticleRow { id, gas: 0, position, velocity, spin_energy: 0.0 }
            })
            .collect();
        writer.write(f64::from(snapshot), &particles).unwrap();
    }
}

fn measured(columns: usize, rows: usize, snapshots: u32, particles: u32) -> (u64, f64, String) {
    let dir = tempfile::tempdir().unwrap();
    folder(dir.path(), columns, rows, snapshots, particles);
    let since = Instant::now();
    let path = reported(&[dir.path().to_str().unwrap()]);
    let seconds = since.elapsed().as_secs_f64();
    (std::fs::metadata(&path).unwrap().len(), seconds, std::fs::read_to_string(path).unwrap())
}

/// `cargo test --release --locked --test report -- --ignored --nocapture large` prints the figures; 1.2 GB of snapshots.
#[test]
#[ignore = "writes and reads 1.2 GB"]
fn a_large_run_has_a_small_page() {
    let (bytes, seconds, html) = measured(50, 10_000, 20, 1_000_000);
    println!(
        "50 columns x 10,000 rows, 20 snapshots of 1,000,000 particles: {:.1} MB in {seconds:.1} s",
        1e-6 * bytes as f64
    );
    assert!(bytes < MOST_BYTES && seconds < MOST_SECONDS, "{bytes} bytes, {seconds} s");
    assert!(html.contains("A sample is shown"));
}

/// The same bound where more would have to be thinned.
#[test]
fn a_long_history_is_thinned_and_says_so() {
    let (bytes, _, html) = measured(20, 100_000, 3, 50_000);
    assert!(bytes < MOST_BYTES, "{bytes}");
    assert!(html.contains("Thinned: the history has 100000 rows; a point of a curve is the mean of 2 of them"));
    assert!(html.contains("the same 40.00 % of the particles"), "no note of the sample");
}
