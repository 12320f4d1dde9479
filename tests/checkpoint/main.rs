//! Law: a kill at any moment leaves the last good checkpoint.
//!
//! A child process writes checkpoints without end, as three ranks would, and is killed at moments spread over its work.
//! The other files have the laws of whole runs that are interrupted.

mod kills;
mod program;
mod refusals;
mod restarts;
mod signals;

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use corpuscle::output::{
    Adapter, AppendedState, Checkpoint, CheckpointError, CheckpointWriter, HistoryState, Moment, Origin, OutputState,
    RunContext, latest,
};
use corpuscle::scene::UnitSystem;
use corpuscle::subdomain::GpuParticle;

const FOLDER: &str = "CORPUSCLE_TEST_CHECKPOINTS";
const RANKS: u32 = 3;
const PARTICLES_OF_RANK: u32 = 4000;

fn particles(rank: u32, step: u64) -> Vec<GpuParticle> {
    let ids = rank * PARTICLES_OF_RANK..(rank + 1) * PARTICLES_OF_RANK;
    let place = |id: u32| id.wrapping_mul(0x9e37_79b9) >> 1;
    ids.map(|id| GpuParticle {
        position: [place(id), 7, step as u32],
        tag: GpuParticle::tag(3, id),
        ..Default::default()
    })
    .collect()
}

fn write(parent: &Path, step: u64) {
    let writer = CheckpointWriter::new(parent, step);
    let rank = |rank: u32| writer.particles(rank as usize, bytemuck::cast_slice(&particles(rank, step))).unwrap();
    let files = (0..RANKS).map(rank).collect();
    let count = u64::from(RANKS * PARTICLES_OF_RANK);
    let moment = Moment { step, time: step as f64, particles: count, ids: count };
    let origin = Origin {
        scene: "title = \"none\"\n".into(),
        plan: "particles = 3\n".into(),
        meshes: Vec::new(),
        adapter: Adapter::default(),
        units: UnitSystem::Si,
    };
    let file = AppendedState { bytes: step, crc32: 0 };
    let output = OutputState { history: HistoryState { rows: step, file }, snapshots: None };
    writer.commit(files, &moment, RunContext { origin: &origin, state: &step, output: &output }).unwrap();
}

/// What the child does; without the variable it is nothing.
#[test]
#[ignore = "runs until it is killed"]
fn write_without_end() {
    let Some(folder) = std::env::var_os(FOLDER) else { return };
    let folder = Path::new(&folder);
    let mut step = latest(folder).map_or(1, |path| Checkpoint::open(&path).unwrap().manifest().step + 1);
    loop {
        write(folder, step);
        step += 1;
    }
}

fn child(folder: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "write_without_end", "--ignored"])
        .env(FOLDER, folder)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap()
}

/// All of a checkpoint is that of one step.
fn check(path: &Path) -> u64 {
    let checkpoint =
        Checkpoint::open(path).unwrap_or_else(|error| panic!("{error}: {:?}", std::error::Error::source(&error)));
    let step = checkpoint.manifest().step;
    let (output, state) = checkpoint.state::<u64>().unwrap();
    assert_eq!((output.history.rows, state), (step, step));
    for rank in 0..RANKS {
        let expected = particles(rank, step);
        assert!(checkpoint.particles(rank as usize).unwrap() == bytemuck::cast_slice::<_, u8>(&expected));
    }
    step
}

fn begun_or_wait(begun: impl Fn() -> bool) -> bool {
    let begun = begun();
    if !begun {
        std::thread::sleep(Duration::from_millis(5));
    }
    begun
}

#[test]
fn a_kill_at_any_moment_leaves_the_last_good_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 1);
    let (mut newest, mut cut_short) = (1, 0);
    for kill in 0..20u64 {
        let before = latest(folder.path()).unwrap();
        let mut child = child(folder.path());
        // It is at work once a checkpoint of its own stands; then spread over all that happens in the next ones.
        let begun = || latest(folder.path()).unwrap() != before;
        assert!((0..6000).any(|_| begun_or_wait(begun)), "the child does not come to write");
        std::thread::sleep(Duration::from_micros(kill * 7919 % 40_000));
        child.kill().unwrap();
        child.wait().unwrap();
        let step = check(&latest(folder.path()).unwrap());
        assert!(step >= newest, "{step} after {newest}");
        newest = step;
        let mut complete = 0;
        for entry in fs::read_dir(folder.path()).unwrap().flatten() {
            if entry.file_name().to_string_lossy().contains('.') {
                cut_short += 1;
            } else {
                // Not only the newest: a folder with a plain name is whole.
                check(&entry.path());
                complete += 1;
            }
        }
        assert!(complete >= 1);
    }
    assert!(cut_short > 0, "no kill met a checkpoint being written: the test has gone blind");
}

/// The check can fail: a checkpoint without one of its files is noticed.
#[test]
fn a_checkpoint_that_lost_a_file_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), 1);
    let path = latest(folder.path()).unwrap();
    check(&path);
    fs::remove_file(path.join("particles-0001.bin")).unwrap();
    assert!(matches!(Checkpoint::open(&path), Err(CheckpointError::Broken { .. })));
}

/// A particle's id is where the checkpoint looks for it: else two with one id would pass.
#[test]
fn ids_are_where_the_device_has_them() {
    let folder = tempfile::tempdir().unwrap();
    let writer = CheckpointWriter::new(folder.path(), 1);
    let twice = [
        GpuParticle { tag: GpuParticle::tag(1, 5), ..Default::default() },
        GpuParticle { tag: GpuParticle::tag(2, 5), ..Default::default() },
    ];
    let files = vec![writer.particles(0, bytemuck::cast_slice(&twice)).unwrap()];
    let moment = Moment { step: 1, time: 0.0, particles: 2, ids: 6 };
    let origin = Origin {
        scene: String::new(),
        plan: String::new(),
        meshes: Vec::new(),
        adapter: Adapter::default(),
        units: UnitSystem::Si,
    };
    let file = AppendedState { bytes: 0, crc32: 0 };
    let output = OutputState { history: HistoryState { rows: 0, file }, snapshots: None };
    let path = writer.commit(files, &moment, RunContext { origin: &origin, state: &(), output: &output }).unwrap();
    let error = Checkpoint::open(&path).unwrap_err();
    let cause = std::error::Error::source(&error).unwrap().to_string();
    assert!(cause.contains("particle 5 is in the checkpoint twice"), "{cause}");
}
