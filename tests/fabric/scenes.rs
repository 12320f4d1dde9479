//! Scenes of a box with fabric in it.

use corpuscle::geometry::{NodeFrames, Precision, TriangleMesh};
use corpuscle::scene::Method;
use corpuscle::simulation::{Model, Options};
use tempfile::TempDir;

use crate::whole_run::{Run, model_in, run};

/// Lengths in m.
pub struct Scene {
    pub method: Method,
    pub mesh: TriangleMesh,
    pub frames: Option<NodeFrames>,
    /// Of the box.
    pub low: [f64; 3],
    pub high: [f64; 3],
    pub particles: u32,
    pub seed: u32,
    pub end: f64,
    pub step: Option<f64>,
    pub rows: u32,
    /// TOML.
    pub chambers: String,
    /// TOML of elastic fabric: its other keys, and its material.
    pub elastic: String,
    /// Of elastic fabric, free of stress.
    pub reference: Option<TriangleMesh>,
    /// m/s2.
    pub gravity: [f64; 3],
}

pub const ALIKE: &str = "[[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n";

/// Pressures inside of the fabric, and outside.
pub fn inside_and_outside(inside: f64, outside: f64) -> String {
    format!(
        "[[chamber]]\nname = \"in\"\ninside = \"bag\"\npressure = {inside:e}\ntemperature = 300.0\ngas = \"air\"\n\
         [[chamber]]\nname = \"out\"\npressure = {outside:e}\ntemperature = 300.0\ngas = \"air\"\n"
    )
}

impl Scene {
    pub fn new(method: Method, mesh: TriangleMesh, frames: Option<NodeFrames>) -> Scene {
        Scene {
            method,
            mesh,
            frames,
            low: [0.0; 3],
            high: [0.1; 3],
            particles: 3000,
            seed: 1,
            end: 1e-3,
            step: None,
            rows: 5,
            chambers: ALIKE.into(),
            elastic: String::new(),
            reference: None,
            gravity: [0.0; 3],
        }
    }

    pub fn text(&self, folder: &TempDir) -> String {
        let mesh = folder.path().join("bag.obj");
        self.mesh.write(&mesh, 1.0).expect("a mesh file");
        let motion = self.frames.as_ref().map_or("", |frames| {
            frames.write(&folder.path().join("bag.nodes"), Precision::Double).expect("a file of nodes");
            "motion = \"bag.nodes\"\n"
        });
        let reference = self.reference.as_ref().map_or("", |reference| {
            reference.write(&folder.path().join("reference.obj"), 1.0).expect("a mesh file");
            "reference = \"reference.obj\"\n"
        });
        let Scene { method, low, high, particles, seed, end, rows, chambers, elastic, .. } = self;
        let gravity = if self.gravity == [0.0; 3] { String::new() } else { format!("gravity = {:?}\n", self.gravity) };
        let step = self.step.map_or(String::new(), |step| format!("time_step = {step:e}\n"));
        format!(
            "end_time = {end:e}\nseed = {seed}\n{gravity}[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = {low:?}\nmax = {high:?}\ngas = \"inside\"\n\
             [[fabric]]\nname = \"bag\"\nfile = \"bag.obj\"\n{motion}{reference}{elastic}{chambers}\
             [model]\nmethod = \"{}\"\nparticles = {particles}\n{step}[output]\nrows = {rows}\nsnapshots = 0\n",
            method.name()
        )
    }

    pub fn model(&self) -> Model {
        let folder = TempDir::new().expect("a folder");
        model_in(&self.text(&folder), folder.path())
    }

    pub fn run(&self) -> (Model, Run) {
        let model = self.model();
        let run = run(&model, Options::default());
        (model, run)
    }
}

/// Particles whose tag says another side than the parity of triangles beyond their place, by id.
pub fn on_the_wrong_side(model: &Model, run: &Run, time: f64) -> Vec<u32> {
    let bags = model.fabric.bags(time).expect("closed fabric");
    let particles = run.outcome.particles.iter();
    particles
        .filter(|particle| {
            let place = model.plan.grid.to_metres(particle.position);
            bags.iter().flatten().any(|bag| bag.contains(place)) != particle.is_inside()
        })
        .map(|particle| particle.id())
        .collect()
}
