//! Law: ranks that are processes of MPI give the bits of one process alone: history, final state, counts, audit.
//!
//! The same program is the test, which runs the scene alone and launches itself with `mpirun`, and the rank that
//! is launched: a variable of the environment says so, and what to run. Therefore it has a `main` of its own; words
//! among its arguments choose cases by name, `--include-ignored` runs all of them.

#[allow(dead_code)] // Each test binary uses its own part.
#[path = "../invariance/bits.rs"]
mod bits;
mod midway;
#[allow(dead_code)]
#[path = "../invariance/scenes.rs"]
mod scenes;
#[allow(dead_code)]
#[path = "../whole_run/mod.rs"]
mod whole_run;

use std::collections::BTreeMap;
use std::fs::File;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::process::{Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use bits::Bits;
use corpuscle::partition::By;
use corpuscle::ranks::{Communicator, from_environment};
use corpuscle::scene::Method;
use corpuscle::simulation::{BalanceMode, BalanceOptions, Model, Options, Setup, Simulation, SimulationError};
use whole_run::{Run, Witness, device, run};

const MIDWAY: &str = "-midway";
const HALF_TURN: &str = "-half-turn";
/// Says what a rank runs.
const CASE: &str = "CORPUSCLE_TEST_CASE";
/// Far beyond what a slow machine needs.
const PATIENCE: Duration = Duration::from_secs(300);

/// `half-turn`: by that method; `midway`: from a state in the middle of the run.
const SCENES: [&str; 11] = [
    "tank",
    "box",
    "effusion",
    "tank-midway",
    "effusion-midway",
    "box-half-turn",
    "effusion-half-turn",
    "vent-half-turn",
    "tank-half-turn-midway",
    "tank-half-turn",
    "bag",
];
const MODES: [&str; 4] = ["off", "initial", "dynamic", "forced"];
/// Scene, mode, ranks: each of them once at least.
const SOME: [(&str, &str, usize); 16] = [
    ("tank", "dynamic", 2),
    ("tank", "initial", 4),
    ("tank", "forced", 3),
    ("box", "off", 3),
    ("effusion", "dynamic", 3),
    ("box", "dynamic", 1),
    ("tank-midway", "dynamic", 3),
    ("tank-midway", "initial", 2),
    ("tank-midway", "off", 2),
    ("effusion-midway", "off", 2),
    ("box-half-turn", "dynamic", 2),
    ("effusion-half-turn", "initial", 2),
    ("vent-half-turn", "forced", 2),
    ("tank-half-turn", "forced", 2),
    ("tank-half-turn-midway", "dynamic", 2),
    ("bag", "forced", 2),
];

fn main() -> ExitCode {
    if let Ok(case) = std::env::var(CASE) {
        return play(&case);
    }
    let (flags, words): (Vec<String>, Vec<String>) = std::env::args().skip(1).partition(|word| word.starts_with('-'));
    let all = flags.iter().any(|flag| flag == "--include-ignored" || flag == "--ignored");
    let mut cases = SOME.to_vec();
    if all {
        cases = SCENES
            .iter()
            .flat_map(|&scene| MODES.iter().flat_map(move |&mode| (1..=4).map(move |ranks| (scene, mode, ranks))))
            .collect();
    }
    let mut alone: BTreeMap<&str, String> = BTreeMap::new();
    for (scene, mode, ranks) in cases {
        let name = format!("{scene}_{mode}_on_{ranks}_ranks");
        if !words.iter().all(|word| name.contains(word.as_str())) {
            continue;
        }
        let expected = alone.entry(scene).or_insert_with(|| match scene.strip_suffix(MIDWAY) {
            Some(scene) => told(&midway::go_on_alone(&model(scene), steps_before(scene), &device())),
            None => told(&run(&model(scene), Options::default())),
        });
        let found = mpirun(ranks, &format!("{scene} {mode}"));
        assert_eq!(&found, expected, "{name}");
        println!("test {name} ... ok");
    }
    if words.is_empty() {
        assert_ne!(alone.get("tank"), alone.get("tank-midway"), "the check can fail: fewer rows, other counts");
        let other = mpirun(2, "other off");
        assert_ne!(Some(&other), alone.get("box"), "the check can fail: another seed gives other bits");
    }
    ExitCode::SUCCESS
}

fn model(scene: &str) -> Model {
    if let Some(scene) = scene.strip_suffix(HALF_TURN) {
        return scenes::by(Method::HalfTurn, model(scene));
    }
    match scene {
        "tank" => scenes::tank(3),
        "box" => scenes::gas_box(),
        "effusion" => scenes::effusion(),
        "vent" => scenes::venting(),
        // Elastic, by `half-turn`.
        "bag" => scenes::vented_bag(Method::HalfTurn),
        "other" => {
            let mut scene = scenes::gas_box().scene;
            scene.seed += 1;
            Model::new(scene).expect("a model")
        }
        unknown => panic!("there is no scene `{unknown}`"),
    }
}

/// Of a state in the middle of the run.
fn steps_before(scene: &str) -> u64 {
    // In the tank the jet has reached the vent.
    if scene == "tank" { 96 } else { 32 }
}

/// What a run tells, in a line: counts to read, and a hash of everything.
fn told(run: &Run) -> String {
    let bits = Bits::of(run);
    assert!(bits.history.len() > 3 && !bits.state.is_empty());
    let mut hasher = DefaultHasher::new();
    (&bits.history, &bits.state, &bits.counts, &bits.audit).hash(&mut hasher);
    format!("{} rows, {:?}, {:016x}", bits.history.len(), bits.counts, hasher.finish())
}

/// As a rank.
fn play(case: &str) -> ExitCode {
    let comm = match from_environment() {
        Ok(comm) => comm,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    match of_rank(case, comm.as_ref()) {
        Ok(run) if comm.rank() == 0 => println!("{}", told(&run)),
        Ok(_) => {}
        Err(error) => comm.fail(&error.to_string(), 1),
    }
    ExitCode::SUCCESS
}

fn of_rank(case: &str, comm: &dyn Communicator) -> Result<Run, SimulationError> {
    let (scene, mode) = case.split_once(' ').expect("a scene and a mode");
    let mode = match mode {
        "off" => BalanceMode::Off,
        "initial" => BalanceMode::Initial,
        // Cut anew at steps drawn at random.
        "forced" => BalanceMode::Forced { seed: 1 },
        _ => BalanceMode::Dynamic,
    };
    // By their number: so few particles cost a device nothing that could be measured, and dynamic cuts would never move.
    let balance = BalanceOptions { mode, by: By::Particles, every: 1, threshold: 1.0 };
    let options = Options { balance, ..Options::default() };
    let device = device();
    if let Some(scene) = scene.strip_suffix(MIDWAY) {
        return midway::go_on(&model(scene), steps_before(scene), &device, comm, options);
    }
    let model = model(scene);
    let setup = Setup::new(&model, &device, comm.size(), None)?;
    let mut witness = Witness::default();
    let outcome = Simulation::among(&model, &device, &setup, comm, options)?.run(&mut witness)?;
    Ok(Run { rows: witness.rows, snapshots: witness.snapshots, outcome })
}

/// Launches so many ranks; what rank 0 tells.
fn mpirun(ranks: usize, case: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut child = Command::new("mpirun")
        .args(["--bind-to", "none", "-n", &ranks.to_string()])
        .arg(std::env::current_exe().unwrap())
        .env(CASE, case)
        .env("LP_NUM_THREADS", "0")
        // More ranks than cores, also as root.
        .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
        .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
        .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
        .stdin(Stdio::null())
        .stdout(File::create(path("out")).unwrap())
        .stderr(File::create(path("err")).unwrap())
        .spawn()
        .expect("mpirun can be started");
    let begun = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if begun.elapsed() > PATIENCE {
            child.kill().unwrap();
            panic!("{ranks} ranks hang in the case `{case}`");
        }
        std::thread::sleep(Duration::from_millis(20));
    };
    let [told, errors] = ["out", "err"].map(|name| std::fs::read_to_string(path(name)).unwrap());
    assert!(status.success(), "{ranks} ranks, {case}: {told}{errors}");
    told.trim().to_owned()
}
