use corpuscle::partition::*;

use super::clouds::Random;

/// Seconds per particle, candidate, wall test, cell and step.
const TRUE: [f64; 5] = [2e-8, 3e-9, 9e-8, 5e-10, 4e-4];

fn seconds(work: &Work) -> f64 {
    TRUE[0] * work.particles as f64
        + TRUE[1] * work.candidates as f64
        + TRUE[2] * work.wall_tests as f64
        + TRUE[3] * work.cells as f64
        + TRUE[4] * work.steps as f64
}

/// Ranks of different gas: some dense, some near walls, some among empty cells, and changing in time.
fn works(ranks: usize, random: &mut Random) -> Vec<Work> {
    let mut work = || {
        let particles = 64.0 * (20_000.0 + 100_000.0 * random.unit());
        Work {
            particles: particles as u64,
            candidates: (particles * (2.0 + 28.0 * random.unit())) as u64,
            wall_tests: (particles * 0.5 * random.unit()) as u64,
            sheet_tests: 0,
            cells: (particles * 12.0 * random.unit()) as u64,
            steps: 64,
        }
    };
    (0..ranks).map(|_| work()).collect()
}

/// Observes intervals with relative noise on the timers.
fn observe(model: &mut CostModel, speeds: &[f64], intervals: usize, noise: f64, random: &mut Random) {
    for _ in 0..intervals {
        let works = works(speeds.len(), random);
        let measured = works.iter().zip(speeds).map(|(work, speed)| {
            let seconds = seconds(work) / speed * (1.0 + noise * random.normal()).max(0.1);
            Measurement { work: *work, seconds, pair_seconds: None }
        });
        let measured: Vec<_> = measured.collect();
        model.observe(&measured);
    }
}

/// Some ranks have fabric in a part of their cells: what its triangles cost is told from what particles cost, and weighs.
#[test]
fn triangles_of_fabric_have_a_cost_of_their_own() {
    const SHEET: f64 = 7e-9;
    let (mut model, mut random) = (CostModel::new(By::Cost, 8), Random(5));
    for _ in 0..60 {
        let mut works = works(8, &mut random);
        for work in &mut works[..3] {
            work.sheet_tests = (work.particles as f64 * 6.0 * random.unit()) as u64;
        }
        let measured: Vec<Measurement> = works
            .into_iter()
            .map(|work| Measurement {
                work,
                seconds: (seconds(&work) + SHEET * work.sheet_tests as f64) * (1.0 + 0.05 * random.normal()).max(0.1),
                pair_seconds: None,
            })
            .collect();
        model.observe(&measured);
    }
    let found = model.sheet_coefficient();
    assert!((found / SHEET - 1.0).abs() < 0.15, "{found} {SHEET}");
    let weights = model.weights();
    let share = f64::from(weights.sheet) / f64::from(weights.candidate);
    assert!((share / (SHEET / TRUE[1]) - 1.0).abs() < 0.2, "{weights:?}");
}

/// Coefficients are recovered from timings with 5 % of noise.
#[test]
fn known_coefficients_are_recovered() {
    let mut model = CostModel::new(By::Cost, 8);
    observe(&mut model, &[1.0; 8], 60, 0.05, &mut Random(1));
    let found = model.coefficients();
    println!("{found:?}");
    for (feature, tolerance) in [(0, 0.2), (1, 0.1), (2, 0.1)] {
        assert!((found[feature] / TRUE[feature] - 1.0).abs() < tolerance, "{found:?} against {TRUE:?}");
    }
    let work = works(1, &mut Random(2))[0];
    assert!((model.cost(&work) / seconds(&work) - 1.0).abs() < 0.02);
    let weights = model.weights();
    assert_eq!(weights.wall, 16_384, "the largest");
    assert!((f64::from(weights.candidate) / f64::from(weights.wall) / (TRUE[1] / TRUE[2]) - 1.0).abs() < 0.15);
}

/// What a cell costs is told by ranks that have much empty space, as exactly as what a candidate costs.
#[test]
fn empty_space_tells_what_a_cell_costs() {
    let (mut model, mut random) = (CostModel::new(By::Cost, 8), Random(41));
    for _ in 0..60 {
        let measured: Vec<_> = (0..8)
            .map(|rank| {
                let [gas] = works(1, &mut random)[..] else { unreachable!("one was asked for") };
                let work = Work { cells: if rank % 2 == 0 { gas.cells } else { 200 * gas.particles }, ..gas };
                let seconds = seconds(&work) * (1.0 + 0.05 * random.normal());
                Measurement { work, seconds, pair_seconds: None }
            })
            .collect();
        model.observe(&measured);
    }
    let found = model.coefficients()[3];
    assert!((found / TRUE[3] - 1.0).abs() < 0.1, "{found} against {}", TRUE[3]);
    let weights = model.weights();
    assert!((f64::from(weights.cell) / f64::from(weights.wall) / (TRUE[3] / TRUE[2]) - 1.0).abs() < 0.15);
}

/// A device of half the speed gets half the share of the others, and the coefficients stay.
#[test]
fn a_slow_device_is_found() {
    let mut model = CostModel::new(By::Cost, 4);
    observe(&mut model, &[1.0, 1.0, 0.5, 1.0], 60, 0.1, &mut Random(3));
    let shares = model.shares();
    println!("{shares:?} {:?}", model.coefficients());
    assert!((shares[2] / shares[0] - 0.5).abs() < 0.05, "{shares:?}");
    assert_eq!((shares[0], shares[0]), (shares[1], shares[3]), "the others are alike to the last bit");
    let candidate = model.coefficients()[1];
    assert!((candidate / TRUE[1] - 1.0).abs() < 0.2, "{candidate}");
    // What it is thought to take are the seconds that it does.
    let work = works(1, &mut Random(6))[0];
    for (rank, speed) in [(0, 1.0), (2, 0.5)] {
        assert!((model.seconds(rank, &work) / (seconds(&work) / speed) - 1.0).abs() < 0.1, "rank {rank}");
    }
}

/// With the shares that it is given, each rank's own work and its halo take the same time, and a rank without one
/// gets more; by particles, halos do not count.
#[test]
fn a_halo_leaves_a_rank_less_of_the_weight() {
    let mut model = CostModel::new(By::Cost, 4);
    observe(&mut model, &[1.0; 4], 60, 0.02, &mut Random(31));
    let work = |owned: u64, ghosts: u64| {
        let halo = Work {
            particles: ghosts,
            candidates: 4 * ghosts,
            wall_tests: 0,
            sheet_tests: 0,
            cells: 6 * ghosts,
            steps: 0,
        };
        let candidates = 10 * owned + halo.candidates;
        let cells = 4 * owned + halo.cells;
        (Work { particles: owned + ghosts, candidates, wall_tests: 0, sheet_tests: 0, cells, steps: 1 }, halo)
    };
    let loads = [work(2000, 0), work(3000, 2000), work(2500, 1000), work(2500, 1800)];
    let shares = model.shares_beside_halos(&loads);
    let [particle, candidate, _, cell, _] = model.coefficients();
    let all =
        |work: &Work| particle * work.particles as f64 + candidate * work.candidates as f64 + cell * work.cells as f64;
    let own: f64 = loads.iter().map(|(work, halo)| all(work) - all(halo)).sum();
    let times: Vec<f64> = shares.iter().zip(&loads).map(|(share, (_, halo))| share * own / 4.0 + all(halo)).collect();
    let mean = times.iter().sum::<f64>() / 4.0;
    assert!(times.iter().all(|time| (time / mean - 1.0).abs() < 1e-9), "{times:?}");
    assert!((shares.iter().sum::<f64>() - 4.0).abs() < 1e-9 && shares[0] > 1.05 * shares[1], "{shares:?}");
    assert_eq!(CostModel::new(By::Particles, 4).shares_beside_halos(&loads), [1.0; 4]);
    // Nothing but ghosts: still a part.
    assert!(model.shares_beside_halos(&[work(10, 0), work(0, 9000), work(10, 0), work(10, 0)])[1] > 0.1);
}

/// 20 % of noise on equal devices moves no share, ever.
#[test]
fn noise_moves_no_share() {
    for seed in 0..10 {
        let (mut model, mut random) = (CostModel::new(By::Cost, 12), Random(seed));
        for interval in 0..300 {
            observe(&mut model, &[1.0; 12], 1, 0.2, &mut random);
            assert_eq!(model.shares(), [1.0; 12], "seed {seed}, interval {interval}");
        }
    }
}

/// Where the ranks' gas is all alike, nothing can be told apart: the weights keep the prior's ratios.
#[test]
fn uniform_gas_keeps_the_prior() {
    let mut model = CostModel::new(By::Cost, 4);
    let prior = model.weights();
    let work = Work {
        particles: 6_400_000,
        candidates: 64_000_000,
        wall_tests: 640_000,
        sheet_tests: 0,
        cells: 25_600_000,
        steps: 64,
    };
    for _ in 0..50 {
        model.observe(&[Measurement { work, seconds: 0.3, pair_seconds: None }; 4]);
    }
    assert!((model.cost(&work) - 0.3).abs() < 1e-3);
    let weights = model.weights();
    assert!(weights.particle.abs_diff(prior.particle) <= prior.particle / 50, "{weights:?} {prior:?}");
    assert!(weights.candidate.abs_diff(prior.candidate) <= prior.candidate / 50, "{weights:?} {prior:?}");
    assert!(weights.cell.abs_diff(prior.cell) <= 1 + prior.cell / 50, "{weights:?} {prior:?}");
}

/// Where all ranks' gas is much alike, their seconds as a whole say little of what a candidate costs; with those of the
/// search for pairs apart it is found.
#[test]
fn the_seconds_of_the_search_tell_candidates_from_particles() {
    const CANDIDATE: f64 = 0.5 * TRUE[0];
    let found = |apart: bool| {
        let (mut model, mut random) = (CostModel::new(By::Cost, 4), Random(21));
        for _ in 0..60 {
            let measured: Vec<_> = (0..4)
                .map(|_| {
                    let particles = 64.0 * (50_000.0 + 50_000.0 * random.unit());
                    let candidates = particles * (11.5 + random.unit());
                    let work = Work {
                        particles: particles as u64,
                        candidates: candidates as u64,
                        steps: 64,
                        ..Work::default()
                    };
                    let pairs = (CANDIDATE * candidates + 0.4 * TRUE[4] * 64.0) * (1.0 + 0.05 * random.normal());
                    let others = (TRUE[0] * particles + 0.6 * TRUE[4] * 64.0) * (1.0 + 0.05 * random.normal());
                    Measurement { work, seconds: pairs + others, pair_seconds: apart.then_some(pairs) }
                })
                .collect();
            model.observe(&measured);
        }
        model.coefficients()[1] / CANDIDATE
    };
    let (apart, whole) = (found(true), found(false));
    assert!((apart - 1.0).abs() < 0.1, "{apart} of the truth");
    assert!((whole - 1.0).abs() > 0.2, "{whole} of the truth without the search apart");
}

/// A cost that is none is found to be none, never negative; the coefficients follow when costs change.
#[test]
fn coefficients_are_never_negative_and_follow() {
    let mut model = CostModel::new(By::Cost, 6);
    let mut random = Random(8);
    for (candidate, intervals) in [(0.0, 50), (5e-9, 120)] {
        for _ in 0..intervals {
            let measured: Vec<_> = works(6, &mut random)
                .into_iter()
                .map(|work| {
                    let seconds = 1e-8 * work.particles as f64 + candidate * work.candidates as f64;
                    Measurement { work, seconds: seconds * (1.0 + 0.03 * random.normal()), pair_seconds: None }
                })
                .collect();
            model.observe(&measured);
            assert!(model.coefficients().iter().all(|cost| *cost >= 0.0));
        }
        assert!((model.coefficients()[1] - candidate).abs() < 3e-10, "{:?}", model.coefficients());
    }
}

/// Ranks that observe the same hold the same state, also after it was stored; rows without work or time change nothing
/// but the age of the others.
#[test]
fn the_state_is_a_function_of_the_measurements() {
    let mut one = CostModel::new(By::Cost, 3);
    let mut other = one.clone();
    observe(&mut one, &[1.0, 0.7, 1.0], 30, 0.1, &mut Random(4));
    observe(&mut other, &[1.0, 0.7, 1.0], 15, 0.1, &mut Random(4));
    assert_ne!(one, other);
    let mut again = CostModel::new(By::Cost, 3);
    observe(&mut again, &[1.0, 0.7, 1.0], 30, 0.1, &mut Random(4));
    assert_eq!(one, again);
    assert_eq!(one, toml::from_str(&toml::to_string(&one).unwrap()).unwrap());
    let nothing = Measurement { work: Work::default(), seconds: f64::NAN, pair_seconds: None };
    again.observe(&[nothing; 3]);
    assert!(again.coefficients().iter().all(|cost| cost.is_finite() && *cost >= 0.0));
    assert_eq!(again.shares(), one.shares());
}

/// By particles, a particle is what counts.
#[test]
fn by_particles_counts_particles() {
    let mut model = CostModel::new(By::Particles, 4);
    observe(&mut model, &[1.0, 0.5, 1.0, 1.0], 40, 0.01, &mut Random(5));
    assert_eq!(model.weights(), IntegerWeights { particle: 1, candidate: 0, wall: 0, sheet: 0, cell: 0 });
    assert_eq!(model.shares(), [1.0; 4]);
}
