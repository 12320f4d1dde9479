//! Law: `corpuscle run --repeat N` runs the seeds S to S + N - 1, each as a run of its own, and `history_mean.csv` has mean,
//! standard deviation and standard error of every column; on any number of subdomains.

use std::fs;
use std::path::{Path, PathBuf};

use super::{ROOT, outcome};

/// `scenes/box.toml`, a tenth of it, with some of its text replaced.
fn scene(folder: &Path, from: &str, to: &str) -> PathBuf {
    let text = fs::read_to_string(Path::new(ROOT).join("scenes/box.toml")).unwrap();
    let text = text.replace("end_time = 0.0044", "end_time = 0.00044").replace("rows = 44", "rows = 4");
    let changed = text.replace(from, to);
    assert!(from.is_empty() || changed != text);
    let path = folder.join("short.toml");
    fs::write(&path, changed).unwrap();
    path
}

fn repeated(scene: &Path, out: &Path, more: &[&str]) -> (i32, String, String) {
    let basic = ["run", scene.to_str().unwrap(), "--particles", "500", "--out", out.to_str().unwrap()];
    outcome(&[&basic, more].concat())
}

fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut reader = csv::Reader::from_path(path).unwrap();
    let heads = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows = reader.records().map(|row| row.unwrap().iter().map(|value| value.parse().unwrap()).collect());
    (heads, rows.collect())
}

#[test]
fn a_repeated_run_has_a_folder_for_each_seed_and_their_mean_and_spread() {
    let folder = tempfile::tempdir().unwrap();
    let short = scene(folder.path(), "", "");
    let out = folder.path().join("out");
    let (code, text, err) = repeated(&short, &out, &["--seed", "7", "--repeat", "3"]);
    assert_eq!(code, 0, "{err}");
    assert!(text.contains("3 runs, seeds 7 to 9") && text.lines().last() == out.to_str(), "{text}");
    let runs = [7, 8, 9].map(|seed| table(&out.join(format!("seed-{seed}/history.csv"))));
    let (heads, rows) = table(&out.join("history_mean.csv"));
    assert_eq!(rows.len(), 4);
    let mut spread = 0;
    for (column, head) in runs[0].0.iter().enumerate() {
        assert_eq!(heads[3 * column..3 * column + 3], [head.clone(), format!("{head}:sd"), format!("{head}:se")]);
        for (row, found) in rows.iter().enumerate() {
            let values = runs.each_ref().map(|run| run.1[row][column]);
            let mean = values.iter().sum::<f64>() / 3.0;
            let deviation = (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / 2.0).sqrt();
            let scale = values.iter().map(|value| value.abs()).fold(0.0, f64::max);
            for (found, expected) in found[3 * column..].iter().zip([mean, deviation, deviation / 3f64.sqrt()]) {
                assert!((found - expected).abs() <= 1e-9 * scale, "{head}, row {row}: {found} {expected}");
            }
            spread += usize::from(deviation > 1e-6 * scale);
        }
    }
    assert!(spread > 10, "seeds are samples of their own");
    // A seed alone is the run that it is without --repeat.
    let alone = folder.path().join("alone");
    assert_eq!(repeated(&short, &alone, &["--seed", "8"]).0, 0);
    let bytes = |path: &Path| fs::read(path.join("history.csv")).unwrap();
    assert_eq!(bytes(&alone), bytes(&out.join("seed-8")));
    // Subdomains change no byte; fewer seeds leave nothing of more.
    let three = fs::read(out.join("history_mean.csv")).unwrap();
    assert_eq!(repeated(&short, &out, &["--seed", "7", "--repeat", "3", "--subdomains", "2"]).0, 0);
    assert_eq!(fs::read(out.join("history_mean.csv")).unwrap(), three);
    assert_eq!(repeated(&short, &out, &["--seed", "7", "--repeat", "2"]).0, 0);
    assert!(!out.join("seed-9").exists() && fs::read(out.join("history_mean.csv")).unwrap() != three);
}

#[test]
fn what_has_no_seeds_or_no_end_is_not_repeated() {
    let folder = tempfile::tempdir().unwrap();
    let short = scene(folder.path(), "", "");
    let out = folder.path().join("out");
    let refused = |options: &[&str], part: &str| {
        let (code, _, err) = repeated(&short, &out, options);
        let flat = err.replace('│', " ").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(code == 2 && flat.contains(part), "{options:?}: {err}");
        assert!(!out.exists());
    };
    refused(&["--repeat", "2", "--steps", "64"], "--steps");
    refused(&["--repeat", "2", "--checkpoint-every", "64"], "--checkpoint-every");
    refused(&["--repeat", "2", "--stop-after", "1h"], "--stop-after");
    refused(&["--repeat", "1"], "--repeat");
    refused(&["--repeat", "3", "--seed", "72057594037927934"], "seeds are below");
    scene(folder.path(), "occupancy = 0.1", "method = \"control-volume\"");
    refused(&["--repeat", "2"], "control-volume");
    scene(folder.path(), "particles = 8000", "switch = 2e-4\nparticles = 8000");
    refused(&["--repeat", "2"], "`switch`");
}
