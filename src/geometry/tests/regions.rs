//! Gas volumes of regions and chambers.

use super::*;
use crate::geometry::{region_bounds, region_contains, region_volume};
use crate::scene::{Chamber, Mixture, Region};
use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::PI;

fn chamber(region: Option<Region>) -> Chamber {
    Chamber {
        name: "c".into(),
        region,
        inside: None,
        pressure: 1e5,
        temperature: 300.0,
        mixture: Mixture(vec![(0, 1.0)]),
    }
}

fn vessel() -> Vessel {
    Vessel::build(&[tank([1.0; 3]), hollow_box([0.3; 3], [0.5; 3], 0.02)]).unwrap()
}

#[test]
fn a_region_wholly_in_the_gas_has_its_own_volume() {
    let vessel = vessel();
    let axis = DVec3::new(2.0, -1.0, 2.0).normalize().to_array();
    for region in [
        Region::Box { min: [0.6, 0.1, 0.13], max: [0.97, 0.31, 0.77] },
        Region::Box { min: [0.3; 3], max: [0.5; 3] },
        Region::Sphere { center: [0.75; 3], radius: 0.2 },
        Region::Cylinder { base: [0.6, 0.7, 0.1], axis, radius: 0.07, height: 0.3 },
        Region::Cylinder { base: [0.6, 0.8, 0.8], axis: [1.0, 0.0, 0.0], radius: 0.1, height: 0.3 },
    ] {
        let share = vessel.gas_volume_in(&region) / region_volume(&region);
        assert!((share - 1.0).abs() < 1e-12, "{region:?} {share}");
    }
}

#[test]
fn a_region_cut_by_walls_has_the_part_in_the_gas() {
    let vessel = vessel();
    let shell = 0.24f64.powi(3) - 0.2f64.powi(3);
    let octant = 4.0 / 3.0 * PI * 0.2f64.powi(3) / 8.0;
    let cases = [
        // Much larger than the vessel.
        (Region::Box { min: [-9.0; 3], max: [9.0; 3] }, 1.0 - shell),
        (Region::Box { min: [0.2, 0.2, 0.2], max: [0.6, 0.6, 0.4] }, 0.032 - shell / 2.0),
        // An eighth of a ball in a corner.
        (Region::Sphere { center: [1.0; 3], radius: 0.2 }, octant),
        // A rod through the wall at x = 1, and one through the shell.
        (Region::Cylinder { base: [0.9, 0.8, 0.8], axis: [1.0, 0.0, 0.0], radius: 0.1, height: 0.4 }, PI * 1e-3),
        (
            Region::Cylinder { base: [0.4, 0.4, 0.1], axis: [0.0, 0.0, 1.0], radius: 0.05, height: 0.6 },
            PI * 0.0025 * 0.56,
        ),
        (Region::Sphere { center: [3.0; 3], radius: 1.0 }, 0.0),
    ];
    for (region, right) in cases {
        let found = vessel.gas_volume_in(&region);
        assert!((found - right).abs() <= 1e-4 * right, "{region:?}: {found} {right}");
    }
}

#[test]
fn chambers_share_out_the_gas_and_earlier_ones_come_first() {
    let vessel = vessel();
    let cavity = Region::Box { min: [0.3; 3], max: [0.5; 3] };
    let upper = Region::Box { min: [0.0, 0.0, 0.4], max: [1.0; 3] };
    let volumes = vessel.chamber_volumes(&[chamber(Some(cavity.clone())), chamber(Some(upper.clone())), chamber(None)]);
    let shell = 0.24f64.powi(3) - 0.2f64.powi(3);
    assert!((volumes[0] - 0.008).abs() < 1e-14);
    assert!((volumes[1] - (0.6 - shell / 2.0 - 0.004)).abs() < 6e-5, "{volumes:?}");
    assert!((volumes.iter().sum::<f64>() - vessel.gas_volume()).abs() < 1e-14);
    // In the other order the upper half of the cavity is the other chamber's.
    let turned = vessel.chamber_volumes(&[chamber(Some(upper)), chamber(Some(cavity))]);
    assert!((turned[1] - 0.004).abs() < 1e-6 && (turned[0] - volumes[1] - 0.004).abs() < 1e-4, "{turned:?}");
}

fn region() -> impl Strategy<Value = Region> {
    let place = || prop::array::uniform3(-1.0..1.0f64);
    prop_oneof![
        (place(), prop::array::uniform3(0.1..1.0f64))
            .prop_map(|(min, size)| Region::Box { min, max: std::array::from_fn(|k| min[k] + size[k]) }),
        (place(), 0.1..1.0f64).prop_map(|(center, radius)| Region::Sphere { center, radius }),
        (place(), place(), 0.1..1.0f64, 0.1..1.0f64).prop_map(|(base, axis, radius, height)| {
            Region::Cylinder {
                base,
                axis: DVec3::from(axis).try_normalize().unwrap_or(DVec3::X).to_array(),
                radius,
                height,
            }
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A point test and line intervals are two descriptions of the same body, whose volume is the formula's.
    #[test]
    fn contains_bounds_and_volume_belong_to_the_same_body(region in region()) {
        let (min, max) = region_bounds(&region);
        let inner = DVec3::from(max) - DVec3::from(min);
        let n = 40;
        let mut inside = 0;
        for k in 0..n * n * n {
            let index = [k % n, k / n % n, k / n / n];
            // A tenth beyond the bounds on each side.
            let p: [f64; 3] = std::array::from_fn(|a| min[a] + inner[a] * (1.2 * (index[a] as f64 + 0.5) / n as f64 - 0.1));
            if region_contains(&region, p) {
                prop_assert!((0..3).all(|a| min[a] <= p[a] && p[a] <= max[a]));
                inside += 1;
            }
        }
        let counted = f64::from(inside) / f64::from(n * n * n) * 1.728 * inner.element_product();
        prop_assert!((counted / region_volume(&region) - 1.0).abs() < 0.08, "{counted} {}", region_volume(&region));
        let vessel = Vessel::build(&[wall("w", crate::scene::Shape::Box { min: [-3.0; 3], max: [3.0; 3], thickness: None, holes: vec![] }, GasSide::Inside)]).unwrap();
        prop_assert!((vessel.gas_volume_in(&region) / region_volume(&region) - 1.0).abs() < 1e-12);
        // Half the space halves a region that is symmetric about its plane, and only that.
        let half = Vessel::build(&[wall("w", crate::scene::Shape::Box { min: [-3.0; 3], max: [(min[0] + max[0]) / 2.0, 3.0, 3.0], thickness: None, holes: vec![] }, GasSide::Inside)]).unwrap();
        prop_assert!((half.gas_volume_in(&region) / region_volume(&region) - 0.5).abs() < 2e-4);
    }
}
