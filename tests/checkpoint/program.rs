//! The program as its users start it, on small scenes, and what it leaves.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use corpuscle::output::latest;
use corpuscle::scene::{self, Scene, load, to_toml};

/// Far beyond what a slow machine needs.
const PATIENCE: Duration = Duration::from_secs(240);

/// A scene of the package with fewer particles and an earlier end.
pub fn published(name: &str, particles: u64, end_time: f64) -> Scene {
    let mut scene = load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap();
    scene.model.particles = Some(particles);
    (scene.end_time, scene.output.rows, scene.output.snapshots) = (end_time, 20, 5);
    scene
}

/// The tank with steps so long that the inner box's rise makes them finer.
pub fn tank(end_time: f64) -> Scene {
    let mut scene = published("tank.toml", 1500, end_time);
    scene.model.time_step = Some(2e-5);
    scene
}

/// Gas that becomes so dense that neighbour lists which fit it at the start are too short later, and intervals are run again.
pub fn dense() -> Scene {
    let text = "title = \"dense\"\nend_time = 5e-4\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
        [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
        [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
        [[orifice]]\nname = \"in\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.006\n\
        gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 6.0], [5e-4, 6.0]]\n\
        [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
        [model]\nparticles = 2000\ndiameter = 0.010\ntime_step = 1e-5\n[output]\nrows = 5\nsnapshots = 3\n";
    scene::parse(text, "dense.toml", Path::new("")).unwrap()
}

/// A scene, the folder of its runs, and what a run without interruption leaves.
pub struct Case {
    folder: tempfile::TempDir,
    pub whole: Results,
    /// What the run without interruption said.
    pub said: String,
    /// Steps to the end.
    pub steps: u64,
}

impl Case {
    pub fn new(scene: &Scene) -> Case {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scene.toml"), to_toml(scene)).unwrap();
        let out = folder.path().join("whole");
        let said = Program::alone().run(folder.path(), "whole", &[]).finish();
        let audit = fs::read_to_string(out.join("audit.txt")).unwrap();
        let steps = audit.split(" ms in ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        let steps = steps.replace(',', "").parse().unwrap();
        Case { whole: Results::of(&out), said, steps, folder }
    }

    pub fn out(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Starts a run into the folder `name`.
    pub fn run(&self, program: &Program, name: &str, more: &[&str]) -> Running {
        program.run(self.folder.path(), name, more)
    }

    /// Goes on with the run in the folder `name`, or from the checkpoint of that name.
    pub fn resume(&self, program: &Program, name: &str, more: &[&str]) -> Running {
        let from = self.out(name);
        program.start(&[&["resume", from.to_str().unwrap()], more].concat())
    }

    /// Everything in the folder is as the run without interruption left it.
    pub fn assert_same(&self, name: &str) {
        if let Some(difference) = self.whole.difference(&Results::of(&self.out(name))) {
            panic!("{name}: {difference}");
        }
    }
}

/// How the program is started.
#[derive(Clone)]
pub struct Program {
    /// Under `mpirun`, if more than none.
    ranks: usize,
    subdomains: usize,
}

impl Program {
    pub fn alone() -> Program {
        Program::sharing(1)
    }

    /// One process with so many subdomains.
    pub fn sharing(subdomains: usize) -> Program {
        Program { ranks: 0, subdomains }
    }

    #[cfg(feature = "mpi")]
    pub fn mpi(ranks: usize) -> Program {
        Program { ranks, subdomains: 1 }
    }

    pub fn run(&self, folder: &Path, name: &str, more: &[&str]) -> Running {
        let (scene, out) = (folder.join("scene.toml"), folder.join(name));
        self.start(&[&["run", scene.to_str().unwrap(), "--out", out.to_str().unwrap()], more].concat())
    }

    pub fn start(&self, arguments: &[&str]) -> Running {
        let program = env!("CARGO_BIN_EXE_corpuscle");
        let mut command = if self.ranks > 0 {
            let mut command = Command::new("mpirun");
            command.args(["--bind-to", "none", "-n", &self.ranks.to_string(), program]);
            command
        } else {
            Command::new(program)
        };
        command.args(arguments);
        if self.subdomains > 1 {
            // Balanced anew whenever it is looked at: where a particle is must not matter.
            let subdomains = self.subdomains.to_string();
            command.args(["--subdomains", &subdomains, "--balance-by", "particles", "--balance-threshold", "1.0"]);
        }
        command
            .env("NODEVICE_SELECT", "1")
            .env("NO_COLOR", "1")
            .env("LP_NUM_THREADS", "0")
            // More ranks than cores, also as root.
            .env("OMPI_ALLOW_RUN_AS_ROOT", "1")
            .env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1")
            .env("OMPI_MCA_rmaps_base_oversubscribe", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        Running { child: command.spawn().expect("the program can be started"), ranks: self.ranks }
    }
}

/// A process of the program, or of its launcher.
pub struct Running {
    child: Child,
    ranks: usize,
}

impl Running {
    /// Waits for the end: exit code, if it was no signal, standard output and standard error.
    pub fn end(self) -> (Option<i32>, String, String) {
        let Output { status, stdout, stderr } = self.child.wait_with_output().unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
        (status.code(), text(stdout), text(stderr))
    }

    /// Waits for a good end; what was said.
    pub fn finish(self) -> String {
        let (code, stdout, stderr) = self.end();
        assert_eq!(code, Some(0), "{stdout}{stderr}");
        stdout
    }

    pub fn has_ended(&mut self) -> bool {
        self.child.try_wait().unwrap().is_some()
    }

    /// Waits until `happened`; false if the process ended first.
    pub fn until(&mut self, happened: impl Fn() -> bool) -> bool {
        let begun = Instant::now();
        while !happened() {
            if self.has_ended() {
                return false;
            }
            assert!(begun.elapsed() < PATIENCE, "nothing happens");
            std::thread::sleep(Duration::from_millis(5));
        }
        true
    }

    /// Sends a signal to the process: under `mpirun`, to the launcher.
    pub fn signal(&self, name: &str) {
        signal(name, self.child.id());
    }

    /// The processes that compute.
    pub fn processes(&self) -> Vec<u32> {
        if self.ranks == 0 {
            return vec![self.child.id()];
        }
        let own = self.child.id();
        let children = fs::read_to_string(format!("/proc/{own}/task/{own}/children")).unwrap_or_default();
        children.split_whitespace().filter_map(|pid| pid.parse().ok()).collect()
    }
}

/// One that has ended already takes no signal, which is no fault.
pub fn signal(name: &str, process: u32) {
    Command::new("kill").args([&format!("-{name}"), &process.to_string()]).stderr(Stdio::null()).status().unwrap();
}

/// The files of a run, by name, that must not depend on how it was done: not the command line, not the checkpoints.
pub struct Results(BTreeMap<PathBuf, Vec<u8>>);

impl Results {
    pub fn of(folder: &Path) -> Results {
        let mut files = BTreeMap::new();
        for inside in [folder.to_path_buf(), folder.join("snapshots")] {
            for path in fs::read_dir(&inside).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file())
            {
                let name = path.strip_prefix(folder).unwrap().to_path_buf();
                if !["environment.json", "balance.csv", "timing.json", "subdomains.svg", "log.txt"]
                    .contains(&name.to_str().unwrap())
                {
                    let bytes = fs::read(&path).unwrap();
                    let snapshot = path.extension().is_some_and(|kind| kind == "vtu");
                    files.insert(name, if snapshot { without_subdomains(&bytes) } else { bytes });
                }
            }
        }
        Results(files)
    }

    /// The files that differ, or are there in one only, and of each text the first line that differs.
    pub fn difference(&self, other: &Results) -> Option<String> {
        let names = |results: &Results| results.0.keys().cloned().collect::<Vec<_>>();
        if names(self) != names(other) {
            return Some(format!("{:?} are not {:?}", names(other), names(self)));
        }
        let differing = self.0.iter().filter(|(name, bytes)| other.0[*name] != **bytes);
        let told: Vec<String> = differing.map(|(name, bytes)| told(name, bytes, &other.0[name])).collect();
        (!told.is_empty()).then(|| told.join("; "))
    }
}

fn told(name: &Path, expected: &[u8], found: &[u8]) -> String {
    let name = name.display();
    let [Ok(expected), Ok(found)] = [expected, found].map(std::str::from_utf8) else {
        return format!("{name} differs");
    };
    let mut lines = expected.lines().zip(found.lines());
    match lines.find(|(expected, found)| expected != found) {
        Some((expected, found)) => format!("{name} has {found:?} where {expected:?} should be"),
        None => format!("{name} has another length"),
    }
}

/// A snapshot less the numbers of the subdomains and what moves with them, the places of arrays in the file.
fn without_subdomains(bytes: &[u8]) -> Vec<u8> {
    let marker = b"<AppendedData encoding=\"raw\">\n_";
    let at = bytes.windows(marker.len()).position(|window| window == marker).expect("a snapshot");
    let (xml, block) = (std::str::from_utf8(&bytes[..at]).unwrap(), &bytes[at + marker.len()..]);
    let (mut kept, mut offset) = (Vec::new(), 0);
    for line in xml.lines() {
        let array = line.split_once(" offset=");
        let length =
            array.map_or(0, |_| 8 + u64::from_le_bytes(block[offset..offset + 8].try_into().unwrap()) as usize);
        if !line.contains("Name=\"subdomain\"") {
            kept.extend_from_slice(array.map_or(line, |(head, _)| head).as_bytes());
            kept.extend_from_slice(&block[offset..offset + length]);
        }
        offset += length;
    }
    kept.extend_from_slice(&block[offset..]);
    kept
}

/// The step of the newest complete checkpoint in a run's folder.
pub fn newest(out: &Path) -> Option<u64> {
    let path = latest(out).ok()?;
    path.file_name()?.to_str()?.strip_prefix("step-")?.parse().ok()
}

/// Numbers without a pattern, the same each time.
pub struct Numbers(pub u64);

impl Numbers {
    /// From `low` to below `high`.
    pub fn between(&mut self, low: u64, high: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (self.0 >> 33) % (high - low)
    }
}
