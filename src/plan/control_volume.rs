//! The plan of a control volume: no particles, no step, no grid to speak of.

use super::amounts::{Amounts, highest_temperature};
use super::population::{openings, silent_orifices};
use super::resolution::{LADDER_LEVELS, STEPS_PER_INTERVAL, TALLY_EVERY};
use super::{ChamberPlan, GasPlan, Inventory, Measured, OpeningPlan, Plan, PlanError, Reason, notes};
use crate::gas::Species;
use crate::geometry::Grid;
use crate::scene::{Method, Scene};

/// Amounts in the history are in this part of all gas, where the scene does not say `particles`.
const PARTS: u64 = 1_000_000;
/// Cells along the longest edge of a grid that holds nothing.
const CELLS: f64 = 8.0;

pub fn plan(
    scene: &Scene,
    measured: &Measured,
    species: &[Species],
    amounts: &Amounts,
    mut reasons: Vec<Reason>,
) -> Result<Plan, PlanError> {
    measured.no_empty_space("the method `control-volume`")?;
    super::motion::reasons(scene, measured, &mut reasons);
    super::facets::reasons(scene, &mut reasons);
    let mut because = |quantity: &str, value: &str, why: &str| {
        reasons.push(Reason { quantity: quantity.into(), value: value.into(), why: why.into() });
    };
    because(
        "particles",
        "none",
        "each chamber has one pressure, one temperature and one composition; right once pressures are uniform",
    );
    because(
        "openings",
        "continuum",
        "0.84 of isentropic flow into vacuum, 0.61 by small differences of pressure, of the gas of the upper chamber",
    );
    let parts = scene.model.particles.unwrap_or(PARTS);
    let unit = amounts.total() / parts as f64;
    because(
        "amounts",
        &format!("{unit:.4e} mol"),
        "what the columns `particles` of the history count in, for comparison with runs of particles",
    );
    let (low, high) = (measured.bounds_min, measured.bounds_max);
    let longest = (0..3).map(|axis| high[axis] - low[axis]).fold(0.0, f64::max);
    let openings: Vec<OpeningPlan> = openings(scene, measured)
        .map(|opening| OpeningPlan {
            name: opening.name.clone(),
            between: opening.between,
            area: opening.area,
            length: opening.length,
            knudsen: 0.0,
        })
        .collect();
    let gases = scene.gases.iter().zip(species).map(|(gas, species)| GasPlan {
        name: gas.name.clone(),
        molar_mass: gas.molar_mass,
        spin_dof: species.spin_dof(amounts.final_temperature),
        exchange_probability: 0.0,
        particles: 0,
        species: species.clone(),
    });
    let chambers = scene.chambers.iter().zip(&measured.chamber_volumes).map(|(chamber, &volume)| ChamberPlan {
        name: chamber.name.clone(),
        volume,
        particles: vec![0; scene.gases.len()],
    });
    let mut inventory = Inventory::of(scene, measured, amounts);
    inventory.notes.extend(notes::open_beside_walls(scene, measured));
    inventory.notes.extend(notes::gaps_beside(scene, measured, false));
    Ok(Plan {
        inventory,
        method: Method::ControlVolume,
        particles: 0,
        initial_particles: 0,
        injected_particles: 0,
        moles_per_particle: unit,
        diameter: 0.0,
        diameter_cap: None,
        occupancy: 0.0,
        mean_free_path: 0.0,
        collision_number: 0.0,
        rounds: 0,
        collision_limit: 0.0,
        time_step: scene.end_time,
        ladder_levels: LADDER_LEVELS,
        steps_per_interval: STEPS_PER_INTERVAL,
        tally_every: TALLY_EVERY,
        block_cells_log2: 1,
        temperature_reference: amounts.final_temperature,
        temperature_max: highest_temperature(scene, measured).0,
        seed: scene.seed,
        end_time: scene.end_time,
        estimated_steps: 0.0,
        grid: Grid::around(low, high, longest / CELLS)?,
        chambers: chambers.collect(),
        gases: gases.collect(),
        warnings: warnings(scene, measured, species, &openings),
        openings,
        vents: Vec::new(),
        reasons,
        left_out: Vec::new(),
        forecast: None,
    })
}

/// Chambers that gas cannot leave, beside others; what a control volume does not know; and what it cuts, as particles do. (A vent
/// passes what is asked of it here: there are no hits that could be too few.)
fn warnings(scene: &Scene, measured: &Measured, species: &[Species], openings: &[OpeningPlan]) -> Vec<String> {
    let alone = |index: usize| openings.iter().all(|opening| !opening.between.contains(&index));
    let several = scene.chambers.len() > 1;
    let chambers = scene.chambers.iter().enumerate().filter(|(index, _)| several && alone(*index));
    let closed = chambers.map(|(_, chamber)| {
        format!(
            "no opening is known of chamber `{}`: its gas stays in it, though nothing but its region may part it from \
             another chamber; declare an [[opening]], or make it one with its neighbour",
            chamber.name
        )
    });
    let rough = scene.surface_ids().filter(|&id| scene.surface_model(id).friction > 0.0).map(|id| {
        format!(
            "wall `{}` has a friction, which a control volume does not know: holes flow as if walls were smooth",
            scene.surface_name(id)
        )
    });
    let heat = super::vents::heat(scene, species, Method::ControlVolume, measured);
    let silent = silent_orifices(scene);
    let facets = super::facets::warnings(scene, Method::ControlVolume);
    closed.chain(rough).chain(silent).chain(heat).chain(facets).chain(super::motion::covered(scene, measured)).collect()
}
