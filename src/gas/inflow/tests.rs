use super::*;
use std::sync::LazyLock;

use crate::gas::{Modes, fit};
use crate::scene::{Curve, Jet, JetSpeed, Mixture};

/// Like nitrogen, helium and carbon dioxide, the last with a heat capacity that grows.
fn gases() -> Vec<Species> {
    let gas = |molar_mass, spin: f64| Species::constant(molar_mass, 0.5 * (3.0 + spin) * GAS_CONSTANT);
    static CURVE: LazyLock<Modes> = LazyLock::new(|| fit([23.0, 5.6e-2, -2.2e-5], [400.0, 1200.0]).unwrap());
    vec![gas(0.028, 2.0), gas(0.004, 0.0), Species::with_modes(0.044, CURVE.clone())]
}

fn orifice(mixture: Vec<(usize, f64)>, jet: Option<Jet>) -> Orifice {
    Orifice {
        name: "inflator".into(),
        position: [0.1, 0.2, 0.3],
        direction: [0.6, 0.0, 0.8],
        area: 1e-4,
        mass_flow: Curve { points: vec![[0.0, 0.0], [0.01, 2.0], [0.03, 0.5], [0.06, 0.0]] },
        temperature: Curve { points: vec![[0.0, 900.0], [0.05, 500.0]] },
        mixture: Mixture(mixture),
        jet,
    }
}

const NU: f64 = 1e-4;

fn inflow_until(orifices: &[Orifice], end: f64, moles_per_particle: f64, [seed, first_id]: [u32; 2]) -> Inflow {
    let gases = &gases();
    Inflow::new(orifices, end, InflowParticles { gases, moles_per_particle, seed: seed.into(), first_id })
}

fn inflow(orifices: &[Orifice]) -> Inflow {
    inflow_until(orifices, 0.1, NU, [11, 100])
}

fn energy(newborn: &Newborn) -> f64 {
    let mass = gases()[usize::from(newborn.particle.gas)].molar_mass * NU;
    0.5 * mass * newborn.particle.velocity.iter().map(|v| v * v).sum::<f64>() + newborn.particle.spin_energy
}

fn enthalpy(newborn: &Newborn) -> f64 {
    let temperature = value_held(&orifice(vec![], None).temperature, newborn.time);
    gases()[usize::from(newborn.particle.gas)].enthalpy(NU, temperature)
}

/// Mass: within half a particle per gas of the curves' integral at every moment, and within one of each orifice's own; what
/// has not begun to flow lets nobody in.
#[test]
fn mass_is_within_half_a_particle() {
    let later = |start: f64, flow: f64| {
        let mass_flow = Curve { points: vec![[start, flow], [start + 0.02, 0.3 * flow]] };
        Orifice { mass_flow, ..orifice(vec![(0, 0.5), (1, 0.5)], None) }
    };
    let orifices =
        [orifice(vec![(0, 0.7), (1, 0.3)], None), orifice(vec![(0, 1.0)], None), later(0.02, 0.1), later(0.031, 0.007)];
    let mut whole = inflow(&orifices);
    assert_eq!(whole.total(), whole.total_by_gas().iter().sum::<u64>());
    let delivered = |end: f64| -> Vec<f64> {
        let of = |orifice: &Orifice| {
            let kg = FlowIntegral::new(&orifice.mass_flow, end).total();
            let moles = kg / thermo::molar_mass(&orifice.mixture, &gases());
            orifice.mixture.0.iter().map(|(_, fraction)| fraction * moles / NU).collect::<Vec<_>>()
        };
        orifices.iter().flat_map(of).collect()
    };
    let off = |counts: &[u64], end: f64| {
        let delivered = delivered(end);
        let nitrogen = delivered[0] + delivered[2] + delivered[3] + delivered[5];
        (counts[0] as f64 - nitrogen).abs().max((counts[1] as f64 - delivered[1] - delivered[4] - delivered[6]).abs())
    };
    let mut worst = 0.0f64;
    for step in 1..=1000 {
        let end = f64::from(step) * 1e-4;
        whole.take_until(end);
        assert!(off(&whole.entered_by_gas(), end) <= 0.5 + 1e-6);
        for (taken, delivered) in whole.state().taken.iter().zip(delivered(end)) {
            assert!((*taken as f64 - delivered).abs() < 1.0 + 1e-6, "{taken} {delivered} at {end}");
            assert!(delivered > 0.0 || *taken == 0);
            worst = worst.max((*taken as f64 - delivered).abs());
        }
    }
    assert!(worst > 0.6, "orifices take turns: {worst}");
    assert_eq!(whole.entered_by_gas(), whole.total_by_gas());
    // The check can fail: one particle less is outside.
    let mut counts = whole.entered_by_gas();
    counts[1] -= 1;
    assert!(off(&counts, 0.1) > 0.5);
    // Nothing enters after the end of the run.
    let short = inflow_until(&orifices, 0.01, NU, [11, 0]);
    assert!(short.total() < whole.total() / 2);
}

/// Many orifices alike, each of which brings .69 of a particle, together bring their sum, in turn; those
/// that bring none are told.
#[test]
fn orifices_alike_take_turns() {
    let small = orifice(vec![(0, 1.0)], None);
    let each = FlowIntegral::new(&small.mass_flow, 0.1).total() / 0.028;
    let orifices = vec![small; 24];
    let mut inflow = inflow_until(&orifices, 0.1, each / 0.69, [11, 0]);
    assert_eq!(inflow.total(), 17, "24 times .69 is 16.56");
    let without = inflow.without_particle();
    let newborns = inflow.take_until(0.1);
    assert_eq!(newborns.len(), 17);
    assert!(inflow.state().taken.iter().all(|&taken| taken <= 1));
    let expected: Vec<usize> = (0..24).filter(|&orifice| inflow.state().taken[orifice] == 0).collect();
    assert_eq!(without.iter().map(|none| none.orifice).collect::<Vec<_>>(), expected);
    assert!(without.iter().all(|none| (none.part - 0.69).abs() < 1e-9 && none.enough == 1.0));
    assert!(inflow.debt().abs() < 1e-9 * inflow.enthalpy(), "each settles its debt");
}

/// Energy: exactly the enthalpy at the temperatures of entry, for spin, for speed, for mixtures and jets.
#[test]
fn energy_is_the_enthalpy_injected() {
    let jet = |mach| Some(Jet { speed: JetSpeed::Mach(mach), cone_angle: 0.3 });
    for orifices in [
        vec![orifice(vec![(0, 1.0)], None)],
        vec![orifice(vec![(1, 1.0)], None)],
        vec![orifice(vec![(0, 0.5), (1, 0.2), (2, 0.3)], None), orifice(vec![(2, 1.0)], jet(0.0))],
        vec![orifice(vec![(0, 1.0)], jet(2.5)), orifice(vec![(1, 1.0)], jet(1.0))],
        vec![orifice(vec![(0, 1.0)], Some(Jet { speed: JetSpeed::Velocity(600.0), cone_angle: 0.3 }))],
    ] {
        let mut inflow = inflow(&orifices);
        // Halfway the debt accounts for the difference.
        let mut newborns = inflow.take_until(0.02);
        let sums = |newborns: &[Newborn]| {
            let (e, h) = (newborns.iter().map(energy).sum::<f64>(), newborns.iter().map(enthalpy).sum::<f64>());
            assert!(newborns.len() > 1000);
            (e, h)
        };
        let (e, h) = sums(&newborns);
        assert!(((e + inflow.debt()) / h - 1.0).abs() < 1e-12);
        assert!((inflow.enthalpy() / h - 1.0).abs() < 1e-12);
        assert!((inflow.debt() / h).abs() < 0.01);
        assert!(inflow.debt() != 0.0, "the check must see a debt");
        newborns.extend(inflow.take_until(0.1));
        let (e, h) = sums(&newborns);
        assert!(((e + inflow.debt()) / h - 1.0).abs() < 1e-12);
        assert!((e / h - 1.0).abs() < 1e-9, "{}", e / h - 1.0);
        assert!(newborns.iter().all(|newborn| newborn.particle.spin_energy >= 0.0));
    }
}

/// The same newborns, bit for bit, however the time is cut; ids dense, times in order.
#[test]
fn chunks_do_not_matter() {
    let orifices = [orifice(vec![(0, 0.7), (1, 0.3)], None), orifice(vec![(0, 1.0)], None)];
    let mut once = inflow(&orifices);
    let whole = once.take_until(0.1);
    assert_eq!(whole.len() as u64, once.total());
    assert!(whole.iter().zip(100..).all(|(newborn, id)| newborn.particle.id == id));
    assert!(whole.windows(2).all(|pair| pair[0].time <= pair[1].time));
    let mut cut = inflow(&orifices);
    let mut parts = Vec::new();
    let mut end = 0.0;
    while end < 0.1 {
        end += 7.3e-5;
        parts.extend(cut.take_until(end));
        cut = cut.clone();
    }
    assert_eq!(parts, whole);
    assert_eq!(cut, once);
    // The check can fail: another seed gives other velocities.
    let other = inflow_until(&orifices, 0.1, NU, [12, 100]).take_until(0.1);
    assert_ne!(other, whole);
}

/// Normal speeds of the default inflow: <v> = sqrt(8 kT / pi m), <v^2> = 3 kT/m, at a constant temperature.
#[test]
fn default_speeds_are_maxwellian() {
    let mut source = orifice(vec![(0, 1.0)], None);
    source.temperature = Curve { points: vec![[0.0, 700.0]] };
    let newborns = inflow_until(&[source.clone()], 0.1, 2e-5, [1, 0]).take_until(0.1);
    let c0 = (GAS_CONSTANT * 700.0 / 0.028f64).sqrt();
    let count = newborns.len() as f64;
    assert!(count > 50_000.0);
    let along = |n: &Newborn| n.particle.velocity.iter().zip(source.direction).map(|(v, d)| v * d).sum::<f64>() / c0;
    let mean = newborns.iter().map(along).sum::<f64>() / count;
    let square = newborns.iter().map(|n| along(n).powi(2)).sum::<f64>() / count;
    let expected = (8.0 / std::f64::consts::PI).sqrt();
    let error = ((3.0 - expected * expected) / count).sqrt();
    assert!((mean - expected).abs() < 4.0 * error, "{mean}");
    assert!((square - 3.0).abs() < 4.0 * (6.0 / count).sqrt(), "{square}");
    assert!((mean - (std::f64::consts::PI / 2.0).sqrt()).abs() > 4.0 * error, "a flux Maxwellian must not pass");
    // Positions lie on the disc, uniformly: <r^2> = area / 2 pi.
    let r2 = |n: &Newborn| n.particle.position.iter().zip(source.position).map(|(p, o)| (p - o) * (p - o)).sum::<f64>();
    let mean_r2 = newborns.iter().map(r2).sum::<f64>() / count;
    assert!((mean_r2 / (1e-4 / (2.0 * std::f64::consts::PI)) - 1.0).abs() < 0.02);
    assert!(newborns.iter().all(|n| r2(n) <= 1e-4 / std::f64::consts::PI * (1.0 + 1e-9) && along(n) > 0.0));
}

/// A fast jet flies at its drift speed: <v_n> close to u cos, and static temperature below stagnation.
#[test]
fn jets_drift() {
    let jet = Jet { speed: JetSpeed::Mach(6.0), cone_angle: 1e-3 };
    let mut source = orifice(vec![(0, 1.0)], Some(jet));
    source.temperature = Curve { points: vec![[0.0, 700.0]] };
    let newborns = inflow(&[source.clone()]).take_until(0.1);
    let ts = 700.0 / (1.0 + 0.2 * 36.0);
    let c0 = (GAS_CONSTANT * ts / 0.028f64).sqrt();
    let u = 6.0 * 1.4f64.sqrt() * c0;
    let along = |n: &Newborn| n.particle.velocity.iter().zip(source.direction).map(|(v, d)| v * d).sum::<f64>();
    let mean = newborns.iter().map(along).sum::<f64>() / newborns.len() as f64;
    // Flux weighting adds c0^2 / u.
    let expected = u + c0 * c0 / u;
    let error = c0 / (newborns.len() as f64).sqrt();
    assert!((mean - expected).abs() < 4.0 * error, "{mean} {expected}");
    assert!((mean - u).abs() > 4.0 * error);
}

/// However often and wherever a run is cut, an inflow built anew and restored lets exactly the same particles in.
#[test]
fn a_restored_inflow_goes_on_to_the_bit() {
    let jet = Some(Jet { speed: JetSpeed::Mach(1.5), cone_angle: 0.4 });
    let orifices = [
        orifice(vec![(0, 0.7), (1, 0.3)], None),
        orifice(vec![(1, 1.0)], jet),
        orifice(vec![(0, 0.2), (1, 0.3), (2, 0.5)], jet),
    ];
    let whole = inflow(&orifices).take_until(1.0);
    let mut cuts = Draws::new(5, Purpose::Inflow, 0);
    for _ in 0..6 {
        let mut cut: Vec<f64> = (0..8).map(|_| 0.06 * cuts.uniform()).chain([0.0, 1.0]).collect();
        cut.sort_by(f64::total_cmp);
        let mut pieces = Vec::new();
        let mut current = inflow(&orifices);
        for end in cut {
            pieces.extend(current.take_until(end));
            let bytes = postcard::to_stdvec(&current.state()).unwrap();
            let mut restored = inflow(&orifices);
            restored.restore(&postcard::from_bytes(&bytes).unwrap()).unwrap();
            assert_eq!(restored, current);
            current = restored;
        }
        assert!(pieces == whole);
    }
    // The comparison can fail: a debt that is forgotten changes who comes.
    let mut cut = inflow(&orifices);
    let before = cut.take_until(0.02).len();
    let mut state = cut.state();
    state.debts.fill(0.0);
    cut.restore(&state).unwrap();
    assert!(cut.take_until(1.0) != whole[before..]);
}

/// A state of another scene is refused, and the inflow stays as it was.
#[test]
fn a_foreign_state_of_the_inflow_is_refused() {
    let orifices = [orifice(vec![(0, 1.0)], None), orifice(vec![(0, 0.5), (1, 0.5)], None)];
    let mut own = inflow(&orifices);
    own.take_until(0.02);
    let before = own.clone();
    let other = inflow(&orifices[..1]).state();
    let error = own.restore(&other).unwrap_err().to_string();
    assert_eq!(error, "the state has 1 flows of 1 orifices, the scene has 3 of 2");
    let mut many = own.state();
    many.taken[1] = u64::MAX;
    assert!(matches!(own.restore(&many), Err(InflowStateError::Taken { stream: 1, .. })));
    let mut broken = own.state();
    broken.debts[0] = f64::NAN;
    assert_eq!(own.restore(&broken), Err(InflowStateError::Energy));
    assert_eq!(own, before);
}

/// A jet of a velocity is the jet of its Mach number, whatever the heat capacities; no gas is faster than all its enthalpy
/// makes it.
#[test]
fn a_jet_of_a_velocity_is_that_of_its_mach_number() {
    for mixture in [vec![(0, 1.0)], vec![(0, 0.5), (1, 0.2), (2, 0.3)], vec![(2, 1.0)]].map(Mixture) {
        for mach in [0.2, 1.0, 6.0] {
            let [drift, temperature] = jet_state(JetSpeed::Mach(mach), 700.0, &mixture, &gases()).unwrap();
            let speed = JetSpeed::Velocity(drift);
            let [same, found] = jet_state(speed, 700.0, &mixture, &gases()).unwrap();
            assert!(same == drift && (found / temperature - 1.0).abs() < 1e-9, "{found} {temperature}");
            assert!((jet_mach(speed, 700.0, &mixture, &gases()) / mach - 1.0).abs() < 1e-9);
        }
        let enthalpy = thermo::molar_enthalpy(&mixture, &gases(), 700.0) / thermo::molar_mass(&mixture, &gases());
        let fastest = (2.0 * enthalpy).sqrt();
        assert_eq!(jet_state(JetSpeed::Velocity(1.001 * fastest), 700.0, &mixture, &gases()), None);
        assert_eq!(jet_mach(JetSpeed::Velocity(1.001 * fastest), 700.0, &mixture, &gases()), f64::INFINITY);
        assert!(jet_mach(JetSpeed::Velocity(0.999 * fastest), 700.0, &mixture, &gases()) > 20.0);
    }
}
