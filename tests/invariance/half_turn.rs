//! The method `half-turn` in parts: boxes of whole tiles, which begin a cell farther in every other step, and no ghosts.

use corpuscle::scene::Method;
use corpuscle::simulation::BalanceMode::{Dynamic, Forced, Initial, Off};
use corpuscle::simulation::Model;

use crate::among::Way;
use crate::orders::shuffled;
use crate::ranks::{rebalanced, same};
use crate::scenes::{by, curves, effusion, first, gas_box, pistons, plate, tank, venting};

/// Inflow, two gases, walls that move, curves of heat capacities, and a wall with a hole through collision cells.
#[test]
fn half_turns_have_the_same_bits_on_any_number_of_ranks() {
    let ways = [
        Way::new(2, Dynamic, 1),
        Way { order: Some(&shuffled::<6>), ..Way::new(4, Initial, None) },
        Way { batch: Some(3), ..Way::new(7, Forced { seed: 7 }, 2) }.over_places(),
    ];
    let runs = same(&by(Method::HalfTurn, tank(0)), &ways);
    assert!(rebalanced(&runs[3]) > 1);
    let particles = runs[0].outcome.particles.len() as u64;
    for run in &runs[1..] {
        let traffic = &run.outcome.traffic;
        assert!(traffic.present <= traffic.steps * particles, "there are no ghosts");
        assert!(traffic.arrived > 0);
    }
    let ways = [Way::new(3, Initial, 1), Way::new(8, Forced { seed: 8 }, 2)];
    same(&by(Method::HalfTurn, plate()), &ways);
    same(&by(Method::HalfTurn, pistons()), &ways[1..]);
    same(&by(Method::HalfTurn, curves()), &[Way::new(3, Forced { seed: 1 }, None).over_places()]);
}

/// In every number of parts, by every mode.
fn in_all_parts(model: &Model) {
    let ways = [
        Way::new(2, Dynamic, None),
        Way { batch: Some(1), ..Way::new(3, Forced { seed: 1 }, None) },
        Way { order: Some(&shuffled::<3>), ..Way::new(4, Initial, None) },
        Way::new(7, Forced { seed: 2 }, None).over_places(),
        Way { batch: Some(3), ..Way::new(8, Off, None) },
    ];
    let runs = same(model, &ways);
    assert!(runs[1..].iter().all(|run| run.outcome.traffic.arrived > 0), "nobody changed its owner");
}

/// Gas at rest, with the impulse on its walls.
#[test]
fn half_turns_of_gas_at_rest_have_the_same_bits_in_all_parts() {
    in_all_parts(&by(Method::HalfTurn, gas_box()));
}

/// A box in a box, of which all cells at the walls are cut, and gas that is thin in the one of them.
#[test]
fn half_turns_of_gas_that_escapes_have_the_same_bits_in_all_parts() {
    // As many as make tiles enough for all.
    let mut scene = first(0.25, effusion()).scene;
    scene.model.particles = Some(12_000);
    in_all_parts(&by(Method::HalfTurn, Model::new(scene).expect("a model")));
}

/// Gas flows in, and out through a vent that opens and walls that leak and are cold.
#[test]
fn half_turns_with_vents_have_the_same_bits_in_all_parts() {
    in_all_parts(&by(Method::HalfTurn, venting()));
}
