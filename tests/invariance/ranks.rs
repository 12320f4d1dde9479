//! Among ranks.

use corpuscle::partition::By;
use corpuscle::ranks::Pace;
use corpuscle::scene::Method;
use corpuscle::simulation::BalanceMode::{self, Dynamic, Forced, Initial, Off};
use corpuscle::simulation::{Ghosts, Model, Options};
use corpuscle::subdomain::few_stretches;

use crate::among::{Way, World};
use crate::bits::{Bits, assert_same};
use crate::orders::{shuffled, with_fast_ones};
use crate::scenes::{
    burst, by, cold_walls, curves, dense, driven_fabrics, effusion, first, gas_box, inflated_bag, pistons, plate,
    porous_bag, several_fabrics, shaken_bag, switching, tank, thin, tube, vented_bag, venting, venting_freely,
};
use crate::whole_run::{Run, run};

/// The scene by one rank and by others in these ways; returns all the runs, the first alone.
pub fn same(model: &Model, ways: &[Way]) -> Vec<Run> {
    let first = run(model, Options::default());
    assert!(first.rows.len() > 3, "a history to compare");
    let bits = Bits::of(&first);
    let world = World::new(model);
    let mut runs = vec![first];
    for way in ways {
        let among = world.run(way);
        assert_same(&way.name(), &bits, &Bits::of(&among));
        let owners = &among.outcome.owners;
        assert!((0..way.ranks as u32).all(|rank| owners.contains(&rank)), "{}: someone owns nothing", way.name());
        runs.push(among);
    }
    runs
}

/// Few ways, with every number of ranks, mode, depth and pace among them.
fn some_ways() -> Vec<Way> {
    vec![
        Way::new(1, Dynamic, 2),
        Way::new(2, Dynamic, 1),
        Way { batch: Some(1), ghosts: Some(Ghosts::OnDemand), ..Way::new(3, Forced { seed: 1 }, 2) },
        Way { order: Some(&shuffled::<3>), ..Way::new(4, Initial, 4) },
        Way::new(7, Off, 8).over_places(),
        Way { batch: Some(3), ..Way::new(8, Forced { seed: 2 }, 2) },
    ]
}

/// All of them; what else must not matter takes turns.
fn all_ways() -> Vec<Way> {
    let modes: [BalanceMode; 6] = [Off, Initial, Dynamic, Forced { seed: 1 }, Forced { seed: 2 }, Forced { seed: 3 }];
    let mut ways = Vec::new();
    for ranks in [1, 2, 3, 4, 7, 8] {
        for mode in modes {
            for halo_rounds in [Some(1), Some(2), Some(4), Some(8), None] {
                let turn = ways.len();
                ways.push(Way {
                    pace: if turn.is_multiple_of(2) { Pace::Together } else { Pace::OneAtATime },
                    batch: [None, Some(1), Some(5)][turn % 3],
                    order: if turn % 5 < 2 { Some(&shuffled::<4>) } else { None },
                    ghosts: [Some(Ghosts::OnDemand), Some(Ghosts::All), Some(Ghosts::OnDemand), None][turn % 4],
                    over_places: turn % 7 == 3,
                    ..Way::new(ranks, mode, halo_rounds)
                });
            }
        }
    }
    ways
}

pub fn rebalanced(run: &Run) -> usize {
    run.outcome.rebalances
}

/// Inflow, two gases, two chambers, an inner box with a hole, and steps that change.
#[test]
fn tank_has_the_same_bits_on_any_number_of_ranks() {
    let ways = [
        Way::new(2, Dynamic, 1).over_places(),
        Way { batch: Some(3), ..Way::new(4, Forced { seed: 2 }, 2) },
        Way { order: Some(&shuffled::<3>), ..Way::new(7, Initial, None) },
    ];
    let runs = same(&tank(0), &ways);
    let [finest, coarsest] = runs[0].outcome.step_range;
    assert!(coarsest > 1.5 * finest, "the step does not change");
    assert!(rebalanced(&runs[2]) > 1, "the cuts do not move");
    assert!(runs[0].outcome.collisions > 1000);
}

/// Where walls are is a function of the time alone.
#[test]
fn pistons_have_the_same_bits_on_any_number_of_ranks() {
    let ways = [
        Way::new(2, Dynamic, 1),
        Way { batch: Some(1), ghosts: Some(Ghosts::OnDemand), ..Way::new(3, Forced { seed: 1 }, 2) },
        Way { order: Some(&shuffled::<3>), ..Way::new(5, Forced { seed: 2 }, None) },
    ];
    let runs = same(&pistons(), &ways);
    assert!(rebalanced(&runs[2]) > 1, "the cuts do not move");
    same(&by(Method::None, pistons()), &[Way::new(3, Off, 1).over_places()]);
}

/// So is the room that they leave in a cell.
#[test]
fn pistons_in_cells_have_the_same_bits_on_any_number_of_ranks() {
    let ways = [
        Way::new(2, Dynamic, 1),
        Way { batch: Some(1), ..Way::new(3, Forced { seed: 1 }, 1) }.over_places(),
        Way { order: Some(&shuffled::<3>), ..Way::new(4, Forced { seed: 2 }, None) },
    ];
    let runs = same(&by(Method::Cell, pistons()), &ways);
    assert!(runs[0].outcome.collisions > 1000);
}

/// When it switches follows from rows, which are the same.
#[test]
fn a_run_that_switches_has_the_same_bits_on_any_number_of_ranks() {
    let ways = [
        Way::new(2, Dynamic, 1),
        Way { batch: Some(1), ghosts: Some(Ghosts::OnDemand), ..Way::new(3, Forced { seed: 1 }, 2) },
        Way::new(7, Off, None),
    ];
    let runs = same(&switching(), &ways);
    let outcome = &runs[0].outcome;
    assert!(outcome.continued.is_some() && outcome.time > 6e-4, "{:?} at {}", outcome.continued, outcome.time);
}

/// With the impulse on its walls.
#[test]
fn box_has_the_same_bits_on_any_number_of_ranks() {
    let ways = [
        Way::new(2, Off, 1),
        Way { batch: Some(1), ..Way::new(3, Forced { seed: 1 }, 2) }.over_places(),
        Way::new(8, Dynamic, 8),
    ];
    let runs = same(&gas_box(), &ways);
    assert!(runs.iter().all(|run| run.rows.iter().any(|row| row.surfaces[0].hits > 0)));
    // Ghosts were told of their collisions.
    assert!(runs[1].outcome.traffic.messages > 1000 && runs[1].outcome.traffic.bytes > 100_000);
}

#[test]
fn many_cells_have_the_same_bits_on_any_number_of_ranks() {
    let model = thin();
    let cells = model.plan.grid.cell_count() as u64;
    assert!(!few_stretches(cells) && few_stretches(cells / 2), "{cells}");
    let runs = same(&model, &[Way::new(1, Off, 2), Way::new(3, Off, 2).over_places(), Way::new(4, Dynamic, 8)]);
    assert!(runs[0].outcome.collisions > 0);
}

/// What walls have taken is one sum, and the next intervals follow it on every rank.
#[test]
fn cold_walls_have_the_same_bits_on_any_number_of_ranks() {
    let ways = [Way::new(3, Forced { seed: 7 }, 2).over_places(), Way::new(4, Dynamic, 8)];
    let runs = same(&cold_walls(), &ways);
    assert!(runs.iter().all(|run| run.rows.iter().any(|row| row.walls[1].heat != 0.0)));
}

#[test]
fn vents_have_the_same_bits_on_any_number_of_ranks() {
    let runs = same(&venting(), &[Way::new(4, Forced { seed: 8 }, 2), Way::new(5, Off, 8)]);
    assert!(runs.iter().all(|run| run.outcome.audit.particles_vented > 20));
    same(&venting_freely(), &[Way::new(3, Off, 1).over_places()]);
    same(&by(Method::Cell, venting()), &[Way::new(3, Forced { seed: 9 }, 1).over_places()]);
}

/// Heat capacities that depend on the temperature, and mixtures at rest and flowing in.
#[test]
fn mixtures_with_modes_have_the_same_bits_on_any_number_of_ranks() {
    let ways = [Way { batch: Some(3), ..Way::new(3, Forced { seed: 1 }, 2) }, Way::new(4, Dynamic, 1)];
    let runs = same(&curves(), &ways);
    assert!(runs[0].outcome.audit.particles_injected > 500 && runs[0].outcome.collisions > 5000);
    let in_cells = same(
        &by(Method::Cell, curves()),
        &[Way { batch: Some(3), ..Way::new(3, Forced { seed: 1 }, None) }.over_places()],
    );
    assert!(in_cells[0].outcome.collisions > 1000);
}

/// Free flight is shared out by ids.
#[test]
fn effusion_has_the_same_bits_on_any_number_of_ranks() {
    same(&effusion(), &some_ways());
}

/// Cells that walls part, with up to two hundred particles each. (Found by it: looked for one by one, the members of a part took more turns of a
/// loop than Mesa's lavapipe of 22.3 grants a thread, so that too few collided, by the order of the cells.)
#[test]
fn crowded_cells_that_walls_part_have_the_same_bits_in_any_order() {
    let ways = [
        Way { order: Some(&shuffled::<3>), ..Way::new(1, Off, None) },
        Way::new(2, Dynamic, 1),
        Way::new(3, Initial, 1),
    ];
    let runs = same(&first(0.25, by(Method::Cell, effusion())), &ways);
    assert!(runs[0].outcome.collisions > 50_000);
}

/// Pairs on the two sides of a plate, and in its hole, beside cuts through it.
#[test]
fn a_plate_with_a_hole_has_the_same_bits_on_any_number_of_ranks() {
    same(
        &plate(),
        &[
            Way { order: Some(&shuffled::<5>), ..Way::new(4, Initial, 2) },
            Way::new(3, Forced { seed: 3 }, 1).over_places(),
        ],
    );
}

/// Without ghosts: only who changes its owner is sent.
#[test]
fn collisions_within_cells_have_the_same_bits_on_any_number_of_ranks() {
    let ways = [
        Way::new(2, Dynamic, 1),
        Way { order: Some(&shuffled::<6>), ..Way::new(4, Initial, None) },
        Way { batch: Some(3), ..Way::new(7, Forced { seed: 7 }, 2) }.over_places(),
    ];
    let runs = same(&by(Method::Cell, tank(0)), &ways);
    assert!(runs[0].outcome.collisions > 1000 && rebalanced(&runs[3]) > 1);
    let particles = runs[0].outcome.particles.len() as u64;
    for run in &runs[1..] {
        let traffic = &run.outcome.traffic;
        assert!(traffic.present <= traffic.steps * particles, "there are no ghosts");
        assert!(traffic.arrived > 0);
    }
    let ways = [Way::new(3, Initial, 1), Way::new(8, Forced { seed: 8 }, 2)];
    same(&by(Method::Cell, plate()), &ways);
    same(&by(Method::Cell, burst()), &ways);
}

/// Which triangles are near follows from the clock, whoever owns the cells.
#[test]
fn a_shaken_bag_has_the_same_bits_on_any_number_of_ranks() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        let ways = [Way::new(2, Forced { seed: 1 }, None), Way::new(5, Forced { seed: 2 }, 2).over_places()];
        let runs = same(&shaken_bag(method), &ways);
        let inside = runs[0].outcome.particles.iter().filter(|particle| particle.is_inside()).count();
        assert!((100..1400).contains(&inside), "{inside} inside");
        // Flights come to cells in which no fabric is listed.
        assert!(method != Method::HalfTurn || runs.iter().any(|run| run.outcome.repeated > 0));
    }
    same(&shaken_bag(Method::None), &[Way::new(3, Off, 1).over_places()]);
}

/// Planes tell bags apart, plates turn, and gas passes them.
#[test]
fn several_fabrics_have_the_same_bits_on_any_number_of_ranks() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        let ways = [Way::new(2, Forced { seed: 1 }, None), Way::new(5, Forced { seed: 2 }, 2).over_places()];
        let runs = same(&several_fabrics(method), &ways);
        let audit = &runs[0].outcome.audit;
        assert!(audit.through_fabric.is_some_and(|(passed, _)| passed > 5), "{audit:?}");
        assert_eq!(audit.passed.map(|passed| passed.particles), Some(0));
    }
}

/// Walls and nodes that move whatever the gas does, beside a bag that gives way.
#[test]
fn fabric_among_what_moves_has_the_same_bits_on_any_number_of_ranks() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        let ways = [Way::new(2, Forced { seed: 1 }, None), Way::new(5, Forced { seed: 2 }, 2).over_places()];
        let runs = same(&driven_fabrics(method), &ways);
        let audit = &runs[0].outcome.audit;
        assert!(audit.fabric.is_some_and(|account| account.from_supports > 0.0), "{audit:?}");
        assert_eq!(audit.passed.map(|passed| passed.particles), Some(0));
    }
}

/// What the gas gives the nodes is summed over the ranks in integers.
#[test]
fn an_inflated_bag_has_the_same_bits_on_any_number_of_ranks() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        let ways = [Way::new(2, Forced { seed: 1 }, None), Way::new(5, Forced { seed: 2 }, 2).over_places()];
        let runs = same(&inflated_bag(method), &ways);
        let [first, last] = [0, runs[0].rows.len() - 1].map(|row| runs[0].rows[row].fabrics[0].volume);
        assert!(last > 1.01 * first, "the bag has {last} m3 after {first}");
        // Lists of fabric grow on the way, and flights come to cells in which there are none.
        assert!(runs.iter().any(|run| run.outcome.repeated > 1));
    }
    same(&inflated_bag(Method::None), &[Way::new(3, Off, 1).over_places()]);
}

/// Vents follow gas of all ranks, and what passes them is counted once.
#[test]
fn a_porous_bag_has_the_same_bits_on_any_number_of_ranks() {
    for method in [Method::HalfTurn, Method::ClosestApproach] {
        let ways = [Way::new(2, Forced { seed: 1 }, None), Way::new(5, Forced { seed: 2 }, 2).over_places()];
        let runs = same(&porous_bag(method), &ways);
        let audit = &runs[0].outcome.audit;
        assert!(audit.through_fabric.is_some_and(|(passed, _)| passed > 20), "{audit:?}");
        assert_eq!(audit.passed.map(|passed| passed.particles), Some(0));
    }
    let ways = [Way::new(2, Forced { seed: 1 }, None), Way::new(5, Forced { seed: 2 }, 2).over_places()];
    let runs = same(&vented_bag(Method::HalfTurn), &ways);
    assert!(runs[0].outcome.audit.through_fabric.is_some_and(|(passed, _)| passed > 20));
}

#[test]
fn rigid_spheres_have_the_same_bits_on_any_number_of_ranks() {
    let ways = [Way::new(2, Dynamic, 1).over_places(), Way { batch: Some(3), ..Way::new(5, Forced { seed: 9 }, 2) }];
    let runs = same(&by(Method::HardSphere, tank(0)), &ways);
    assert!(runs[0].outcome.collisions > 100);
    same(&by(Method::HardSphere, plate()), &ways[1..]);
}

/// Intervals are run again with longer lists, after the cuts have moved.
#[test]
fn lists_that_grow_among_ranks_change_no_bit() {
    let ways = [Way::new(2, Off, 4), Way::new(5, Forced { seed: 4 }, 1).over_places()];
    let model = dense(1);
    let runs = same(&model, &ways);
    assert!(runs[1..].iter().all(|run| run.outcome.repeated > 0), "the lists did not grow");
    // In steps that density cuts, in which pairs meet nearer than a cell's edge.
    assert!(runs[0].outcome.steps > (model.scene.end_time / model.plan.time_step).round() as u64, "no step was cut");
}

/// Buffers of particles, newborns, messages and updates grow on the way.
#[test]
fn a_burst_near_a_cut_changes_no_bit() {
    let ways = [Way::new(3, Initial, 1).over_places(), Way::new(8, Forced { seed: 5 }, 2)];
    same(&burst(), &ways);
}

/// Cut anew where it pays, as runs do by themselves: gas flows into one side. (So few particles cost a device nothing that
/// could be measured: they are balanced by their number.)
#[test]
fn cuts_that_follow_the_gas_change_no_bit() {
    let by_number = |way: Way| Way { by: By::Particles, ..way };
    let ways = [by_number(Way::new(2, Dynamic, 1)), by_number(Way::new(3, Dynamic, 2))];
    let runs = same(&burst(), &ways);
    assert!(runs[1..].iter().all(|run| rebalanced(run) > 0), "the cuts do not move");
    // With planes enough that another is nearer to the middle.
    let mut fine = burst().scene;
    fine.model.particles = Some(24_000);
    let fine = by(Method::Cell, Model::new(fine).expect("a model"));
    let runs = same(&fine, &[by_number(Way::new(3, Dynamic, 1))]);
    assert!(rebalanced(&runs[1]) > 0, "the cuts do not move");
}

/// A look at the state by one rank moves no particle.
#[test]
fn snapshots_among_ranks_are_those_of_one() {
    let mut model = gas_box();
    model.scene.output.snapshots = 5;
    let runs = same(&model, &[Way::new(4, Forced { seed: 6 }, 2)]);
    assert!(runs.iter().all(|run| run.snapshots.len() > 3));
}

/// A particle that flies beyond the peers of its rank is not lost: the interval is run again with everyone as a peer.
#[test]
fn particles_that_stray_beyond_the_peers_change_no_bit() {
    let mut model = tube();
    // Such speeds are beyond the range of a tally.
    model.plan.tally_every = 0;
    let stop = Some(7);
    let options = Options { shuffle: Some(&with_fast_ones), stop_after_steps: stop, ..Options::default() };
    let alone = run(&model, options);
    assert_eq!(alone.outcome.steps, 7);
    assert_eq!(alone.outcome.repeated, 0);
    let world = World::new(&model);
    for way in [Way::new(12, Off, 1).over_places(), Way::new(12, Initial, 2), Way::new(2, Off, 1)] {
        let way = Way { order: Some(&with_fast_ones), stop, ..way };
        let among = world.run(&way);
        assert_same(&way.name(), &Bits::of(&alone), &Bits::of(&among));
        // Of two ranks each is the other's peer.
        assert_eq!(among.outcome.repeated > 0, way.ranks > 2, "{}", way.name());
    }
    // Without the fast ones nobody strays.
    assert_eq!(world.run(&Way::new(12, Off, 1)).outcome.repeated, 0);
}

#[test]
#[ignore = "all ways take many minutes; ./scripts/test.sh --long runs them"]
fn tank_has_the_same_bits_in_all_ways() {
    same(&tank(0), &all_ways());
}

#[test]
#[ignore = "all ways take many minutes; ./scripts/test.sh --long runs them"]
fn box_has_the_same_bits_in_all_ways() {
    same(&gas_box(), &all_ways());
}

#[test]
#[ignore = "all ways take many minutes; ./scripts/test.sh --long runs them"]
fn effusion_has_the_same_bits_in_all_ways() {
    same(&effusion(), &all_ways());
}

#[test]
#[ignore = "all ways take many minutes; ./scripts/test.sh --long runs them"]
fn a_plate_with_a_hole_has_the_same_bits_in_all_ways() {
    same(&plate(), &all_ways());
}

#[test]
#[ignore = "all ways take many minutes; ./scripts/test.sh --long runs them"]
fn dense_gas_and_a_burst_have_the_same_bits_in_all_ways() {
    same(&dense(1), &all_ways());
    same(&burst(), &all_ways());
}

#[test]
#[ignore = "all ways take many minutes; ./scripts/test.sh --long runs them"]
fn the_other_methods_have_the_same_bits_in_all_ways() {
    for method in [Method::Cell, Method::HardSphere] {
        same(&by(method, tank(0)), &all_ways());
        same(&by(method, plate()), &all_ways());
    }
}
