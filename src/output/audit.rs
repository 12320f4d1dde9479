//! The audit at the end of a run: does the account of particles, mass and energy close?
//!
//! - particles: initial + injected = inside + outside + vented, with none outside the vessel;
//! - mass: start + injected = end + vented;
//! - energy: U0 + integral of h dm in + work of moving walls = U + integral of h dm out + heat to the walls
//!   (docs/explanation/method.md, "Inflow").
//!
//! - momentum, where the scene names surfaces and so what the walls received is tallied: start + injected =
//!   end + to the walls, within a share of M sqrt(2 U / M), the momentum of all gas flying one way at its
//!   mean thermal speed. In other scenes it is shown, not judged: the walls take an unknown part.
//!
//! Each is relative to all that there ever was, at the start and what came in: of a vessel that was pumped empty nothing is
//! left to compare with.
//!
//! Every comparison is written so that a NaN fails it.

mod elastic_fabric;
mod passed;

pub use elastic_fabric::{CaughtFlights, FabricAccount};
pub use passed::PassedParticles;

use super::table::{aligned, grouped};

/// What a run counted and measured, SI.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Audit {
    pub particles_initial: u64,
    pub particles_injected: u64,
    pub particles_vented: u64,
    /// At the end, inside the vessel.
    pub particles_inside: u64,
    /// At the end, outside the vessel: each one has passed a closed wall.
    pub particles_outside: u64,
    /// On the wrong side of closed fabric; `None` in a scene without.
    pub passed: Option<PassedParticles>,
    /// What passed vents and pores of fabric to gas on its other side, and so stays: particles, and kg. `None` where no vent leads there.
    pub through_fabric: Option<(u64, f64)>,
    /// kg.
    pub mass_start: f64,
    pub mass_injected: f64,
    pub mass_vented: f64,
    pub mass_end: f64,
    /// kg m/s.
    pub momentum_start: [f64; 3],
    pub momentum_injected: [f64; 3],
    /// What the walls received; `None` in a scene without surfaces, where it is not tallied.
    pub momentum_to_walls: Option<[f64; 3]>,
    pub momentum_end: [f64; 3],
    /// J, kinetic and spin.
    pub energy_start: f64,
    /// J, the integral of h dm over the mass actually injected.
    pub enthalpy_injected: f64,
    /// J.
    pub enthalpy_vented: f64,
    /// J, on the gas; `None` where no wall moves.
    pub work_by_walls: Option<f64>,
    /// `None` where no fabric is elastic.
    pub fabric: Option<FabricAccount>,
    /// J; `None` where no wall exchanges heat.
    pub heat_to_walls: Option<f64>,
    pub energy_end: f64,
    /// Pairs still mutually eligible after the last round, over all that should have collided; `None`
    /// where the method has no collisions.
    pub lost_collision_fraction: Option<f64>,
    /// In their place where all particles of a cell collide at once (the method `half-turn`).
    pub collision_cells: Option<CollisionCells>,
    /// Largest distance by which a particle was found beyond a wall, m.
    pub wall_overshoot: f64,
    /// Flights that used up their bounces in a step and were cut short.
    pub truncated_flights: u64,
    /// Flights that used up those at elastic fabric; `None` without.
    pub caught_flights: Option<CaughtFlights>,
    /// Of each vent its name, and the hits whose probability of passing was clipped to one, over those that passed.
    pub clipped_vents: Vec<(String, f64)>,
    /// Surfaces ("wall `x`", "fabric `x`") whose heat-transfer coefficient asked for more than all hits, and how many times as much at most.
    pub clipped_surfaces: Vec<(String, f64)>,
    /// Names of the buffers or tallies that overflowed.
    pub overflows: Vec<String>,
}

/// What was less than a full collision cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CollisionCells {
    /// Over the particles of all steps: those that flew on, alone in their collision cell or behind walls.
    pub free_flights: f64,
    /// And those that collided without a velocity gradient, in collision cells of fewer than six or flat ones.
    pub unfitted: f64,
    /// Groups that walls made of the particles of collision cells, a step.
    pub cut_groups: f64,
}

/// What an audit lets pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AuditLimits {
    /// Relative, of mass and of energy (docs/reference/accuracy.md: 1e-4).
    pub mass_error: f64,
    pub energy_error: f64,
    /// Relative to the momentum of all gas flying one way.
    pub momentum_error: f64,
    /// m.
    pub wall_overshoot: f64,
    pub truncated_flights: u64,
    /// Over the particles of all steps: above the one a warning, above the other the run fails. A flight that is caught presses less
    /// than it would, and so the gas less by at most the share of such flights: by no more than 1 %.
    pub caught_share: [f64; 2],
    /// The run fails if more than this share of the particles is on the wrong side of elastic fabric at a time.
    pub passed_share: f64,
    /// Above it a warning (docs/explanation/method.md, "Collisions": 3 %).
    pub lost_collision_fraction: f64,
    /// Of the account of elastic fabric; above it a warning.
    pub fabric_error: f64,
    /// Above it a warning.
    pub clipped_fraction: f64,
}

impl Default for AuditLimits {
    fn default() -> AuditLimits {
        AuditLimits {
            mass_error: 1e-6,
            energy_error: 1e-4,
            momentum_error: 1e-4,
            wall_overshoot: 1e-6,
            truncated_flights: 0,
            caught_share: [1e-4, 0.01],
            passed_share: 0.01,
            lost_collision_fraction: 0.03,
            fabric_error: 0.02,
            clipped_fraction: 0.01,
        }
    }
}

impl Audit {
    /// (U + vented + heat - U0 - injected - work) / (U0 + injected + work on the gas); NaN where there was no energy at all.
    pub fn energy_error(&self) -> f64 {
        (self.energy_end + self.energy_out() - self.energy_start - self.energy_in()) / self.energy_present()
    }

    /// All energy that there ever was. (Work that the gas did was its own.)
    fn energy_present(&self) -> f64 {
        self.energy_start + self.enthalpy_injected + self.work_by_walls.unwrap_or(0.0).max(0.0)
    }

    fn energy_in(&self) -> f64 {
        self.enthalpy_injected + self.work_by_walls.unwrap_or(0.0)
    }

    fn energy_out(&self) -> f64 {
        self.enthalpy_vented + self.heat_to_walls.unwrap_or(0.0)
    }

    /// As [`Audit::energy_error`], of the mass.
    pub fn mass_error(&self) -> f64 {
        let present = self.mass_start + self.mass_injected;
        (self.mass_end + self.mass_vented - present) / present
    }

    /// |p_end - p_start - p_injected + p_to_walls| over M sqrt(2 U / M) of all gas that there ever was; `None` where the walls'
    /// part was not tallied.
    pub fn momentum_error(&self) -> Option<f64> {
        let to_walls = self.momentum_to_walls?;
        let square = |axis: usize| {
            let expected = self.momentum_start[axis] + self.momentum_injected[axis] - to_walls[axis];
            (self.momentum_end[axis] - expected).powi(2)
        };
        let scale = (2.0 * self.energy_present() * (self.mass_start + self.mass_injected)).sqrt();
        Some((square(0) + square(1) + square(2)).sqrt() / scale)
    }

    /// Why the run cannot be trusted, one sentence each; empty if the audit is clean.
    pub fn verdict(&self, limits: &AuditLimits) -> Vec<String> {
        let mut failures = Vec::new();
        let entered = self.particles_initial + self.particles_injected;
        let found = self.particles_inside + self.particles_outside + self.particles_vented;
        if entered != found {
            failures.push(format!("{} particles entered and {} are accounted for", grouped(entered), grouped(found)));
        }
        if self.particles_outside > 0 {
            failures.push(format!("{} particles are outside the vessel", grouped(self.particles_outside)));
        }
        failures.extend(self.passed.and_then(|passed| passed.failure(limits.passed_share)));
        // A run without any gas has nothing to balance. (A control volume has gas without particles.)
        if entered > 0 || self.mass_start + self.mass_injected > 0.0 {
            for (what, error, limit) in
                [("mass", self.mass_error(), limits.mass_error), ("energy", self.energy_error(), limits.energy_error)]
            {
                if !within(error.abs(), limit) {
                    failures.push(format!("the {what} is off by {error:.2e} of it; {limit:.0e} is allowed"));
                }
            }
            if let Some(error) = self.momentum_error()
                && !within(error, limits.momentum_error)
            {
                failures.push(format!(
                    "the momentum is off by {error:.2e} of that of all gas flying one way; {:.0e} is allowed",
                    limits.momentum_error
                ));
            }
        }
        if !within(self.wall_overshoot, limits.wall_overshoot) {
            failures.push(format!(
                "a particle was {:.2e} m beyond a wall; {:.0e} m is allowed",
                self.wall_overshoot, limits.wall_overshoot
            ));
        }
        if self.truncated_flights > limits.truncated_flights {
            failures.push(format!(
                "{} flights had more bounces in a step than are followed; {} are allowed",
                grouped(self.truncated_flights),
                grouped(limits.truncated_flights)
            ));
        }
        if let Some(caught) = self.caught_flights
            && !within(caught.share, limits.caught_share[1])
        {
            failures.push(format!(
                "{}; {:.0} % is allowed, by so much the gas may press too little",
                caught.told(),
                100.0 * limits.caught_share[1]
            ));
        }
        for name in &self.overflows {
            failures.push(format!("{name} overflowed"));
        }
        failures
    }

    /// What makes the run less accurate than planned without making its account wrong.
    pub fn warnings(&self, limits: &AuditLimits) -> Vec<String> {
        let mut warnings = Vec::new();
        if let Some(lost) = self.lost_collision_fraction
            && !within(lost, limits.lost_collision_fraction)
        {
            warnings.push(format!(
                "{:.1} % of the collisions were lost (more than {:.0} %): use a smaller time step or more rounds",
                100.0 * lost,
                100.0 * limits.lost_collision_fraction
            ));
        }
        warnings.extend(self.passed.and_then(|passed| passed.warning(limits.passed_share)));
        if let Some(account) = &self.fabric
            && !within(account.error().abs(), limits.fabric_error)
        {
            warnings.push(format!(
                "the energy of elastic fabric is off by {:+.1} % of the largest amount of its account (more than {:.0} %): its steps \
                 are too long for how it moves, or hits of few heavy particles shake it",
                100.0 * account.error(),
                100.0 * limits.fabric_error
            ));
        }
        if let Some(caught) = self.caught_flights
            && !within(caught.share, limits.caught_share[0])
            && within(caught.share, limits.caught_share[1])
        {
            let allowed = 100.0 * limits.caught_share[0];
            warnings.push(format!(
                "{} (more than {allowed:.2} %): gas between sheets that touch presses too little",
                caught.told()
            ));
        }
        for (vent, share) in &self.clipped_vents {
            if !within(*share, limits.clipped_fraction) {
                warnings.push(format!(
                    "vent `{vent}`: {:.0} % of what left had a probability above one (more than {:.0} %): it passes too \
                     little, or with less than its enthalpy; give it a larger place, or resolve the hole",
                    100.0 * share,
                    100.0 * limits.clipped_fraction
                ));
            }
        }
        for (surface, times) in &self.clipped_surfaces {
            warnings.push(format!(
                "{surface}: its heat-transfer coefficient was up to {times:.2} times what all hits on it can carry"
            ));
        }
        warnings
    }

    /// The table for the end of the run and the report.
    pub fn render(&self) -> String {
        let row = |name: &str, cells: &[String]| -> Vec<String> {
            std::iter::once(name.to_owned()).chain(cells.iter().cloned()).collect()
        };
        let head: Vec<String> = ["start", "in", "out", "end", "error"].map(str::to_owned).into();
        let amounts = |values: [f64; 4], error: f64| -> Vec<String> {
            let amounts = values.iter().map(|value| format!("{value:.6e}"));
            amounts.chain([format!("{error:+.2e}")]).collect()
        };
        let entered = self.particles_initial + self.particles_injected;
        let found = self.particles_inside + self.particles_outside + self.particles_vented;
        let particles = [
            grouped(self.particles_initial),
            grouped(self.particles_injected),
            grouped(self.particles_vented),
            grouped(self.particles_inside + self.particles_outside),
            (i128::from(found) - i128::from(entered)).to_string(),
        ];
        let mass = [self.mass_start, self.mass_injected, self.mass_vented, self.mass_end];
        let energy = [self.energy_start, self.energy_in(), self.energy_out(), self.energy_end];
        let accounts = aligned(&[
            row("Audit", &head),
            row("particles", &particles),
            row("mass, kg", &amounts(mass, self.mass_error())),
            row("energy, J", &amounts(energy, self.energy_error())),
        ]);
        let vector = |[x, y, z]: [f64; 3]| format!("({x:.3e}, {y:.3e}, {z:.3e})");
        let collisions = match (self.collision_cells, self.lost_collision_fraction) {
            (Some(cells), _) => vec![
                ("free flights", format!("{:.3} % of particle-steps", 100.0 * cells.free_flights)),
                ("without a gradient", format!("{:.3} % of particle-steps", 100.0 * cells.unfitted)),
                ("groups cut by walls", format!("{:.1} a step", cells.cut_groups)),
            ],
            (None, Some(lost)) => vec![("lost collisions", format!("{:.3} %", 100.0 * lost))],
            (None, None) => vec![("lost collisions", "no collisions".to_owned())],
        };
        let overflows = if self.overflows.is_empty() { "none".to_owned() } else { self.overflows.join(", ") };
        let (to_walls, momentum_error) = match (self.momentum_to_walls, self.momentum_error()) {
            (Some(received), Some(error)) => (vector(received), format!("{error:.2e}")),
            _ if entered == 0 => ("none: there are no particles".to_owned(), "unknown".to_owned()),
            _ => ("not tallied: no surfaces".to_owned(), "unknown".to_owned()),
        };
        let passed = self.passed.map(|passed| ("on the wrong side of fabric", passed.amount()));
        let mut facts = vec![("outside the vessel", grouped(self.particles_outside))];
        facts.extend(passed);
        facts.extend([
            ("largest wall overshoot, m", format!("{:.2e}", self.wall_overshoot)),
            ("truncated flights", grouped(self.truncated_flights)),
        ]);
        facts.extend(self.caught_flights.map(|caught| ("flights caught by fabric", caught.amount())));
        facts.extend([
            ("overflows", overflows),
            ("momentum, kg m/s, start", vector(self.momentum_start)),
            ("  injected", vector(self.momentum_injected)),
            ("  to the walls", to_walls),
            ("  end", vector(self.momentum_end)),
            ("  error", momentum_error),
        ]);
        facts.extend(self.through_fabric.map(|(particles, mass)| {
            ("through vents of fabric, inside", format!("{} particles, {mass:.6e} kg", grouped(particles)))
        }));
        facts.splice(1..1, collisions);
        facts.extend(self.fabric.iter().flat_map(FabricAccount::facts));
        if let Some(work) = self.work_by_walls {
            facts.insert(0, ("in energy: work of moving walls, J", format!("{work:.6e}")));
        }
        if let Some(heat) = self.heat_to_walls {
            facts.insert(0, ("out of energy: heat to the walls, J", format!("{heat:.6e}")));
        }
        let widest = facts.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        facts.iter().fold(accounts, |text, (name, fact)| text + &format!("{name:<widest$}  {fact}\n"))
    }
}

/// False for a NaN.
fn within(value: f64, limit: f64) -> bool {
    value <= limit
}

#[cfg(test)]
mod tests;
