//! The plan as text: the table of `corpuscle plan`, and TOML.

use super::{Plan, Reason};
use crate::scene::Method;
use std::fmt::Write;

impl Plan {
    /// Aligned tables: each decision with its reason, then chambers, gases, openings, warnings.
    pub fn render(&self) -> String {
        let mut rows: Vec<[String; 3]> = self
            .reasons
            .iter()
            .map(|Reason { quantity, value, why }| [quantity, value, why].map(String::clone))
            .collect();
        let mut row = |quantity: &str, value: String, why: &str| rows.push([quantity.into(), value, why.into()]);
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
        let mut chambers = vec![["chamber".to_string(), "volume".into(), "particles".into()]];
        chambers.extend(self.chambers.iter().map(|chamber| {
            let count = counted(chamber.particles.iter().sum());
            [chamber.name.clone(), format!("{} L", significant(1e3 * chamber.volume)), count]
        }));
        let mut gases = vec![["gas".to_string(), "particles".into(), "spin dof, exchange probability".into()]];
        gases.extend(self.gases.iter().map(|gas| {
            let spin = format!("{}, {}", significant(gas.spin_dof), significant(gas.exchange_probability));
            [gas.name.clone(), counted(gas.particles), spin]
        }));
        let mut openings = vec![["opening".to_string(), "area".into(), "Knudsen number".into()]];
        openings.extend(self.openings.iter().map(|opening| {
            let area = format!("{} cm2", significant(1e4 * opening.area));
            [opening.name.clone(), area, significant(opening.knudsen)]
        }));
        let mut vents = vec![["vent".to_string(), "area, place".into(), "mass flow at the start".into()]];
        vents.extend(self.vents.iter().map(|vent| {
            let areas = format!("{} of {} cm2", significant(1e4 * vent.area), significant(1e4 * vent.place));
            [vent.name.clone(), areas, format!("{} g/s", significant(1e3 * vent.initial_mass_flow))]
        }));
        for part in [chambers, gases, openings, vents].iter().filter(|part| part.len() > 1) {
            text.push('\n');
            text.push_str(&table(part));
        }
        for warning in &self.warnings {
            // Writing to a string cannot fail.
            let _ = write!(text, "\nwarning: {warning}");
        }
        if !self.warnings.is_empty() {
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

/// Columns padded to their widest entry; a line per row.
fn table(rows: &[[String; 3]]) -> String {
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let (first, second) = (width(0), width(1));
    let mut text = String::new();
    for [a, b, c] in rows {
        let line = format!("{a:first$}  {b:second$}  {c}");
        text.push_str(line.trim_end());
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
        let rows = [["a", "bb", "c"], ["aaa", "b", ""]].map(|row| row.map(String::from));
        assert_eq!(table(&rows), "a    bb  c\naaa  b\n");
    }
}
