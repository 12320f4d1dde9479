//! Law: a run's bits depend on its scene alone (specification, section 9). The history (every f64) and the
//! final state (every byte of every particle) are the same whatever the order of the initial particles, the
//! length of the batches or the growth of buffers on the way, and from run to run.

#[path = "../whole_run/mod.rs"]
mod whole_run;

use std::hash::{DefaultHasher, Hash, Hasher};

use corpuscle::simulation::{Model, Options, Row, ZoneState};
use corpuscle::subdomain::GpuParticle;

use whole_run::{Run, model, published, run};

fn zone_bits(zone: &ZoneState) -> Vec<u64> {
    let scalars = [zone.pressure, zone.temperature, zone.density];
    scalars.iter().chain(&zone.velocity).chain(&zone.particles).map(|value| value.to_bits()).collect()
}

fn row_bits(row: &Row) -> Vec<u64> {
    let mut bits: Vec<u64> = [row.time, row.window[0], row.window[1], row.step].map(f64::to_bits).to_vec();
    bits.push(row.particles);
    bits.extend(row.chambers.iter().chain(&row.probes).flat_map(zone_bits));
    for surface in &row.surfaces {
        bits.push(surface.hits);
        bits.push(surface.pressure.to_bits());
        bits.extend(surface.impulse.map(f64::to_bits));
    }
    bits
}

/// All that must not change.
#[derive(PartialEq)]
struct Bits {
    history: Vec<Vec<u64>>,
    /// Of each snapshot, then of the end.
    state: Vec<u8>,
    collisions: u64,
    steps: u64,
}

impl Bits {
    fn of(run: &Run) -> Bits {
        Bits {
            history: run.rows.iter().map(row_bits).collect(),
            state: run
                .snapshots
                .iter()
                .map(|(_, particles)| particles)
                .chain([&run.outcome.particles])
                .flat_map(|particles| bytemuck::cast_slice::<_, u8>(particles).to_vec())
                .collect(),
            collisions: run.outcome.collisions,
            steps: run.outcome.steps,
        }
    }
}

/// Where two runs part, or `None` if they are the same to the last bit.
fn difference(a: &Bits, b: &Bits) -> Option<String> {
    if a.steps != b.steps || a.collisions != b.collisions {
        return Some(format!("{} steps, {} collisions; {} and {}", a.steps, a.collisions, b.steps, b.collisions));
    }
    if let Some(row) = a.history.iter().zip(&b.history).position(|(a, b)| a != b) {
        return Some(format!("row {row}"));
    }
    if a.history.len() != b.history.len() || a.state.len() != b.state.len() {
        return Some("lengths".into());
    }
    a.state.iter().zip(&b.state).position(|(a, b)| a != b).map(|byte| format!("particle {}", byte / 32))
}

fn assert_same(name: &str, a: &Bits, b: &Bits) {
    assert_eq!(difference(a, b), None, "{name}");
}

/// An order of the particles that depends on `salt` in no regular way.
fn shuffled<const SALT: u64>(particles: &mut [GpuParticle]) {
    particles.sort_by_key(|particle| {
        let mut hasher = DefaultHasher::new();
        (SALT, particle.id()).hash(&mut hasher);
        hasher.finish()
    });
}

fn reversed(particles: &mut [GpuParticle]) {
    particles.reverse();
}

/// The scene again, in every way that must not matter.
fn every_way(model: &Model) -> Bits {
    let first = run(model, Options::default());
    assert!(first.rows.len() > 3, "a history to compare");
    let bits = Bits::of(&first);
    assert_same("a second run", &bits, &Bits::of(&run(model, Options::default())));
    let orders: [(u32, &corpuscle::simulation::Shuffle); 3] =
        [(1, &reversed), (5, &shuffled::<1>), (32, &shuffled::<2>)];
    for (batch, order) in orders {
        let options = Options { batch: Some(batch), shuffle: Some(order), ..Options::default() };
        assert_same(&format!("another order, batches of {batch}"), &bits, &Bits::of(&run(model, options)));
    }
    let options = Options { batch: Some(1), ..Options::default() };
    assert_same("batches of one", &bits, &Bits::of(&run(model, options)));
    bits
}

/// The first 4 ms of the tank with steps so long that the inner box's rise makes them finer.
fn tank(snapshots: u32) -> Model {
    let mut scene = published("tank.toml", 1500, 0.004).scene;
    scene.model.time_step = Some(2e-5);
    scene.output.snapshots = snapshots;
    Model::new(scene).expect("a model")
}

/// Inflow, two gases, two chambers and steps that change.
#[test]
fn tank_has_the_same_bits_in_every_way() {
    every_way(&tank(0));
}

/// A look at the state on the way changes nothing, though the host then waits for the device and so knows
/// the state an interval earlier.
#[test]
fn snapshots_change_no_bit() {
    let alone = run(&tank(0), Options::default());
    let [finest, coarsest] = alone.outcome.step_range;
    assert!(coarsest > 1.5 * finest, "the step does not change");
    let watched = run(&tank(25), Options::default());
    assert!(watched.snapshots.len() > 10);
    let watched = Bits::of(&Run { snapshots: Vec::new(), ..watched });
    assert_same("snapshots", &Bits::of(&alone), &watched);
}

/// Six times as much gas flows in as was there, so the buffers of particles and newborns grow.
#[test]
fn inflow_that_outgrows_the_buffers_has_the_same_bits_in_every_way() {
    let model = model(
        "end_time = 2e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 2e4\ntemperature = 300.0\ngas = \"air\"\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.004\n\
         gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.7], [2e-3, 0.7]]\n\
         [model]\nparticles = 3000\n[output]\nrows = 5\nsnapshots = 0\n",
    );
    let initial = model.plan.initial_particles;
    let room = initial + (initial / 8).max(1024);
    assert!(model.plan.particles > room + 1000, "the buffers for {room} must grow for {}", model.plan.particles);
    every_way(&model);
}

#[test]
fn box_has_the_same_bits_in_every_way() {
    every_way(&published("box.toml", 2000, 4e-4));
}

/// Free flight does not sort its particles: not even its memory is in order.
#[test]
fn effusion_has_the_same_bits_in_every_way() {
    every_way(&published("effusion.toml", 3000, 4e-3));
}

/// Dense gas with long neighbour lists: intervals are run again, and nothing is lost.
fn dense(seed: u64) -> Model {
    model(&format!(
        "end_time = 4e-4\nseed = {seed}\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
         [[surface]]\nname = \"walls\"\nwall = \"box\"\n\
         [model]\nparticles = 1500\noccupancy = 0.4\ntime_step = 1e-5\n[output]\nrows = 5\nsnapshots = 0\n"
    ))
}

#[test]
fn growth_of_neighbour_lists_changes_no_bit_and_loses_nothing() {
    let model = dense(1);
    let first = run(&model, Options::default());
    assert!(first.outcome.repeated > 0, "the lists did not grow");
    assert_eq!(first.outcome.particles.len(), 1500);
    let ids: Vec<u32> = first.outcome.particles.iter().map(GpuParticle::id).collect();
    assert_eq!(ids, (0..1500).collect::<Vec<u32>>());
    every_way(&model);
}

/// The comparison can fail: it tells another seed, and one bit of one particle or of one row.
#[test]
fn another_seed_and_a_single_bit_are_told_apart() {
    let bits = || Bits::of(&run(&dense(1), Options { stop_after_steps: Some(64), ..Options::default() }));
    let first = bits();
    let other = run(&dense(2), Options { stop_after_steps: Some(64), ..Options::default() });
    assert!(difference(&first, &Bits::of(&other)).is_some());
    let mut touched = bits();
    assert_same("before", &first, &touched);
    touched.state[7 * 32 + 5] ^= 1;
    assert_eq!(difference(&first, &touched), Some("particle 7".into()));
    let mut touched = bits();
    touched.history[0][6] ^= 1;
    assert_eq!(difference(&first, &touched), Some("row 0".into()));
}
