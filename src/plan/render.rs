//! The plan as text: the table of `corpuscle plan`, and TOML.

use super::{ChamberPlan, Plan, Reason};
use crate::scene::Method;
use std::fmt::Write;

impl Plan {
    /// Aligned tables: each decision with its reason, then chambers, gases, openings, warnings.
    pub fn render(&self) -> String {
        let mut rows: Vec<Vec<String>> = self
            .reasons
            .iter()
            .map(|Reason { quantity, value, why }| vec![quantity.clone(), value.clone(), why.clone()])
            .collect();
        let mut row = |quantity: &str, value: String, why: &str| rows.push(vec![quantity.into(), value, why.into()]);
        if self.method != Method::ControlVolume {
            self.render_particles(&mut row);
        }
        let reference = format!("{} K", significant(self.temperature_reference));
        row("final temperature", reference, "mean of all gas, no heat lost");
        if !self.left_out.is_empty() {
            let lacks = format!("the scene lacks {}", self.left_out.join(", "));
            row("not compiled", format!("{} features", self.left_out.len()), &lacks);
        }
        let mut text = table(&rows);

        let counted = |count: u64| if self.method == Method::ControlVolume { String::new() } else { grouped(count) };
        let mut chambers = vec![row_of(["chamber", "particles", ""])];
        if self.method != Method::ControlVolume {
            let particles = |chamber: &ChamberPlan| counted(chamber.particles.iter().sum());
            chambers.extend(self.chambers.iter().map(|chamber| row_of([&chamber.name, &particles(chamber), ""])));
        }
        let mut gases = vec![row_of(["gas", "particles", "spin dof, exchange probability"])];
        gases.extend(self.gases.iter().map(|gas| {
            let spin = format!("{}, {}", significant(gas.spin_dof), significant(gas.exchange_probability));
            row_of([&gas.name, &counted(gas.particles), &spin])
        }));
        let mut openings = vec![row_of(["opening", "area", "Knudsen number"])];
        openings.extend(self.openings.iter().map(|opening| {
            let area = format!("{} cm2", significant(1e4 * opening.area));
            row_of([&opening.name, &area, &significant(opening.knudsen)])
        }));
        let mut vents = vec![row_of(["vent", "area, place", "mass flow at the start"])];
        vents.extend(self.vents.iter().map(|vent| {
            let areas = format!("{} of {} cm2", significant(1e4 * vent.area), significant(1e4 * vent.place));
            row_of([&vent.name, &areas, &format!("{} g/s", significant(1e3 * vent.initial_mass_flow))])
        }));
        let inventory = self.inventory.render();
        if !inventory.is_empty() {
            text.push('\n');
            text.push_str(&inventory);
        }
        for part in [chambers, gases, openings, vents].iter().filter(|part| part.len() > 1) {
            text.push('\n');
            text.push_str(&table(part));
        }
        for warning in &self.told() {
            // Writing to a string cannot fail.
            let _ = write!(text, "\nwarning: {warning}");
        }
        if !self.told().is_empty() {
            text.push('\n');
        }
        text
    }

    fn render_particles(&self, row: &mut dyn FnMut(&str, String, &str)) {
        let split =
            format!("{} initial, {} injected", grouped(self.initial_particles), grouped(self.injected_particles));
        row("particles counted", grouped(self.particles), &split);
        row("moles per particle", format!("{:.4e} mol", self.moles_per_particle), "the same for every gas");
        if self.diameter > 0.0 {
            let value = format!("{} mm", significant(1e3 * self.mean_free_path));
            row("mean free path", value, &format!("at occupancy {}", significant(self.occupancy)));
        }
        let [x, y, z] = self.grid.cells;
        row("grid", format!("{x} x {y} x {z}"), &format!("{} cells", grouped(self.grid.cell_count() as u64)));
        let steps = grouped(self.estimated_steps as u64);
        row(
            "steps",
            steps,
            &format!("for {} ms; more while dense gas needs shorter ones", significant(1e3 * self.end_time)),
        );
    }

    /// The whole plan, `plan.toml` of a run.
    pub fn to_toml(&self) -> Result<String, toml::ser::Error> {
        toml::to_string(self)
    }
}

fn row_of(cells: [&str; 3]) -> Vec<String> {
    cells.map(String::from).to_vec()
}

/// Columns padded to their widest entry; a line per row, all of the same length.
pub(super) fn table(rows: &[Vec<String>]) -> String {
    let columns = rows.first().map_or(0, Vec::len);
    let widths: Vec<usize> =
        (0..columns).map(|c| rows.iter().map(|row| row[c].chars().count()).max().unwrap_or(0)).collect();
    let mut text = String::new();
    for row in rows {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        text.push_str(cells.join("  ").trim_end());
        text.push('\n');
    }
    text
}

/// 1234567 as "1,234,567".
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Four significant digits, without trailing zeros.
pub fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let magnitude = libm::log10(value.abs()).floor() as i32;
    if !(-4..7).contains(&magnitude) {
        return format!("{value:.3e}");
    }
    let decimals = (3 - magnitude).max(0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        let found = [0.0, 0.12, 0.8571428, 12.3456, 123_456.0, 1e-9, f64::INFINITY].map(significant);
        assert_eq!(found, ["0", "0.12", "0.8571", "12.35", "123456", "1.000e-9", "inf"]);
    }

    #[test]
    fn columns_align() {
        assert_eq!(table(&[["a", "bb", "c"], ["aaa", "b", ""]].map(row_of)), "a    bb  c\naaa  b\n");
    }
}
