//! `corpuscle sweep`: a scene on several counts of devices, run or emulated, and compared.

mod emulated;
mod plan;

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use crate::gpu::Device;
use crate::output::{
    Claim, Content, OutputFolder, SCENE_FILE, SWEEP_CHART_FILE, SWEEP_FILE, SWEEP_MODEL_CHART_FILE, SWEEP_TABLE_FILE,
    Timing, grouped, mesh_paths,
};
use crate::scene::{Method, Scene, to_toml};
use crate::simulation::{BalanceOptions, Ghosts, HaloOptions, SimulationError};
use crate::study::launched::{Case, Measured, Program, compare, take_turns, together};
use crate::study::report;
use crate::study::state::{Moment, weights};
use crate::study::{Strategy, StudyError};

use super::CliError;
use super::arguments::{Balance, BalanceBy, SweepArguments};
use super::settings::{model_of, scene_of};
use super::terminal::say;
use emulated::{EMULATED_STEPS, Emulation};
use plan::SweepPlan;

const RUNS_FOLDER: &str = "runs";
/// Times that every count is run unless said.
const TURNS: u32 = 3;

pub fn sweep(raw: SweepArguments) -> Result<(), CliError> {
    let plan = SweepPlan::new(raw)?;
    let emulating = plan.raw.emulation.emulate;
    // Earlier results are removed once it is clear that there can be others.
    let device = emulating.then(|| Device::open(plan.raw.gpu.as_deref())).transpose()?;
    let scene = to_toml(&plan.scene);
    let inputs = plan.inputs();
    let claim =
        Claim { content: Content::Sweep, scene: Some(&scene), meshes: &[], inputs: &inputs, force: plan.raw.force };
    let folder = OutputFolder::create(&plan.folder, &claim)?;
    folder.write_text(SCENE_FILE, &scene)?;
    let emulated = device.map(|device| plan.emulate(&device)).transpose()?;
    let measured = plan.run(folder.path())?;
    let points = emulated.as_ref().map_or(&[][..], |emulated| &emulated.points);
    let text = plan.text(&measured, emulated.as_ref());
    folder.write_text(SWEEP_FILE, &report::csv(&measured, points))?;
    folder.write_text(SWEEP_TABLE_FILE, &text)?;
    let title = &plan.scene.title;
    if !measured.is_empty() {
        report::measured_chart(&folder.path().join(SWEEP_CHART_FILE), title, &measured)?;
    }
    if !points.is_empty() {
        report::modelled_chart(&folder.path().join(SWEEP_MODEL_CHART_FILE), title, points)?;
    }
    say(&text)?;
    say(&format!("{}\n", folder.path().display()))
}

impl SweepPlan {
    fn new(raw: SweepArguments) -> Result<SweepPlan, CliError> {
        check(&raw)?;
        let mut scene = scene_of(&raw.scene)?;
        if model_of(&raw.scene.scene, scene.clone())?.plan.method == Method::ControlVolume {
            return Err(SimulationError::NoParticles.into());
        }
        // They would be timed.
        scene.output.snapshots = 0;
        let path = &raw.scene.scene;
        let name = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        let folder = raw.out.clone().unwrap_or_else(|| Path::new("results").join(format!("{name}-sweep")));
        let launcher: Vec<String> =
            raw.runs.launcher.iter().flat_map(|text| text.split_whitespace()).map(str::to_owned).collect();
        let devices = sorted(&raw.devices);
        let real = if raw.emulation.emulate { sorted(&raw.emulation.validate) } else { devices.clone() };
        let mut strategies = Vec::new();
        for balance in &raw.balance {
            let strategy = match balance {
                Balance::Off => Strategy::Off,
                Balance::Initial => Strategy::Initial,
                Balance::Dynamic => Strategy::Dynamic,
            };
            if !strategies.contains(&strategy) {
                strategies.push(strategy);
            }
        }
        let mut moments = raw.from.iter().map(|from| Moment::read(from)).collect::<Result<Vec<_>, _>>()?;
        moments.sort_by(|a, b| a.time.total_cmp(&b.time));
        let runs_initial = !real.is_empty() && strategies.contains(&Strategy::Initial);
        if !moments.is_empty() && runs_initial {
            return Err(CliError::InitialFrom);
        }
        for moment in &moments {
            let asked = |scene: &Scene| {
                let mut scene = scene.clone();
                (scene.model.particles, scene.seed) = (None, 0);
                scene.output = moment.model.scene.output;
                to_toml(&scene)
            };
            if asked(&moment.model.scene) != asked(&scene) {
                return Err(CliError::OtherScene { from: moment.from.clone(), scene: path.clone() });
            }
        }
        Ok(SweepPlan { raw, scene, folder, devices, real, strategies, launcher, moments })
    }

    /// The files and folders that are read.
    fn inputs(&self) -> Vec<PathBuf> {
        let mut inputs = vec![self.raw.scene.scene.clone()];
        inputs.extend(mesh_paths(&self.scene));
        inputs.extend(self.raw.from.iter().cloned());
        inputs
    }

    /// Every count with every strategy; one device has nothing to share out.
    fn pairs(&self, devices: &[usize]) -> Vec<(usize, Strategy)> {
        let of = |&devices: &usize| {
            let strategies = if devices == 1 { &self.strategies[..1] } else { &self.strategies[..] };
            strategies.iter().map(move |&strategy| (devices, strategy)).collect::<Vec<_>>()
        };
        devices.iter().flat_map(of).collect()
    }

    fn run(&self, folder: &Path) -> Result<Vec<Measured>, CliError> {
        if self.real.is_empty() {
            return Ok(Vec::new());
        }
        let runs = folder.join(RUNS_FOLDER);
        fs::create_dir_all(&runs).map_err(|error| io("create", &runs, error))?;
        let pairs = self.pairs(&self.real);
        let mut cases = Vec::new();
        for &(devices, strategy) in &pairs {
            if self.moments.is_empty() {
                cases.push(Case { devices, strategy, scene: self.scene_file(&runs, devices)?, from: None });
            }
            for moment in &self.moments {
                let (scene, from) = (moment.from.clone(), Some(moment.start.clone()));
                cases.push(Case { devices, strategy, scene, from });
            }
        }
        let path = std::env::current_exe().map_err(|error| io("find", Path::new("the program"), error))?;
        let (launcher, arguments) = (self.launcher.clone(), self.run_arguments());
        let program = Program { path, launcher, arguments, steps: self.raw.runs.steps };
        let turns = self.turns() as usize;
        let timings = take_turns(&cases, turns, |case, turn| {
            let at = self.moments.iter().position(|moment| moment.from == case.scene);
            let at = at.map_or_else(String::new, |at| format!("-state-{}", at + 1));
            let name = format!("{}-{}{at}", case.name(), turn + 1);
            tracing::info!("run {name}");
            program.run(case, &runs.join(name))
        })?;
        // Nothing but equal histories is in them; on an error they stay.
        fs::remove_dir_all(&runs).map_err(|error| io("remove", &runs, error))?;
        if self.moments.is_empty() {
            return Ok(compare(&cases, &timings));
        }
        // The states of a pair stand side by side; together they are the run.
        let weights = weights(&self.moments);
        let of_pair = |states: &[Vec<Timing>]| -> Vec<Timing> {
            let turn = |turn: usize| -> Timing {
                let states: Vec<(f64, Timing)> =
                    weights.iter().zip(states).map(|(&weight, turns)| (weight, turns[turn].clone())).collect();
                together(&states)
            };
            (0..turns).map(turn).collect()
        };
        let whole: Vec<Vec<Timing>> = timings.chunks(self.moments.len()).map(of_pair).collect();
        let first: Vec<Case> = cases.iter().step_by(self.moments.len()).cloned().collect();
        Ok(compare(&first, &whole))
    }

    /// The scene that a count runs: one for all, but where each device has its own particles.
    fn scene_file(&self, runs: &Path, devices: usize) -> Result<PathBuf, CliError> {
        let mut scene = self.scene.clone();
        let mut name = "scene.toml".to_owned();
        if self.raw.runs.weak {
            let one = model_of(&self.raw.scene.scene, scene.clone())?.plan.particles;
            scene.model.particles = Some(one * devices as u64);
            name = format!("scene-{devices}.toml");
        }
        let path = runs.join(name);
        fs::write(&path, to_toml(&scene)).map_err(|error| io("write", &path, error))?;
        Ok(path)
    }

    fn turns(&self) -> u32 {
        self.raw.runs.repeat.unwrap_or(TURNS)
    }

    fn run_arguments(&self) -> Vec<String> {
        let tuning = &self.raw.tuning;
        let by = match tuning.balance_by {
            BalanceBy::Cost => "cost",
            BalanceBy::Particles => "particles",
        };
        let mut words = vec![("--balance-by", by.to_owned())];
        words.extend(tuning.balance_every.map(|steps| ("--balance-every", steps.to_string())));
        words.extend(tuning.balance_threshold.map(|ratio| ("--balance-threshold", ratio.to_string())));
        // Runs that are set beside an emulation have its halo.
        let halo = if self.raw.emulation.emulate { emulated::halo(tuning) } else { HaloOptions::from(tuning) };
        words.extend(halo.rounds.map(|rounds| ("--halo-rounds", rounds.to_string())));
        words.extend(halo.ghosts.map(|ghosts| {
            let word = match ghosts {
                Ghosts::OnDemand => "asked",
                Ghosts::All => "all",
            };
            ("--ghosts", word.to_owned())
        }));
        words.extend(self.raw.gpu.as_ref().map(|gpu| ("--gpu", gpu.clone())));
        words.into_iter().flat_map(|(name, value)| [name.to_owned(), value]).collect()
    }

    fn text(&self, measured: &[Measured], emulated: Option<&Emulation>) -> String {
        let mut text = format!("# {}: sweep over counts of devices\n", self.scene.title);
        if !measured.is_empty() {
            text += &self.measured_text(measured);
        }
        if let Some(emulation) = emulated {
            text += &self.modelled_text(emulation, measured);
        }
        text
    }

    /// What is measured.
    fn states(&self) -> String {
        let named: Vec<String> = weights(&self.moments)
            .iter()
            .zip(&self.moments)
            .map(|(steps, moment)| format!("{} for {steps:.0} steps", moment.name()))
            .collect();
        if named.is_empty() { "the start of the scene".into() } else { named.join(", ") }
    }

    fn measured_text(&self, measured: &[Measured]) -> String {
        let started = if self.launcher.is_empty() {
            "The devices are subdomains of one process on one device: what is seen is the cost of dividing, not a \
             speed-up of several devices."
                .to_owned()
        } else {
            format!("Each device is a rank of `{}`.", self.launcher.join(" "))
        };
        let held = if self.raw.runs.weak {
            " The particles of each device are held, so there are as many times more as devices."
        } else {
            ""
        };
        format!(
            "\n## Measured\n\nWall time of {} steps without set-up, median of {} turns. {started}{held} All runs of a \
             scene left the same bytes in `history.csv`.\n\n{}",
            measured.first().map_or_else(String::new, |m| grouped(m.steps)),
            self.turns(),
            report::measured_table(measured),
        )
    }

    fn modelled_text(&self, emulation: &Emulation, measured: &[Measured]) -> String {
        let Emulation { adapter, particles, costs, points } = emulation;
        let raw = &self.raw.emulation;
        let steps = points.first().map_or(0.0, |point| point.steps);
        let relative = |cost: f64| cost / costs.unit;
        let mut text = String::new();
        // Writing to a string cannot fail.
        let _ = write!(
            text,
            "\n## Modelled: work alone\n\nSubdomains of {} particles{}, measured one at a time on {adapter}: {} intervals \
             of {EMULATED_STEPS} steps of each state ({}), dynamic cuts made for the state, borders exchanged every {} of \
             collisions. Speed-up of the fullest subdomain's owned particles, and of its work, ghosts included: of the work of the mean \
             particle a particle is {:.3}, a candidate {:.3}, a wall test {:.2}, a triangle of fabric {:.3} and a cell {:.4}, \
             as fitted to the device times.\n\n{}",
            grouped(*particles),
            if self.raw.runs.weak { " on the fewest devices, as many more as there are more devices" } else { "" },
            raw.intervals,
            self.states(),
            match emulated::halo(&self.raw.tuning).rounds {
                None | Some(1) => "round".to_owned(),
                Some(rounds) => format!("{rounds} rounds"),
            },
            relative(costs.particle),
            relative(costs.candidate),
            relative(costs.wall),
            relative(costs.sheet),
            relative(costs.cell),
            report::work_table(points),
        );
        let _ = write!(
            text,
            "\n## Modelled: time, with the fixed costs of {adapter}\n\nFor {steps:.0} steps: the slowest subdomain's own \
             time (measured alone), and {} us per exchange, {} us per message and {} GB/s (assumed) for the messages \
             that were exchanged.\n\n{}",
            raw.latency_us,
            raw.message_us,
            raw.bandwidth_gbs,
            report::time_table(points, measured),
        );
        let _ = write!(
            text,
            "\n## Modelled: time on an assumed GPU\n\nThe work above, and as assumed:\n\n| per mean particle | per pass | \
             host's wait per exchange | exchange | message | bandwidth |\n|--:|--:|--:|--:|--:|--:|\n| {} ns | {} us | {} us | \
             {} us | {} us | {} GB/s |\n\n{}",
            raw.gpu_particle_ns,
            raw.gpu_pass_us,
            raw.gpu_wait_us,
            raw.latency_us,
            raw.message_us,
            raw.bandwidth_gbs,
            report::gpu_table(points),
        );
        if let Some(table) = report::validation_table(points, measured) {
            let _ = write!(text, "\n## The model beside real runs\n\n{table}");
        }
        text
    }
}

fn check(raw: &SweepArguments) -> Result<(), CliError> {
    let emulation = &raw.emulation;
    let times = [
        ("--latency-us", emulation.latency_us),
        ("--message-us", emulation.message_us),
        ("--gpu-particle-ns", emulation.gpu_particle_ns),
        ("--gpu-pass-us", emulation.gpu_pass_us),
        ("--gpu-wait-us", emulation.gpu_wait_us),
    ];
    for (option, found) in times {
        if !(found.is_finite() && found >= 0.0) {
            return Err(CliError::SweepFigure { option, found, expected: "a number of at least 0" });
        }
    }
    let bandwidth = emulation.bandwidth_gbs;
    if bandwidth.is_nan() || bandwidth <= 0.0 {
        let expected = "a number above 0";
        return Err(CliError::SweepFigure { option: "--bandwidth-gbs", found: bandwidth, expected });
    }
    BalanceOptions::try_from(&raw.tuning)?;
    if raw.runs.launcher.as_ref().is_some_and(|text| text.trim().is_empty()) {
        return Err(CliError::NoLauncher);
    }
    if emulation.emulate && emulation.validate.is_empty() {
        let of_runs = [
            ("--launcher", raw.runs.launcher.is_some()),
            ("--repeat", raw.runs.repeat.is_some()),
            ("--steps", raw.runs.steps.is_some()),
            ("--balance-every", raw.tuning.balance_every.is_some()),
            ("--balance-threshold", raw.tuning.balance_threshold.is_some()),
        ];
        if let Some(&(option, _)) = of_runs.iter().find(|(_, given)| *given) {
            return Err(CliError::NoRuns { option });
        }
    }
    if let Some(&devices) = emulation.validate.iter().find(|&&devices| devices > 1)
        && raw.runs.launcher.is_none()
    {
        return Err(CliError::ValidateOnOne { devices });
    }
    match emulation.validate.iter().find(|devices| !raw.devices.contains(devices)) {
        Some(&devices) => Err(CliError::ValidateOther { devices }),
        None => Ok(()),
    }
}

fn sorted(counts: &[u32]) -> Vec<usize> {
    let mut counts: Vec<usize> = counts.iter().map(|&count| count as usize).collect();
    counts.sort_unstable();
    counts.dedup();
    counts
}

fn io(action: &'static str, path: &Path, source: std::io::Error) -> CliError {
    StudyError::from(crate::output::OutputError::Io { action, path: path.to_path_buf(), source }).into()
}
