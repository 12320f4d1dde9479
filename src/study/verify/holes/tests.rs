use super::*;

/// A software device allows 128 MiB a buffer, a word for each cell.
#[test]
fn the_grids_of_all_holes_fit_small_devices() {
    for knudsen in KNUDSEN.into_iter().chain(gas::BETWEEN) {
        let plan = emptying(FULL, knudsen).expect("a plan").plan;
        let cells = plan.grid.cell_count() as u64;
        assert!(4 * cells < 128 << 20, "Kn = {knudsen}: {cells} cells");
    }
}

/// Cut through the middle of its hole, all the gas it should have, and no more particles than a small device takes.
#[test]
fn the_quarter_of_a_chamber_has_a_quarter_of_its_hole() {
    let plan = quarter(DENSE).expect("a plan").plan;
    let [inner, behind] = [0, 1].map(|k| plan.chambers[k].volume);
    let hole = THICKNESS * RADIUS * RADIUS;
    assert!((inner / QUARTER.powi(3) - 1.0).abs() < 1e-6, "{inner}");
    assert!((behind / (QUARTER.powi(3) + hole) - 1.0).abs() < 1e-3, "{behind}");
    assert!(32 * plan.particles < 128 << 20, "{}", plan.particles);
    assert!(4 * (plan.grid.cell_count() as u64) < 128 << 20, "{}", plan.grid.cell_count());
}
