//! Law: a run that is stopped at any steps and goes on with any numbers of subdomains leaves the files of one that was
//! never stopped, to the last byte.

use corpuscle::output::{Checkpoint, latest};
use corpuscle::scene::{Method, Scene};
use corpuscle::subdomain::GpuParticle;

use super::program::{Case, Numbers, Program, Results, dense, newest, published, tank};

/// Stops at three random steps, and goes on each time with another number of subdomains. Once more is computed
/// and written than the checkpoint knows, and then thrown away.
fn restarts(scene: &Scene, seed: u64, subdomains: [usize; 4]) -> Case {
    let case = Case::new(scene);
    let mut numbers = Numbers(seed);
    assert!(case.steps >= 160, "{} steps are too few to stop in", case.steps);
    let third = case.steps / 4;
    let stops: Vec<u64> = (0..3).map(|k| k * third + numbers.between(8, third)).collect();
    // Checkpoints come where the run stops.
    let every = ["--checkpoint-every", "1000000"];
    let sharing = subdomains.map(Program::sharing);
    let mut done = 0;
    for (k, stop) in stops.into_iter().enumerate() {
        let stop = stop.max(done + 1).to_string();
        let more = [&every[..], &["--steps", &stop]].concat();
        let running = if k == 0 { case.run(&sharing[k], "out", &more) } else { case.resume(&sharing[k], "out", &more) };
        running.finish();
        done = newest(&case.out("out")).unwrap();
        if k == 1 {
            let kept = latest(&case.out("out")).unwrap();
            let further = (done + third).to_string();
            case.resume(&sharing[0], "out", &["--steps", &further]).finish();
            // A run that went on from a checkpoint leaves one where it stops, unasked; as if it had been killed before:
            let beyond = latest(&case.out("out")).unwrap();
            assert!(newest(&case.out("out")).unwrap() > done, "{}", beyond.display());
            std::fs::remove_dir_all(beyond).unwrap();
            assert_eq!(latest(&case.out("out")).unwrap(), kept);
        }
    }
    let said = case.resume(&sharing[3], "out", &[]).finish();
    assert!(said.contains("Audit"), "{said}");
    case.assert_same("out");
    case
}

#[test]
fn the_tank_goes_on_from_any_step_on_any_number_of_subdomains() {
    let case = restarts(&tank(0.004), 1, [1, 3, 2, 1]);
    let line = case.said.lines().find(|line| line.contains(" steps of ")).unwrap();
    let steps: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
    // Time, number of steps, shortest, longest.
    assert!(steps[3] > 1.5 * steps[2], "the step does not change: {line}");
}

#[test]
fn the_box_with_its_surfaces_goes_on_from_any_step() {
    restarts(&published("box.toml", 1500, 1.6e-3), 2, [7, 1, 4, 8]);
}

/// Where its piston is follows from the clock.
#[test]
fn a_piston_goes_on_from_any_step() {
    let mut scene = published("piston.toml", 1200, 1e-3);
    scene.motions[0].course =
        corpuscle::scene::Course::Velocity(corpuscle::scene::Curve { points: vec![[0.0, 0.0], [6e-4, 60.0]] });
    restarts(&scene, 9, [2, 1, 3, 2]);
    scene.model.method = Some(Method::Cell);
    scene.model.time_step = Some(scene.end_time / 200.0);
    restarts(&scene, 10, [1, 4, 2, 3]);
}

/// Where its nodes are follows from the clock, and its files are kept with the run.
#[test]
fn a_bag_goes_on_from_any_step() {
    let mut scene = published("bag.toml", 1500, 2e-3);
    scene.model.time_step = Some(scene.end_time / 240.0);
    let case = restarts(&scene, 12, [2, 1, 3, 2]);
    let copies = std::fs::read_dir(case.out("out").join("meshes")).expect("copies of meshes").count();
    assert_eq!(copies, 2, "the mesh and its motion");
}

/// Where its nodes are, and how fast, is in the checkpoint.
#[test]
fn an_elastic_bag_goes_on_from_any_step() {
    let mut scene = published("teabag.toml", 1500, 1e-3);
    scene.model.time_step = Some(scene.end_time / 240.0);
    restarts(&scene, 14, [2, 1, 3, 2]);
}

/// What it remembers of the rows, and what it has decided, is in the checkpoint.
#[test]
fn a_run_that_switches_goes_on_from_any_step() {
    let mut scene = tank(0.004);
    scene.model.switch = Some(corpuscle::scene::Switch::WhenUniform { lasting: 2.5e-3 });
    scene.output.rows = 100;
    let case = restarts(&scene, 11, [1, 3, 2, 1]);
    // Where it has decided, and one interval of particles is to come.
    let decided = (case.steps - 32).to_string();
    case.run(&Program::sharing(2), "decided", &["--checkpoint-every", "1000000", "--steps", &decided]).finish();
    case.resume(&Program::sharing(1), "decided", &[]).finish();
    case.assert_same("decided");
    assert!(case.said.contains(" as a control volume: the pressures of all probes"), "{}", case.said);
    scene.model.switch = Some(corpuscle::scene::Switch::At(0.003));
    let case = restarts(&scene, 12, [2, 1, 1, 3]);
    assert!(case.said.contains(" as a control volume: asked for"), "{}", case.said);
}

/// The other methods with collisions; where the tiles of half-turn lie follows from the step.
#[test]
fn cells_and_rigid_spheres_go_on_from_any_step() {
    for (seed, method) in [(5, Method::Cell), (6, Method::HardSphere), (13, Method::HalfTurn)] {
        let mut scene = tank(0.004);
        scene.model.method = Some(method);
        restarts(&scene, seed, [2, 1, 3, 1]);
    }
}

/// Half-turn at rest, in a box within a box, and where gas enters and leaves.
#[test]
fn half_turns_go_on_from_any_step_in_every_scene() {
    let mut vent = published("vent.toml", 1000, 0.004);
    vent.vents[0].opening_pressure = 5e3;
    let scenes = [published("box.toml", 1000, 1e-3), published("effusion.toml", 2000, 2e-3), vent];
    for (seed, mut scene) in (14..).zip(scenes) {
        (scene.model.method, scene.model.occupancy) = (Some(Method::HalfTurn), None);
        scene.model.time_step = Some(scene.end_time / 200.0);
        restarts(&scene, seed, [2, 1, 3, 1]);
    }
}

/// Without collisions particles are dealt out by their ids.
#[test]
fn free_flight_goes_on_from_any_step() {
    restarts(&published("effusion.toml", 2000, 0.008), 3, [3, 1, 2, 3]);
}

/// Who has left is not in the checkpoint, and what vents owe and walls have taken is.
#[test]
fn vents_and_cold_walls_go_on_from_any_step() {
    let mut scene = published("vent.toml", 1500, 0.006);
    scene.model.method = Some(Method::ClosestApproach);
    scene.vents[0].opening_pressure = 5e3;
    let case = restarts(&scene, 5, [1, 2, 3, 1]);
    assert!(case.said.contains("heat to the walls"), "{}", case.said);
}

/// A run that goes on has neighbour lists that fit its gas of then, whatever they were before.
#[test]
fn intervals_that_are_run_again_do_not_matter() {
    let case = restarts(&dense(), 4, [2, 3, 1, 2]);
    assert!(case.said.contains("steps were run again"), "{}", case.said);
}

/// An ended run says so, is left alone, and can still be done anew from one of its checkpoints.
#[test]
fn a_run_that_has_ended_says_so() {
    let case = Case::new(&published("box.toml", 500, 4e-4));
    case.run(&Program::alone(), "out", &["--checkpoint-every", "32"]).finish();
    case.assert_same("out");
    let kept = latest(&case.out("out")).unwrap();
    let said = case.resume(&Program::sharing(2), "out", &[]).finish();
    assert!(said.contains("has reached its end"), "{said}");
    assert_eq!(said.lines().last(), case.out("out").to_str());
    case.assert_same("out");
    let one = kept.strip_prefix(case.out("")).unwrap().to_str().unwrap().to_owned();
    let said = case.resume(&Program::sharing(2), &one, &[]).finish();
    assert!(said.contains("Audit"), "{said}");
    case.assert_same("out");
}

/// The particles are in a checkpoint by id: with `cell` they lie on the device in the order of its threads.
#[test]
fn equal_runs_leave_equal_checkpoints() {
    for method in [Method::Cell, Method::ClosestApproach] {
        let mut scene = published("box.toml", 2000, 8e-4);
        scene.model.method = Some(method);
        let case = Case::new(&scene);
        let particles = |name: &str| -> Vec<GpuParticle> {
            case.run(&Program::alone(), name, &["--checkpoint-every", "32"]).finish();
            let checkpoint = Checkpoint::open(&latest(&case.out(name)).unwrap()).unwrap();
            bytemuck::pod_collect_to_vec(&checkpoint.particles(0).unwrap())
        };
        let first = particles("first");
        assert!(first.len() >= 2000 && first.is_sorted_by_key(GpuParticle::id), "{} particles", first.len());
        assert!(particles("second") == first);
    }
}

/// The comparison can fail: another seed is another gas.
#[test]
fn another_seed_is_told_apart() {
    let mut scene = published("box.toml", 500, 4e-4);
    let case = Case::new(&scene);
    scene.seed += 1;
    let other = Case::new(&scene);
    assert!(case.whole.difference(&other.whole).is_some());
    assert!(case.whole.difference(&Results::of(&case.out("whole"))).is_none());
}
