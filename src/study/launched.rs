//! Real runs: the program itself, started once for each count and way of sharing, in turns.
//!
//! Runs of one scene must leave the same bytes in `history.csv`, whoever shared it: if they do not, there is nothing
//! to compare. Ratios are taken between runs of one turn, so that a machine that slows down for a while does so for
//! both, and the median over the turns is told.

use std::collections::HashMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::output::{
    AUDIT_FILE, CHECKPOINT_FOLDER, HISTORY_FILE, OutputError, RankTiming, TIMING_FILE, Timing, check_marker,
};

use super::emulation::median;
use super::{Strategy, StudyError};

/// How the program is started.
#[derive(Debug, Clone, Default)]
pub struct Program {
    pub path: PathBuf,
    /// The launcher and its arguments; none: the devices are subdomains of one process.
    pub launcher: Vec<String>,
    /// Further arguments of `run`.
    pub arguments: Vec<String>,
    /// Steps of each run; `None`: to the end of the scene.
    pub steps: Option<u64>,
}

/// A run to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    pub devices: usize,
    pub strategy: Strategy,
    pub scene: PathBuf,
    /// To go on from, instead of the start of the scene.
    pub from: Option<Start>,
}

/// A checkpoint, the folder of its run, and the steps that it has done.
#[derive(Debug, Clone, PartialEq)]
pub struct Start {
    pub checkpoint: PathBuf,
    pub folder: PathBuf,
    pub step: u64,
}

/// A run that was made.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    pub timing: Timing,
    pub history: Vec<u8>,
}

impl Program {
    /// Runs the case into `folder`.
    ///
    /// # Errors
    /// If it cannot be started, fails, or leaves no results.
    pub fn run(&self, case: &Case, folder: &Path) -> Result<Trial, StudyError> {
        if let Some(start) = &case.from {
            start.copy(folder)?;
        }
        let mut command = self.command(case, folder);
        let name = command.get_program().to_string_lossy().into_owned();
        let output = command.output().map_err(|source| StudyError::Start { program: name, source })?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(StudyError::Run {
                case: case.name(),
                status: output.status.to_string(),
                code: output.status.code(),
                said: said.trim().to_owned(),
            });
        }
        let history = folder.join(HISTORY_FILE);
        let bytes = std::fs::read(&history).map_err(io("read", &history))?;
        Ok(Trial { timing: Timing::read(folder)?, history: bytes })
    }

    fn command(&self, case: &Case, folder: &Path) -> Command {
        let devices = case.devices.to_string();
        let mut command = match self.launcher.split_first() {
            Some((launcher, arguments)) => {
                let mut command = Command::new(launcher);
                command.args(arguments).arg("-n").arg(&devices).arg(&self.path);
                command
            }
            None => Command::new(&self.path),
        };
        let mut done = 0;
        match &case.from {
            // The folder may have what an earlier sweep left that failed.
            None => command.arg("run").arg(&case.scene).arg("--force").arg("--out").arg(folder),
            Some(start) => {
                done = start.step;
                command.arg("resume").arg(folder)
            }
        };
        command.args(["--balance", case.strategy.name()]).args(&self.arguments).arg("--quiet");
        if let Some(steps) = self.steps {
            command.args(["--steps", &(done + steps).to_string()]);
        }
        if self.launcher.is_empty() {
            command.args(["--subdomains", &devices]);
        }
        command
    }
}

impl Start {
    /// Copies the run as it was at this checkpoint, that it can go on in `to`: not what it wrote at its end, nor later checkpoints,
    /// and nothing of an earlier sweep that failed stays there.
    fn copy(&self, to: &Path) -> Result<(), OutputError> {
        check_marker(&self.folder)?;
        if to.exists() {
            check_marker(to)?;
            std::fs::remove_dir_all(to).map_err(io("remove", to))?;
        }
        let after = [CHECKPOINT_FOLDER, AUDIT_FILE, TIMING_FILE];
        copy(&self.folder, to, &|name| !after.iter().any(|after| name == *after))?;
        // A named checkpoint has a name.
        let name = self.checkpoint.file_name().unwrap_or_default();
        copy(&self.checkpoint, &to.join(CHECKPOINT_FOLDER).join(name), &|_| true)
    }
}

/// Copies what is in a folder and has one of the wanted names, and all in the folders among it.
fn copy(from: &Path, to: &Path, wanted: &dyn Fn(&OsStr) -> bool) -> Result<(), OutputError> {
    std::fs::create_dir_all(to).map_err(io("create", to))?;
    for entry in std::fs::read_dir(from).map_err(io("read", from))? {
        let entry = entry.map_err(io("read", from))?;
        let (path, target) = (entry.path(), to.join(entry.file_name()));
        if !wanted(&entry.file_name()) {
            continue;
        }
        if path.is_dir() {
            copy(&path, &target, &|_| true)?;
        } else {
            std::fs::copy(&path, &target).map_err(io("copy", &path))?;
        }
    }
    Ok(())
}

fn io(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> OutputError {
    let path = path.to_path_buf();
    move |source| OutputError::Io { action, path, source }
}

/// One timing for several states of a run: each state's, for as many steps as it stands for.
pub fn together(states: &[(f64, Timing)]) -> Timing {
    let mut all = Timing::default();
    let (mut steps, mut particle_steps) = (0.0, 0.0);
    for (weight, timing) in states {
        let times = weight / timing.steps.max(1) as f64;
        all.stepping_seconds += times * timing.stepping_seconds;
        steps += weight;
        particle_steps += times * timing.particle_steps as f64;
        all.ranks.resize(timing.ranks.len(), RankTiming::default());
        for (sum, rank) in all.ranks.iter_mut().zip(&timing.ranks) {
            sum.waiting_seconds += times * rank.waiting_seconds;
            sum.device_seconds += times * rank.device_seconds;
            sum.rebalancing_seconds += times * rank.rebalancing_seconds;
        }
    }
    (all.steps, all.particle_steps) = (steps.round() as u64, particle_steps.round() as u64);
    all
}

impl Case {
    pub fn name(&self) -> String {
        format!("{}-{}", self.devices, self.strategy.name())
    }
}

/// Makes every case `turns` times, all cases in each turn; the trials by case, in order of turn. `run` is told the
/// turn.
///
/// # Errors
/// If a run fails, or two of one scene have different histories.
pub fn take_turns(
    cases: &[Case],
    turns: usize,
    mut run: impl FnMut(&Case, usize) -> Result<Trial, StudyError>,
) -> Result<Vec<Vec<Timing>>, StudyError> {
    let mut timings = vec![Vec::new(); cases.len()];
    let mut histories: HashMap<&Path, (String, Vec<u8>)> = HashMap::new();
    for turn in 0..turns {
        for (case, timings) in cases.iter().zip(&mut timings) {
            let trial = run(case, turn)?;
            let own = format!("{}, turn {}", case.name(), turn + 1);
            match histories.get(case.scene.as_path()) {
                None => drop(histories.insert(&case.scene, (own, trial.history))),
                Some((other, history)) if *history != trial.history => {
                    let line = first_difference(history, &trial.history);
                    return Err(StudyError::Bits { one: other.clone(), other: own, line });
                }
                Some(_) => {}
            }
            timings.push(trial.timing);
        }
    }
    Ok(timings)
}

/// The line, from 1, where two texts part.
fn first_difference(one: &[u8], other: &[u8]) -> usize {
    let same = one.iter().zip(other).take_while(|(a, b)| a == b).count();
    1 + one[..same].iter().filter(|&&byte| byte == b'\n').count()
}

/// What the trials of a case come to.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    pub devices: usize,
    pub strategy: Strategy,
    /// Wall time of the steps, s: median, least, most.
    pub seconds: [f64; 3],
    pub turns: usize,
    pub steps: u64,
    /// Per second.
    pub particle_steps: f64,
    /// Against the fewest devices, shared in the same way: particle-steps per second and device over theirs.
    pub efficiency: f64,
    pub speed_up: f64,
    /// Share of the slowest rank's time in which it waits for messages of others.
    pub waiting: Option<f64>,
}

/// The cases in their order; each against that with the fewest devices of its strategy. One device is of every
/// strategy.
pub fn compare(cases: &[Case], timings: &[Vec<Timing>]) -> Vec<Measured> {
    let fewest = cases.iter().map(|case| case.devices).min().unwrap_or(1);
    let is_base = |case: &Case, of: &Case| case.devices == fewest && (case.strategy == of.strategy || fewest == 1);
    let rate = |timing: &Timing| timing.particle_steps as f64 / timing.stepping_seconds;
    let compared = cases.iter().zip(timings).filter_map(|(case, own)| {
        let base = cases.iter().position(|other| is_base(other, case))?;
        let per_device = |timing: &Timing, devices: usize| rate(timing) / devices as f64;
        let ratios = own.iter().zip(&timings[base]);
        let ratios = ratios.map(|(own, base)| per_device(own, case.devices) / per_device(base, fewest));
        let efficiency = median(ratios)?;
        let seconds = || own.iter().map(|timing| timing.stepping_seconds);
        let waiting = |timing: &Timing| {
            let most = timing.ranks.iter().map(|rank| rank.waiting_seconds).reduce(f64::max)?;
            (timing.ranks.len() > 1).then_some(most / timing.stepping_seconds)
        };
        Some(Measured {
            devices: case.devices,
            strategy: case.strategy,
            seconds: [median(seconds())?, seconds().fold(f64::INFINITY, f64::min), seconds().fold(0.0, f64::max)],
            turns: own.len(),
            steps: own.first()?.steps,
            particle_steps: median(own.iter().map(rate))?,
            efficiency,
            speed_up: efficiency * case.devices as f64 / fewest as f64,
            waiting: median(own.iter().filter_map(waiting)),
        })
    });
    compared.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(devices: usize, strategy: Strategy, scene: &str) -> Case {
        Case { devices, strategy, scene: scene.into(), from: None }
    }

    fn trial(seconds: f64, particle_steps: u64, history: &str) -> Trial {
        let timing = Timing { stepping_seconds: seconds, steps: 10, particle_steps, ..Timing::default() };
        Trial { timing, history: history.into() }
    }

    /// One different byte, in whatever run, ends the sweep, and says where.
    #[test]
    fn different_histories_of_one_scene_are_an_error() {
        let cases = [case(1, Strategy::Off, "a"), case(2, Strategy::Off, "a"), case(2, Strategy::Dynamic, "a")];
        let sweep = |odd: (usize, usize)| {
            let mut calls = Vec::new();
            let done = take_turns(&cases, 2, |case, turn| {
                calls.push((case.name(), turn));
                let at = cases.iter().position(|other| other == case).unwrap();
                Ok(trial(1.0, 1, if (at, turn) == odd { "t\n0\n1\n3\n" } else { "t\n0\n1\n2\n" }))
            });
            (done, calls)
        };
        let (same, calls) = sweep((9, 9));
        assert!(same.is_ok_and(|timings| timings.iter().all(|own| own.len() == 2)));
        assert_eq!(calls[2..4], [("2-dynamic".to_owned(), 0), ("1-off".to_owned(), 1)], "in turns");
        for odd in [(1, 0), (2, 0), (0, 1), (2, 1)] {
            let text = sweep(odd).0.unwrap_err().to_string();
            assert!(text.contains("line 4") && text.contains("1-off, turn 1"), "{text}");
        }
        // Of different scenes nothing is expected.
        let two = [case(1, Strategy::Off, "a"), case(2, Strategy::Off, "b")];
        assert!(take_turns(&two, 1, |case, _| Ok(trial(1.0, 1, &case.name()))).is_ok());
    }

    /// The machine is half as fast in the second turn, which no ratio shows.
    #[test]
    fn efficiencies_are_ratios_of_one_turn() {
        let cases = [case(1, Strategy::Off, "a"), case(4, Strategy::Off, "a"), case(4, Strategy::Dynamic, "a")];
        let timings = |seconds: [f64; 2]| seconds.map(|seconds| trial(seconds, 1200, "").timing).to_vec();
        let all = [timings([8.0, 16.0]), timings([4.0, 8.0]), timings([2.5, 5.0])];
        let compared = compare(&cases, &all);
        let found: Vec<_> = compared.iter().map(|m| (m.efficiency, m.speed_up, m.seconds)).collect();
        assert_eq!(found[0], (1.0, 1.0, [12.0, 8.0, 16.0]));
        assert_eq!(found[1], (0.5, 2.0, [6.0, 4.0, 8.0]));
        assert!((found[2].0 - 0.8).abs() < 1e-12 && (found[2].1 - 3.2).abs() < 1e-12);
        // Where nothing ran on one device, a strategy is compared with itself.
        let cases = [case(2, Strategy::Off, "a"), case(2, Strategy::Dynamic, "a"), case(4, Strategy::Dynamic, "a")];
        let all = [timings([9.0, 9.0]), timings([4.0, 4.0]), timings([2.0, 2.0])];
        assert_eq!(compare(&cases, &all)[2].efficiency, 1.0);
    }

    /// With the particles per device held, equal times are full efficiency.
    #[test]
    fn weak_scaling_is_the_rate_of_a_device() {
        let cases = [case(1, Strategy::Off, "a"), case(3, Strategy::Off, "b")];
        let compared = compare(&cases, &[vec![trial(2.0, 100, "").timing], vec![trial(2.5, 300, "").timing]]);
        assert!((compared[1].efficiency - 0.8).abs() < 1e-12 && (compared[1].speed_up - 2.4).abs() < 1e-12);
    }

    #[test]
    fn a_launcher_goes_before_the_program_and_subdomains_stand_in_for_it() {
        let words = |launcher: &[&str]| {
            let launcher = launcher.iter().map(|&word| word.to_owned()).collect();
            let program = Program {
                path: "/p".into(),
                launcher,
                arguments: vec!["--halo-rounds".into(), "2".into()],
                steps: Some(9),
            };
            let command = program.command(&case(4, Strategy::Dynamic, "s.toml"), Path::new("f"));
            let words = std::iter::once(command.get_program()).chain(command.get_args());
            words.map(|word| word.to_str().unwrap().to_owned()).collect::<Vec<_>>().join(" ")
        };
        let run = "run s.toml --force --out f --balance dynamic --halo-rounds 2 --quiet --steps 9";
        assert_eq!(words(&[]), format!("/p {run} --subdomains 4"));
        assert_eq!(words(&["mpirun", "--bind-to", "none"]), format!("mpirun --bind-to none -n 4 /p {run}"));
    }
}
