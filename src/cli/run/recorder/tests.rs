use super::*;
use crate::cli::run::chart;
use crate::simulation::{SurfaceState, ZoneState};
use std::path::PathBuf;

fn model() -> Model {
    let text = include_str!("../../../../scenes/tank.toml").replace("particles = 1000000", "particles = 2000");
    Model::new(crate::scene::parse(&text, "tank.toml", Path::new("")).unwrap()).unwrap()
}

fn row(model: &Model, k: usize) -> Row {
    let x = k as f64;
    let zone = ZoneState {
        pressure: 1e5 + 0.1 * x,
        temperature: 300.0 / (x + 1.0),
        density: 1.2,
        velocity: [0.0, -x, 0.3],
        particles: vec![x / 3.0, 0.0],
        volume: 1e-3,
    };
    Row {
        time: 1e-3 * x,
        window: [1e-3 * (x - 0.5), 1e-3 * (x + 0.5)],
        step: 1e-7,
        particles: 2000,
        chambers: vec![zone.clone(); model.scene.chambers.len()],
        probes: vec![zone; model.scene.probes.len()],
        surfaces: vec![SurfaceState::default(); model.scene.surfaces.len()],
        walls: Vec::new(),
        vents: Vec::new(),
        motions: Vec::new(),
        fabrics: Vec::new(),
    }
}

/// Ten rows and five snapshots; every second event of the run is both.
fn go_on(recorder: &mut Recorder<'_>, from: usize, to: usize, model: &Model) {
    for k in from..to {
        recorder.row(&row(model, k)).unwrap();
        if k % 2 == 0 {
            let particle = GpuParticle { position: [k as u32; 3], ..GpuParticle::default() };
            recorder.snapshot(1e-3 * k as f64, &vec![particle; k], &vec![0; k]).unwrap();
        }
    }
    recorder.progress(0.0, 0, 0);
}

fn draw(recorder: &Recorder<'_>, dir: &Path, model: &Model) {
    chart::draw(&dir.join("pressure.svg"), &model.scene, recorder.history()).unwrap();
}

fn files(dir: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut found = Vec::new();
    for folder in [dir.to_path_buf(), dir.join("snapshots")] {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|p| p.is_file()) {
            let content = std::fs::read(&path).unwrap();
            found.push((path.strip_prefix(dir).unwrap().to_path_buf(), content));
        }
    }
    found.sort();
    found
}

/// Wherever a run is cut, and however much it had written beyond, its files end as those of a run without
/// interruption, the chart included.
#[test]
fn resumed_files_end_as_uninterrupted_ones() {
    let model = model();
    let totals = Totals { time: 0.0, steps: 0, particle_steps: 0 };
    let whole = tempfile::tempdir().unwrap();
    let mut recorder = Recorder::new(&model, Reference::new(&model), whole.path(), Shown::No).unwrap();
    go_on(&mut recorder, 0, 10, &model);
    draw(&recorder, whole.path(), &model);
    for (cut, lost) in [(0, 4), (3, 0), (4, 3), (7, 1), (10, 0)] {
        let dir = tempfile::tempdir().unwrap();
        let mut recorder = Recorder::new(&model, Reference::new(&model), dir.path(), Shown::No).unwrap();
        go_on(&mut recorder, 0, cut, &model);
        let state = recorder.state().unwrap();
        let bytes = postcard::to_stdvec(&state).unwrap();
        assert_eq!(postcard::from_bytes::<OutputState>(&bytes).unwrap(), state);
        // What the end of a stopped run writes, too.
        go_on(&mut recorder, cut, (cut + lost).min(10), &model);
        draw(&recorder, dir.path(), &model);
        drop(recorder);
        let reference = Reference::new(&model);
        let from = Reached { output: &state, totals };
        let mut resumed = Recorder::resume(&model, reference, dir.path(), Shown::No, from).unwrap();
        go_on(&mut resumed, cut, 10, &model);
        draw(&resumed, dir.path(), &model);
        assert!(files(dir.path()) == files(whole.path()), "cut {cut}, lost {lost}");
    }
    assert_eq!(files(whole.path()).len(), 2 + 5 + 2);
}
