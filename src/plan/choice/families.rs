//! The ways to run a scene that the plan chooses from: methods, occupancies, rounds (method.md, "What the plan decides, and why"),
//! lengths of the step.

use crate::gas::kinetics;
use crate::plan::amounts::Amounts;
use crate::plan::continuum;
use crate::plan::resolution::default_occupancy;
use crate::plan::{Measured, PlanError, Quantity, Reason, forecast::Forecaster, limit};
use crate::scene::{DiameterCap, Method, Scene};

/// All candidates but for the number of particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Family {
    pub method: Method,
    /// `None`: follows from the diameter that was asked for, or there are no collisions.
    pub occupancy: Option<f64>,
    pub rounds: Option<u32>,
    /// Its step over that of a scene which asks for none, where so long a one is possible.
    pub stretch: f64,
    /// Particles from which on it is compared: with fewer its error is not known.
    pub fewest: f64,
}

/// Mean free path of the molecules over the size of the vessel from which on they do not meet (method.md, "Collisions").
const FREE_KNUDSEN: f64 = 1.0;
/// Rounds of pairing that are compared.
const ROUNDS: [u32; 2] = [8, 4];
/// Longer steps have larger cells to search, and what a particle-step needs besides counts less often. (At 2, 4.24 sqrt(kT/m) crosses
/// a cell: a few fast particles halve the step, and the cells are large in vain.)
const STRETCHES: [f64; 2] = [1.0, 1.5];
const USUAL: [f64; 1] = [0.12];
/// More than the usual one only for sharper fronts.
const OF_FRONTS: [f64; 3] = [0.12, 0.2, 0.3];

/// The families, cheapest kind first, and why these.
pub fn families(
    scene: &Scene,
    measured: &Measured,
    amounts: &Amounts,
    forecaster: &Forecaster<'_>,
) -> Result<(Vec<Family>, Reason), PlanError> {
    let (methods, why) = methods(scene, measured, amounts, forecaster)?;
    let occupancies: &[f64] = if forecaster.is_release() { &OF_FRONTS } else { &USUAL };
    let mut families = Vec::new();
    for &method in &methods {
        let collides = !matches!(method, Method::None | Method::ControlVolume);
        let of_method: Vec<Option<f64>> = match scene.model.occupancy {
            _ if method == Method::HalfTurn => vec![None],
            Some(asked) if collides => vec![Some(asked)],
            None if collides && scene.model.diameter.is_none() => match method {
                Method::HardSphere => vec![Some(default_occupancy(method))],
                // Nothing holds its diameter down where gas is dense.
                Method::Cell => vec![Some(where_dense(measured, amounts))],
                _ => occupancies.iter().copied().map(Some).collect(),
            },
            _ => vec![None],
        };
        let of_rounds: Vec<Option<u32>> = match scene.model.rounds {
            Some(asked) if method.has_rounds() => vec![Some(asked)],
            None if method.has_rounds() => ROUNDS.iter().copied().map(Some).collect(),
            _ => vec![None],
        };
        // The steps of `cell` and `none` are as long as cells or collisions allow, and rigid spheres are there for comparison.
        let longer = method == Method::ClosestApproach && scene.model.time_step.is_none();
        let stretches = if longer { &STRETCHES[..] } else { &STRETCHES[..1] };
        // Who names a method has it with any number.
        let unasked = scene.model.method.is_none();
        let fewest = if unasked && method == Method::HalfTurn { continuum::fewest(scene, measured) } else { 0.0 };
        for &occupancy in &of_method {
            for &stretch in stretches {
                families.extend(of_rounds.iter().map(|&rounds| Family { method, occupancy, rounds, stretch, fewest }));
            }
        }
    }
    let names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
    Ok((families, Reason { quantity: "methods compared".into(), value: names.join(", "), why }))
}

/// The occupancy at the mean density of the end, of cells: the usual one, or that of which the densest chamber at the start is within
/// the limit.
fn where_dense(measured: &Measured, amounts: &Amounts) -> f64 {
    let of_chamber =
        |(moles, volume): (&Vec<f64>, &f64)| moles.iter().sum::<f64>() / amounts.total() * measured.gas_volume / volume;
    let denser = amounts.initial.iter().zip(&measured.chamber_volumes).map(of_chamber).fold(1.0, f64::max);
    let most = limit(Quantity::Occupancy, Method::Cell).map_or(f64::INFINITY, |limit| limit.bound.value());
    // Three digits, downwards: chambers are rounded to particles.
    let unit = libm::pow(10.0, libm::log10(most / denser).floor() - 2.0);
    (((most / denser) / unit).floor() * unit).min(USUAL[0])
}

/// What the scene is that no control volume is, or whose effect on one is not predicted.
fn beyond_control_volumes(scene: &Scene, forecaster: &Forecaster<'_>) -> Option<&'static str> {
    if forecaster.is_release() {
        Some("a release without a wall is no control volume")
    } else if forecaster.has_open_borders() {
        Some("gas passes where chambers touch without a wall, and between control volumes there it does not")
    } else if !scene.vents.is_empty() || !scene.has_mirrors_only() {
        Some("its error beside vents, rough walls and walls that keep a temperature is not predicted yet")
    } else {
        None
    }
}

/// The first that the scene asks for of what only methods with particles have.
fn asked_of_particles(scene: &Scene) -> Option<&'static str> {
    let model = &scene.model;
    let asked = [
        ("particles", model.particles.is_some()),
        ("diameter", model.diameter.is_some()),
        ("occupancy", model.occupancy.is_some()),
        ("rounds", model.rounds.is_some()),
        ("time_step", model.time_step.is_some()),
    ];
    asked.into_iter().find_map(|(name, asked)| asked.then_some(name))
}

fn methods(
    scene: &Scene,
    measured: &Measured,
    amounts: &Amounts,
    forecaster: &Forecaster<'_>,
) -> Result<(Vec<Method>, String), PlanError> {
    measured.no_empty_space("an accuracy or a budget")?;
    let beyond = beyond_control_volumes(scene, forecaster);
    if let Some(method) = scene.model.method {
        return match beyond.filter(|_| method == Method::ControlVolume) {
            Some(why) => Err(PlanError::WishOfControlVolume { why }),
            None => Ok((vec![method], "asked for in the scene".into())),
        };
    }
    if let Some(DiameterCap::Spacings(_)) = scene.model.diameter_cap {
        return Ok((vec![Method::ClosestApproach], "the only one that has a `diameter_cap`".into()));
    }
    let path = kinetics::molecular_mean_free_path(amounts.total() / measured.gas_volume);
    let knudsen = path / libm::cbrt(measured.gas_volume);
    if knudsen >= FREE_KNUDSEN {
        let why =
            format!("the molecules themselves do not meet: Kn {knudsen:.1} of the vessel, of molecules of 0.37 nm");
        return Ok((vec![Method::None], why));
    }
    let mut methods = Vec::new();
    let mut why = Vec::new();
    match (beyond, asked_of_particles(scene)) {
        (Some(beyond), _) => why.push(format!("not the method control-volume: {beyond}")),
        (None, Some(asked)) => why.push(format!("not the method control-volume, which has no `{asked}`")),
        (None, None) => methods.push(Method::ControlVolume),
    }
    // docs/explanation/method.md, "What the plan decides, and why".
    let open = scene.orifices.is_empty()
        && scene.vents.is_empty()
        && measured.openings.is_empty()
        && scene.openings.is_empty();
    if !open {
        why.push("closest-approach, not cell, near jets, holes and vents".into());
    } else if scene.model.rounds.is_some() {
        why.push("not cell, which has no `rounds`".into());
    } else {
        methods.push(Method::Cell);
        why.push("cell in open volumes".into());
    }
    match continuum::unfit(scene, measured, amounts) {
        Some(unfit) => why.push(format!("not half-turn: {unfit}")),
        None => methods.push(Method::HalfTurn),
    }
    methods.push(Method::ClosestApproach);
    Ok((methods, why.join("; ")))
}
