use super::*;
use crate::output::{ParticleRow, SnapshotWriter};
use crate::scene::GAS_CONSTANT;

/// Numbers between 0 and 1 without an order.
fn scattered(id: u32) -> f64 {
    (f64::from(id) * 0.618_033_988_749_894_9).fract()
}

/// Of nitrogen at 300 K on the left and 900 K on the right, all of it drifting at 100 m/s along y.
fn gas(count: u32) -> Vec<ParticleRow> {
    let normal = |k: u32| {
        let radius = (-2.0 * (1.0 - scattered(k)).ln()).sqrt();
        radius * (std::f64::consts::TAU * scattered(k.wrapping_mul(7919) + 13)).cos()
    };
    (0..count)
        .map(|id| {
            let x = scattered(id);
            let kelvin = if x < 0.5 { 300.0 } else { 900.0 };
            let width = (GAS_CONSTANT * kelvin / 0.028).sqrt();
            let velocity = [0u32, 1, 2].map(|axis| (width * normal(3 * id + axis)) as f32);
            let velocity = [velocity[0], velocity[1] + 100.0, velocity[2]];
            let position = [x, scattered(id.wrapping_mul(31) + 5), scattered(id.wrapping_mul(57) + 11)];
            ParticleRow { id, gas: 0, position, velocity, spin_energy: 0.0 }
        })
        .collect()
}

#[test]
fn the_temperature_is_that_of_the_gas_around_and_not_of_its_drift() {
    let dir = tempfile::tempdir().unwrap();
    SnapshotWriter::create(dir.path()).unwrap().naming(["nitrogen".to_owned()]).write(0.0, &gas(20_000)).unwrap();
    let cloud = Cloud::read(dir.path(), &[0.028]).unwrap();
    let frame = &cloud.frames[0];
    assert_eq!((frame.count, frame.position.len(), cloud.share), (20_000, 20_000, 1.0));
    let mean = |right: bool| {
        let near = frame.position.iter().zip(&frame.temperature);
        // Blocks on the border have both.
        let own: Vec<f32> = near
            .filter(|(point, _)| if right { point[0] > 0.6 } else { point[0] < 0.4 })
            .map(|(_, kelvin)| *kelvin)
            .collect();
        own.iter().sum::<f32>() / own.len() as f32
    };
    assert!((mean(false) / 300.0 - 1.0).abs() < 0.05, "{}", mean(false));
    assert!((mean(true) / 900.0 - 1.0).abs() < 0.05, "{}", mean(true));
}

/// The same particles in every snapshot, about as many as asked for, whatever the order of their ids.
#[test]
fn a_sample_follows_its_particles() {
    let share = 0.1;
    let shown: Vec<u32> = (0..100_000).filter(|id| is_shown(*id, share)).collect();
    assert!((9_500..10_500).contains(&shown.len()), "{}", shown.len());
    let early = shown.iter().filter(|id| **id < 10_000).count();
    assert!((850..1150).contains(&early), "{early}");
    assert!((0..1000).all(|id| is_shown(id, 1.0)) && !(0..1000).any(|id| is_shown(id, 0.0)));
}

#[test]
fn many_snapshots_are_thinned_and_broken_ones_left_out() {
    let dir = tempfile::tempdir().unwrap();
    let mut writer = SnapshotWriter::create(dir.path()).unwrap();
    for k in 0..150 {
        writer.write(f64::from(k), &gas(3)).unwrap();
    }
    let cloud = Cloud::read(dir.path(), &[0.028]).unwrap();
    assert_eq!((cloud.snapshots, cloud.frames.len()), (150, MOST_FRAMES));
    assert_eq!((cloud.frames[0].time, cloud.frames[MOST_FRAMES - 1].time), (0.0, 149.0));
    std::fs::write(dir.path().join("snapshots/particles_000000.vtu"), "cut").unwrap();
    let cloud = Cloud::read(dir.path(), &[0.028]).unwrap();
    assert_eq!((cloud.frames.len(), cloud.unreadable.len()), (MOST_FRAMES - 1, 1));
    assert!(cloud.unreadable[0].contains("particles_000000.vtu"), "{:?}", cloud.unreadable);
    assert_eq!(
        Cloud::read(tempfile::tempdir().unwrap().path(), &[]).unwrap(),
        Cloud { share: 1.0, ..Cloud::default() }
    );
}
