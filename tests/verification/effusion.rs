//! Law: without collisions n cbar A / 4 particles a second leave through a hole of area A (docs/explanation/method.md,
//! "Openings": within 3 %). The walls are specular, so the hole's side wall sends nothing back: a
//! particle keeps its velocity along the hole's axis and so comes through.
//!
//! Particles of speed v leave at v A / (4 V), the fast first, so after a time t
//! N0 (1 - integral f(v) exp(-v A t / (4 V)) dv) have left; the run is short enough (10 %) that what comes
//! back from the 26 times larger outer space is .2 % of that. Statistics: M particles that left are known
//! to 1 / sqrt(M).

use std::f64::consts::PI;

use corpuscle::study::verify::effusion::{self, CLAUSING, DIAMETER, staying};

use crate::whole_run::device;

fn flow_ratio(diameter: f64) -> (f64, f64) {
    effusion::flow_ratio(&device(), 100_000, diameter).expect("a run")
}

#[test]
fn a_thin_gas_leaves_through_a_hole_at_n_cbar_a_over_4() {
    let (ratio, error) = flow_ratio(DIAMETER);
    println!("effusion {ratio:.4} +- {error:.4}");
    assert!(error <= 0.03 / 2.5);
    assert!((ratio - 1.0).abs() < 0.03, "{ratio:.4} +- {error:.4}");
    // The check can fail: a hole 5 % narrower, by 9.75 % of its area, does not pass.
    let (narrow, error) = flow_ratio(0.95 * DIAMETER);
    println!("narrow {narrow:.4} +- {error:.4}");
    assert!((narrow - 1.0).abs() > 0.03, "{narrow:.4} +- {error:.4}");
}

/// To first order in time the share is cbar A t / (4 V).
#[test]
fn the_share_that_stays() {
    assert!((staying(0.0) - 1.0).abs() < 1e-9);
    assert!(((1.0 - staying(1e-4)) / 1e-4 - (8.0 / PI).sqrt()).abs() < 1e-3);
}

/// Law: of what enters a tube of rough walls twice as long as its radius .5142 come out at the other end, whatever their
/// speeds (Clausing 1932); through a smooth one all do. Half as rough walls let more through than rough ones.
#[test]
#[ignore = "a minute or two: scripts/test.sh --long; `corpuscle verify rough-tube` runs the case too"]
fn a_rough_tube_passes_what_clausing_says() {
    let transmission = |friction| effusion::transmission(&device(), 100_000, friction).expect("a run");
    let [rough, half, smooth] = [1.0, 0.5, 0.0].map(transmission);
    println!("rough {rough:.4?}, half {half:.4?}, smooth {smooth:.4?}");
    assert!(rough.1 <= 0.03 * CLAUSING / 2.0);
    assert!((rough.0 - CLAUSING).abs() < 0.03 * CLAUSING, "{rough:.4?}");
    assert!((smooth.0 - 1.0).abs() < 0.03, "{smooth:.4?}");
    assert!(half.0 > rough.0 + 4.0 * rough.1 && half.0 < smooth.0 - 4.0 * smooth.1, "{half:.4?}");
}
