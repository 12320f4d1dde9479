//! The end of the particles: a control volume takes over what they leave (`switch`).

use super::simulation::Simulation;
use crate::output::Audit;
use crate::simulation::SimulationError;
use crate::simulation::accounting::row::Row;
use crate::simulation::timeloop::observer::{Continued, Observer};
use crate::simulation::zero_d::switch::beginning;
use crate::simulation::zero_d::uniform::{Continuation, Earlier, continue_uniform};
use crate::subdomain::Tallies;

/// What of mass and energy may be lost to rounding where a control volume takes over.
const HANDED_OVER: f64 = 1e-9;

impl Simulation<'_> {
    /// What a control volume does after the particles, whose state is `at_end`; `last` is the last row of theirs.
    pub fn go_on_without_particles(
        &self,
        at_end: &Tallies,
        account: &Audit,
        last: Option<&Row>,
        observer: &mut dyn Observer,
    ) -> Result<Option<Continued>, SimulationError> {
        let Some(known) = self.switching.known().filter(|_| self.switched) else { return Ok(None) };
        let (time, until) = (self.control.clock.time(), self.model.plan.end_time);
        let rows = self.model.scene.output.rows.max(1);
        let ends =
            (1..=rows).map(|row| until * f64::from(row) / f64::from(rows)).filter(|&end| end > time * (1.0 + 1e-9));
        let beginning = beginning(self.model, at_end, time, self.control.surfaces.open_vents());
        let ends: Vec<f64> = ends.collect();
        let earlier = Earlier { last, watches: &self.books.vents };
        let from = Continuation { beginning: &beginning, earlier };
        let audit = continue_uniform(self.model, known, &from, &ends, observer)?;
        for (what, had, has) in
            [("mass", account.mass_end, audit.mass_start), ("energy", account.energy_end, audit.energy_start)]
        {
            if (has - had).abs() > HANDED_OVER * had.abs() {
                let what = format!("the particles left a {what} of {had:.9e}, the control volume took over {has:.9e}");
                return Err(SimulationError::Lost { time, what });
            }
        }
        Ok(Some(Continued { until, why: self.switching.why(), audit }))
    }
}
