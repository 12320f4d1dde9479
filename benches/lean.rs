//! What a scene pays for what it has: `cargo bench --bench lean`.
//!
//! Gas at rest in the same box, the same particles, steps and collisions each time; only what the scene has differs, and
//! with it what its kernels are compiled with. The second row is the first scene by kernels that have nothing left out: what it
//! saves that the first's have. All in turns; prints particle-steps per second of wall time, the median, and the time over that of
//! the bare scene, formed turn by turn.
//!
//! `-- 100000` chooses the number of particles, `-- --steps N` the steps of each run (default 64).

use std::path::Path;
use std::time::Instant;

use corpuscle::gpu::Device;
use corpuscle::ranks::Solo;
use corpuscle::simulation::{Model, Options, Setup, Simulation};
use corpuscle::study::emulation::median;

const REPEATS: usize = 5;
const BARE: &str = "[[gas]]\nname = \"a\"\nmolar_mass = 0.028\ngamma = 1.66666667\n";
const SPIN: &str = "[[gas]]\nname = \"a\"\nmolar_mass = 0.028\ngamma = 1.4\n";
const CURVE: &str = "[[gas]]\nname = \"a\"\nmolar_mass = 0.044\ncp = [23.0, 5.6e-2, -2.2e-5]\n";
const SECOND: &str = "[[gas]]\nname = \"b\"\nmolar_mass = 0.028\ngamma = 1.66666667\n";
const SURFACE: &str = "[[surface]]\nname = \"walls\"\nwall = \"box\"\n";
/// So little leaves that the gas is the same.
const VENT: &str = "[[vent]]\nname = \"vent\"\nwall = \"box\"\nface = \"+x\"\ndischarge = 1e-6\n";
const INFLOW: &str = "[[orifice]]\nname = \"in\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 1e-4\n\
     gas = \"a\"\ntemperature = 300.0\nmass_flow = [[0.0, 1e-4], [1.0, 1e-4]]\n";

fn scene(gases: &str, mixture: &str, wall: &str, more: &str, particles: u64) -> String {
    format!(
        "end_time = 0.0044\n{gases}[[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\n\
         gas = \"inside\"\n{wall}[[chamber]]\nname = \"box\"\npressure = 101325.0\ntemperature = 300.0\ngas = {mixture}\n{more}\
         [model]\nparticles = {particles}\noccupancy = 0.12\n[output]\nsnapshots = 0\n"
    )
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut particles, mut steps) = (100_000, 64);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            // Given by cargo.
            "--bench" => {}
            "--steps" => steps = arguments.next().ok_or("--steps needs a number")?.parse()?,
            number => particles = number.parse()?,
        }
    }
    let device = Device::open(None)?;
    println!("adapter: {}; {particles} particles, {steps} steps", device.adapter().info.name);
    let two = format!("{BARE}{SECOND}");
    let heat = "temperature = 300.0\naccommodation = 1.0\n";
    let all = format!("{SURFACE}{VENT}{INFLOW}");
    let spins = format!("{SPIN}{SECOND}");
    let cases = [
        ("bare: one gas without spin energy", scene(BARE, "\"a\"", "", "", particles)),
        ("spin energy", scene(SPIN, "\"a\"", "", "", particles)),
        ("heat capacity of the temperature", scene(CURVE, "\"a\"", "", "", particles)),
        ("second gas", scene(&two, "{ a = 0.5, b = 0.5 }", "", "", particles)),
        ("measured surface", scene(BARE, "\"a\"", "", SURFACE, particles)),
        ("wall that keeps a temperature", scene(BARE, "\"a\"", heat, "", particles)),
        ("vent", scene(BARE, "\"a\"", "", VENT, particles)),
        ("orifice", scene(BARE, "\"a\"", "", INFLOW, particles)),
        ("all but the curve", scene(&spins, "{ a = 0.5, b = 0.5 }", heat, &all, particles)),
    ];
    let model = |text: &str| -> Result<Model, Box<dyn std::error::Error>> {
        Ok(Model::new(corpuscle::scene::parse(text, "lean.toml", Path::new(""))?)?)
    };
    let mut models = Vec::new();
    for (name, text) in &cases {
        models.push((*name, model(text)?, false));
    }
    // The same particles, steps and collisions, by kernels that a scene with all of that would have.
    models.insert(1, ("the same, by kernels with all but the curve", model(&cases[0].1)?, true));
    let solo = Solo::new();
    let mut seconds = vec![Vec::new(); models.len()];
    for turn in 0..=REPEATS {
        for ((_, model, whole), seconds) in models.iter().zip(&mut seconds) {
            let setup = if *whole { Setup::whole(model, &device)? } else { Setup::new(model, &device, 1, None)? };
            // The first turn pays for the compilation of the kernels.
            let options = Options { stop_after_steps: Some(if turn > 0 { steps } else { 1 }), ..Options::default() };
            let simulation = Simulation::among(model, &device, &setup, &solo, options)?;
            let start = Instant::now();
            let outcome = simulation.run(&mut ())?;
            if turn > 0 {
                seconds.push(start.elapsed().as_secs_f64() / outcome.particle_steps as f64);
            }
        }
    }
    for ((name, ..), own) in models.iter().zip(&seconds) {
        let ratio = median(own.iter().zip(&seconds[0]).map(|(own, bare)| own / bare)).ok_or("no turns")?;
        let own = median(own.iter().copied()).ok_or("no turns")?;
        println!("{name:45} {:8.3} M particle-steps/s, {ratio:.2} of bare", 1e-6 / own);
    }
    Ok(())
}
