//! How many particles, and how many of them in which chamber and of which gas.

use super::amounts::{Amounts, delivers};
use super::error::MOST_PARTICLES;
use super::limits::{Quantity, limit};
use super::resolution::cell_edge;
use super::text::{grouped, significant};
use super::{Measured, PlanError, Reason};
use crate::gas::{Inflow, InflowParticles, Species, Unrepresented, kinetics};
use crate::scene::{Method, Orifice, Scene};

/// Wanted noise of the pressure on a wall, and the time over which it is averaged, s.
const NOISE: f64 = 0.05;
const WINDOW: f64 = 1e-3;
/// Wanted Knudsen number of the smallest opening: about 7 % on its flow.
pub const WANTED_KNUDSEN: f64 = 0.1;
/// The most particles that the plan chooses by itself.
const MOST_UNASKED: f64 = 1e7;

/// At the mean density of the end. Cells that are coarse to a hole's gas take a smaller one, and all the more where that is denser: their guard's
/// at most.
fn wanted_knudsen(method: Method, occupancy: f64) -> f64 {
    if method != Method::Cell {
        return WANTED_KNUDSEN;
    }
    // In mean spacings.
    let edge = cell_edge(1.0, kinetics::diameter(1.0, occupancy));
    let worse = kinetics::viscosity_of_cells(edge / kinetics::mean_free_path_over_spacing(occupancy));
    let guard = limit(Quantity::Knudsen, method).map_or(WANTED_KNUDSEN, |limit| limit.bound.value());
    (WANTED_KNUDSEN / worse).min(guard)
}

/// N_stat = 5.1 V / (cbar A T_w eps^2) and N_res = V / d^3, d = Kn l / .79 (method.md, "What the plan decides, and why").
///
/// The area is not a part of the scene: A = V^(2/3) / 16, a sixteenth of the face of a cube of the gas
/// volume (.0096 m2 for 60 L). Also why.
pub fn wanted(scene: &Scene, measured: &Measured, amounts: &Amounts, method: Method, occupancy: f64) -> (u64, Reason) {
    let give = |count: u64, why: String| (count, Reason { quantity: "particles".into(), value: grouped(count), why });
    if let Some(count) = scene.model.particles {
        return give(count, "asked for; initial and injected gas together at the end".into());
    }
    let volume = measured.inflated.unwrap_or(measured.gas_volume);
    let (molar_mass, _) = amounts.mean_molar_masses(scene);
    let speed = kinetics::mean_speed(kinetics::thermal_square(amounts.final_temperature, molar_mass));
    let area = libm::pow(volume, 2.0 / 3.0) / 16.0;
    let statistics = 5.1 * volume / (speed * area * WINDOW * NOISE * NOISE);
    let noise = format!("{:.0} % noise of the pressure on {} cm2 in 1 ms", 100.0 * NOISE, significant(1e4 * area));
    let smallest = openings(scene, measured).map(|opening| opening.length).fold(f64::INFINITY, f64::min);
    let wanted = wanted_knudsen(method, occupancy);
    let path = match method {
        Method::HalfTurn => kinetics::HALF_TURN_PATHS[0],
        _ => kinetics::effective_mean_free_path_over_spacing(occupancy),
    };
    let spacing = wanted * smallest / path;
    let resolution = volume / (spacing * spacing * spacing);
    if method == Method::None || resolution <= statistics {
        return give(statistics.min(MOST_UNASKED).ceil() as u64, noise);
    }
    if resolution > MOST_UNASKED {
        let why = format!(
            "the most without being asked; an opening of {} mm at Kn {} takes {:.1e}",
            significant(1e3 * smallest),
            significant(wanted),
            resolution
        );
        return give(MOST_UNASKED as u64, why);
    }
    let why = format!(
        "Kn {} at the smallest opening ({} mm); {} would do for {noise}",
        significant(wanted),
        significant(1e3 * smallest),
        grouped(statistics.ceil() as u64)
    );
    give(resolution.ceil() as u64, why)
}

/// Openings found, then those declared that were not found under the same name.
pub fn openings<'a>(scene: &'a Scene, measured: &'a Measured) -> impl Iterator<Item = &'a crate::scene::Opening> {
    let declared = scene.openings.iter().filter(|own| measured.openings.iter().all(|found| found.name != own.name));
    measured.openings.iter().chain(declared)
}

pub struct Population {
    pub moles_per_particle: f64,
    /// By chamber, then gas.
    pub initial: Vec<Vec<u64>>,
    /// By gas.
    pub injected: Vec<u64>,
    /// What gas is less than half a particle, so that the run is without it.
    pub warnings: Vec<String>,
}

impl Population {
    /// Equal moles per particle for all; chamber counts by rounding, injected ones by the inflow itself.
    pub fn count(scene: &Scene, species: &[Species], amounts: &Amounts, wanted: u64) -> Result<Self, PlanError> {
        let limit = MOST_PARTICLES;
        if wanted > limit {
            return Err(PlanError::TooManyParticles { particles: wanted, limit });
        }
        let moles_per_particle = amounts.total() / wanted.max(1) as f64;
        let round = |moles: &f64| (moles / moles_per_particle).round() as u64;
        let initial: Vec<Vec<u64>> = amounts.initial.iter().map(|gases| gases.iter().map(round).collect()).collect();
        for (chamber, (moles, counts)) in scene.chambers.iter().zip(amounts.initial.iter().zip(&initial)) {
            let moles: f64 = moles.iter().sum();
            if moles > 0.0 && counts.iter().sum::<u64>() == 0 {
                let needed = (amounts.total() / moles).ceil() as u64;
                let chamber = chamber.name.clone();
                return Err(PlanError::EmptyChamber { chamber, moles, moles_per_particle, needed });
            }
        }
        let particles = InflowParticles { gases: species, moles_per_particle, seed: scene.seed, first_id: 0 };
        let inflow = Inflow::new(&scene.orifices, scene.end_time, particles);
        let warnings = unrepresented(scene, amounts, moles_per_particle, &initial, &inflow);
        let population = Self { moles_per_particle, initial, injected: inflow.total_by_gas(), warnings };
        let particles = population.initial_total() + population.injected_total();
        if particles > limit { Err(PlanError::TooManyParticles { particles, limit }) } else { Ok(population) }
    }

    pub fn initial_total(&self) -> u64 {
        self.initial.iter().flatten().sum()
    }

    pub fn injected_total(&self) -> u64 {
        self.injected.iter().sum()
    }

    pub fn of_gas(&self, gas: usize) -> u64 {
        self.injected[gas] + self.initial.iter().map(|chamber| chamber[gas]).sum::<u64>()
    }
}

/// "K times the particles", rounded up to two digits, where a run can have so many.
pub fn more_particles(times: f64, particles: f64) -> Option<String> {
    let digit = libm::pow(10.0, libm::log10(times).floor() - 1.0);
    let times = (times / digit - 1e-9).ceil() * digit;
    (times * particles <= MOST_PARTICLES as f64).then(|| format!("{} times the particles", significant(times)))
}

/// Gas of chambers and inflow that rounds to no particle.
fn unrepresented(
    scene: &Scene,
    amounts: &Amounts,
    moles_per_particle: f64,
    initial: &[Vec<u64>],
    inflow: &Inflow,
) -> Vec<String> {
    let wanted = amounts.total() / moles_per_particle;
    let none = |gas: usize, place: String, part: f64, enough: f64| {
        // A little more: an orifice's particle enters before the end.
        let remedy = match more_particles((enough + 0.001) / part, wanted) {
            Some(more) => format!("{more}, or leave it out"),
            None => "leave it out".to_string(),
        };
        let (gas, part) = (&scene.gases[gas].name, significant(part));
        let bound = if enough < 1.0 { "less than a half, so none of it is" } else { "and none of it is" };
        format!("gas `{gas}` of {place}: {part} of a particle, {bound} in the run; {remedy}")
    };
    let mut found = Vec::new();
    for (chamber, (moles, counts)) in scene.chambers.iter().zip(amounts.initial.iter().zip(initial)) {
        for (gas, (moles, count)) in moles.iter().zip(counts).enumerate() {
            if *moles > 0.0 && *count == 0 {
                found.push(none(gas, format!("chamber `{}`", chamber.name), moles / moles_per_particle, 0.5));
            }
        }
    }
    for Unrepresented { orifice, gas, part, enough } in inflow.without_particle() {
        if part > 0.0 {
            found.push(none(gas, format!("orifice `{}`", scene.orifices[orifice].name), part, enough));
        }
    }
    found
}

/// Orifices from which nothing flows in the run, by all methods.
pub fn silent_orifices(scene: &Scene) -> Vec<String> {
    let silent = scene.orifices.iter().filter(|orifice| !delivers(orifice, scene.end_time));
    let warning = |orifice: &Orifice| {
        format!(
            "orifice `{}`: its mass flow is 0 until the end of the run, at {} ms; an earlier flow, or a later `end_time`",
            orifice.name,
            significant(1e3 * scene.end_time)
        )
    };
    silent.map(warning).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::plan;
    use crate::plan::tests::tank;
    use crate::scene::{Mixture, ModelRequest};

    #[test]
    fn as_many_particles_are_named_as_do_and_as_can_be() {
        let named = |times: f64| more_particles(times, 1e4).unwrap();
        assert_eq!(named(1.627), "1.7 times the particles");
        assert_eq!(named(2.0), "2 times the particles");
        assert_eq!(named(1234.3), "1300 times the particles");
        assert!(more_particles(1.5e4, 1e4).is_none() && more_particles(1e4, 1e4).is_some());
    }

    /// Gas that rounds to no particle is warned of, by chamber and by orifice, with a number of particles that do; so is an
    /// orifice from which nothing flows, whose gas then is not the hottest.
    #[test]
    fn gas_that_no_particle_stands_for_is_told() {
        let told = |change: &dyn Fn(&mut Scene)| {
            let (mut scene, measured) = tank();
            change(&mut scene);
            let plan = plan(&scene, &measured).unwrap();
            let about: Vec<String> = plan
                .warnings
                .iter()
                .filter(|text| text.starts_with("gas `") || text.starts_with("orifice"))
                .cloned()
                .collect();
            (plan, about)
        };
        let trace = |scene: &mut Scene, particles: f64| {
            scene.chambers[1].mixture = Mixture(vec![(0, 1.0 - 1e-5), (1, 1e-5)]);
            scene.model.particles = Some(particles as u64);
        };
        let (plan, about) = told(&|scene| trace(scene, 1e5));
        assert!(plan.chambers[1].particles[1] == 0 && about.len() == 1, "{about:?}");
        let text = &about[0];
        assert!(text.contains("of chamber `tank`: 0.") && text.contains("less than a half"), "{text}");
        let times: f64 = text.split("; ").last().unwrap().split(' ').next().unwrap().parse().unwrap();
        let (plan, about) = told(&|scene| trace(scene, times * 1e5));
        assert!(plan.chambers[1].particles[1] == 1 && about.is_empty(), "{about:?}");
        let never = |scene: &mut Scene| {
            trace(scene, 1e5);
            scene.chambers[1].mixture = Mixture(vec![(0, 1.0 - 1e-12), (1, 1e-12)]);
        };
        assert!(told(&never).1[0].ends_with("; leave it out"));

        let (_, about) = told(&|scene| scene.orifices[0].mixture = Mixture(vec![(1, 1.0 - 1e-8), (0, 1e-8)]));
        assert!(about.len() == 1 && about[0].contains("of orifice `inflator`"), "{about:?}");

        let late = |scene: &mut Scene| {
            scene.orifices[0].mass_flow.points.iter_mut().for_each(|point| point[1] = 0.0);
            scene.orifices[0].temperature.points.iter_mut().for_each(|point| point[1] = 3000.0);
        };
        for method in [None, Some(Method::ControlVolume)] {
            let (plan, about) = told(&|scene| {
                late(scene);
                scene.model = ModelRequest { method, ..Default::default() };
            });
            assert!(about.len() == 1 && about[0].contains("its mass flow is 0 until the end"), "{about:?}");
            assert!(plan.temperature_max < 500.0, "{}", plan.temperature_max);
        }
        assert!(told(&|_| ()).1.is_empty());
    }

    /// The guard's at the occupancy of plans; less in cells that are longer beside the free path.
    #[test]
    fn cells_want_a_hole_of_a_smaller_knudsen_number() {
        assert_eq!(wanted_knudsen(Method::ClosestApproach, 0.3), WANTED_KNUDSEN);
        assert_eq!(wanted_knudsen(Method::Cell, 0.12), 0.03);
        let coarse = wanted_knudsen(Method::Cell, 0.3);
        let edge = libm::cbrt(6.0) / kinetics::mean_free_path_over_spacing(0.3);
        assert!(coarse < 0.025 && (coarse * kinetics::viscosity_of_cells(edge) / WANTED_KNUDSEN - 1.0).abs() < 1e-9);
    }
}
