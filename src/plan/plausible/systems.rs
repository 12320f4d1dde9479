//! Numbers that are those of another unit system than the one that the scene says.

use super::range::{Kind, Range, most, range_of};
use crate::scene::{GAS_CONSTANT, HeatCapacity, JetSpeed, Scene, Shape, UnitSystem};

const SYSTEMS: [(UnitSystem, &str); 3] =
    [(UnitSystem::Si, "SI"), (UnitSystem::KgMmMs, "kg-mm-ms"), (UnitSystem::TMmS, "t-mm-s")];
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
    let fits = |(system, _): &&(UnitSystem, &str)| *system != scene.units && beyond(*system).is_empty();
    let name = |units: UnitSystem| SYSTEMS.iter().find(|known| known.0 == units).map_or("", |known| known.1);
    let fitting: Vec<String> =
        SYSTEMS.iter().filter(fits).map(|(system, _)| format!("`units = \"{}\"`", name(*system))).collect();
    (!fitting.is_empty()).then(|| {
        format!(
            "the scene: {} kinds of values are beyond what is usual in {}, and none would be with {}: are the numbers in that system?",
            own.len(),
            name(scene.units),
            fitting.join(" or ")
        )
    })
}

/// What the file gives that has a range, SI, kind by kind. (An external pressure may be that of a scene that gives none.)
fn values(scene: &Scene) -> Vec<(Kind, f64)> {
    let extent = |shape: &Shape| match shape {
        Shape::Box { min, max, .. } => (0..3).map(|axis| max[axis] - min[axis]).reduce(f64::max),
        Shape::Cylinder { radius, height, .. } => Some(height.max(2.0 * radius)),
        Shape::Sphere { radius, .. } => Some(2.0 * radius),
        Shape::Plane { size, .. } => Some(size[0].max(size[1])),
        Shape::Mesh { .. } => None,
    };
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
    values.extend(scene.walls.iter().filter_map(|wall| extent(&wall.shape)).map(of(Kind::Extent)));
    values.extend(scene.chambers.iter().map(|chamber| chamber.pressure).map(of(Kind::Pressure)));
    values.extend(scene.orifices.iter().map(|orifice| most(&orifice.mass_flow)).map(of(Kind::MassFlow)));
    values.extend(speeds.map(of(Kind::Speed)));
    values
}
