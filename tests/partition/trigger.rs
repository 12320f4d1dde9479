use corpuscle::partition::*;

use super::clouds::Random;

const STEPS: u64 = 1000;
/// What is thought likely of measured times.
const NOISE: f64 = 0.15;

/// Steps between two observations.
const INTERVAL: u64 = 32;

/// A trigger that observes at equal distances.
#[derive(Clone, Debug, PartialEq)]
struct Watch {
    trigger: Trigger,
    step: u64,
}

impl Watch {
    fn new(threshold: f64, estimate: f64, likely: f64) -> Watch {
        Watch { trigger: Trigger::new(threshold, estimate, likely), step: 0 }
    }

    fn observe(&mut self, seconds: &[f64], shares: &[f64]) {
        self.step += INTERVAL;
        self.trigger.observe(self.step, seconds, shares);
    }

    /// A check right after an observation.
    fn check(&mut self, seconds: &[f64], shares: &[f64], steps: u64) -> Decision {
        self.observe(seconds, shares);
        self.trigger.check(self.step, steps)
    }
}

/// Equal ranks of 1 ms a step with 20 % of noise never lead to a rebalance, be it for nothing.
#[test]
fn a_noisy_load_never_triggers() {
    for (seed, ranks) in [(1, 2), (2, 8), (3, 8), (4, 64), (5, 384)] {
        let (mut trigger, mut random) = (Watch::new(1.1, 0.0, NOISE), Random(seed));
        for turn in 0..500 {
            let seconds: Vec<f64> = (0..ranks).map(|_| 1e-3 * (1.0 + 0.2 * random.normal()).max(0.1)).collect();
            let decision = trigger.check(&seconds, &vec![1.0; ranks], STEPS);
            assert!(!decision.rebalances(), "{ranks} ranks, check {turn}: {decision}");
        }
    }
}

/// A load that drifts to one rank leads to a rebalance soon after it is 15 % over the mean, and not before 10 %. A steep
/// drift is no noise that would have to be waited out: one of 1 % or 3 % an observation has gone on for few more.
#[test]
fn a_drift_triggers() {
    for (steepness, latest) in [(0.002, 0.15), (0.01, 0.2), (0.03, 0.3)] {
        let (mut trigger, mut random) = (Watch::new(1.1, 0.01, NOISE), Random(7));
        let first = (0..200).map(|turn| steepness * f64::from(turn)).take_while(|&off| off < 0.9).find(|&off| {
            let seconds = [1.0 + off, 1.0 - off].map(|seconds| 1e-3 * seconds * (1.0 + 0.01 * random.normal()));
            trigger.check(&seconds, &[1.0; 2], STEPS).rebalances()
        });
        assert!(first.is_some_and(|off| (0.1..latest).contains(&off)), "{steepness}: {first:?}");
    }
}

/// Loads that drift by less than half a per cent an interval, as the corner's do, are cut anew within two checks of the threshold, though the
/// newest that is known is an interval old: averages would be late by three intervals more.
#[test]
fn a_drift_is_followed_to_the_check() {
    for seed in 1..=5 {
        let (mut watch, mut random) = (Watch::new(1.01, 0.0, 0.002), Random(seed));
        let load = |interval: u64| 0.0045 * (interval as f64 - 3.0);
        let first = (1..40).find(|&interval| {
            let off = load(interval) + 0.001 * random.normal();
            watch.observe(&[1.0 + off, 1.0 - off], &[1.0; 2]);
            let at = watch.step + INTERVAL;
            (interval + 1) % 2 == 0 && watch.trigger.check(at, 2 * INTERVAL).rebalances()
        });
        let off = first.map(|interval| load(interval + 1));
        assert!(off.is_some_and(|off| (0.01..0.028).contains(&off)), "seed {seed}: {off:?}");
    }
}

/// What is steady is believed after a dozen observations, though noise of 15 % is thought likely at first.
#[test]
fn a_steady_imbalance_triggers() {
    let mut trigger = Watch::new(1.1, 0.0, NOISE);
    let first = (1..=50).find(|_| trigger.check(&[1.15e-3, 0.85e-3], &[1.0; 2], STEPS).rebalances());
    assert!(first.is_some_and(|first| (2..=12).contains(&first)), "{first:?}");
}

/// Loads that are known to be steady need not be waited for: two are enough.
#[test]
fn what_has_little_noise_is_believed_at_once() {
    let mut trigger = Watch::new(1.1, 0.0, 0.02);
    trigger.observe(&[1.15e-3, 0.85e-3], &[1.0; 2]);
    assert!(trigger.check(&[1.15e-3, 0.85e-3], &[1.0; 2], STEPS).rebalances());
    let mut trigger = Watch::new(1.1, 0.0, 0.02);
    assert!((0..50).all(|_| !trigger.check(&[1.09e-3, 0.91e-3], &[1.0; 2], STEPS).rebalances()));
}

/// A rebalance that costs more than it saves until the next check is not done; the measured cost replaces the estimate.
#[test]
fn too_dear_a_rebalance_is_not_done() {
    let load = [1.5e-3, 0.5e-3];
    let decide = |trigger: &mut Watch, steps| (0..10).map(|_| trigger.check(&load, &[1.0; 2], steps)).last().unwrap();
    // 0.5 ms a step are saved: half a second in 1000.
    assert!(matches!(decide(&mut Watch::new(1.1, 0.6, NOISE), 1000), Decision::TooDear { .. }));
    assert!(decide(&mut Watch::new(1.1, 0.4, NOISE), 1000).rebalances());
    let mut measured = Watch::new(1.1, 0.6, NOISE);
    measured.trigger.rebalanced(0.4);
    assert!(decide(&mut measured, 1000).rebalances());
    assert!(matches!(decide(&mut measured, 700), Decision::TooDear { .. }));
}

/// Times in proportion to unequal shares are balanced by their seconds: the mean is what all would take.
#[test]
fn unequal_shares_are_weighed() {
    // Three quarters of the work belong to the first rank. It has half of it and takes 2/3 of the mean time.
    let mut trigger = Watch::new(1.1, 0.0, NOISE);
    trigger.observe(&[2.0, 6.0], &[0.75, 0.25]);
    assert!((trigger.trigger.imbalance() - 2.0).abs() < 1e-12, "{}", trigger.trigger.imbalance());
    let balanced = Watch::new(1.1, 0.0, NOISE).check(&[3.0, 3.0], &[0.75, 0.25], STEPS);
    assert!(matches!(balanced, Decision::Balanced { .. }));
}

/// If rebalances do not help they are soon given up; when the load can be balanced again they come back.
#[test]
fn rebalances_in_vain_back_off() {
    let mut trigger = Watch::new(1.1, 0.001, NOISE);
    let mut rebalances = |load: [f64; 2], checks: usize| {
        let mut count = 0;
        for _ in 0..checks {
            if trigger.check(&load, &[1.0; 2], STEPS).rebalances() {
                trigger.trigger.rebalanced(0.001);
                count += 1;
            }
        }
        count
    };
    let stuck = rebalances([1.3e-3, 0.7e-3], 200);
    assert!((1..=3).contains(&stuck), "{stuck}");
    assert_eq!(rebalances([1e-3, 1e-3], 50), 0);
    assert!(rebalances([1.3e-3, 0.7e-3], 20) >= 1);
}

/// One rank has nothing to balance; reasons read as sentences.
#[test]
fn reasons_are_printed() {
    assert_eq!(Watch::new(1.1, 0.0, NOISE).check(&[1.0], &[1.0], STEPS), Decision::Idle);
    let balanced = Watch::new(1.1, 0.0, NOISE).check(&[1.02, 0.98], &[1.0; 2], STEPS);
    assert_eq!(balanced.to_string(), "no rebalance: imbalance 1.020 is not above 1.100");
    let mut trigger = Watch::new(1.1, 0.25, NOISE);
    let mut said = || trigger.check(&[1.5e-3, 0.5e-3], &[1.0; 2], STEPS).to_string();
    assert_eq!(said(), "no rebalance: imbalance 1.500 may be noise up to 1.777");
    let last = (0..9).map(|_| said()).last().unwrap();
    assert_eq!(last, "rebalance: imbalance 1.500, saves 5.000e-1 s for 2.500e-1 s");
    let stored: Trigger = toml::from_str(&toml::to_string(&trigger.trigger).unwrap()).unwrap();
    assert_eq!(stored, trigger.trigger, "what is stored decides as before");
}

/// Noise of 1 % carries no load of 8.5 % over the threshold of 10 % in 500 checks; one of 13 % leads to a rebalance.
#[test]
fn noise_does_not_carry_a_load_over_the_threshold() {
    let turns = |excess: f64, seed| {
        let (mut trigger, mut random) = (Watch::new(1.1, 0.0, NOISE), Random(seed));
        (0..500).position(|_| {
            let seconds = [1.0 + excess, 1.0 - excess].map(|s| 1e-3 * s * (1.0 + 0.01 * random.normal()));
            trigger.check(&seconds, &[1.0; 2], STEPS).rebalances()
        })
    };
    for seed in 1..=5 {
        assert_eq!(turns(0.085, seed), None, "seed {seed}");
        assert!(turns(0.13, seed).is_some_and(|turn| turn <= 12), "seed {seed}");
    }
}
