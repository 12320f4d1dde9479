//! The decisions in order: amounts, particles, diameter, rounds, step, grid.

use super::amounts::{Amounts, highest_temperature};
use super::cap::diameter_cap;
use super::continuum;
use super::error::{MOST_CELLS, MOST_GASES};
use super::heat::species;
use super::limits::Quantity;
use super::longest::{Basis, asked_and_own, possible_step};
use super::population::{Population, openings, silent_orifices, wanted};
use super::resolution::{
    ExpectedGas, Extreme, LADDER_LEVELS, MeanState, PER_BLOCK, Resolution, STEPS_PER_INTERVAL, TALLY_EVERY,
    default_occupancy, mean_free_path,
};
use super::text::significant;
use super::warnings::{Decided, warnings};
use super::{
    ChamberPlan, GasPlan, Inventory, Measured, OpeningPlan, Plan, PlanError, Reason, control_volume, facets, motion,
    notes, plausible, vents,
};
use crate::gas::{Species, jet_mach, jet_state, kinetics};
use crate::geometry::Grid;
use crate::scene::{FASTEST_JET, GAS_CONSTANT, Jet, JetSpeed, Method, Scene, Switch};

const DEFAULT_COLLISION_NUMBER: f64 = 5.0;

/// Decides what to model, or says why it cannot be modelled.
pub fn plan(scene: &Scene, measured: &Measured) -> Result<Plan, PlanError> {
    if scene.gases.len() > MOST_GASES {
        return Err(PlanError::TooManyGases { found: scene.gases.len(), limit: MOST_GASES });
    }
    let mut of_heat = Vec::new();
    let species = species(scene, measured, &mut of_heat)?;
    jets(scene, &species)?;
    let amounts = Amounts::of(scene, &species, measured)?;
    let (method, why) = continuum::method(scene, measured, &amounts);
    let mut reasons = vec![why];
    reasons.append(&mut of_heat);
    switch(scene, method, &mut reasons)?;
    if scene.model.switch.is_some() {
        measured.no_empty_space("`switch`")?;
    }
    if method == Method::ControlVolume {
        return control_volume::plan(scene, measured, &species, &amounts, reasons);
    }
    let wanted_occupancy = scene.model.occupancy.unwrap_or_else(|| default_occupancy(method));
    let (wanted, why) = wanted(scene, measured, &amounts, method, wanted_occupancy);
    reasons.push(why);
    let population = Population::count(scene, &species, &amounts, wanted)?;
    let (initial_particles, injected_particles) = (population.initial_total(), population.injected_total());
    let particles = initial_particles + injected_particles;

    let (temperature_max, why) = highest_temperature(scene, measured);
    reasons.push(Reason {
        quantity: "highest temperature".into(),
        value: format!("{} K", significant(temperature_max)),
        why,
    });
    let extreme = Extreme(kinetics::thermal_square(temperature_max, amounts.lightest(scene)));
    motion::reasons(scene, measured, &mut reasons);
    facets::reasons(scene, &mut reasons);
    let states = mean_states(scene, measured, &amounts, [initial_particles as f64, particles as f64]);
    let number_density = states[1].number_density;
    let basis = Basis { method, request: &scene.model, measured, states, extreme, particles, end_time: scene.end_time };
    let (request, shortened) = possible_step(&basis)?;
    let steps = asked_and_own(&basis)?;
    let gas = ExpectedGas { states, extreme };
    let resolution = Resolution::choose(method, &request, gas, scene.end_time, &mut reasons)?;
    let diameter_cap = diameter_cap(scene, method, resolution.diameter, number_density, &mut reasons)?;
    let (collision_number, why) = collision_number(scene, &species, amounts.final_temperature);
    // (Where all particles of a cell collide at once there is none.)
    if method != Method::HalfTurn {
        reasons.push(why);
    }
    let gases = gases(scene, &species, amounts.final_temperature, &population, collision_number)?;

    let grid = Grid::around(measured.bounds_min, measured.bounds_max, resolution.cell)?;
    // Each axis may fit a position while all cells together do not fit a number.
    if grid.cell_count() > MOST_CELLS {
        return Err(PlanError::TooManyCells { cells: grid.cell_count(), limit: MOST_CELLS });
    }
    let mean_free_path = mean_free_path(method, number_density, resolution.diameter);
    let openings: Vec<OpeningPlan> = openings(scene, measured)
        .map(|opening| OpeningPlan {
            name: opening.name.clone(),
            between: opening.between,
            area: opening.area,
            length: opening.length,
            knudsen: mean_free_path / opening.length,
        })
        .collect();
    let occupancy = kinetics::occupancy(number_density, resolution.diameter);
    let chambers = chambers(scene, measured, population.initial);
    let decided = Decided {
        method,
        moles_per_particle: population.moles_per_particle,
        particles,
        number_density,
        thermal_energy: population.moles_per_particle * GAS_CONSTANT * amounts.final_temperature,
        resolution: &resolution,
        diameter_cap,
        chambers: &chambers,
        openings: &openings,
    };
    super::fabric::reasons(scene, measured, population.moles_per_particle, decided.thermal_energy, &mut reasons);
    let beyond = warnings(scene, measured, &decided);
    let narrow = beyond.iter().any(|warning| warning.quantity == Quantity::Gap);
    let mut warnings: Vec<String> = beyond.into_iter().map(|warning| warning.text).collect();
    warnings.extend(shortened);
    warnings.extend(silent_orifices(scene));
    warnings.extend(facets::warnings(scene, method));
    warnings.extend(population.warnings);
    let vents = vents::planned(scene, &species, measured);
    warnings.extend(vents::warnings(scene, &species, method, &vents, measured));
    warnings.extend(motion::warnings(scene, &species, method, measured));
    let mut inventory = Inventory::of(scene, measured, &amounts);
    let [many, long] =
        [plausible::many_steps(scene, resolution.steps as f64), plausible::long_run(scene, measured, method)];
    let short = steps.and_then(|[asked, own]| plausible::short_step(scene, asked, own));
    inventory.doubts.extend([many, short, long].into_iter().flatten().map(|doubt| scene.lines.told(doubt)));
    inventory.notes.extend(notes::touching(scene, measured));
    let narrow_gap = if narrow { None } else { notes::narrow_gap(scene, measured) };
    inventory.notes.extend(notes::gaps_beside(scene, measured, narrow || narrow_gap.is_some()));
    inventory.notes.extend(narrow_gap);
    Ok(Plan {
        inventory,
        method,
        particles,
        initial_particles,
        injected_particles,
        moles_per_particle: population.moles_per_particle,
        diameter: resolution.diameter,
        diameter_cap,
        occupancy,
        mean_free_path,
        collision_number,
        rounds: resolution.rounds,
        collision_limit: resolution.collision_limit,
        time_step: resolution.time_step,
        ladder_levels: LADDER_LEVELS,
        steps_per_interval: STEPS_PER_INTERVAL,
        tally_every: TALLY_EVERY,
        block_cells_log2: block_cells_log2(&grid, number_density),
        temperature_reference: amounts.final_temperature,
        temperature_max,
        seed: scene.seed,
        end_time: scene.end_time,
        estimated_steps: resolution.steps as f64,
        grid,
        chambers,
        left_out: left_out(scene, method, &gases, injected_particles, diameter_cap.is_some()),
        gases,
        openings,
        vents,
        reasons,
        warnings,
        forecast: None,
    })
}

/// Whether and when the run goes on as a control volume.
fn switch(scene: &Scene, method: Method, reasons: &mut Vec<Reason>) -> Result<(), PlanError> {
    let value = match scene.model.switch {
        None => return Ok(()),
        Some(Switch::At(at)) if at >= scene.end_time => {
            return Err(PlanError::SwitchTime { at, end: scene.end_time });
        }
        Some(Switch::At(at)) => format!("at {} ms", significant(1e3 * at)),
        Some(Switch::WhenUniform { lasting }) if lasting >= scene.end_time => {
            return Err(PlanError::SwitchTime { at: lasting, end: scene.end_time });
        }
        Some(Switch::WhenUniform { .. }) if method == Method::HardSphere && !scene.surfaces.is_empty() => {
            return Err(PlanError::SwitchOfRigidSpheres);
        }
        Some(Switch::WhenUniform { .. }) if scene.probes.is_empty() && scene.surfaces.is_empty() => {
            return Err(PlanError::SwitchUnseen);
        }
        Some(Switch::WhenUniform { lasting }) => {
            format!("once probes and surfaces have had their chambers' pressures for {} ms", significant(1e3 * lasting))
        }
    };
    let why = "asked for: from there on without particles".into();
    reasons.push(Reason { quantity: "control volume".into(), value, why });
    Ok(())
}

/// A jet of given velocity must be possible whenever its gas flows.
fn jets(scene: &Scene, species: &[Species]) -> Result<(), PlanError> {
    for orifice in &scene.orifices {
        let Some(Jet { speed: JetSpeed::Velocity(velocity), .. }) = orifice.jet else { continue };
        let speed = JetSpeed::Velocity(velocity);
        // The coldest decides; a temperature is linear between the points of its curve.
        let temperature = orifice.temperature.points.iter().map(|point| point[1]).fold(f64::INFINITY, f64::min);
        let mach = jet_mach(speed, temperature, &orifice.mixture, species);
        if mach > FASTEST_JET {
            let largest = jet_state(JetSpeed::Mach(FASTEST_JET), temperature, &orifice.mixture, species);
            let fastest = largest.map_or(0.0, |[drift, _]| drift);
            let (orifice, limit) = (orifice.name.clone(), FASTEST_JET);
            return Err(PlanError::JetTooFast { orifice, velocity, temperature, mach, limit, fastest });
        }
    }
    Ok(())
}

/// What the scene lacks: `subdomain::Features` has the same flags, and compiles nothing for them (of gases the kernels know
/// the number).
fn left_out(scene: &Scene, method: Method, gases: &[GasPlan], injected: u64, capped: bool) -> Vec<&'static str> {
    let present = || gases.iter().filter(|gas| gas.particles > 0);
    let modelled = !scene.vents.is_empty() || !scene.has_mirrors_only();
    let has = [
        ("collisions", method != Method::None),
        ("a diameter that follows the local density", capped || method != Method::ClosestApproach),
        ("spin energy", present().any(|gas| gas.species.has_spin())),
        ("heat capacities that depend on the temperature", present().any(|gas| !gas.species.is_constant())),
        ("a second gas", gases.len() > 1),
        ("inflow", injected > 0),
        ("measured surfaces", !scene.surfaces.is_empty()),
        ("walls that are no mirrors", modelled),
        ("vents", !scene.vents.is_empty()),
        ("walls that move", !scene.motions.is_empty()),
    ];
    has.into_iter().filter(|(_, there)| !there).map(|(name, _)| name).collect()
}

/// At the start and the end, from the particles in the gas volume at each.
pub fn mean_states(scene: &Scene, measured: &Measured, amounts: &Amounts, particles: [f64; 2]) -> [MeanState; 2] {
    let (final_mass, initial_mass) = amounts.mean_molar_masses(scene);
    let state = |count: f64, volume: f64, temperature, molar_mass| MeanState {
        number_density: count / volume,
        thermal_square: kinetics::thermal_square(temperature, molar_mass),
    };
    let end = state(particles[1], measured.final_volume(), amounts.final_temperature, final_mass);
    // Without initial gas there is no state to limit the step.
    let start = if particles[0] > 0.0 {
        state(particles[0], measured.gas_volume, amounts.initial_temperature, initial_mass)
    } else {
        end
    };
    [start, end]
}

/// Z, raised where nothing was asked and a gas cannot relax that fast, and why.
/// A heat capacity that depends on the temperature counts as it is at `temperature`, K: the exchange probability is
/// constant.
fn collision_number(scene: &Scene, species: &[Species], temperature: f64) -> (f64, Reason) {
    let least = |gas: &Species| kinetics::least_collision_number(gas.spin_dof(temperature));
    let least = species.iter().map(least).fold(0.0, f64::max);
    let (number, why) = match scene.model.collision_number {
        Some(number) => (number, "asked for"),
        None if least > DEFAULT_COLLISION_NUMBER => (least, "the fastest spin exchange of the gas with the most spin"),
        None => (DEFAULT_COLLISION_NUMBER, "rotation relaxes in about five collisions"),
    };
    (number, Reason { quantity: "collision number".into(), value: significant(number), why: why.into() })
}

/// Each gas with its exchange by this Z.
fn gases(
    scene: &Scene,
    species: &[Species],
    temperature: f64,
    population: &Population,
    collision_number: f64,
) -> Result<Vec<GasPlan>, PlanError> {
    let gases = scene.gases.iter().zip(species).enumerate().map(|(index, (gas, species))| {
        let spin_dof = species.spin_dof(temperature);
        let exchange_probability = kinetics::exchange_probability(spin_dof, collision_number).ok_or_else(|| {
            let least = kinetics::least_collision_number(spin_dof);
            PlanError::CollisionNumber { gas: gas.name.clone(), found: collision_number, least }
        })?;
        Ok(GasPlan {
            name: gas.name.clone(),
            molar_mass: gas.molar_mass,
            spin_dof,
            exchange_probability,
            particles: population.of_gas(index),
            species: species.clone(),
        })
    });
    gases.collect()
}

fn chambers(scene: &Scene, measured: &Measured, counts: Vec<Vec<u64>>) -> Vec<ChamberPlan> {
    let volumes = measured.chamber_volumes.iter().copied();
    let chambers = scene.chambers.iter().zip(volumes).zip(counts);
    chambers
        .map(|((chamber, volume), particles)| ChamberPlan { name: chamber.name.clone(), volume, particles })
        .collect()
}

/// The smallest block, of at least two cells, that holds enough particles at the mean density; no larger
/// than the grid.
fn block_cells_log2(grid: &Grid, number_density: f64) -> u32 {
    let per_cell = number_density * grid.cell * grid.cell * grid.cell;
    let most = grid.cells.iter().copied().max().unwrap_or(1);
    let mut log2 = 1;
    while per_cell * f64::from(1u32 << log2).powi(3) < PER_BLOCK && (1u32 << log2) < most {
        log2 += 1;
    }
    log2
}
