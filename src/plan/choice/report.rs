//! The choice in words: what was chosen, what it is worth and costs, what the next plans would be, and why.

use super::chooser::{AIM, Chooser, Limits, NEXT};
use super::holes::Holes;
use super::possible::Possible;
use super::words::{duration, percent, words};
use crate::plan::forecast::{Alternative, Cause, ColumnForecast, Forecast, worst};
use crate::plan::text::{grouped, significant};
use crate::plan::{Plan, Quantity, Reason};
use crate::scene::{Method, ModelRequest, Wish};

/// The request to plan, and what to add to its plan.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    pub request: ModelRequest,
    pub forecast: Forecast,
    reasons: Vec<Reason>,
    holes: Holes,
    /// Of holes that are resolved, in place of an advice: the name, and what to add to its reason.
    hole_notes: Vec<(String, String)>,
}

impl Choice {
    /// A line for the start of a run.
    pub fn summary(&self) -> String {
        let Forecast { error, seconds, .. } = &self.forecast;
        let method = self.request.method.map_or("", Method::name);
        format!("{method}: predicted error {}, predicted cost {}", percent(*error), duration(*seconds))
    }

    /// The same in few words, beside another choice.
    pub fn in_short(&self) -> String {
        let particles = self.request.particles.map_or(String::new(), |n| format!(" with {} particles", grouped(n)));
        let method = self.request.method.map_or("", Method::name);
        let Forecast { error, seconds, .. } = &self.forecast;
        format!("{method}{particles}, predicted error {}, cost {}", percent(*error), duration(*seconds))
    }

    /// Whether it is better by what was wished: of those that reach the aim for an accuracy the cheaper one, and one of these before one that
    /// only reaches the accuracy itself; without an accuracy the more accurate one.
    pub fn is_better_than(&self, other: &Choice, wish: &Wish) -> bool {
        let [own, other] = [self, other].map(|choice| {
            let Forecast { error, seconds, .. } = choice.forecast;
            wish.accuracy.map_or((false, error), |accuracy| (error > AIM * accuracy, seconds))
        });
        own < other
    }

    /// Adds to the reasons of holes that are resolved. (A control volume models them all.)
    pub fn hole_notes(&mut self, holes: Vec<String>, note: &str) {
        if self.request.method == Some(Method::ControlVolume) {
            return;
        }
        self.hole_notes = holes.into_iter().map(|hole| (hole, note.to_owned())).collect();
    }

    /// Gives the reasons of holes that are modelled: of each its name and what stands for it; `beside`: what resolving them
    /// would be.
    pub fn holes_modelled(&mut self, holes: &[(String, String)], beside: &str) {
        let lacking = self.forecast.columns.iter().filter(|column| column.asked).flat_map(|column| &column.parts);
        let error = lacking.filter(|part| part.cause == Cause::LeftOut).map(|part| part.error).fold(0.0, f64::max);
        for (hole, what) in holes {
            let why = format!("only its flow matters: {what}, which is {} of a pressure; {beside}", percent(error));
            self.reasons.push(reason(&format!("hole {hole}"), "modelled".into(), why));
        }
    }

    /// Says that a wish of the command line has set the scene's `particles` aside.
    pub fn set_aside(&mut self, particles: u64) {
        let why = "of the file: the command line wishes something else of the plan; --particles would keep it";
        self.reasons.insert(1, reason("set aside", format!("particles = {}", grouped(particles)), why.into()));
    }

    /// Puts the reasons of the choice in the place of those that say "asked for", and the forecast into the plan.
    pub fn explain(&self, plan: &mut Plan) {
        let mut reasons = self.reasons.clone();
        for hole in &plan.openings {
            let mut own = hole_reason(plan.method, &hole.name, hole.knudsen, &self.forecast.columns);
            match self.hole_notes.iter().find(|(name, _)| *name == hole.name) {
                Some((_, note)) => own.why.push_str(note),
                None => own.why.extend(self.holes.advice(plan, hole)),
            }
            reasons.push(own);
        }
        for vent in &plan.vents {
            let length = (vent.area / std::f64::consts::PI).sqrt();
            let volume: f64 = plan.chambers.iter().map(|chamber| chamber.volume).sum();
            // d = Kn l / .79 (docs/explanation/method.md, "What the plan decides, and why").
            let resolved = volume / (0.1 * length / 0.79f64).powi(3);
            let why = format!("exact in mass; resolved at Kn 0.1 it would take {} particles", grouped(resolved as u64));
            reasons.push(reason(&format!("vent {}", vent.name), "modelled".into(), why));
        }
        for own in &plan.reasons {
            if reasons.iter().all(|reason| reason.quantity != own.quantity) {
                reasons.push(own.clone());
            }
        }
        // What a hole that is not resolved is off by is in the forecast, and in the reason of the hole.
        let counted = |text: &String| text.starts_with("opening `") && text.contains(Quantity::Knudsen.name());
        plan.warnings.retain(|text| !counted(text));
        plan.reasons = reasons;
        plan.forecast = Some(self.forecast.clone());
    }
}

fn reason(quantity: &str, value: String, why: String) -> Reason {
    Reason { quantity: quantity.into(), value, why }
}

fn hole_reason(method: Method, name: &str, knudsen: f64, columns: &[ColumnForecast]) -> Reason {
    let error = |cause: Cause| {
        let parts = columns.iter().flat_map(|column| &column.parts).filter(|part| part.cause == cause);
        parts.map(|part| part.error).fold(0.0, f64::max)
    };
    let quantity = format!("hole {name}");
    if method == Method::ControlVolume {
        let why = format!(
            "0.84 of isentropic flow into vacuum, 0.61 by small differences, known to 0.02: {} of a pressure",
            percent(error(Cause::Coefficients))
        );
        return reason(&quantity, "modelled".into(), why);
    }
    if method == Method::None {
        return reason(&quantity, "resolved".into(), "free flight: no length to resolve".into());
    }
    let why = format!(
        "Kn {} at the mean density of the end: {} of a pressure",
        significant(knudsen),
        percent(error(Cause::Holes))
    );
    reason(&quantity, "resolved".into(), why)
}

fn wish_words(wish: &Wish) -> String {
    let mut words = Vec::new();
    words.extend(wish.accuracy.map(|accuracy| format!("accuracy {accuracy}")));
    words.extend(wish.time_budget.map(|budget| format!("time budget {}", duration(budget))));
    words.extend(wish.particle_budget.map(|budget| format!("particle budget {}", grouped(budget))));
    words.join(", ")
}

fn alternative(plan: &Possible) -> Alternative {
    Alternative {
        method: plan.candidate.method,
        particles: if plan.candidate.method == Method::ControlVolume { 0 } else { plan.candidate.particles as u64 },
        error: plan.error,
        seconds: plan.cost.seconds,
    }
}

pub fn choice(chooser: &Chooser<'_>, chosen: Possible, methods: Reason) -> Choice {
    let wish = &chooser.scene.model.wish;
    // Half a plan's cost is no other plan.
    let limits = if chosen.beyond.is_empty() { Limits::Kept } else { Limits::Broken };
    let cheaper =
        chooser.cheapest(NEXT * chosen.error, limits).filter(|plan| plan.cost.seconds < 0.8 * chosen.cost.seconds);
    let better = chooser.cheapest(chosen.error / NEXT, limits).filter(|plan| plan.error < chosen.error);
    let mut reasons = Vec::new();
    let aim = percent(AIM);
    let asked = match wish.accuracy {
        Some(accuracy) if chosen.error <= AIM * accuracy => format!("the cheapest plan that reaches {aim} of it"),
        Some(_) => {
            format!("the cheapest plan that reaches it; none reaches {aim} of it, as a forecast needs to be sure")
        }
        None => "the most accurate plan within it".to_owned(),
    };
    reasons.push(reason("wish", wish_words(wish), asked));
    let column = worst(&chosen.columns);
    let of = column.map_or_else(
        || "no column can be wrong".to_string(),
        |column| {
            let parts: Vec<String> =
                column.parts.iter().map(|part| format!("{} {}", part.cause.name(), percent(part.error))).collect();
            let parts = if parts.is_empty() { "nothing".into() } else { parts.join(", ") };
            format!("rms over the rows, worst in {}: {parts}", column.name)
        },
    );
    reasons.push(reason("predicted error", percent(chosen.error), of));
    let others = chosen.columns.iter().filter(|column| !column.asked && column.error > chosen.error);
    for other in others {
        let why = format!(
            "{}; not asked for: where a scene has surfaces or probes, these are",
            other.main_cause().map_or("", Cause::name)
        );
        reasons.push(reason(&format!("error of {}", other.name), percent(other.error), why));
    }
    let cost = if chosen.candidate.method == Method::ControlVolume {
        "an integration of ordinary equations; no device".into()
    } else {
        format!(
            "{:.2e} particle-steps at {} million a second{}; a rough estimate",
            chosen.cost.particle_steps,
            significant(1e-6 * chooser.rate),
            if wish.device_rate.is_some() { "" } else { " (lavapipe, two cores)" }
        )
    };
    reasons.push(reason("predicted cost", duration(chosen.cost.seconds), cost));
    reasons.extend(limits_reason(&chosen, wish));
    reasons.push(methods);
    reasons.push(method_reason(chooser, &chosen));
    if chosen.candidate.method != Method::ControlVolume {
        reasons.push(particles_reason(chooser, &chosen));
        reasons.extend(occupancy_reason(chooser, &chosen));
        reasons.extend(rounds_reason(chooser, &chosen));
        reasons.extend(step_reason(&chosen));
    }
    let none = |why: &str| ("none".to_string(), why.to_string());
    let shown = |plan: &Possible| {
        (words(plan), format!("predicted error {}, cost {}", percent(plan.error), duration(plan.cost.seconds)))
    };
    let (value, why) = cheaper.as_ref().map_or_else(|| none("no plan of twice the error costs less"), shown);
    reasons.push(reason("next cheaper", value, why));
    let (value, why) = better.as_ref().map_or_else(|| none("no plan has half the error"), shown);
    reasons.push(reason("next better", value, why));
    let forecast = Forecast {
        error: chosen.error,
        seconds: chosen.cost.seconds,
        particle_steps: chosen.cost.particle_steps,
        device_rate: chooser.rate,
        cheaper: cheaper.as_ref().map(alternative),
        better: better.as_ref().map(alternative),
        columns: chosen.columns.clone(),
    };
    let mut request = chooser.request(&chosen.family, chosen.candidate.particles as u64);
    request.time_step = chosen.time_step.or(request.time_step);
    let aimed = wish.accuracy.map_or(chosen.error, |accuracy| AIM * accuracy);
    let holes = Holes::new(chooser.scene, &chosen, aimed);
    Choice { request, forecast, reasons, holes, hole_notes: Vec::new() }
}

/// What the plan will warn of, where no other does better.
fn limits_reason(chosen: &Possible, wish: &Wish) -> Option<Reason> {
    if chosen.beyond.is_empty() {
        return None;
    }
    let names: Vec<&str> = chosen.beyond.iter().map(|quantity| quantity.name()).collect();
    let budget = match (wish.particle_budget, wish.time_budget) {
        (None, None) => "with what [model] asks for",
        _ => "within the budget",
    };
    let why = format!("no plan {budget} that is about as good keeps all limits: warned of below");
    Some(reason("limits not kept", names.join(", "), why))
}

/// How many rounds, and why not the other number.
fn rounds_reason(chooser: &Chooser<'_>, chosen: &Possible) -> Option<Reason> {
    let rounds = chosen.family.rounds.filter(|_| chooser.scene.model.rounds.is_none())?;
    let x = significant(chosen.candidate.collisions_per_step);
    let lost = percent(crate::plan::warnings::lost_events(chosen.candidate.collisions_per_step, rounds));
    Some(reason("rounds", rounds.to_string(), format!("the cheaper number: {lost} of collisions lost at x = {x}")))
}

/// Why a longer step than without a wish.
fn step_reason(chosen: &Possible) -> Option<Reason> {
    let step = chosen.time_step?;
    let why = format!(
        "{} times that of a scene without a wish: cheaper, though cells are larger; x = {}",
        significant(chosen.family.stretch),
        significant(chosen.candidate.collisions_per_step)
    );
    Some(reason("time step", format!("{} us", significant(1e6 * step)), why))
}

/// Why this method, and whether a control volume would do.
fn method_reason(chooser: &Chooser<'_>, chosen: &Possible) -> Reason {
    let method = chosen.candidate.method;
    let name = method.name().to_string();
    if chooser.scene.model.method.is_some() {
        return reason("method", name, "asked for".into());
    }
    let uniform = chooser.families.iter().find(|family| family.method == Method::ControlVolume);
    let wished = chooser.scene.model.wish.accuracy.is_some();
    let uniform = uniform.and_then(|family| chooser.possible(family, chooser.range[0]));
    let off = |uniform: &Possible| {
        let column = worst(&uniform.columns);
        let cause =
            column.and_then(ColumnForecast::main_cause).map_or(String::new(), |cause| format!(" ({})", cause.name()));
        format!("{} off in {}{cause}", percent(uniform.error), column.map_or("", |column| column.name.as_str()))
    };
    let why = match (uniform, wished) {
        (Some(_), true) if method == Method::ControlVolume => "suffices: pressures are uniform enough".into(),
        (Some(uniform), true) if uniform.cost.seconds < chosen.cost.seconds => {
            format!("a control volume does not suffice: {}", off(&uniform))
        }
        (_, true) => "the cheapest of those compared".to_string(),
        (Some(uniform), false) if method != Method::ControlVolume => {
            format!("the least error within the budget; a control volume is {}", off(&uniform))
        }
        (_, false) => "the least error within the budget".into(),
    };
    reason("method", name, why + &beside_others(chooser, chosen))
}

/// What the best of the other methods of particles would be.
fn beside_others(chooser: &Chooser<'_>, chosen: &Possible) -> String {
    if chosen.candidate.method == Method::ControlVolume {
        return String::new();
    }
    let wished = chooser.scene.model.wish.accuracy.is_some();
    match chooser.by_others(chosen) {
        None => String::new(),
        Some(None) => "; no other method of particles can".into(),
        Some(Some(other)) if wished => format!("; {} would cost {}", words(&other), duration(other.cost.seconds)),
        Some(Some(other)) => format!("; {} would be {} off", words(&other), percent(other.error)),
    }
}

fn particles_reason(chooser: &Chooser<'_>, chosen: &Possible) -> Reason {
    let value = grouped(chosen.candidate.particles as u64);
    if chooser.scene.model.particles.is_some() {
        return reason("particles", value, "asked for; initial and injected gas together at the end".into());
    }
    if chosen.family.fewest >= chooser.range[0] && chosen.candidate.particles <= 1.05 * chosen.family.fewest {
        return reason(
            "particles",
            value,
            "the fewest whose collision cells are no longer than the radius of the smallest hole".into(),
        );
    }
    let fewest = chosen.candidate.particles <= chooser.range[0];
    let column = worst(&chosen.columns);
    let why = match column.and_then(|column| column.main_cause().map(|cause| (column, cause))) {
        Some(_) if fewest => "the fewest that the plan takes; they are enough".into(),
        Some((column, cause)) => format!("{} decides, of {}", cause.name(), column.name),
        None => "the fewest that the plan takes".into(),
    };
    reason("particles", value, why)
}

fn occupancy_reason(chooser: &Chooser<'_>, chosen: &Possible) -> Option<Reason> {
    let asked = &chooser.scene.model;
    if asked.diameter.is_some() || asked.occupancy.is_some() {
        return None;
    }
    let occupancy = chosen.family.occupancy?;
    let density = chosen.candidate.particles / chooser.measured.gas_volume;
    let diameter = crate::gas::kinetics::diameter(density, occupancy);
    let why = if occupancy > 0.12 {
        format!("occupancy {occupancy}: sharper fronts for the cost than more particles")
    } else if occupancy < 0.12 {
        format!("occupancy {}: more would crowd the densest chamber", significant(occupancy))
    } else {
        format!("occupancy {occupancy}: more buys almost no resolution")
    };
    Some(reason("diameter", format!("{} mm", significant(1e3 * diameter)), why))
}
