//! Whole runs for tests: the text of a scene becomes a model, a run and all that an observer sees of it.

use std::ops::Deref;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use corpuscle::gpu::Device;
use corpuscle::scene;
use corpuscle::simulation::{Model, Options};
use corpuscle::study::verify;
#[allow(unused_imports, reason = "not every test needs both")]
pub use corpuscle::study::verify::{Run, Witness};

/// Those that no test has at the moment, with the kernels that they have compiled.
static IDLE: Mutex<Vec<Device>> = Mutex::new(Vec::new());

/// A device that no other test has; one is opened where none is idle.
pub struct Lent(Option<Device>);

impl Deref for Lent {
    type Target = Device;

    fn deref(&self) -> &Device {
        self.0.as_ref().expect("a device until it is given back")
    }
}

impl Drop for Lent {
    fn drop(&mut self) {
        // That of a test that failed may be lost.
        if !std::thread::panicking() {
            IDLE.lock().unwrap_or_else(PoisonError::into_inner).extend(self.0.take());
        }
    }
}

pub fn device() -> Lent {
    let idle = IDLE.lock().unwrap_or_else(PoisonError::into_inner).pop();
    Lent(Some(idle.unwrap_or_else(|| Device::open(None).expect("an adapter"))))
}

/// The model of a scene; mesh files are looked for from `folder`.
pub fn model_in(text: &str, folder: &Path) -> Model {
    let scene = scene::parse(text, "test.toml", folder).unwrap_or_else(|error| panic!("{error:?}\n{text}"));
    Model::new(scene).expect("a model")
}

pub fn model(text: &str) -> Model {
    model_in(text, Path::new(""))
}

/// A scene of the repository, with `[model] particles` and `end_time` (s) replaced.
pub fn published(name: &str, particles: u64, end_time: f64) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    let mut scene = scene::load(&path).expect("a published scene");
    scene.model.particles = Some(particles);
    scene.end_time = end_time;
    scene.output.rows = 40;
    scene.output.snapshots = 0;
    Model::new(scene).expect("a model")
}

pub fn run(model: &Model, options: Options<'_>) -> Run {
    verify::run(&device(), model, options).expect("a run")
}
