//! Times that do not belong together: curves that end long after the run or long before, runs of very many steps or of very many
//! transits of sound.

use super::range::{Kind, range_of};
use crate::plan::measured::Measured;
use crate::plan::text::{as_written, grouped, significant};
use crate::scene::{Course, Curve, Dimension, GAS_CONSTANT, Method, Scene, Switch, VentFlow};

/// How many times the length of a run a curve may go on.
const FAR_BEYOND: f64 = 100.0;
/// How many times as long as a curve a run may be: a thousand is a unit, a spark of 10 us in 1 ms a hundred.
const LONG_AFTER: f64 = 500.0;
/// How many times as long as its temperature's curve a mass flow may be: both are of one inflator.
const LONG_BESIDE: f64 = 100.0;
/// How many times as long as a step that is asked for the plan's own may be.
const LONG_STEP: f64 = 100.0;
/// Transits of sound from which on a run of particles is long: pressures are uniform after some tens.
const MANY_TRANSITS: f64 = 1000.0;

fn shown(scene: &Scene, time: f64) -> String {
    format!("{} {}", as_written(time / scene.units.factor(Dimension::Time)), scene.units.symbol(Dimension::Time))
}

fn last(curve: &Curve) -> f64 {
    curve.points.last().map_or(0.0, |point| point[0])
}

/// Of the curves of a scene.
pub fn doubts(scene: &Scene) -> Vec<String> {
    let mut found = Vec::new();
    for orifice in &scene.orifices {
        let subject = format!("orifice `{}`", orifice.name);
        found.extend(late(scene, &subject, "mass flow", last(&orifice.mass_flow)));
        found.extend(late(scene, &subject, "temperature", last(&orifice.temperature)));
        found.extend(early(scene, &subject, "mass flow", &orifice.mass_flow));
        let flows_until = last(&orifice.mass_flow).min(scene.end_time);
        found.extend(short_beside(scene, &subject, &orifice.temperature, flows_until));
    }
    for vent in &scene.vents {
        if let VentFlow::Discharge(curve) = &vent.flow {
            let subject = format!("vent `{}`", vent.name);
            found.extend(late(scene, &subject, "discharge", last(curve)));
            found.extend(early(scene, &subject, "discharge", curve));
        }
    }
    if let Some(Switch::At(at)) = scene.model.switch {
        found.extend(early_switch(scene, at));
    }
    for motion in &scene.motions {
        let (Course::Velocity(curve) | Course::Displacement(curve)) = &motion.course;
        let subject = format!("motion of wall `{}`", scene.walls[motion.wall].name);
        found.extend(late(scene, &subject, "curve", last(curve)));
        found.extend(early(scene, &subject, "curve", curve));
    }
    found
}

fn late(scene: &Scene, subject: &str, what: &str, ends: f64) -> Option<String> {
    (ends > FAR_BEYOND * scene.end_time).then(|| {
        format!(
            "{subject}: its {what} goes on until {}, {} times `end_time` {}: are its times, or is `end_time`, in another unit?",
            shown(scene, ends),
            significant(ends / scene.end_time),
            shown(scene, scene.end_time)
        )
    })
}

/// A run that is a control volume nearly from its start.
fn early_switch(scene: &Scene, at: f64) -> Option<String> {
    (LONG_AFTER * at < scene.end_time).then(|| {
        format!(
            "`model.switch`: particles end at {}, and `end_time` {} is {} times that: is one of them in another unit?",
            shown(scene, at),
            shown(scene, scene.end_time),
            significant(scene.end_time / at)
        )
    })
}

/// Of a curve that changes with time.
fn early(scene: &Scene, subject: &str, what: &str, curve: &Curve) -> Option<String> {
    let ends = last(curve);
    (curve.points.len() > 1 && ends > 0.0 && LONG_AFTER * ends < scene.end_time).then(|| {
        format!(
            "{subject}: its {what} is over at {}, and `end_time` {} is {} times that: are its times, or is `end_time`, in another unit?",
            shown(scene, ends),
            shown(scene, scene.end_time),
            significant(scene.end_time / ends)
        )
    })
}

/// A temperature that changes with time is one of the gas that flows meanwhile.
fn short_beside(scene: &Scene, subject: &str, temperature: &Curve, flows_until: f64) -> Option<String> {
    let ends = last(temperature);
    (temperature.points.len() > 1 && ends > 0.0 && LONG_BESIDE * ends < flows_until).then(|| {
        format!(
            "{subject}: its temperature ends at {}, and its mass flow goes on until {}, {} times that, at a constant temperature: are the \
             times of both in the unit of the scene?",
            shown(scene, ends),
            shown(scene, flows_until),
            significant(flows_until / ends)
        )
    })
}

/// A step that is asked for and is far shorter than the plan's own, both s.
pub fn short_step(scene: &Scene, asked: f64, own: f64) -> Option<String> {
    (LONG_STEP * asked < own * (1.0 + 1e-9)).then(|| {
        let steps = |step: f64| grouped((scene.end_time / step).ceil() as u64);
        format!(
            "the model: time_step {} is {} times shorter than the {} {} that the plan would choose, so the run has {} steps in place of \
             about {}: is it in another unit? Leave it out to have the plan's own",
            shown(scene, asked),
            significant(own / asked),
            significant(own / scene.units.factor(Dimension::Time)),
            scene.units.symbol(Dimension::Time),
            steps(asked),
            steps(own)
        )
    })
}

/// What is odd about the number of steps of a run of particles.
pub fn many_steps(scene: &Scene, steps: f64) -> Option<String> {
    let range = range_of(Kind::Steps);
    let step = scene.model.time_step.map_or(String::new(), |step| format!(" or `time_step` {}", shown(scene, step)));
    (!range.holds(steps)).then(|| {
        format!(
            "the run: {} steps, usual is {}: is `end_time` {}{step} in another unit?",
            grouped(steps as u64),
            range.words(scene.units),
            shown(scene, scene.end_time)
        )
    })
}

/// A run of particles that is long beside the time that sound takes through the gas of the first chamber (of gamma 1.4). Free flight
/// has no sound, and what switches to a control volume is not as long.
pub fn long_run(scene: &Scene, measured: &Measured, method: Method) -> Option<String> {
    let first = scene.chambers.first()?;
    if method == Method::None || scene.model.switch.is_some() || !range_of(Kind::EndTime).holds(scene.end_time) {
        return None;
    }
    let sound = libm::sqrt(1.4 * GAS_CONSTANT * first.temperature / first.mixture.molar_mass(&scene.gases));
    let transit = libm::cbrt(measured.gas_volume) / sound;
    let times = scene.end_time / transit;
    (times > MANY_TRANSITS).then(|| {
        format!(
            "the run: end_time {} is {} times the {} {} that sound takes through the gas: is it in another unit? If it is meant, a \
             `switch` goes on as a control volume once all is uniform",
            shown(scene, scene.end_time),
            grouped(times as u64),
            significant(transit / scene.units.factor(Dimension::Time)),
            scene.units.symbol(Dimension::Time)
        )
    })
}
