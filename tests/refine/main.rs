//! Law: a refined state is the state of its parent in more and smaller particles, and a run goes on from it.

mod scenes;

use corpuscle::geometry::Vessel;
use corpuscle::output::Checkpoint;
use corpuscle::scene::GAS_CONSTANT;
use corpuscle::simulation::{Model, RefineError, Refined, audit_limits, chamber_of, refine};
use corpuscle::subdomain::GpuParticle;

use scenes::{Cut, across, half_turn_tank, mixing, tank, thin_wall};

/// Of all particles of some kind, SI.
#[derive(Debug, Clone, Copy, Default)]
struct Gas {
    number: f64,
    mass: f64,
    momentum: [f64; 3],
    kinetic: f64,
    spin: f64,
}

impl Gas {
    fn of<'a>(model: &Model, particles: impl Iterator<Item = &'a GpuParticle>) -> Gas {
        let plan = &model.plan;
        let heaviest = plan.gases.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max);
        let mut sums = Gas::default();
        for particle in particles {
            let mass = plan.gases[usize::from(particle.gas())].molar_mass * plan.moles_per_particle;
            let velocity = particle.velocity.map(f64::from);
            sums.number += 1.0;
            sums.mass += mass;
            sums.kinetic += 0.5 * mass * velocity.iter().map(|v| v * v).sum::<f64>();
            sums.spin += f64::from(particle.spin) * heaviest * plan.moles_per_particle;
            for (total, v) in sums.momentum.iter_mut().zip(velocity) {
                *total += mass * v;
            }
        }
        sums
    }

    fn energy(&self) -> f64 {
        self.kinetic + self.spin
    }

    fn velocity(&self) -> [f64; 3] {
        self.momentum.map(|momentum| momentum / self.mass)
    }

    fn temperature(&self, model: &Model) -> f64 {
        let bulk = self.momentum.iter().map(|p| p * p).sum::<f64>() / self.mass;
        (2.0 * self.kinetic - bulk) / (3.0 * self.number * model.plan.moles_per_particle * GAS_CONSTANT)
    }
}

fn place(model: &Model, particle: &GpuParticle) -> [f64; 3] {
    model.plan.grid.to_metres(particle.position)
}

fn refined(cut: &Cut, times: u64) -> Refined {
    refine(&cut.model, &cut.state, &cut.particles, times).unwrap()
}

/// In gas, or behind a wall by no more than a particle may be.
fn in_gas(vessel: &Vessel, point: [f64; 3]) -> bool {
    let near = |axis: usize, by: f64| {
        let mut near = point;
        near[axis] += by;
        vessel.is_gas(near)
    };
    vessel.is_gas(point) || (0..3).any(|axis| near(axis, 1e-6) || near(axis, -1e-6))
}

#[test]
fn there_are_the_particles_of_a_run_of_the_refined_scene() {
    for (cut, times) in [(tank(), 2), (tank(), 10), (tank(), 50), (mixing(), 7)] {
        let refined = refined(cut, times);
        let (plan, report) = (&refined.model.plan, &refined.report);
        assert!((plan.moles_per_particle * times as f64 / cut.model.plan.moles_per_particle - 1.0).abs() < 1e-12);
        assert!(refined.particles.iter().zip(0..).all(|(particle, id)| particle.id() == id));
        let (found, even) = (refined.particles.len() as u64, times * cut.particles.len() as u64);
        assert_eq!(found + report.dropped, even + report.added);
        // Of each chamber and gas, and of each gas of each orifice, half a parent at most.
        let streams = (plan.gases.len() * plan.chambers.len() + plan.gases.len()) as u64;
        assert!(report.added + report.dropped <= streams * times.div_ceil(2), "{report:?}");
        // Initial ids have the gases of the plan.
        let mut first = 0;
        for chamber in &plan.chambers {
            for (gas, &count) in chamber.particles.iter().enumerate() {
                let own = &refined.particles[first..first + count as usize];
                assert!(own.iter().all(|particle| usize::from(particle.gas()) == gas));
                first += count as usize;
            }
        }
        assert_eq!(first as u64, plan.initial_particles);
    }
}

/// All of the gas, and the report's worst group.
#[test]
fn mass_momentum_and_energy_are_kept() {
    for (cut, times) in [(tank(), 2), (tank(), 10), (tank(), 50), (mixing(), 10)] {
        let refined = refined(cut, times);
        let (before, after) =
            (Gas::of(&cut.model, cut.particles.iter()), Gas::of(&refined.model, refined.particles.iter()));
        let report = &refined.report;
        assert!(report.momentum_error < 1e-6 && report.energy_error < 1e-6, "{report:?}");
        assert!(report.groups > 50);
        // Children more or less bring the mean of their group: at most a few times the energy of the mean particle.
        let rounding = (report.added + report.dropped) as f64 / refined.particles.len() as f64;
        assert!((after.mass / before.mass - 1.0).abs() <= 1e-9 + rounding);
        assert!((after.energy() / before.energy() - 1.0).abs() <= 1e-6 + 10.0 * rounding);
        let scale = (2.0 * before.mass * before.energy()).sqrt();
        for axis in 0..3 {
            assert!((after.momentum[axis] - before.momentum[axis]).abs() <= scale * (1e-6 + 3.0 * rounding));
        }
        // Internal energy apart: it is not mixed up with that of translation.
        assert!((after.spin / before.spin - 1.0).abs() <= 1e-6 + 10.0 * rounding);
    }
}

#[test]
fn each_gas_keeps_its_number_density_and_temperature_where_it_is() {
    let cut = tank();
    let refined = refined(cut, 20);
    for chamber in 0..2 {
        let own = |model: &Model, particles: &[GpuParticle]| -> Gas {
            let scene = &cut.model.scene;
            let inside = |point| chamber_of(scene, &cut.model.vessel, point) == Some(chamber);
            Gas::of(model, particles.iter().filter(|particle| inside(place(model, particle))))
        };
        let (before, after) = (own(&cut.model, &cut.particles), own(&refined.model, &refined.particles));
        // Chambers are kept apart: their mass and energy are exact but for the few by rounding.
        let rounding = (refined.report.added + refined.report.dropped) as f64 / after.number;
        assert!((after.mass / before.mass - 1.0).abs() <= rounding + 1e-9, "{chamber}");
        let (hot, cold) = (before.temperature(&cut.model), after.temperature(&refined.model));
        assert!((cold / hot - 1.0).abs() < 1e-3 + 2.0 * rounding, "{hot} {cold}");
    }
    let half = |model: &Model, particles: &[GpuParticle], upper: bool| {
        Gas::of(model, particles.iter().filter(|particle| (place(model, particle)[1] > 0.0) == upper))
    };
    for upper in [false, true] {
        let before = half(&cut.model, &cut.particles, upper);
        let after = half(&refined.model, &refined.particles, upper);
        // A child is within half its parent's share of the volume: only a layer of parents at the plane can change sides.
        let error = (before.number).powf(1.0 / 3.0) / before.number;
        assert!((after.mass / before.mass - 1.0).abs() < error, "{} {}", after.mass, before.mass);
        assert!((after.temperature(&refined.model) / before.temperature(&cut.model) - 1.0).abs() < 5.0 * error);
        let speed = (2.0 * before.kinetic / before.mass).sqrt();
        for axis in 0..3 {
            assert!((after.velocity()[axis] - before.velocity()[axis]).abs() < 5.0 * error * speed);
        }
    }
}

/// The parent of each child, where there is one gas: see the head of the module that deals them out.
fn parents_of(cut: &Cut, refined: &Refined) -> Vec<GpuParticle> {
    let mut parents = cut.particles.clone();
    parents.sort_by_key(GpuParticle::id);
    let (count, total) = (parents.len(), refined.particles.len());
    parents
        .iter()
        .enumerate()
        .flat_map(|(rank, parent)| vec![*parent; (rank + 1) * total / count - rank * total / count])
        .collect()
}

/// A plate parts the space, whether it is also the border of two chambers or has both on either side.
#[test]
fn no_child_is_behind_a_wall() {
    for (cut, border) in [(thin_wall(), 0), (across(), 1)] {
        for times in [2, 30] {
            let refined = refined(cut, times);
            let vessel = &refined.model.vessel;
            let mut sides = [0, 0];
            for (child, parent) in refined.particles.iter().zip(parents_of(cut, &refined)) {
                let (point, from) = (place(&refined.model, child), place(&cut.model, &parent));
                assert!(in_gas(vessel, point), "{point:?}");
                // On its side of the plate, and in its chamber.
                for axis in [0, border] {
                    assert!((point[axis] > 0.0) == (from[axis] > 0.0), "{from:?} to {point:?}");
                }
                // Half an edge of the cube on each axis at most, where gas is thinnest; but really around it.
                assert!((0..3).all(|axis| (point[axis] - from[axis]).abs() < 0.02), "{from:?} to {point:?}");
                sides[usize::from(point[0] > 0.0)] += 1;
            }
            assert!(sides[0] > 0 && sides[1] > 0);
            assert!((refined.report.at_parent as f64) < 1e-3 * refined.particles.len() as f64);
        }
    }
}

/// Even gas stays even up to the wall: had children behind it been refused, and not mirrored, the outermost layer would
/// have ln 2 of the density.
#[test]
fn the_layer_at_the_walls_has_its_share() {
    let cut = thin_wall();
    let refined = refined(cut, 30);
    // Distance to the nearest wall of those on the left.
    let distances = |model: &Model, particles: &[GpuParticle]| -> Vec<f64> {
        let points = particles.iter().map(|particle| place(model, particle)).filter(|point| point[0] < 0.0);
        let to_side = |z: f64| 0.05 - z.abs();
        let distance = |[x, y, z]: [f64; 3]| (x + 0.1).min(-5e-5 - x).min(to_side(y)).min(to_side(z));
        points.map(distance).collect()
    };
    let before = distances(&cut.model, &cut.particles);
    let after = distances(&refined.model, &refined.particles);
    let edge = (1e-3 / before.len() as f64).cbrt();
    let depth = edge / 16.0;
    let found = after.iter().filter(|&&distance| distance < depth).count() as f64;
    let share = found / after.len() as f64 / (1.0 - (1.0 - 2.0 * depth / 0.1).powi(3));
    // Only parents within half an edge have children there.
    let near = before.iter().filter(|&&distance| distance < 0.5 * edge).count() as f64;
    let error = 4.0 / near.sqrt();
    assert!((share - 1.0).abs() < error && error < 0.2, "{share} {error}");
}

#[test]
fn a_refined_state_depends_on_nothing_but_its_parent() {
    let cut = mixing();
    let first = refined(cut, 5);
    let mut shuffled = cut.particles.clone();
    shuffled.reverse();
    shuffled.rotate_left(777);
    let second = refine(&cut.model, &cut.state, &shuffled, 5).unwrap();
    assert!(first.particles == second.particles && first.state == second.state && first.report == second.report);
    let mut other = cut.particles.clone();
    other[0].velocity[0] += 1.0;
    assert!(refine(&cut.model, &cut.state, &other, 5).unwrap().particles != first.particles);
}

/// Velocities are new ones, Maxwellian: the kurtosis of one component about the mean of a whole gas at rest is 3.
#[test]
fn children_are_not_copies_of_their_parents() {
    let cut = thin_wall();
    let refined = refined(cut, 10);
    let velocities: Vec<f64> = refined.particles.iter().map(|particle| f64::from(particle.velocity[0])).collect();
    let moment = |power: i32| velocities.iter().map(|v| v.powi(power)).sum::<f64>() / velocities.len() as f64;
    let kurtosis = moment(4) / moment(2).powi(2);
    // The temperatures of groups of 16 scatter by a fifth, which adds 3 x .04.
    assert!(kurtosis > 2.95 && kurtosis < 3.3, "{kurtosis}");
    let mut seen: Vec<[u32; 3]> =
        refined.particles.iter().map(|particle| particle.velocity.map(f32::to_bits)).collect();
    seen.sort_unstable();
    seen.dedup();
    assert!(seen.len() as f64 > 0.999 * refined.particles.len() as f64);
}

#[test]
fn what_cannot_be_refined_is_refused_with_the_reason() {
    let cut = tank();
    let fails = |particles: &[GpuParticle], times| match refine(&cut.model, &cut.state, particles, times) {
        Ok(_) => panic!("refined"),
        Err(error) => error,
    };
    for times in [0, 1] {
        assert!(matches!(fails(&cut.particles, times), RefineError::Times { .. }));
    }
    for times in [1 << 20, u64::MAX] {
        let error = fails(&cut.particles, times);
        assert!(matches!(error, RefineError::TooMany { .. }) && error.to_string().contains("134217727"), "{error}");
    }
    let error = fails(&cut.particles[1..], 2);
    assert!(matches!(error, RefineError::Particles { .. }), "{error}");
    let other = mixing();
    assert!(matches!(refine(&cut.model, &other.state, &cut.particles, 2), Err(RefineError::State(_))));
    // A flow's first particle of many enters before the first of few.
    let early = scenes::early();
    let error = refine(&early.model, &early.state, &early.particles, 10).err().unwrap();
    assert!(matches!(error, RefineError::NoParents { .. }) && error.to_string().contains("nitrogen"), "{error}");
}

/// The run goes on: its account closes, and its rows are the parent's within the noise.
#[test]
fn a_run_goes_on_from_a_refined_state() {
    goes_on(tank());
}

/// Its collision cells are those of the new density.
#[test]
fn a_run_of_half_turn_goes_on_from_a_refined_state() {
    let cut = half_turn_tank();
    goes_on(cut);
    let cell = |cut: &Model| cut.plan.grid.cell;
    let finer = cell(&cut.model) / cell(&refined(cut, 4).model);
    assert!((finer / 4f64.cbrt() - 1.0).abs() < 0.01, "{finer}");
}

fn goes_on(cut: &Cut) {
    let refined = refined(cut, 4);
    let steps = 192;
    let parent = scenes::go_on(&cut.model, &cut.particles, &cut.state, cut.step + steps);
    let child = scenes::go_on(&refined.model, &refined.particles, &refined.state, 2 * steps);
    let (audit, limits) = (&child.outcome.audit, audit_limits(&refined.model.plan));
    assert_eq!(audit.verdict(&limits), Vec::<String>::new());
    assert_eq!(audit.particles_initial, refined.particles.len() as u64);
    assert!(audit.particles_injected > 0 && audit.energy_error().abs() < 1e-4);
    let (before, after) = (&parent.rows[0], &child.rows[0]);
    assert!((after.window[0] - cut.time).abs() < 1e-9);
    // The vent's own probe holds too few to tell.
    let (chambers, probes) = (before.chambers.iter().zip(&after.chambers), before.probes.iter().zip(&after.probes));
    for (a, b) in chambers.chain(probes.skip(1)) {
        let number: f64 = a.particles.iter().sum();
        assert!(number > 90.0, "{number}");
        let error = 5.0 * (2.0 / 3.0 / number).sqrt();
        assert!((b.pressure / a.pressure - 1.0).abs() < error, "{} {}", b.pressure, a.pressure);
        assert!((b.temperature / a.temperature - 1.0).abs() < error);
        let (density, bulk) = (b.density / a.density, (2.0 * GAS_CONSTANT * a.temperature / 0.028).sqrt());
        assert!((density - 1.0).abs() < 5.0 * (2.0 / number).sqrt(), "{density}");
        assert!((0..3).all(|axis| (b.velocity[axis] - a.velocity[axis]).abs() < 5.0 * (2.0 / number).sqrt() * bulk));
    }
    // The check can fail: the two chambers differ by more than their noise lets them.
    let [inner, outer] = [&before.chambers[0], &before.chambers[1]];
    let number: f64 = inner.particles.iter().sum();
    assert!((inner.pressure / outer.pressure - 1.0).abs() > 5.0 * (2.0 / 3.0 / number).sqrt());
}

/// The checkpoint that the program writes has the state that the library makes.
#[test]
fn the_program_refines_a_folder() {
    let cut = mixing();
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("mixing");
    cut.write(&run);
    let program = |arguments: &[&str]| {
        let mut command = assert_cmd::Command::cargo_bin("corpuscle").unwrap();
        command.current_dir(folder.path()).arg("refine").args(arguments).output().unwrap()
    };
    let output = program(&["mixing", "--times", "3"]);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{text}{}", String::from_utf8_lossy(&output.stderr));
    let written = folder.path().join("mixing-x3/checkpoints/step-0000000000");
    assert!(text.contains("mixing-x3/checkpoints/step-0000000000"), "{text}");
    let checkpoint = Checkpoint::open(&written).unwrap();
    let refined = refined(cut, 3);
    assert!(checkpoint.particles(0).unwrap() == bytemuck::cast_slice::<_, u8>(&refined.particles));
    let (output, state) = checkpoint.state::<corpuscle::simulation::RunState>().unwrap();
    assert!(state == refined.state && output.history.rows == 0);
    checkpoint.check_plan(&refined.model.plan.to_toml().unwrap()).unwrap();
    for (arguments, expected) in [
        (&["mixing", "--times", "3", "--out", "mixing"][..], "is the folder of the run to be refined"),
        (&["nothing", "--times", "3"], "nothing"),
        (&["mixing", "--times", "1"], "--times"),
        (&["mixing", "--times", "100000000"], "more than the"),
    ] {
        let output = program(arguments);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.code() == Some(2) && text.contains(expected), "{text}");
    }
    assert!(run.join("checkpoints").is_dir());
}
