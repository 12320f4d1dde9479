//! The way back of fabric.

use super::fabric::{Elasticity, Fabric, Fixed, Membrane, Turn};
use super::toml_lines::{TomlLines, region_table};
use super::types::Course;
use super::write_surface::{write_part, write_surface};

pub(super) fn write_fabric(out: &mut TomlLines, fabric: &Fabric) {
    out.header("[[fabric]]");
    out.text("name", &fabric.name);
    out.text("file", &fabric.mesh.to_string_lossy());
    out.number("scale", fabric.scale);
    if let Some(motion) = &fabric.motion {
        out.text("motion", &motion.to_string_lossy());
    }
    write_surface(out, &fabric.surface);
    if let Some(pressure) = fabric.external_pressure {
        out.number("external_pressure", pressure);
    }
    if let Some(membrane) = &fabric.membrane {
        write_membrane(out, membrane);
    }
    if let Some(turn) = &fabric.turn {
        write_turn(out, turn);
    }
    for part in &fabric.surface_parts {
        out.header("[[fabric.part]]");
        write_part(out, &fabric.face_name(part.face), &part.surface);
    }
}

fn write_turn(out: &mut TomlLines, turn: &Turn) {
    out.header("[fabric.turn]");
    out.numbers("axis", &turn.axis);
    out.numbers("center", &turn.center);
    match &turn.course {
        Course::Velocity(curve) => out.curve("angular_velocity", curve),
        Course::Displacement(curve) => out.curve("angle", curve),
    }
}

fn write_membrane(out: &mut TomlLines, membrane: &Membrane) {
    if let Some(reference) = &membrane.reference {
        out.text("reference", &reference.to_string_lossy());
    }
    match &membrane.fixed {
        Fixed::Nothing => {}
        Fixed::Edge => out.text("fixed", "edge"),
        Fixed::Within(regions) => {
            let regions: Vec<String> = regions.iter().map(region_table).collect();
            out.entry("fixed", &format!("[{}]", regions.join(", ")));
        }
    }
    if membrane.reference_scale != 1.0 || membrane.reference_time.is_some() {
        out.number("reference_scale", membrane.reference_scale);
    }
    if let Some(time) = membrane.reference_time {
        out.number("reference_time", time);
    }
    for (key, value) in [("added_mass", membrane.added_mass), ("wall_friction", membrane.wall_friction)] {
        if value != 0.0 {
            out.number(key, value);
        }
    }
    let material = &membrane.material;
    out.header("[fabric.material]");
    out.number("thickness", material.thickness);
    out.number("density", material.density);
    match &material.elasticity {
        Elasticity::Isotropic { young, poisson } => {
            out.number("young", *young);
            out.number("poisson", *poisson);
        }
        Elasticity::Orthotropic { young, poisson, shear, fibre } => {
            out.numbers("young", young);
            out.number("poisson", *poisson);
            out.number("shear", *shear);
            out.numbers("fibre", fibre);
        }
        Elasticity::Woven { young, shear, fibre } => {
            out.numbers("young", young);
            out.number("shear", *shear);
            out.numbers("fibre", fibre);
        }
    }
    out.number("damping", material.damping);
}
