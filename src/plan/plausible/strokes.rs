//! Walls that hardly move beside the chambers that they border on.

use super::units::{factor_of, units_of};
use crate::plan::Stroke;
use crate::plan::text::significant;
use crate::scene::{Course, Dimension, Scene};

/// Of the length of the chamber along the motion: who lets a wall move means it to move farther.
const HARDLY: f64 = 0.01;
/// Of that length, what another unit may make of the way.
const FARTHEST: f64 = 2.0;

pub fn hardly_moves(scene: &Scene, stroke: &Stroke) -> Option<String> {
    let share = stroke.way / stroke.length;
    if share >= HARDLY || stroke.way <= 0.0 {
        return None;
    }
    let motion = &scene.motions[stroke.motion];
    let (key, dimension) = match motion.course {
        Course::Velocity(_) => ("velocity", Dimension::Velocity),
        Course::Displacement(_) => ("displacement", Dimension::Length),
    };
    let own = scene.units.factor(dimension);
    let fits = |unit: &&str| (HARDLY..=FARTHEST).contains(&(share * factor_of(unit, dimension) / own));
    let question = match units_of(dimension).find(fits) {
        Some(unit) => format!(": is its `{key}` in {unit}? This scene has {}", scene.units.symbol(dimension)),
        None => format!(": is its `{key}` in the units of the scene?"),
    };
    let length = |m: f64| {
        let (factor, symbol) = scene.units.length();
        format!("{} {symbol}", significant(m / factor))
    };
    Some(format!(
        "motion of wall `{}`: it moves by {} in the whole run, {} % of the {} of chamber `{}` along it{question}",
        scene.walls[motion.wall].name,
        length(stroke.way),
        significant(100.0 * share),
        length(stroke.length),
        scene.chambers[stroke.chamber].name
    ))
}
