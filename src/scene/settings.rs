//! What the scene asks of the plan and of the output.

use super::errors::Problem;
use super::gases::{MOST_MOLAR_HEAT, least_collision_number, other_system, shown_collision_number};
use super::numbers::{bounded, positive, show, small_count};
use super::raw::{RawCap, RawGas, RawModel, RawOutput, RawSwitch, When};
use super::raw_values::At;
use super::types::{
    DiameterCap, GAS_CONSTANT, Gas, HeatCapacity, Method, ModelRequest, OutputRequest, Switch, UnitSystem, Wish,
};
use super::units::Quantity;

/// Particle ids share a word with flags.
const MOST_PARTICLES: i64 = (1 << 27) - 1;
/// Z where the scene gives none.
const COLLISION_NUMBER: f64 = 5.0;
/// Range of a wished accuracy.
pub const LEAST_ACCURACY: f64 = 1e-4;
/// Million particle-steps per second: ten times what a GPU of 5 TB/s does in free flight. More are not millions.
pub const MOST_DEVICE_RATE: f64 = 3e5;
pub const MOST_ACCURACY: f64 = 0.5;
const ROWS: u32 = 200;
const SNAPSHOTS: u32 = 10;

pub(super) fn model(raw: &RawModel, units: UnitSystem) -> Result<ModelRequest, Problem> {
    if let (Some(diameter), Some(occupancy)) = (&raw.diameter, &raw.occupancy) {
        let later = if diameter.span.start > occupancy.span.start { &diameter.span } else { &occupancy.span };
        return Err(Problem::value(
            later,
            "both `diameter` and `occupancy`",
            "at most one of them: each follows from the other",
        ));
    }
    if let Some(method) = raw.method {
        heeded(raw, method)?;
    }
    let length = |at: &Option<At<f64>>| at.as_ref().map(|at| positive(at, Quantity::Length, units)).transpose();
    Ok(ModelRequest {
        method: raw.method,
        particles: raw.particles.as_ref().map(|n| super::numbers::count(n, 1..=MOST_PARTICLES)).transpose()?,
        diameter: length(&raw.diameter)?,
        occupancy: raw
            .occupancy
            .as_ref()
            .map(|f| bounded(f, Quantity::Pure, units, "a number above 0 and at most 0.5", |f| f > 0.0 && f <= 0.5))
            .transpose()?,
        diameter_cap: raw.diameter_cap.as_ref().map(|at| diameter_cap(at, units)).transpose()?,
        time_step: raw.time_step.as_ref().map(|t| positive(t, Quantity::Time, units)).transpose()?,
        rounds: raw.rounds.as_ref().map(|n| small_count(n, 1..=8)).transpose()?,
        collision_number: raw.collision_number.as_ref().map(|z| positive(z, Quantity::Pure, units)).transpose()?,
        switch: switch(raw, units)?,
        wish: wish(raw, units)?,
    })
}

/// A key that a run of the method would not heed is refused. (`diameter_cap = "off"` asks for nothing.)
fn heeded(raw: &RawModel, method: Method) -> Result<(), Problem> {
    let span = |at: &Option<At<f64>>| at.as_ref().map(|at| at.span.clone());
    let cap = raw.diameter_cap.as_ref().filter(|cap| matches!(cap.value, RawCap::Spacings(_)));
    let given = [
        ("diameter", span(&raw.diameter)),
        ("occupancy", span(&raw.occupancy)),
        ("diameter_cap", cap.map(|at| at.span.clone())),
        ("time_step", span(&raw.time_step)),
        ("rounds", raw.rounds.as_ref().map(|at| at.span.clone())),
        ("collision_number", span(&raw.collision_number)),
    ];
    let (without, why) = method.has_no();
    for (key, span) in given {
        if let Some(span) = span.filter(|_| without.contains(&key)) {
            let allowed = format!("no `{key}` with the method `{}`, {why}", method.name());
            return Err(Problem::value(&span, format!("`{key}`"), allowed));
        }
    }
    Ok(())
}

fn diameter_cap(asked: &At<RawCap>, units: UnitSystem) -> Result<DiameterCap, Problem> {
    let RawCap::Spacings(value) = asked.value else { return Ok(DiameterCap::Off) };
    let at = At { value, span: asked.span.clone() };
    Ok(DiameterCap::Spacings(positive(&at, Quantity::Pure, units)?))
}

fn wishes(raw: &RawModel) -> bool {
    raw.accuracy.is_some() || raw.time_budget.is_some() || raw.particle_budget.is_some()
}

fn switch(raw: &RawModel, units: UnitSystem) -> Result<Option<Switch>, Problem> {
    let lasting = raw.uniform_for.as_ref().map(|at| positive(at, Quantity::Time, units)).transpose()?;
    let Some(asked) = &raw.switch else {
        return match &raw.uniform_for {
            Some(at) => Err(Problem::value(&at.span, "`uniform_for`", "only beside `switch = \"when-uniform\"`")),
            None => Ok(None),
        };
    };
    if wishes(raw) {
        let allowed =
            "no `switch` beside `accuracy`, `time_budget` or `particle_budget`: what it saves is not predicted yet";
        return Err(Problem::value(&asked.span, "`switch` with a wish", allowed));
    }
    if raw.method == Some(Method::ControlVolume) {
        let allowed = "no `switch` with the method `control-volume`, which the run would switch to";
        return Err(Problem::value(&asked.span, "`switch`", allowed));
    }
    match (&asked.value, lasting, &raw.uniform_for) {
        (RawSwitch::At(time), None, _) => {
            let at = At { value: *time, span: asked.span.clone() };
            Ok(Some(Switch::At(positive(&at, Quantity::Time, units)?)))
        }
        (RawSwitch::When(When::Uniform), Some(lasting), _) => Ok(Some(Switch::WhenUniform { lasting })),
        (RawSwitch::When(When::Uniform), None, _) => Err(Problem::value(
            &asked.span,
            "\"when-uniform\" without `uniform_for`",
            "both: `uniform_for` says how long the pressures must have been uniform",
        )),
        (RawSwitch::At(_), Some(_), at) => Err(Problem::value(
            at.as_ref().map_or(&asked.span, |at| &at.span),
            "`uniform_for` with a time to switch at",
            "only beside `switch = \"when-uniform\"`",
        )),
    }
}

fn wish(raw: &RawModel, units: UnitSystem) -> Result<Wish, Problem> {
    if let (Some(particles), Some(budget)) = (&raw.particles, &raw.particle_budget) {
        let later = if particles.span.start > budget.span.start { &particles.span } else { &budget.span };
        return Err(Problem::value(
            later,
            "both `particles` and `particle_budget`",
            "at most one of them: the first says how many, the second how many at most",
        ));
    }
    if let Some(rate) = raw.device_rate.as_ref().filter(|_| !wishes(raw)) {
        let allowed = "only beside `accuracy`, `time_budget` or `particle_budget`, whose predicted cost it scales";
        return Err(Problem::value(&rate.span, "`device_rate` without a wish", allowed));
    }
    let pure = |at: &Option<At<f64>>| at.as_ref().map(|at| positive(at, Quantity::Pure, units)).transpose();
    let accuracy = |at: &At<f64>| {
        let allowed = "a relative error from 0.0001 to 0.5";
        bounded(at, Quantity::Pure, units, allowed, |e| (LEAST_ACCURACY..=MOST_ACCURACY).contains(&e))
    };
    let rate = |at: &At<f64>| {
        let allowed = format!("above 0 and at most {MOST_DEVICE_RATE}: it is in million particle-steps per second");
        bounded(at, Quantity::Pure, units, &allowed, |millions| millions > 0.0 && millions <= MOST_DEVICE_RATE)
    };
    Ok(Wish {
        accuracy: raw.accuracy.as_ref().map(accuracy).transpose()?,
        time_budget: pure(&raw.time_budget)?,
        particle_budget: raw
            .particle_budget
            .as_ref()
            .map(|n| super::numbers::count(n, 1..=MOST_PARTICLES))
            .transpose()?,
        device_rate: raw.device_rate.as_ref().map(rate).transpose()?.map(|millions| 1e6 * millions),
    })
}

/// Z must be large enough for every gas that has internal energy (docs/explanation/method.md, "Spin exchange").
pub(super) fn collision_number(
    raw: &RawModel,
    gases: &[Gas],
    raw_gases: &[At<RawGas>],
    units: UnitSystem,
) -> Result<(), Problem> {
    for (gas, raw_gas) in gases.iter().zip(raw_gases) {
        // That of a curve follows from the temperatures of the scene: the plan sees to it.
        let HeatCapacity::Constant(cv) = gas.heat else { continue };
        let zeta = 2.0 * cv / GAS_CONSTANT - 3.0;
        if zeta <= 0.0 {
            continue;
        }
        let least = least_collision_number(zeta);
        let shown = shown_collision_number(least);
        let allowed = format!("at least {shown:.4} for the {zeta:.3} internal degrees of freedom of {:?}", gas.name);
        match &raw.collision_number {
            Some(z) if z.value < least * (1.0 - 1e-12) => {
                return Err(Problem::value(&z.span, show(z.value), allowed));
            }
            None if COLLISION_NUMBER < least
                && !matches!(raw.method, Some(Method::None | Method::HalfTurn | Method::ControlVolume)) =>
            {
                if cv + GAS_CONSTANT > MOST_MOLAR_HEAT && raw_gas.value.gamma.is_none() {
                    return Err(implausible_heat(gas, cv, raw_gas, units));
                }
                let found = format!("a gas for which the default collision number {COLLISION_NUMBER} is too small");
                let hint = "give `collision_number` in `[model]`";
                return Err(Problem::value(&raw_gas.span, found, allowed).hint(hint));
            }
            _ => {}
        }
    }
    Ok(())
}

/// A heat capacity that no gas has, as a molar one: at its own line.
fn implausible_heat(gas: &Gas, cv: f64, raw_gas: &At<RawGas>, units: UnitSystem) -> Problem {
    let raw = &raw_gas.value;
    let (key, span, si) = match (&raw.cp, &raw.cv) {
        (Some(at), _) => ("cp", &at.span, cv + GAS_CONSTANT),
        (_, Some(at)) => ("cv", &at.span, cv),
        _ => ("heat capacity", &raw_gas.span, cv),
    };
    let shown = |si: f64| {
        format!("{:.4}", si / units.factor(Quantity::MolarHeat)).trim_end_matches('0').trim_end_matches('.').to_string()
    };
    let unit = units.symbol(Quantity::MolarHeat);
    let found = format!("a molar {key} of {} {unit}, more than any gas here has", shown(si));
    let allowed = format!(
        "at most {} {unit} (20 R), or a `collision_number` in [model] for the {:.3} internal degrees of freedom of {:?}",
        shown(MOST_MOLAR_HEAT),
        2.0 * cv / GAS_CONSTANT - 3.0,
        gas.name
    );
    let per_kilogram = "its heat capacity is more than 20 R: is it per kilogram? Multiply it by the molar mass";
    let hint = other_system(cv + GAS_CONSTANT, gas.molar_mass, units).unwrap_or_else(|| per_kilogram.into());
    Problem::value(span, found, allowed).hint(&hint)
}

pub(super) fn output(raw: &RawOutput) -> Result<OutputRequest, Problem> {
    Ok(OutputRequest {
        rows: raw.rows.as_ref().map_or(Ok(ROWS), |n| small_count(n, 1..=1_000_000))?,
        snapshots: raw.snapshots.as_ref().map_or(Ok(SNAPSHOTS), |n| small_count(n, 0..=100_000))?,
        report: raw.report.as_ref().map(|report| report.value),
    })
}
