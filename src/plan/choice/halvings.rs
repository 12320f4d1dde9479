//! By how many a run's steps will be more than the plan's: a run halves its steps where gas is denser or hotter than the plan's
//! mean states (`simulation/ladder.rs`). Known beforehand are the chambers at the start and the mean state at the end.

use crate::gas::kinetics;
use crate::plan::Measured;
use crate::plan::amounts::Amounts;
use crate::plan::resolution::{LADDER_TAIL, MeanState, Resolution};
use crate::scene::{Chamber, Scene};

/// What is known of the gas before the run.
pub struct Gas<'a> {
    pub scene: &'a Scene,
    pub measured: &'a Measured,
    pub amounts: &'a Amounts,
    pub particles: f64,
    /// The mean at the end.
    pub end: MeanState,
    /// The largest diameter in local mean spacings.
    pub cap: Option<f64>,
}

/// The steps of the run over those of the plan, at the start and at the end.
pub fn steps_over_planned(gas: &Gas<'_>, resolution: &Resolution) -> [f64; 2] {
    if resolution.collision_limit <= 0.0 {
        return [1.0; 2];
    }
    let at_end = resolution.collisions_in_step(gas.end, resolution.diameter);
    let times = |x: f64| resolution.halved(x, gas.end.number_density);
    let at_start = in_densest_chamber(gas, resolution).unwrap_or(at_end);
    [times(at_start), times(at_end)]
}

/// x of the initial gas but for the tail; `None` if there is none.
fn in_densest_chamber(gas: &Gas<'_>, resolution: &Resolution) -> Option<f64> {
    let Gas { scene, measured, amounts, particles, cap, .. } = *gas;
    let lightest = amounts.lightest(scene);
    let initial = amounts.initial_total();
    let of_chamber = |((chamber, moles), volume): ((&Chamber, &Vec<f64>), &f64)| {
        let moles: f64 = moles.iter().sum();
        let number_density = moles / amounts.total() * particles / volume;
        let thermal_square = kinetics::thermal_square(chamber.temperature, lightest);
        let most = cap.map_or(f64::INFINITY, |cap| cap * kinetics::mean_spacing(number_density));
        let state = MeanState { number_density, thermal_square };
        (resolution.collisions_in_step(state, resolution.diameter.min(most)), moles)
    };
    let chambers = scene.chambers.iter().zip(&amounts.initial).zip(&measured.chamber_volumes);
    let mut chambers: Vec<(f64, f64)> = chambers.map(of_chamber).filter(|(_, moles)| *moles > 0.0).collect();
    chambers.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut denser = 0.0;
    chambers.into_iter().find_map(|(x, moles)| {
        denser += moles;
        (denser > LADDER_TAIL * initial).then_some(x)
    })
}
