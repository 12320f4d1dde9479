use super::*;
use crate::scene::parse;

/// A particle behind a wall by no more than walls let it be is no fault, however large the vessel.
#[test]
fn the_overshoot_allowed_is_the_walls_tolerance() {
    let text = include_str!("../../../../scenes/box.toml");
    let limits = |text: &str| {
        let plan = Model::new(parse(text, "box.toml", std::path::Path::new("")).unwrap()).unwrap().plan;
        (audit_limits(&plan).wall_overshoot, Walls::tolerance(&plan.grid))
    };
    let (small, tolerance) = limits(text);
    assert!(small > tolerance && small < 1.01 * tolerance, "{small} {tolerance}");
    let (large, tolerance) = limits(&text.replace("[0.1, 0.1, 0.1]", "[5.0, 5.0, 5.0]"));
    assert!(large > tolerance && large < 1.01 * tolerance, "{large} {tolerance}");
    // The default, 1 um, would refuse what the walls of the large vessel allow, and not what those of the small do.
    assert!(small < AuditLimits::default().wall_overshoot && large > AuditLimits::default().wall_overshoot);
}
