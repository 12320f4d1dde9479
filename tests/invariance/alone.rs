//! On one device.

use corpuscle::gpu::Recording;
use corpuscle::output::AuditLimits;
use corpuscle::ranks::Solo;
use corpuscle::scene::{DiameterCap, Method, Scene};
use corpuscle::simulation::{Model, Options, Setup, Shuffle, Simulation, initial_particles};
use corpuscle::subdomain::{GpuParticle, Newborns, Steps, Subdomain, SubdomainBox, Tables};

use crate::bits::{Bits, assert_same, difference};
use crate::orders::{reversed, shuffled};
use crate::scenes::{
    burst, by, cold_walls, crowding, dense, driven_fabrics, effusion, first, gas_box, inflated_bag, pistons, plate,
    porous_bag, several_fabrics, shaken_bag, tank, vented_bag, venting, venting_freely,
};
use crate::whole_run::{Run, Witness, device, published, run};

/// The scene again, in every way that must not matter.
fn every_way(model: &Model) -> Bits {
    let first = run(model, Options::default());
    assert!(first.rows.len() > 3, "a history to compare");
    let bits = Bits::of(&first);
    assert_same("a second run", &bits, &Bits::of(&run(model, Options::default())));
    let orders: [(u32, &Shuffle); 3] = [(1, &reversed), (5, &shuffled::<1>), (32, &shuffled::<2>)];
    for (batch, order) in orders {
        let options = Options { batch: Some(batch), shuffle: Some(order), ..Options::default() };
        assert_same(&format!("another order, batches of {batch}"), &bits, &Bits::of(&run(model, options)));
    }
    let options = Options { batch: Some(1), lists_start_short: true, ..Options::default() };
    assert_same("batches of one", &bits, &Bits::of(&run(model, options)));
    bits
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

/// Three times as much gas flows in as was there, so the buffers of particles and newborns grow.
#[test]
fn inflow_that_outgrows_the_buffers_has_the_same_bits_in_every_way() {
    let model = burst();
    let initial = model.plan.initial_particles;
    let room = initial + (initial / 8).max(1024);
    assert!(model.plan.particles > room + 1000, "the buffers for {room} must grow for {}", model.plan.particles);
    every_way(&model);
}

/// Room that is made when a step is recorded and has not run yet loses nothing of it: the particles go to the larger buffer as
/// they are after it.
#[test]
fn room_made_between_recorded_steps_loses_none() {
    let device = device();
    for method in [Method::ClosestApproach, Method::Cell, Method::HalfTurn] {
        let model = by(method, gas_box());
        let setup = Setup::new(&model, &device, 1, None).expect("a set-up");
        let particles = initial_particles(&model).expect("particles");
        let after_two_steps = |room_after: Option<usize>| {
            let place = SubdomainBox::alone(&model.plan);
            let mut subdomain = Subdomain::new(&device, setup.domain.clone(), place, &particles).expect("a subdomain");
            let first_id = particles.len() as u32;
            let newborns = Newborns { of_step: &[0, 0], list: &[], first_id, stride: 1 };
            let dt = model.plan.time_step;
            let tables = Tables::default();
            let steps = Steps { first: 0, done: 0, dt, tallied: &[false; 2] };
            let slots = subdomain.begin_interval(&device, &steps, &newborns, &tables).expect("room");
            let mut rec = Recording::new(&device);
            for (k, slot) in slots.iter().enumerate() {
                subdomain.reset(&mut rec);
                subdomain.bin(&mut rec, slot);
                subdomain.scan(&mut rec, slot);
                subdomain.sort(&mut rec, slot);
                subdomain.neighbours(&mut rec, slot);
                subdomain.collide(&mut rec, slot);
                for round in 0..model.plan.rounds {
                    subdomain.choose(&mut rec, slot, round);
                    subdomain.settle(&mut rec, slot, round);
                }
                subdomain.clear_cells(&mut rec, slot);
                subdomain.advect(&mut rec, slot);
                if room_after == Some(k) {
                    subdomain.make_room(&mut rec, 3 * particles.len() as u64, 0, 0).expect("more room");
                }
            }
            rec.submit();
            let mut particles = subdomain.particles(&device).expect("the particles");
            // Those of a cell lie in the order of the threads.
            particles.sort_by_key(GpuParticle::id);
            particles
        };
        let plain = after_two_steps(None);
        assert_eq!(plain.len(), particles.len());
        for k in 0..2 {
            assert_eq!(after_two_steps(Some(k)), plain, "{method:?}, room after step {k}");
        }
    }
}

/// What the suite's scene of a dense and a thin side shows of capped diameters and rough walls: both change its bits.
#[test]
fn dense_gas_and_a_rough_wall_have_the_same_bits_in_every_way() {
    let model = plate();
    let bits = every_way(&model);
    let other = |change: &dyn Fn(&mut Scene)| {
        let mut scene = model.scene.clone();
        change(&mut scene);
        Bits::of(&run(&Model::new(scene).expect("a model"), Options::default()))
    };
    let uncapped = other(&|scene| scene.model.diameter_cap = Some(DiameterCap::Off));
    assert!(difference(&bits, &uncapped).is_some(), "no diameter was capped");
    let smooth = other(&|scene| scene.walls[1].surface.friction = 0.0);
    assert!(difference(&bits, &smooth).is_some(), "no wall was rough");
}

#[test]
fn box_has_the_same_bits_in_every_way() {
    every_way(&gas_box());
}

/// Walls that move, in a straight line and back, among newborns.
#[test]
fn pistons_have_the_same_bits_in_every_way() {
    let model = pistons();
    let first = run(&model, Options::default());
    assert!(first.outcome.audit.verdict(&AuditLimits::default()).is_empty(), "{:?}", first.outcome.audit);
    let last = first.rows.last().expect("a row");
    assert!(last.motions.iter().all(|motion| motion.work != 0.0), "{:?}", last.motions);
    every_way(&model);
    every_way(&by(Method::Cell, pistons()));
}

/// Walls that exchange heat draw random numbers, and follow the gas.
#[test]
fn cold_walls_have_the_same_bits_in_every_way() {
    let model = cold_walls();
    let first = run(&model, Options::default());
    let last = first.rows.last().expect("a row");
    assert!(last.walls.iter().all(|wall| wall.heat > 0.0) && last.walls.len() == 2, "{:?}", last.walls);
    assert_eq!(first.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    every_way(&model);
}

/// Particles leave, and the host knows of it two intervals late; their slots are used again.
#[test]
fn vents_have_the_same_bits_in_every_way() {
    let model = venting();
    let first = run(&model, Options::default());
    let audit = &first.outcome.audit;
    assert!(audit.particles_vented > 20 && audit.particles_injected > 20, "{audit:?}");
    assert_eq!(audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    assert_eq!(first.rows.last().map(|row| row.particles), Some(audit.particles_inside));
    every_way(&model);
}

#[test]
fn vents_in_free_flight_have_the_same_bits_in_every_way() {
    let model = venting_freely();
    let first = run(&model, Options::default());
    assert!(first.outcome.audit.particles_vented > 20, "{:?}", first.outcome.audit);
    assert_eq!(first.outcome.audit.verdict(&AuditLimits::default()), Vec::<String>::new());
    every_way(&model);
}

/// Inflow, two gases, and cells that a wall with a hole parts.
#[test]
fn collisions_within_cells_have_the_same_bits_in_every_way() {
    every_way(&by(Method::Cell, tank(0)));
    every_way(&by(Method::Cell, plate()));
}

/// Gas at rest and a box within a box; inflow, two gases, walls that move, vents, and a wall with a hole through collision cells.
#[test]
fn half_turns_have_the_same_bits_in_every_way() {
    every_way(&by(Method::HalfTurn, gas_box()));
    every_way(&by(Method::HalfTurn, first(0.25, effusion())));
    every_way(&by(Method::HalfTurn, tank(0)));
    every_way(&by(Method::HalfTurn, plate()));
    every_way(&by(Method::HalfTurn, pistons()));
    every_way(&by(Method::HalfTurn, venting()));
}

#[test]
fn a_shaken_bag_has_the_same_bits_in_every_way() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        every_way(&shaken_bag(method));
    }
}

/// What passes its pores has another side from then on.
#[test]
fn a_porous_bag_has_the_same_bits_in_every_way() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        every_way(&porous_bag(method));
    }
    every_way(&vented_bag(Method::HalfTurn));
}

#[test]
fn several_fabrics_have_the_same_bits_in_every_way() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        every_way(&several_fabrics(method));
    }
}

#[test]
fn fabric_among_what_moves_has_the_same_bits_in_every_way() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        every_way(&driven_fabrics(method));
    }
}

#[test]
fn an_inflated_bag_has_the_same_bits_in_every_way() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        every_way(&inflated_bag(method));
    }
}

#[test]
fn rigid_spheres_have_the_same_bits_in_every_way() {
    every_way(&by(Method::HardSphere, plate()));
}

/// A software device reads the numbers of a scene in short runs; where all are compiled in it rounds alike.
#[test]
fn numbers_read_and_compiled_in_give_the_same_bits() {
    let device = device();
    let scenes = [tank(0), plate(), pistons(), cold_walls(), venting(), venting_freely(), effusion()];
    let more = [
        by(Method::Cell, tank(0)),
        by(Method::Cell, pistons()),
        by(Method::HardSphere, plate()),
        by(Method::HalfTurn, tank(0)),
        by(Method::HalfTurn, pistons()),
    ];
    for model in scenes.into_iter().chain(more) {
        let [read, fixed] = [Setup::new(&model, &device, 1, None), Setup::fixed(&model, &device)].map(|setup| {
            let setup = setup.expect("a set-up");
            let mut witness = Witness::default();
            let alone = Solo::new();
            let simulation = Simulation::among(&model, &device, &setup, &alone, Options::default());
            let outcome = simulation.and_then(|simulation| simulation.run(&mut witness)).expect("a run");
            let run = Run { rows: witness.rows, snapshots: witness.snapshots, outcome };
            (setup.domain.has_runtime_constants(), Bits::of(&run))
        });
        assert_eq!((read.0, fixed.0), (device.adapter().is_cpu(), false), "{} particles", model.plan.particles);
        assert_same("numbers compiled in", &read.1, &fixed.1);
    }
}

/// Free flight does not sort its particles: not even its memory is in order.
#[test]
fn effusion_has_the_same_bits_in_every_way() {
    every_way(&effusion());
}

#[test]
fn growth_of_neighbour_lists_changes_no_bit_and_loses_nothing() {
    let model = dense(1);
    let first = run(&model, Options { lists_start_short: true, ..Options::default() });
    assert!(first.outcome.repeated > 0, "the lists did not grow");
    assert_eq!(first.outcome.particles.len(), 1500);
    let ids: Vec<u32> = first.outcome.particles.iter().map(GpuParticle::id).collect();
    assert_eq!(ids, (0..1500).collect::<Vec<u32>>());
    every_way(&model);
}

/// Where room is made for no more than is wanted the device is held again and again, in steps in which particles enter (seen: in the third to the last of
/// intervals; the tank's is held in the first), and goes on from there as if it had not been. Of the second gas the buffers of particles grow, too, also
/// while it is held and the host does not know it yet.
#[test]
fn a_device_that_is_held_goes_on_as_if_it_had_not_been() {
    for model in [crowding(1200, 0.01), crowding(6000, 0.006)] {
        let held = run(&model, Options { lists_start_short: true, ..Options::default() });
        let free = run(&model, Options::default());
        let [more, fewer] = [&held, &free].map(|run| run.outcome.repeated);
        assert!(more > 12 + fewer, "{more} and {fewer}");
        assert!(held.outcome.audit.verdict(&AuditLimits::default()).is_empty(), "{:?}", held.outcome.audit);
        assert_same("a device that is held", &Bits::of(&free), &Bits::of(&held));
        let counts = |run: &Run| (run.outcome.steps, run.outcome.collisions, run.outcome.bounces);
        assert_eq!(counts(&held), counts(&free));
    }
}

/// Gas that is dense from the start has lists that fit from the start, and no interval runs twice.
#[test]
fn lists_fit_the_gas_at_the_start() {
    let corner = run(&published("corner.toml", 20_000, 2e-5), Options::default());
    assert_eq!(corner.outcome.repeated, 0);
    let model = dense(1);
    let fitted = run(&model, Options::default());
    assert_eq!(fitted.outcome.repeated, 0);
    let grown = run(&model, Options { lists_start_short: true, ..Options::default() });
    assert!(grown.outcome.repeated > 0, "lists as short as they can be are long enough");
    assert_same("lists that grow", &Bits::of(&fitted), &Bits::of(&grown));
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
