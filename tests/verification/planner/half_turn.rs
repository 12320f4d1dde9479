//! The same law of plans of the method `half-turn`. None is blind: the forecast of its rows and of the noise of its
//! spin was mended with them in sight. What is asked of each scene is what is asked of `closest-approach`, but for the
//! two holes: fewer than five spacings across a hole are no choice of a plan's.

use super::*;

fn case<'a>(name: &'a str, text: &'a str, asked: f64, rows: u32, seeds: u64) -> Case<'a> {
    Case { name, text, method: "half-turn", asked, rows, seeds }
}

#[test]
fn gas_at_rest() {
    check(&case("rest", REST, 0.05, 20, 6));
}

#[test]
fn two_chambers_and_a_hole() {
    check(&case("two chambers", TWO, 0.05, 12, 8));
}

#[test]
fn a_closed_vessel_is_filled() {
    check(&case("filling", FILLED, 0.02, 20, 3));
}

#[test]
fn a_vessel_vents() {
    check(&case("vent", VENTED, 0.06, 20, 6));
}

#[test]
fn a_small_tank() {
    check(&case("tank", TANK, 0.35, 10, 3));
}

#[test]
fn a_slab() {
    // Sound lasts longer than in more viscous gas, so a run has fewer independent rows.
    check(&case("slab", SLAB, 0.04, 15, 10));
}

#[test]
fn two_holes() {
    check(&case("two holes", TWO_HOLES, 0.1, 10, 3));
}

#[test]
fn a_hot_inflow() {
    check(&case("hot inflow", HOT, 0.03, 10, 3));
}

#[test]
#[ignore = "minutes: scripts/test.sh --long"]
fn a_vessel_is_filled_by_little_flow() {
    check(&case("low flow", LOW, 0.05, 20, 8));
}
