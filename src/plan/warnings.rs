//! What a plan will do less well than its user may expect: whatever lies beyond the table of limits.

use super::fabric::{Noise, mass_over_node};
use super::limits::{Bound, Judged, Limit, Quantity, Warning, limit, step_limit};
use super::notes::between;
use super::population::more_particles;
use super::resolution::{Resolution, TILE_EDGE, mean_free_path};
use super::text::significant;
use super::{ChamberPlan, Measured, OpeningPlan};
use crate::gas::kinetics;
use crate::scene::{Chamber, GAS_CONSTANT, Method, Scene};

/// Share of collision events lost, by x = dt/tau (first column) for 1 to 4 rounds (docs/explanation/method.md,
/// "Collisions"; measured at f = .1, +-.01; gains taken as zero).
const LOST: [[f64; 5]; 6] = [
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [0.05, 0.055, 0.002, 0.006, 0.001],
    [0.1, 0.116, 0.018, 0.0, 0.0],
    [0.2, 0.186, 0.053, 0.018, 0.006],
    [0.5, 0.352, 0.145, 0.065, 0.030],
    [1.0, 0.538, 0.288, 0.154, 0.086],
];

/// Interpolated in the table; constant beyond x = 1. Eight rounds lose about half of what four do at x = .5
/// (measured in `tests/verification`), those between in proportion.
pub fn lost_events(collisions_per_step: f64, rounds: u32) -> f64 {
    let column = rounds.clamp(1, 4) as usize;
    let share = 1.0 - 0.125 * f64::from(rounds.clamp(4, 8) - 4);
    for pair in LOST.windows(2) {
        let (low, high) = (pair[0], pair[1]);
        if collisions_per_step <= high[0] {
            let fraction = (collisions_per_step - low[0]) / (high[0] - low[0]);
            return share * (low[column] + fraction * (high[column] - low[column]));
        }
    }
    share * LOST[5][column]
}

/// Of a step that is asked for, so that its digits do not make it longer than what it is to be.
const ROUNDED_DOWN: f64 = 0.99;

/// Chambers with less than this share of the highest pressure have fronts run into them.
const PRESSED: f64 = 0.5;

/// The unit of length of a plan's warnings, which are the same whatever the scene's: a checkpoint is held against them.
const MILLIMETRES: (f64, &str) = (1e-3, "mm");

/// What has been decided so far.
pub struct Decided<'a> {
    pub method: Method,
    pub moles_per_particle: f64,
    pub particles: u64,
    /// Particles per m3 at the end.
    pub number_density: f64,
    /// J, kT of a particle at the end.
    pub thermal_energy: f64,
    pub resolution: &'a Resolution,
    /// In local mean spacings.
    pub diameter_cap: Option<f64>,
    pub chambers: &'a [ChamberPlan],
    pub openings: &'a [OpeningPlan],
}

pub fn warnings(scene: &Scene, measured: &Measured, decided: &Decided<'_>) -> Vec<Warning> {
    let Decided { method, particles, number_density, resolution, openings, .. } = *decided;
    let table =
        |quantity, subject: &str, value, remedy: &str| Warning::by_table(quantity, method, subject, value, remedy);
    let mut found = Vec::new();
    found.push(table(Quantity::Particles, "the run", particles as f64, "more `particles`"));
    if method == Method::None {
        found.extend(free_molecules(scene, measured, openings));
    } else {
        found.extend(openings.iter().map(|opening| {
            let wanted = limit(Quantity::Knudsen, method).map_or(f64::NAN, |l| l.bound.value());
            // lambda ~ d at fixed occupancy, d ~ N^(-1/3).
            let times = (opening.knudsen / wanted).powi(3);
            let more = more_particles(times, particles as f64);
            let remedy = more.map_or("a modelled vent".to_string(), |more| format!("{more}, or a modelled vent"));
            table(Quantity::Knudsen, &format!("opening `{}`", opening.name), opening.knudsen, &remedy)
        }));
        found.push(dense(decided));
        found.push(narrow(scene, measured, decided));
        found.extend(thin(scene, decided));
        found.extend(starved(decided));
    }
    found.extend(too_thin(scene, measured, method));
    found.extend(scene.probes.iter().zip(&measured.probe_volumes).map(|(probe, volume)| {
        let count = number_density * volume;
        let remedy = if *volume > 0.0 {
            "a larger region, or more `particles`"
        } else {
            "no gas is in its region: move it into the gas, in the units of the scene"
        };
        table(Quantity::ProbeParticles, &format!("probe `{}` at the end of the run", probe.name), count, remedy)
    }));
    if let Some(mass_over_node) = mass_over_node(scene, measured, decided.moles_per_particle) {
        let remedy = "more `particles`, or a mesh of larger triangles";
        found.push(table(Quantity::NodeMass, "elastic fabric", mass_over_node, remedy));
        let noise = Noise { mass_over_node, thermal_energy: decided.thermal_energy };
        let ripples = noise.final_ripples(scene, measured, number_density);
        found.extend(ripples.map(|share| table(Quantity::Ripples, "elastic fabric at the end", share, remedy)));
    }
    found.push(long_steps(decided));
    found.push(busy_walls(measured, decided));
    if !method.has_rounds() {
        let remedy = "a smaller `time_step`";
        found.push(table(Quantity::Flight, "the time step", resolution.flight_over_cell, remedy));
    }
    found.into_iter().flatten().collect()
}

/// The densest state that is known: the mean at the end, or a chamber at the start.
fn dense(decided: &Decided<'_>) -> Option<Warning> {
    let Decided { method, resolution, diameter_cap, .. } = *decided;
    let of_chamber = |chamber: &ChamberPlan| {
        let density = chamber.particles.iter().sum::<u64>() as f64 / chamber.volume;
        (density, format!("chamber `{}` at the start", chamber.name))
    };
    let at_end = (decided.number_density, "the gas at the end".to_string());
    let (density, subject) =
        decided.chambers.iter().map(of_chamber).fold(at_end, |most, next| if next.0 > most.0 { next } else { most });
    let diameter = kinetics::capped_diameter(resolution.diameter, diameter_cap, density);
    let occupancy = kinetics::occupancy(density, diameter);
    let remedy = match method {
        // Carnahan and Starling's formula has a pole at 1.
        Method::HardSphere if occupancy < 0.7 => format!(
            "they press {:.1} % harder (Carnahan-Starling); `hard-sphere` is for comparison with legacy results only",
            100.0 * (kinetics::rigid_compressibility(occupancy) - 1.0)
        ),
        Method::ClosestApproach => "a smaller `occupancy`, `diameter` or `diameter_cap`".to_string(),
        _ => "a smaller `occupancy` or `diameter`".to_string(),
    };
    // A cap that is the limit may be rounded beyond it.
    let rounded = |limit: &Limit| occupancy <= limit.bound.value() * (1.0 + 1e-9);
    if limit(Quantity::Occupancy, method).is_some_and(rounded) {
        return None;
    }
    Warning::by_table(Quantity::Occupancy, method, &subject, occupancy, &remedy)
}

/// The thinnest gas of those that have less pressure than another.
fn thin(scene: &Scene, decided: &Decided<'_>) -> Option<Option<Warning>> {
    let Decided { method, particles, resolution, chambers, .. } = *decided;
    let highest = scene.chambers.iter().map(|chamber| chamber.pressure).fold(0.0, f64::max);
    let of_chamber = |(chamber, plan): (&Chamber, &ChamberPlan)| {
        let density = plan.particles.iter().sum::<u64>() as f64 / plan.volume;
        let path = mean_free_path(method, density, resolution.diameter) / libm::cbrt(plan.volume);
        (chamber.pressure < PRESSED * highest && density > 0.0).then(|| (path, plan.name.clone()))
    };
    let (path, name) = scene.chambers.iter().zip(chambers).filter_map(of_chamber).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let subject = format!("chamber `{name}` at the start");
    // As lambda ~ N^(-1/3) at fixed occupancy.
    let bound = limit(Quantity::ThinGas, method).map_or(f64::NAN, |l| l.bound.value());
    let more = more_particles((path / bound).powi(3), particles as f64);
    let remedy = more.unwrap_or_else(|| "more gas there: no run has particles enough".to_string());
    Some(Warning::by_table(Quantity::ThinGas, method, &subject, path, &remedy))
}

/// Chambers with few particles in each collision cell: of the method `cell` where gas has no longer free path than that, of `half-turn` in a
/// tile.
fn starved(decided: &Decided<'_>) -> Vec<Option<Warning>> {
    let Decided { method, resolution, chambers, .. } = *decided;
    let of_chamber = |chamber: &ChamberPlan| {
        let density = chamber.particles.iter().sum::<u64>() as f64 / chamber.volume;
        if method == Method::HalfTurn && density > 0.0 {
            let subject = format!("chamber `{}` at the start", chamber.name);
            // Tiles follow the mean density of the end, so more particles have as few there.
            let remedy = "another `method` where viscosity counts there";
            return Warning::by_table(
                Quantity::CellParticles,
                method,
                &subject,
                density * (TILE_EDGE * resolution.cell).powi(3),
                remedy,
            );
        }
        if method != Method::Cell
            || density <= 0.0
            || kinetics::mean_free_path(density, resolution.diameter) > resolution.cell
        {
            return None;
        }
        let subject = format!("chamber `{}` at the start", chamber.name);
        let remedy = "a smaller `diameter` or `occupancy`, or another `method`";
        Warning::by_table(Quantity::CellParticles, method, &subject, density * resolution.cell.powi(3), remedy)
    };
    chambers.iter().map(of_chamber).collect()
}

/// Passages that gas collides across as if they were not there.
fn narrow(scene: &Scene, measured: &Measured, decided: &Decided<'_>) -> Option<Warning> {
    let Decided { method, resolution, openings, .. } = *decided;
    let smallest = smallest_passage(measured, openings);
    let gap = measured.smallest_gap.filter(|gap| gap.length <= smallest);
    let opening = openings.iter().find(|opening| opening.length <= smallest);
    let place = match gap {
        Some(gap) => between(scene, &gap, MILLIMETRES),
        None => opening.map(|opening| format!("of opening `{}`", opening.name)),
    };
    let touching = gap.is_some_and(|gap| gap.walls[0] != gap.walls[1]);
    let remedy = if touching { "; let the walls overlap if they were meant to touch" } else { "" };
    let (length, what) = match method {
        Method::Cell => (resolution.cell, "cell"),
        Method::HalfTurn => (2.0 * resolution.cell, "collision cell"),
        _ => (resolution.diameter, "collision diameter"),
    };
    let subject = format!(
        "the smallest passage, {} mm{}, with a {what} of {} mm",
        significant(1e3 * smallest),
        place.map_or(String::new(), |place| format!(" {place}")),
        significant(1e3 * length)
    );
    Warning::by_table(
        Quantity::Gap,
        method,
        &subject,
        smallest / length,
        &format!("more `particles`, or a modelled vent{remedy}"),
    )
}

fn smallest_passage(measured: &Measured, openings: &[OpeningPlan]) -> f64 {
    let gap = measured.smallest_gap.map(|gap| gap.length);
    openings.iter().map(|opening| opening.length).chain(gap).fold(f64::INFINITY, f64::min)
}

/// What positions on the grid do not tell apart.
fn too_thin(scene: &Scene, measured: &Measured, method: Method) -> [Option<Warning>; 2] {
    let longest = (0..3).map(|axis| measured.bounds_max[axis] - measured.bounds_min[axis]).fold(0.0, f64::max);
    let warning = |what: &str, found: Option<f64>, place: Option<String>, remedy: &str| {
        let found = found?;
        let place = place.map_or(String::new(), |place| format!(" {place}"));
        let subject = format!("{what}, {} mm{place}", significant(1e3 * found));
        Warning::by_table(Quantity::Thickness, method, &subject, found / longest, remedy)
    };
    [
        warning(
            "the thinnest body",
            measured.thinnest_body,
            None,
            "a thicker one: what gas does beside it hardly depends on it",
        ),
        warning(
            "the narrowest gap",
            measured.smallest_gap.map(|gap| gap.length),
            measured.smallest_gap.and_then(|gap| between(scene, &gap, MILLIMETRES)),
            "walls that overlap, or a wider gap",
        ),
    ]
}

/// The largest of the ladder; a run takes shorter steps where it must.
fn long_steps(decided: &Decided<'_>) -> Option<Warning> {
    let Decided { method, resolution, .. } = *decided;
    if method == Method::None {
        return None;
    }
    let x = resolution.collisions_per_step;
    let limit = step_limit(method, resolution.rounds);
    let (effect, remedy) = if method.has_rounds() {
        let lost = 100.0 * lost_events(x, resolution.rounds);
        let effect = format!("about {lost:.0} % of the collisions of {} rounds would be lost", resolution.rounds);
        (effect, "the run takes shorter ones; a smaller `time_step`, or more `rounds`")
    } else {
        ("the gas of a cell changes within the step".to_string(), "the run takes shorter ones; a smaller `time_step`")
    };
    // A step that is the limit by the plan's own choice may be rounded beyond it.
    let bound = Bound::AtMost(limit);
    if x <= limit * (1.0 + 1e-9) {
        return None;
    }
    Warning::beyond(Quantity::Step, bound, &effect, Judged { subject: "the time step", value: x, remedy })
}

/// Of a particle in a step: cbar dt S / (4 V), with cbar tau the mean free path. (Only methods with collisions have a
/// limit of it.)
pub fn wall_hits(measured: &Measured, number_density: f64, resolution: &Resolution) -> f64 {
    let x = resolution.collisions_per_step;
    let flown = match resolution.method {
        // Of thermal speed.
        Method::HalfTurn => kinetics::mean_speed(1.0) * x * kinetics::mean_spacing(number_density),
        _ => x * kinetics::mean_free_path(number_density, resolution.diameter),
    };
    flown * measured.wall_area / (4.0 * measured.gas_volume)
}

fn busy_walls(measured: &Measured, decided: &Decided<'_>) -> Option<Warning> {
    let Decided { method, number_density, resolution, .. } = *decided;
    let hits = wall_hits(measured, number_density, resolution);
    // Hits grow with the step.
    let most = limit(Quantity::WallHits, method).map_or(f64::NAN, |l| l.bound.value());
    let step = significant(1e6 * ROUNDED_DOWN * resolution.time_step * most / hits);
    Warning::by_table(Quantity::WallHits, method, "the time step", hits, &format!("a `time_step` of {step} us"))
}

/// Free flight is right where molecules do not meet either: their mean free path over the smallest passage, or the size
/// of the vessel.
fn free_molecules(scene: &Scene, measured: &Measured, openings: &[OpeningPlan]) -> Option<Option<Warning>> {
    let length = smallest_passage(measured, openings).min(libm::cbrt(measured.gas_volume));
    let dense = |chamber: &Chamber| chamber.pressure / (GAS_CONSTANT * chamber.temperature);
    let densest = scene.chambers.iter().max_by(|a, b| dense(a).total_cmp(&dense(b)))?;
    let path = kinetics::molecular_mean_free_path(dense(densest));
    let subject = format!("the molecules of chamber `{}`", densest.name);
    Some(Warning::by_table(Quantity::Knudsen, Method::None, &subject, path / length, "another `method`"))
}
