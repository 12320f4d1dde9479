//! States to be refined, each from a short run, made once; and runs that go on from a state.

use std::path::Path;
use std::sync::OnceLock;

use corpuscle::gpu::Device;
use corpuscle::output::{
    Adapter, AppendedState, CheckpointWriter, HistoryState, Moment as Written, Origin, OutputState, RunContext,
};
use corpuscle::ranks::Solo;
use corpuscle::simulation::{
    Model, Moment, Observer, Options, Outcome, Request, Row, RowObserver, RunState, Setup, Simulation, SimulationError,
};
use corpuscle::subdomain::GpuParticle;

/// A run that was cut.
pub struct Cut {
    pub model: Model,
    pub state: RunState,
    /// As the device has them.
    pub particles: Vec<GpuParticle>,
    /// s.
    pub time: f64,
    pub step: u64,
}

#[derive(Default)]
struct Cutter {
    steps: u64,
    cut: Option<(RunState, Vec<GpuParticle>, f64, u64)>,
}

impl RowObserver for Cutter {}

impl Observer for Cutter {
    fn request(&mut self, steps: u64) -> Request {
        if steps >= self.steps { Request::CheckpointAndStop(None) } else { Request::None }
    }

    fn checkpoint(&mut self, moment: &Moment<'_>) -> Result<(), SimulationError> {
        self.cut = Some((moment.state.clone(), moment.own.to_vec(), moment.time, moment.step));
        Ok(())
    }
}

fn model(text: &str) -> Model {
    Model::new(corpuscle::scene::parse(text, "test.toml", Path::new("")).unwrap()).unwrap()
}

fn cut(text: &str, steps: u64) -> Cut {
    let model = model(text);
    let device = Device::open(None).unwrap();
    let mut cutter = Cutter { steps, cut: None };
    Simulation::new(&model, &device, Options::default()).unwrap().run(&mut cutter).unwrap();
    let (state, particles, time, step) = cutter.cut.expect("a checkpoint");
    Cut { model, state, particles, time, step }
}

/// Probes of some hundred particles each: before the vent's far wall, and beside the inner box.
const PROBES: &str = r#"
[[probe]]
name = "far end"
region = { box = { min = [0.25, -0.2, -0.18], max = [0.4, 0.2, 0.18] } }

[[probe]]
name = "near end"
region = { box = { min = [0.0, 0.07, -0.18], max = [0.24, 0.2, 0.18] } }
"#;

fn tank_text(particles: u64) -> String {
    let text = format!("{}{PROBES}", include_str!("../../scenes/tank.toml"));
    text.replace("particles = 1000000", &format!("particles = {particles}")).replace("rows = 100", "rows = 1000")
}

/// Some milliseconds into the tank test: the jet is there.
pub fn tank() -> &'static Cut {
    static CUT: OnceLock<Cut> = OnceLock::new();
    CUT.get_or_init(|| cut(&tank_text(4000), 512))
}

/// The same by the method `half-turn`, whose steps are longer.
pub fn half_turn_tank() -> &'static Cut {
    static CUT: OnceLock<Cut> = OnceLock::new();
    CUT.get_or_init(|| cut(&tank_text(4000).replace("\"closest-approach\"", "\"half-turn\""), 128))
}

/// Before the first particle has entered.
pub fn early() -> Cut {
    cut(&tank_text(500), 0)
}

const TWO_CHAMBERS: &str = r#"
end_time = 0.01

[[gas]]
name = "nitrogen"
molar_mass = 0.0280134
gamma = 1.4

[[gas]]
name = "helium"
molar_mass = 0.0040026
gamma = 1.6666666666666667

[[wall]]
name = "box"
shape = "box"
min = [-0.1, -0.05, -0.05]
max = [0.1, 0.05, 0.05]
gas = "inside"

[[wall]]
name = "plate"
shape = "plane"
center = [0.0, 0.0, 0.0]
normal = [1.0, 0.0, 0.0]
u = [0.0, 1.0, 0.0]
size = [0.12, 0.12]
thickness = 0.0001
HOLE

[[chamber]]
name = "left"
region = { box = { min = [-0.1, -0.05, -0.05], max = [0.0, 0.05, 0.05] } }
pressure = 100000.0
temperature = 300.0
gas = GAS

[[chamber]]
name = "right"
pressure = 10000.0
temperature = 500.0
gas = "nitrogen"

[[surface]]
name = "walls"
wall = "box"

[model]
method = "closest-approach"
particles = 4000

[output]
rows = 100
snapshots = 2
"#;

/// Gas at rest on both sides of a thin plate.
pub fn thin_wall() -> &'static Cut {
    static CUT: OnceLock<Cut> = OnceLock::new();
    let text = TWO_CHAMBERS.replace("HOLE", "").replace("GAS", "\"nitrogen\"");
    CUT.get_or_init(|| cut(&text, 64))
}

/// The same plate across two chambers of one state: gas on either side of it is in both.
pub fn across() -> &'static Cut {
    static CUT: OnceLock<Cut> = OnceLock::new();
    let text = TWO_CHAMBERS.replace("HOLE", "").replace("GAS", "\"nitrogen\"");
    let text = text.replace("[0.0, 0.05, 0.05] } }", "[0.1, 0.0, 0.05] } }").replace("500.0", "300.0");
    CUT.get_or_init(|| cut(&text.replace("10000.0", "100000.0"), 64))
}

/// A mixture that flows through a hole in it.
pub fn mixing() -> &'static Cut {
    static CUT: OnceLock<Cut> = OnceLock::new();
    let hole = "[[wall.hole]]\nname = \"hole\"\ncenter = [0.0, 0.0]\nsize = [0.03, 0.03]";
    let gas = "{ nitrogen = 0.7, helium = 0.3 }";
    CUT.get_or_init(|| cut(&TWO_CHAMBERS.replace("HOLE", hole).replace("GAS", gas), 256))
}

impl Cut {
    /// The folder of this run, as far as a refinement looks into it.
    pub fn write(&self, folder: &Path) {
        let parts: Vec<&[GpuParticle]> = self.particles.chunks(self.particles.len().div_ceil(3)).collect();
        let writer = CheckpointWriter::new(&folder.join("checkpoints"), self.step);
        let files = parts.iter().enumerate().map(|(rank, part)| writer.particles(rank, bytemuck::cast_slice(part)));
        let files = files.collect::<Result<Vec<_>, _>>().unwrap();
        let count = self.particles.len() as u64;
        let moment = Written { step: self.step, time: self.time, particles: count, ids: count };
        let plan = self.model.plan.to_toml().unwrap();
        let origin = Origin::new(&self.model.scene, plan, Adapter::default()).unwrap();
        let history = HistoryState { rows: 0, file: AppendedState { bytes: 0, crc32: 0 } };
        let output = OutputState { history, snapshots: None };
        writer.commit(files, &moment, RunContext { origin: &origin, state: &self.state, output: &output }).unwrap();
    }
}

/// What a run told, and what it left.
pub struct Continued {
    pub rows: Vec<Row>,
    pub outcome: Outcome,
}

#[derive(Default)]
struct Rows(Vec<Row>);

impl RowObserver for Rows {
    fn row(&mut self, row: &Row) -> Result<(), SimulationError> {
        self.0.push(row.clone());
        Ok(())
    }
}

impl Observer for Rows {}

/// Goes on from a state up to so many steps since the start of the run.
pub fn go_on(model: &Model, particles: &[GpuParticle], state: &RunState, steps: u64) -> Continued {
    let device = Device::open(None).unwrap();
    let setup = Setup::with_particles(model, &device, 1, particles.to_vec()).unwrap();
    let solo = Solo::new();
    let options = Options { stop_after_steps: Some(steps), ..Options::default() };
    let mut rows = Rows::default();
    let simulation = Simulation::among(model, &device, &setup, &solo, options).unwrap().resume(state).unwrap();
    let outcome = simulation.run(&mut rows).unwrap();
    Continued { rows: rows.0, outcome }
}
