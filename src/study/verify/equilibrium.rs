//! Energy among the degrees of freedom: that it comes to one temperature, how fast, and that none is lost.

use crate::gpu::Device;
use crate::simulation::Options;
use crate::study::StudyError;
use crate::subdomain::GpuParticle;

use super::gas_box::{EquilibriumBox, NITROGEN};
use super::statistics::mean_of_series;
use super::{Check, Effort, Findings, Run, run};

pub const HELIUM: &str = "[[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.6667\n";

/// Kinetic energy times 2/3 and spin energy times 2/zeta (zeta = 2) per particle of a gas, over the reference
/// mass; `mass` is that of the gas over the heaviest.
pub fn temperatures(particles: &[GpuParticle], gas: u8, mass: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    let mut count = 0.0;
    for particle in particles.iter().filter(|particle| particle.gas() == gas) {
        sums[0] += mass / 3.0 * particle.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>();
        sums[1] += f64::from(particle.spin);
        count += 1.0;
    }
    sums.map(|sum| sum / count)
}

/// Masses 1:7, half each, from a start with the light gas 9 times as hot as the heavy one and no spin.
///
/// # Errors
/// If the run fails.
pub fn mixture(device: &Device, method: &str, rounds: u32, step_over_tau: f64, steps: u32) -> Result<Run, StudyError> {
    let gas = EquilibriumBox {
        method,
        particles: 4000,
        rounds,
        step_over_tau,
        steps,
        molar_mass: 0.016,
        gases: "[[gas]]\nname = \"light\"\nmolar_mass = 0.004\ngamma = 1.4\n\
                [[gas]]\nname = \"heavy\"\nmolar_mass = 0.028\ngamma = 1.4\n",
        mixture: "{ light = 0.5, heavy = 0.5 }",
        snapshots: steps / 16,
        ..EquilibriumBox::default()
    };
    let mut model = gas.model()?;
    model.plan.steps_per_interval = 16;
    model.plan.collision_limit = model.plan.collision_limit.max(1.0);
    let unequal = |particles: &mut [GpuParticle]| {
        for particle in particles {
            let factor = if particle.gas() == 0 { 1.5 } else { 0.5 };
            particle.velocity = particle.velocity.map(|v| factor * v);
            particle.spin = 0.0;
        }
    };
    run(device, &model, Options { shuffle: Some(&unequal), ..Options::default() })
}

/// Mean and standard error of T_int/T_tr of all, and of T1/T2, after the first quarter of such a run.
pub fn ratios(run: &Run) -> [(f64, f64); 2] {
    let late = &run.snapshots[run.snapshots.len() / 4..];
    let states: Vec<[[f64; 2]; 2]> = late
        .iter()
        .map(|(_, particles)| [temperatures(particles, 0, 1.0 / 7.0), temperatures(particles, 1, 1.0)])
        .collect();
    let spin: Vec<f64> = states.iter().map(|[light, heavy]| (light[1] + heavy[1]) / (light[0] + heavy[0])).collect();
    let gases: Vec<f64> = states.iter().map(|[light, heavy]| light[0] / heavy[0]).collect();
    [mean_of_series(&spin, 12), mean_of_series(&gases, 12)]
}

pub(super) fn one_temperature(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let times = if effort == Effort::Quick { 1 } else { 2 };
    let mut checks = Vec::new();
    for (method, step_over_tau, steps) in
        [("closest-approach", 0.1, 5600), ("cell", 0.5, 3200), ("half-turn", 0.6, 3200)]
    {
        let [spin, gases] = ratios(&mixture(device, method, 3, step_over_tau, times * steps)?);
        checks.push(Check::of(format!("{method}: T_int/T_tr"), 1.0, spin, 0.01));
        checks.push(Check::of(format!("{method}: T1/T2, masses 1:7"), 1.0, gases, 0.01));
    }
    let steps = if effort == Effort::Quick { 3200 } else { 12_800 };
    checks.extend(three_gases(device, "half-turn", 0.6, steps)?);
    Ok(checks.into())
}

/// Particles without spin, with two degrees of freedom of it and with five; molar masses 1:7:36.
const THREE_GASES: &str = "[[gas]]\nname = \"a\"\nmolar_mass = 0.004\ngamma = 1.6666667\n\
                           [[gas]]\nname = \"b\"\nmolar_mass = 0.028\ngamma = 1.4\n\
                           [[gas]]\nname = \"c\"\nmolar_mass = 0.146\ngamma = 1.25\n";

/// From a start with the light gas hot, the heavy one cold and no spin: after the first quarter of the run each gas has the temperature of
/// all, of both kinds, and the second moment of a spin of two degrees of freedom is that of an exponential distribution.
///
/// # Errors
/// If the run fails.
pub fn three_gases(device: &Device, method: &str, step_over_tau: f64, steps: u32) -> Result<Vec<Check>, StudyError> {
    let gas = EquilibriumBox {
        method,
        particles: 6000,
        step_over_tau,
        steps,
        molar_mass: 0.0593,
        gases: THREE_GASES,
        mixture: "{ a = 0.3333, b = 0.3333, c = 0.3334 }",
        snapshots: steps / 16,
        ..EquilibriumBox::default()
    };
    let mut model = gas.model()?;
    // The light gas is faster than the mean.
    model.plan.collision_limit = f64::INFINITY;
    let unequal = |particles: &mut [GpuParticle]| {
        for particle in particles {
            let factor = [1.4, 1.0, 0.6][usize::from(particle.gas())];
            particle.velocity = particle.velocity.map(|v| factor * v);
            particle.spin = 0.0;
        }
    };
    let run = run(device, &model, Options { shuffle: Some(&unequal), ..Options::default() })?;
    let late = &run.snapshots[run.snapshots.len() / 4..];
    let [light, heavy] = [4.0 / 146.0, 28.0 / 146.0];
    let series = |of: &dyn Fn([[f64; 2]; 3]) -> f64| {
        let states = late
            .iter()
            .map(|(_, all)| [temperatures(all, 0, light), temperatures(all, 1, heavy), temperatures(all, 2, 1.0)]);
        mean_of_series(&states.map(of).collect::<Vec<_>>(), 12)
    };
    // Of all degrees of freedom.
    let mean = |[a, b, c]: [[f64; 2]; 3]| (3.0 * (a[0] + b[0] + c[0]) + 2.0 * (b[1] + c[1])) / 16.0;
    let seconds: Vec<f64> = late.iter().map(|(_, particles)| second_moment(particles, 1)).collect();
    let check = |what: &str, found| Check::of(format!("{method}: {what}, masses 1:7:36"), 1.0, found, 0.01);
    Ok(vec![
        check("T_tr over T, no spin", series(&|state| state[0][0] / mean(state))),
        check("T_tr over T, zeta = 2", series(&|state| state[1][0] / mean(state))),
        check("T_tr over T, zeta = 5", series(&|state| state[2][0] / mean(state))),
        check("T_int over T, zeta = 2", series(&|state| state[1][1] / mean(state))),
        check("T_int over T, zeta = 5", series(&|state| 0.4 * state[2][1] / mean(state))),
        check("<e^2>/(2 <e>^2) of spin, zeta = 2", mean_of_series(&seconds, 12)),
    ])
}

/// Of the spin of a gas over twice the square of its mean: 1 where it has two degrees of freedom.
fn second_moment(particles: &[GpuParticle], gas: u8) -> f64 {
    let spins = || particles.iter().filter(|particle| particle.gas() == gas).map(|particle| f64::from(particle.spin));
    let count = spins().count() as f64;
    0.5 * spins().map(|e| e * e).sum::<f64>() * count / spins().sum::<f64>().powi(2)
}

/// A gas whose translation and spin come to have one temperature.
#[derive(Debug, Clone, Copy)]
pub struct Relaxation {
    pub method: &'static str,
    /// Internal degrees of freedom.
    pub zeta: f64,
    /// The collision number that the scene asks for.
    pub asked: f64,
    pub occupancy: f64,
    pub step_over_tau: f64,
}

/// Z of a gas from a run that starts without spin and stops when
/// about 1 - exp(-.83) of the difference of the temperatures is gone, and its standard error.
///
/// The start has D = T_tr - T_int without noise. At a = (1 + zeta/3) s / Z exchange at the temperature T gives D an error of
/// sqrt(2 (1/3 + 1/zeta) / N) sqrt(1 - exp(-2a)) T. The first exchanges are among pairs as hot as the start, where T is (3 + zeta)/3
/// of that at the end: with the start's the error is certainly not more, relative to D = T exp(-a) and to a = .83
/// 2.5 sqrt(2 (1/3 + 1/zeta) / N).
///
/// # Errors
/// If the run fails.
pub fn collision_number(device: &Device, of: Relaxation) -> Result<(f64, f64), StudyError> {
    let Relaxation { method, zeta, asked, occupancy, step_over_tau } = of;
    let particles = 110_000u64;
    let gamma = (5.0 + zeta) / (3.0 + zeta);
    let gases = format!("[[gas]]\nname = \"gas\"\nmolar_mass = 0.028\ngamma = {gamma}\n");
    let rate = 1.0 + zeta / 3.0;
    let steps = (5.0 / 6.0 * asked / rate / step_over_tau).round() as u32;
    let gas = EquilibriumBox {
        method,
        particles,
        occupancy,
        step_over_tau,
        steps,
        collision_number: asked,
        gases: &gases,
        mixture: "\"gas\"",
        ..EquilibriumBox::default()
    };
    let mut model = gas.model()?;
    model.plan.collision_limit = model.plan.collision_limit.max(1.0);
    let without_spin = |particles: &mut [GpuParticle]| particles.iter_mut().for_each(|particle| particle.spin = 0.0);
    let run = run(device, &model, Options { shuffle: Some(&without_spin), ..Options::default() })?;
    let [translation, energy] = temperatures(&run.outcome.particles, 0, 1.0);
    // The second is that of two degrees of freedom.
    let spin = 2.0 / zeta * energy;
    // All energy was in translation: 3/2 T0 = 3/2 T_tr + zeta/2 T_int.
    let start = translation + zeta / 3.0 * spin;
    let per_particle = 2.0 * run.outcome.collisions as f64 / particles as f64;
    let decay = (start / (translation - spin)).ln();
    let noise = (2.0 * (1.0 / 3.0 + 1.0 / zeta) / particles as f64).sqrt();
    Ok((rate * per_particle / decay, 2.5 * noise * asked))
}

/// The law is that of molecular chaos: of closest approach in a thin gas, of cells in any.
pub(super) fn relaxation(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let thin =
        |zeta, asked| Relaxation { method: "closest-approach", zeta, asked, occupancy: 0.003, step_over_tau: 0.05 };
    let cells = |zeta| Relaxation { method: "cell", zeta, asked: 5.0, occupancy: 0.1, step_over_tau: 0.25 };
    let ways = [thin(2.0, 2.0), cells(2.0), thin(2.0, 5.0), thin(5.0, 5.0), cells(5.0)];
    let count = if effort == Effort::Quick { 2 } else { ways.len() };
    let check = |&way: &Relaxation| {
        let Relaxation { method, zeta, asked, .. } = way;
        let found = collision_number(device, way)?;
        Ok(Check::of(format!("{method}: Z, asked {asked}, zeta = {zeta}"), asked, found, 0.05 * asked))
    };
    ways[..count].iter().map(check).collect()
}

/// What of a gas or a mixture at rest is looked at for long.
#[derive(Debug, Clone, Copy)]
pub struct RestingGas {
    pub name: &'static str,
    /// `[[gas]]` tables.
    pub gases: &'static str,
    /// Gas or mixture, in TOML.
    pub mixture: &'static str,
    /// Mean molar mass, kg/mol.
    pub molar_mass: f64,
}

pub const RESTING_NITROGEN: RestingGas =
    RestingGas { name: "nitrogen", gases: NITROGEN, mixture: "\"nitrogen\"", molar_mass: 0.028 };

pub const RESTING_HELIUM: RestingGas =
    RestingGas { name: "helium", gases: HELIUM, mixture: "\"helium\"", molar_mass: 0.004 };

/// Three without spin, and one where a part has it. No share of two masses is a number of few bits, so that its rounding would show.
pub const RESTING_MIXTURES: [RestingGas; 4] = [
    RestingGas {
        name: "masses 1:10",
        gases: "[[gas]]\nname = \"a\"\nmolar_mass = 0.004\ngamma = 1.6666667\n\
                [[gas]]\nname = \"b\"\nmolar_mass = 0.04\ngamma = 1.6666667\n",
        mixture: "{ a = 0.5, b = 0.5 }",
        molar_mass: 0.022,
    },
    RestingGas {
        name: "masses 1:36",
        gases: "[[gas]]\nname = \"a\"\nmolar_mass = 0.004\ngamma = 1.6666667\n\
                [[gas]]\nname = \"b\"\nmolar_mass = 0.146\ngamma = 1.6666667\n",
        mixture: "{ a = 0.5, b = 0.5 }",
        molar_mass: 0.075,
    },
    RestingGas {
        name: "masses 1:5:33",
        gases: "[[gas]]\nname = \"a\"\nmolar_mass = 0.004\ngamma = 1.6666667\n\
                [[gas]]\nname = \"b\"\nmolar_mass = 0.0202\ngamma = 1.6666667\n\
                [[gas]]\nname = \"c\"\nmolar_mass = 0.1313\ngamma = 1.6666667\n",
        mixture: "{ a = 0.4, b = 0.3, c = 0.3 }",
        molar_mass: 0.047,
    },
    RestingGas {
        name: "He, N2 and Ar",
        gases: "[[gas]]\nname = \"a\"\nmolar_mass = 0.004\ngamma = 1.6666667\n\
                [[gas]]\nname = \"b\"\nmolar_mass = 0.028\ngamma = 1.4\n\
                [[gas]]\nname = \"c\"\nmolar_mass = 0.04\ngamma = 1.6666667\n",
        mixture: "{ a = 0.4, b = 0.1, c = 0.5 }",
        molar_mass: 0.0244,
    },
];

/// How an energy drifted.
#[derive(Debug, Clone, Copy)]
pub struct Drift {
    /// Relative change of the energy.
    pub error: f64,
    pub collisions_per_particle: f64,
    pub steps: u64,
}

/// What rounding takes from a pair goes into spin; where neither has spin, into the scale of its relative velocity. The
/// energies are known to 3e-8 of a thermal energy each (scales of the tallies), so their sum over N far better than any limit
/// here.
///
/// # Errors
/// If the run fails.
pub fn energy_drift(
    device: &Device,
    method: &str,
    resting: &RestingGas,
    particles: u64,
    steps: u32,
) -> Result<Drift, StudyError> {
    let gas = EquilibriumBox {
        method,
        particles,
        steps,
        // Half-turn has steps of .6 spacings, the others of .15 collision times.
        step_over_tau: if method == "half-turn" { 0.6 } else { 0.15 },
        gases: resting.gases,
        mixture: resting.mixture,
        molar_mass: resting.molar_mass,
        ..EquilibriumBox::default()
    };
    let mut model = gas.model()?;
    // Noise of few particles in a block must not shorten the steps.
    model.plan.collision_limit = model.plan.collision_limit.max(1.0);
    let run = run(device, &model, Options::default())?;
    Ok(Drift {
        error: run.outcome.audit.energy_error(),
        collisions_per_particle: 2.0 * run.outcome.collisions as f64 / particles as f64,
        steps: run.outcome.steps,
    })
}

/// Steps, particles and tolerance: rounding is a random walk of some 1.5e-7 of a particle's mean energy for each collision,
/// which with so many particles comes to a quarter of the tolerance.
const QUICK_DRIFT: (u32, u64, f64) = (2000, 2000, 2e-7);
const FULL_DRIFT: (u32, u64, f64) = (100_000, 500, 2e-6);

/// Of half-turn the rounding is that of one number for each collision cell of some 14 particles and step, some 5e-7 kT: over S steps of N particles
/// without spin a walk of 5e-7 sqrt(S/(14 N))/1.5 of the energy. So many times as many particles make it a fourth of the tolerance.
const MORE_OF_HALF_TURN: [u64; 2] = [4, 8];

/// Within 2e-7 in 2,000 steps, and in 1e5 steps within 2e-6, a fifth of what is allowed.
pub(super) fn conservation(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (steps, particles, tolerance) = if effort == Effort::Quick { QUICK_DRIFT } else { FULL_DRIFT };
    let [without_spin @ .., with_spin] = &RESTING_MIXTURES;
    let mut ways = vec![
        ("closest-approach", &RESTING_NITROGEN),
        ("closest-approach", &RESTING_HELIUM),
        ("cell", &RESTING_HELIUM),
        ("half-turn", &RESTING_NITROGEN),
        ("half-turn", &RESTING_HELIUM),
        ("half-turn", with_spin),
        ("closest-approach", with_spin),
    ];
    for method in ["closest-approach", "hard-sphere", "cell", "half-turn"] {
        ways.extend(without_spin.iter().map(|mixture| (method, mixture)));
    }
    let check = |(method, resting): (&str, &RestingGas)| {
        let more = if method == "half-turn" { MORE_OF_HALF_TURN[usize::from(effort == Effort::Full)] } else { 1 };
        let drift = energy_drift(device, method, resting, more * particles, steps)?;
        let quantity = format!("{method}: {}, {steps} steps", resting.name);
        Ok(Check::of(quantity, 0.0, (drift.error, 0.0), tolerance))
    };
    ways.into_iter().map(check).collect()
}
