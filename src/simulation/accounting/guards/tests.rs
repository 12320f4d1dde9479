use super::*;
use crate::simulation::accounting::row::ZoneState;
use crate::simulation::model::build::Model;
use crate::subdomain::{Counters, VentSum};
use std::path::Path;

fn model() -> Model {
    let text = include_str!("../../../../scenes/vent.toml");
    let mut scene = crate::scene::parse(text, "vent.toml", Path::new("")).unwrap();
    scene.model.method = Some(Method::ClosestApproach);
    Model::new(scene).unwrap()
}

fn tallies(lost: u32, sampled: u32, blocks: Vec<BlockSum>) -> Tallies {
    Tallies {
        passages: Vec::new(),
        counters: Counters { lost, sampled, ..Counters::default() },
        zones: Vec::new(),
        surfaces: Vec::new(),
        surface_models: Vec::new(),
        vents: Vec::<VentSum>::new(),
        works: Vec::new(),
        blocks,
        fast: Vec::new(),
    }
}

fn shown(tallies: &Tallies) -> Shown<'_> {
    Shown { time: 1e-3, step: 0.0, tallies, shares: &[], particle_steps: 1000, drift: 0.0, clipped: &[] }
}

fn quantities(told: &[GuardWarning]) -> Vec<Quantity> {
    told.iter().map(|told| told.warning.quantity).collect()
}

/// Each guard is silent within its limit, tells beyond it, with the time, and tells once.
#[test]
fn guards_tell_once_beyond_their_limits() {
    let model = model();
    let plan = &model.plan;
    let volumes = [1e-3; 4];
    let step = plan.time_step;
    let density = |occupancy: f64| occupancy / kinetics::occupancy(1.0, plan.diameter);
    let filled = |occupancy: f64| {
        let number = (density(occupancy) * 1e-3) as u64;
        vec![BlockSum { number, energy: 0 }, BlockSum::default(), BlockSum::default(), BlockSum::default()]
    };
    let mut calm = tallies(20, 1980, filled(0.29));
    calm.counters.bounces = 75;
    let full_vents = vec![[1000, 9]; model.scene.vents.len()];
    let mut guards = Guards::new(&model.scene, plan, volumes.to_vec());
    let within = Shown { step, drift: 9e-6, clipped: &full_vents, ..shown(&calm) };
    assert_eq!(guards.interval(&within), Vec::new());
    let last = step / f64::from(1u32 << (plan.ladder_levels - 1));
    let clipped = vec![[1000, 11]; model.scene.vents.len()];
    type Change<'a> = (Shown<'a>, Quantity, usize);
    let (many, dense) = (tallies(100, 1900, filled(0.29)), tallies(0, 0, filled(0.4)));
    let mut busy = tallies(0, 0, Vec::new());
    busy.counters.bounces = 76;
    let mut fast = tallies(0, 0, filled(0.29));
    let total = fast.blocks[0].number as f64;
    // At the limit, but for noise, and beyond that.
    fast.fast = vec![(1e-3 * total + 2.9 * (1e-3 * total).sqrt()) as u32, 0];
    assert_eq!(guards.interval(&Shown { step, ..shown(&fast) }), Vec::new());
    fast.fast[0] = (1e-3 * total + 3.0 * (2e-3 * total + 9.0).sqrt()) as u32 + 9;
    assert_eq!(guards.interval(&Shown { step: 0.5 * step, ..shown(&fast) }), Vec::new(), "half a step is no flight");
    let cases: [Change<'_>; 7] = [
        (Shown { step, ..shown(&fast) }, Quantity::FastParticles, 1),
        (Shown { step, ..shown(&busy) }, Quantity::WallHits, 1),
        (Shown { step, ..shown(&many) }, Quantity::LostCollisions, 1),
        (Shown { step, ..shown(&dense) }, Quantity::Occupancy, 1),
        (Shown { step: last, ..shown(&calm) }, Quantity::Halvings, 1),
        (Shown { step, drift: -1.1e-5, ..shown(&calm) }, Quantity::EnergyDrift, 1),
        (Shown { step, clipped: &clipped, ..shown(&calm) }, Quantity::ClippedHits, model.scene.vents.len()),
    ];
    // With half of its cross-section the densest gas has .14 of .4.
    let shares = [FULL_SHARE / 2, FULL_SHARE, FULL_SHARE, FULL_SHARE];
    assert_eq!(guards.interval(&Shown { step, shares: &shares, ..shown(&dense) }), Vec::new());
    let mut all = 0;
    for (shown, quantity, times) in &cases {
        let told = guards.interval(shown);
        assert_eq!(quantities(&told), vec![*quantity; *times]);
        assert!(told.iter().all(|told| told.time == 1e-3 && told.to_string().starts_with("at 1.0000 ms: ")));
        assert_eq!(guards.interval(shown), Vec::new(), "once is enough");
        all += times;
    }
    assert_eq!(guards.told().len(), all);
    // Twice the smallest step is far enough, and what was told is not told again after a restart.
    let mut resumed = Guards::new(&model.scene, plan, volumes.to_vec());
    assert_eq!(resumed.interval(&Shown { step: 2.0 * last, ..shown(&calm) }), Vec::new());
    resumed.restore(guards.state());
    assert!(cases.iter().all(|(shown, ..)| resumed.interval(shown).is_empty()));
}

/// Where gas has become thin its cells are starved, unless it is so thin that it collides in none; what noise may be, and
/// the last few of the particles, are not told. Other methods have no such cells.
#[test]
fn starved_cells_are_told() {
    let text = include_str!("../../../../scenes/vent.toml").to_string();
    let mut scene = crate::scene::parse(&text, "vent.toml", Path::new("")).unwrap();
    scene.model.method = Some(Method::Cell);
    scene.model.occupancy = Some(0.25);
    let mut model = Model::new(scene).unwrap();
    let room = 64.0 * model.plan.grid.cell.powi(3);
    let step = model.plan.time_step;
    let told = |model: &Model, in_cell: f64, others: u64| {
        let block = |number| BlockSum { number, energy: 0 };
        let tallies = tallies(0, 0, vec![block((64.0 * in_cell) as u64), block(others)]);
        let mut guards = Guards::new(&model.scene, &model.plan, vec![room; 2]);
        let found = guards.interval(&Shown { step, ..shown(&tallies) });
        found.iter().filter(|told| told.warning.quantity == Quantity::CellParticles).count()
    };
    // Full cells of it have 6 particles, five free paths: 1.3 of them still one.
    assert_eq!(told(&model, 1.3, 384), 1);
    assert_eq!(told(&model, 1.8, 384), 0, "two but for noise");
    assert_eq!(told(&model, 6.0, 384), 0);
    assert_eq!(told(&model, 0.5, 384), 0, "half a free path");
    assert_eq!(told(&model, 1.3, 5000), 0, "2 % of the gas");
    model.plan.method = Method::ClosestApproach;
    assert_eq!(told(&model, 1.3, 384), 0);
}

/// Lost events are judged by thousands, and only where noise cannot have made them.
#[test]
fn noise_is_no_lost_collision() {
    let model = model();
    let step = model.plan.time_step;
    let mut guards = Guards::new(&model.scene, &model.plan, vec![1e-3]);
    let mut tell = |lost, sampled| {
        let tallies = tallies(lost, sampled, Vec::new());
        guards.interval(&Shown { step, ..shown(&tallies) }).len()
    };
    assert_eq!(tell(500, 500), 0, "too few to tell");
    assert_eq!(tell(0, 20_000), 0, "500 of 21,000");
    assert_eq!(tell(65, 1935), 0, "3.25 % +- .4 %");
    assert_eq!(tell(1000, 19_000), 1);
}

#[test]
fn few_particles_at_openings_and_probes_are_told() {
    let text = include_str!("../../../../scenes/tank.toml");
    let model = Model::new(crate::scene::parse(text, "tank.toml", Path::new("")).unwrap()).unwrap();
    let plan = &model.plan;
    let zone = |count: f64| ZoneState { particles: vec![count], ..ZoneState::default() };
    let row = |in_chamber: f64, in_probe: f64| Row {
        time: 2e-3,
        window: [1e-3, 3e-3],
        step: plan.time_step,
        particles: 1,
        chambers: vec![zone(in_chamber); plan.chambers.len()],
        probes: vec![zone(in_probe); model.scene.probes.len()],
        surfaces: Vec::new(),
        walls: Vec::new(),
        vents: Vec::new(),
        motions: Vec::new(),
        fabrics: Vec::new(),
    };
    let mut guards = Guards::new(&model.scene, plan, Vec::new());
    assert!(!plan.openings.is_empty() && !model.scene.probes.is_empty());
    let smallest = plan.chambers.iter().map(|chamber| chamber.volume).fold(f64::INFINITY, f64::min);
    let enough = 8.0 * smallest / plan.openings[0].length.powi(3);
    let largest = plan.chambers.iter().map(|chamber| chamber.volume).fold(0.0, f64::max);
    assert_eq!(guards.row(&row(1.01 * enough * largest / smallest, 100.0)), Vec::new());
    assert_eq!(guards.row(&row(1.01 * enough * largest / smallest, 0.5)), Vec::new(), "empty is not few");
    let told = guards.row(&row(0.99 * enough, 99.0));
    let expected = [plan.openings.len(), model.scene.probes.len()];
    let of = |quantity| quantities(&told).iter().filter(|found| **found == quantity).count();
    assert_eq!([of(Quantity::OpeningParticles), of(Quantity::ProbeParticles)], expected);
    assert!(guards.row(&row(0.0, 99.0)).is_empty());
}
