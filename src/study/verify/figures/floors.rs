//! Viscosities at other occupancies, and of `cell`.

use super::figure::figure;
use crate::gas::kinetics;
use crate::gpu::Device;
use crate::plan::PER_CELL;
use crate::study::StudyError;
use crate::study::verify::gas_box::EquilibriumBox;
use crate::study::verify::shear::viscosity;
use crate::study::verify::{Effort, Findings};

/// Occupancy, rounds and viscosity of closest approach, section 2, to 10 % (at .12 that of its effective mean free path, .79 d); the
/// third is disputed. Plans have eight rounds. Of cells it has "about .7 to .8": see the notes.
const FLOORS: [(f64, u32, f64); 4] = [(0.12, 8, 0.783 * 0.79), (0.2, 8, 0.54), (0.2, 3, 0.54), (0.4, 3, 0.52)];

/// Of cells: .783 lambda (Chapman and Enskog) in mean spacings, and what collisions across a cell carry besides.
fn of_cells(occupancy: f64) -> f64 {
    let path = kinetics::mean_free_path_over_spacing(occupancy);
    0.783 * path * kinetics::viscosity_of_cells(PER_CELL.cbrt() / path)
}

pub(super) fn viscosities(device: &Device, effort: Effort) -> Result<Findings, StudyError> {
    let (particles, seeds) = if effort == Effort::Quick { (4000, 16) } else { (8000, 16) };
    let mut findings = Findings::default();
    let gas = |method, occupancy| EquilibriumBox {
        method,
        particles,
        occupancy,
        step_over_tau: 0.2,
        ..EquilibriumBox::default()
    };
    for (occupancy, rounds, expected) in FLOORS {
        let method = "closest-approach";
        let found = viscosity(device, EquilibriumBox { rounds, ..gas(method, occupancy) }, seeds)?;
        let quantity = format!("{method}: nu / (d c0), f = {occupancy}, R = {rounds}, N = {particles}");
        let check = figure(quantity, expected, found, 0.1 * expected);
        findings.checks.push(if (occupancy, rounds) == (0.2, 3) { check.disputed() } else { check });
    }
    let occupancy = 0.1;
    let found = viscosity(device, gas("cell", occupancy), seeds)?;
    let quantity = format!("cell: nu / (d c0), f = {occupancy}, N = {particles} (prototype .7 to .8)");
    findings.checks.push(figure(quantity, of_cells(occupancy), found, 0.1 * of_cells(occupancy)));
    findings.notes.push(
        "The prototype has .54 for closest approach at f = .2, known to 10 %. With three rounds and x = .2, which lose 2 % of \
         the collisions, it is about .48"
            .into(),
    );
    findings.notes.push(format!(
        "The prototype has .7 to .8 for cells of four to eight particles. Theory has {:.2} for six at f = .1 (Alexander, Garcia \
         and Alder, 1998), at least {:.2} at any occupancy, and the run agrees with it",
        of_cells(occupancy),
        2.0 * 0.783 * kinetics::ACROSS_CELLS.sqrt() * PER_CELL.cbrt()
    ));
    Ok(findings)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cells far smaller than a mean free path have the viscosity of Chapman and Enskog; at f = .1 they are 2.7 times as large.
    #[test]
    fn cells_add_to_the_viscosity() {
        let path = kinetics::mean_free_path_over_spacing;
        assert!((of_cells(1e-4) / (0.783 * path(1e-4)) - 1.0).abs() < 1e-3);
        assert!((of_cells(0.1) - 0.962).abs() < 2e-3, "{}", of_cells(0.1));
    }
}
