//! The way back of what surfaces do to the gas.

use super::surface_model::{HeatTransfer, SurfaceModel};
use super::toml_lines::TomlLines;

pub(super) fn write_surface(out: &mut TomlLines, surface: &SurfaceModel) {
    write_heat(out, surface);
    if surface.friction > 0.0 {
        out.number("friction", surface.friction);
    }
}

/// The keys of a part of a wall or a fabric.
pub(super) fn write_part(out: &mut TomlLines, face: &str, surface: &SurfaceModel) {
    out.text("face", face);
    write_heat(out, surface);
    // What is not given is that of the whole.
    out.number("friction", surface.friction);
}

fn write_heat(out: &mut TomlLines, surface: &SurfaceModel) {
    let Some(heat) = &surface.heat else { return };
    out.number("temperature", heat.temperature);
    match heat.transfer {
        HeatTransfer::Accommodation(share) => out.number("accommodation", share),
        HeatTransfer::Coefficient(coefficient) => out.number("heat_transfer", coefficient),
    }
}
