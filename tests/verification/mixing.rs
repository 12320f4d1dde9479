//! Laws of mixtures (specification, section 1: equal moles per particle): two gases that start apart come to equal shares
//! everywhere and to one temperature; of a mixture that flows in each gas brings its share of the curve's integral to
//! within half a particle, and a mixture at rest has its shares of the particles.

use corpuscle::simulation::Options;
use corpuscle::subdomain::GpuParticle;

use crate::statistics::mean_of_series;
use crate::whole_run::{model, run};

/// m.
const EDGE: f64 = 0.1;

/// Nitrogen at 300 K in one half of a cube, argon at 600 K in the other, at one pressure; no wall between.
const HALVES: &str = "end_time = 6e-3\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
     [[gas]]\nname = \"argon\"\nmolar_mass = 0.04\ngamma = 1.667\n\
     [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
     [[chamber]]\nname = \"left\"\nregion = { box = { min = [0.0, 0.0, 0.0], max = [0.05, 0.1, 0.1] } }\n\
     pressure = 1e5\ntemperature = 300.0\ngas = \"nitrogen\"\n\
     [[chamber]]\nname = \"right\"\npressure = 1e5\ntemperature = 600.0\ngas = \"argon\"\n\
     [model]\nparticles = 1500\n[output]\nrows = 10\nsnapshots = 200\n";

/// Of one gas: its share of particles in the left half, and 1/3 m c^2 per particle over the mass of a heaviest particle.
fn half_and_temperature(particles: &[GpuParticle], middle: u32, gas: u8, mass: f64) -> [f64; 2] {
    let own: Vec<&GpuParticle> = particles.iter().filter(|p| p.gas() == gas).collect();
    let left = own.iter().filter(|p| p.position[0] < middle).count();
    let square: f64 = own.iter().map(|p| p.velocity.iter().map(|v| f64::from(*v).powi(2)).sum::<f64>()).sum();
    [left as f64, mass / 3.0 * square].map(|sum| sum / own.len() as f64)
}

#[test]
fn two_gases_diffuse_into_each_other_and_come_to_one_temperature() {
    let model = model(HALVES);
    let run = run(&model, Options::default());
    let middle = model.plan.grid.to_fixed([EDGE / 2.0; 3]).unwrap()[0];
    let masses = [0.028 / 0.04, 1.0];
    let states: Vec<[[f64; 2]; 2]> = run
        .snapshots
        .iter()
        .map(|(_, particles)| [0, 1].map(|gas| half_and_temperature(particles, middle, gas, masses[usize::from(gas)])))
        .collect();
    assert_eq!([states[0][0][0], states[0][1][0]], [1.0, 0.0], "they start apart");
    assert!((states[0][1][1] / states[0][0][1] - 2.0).abs() < 1e-3);
    let late = &states[states.len() / 2..];
    let series = |f: &dyn Fn(&[[f64; 2]; 2]) -> f64| mean_of_series(&late.iter().map(f).collect::<Vec<_>>(), 8);
    let shares = [series(&|s| s[0][0]), series(&|s| s[1][0])];
    let ratio = series(&|s| s[0][1] / s[1][1]);
    println!("left: {shares:?}, T1/T2 {ratio:?}, {} steps", run.outcome.steps);
    for (share, error) in shares {
        assert!(error < 0.015 && (share - 0.5).abs() < 4.0 * error + 0.003, "{share} +- {error}");
    }
    assert!(ratio.1 < 0.01 && (ratio.0 - 1.0).abs() < 4.0 * ratio.1 + 0.003, "{ratio:?}");
    // The checks can fail: a third of the way they are still apart.
    assert!((states[states.len() / 30][0][0] - 0.5).abs() > 0.1);
    // The temperature is that of the energies: n1 cv1 (T - 300) = n2 cv2 (600 - T) with n1 = 2 n2, cv 5/2 and 3/2.
    let expected = (2.0 * 2.5 * 300.0 + 1.5 * 600.0) / (2.0 * 2.5 + 1.5);
    let kelvin = 0.04 / 8.314462618;
    let found = series(&|s| kelvin * s[0][1]);
    assert!((found.0 - expected).abs() < 4.0 * found.1 + 0.003 * expected, "{found:?} {expected}");
    assert!(run.outcome.audit.verdict(&corpuscle::output::AuditLimits::default()).is_empty());
}

#[test]
fn each_gas_of_an_inflow_brings_its_share_within_half_a_particle() {
    let text = "end_time = 1e-3\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[gas]]\nname = \"helium\"\nmolar_mass = 0.004\ngamma = 1.667\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = { nitrogen = 0.75, helium = 0.25 }\n\
         [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\narea = 0.002\n\
         gas = { helium = 0.4, nitrogen = 0.6 }\ntemperature = 500.0\nmass_flow = [[0.0, 0.0], [5e-4, 0.8], [1e-3, 0.1]]\n\
         [model]\nparticles = 1200\n[output]\nrows = 4\nsnapshots = 0\n";
    let model = model(text);
    let run = run(&model, Options::default());
    let count = |gas: u8, ids: std::ops::Range<u64>| {
        let own = |p: &&GpuParticle| p.gas() == gas && ids.contains(&u64::from(p.id()));
        run.outcome.particles.iter().filter(own).count() as f64
    };
    let first = model.plan.initial_particles;
    let nu = model.plan.moles_per_particle;
    // At rest: moles p V / R T, rounded.
    let at_rest = 1e5 * 1e-3 / (8.314462618 * 300.0);
    for (gas, share) in [(0, 0.75), (1, 0.25)] {
        assert!((count(gas, 0..first) - share * at_rest / nu).abs() <= 0.5);
    }
    // The curve: .5 .8 5e-4 + .5 (.8 + .1) 5e-4 kg, of .6 x .028 + .4 x .004 kg/mol.
    let moles = (0.5 * 0.8 + 0.5 * 0.9) * 5e-4 / (0.6 * 0.028 + 0.4 * 0.004);
    for (gas, share) in [(0, 0.6), (1, 0.4)] {
        let entered = count(gas, first..u64::MAX);
        assert!((entered - share * moles / nu).abs() <= 0.5, "{entered} of {}", share * moles / nu);
        // The check can fail: fractions by mass would be others.
        assert!((entered - [0.9, 0.1][usize::from(gas)] * moles / nu).abs() > 10.0);
    }
}
