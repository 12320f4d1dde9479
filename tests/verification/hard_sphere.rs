//! Law of the method `hard-sphere` (docs/explanation/method.md, "Collisions"): its pressure on walls
//! over n k T is 1.039 at f = .01 and 1.486 at f = .1, near that of rigid spheres (Carnahan-Starling: 1.041, 1.521)
//! and not the ideal gas's.
//!
//! Statistics: H independent hits give the pressure to 1.13 / sqrt(H) (section 6). The table's own error is taken for half
//! a per cent.

use corpuscle::study::verify::collisions::{RIGID, rigid_pressure_ratio};

use crate::equilibrium_box::EquilibriumBox;
use crate::whole_run::device;

#[test]
fn rigid_spheres_press_as_the_table_says() {
    let gas = EquilibriumBox { method: "hard-sphere", ..EquilibriumBox::default() };
    let warnings = gas.model().expect("a model").plan.warnings;
    assert!(warnings.iter().any(|warning| warning.contains("Carnahan-Starling")), "{warnings:?}");
    for (occupancy, steps, expected) in RIGID {
        let ((ratio, error), taken) = rigid_pressure_ratio(&device(), occupancy, steps).expect("a run");
        assert_eq!(taken, u64::from(steps), "every step is as long as asked");
        println!("f {occupancy}: {ratio:.4} +- {error:.4} ({expected})");
        let tolerance = expected * (0.005 + 3.0 * error);
        assert!((ratio - expected).abs() < tolerance, "f {occupancy}: {ratio:.4} +- {error:.4}");
        // The check can fail: the ideal gas is told apart.
        assert!((ratio - 1.0).abs() > 0.5 * (expected - 1.0), "{ratio}");
    }
}
