//! The rows of `corpuscle verify` that are of the method `half-turn`, in short: gas as it is passes, gas of another viscosity, walls of another
//! coefficient, another hole, gases that do not mix and a piston of another speed do not.

use corpuscle::scene::Method;
use corpuscle::study::verify::effusion::DIAMETER;
use corpuscle::study::verify::mixing::{END, mixed_by, of_late};
use corpuscle::study::verify::piston::{Piston, compressed, pressed};
use corpuscle::study::verify::waves::{Waves, sounds_of};
use corpuscle::study::verify::{Check, Verdict, losses, vessels};

use crate::whole_run::device;

fn passes(check: &Check) {
    println!("{check:?}");
    assert_eq!(check.verdict(), Verdict::Pass, "{check:?}");
}

fn fails(check: &Check) {
    println!("{check:?}");
    assert_eq!(check.verdict(), Verdict::Fail, "{check:?}");
}

/// Beyond its tolerance and the noise of so few particles.
fn far(check: &Check) -> bool {
    println!("{check:?}");
    (check.measured - check.reference).abs() > check.tolerance + 3.0 * check.error
}

/// Sound of closest approach dies down twice as fast: nu .65 d c0.
#[test]
fn sound_of_another_viscosity_is_told() {
    let waves = |method| Waves { method, particles: 8000, half_waves: 2, seeds: 8 };
    let [own, others] =
        ["half-turn", "closest-approach"].map(|method| sounds_of(&device(), &waves(method), 0.03).expect("runs"));
    assert!(!far(&own[1]) && far(&others[1]));
}

#[test]
fn a_hole_of_another_width_is_told() {
    let flow = |diameter| vessels::bounded(&device(), Method::HalfTurn, 20_000, diameter).expect("a run");
    passes(&flow(DIAMETER));
    fails(&flow(0.7 * DIAMETER));
    fails(&flow(1.3 * DIAMETER));
}

#[test]
fn walls_that_exchange_more_or_less_are_told() {
    let kept = |times| losses::by_half_turn(&device(), 4000, times).expect("a run");
    passes(&kept(1.0));
    fails(&kept(0.7));
    fails(&kept(1.5));
}

/// At first gases are apart, and without collisions each keeps its temperature.
#[test]
fn a_mixture_that_does_not_mix_is_told() {
    let mixed = |method| mixed_by(&device(), method, 1500, 2.0 * END).expect("a run").0;
    let moments = mixed(Method::HalfTurn);
    of_late(&moments, "half-turn: ", 0.05).iter().for_each(passes);
    let early = moments[1].left;
    assert!(early[0] > 0.6 && early[1] < 0.4, "{early:?}");
    let free = mixed(Method::None);
    assert!(far(&of_late(&free, "none: ", 0.05)[2]));
}

/// In free flight a slow compression heats a fifth more; the shock before a faster piston is stronger.
#[test]
fn another_compression_is_told() {
    passes(&compressed(&device(), Method::HalfTurn, 800, 3).expect("runs"));
    assert!(far(&compressed(&device(), Method::None, 800, 3).expect("runs")));
    let pressure = |speed| {
        let piston = Piston::shock(20_000, speed).by(Method::HalfTurn);
        pressed(&device(), &piston, 0.5, 0.1).expect("a run")
    };
    passes(&pressure(0.5));
    fails(&pressure(0.6));
}
