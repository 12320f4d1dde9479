//! Fabric: surfaces that deform as a file says.

use std::path::{Path, PathBuf};

use super::errors::{Problem, quote};
use super::numbers::positive;
use super::raw::{RawFabric, RawScene};
use super::raw_values::At;
use super::types::{Fabric, UnitSystem};
use super::units::Quantity;
use super::walls::existing;

/// Surfaces that deform, at most.
pub const MOST_FABRICS: usize = 16;

pub(super) fn fabric(raw: &At<RawFabric>, units: UnitSystem, base_dir: &Path) -> Result<Fabric, Problem> {
    let fabric = &raw.value;
    let scale = match &fabric.scale {
        Some(scale) => positive(scale, Quantity::Length, units)?,
        None => units.factor(Quantity::Length),
    };
    Ok(Fabric {
        name: fabric.name.value.clone(),
        mesh: file(&fabric.file, &["stl", "obj"], "a file name that ends with .stl or .obj", base_dir)?,
        scale,
        motion: match &fabric.motion {
            None => None,
            Some(motion) => {
                let allowed = "a file name that ends with .nodes, .pvd, .vtk.series or .vtu.series";
                Some(file(motion, &["nodes", "pvd", "series"], allowed, base_dir)?)
            }
        },
    })
}

fn file(named: &At<String>, endings: &[&str], allowed: &str, base_dir: &Path) -> Result<PathBuf, Problem> {
    let ending = Path::new(&named.value).extension().map(|ending| ending.to_ascii_lowercase());
    if !ending.is_some_and(|ending| endings.iter().any(|known| ending == *known)) {
        return Err(Problem::value(&named.span, quote(&named.value), allowed));
    }
    existing(named, base_dir)
}

/// What a scene with fabric cannot have (what the command line may ask for, too, is refused of the model).
pub(super) fn refuse(raw: &RawScene, problems: &mut Vec<Problem>) {
    if raw.fabric.is_empty() {
        return;
    }
    if let Some(motion) = raw.motion.first() {
        let found = "a [[motion]] in a scene with fabric";
        problems.push(
            Problem::value(&motion.span, found, "walls at rest beside fabric")
                .hint("a body that moves as a whole can be fabric, too: a closed mesh and the file of its motion"),
        );
    }
    for chamber in raw.chamber.iter().filter(|chamber| chamber.value.region.is_some()) {
        let found = format!("chamber {:?} with a `region` in a scene with fabric", chamber.value.name.value);
        problems.push(
            Problem::value(
                &chamber.span,
                found,
                "`inside`, the name of a closed [[fabric]]; the last chamber has the rest",
            )
            .hint("probes may have regions"),
        );
    }
}
