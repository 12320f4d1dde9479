//! Numbers that are those of another unit system than the one that the scene says.

use super::range::{Kind, Range, most, range_of};
use super::shapes::longest;
use crate::scene::{GAS_CONSTANT, HeatCapacity, JetSpeed, Scene, UnitSystem};

/// Kinds of values that are beyond their ranges, at least: one alone has a unit of its own.
const SEVERAL: usize = 2;

/// If several kinds of values are beyond what is usual, and none would be if the numbers were of another system.
pub fn other_system(scene: &Scene) -> Option<String> {
    let values = values(scene);
    let beyond = |system: UnitSystem| {
        let holds = |(kind, si): &&(Kind, f64)| {
            let range: &Range = range_of(*kind);
            range.holds(si / scene.units.factor(range.dimension) * system.factor(range.dimension))
        };
        let mut kinds: Vec<Kind> = values.iter().filter(|value| !holds(value)).map(|value| value.0).collect();
        kinds.dedup();
        kinds
    };
    let own = beyond(scene.units);
    if own.len() < SEVERAL {
        return None;
    }
    let fits = |system: &UnitSystem| *system != scene.units && beyond(*system).is_empty();
    let fitting: Vec<String> =
        UnitSystem::ALL.into_iter().filter(fits).map(|system| format!("`units = \"{}\"`", system.name())).collect();
    (!fitting.is_empty()).then(|| {
        format!(
            "the scene: {} kinds of values are beyond what is usual in {}, and none would be with {}: are the numbers in that system?",
            own.len(),
            scene.units.name(),
            fitting.join(" or ")
        )
    })
}

/// What the file gives that has a range, SI, kind by kind. (An external pressure may be that of a scene that gives none.)
fn values(scene: &Scene) -> Vec<(Kind, f64)> {
    let heat = |heat: &HeatCapacity| match heat {
        HeatCapacity::Constant(_) => None,
        HeatCapacity::Curve(_) => Some(heat.molar_cv(300.0) + GAS_CONSTANT),
    };
    let speeds = scene.orifices.iter().filter_map(|orifice| match orifice.jet?.speed {
        JetSpeed::Velocity(speed) => Some(speed),
        JetSpeed::Mach(_) => None,
    });
    let of = |kind: Kind| move |si: f64| (kind, si);
    let mut values = vec![(Kind::EndTime, scene.end_time)];
    values.extend(scene.gases.iter().map(|gas| gas.molar_mass).map(of(Kind::MolarMass)));
    values.extend(scene.gases.iter().filter_map(|gas| heat(&gas.heat)).map(of(Kind::MolarHeat)));
    values.extend(scene.walls.iter().filter_map(|wall| longest(&wall.shape)).map(of(Kind::Extent)));
    values.extend(scene.chambers.iter().map(|chamber| chamber.pressure).map(of(Kind::Pressure)));
    values.extend(scene.orifices.iter().map(|orifice| most(&orifice.mass_flow)).map(of(Kind::MassFlow)));
    values.extend(speeds.map(of(Kind::Speed)));
    values
}
