//! The phase table at the end of a run: where the device's time went.

use super::table::{aligned, grouped, metric};

/// Device time by phase of the step, of the steps that are timed, each for as many as it stands for.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PhaseTable {
    /// Phase, device seconds, dispatches; in the order of the step.
    pub rows: Vec<(String, f64, u64)>,
    pub steps: u64,
    /// Sum over the steps of the particles in each.
    pub particle_steps: u64,
}

impl PhaseTable {
    /// s, of all phases.
    pub fn seconds(&self) -> f64 {
        self.rows.iter().map(|(_, seconds, _)| seconds).sum()
    }

    /// `wall`: seconds that the steps took, which the phases are given their shares of. What the device was idle is in them all.
    pub fn render(&self, wall: f64) -> String {
        let total = self.seconds();
        let scale = if total > 0.0 { wall / total } else { 0.0 };
        // A dash where there is nothing to divide by.
        let ratio = |over: f64, under: f64, decimals: usize| {
            if under > 0.0 { format!("{:.decimals$}", over / under) } else { "-".to_owned() }
        };
        let particle_steps = self.particle_steps as f64;
        let line = |name: &str, seconds: f64, dispatches: u64| {
            vec![
                name.to_owned(),
                format!("{:.4}", scale * seconds),
                ratio(100.0 * seconds, total, 1),
                ratio(1e9 * scale * seconds, particle_steps, 2),
                grouped(dispatches),
            ]
        };
        let head = ["Phase, sampled", "wall s", "%", "ns/particle-step", "dispatches"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        rows.extend(self.rows.iter().map(|(name, seconds, dispatches)| line(name, *seconds, *dispatches)));
        let dispatches = self.rows.iter().map(|(_, _, dispatches)| dispatches).sum();
        rows.push(line("total", total, dispatches));
        let mut text = aligned(&rows);
        text += &format!("{} steps, {} particle-steps", grouped(self.steps), grouped(self.particle_steps));
        if total > 0.0 {
            text += &format!(
                ", {}particle-steps/s; on the device {total:.4} s by the steps that were timed",
                metric(particle_steps / wall)
            );
        }
        text.push('\n');
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> PhaseTable {
        PhaseTable {
            rows: vec![("bin".to_owned(), 0.5, 1_000), ("choose".to_owned(), 1.5, 2_000)],
            steps: 1_000,
            particle_steps: 20_000_000,
        }
    }

    #[test]
    fn shares_sum_to_all_and_cost_is_per_particle_step() {
        insta::assert_snapshot!(table().render(4.0), @r"
        Phase, sampled  wall s      %  ns/particle-step  dispatches
        bin             1.0000   25.0             50.00       1,000
        choose          3.0000   75.0            150.00       2,000
        total           4.0000  100.0            200.00       3,000
        1,000 steps, 20,000,000 particle-steps, 5.00 M particle-steps/s; on the device 2.0000 s by the steps that were timed
        ");
    }

    #[test]
    fn a_slower_phase_changes_its_share() {
        let mut slower = table();
        slower.rows[0].1 = 1.5;
        assert!(slower.render(4.0).contains(" 50.0 ") && !table().render(4.0).contains(" 50.0 "));
    }

    #[test]
    fn a_run_without_steps_divides_by_nothing() {
        let text = PhaseTable { rows: vec![("bin".to_owned(), 0.0, 0)], ..PhaseTable::default() }.render(0.0);
        assert!(text.contains('-') && !text.contains("NaN") && !text.contains("inf"), "{text}");
    }
}
