//! Laws of mixtures (method.md, "The gas": equal moles per particle): two gases that start apart come to equal shares
//! everywhere and to one temperature; of a mixture that flows in each gas brings its share of the curve's integral to
//! within half a particle, and a mixture at rest has its shares of the particles.

use corpuscle::output::AuditLimits;
use corpuscle::simulation::Options;
use corpuscle::study::verify::mixing::{Moment, common_temperature, late, mixed};
use corpuscle::study::verify::statistics::mean_and_error;
use corpuscle::subdomain::GpuParticle;

use crate::whole_run::{device, model, run};

#[test]
fn two_gases_diffuse_into_each_other_and_come_to_one_temperature() {
    let device = device();
    let (moments, run) = mixed(&device, 1500).expect("a run");
    assert_eq!(moments[0].left, [1.0, 0.0], "they start apart");
    assert!((moments[0].temperature[1] / moments[0].temperature[0] - 2.0).abs() < 1e-3);
    let shares_of = |moments: &[Moment]| [0, 1].map(|gas| late(moments, |m| m.left[gas]).0);
    // Diffusion through the box is slower than the stretches of a run, so the error is that of runs with other numbers.
    let others = [1502, 1504, 1506, 1508, 1510].map(|n| shares_of(&mixed(&device, n).expect("a run").0));
    let samples: Vec<[f64; 2]> = [shares_of(&moments)].into_iter().chain(others).collect();
    let shares = [0, 1].map(|gas| mean_and_error(&samples.iter().map(|shares| shares[gas]).collect::<Vec<_>>()));
    let ratio = late(&moments, |m| m.temperature[0] / m.temperature[1]);
    println!("left: {shares:?}, T1/T2 {ratio:?}, {} steps", run.outcome.steps);
    for (share, error) in shares {
        assert!(error < 0.015 && (share - 0.5).abs() < 4.5 * error, "{share} +- {error}");
    }
    assert!(ratio.1 < 0.01 && (ratio.0 - 1.0).abs() < 4.5 * ratio.1, "{ratio:?}");
    // The checks can fail: a thirtieth of the way they are still apart.
    assert!((moments[moments.len() / 30].left[0] - 0.5).abs() > 0.1);
    let (found, error) = late(&moments, |m| m.temperature[1]);
    assert!((found - common_temperature()).abs() < 4.5 * error, "{found} +- {error}, {}", common_temperature());
    assert!(run.outcome.audit.verdict(&AuditLimits::default()).is_empty());
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

/// A light gas that a far hotter wall heats is tallied to the end; the range of its energies that goes by the mean of the end alone was too
/// small for it.
#[test]
fn a_light_gas_beside_a_hot_wall_is_tallied() {
    let text = "end_time = 1e-4\n[[gas]]\nname = \"nitrogen\"\nmolar_mass = 0.028\ngamma = 1.4\n\
         [[gas]]\nname = \"hydrogen\"\nmolar_mass = 0.002\ngamma = 1.4\n\
         [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
         temperature = 900.0\n\
         [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 200.0\ngas = { nitrogen = 0.5, hydrogen = 0.5 }\n\
         [model]\nmethod = \"closest-approach\"\nparticles = 2000\n[output]\nrows = 1\nsnapshots = 0\n";
    let model = model(text);
    let run = run(&model, Options::default());
    assert!(run.outcome.audit.verdict(&AuditLimits::default()).is_empty());
    // That room: twice 256 v0^2 (the gases are 14 times apart) at the mean of 200 K. With it this run ended at .094 ms.
    let room = 2.0 * 256.0 * 8.314 * 200.0 / 0.028;
    let fastest = run.outcome.particles.iter().map(|p| 0.5 * p.velocity.map(|v| f64::from(v * v)).iter().sum::<f64>());
    let fastest = fastest.fold(0.0, f64::max);
    println!("{:.2} of the room that there was", fastest / room);
    assert!(fastest > 0.6 * room, "the check can fail: at the end, too, some come near it");
}
