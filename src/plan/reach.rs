//! What chambers reach in a control volume, with the heat that walls take and what vents let out: vents that open at more stay shut.

use super::Measured;
use super::amounts::Amounts;
use super::forecast::{Outlook, pressures};
use super::heat::species;
use super::text::{as_written, significant};
use super::vent_notes::{absolute_question, is_absolute};
use crate::scene::{Dimension, GAS_CONSTANT, Scene, Vent};

/// Whether a vent opens at so much above the outside that its pressure may be an absolute one.
fn is_doubtful(scene: &Scene, vent: &Vent) -> bool {
    vent.external_pressure > 0.0 && vent.opening_pressure >= vent.external_pressure && !is_absolute(scene, vent)
}

/// Doubtful vents that all gas together would open, but not with what is lost meanwhile; none beside walls that move, whose work no
/// course of a plan knows.
pub fn notes(scene: &Scene, measured: &Measured, outlook: impl FnOnce() -> Outlook) -> Vec<String> {
    // They alone are worth a solution.
    if scene.vents.iter().all(|vent| !is_doubtful(scene, vent)) || measured.motion.is_some() {
        return Vec::new();
    }
    let Ok(species) = species(scene, measured, &mut Vec::new()) else { return Vec::new() };
    let Ok(amounts) = Amounts::of(scene, &species, measured) else { return Vec::new() };
    let rows = pressures(scene, measured, &outlook(), &species, &amounts);
    let end = amounts.total() * GAS_CONSTANT * amounts.final_temperature / measured.gas_volume;
    let told = scene.vents.iter().zip(&measured.vents).filter_map(|(vent, place)| {
        let start = scene.chambers[place.chamber].pressure;
        let highest = rows.iter().map(|row| row[place.chamber]).fold(start, f64::max);
        let opens_at = vent.external_pressure + vent.opening_pressure;
        // What not even all gas opens is told without.
        if !is_doubtful(scene, vent) || highest >= opens_at || end.max(start) < opens_at {
            return None;
        }
        let unit = scene.units.factor(Dimension::Pressure);
        let symbol = scene.units.symbol(Dimension::Pressure);
        Some(format!(
            "vent `{}`: it opens at {} {symbol} absolute, and with what walls and vents take its chamber has at most {} {symbol}, as a \
             control volume: it probably stays shut{}",
            vent.name,
            as_written(opens_at / unit),
            significant(highest / unit),
            absolute_question(scene, vent, highest)
        ))
    });
    told.map(|note| scene.lines.told(note)).collect()
}
