//! The plan as text: the table of `corpuscle plan`, and TOML.

use std::fmt::Write;

use super::planned::{ChamberPlan, Plan};
use super::reason::Reason;
use super::text::{grouped, row_of, significant, table};
use crate::scene::Method;

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
        let without = if self.inventory.moves { ", without the work of moving walls" } else { "" };
        row("final temperature", reference, &format!("mean of all gas, no heat lost{without}"));
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
