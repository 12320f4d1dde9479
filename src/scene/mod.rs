//! What the user asked for: a TOML file becomes a validated [`Scene`] in SI units.
//!
//! Two types stand for the two stages: the raw types are the file as written (serde reads them,
//! schemars describes them), [`Scene`] is what it means, every default and name resolved. On the way
//! every number is checked and converted, once. docs/reference/scenes.md describes the format.

mod course;
mod entries;
mod errors;
mod fabric;
mod fabric_material;
mod fabrics;
mod face;
mod flows;
mod gases;
mod holes;
mod lines;
mod motions;
mod names;
mod numbers;
mod parts;
mod places;
mod raw;
mod raw_fabric;
mod raw_part;
mod raw_region;
mod raw_values;
mod region;
mod settings;
mod structure;
mod surface_model;
mod surfaces;
#[cfg(test)]
mod tests;
mod toml_lines;
pub(super) mod types;
mod units;
mod validate;
mod vents;
mod wall_surface;
mod walls;
mod words;
mod write;
mod write_fabric;
mod write_surface;

use std::io::Read;
use std::path::Path;

pub use errors::{InvalidScene, Problem, SceneError};
pub use fabric::*;
pub use flows::FASTEST_JET;
pub use gases::shown_collision_number;
pub use lines::Lines;
pub use motions::MOST_MOTIONS;
pub use region::Region;
pub use settings::{LEAST_ACCURACY, MOST_ACCURACY, MOST_DEVICE_RATE};
pub use surface_model::*;
pub use types::*;
pub use units::Quantity as Dimension;
pub use words::key_of_other_name;
pub use write::to_toml;

/// A scene file is a text that people write.
const MOST_BYTES: u64 = 16 << 20;

/// Reads a scene file. Mesh files are looked for from its folder.
///
/// # Errors
/// The file cannot be read, is larger than 16 MiB, is not UTF-8, or does not describe a scene.
pub fn load(path: &Path) -> Result<Scene, SceneError> {
    let unreadable = |reason: std::io::Error| match std::fs::read_link(path) {
        Ok(target) if reason.kind() == std::io::ErrorKind::NotFound => {
            SceneError::Dangling { path: path.to_path_buf(), target }
        }
        _ => SceneError::Unreadable { path: path.to_path_buf(), reason },
    };
    let file = std::fs::File::open(path).map_err(unreadable)?;
    let mut bytes = Vec::new();
    // Devices and pipes have no length to ask for: read up to the limit and see.
    file.take(MOST_BYTES + 1).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(SceneError::TooLarge { path: path.to_path_buf(), limit: MOST_BYTES });
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let (offset, bytes) = (error.utf8_error().valid_up_to(), error.as_bytes());
        let line = 1 + bytes[..offset].iter().filter(|&&b| b == b'\n').count();
        SceneError::NotText { path: path.to_path_buf(), line, offset, byte: bytes.get(offset).copied().unwrap_or(0) }
    })?;
    parse(&text, &path.display().to_string(), path.parent().unwrap_or(Path::new("")))
}

/// Reads the text of a scene. `name` stands for it in messages; mesh files are looked for from `base_dir`.
///
/// # Errors
/// The text is not TOML or does not describe a scene: every problem found, with its place.
pub fn parse(text: &str, name: &str, base_dir: &Path) -> Result<Scene, SceneError> {
    let raw = structure::read(text).map_err(|problem| SceneError::invalid(name, text, vec![problem]))?;
    let stem = Path::new(name).file_stem().map_or_else(|| name.to_string(), |stem| stem.to_string_lossy().into_owned());
    let scene =
        validate::validate(&raw, &stem, base_dir).map_err(|problems| SceneError::invalid(name, text, problems))?;
    Ok(Scene { lines: entries::lines(&raw, text), ..scene })
}

/// The JSON schema of scene files, for editors that complete and check TOML.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(raw::RawScene).to_value()
}
