//! A scene as resolved: in SI, every default explicit. Reading it back gives an equal scene (but for
//! `units`, which says SI then).

use super::toml_lines::{TomlLines, quoted, region_table, shown};
use super::types::*;
use super::write_fabric::write_fabric;
use super::write_surface::{write_part, write_surface};

/// The scene as a TOML text.
pub fn to_toml(scene: &Scene) -> String {
    let mut out = TomlLines::default();
    out.text("title", &scene.title);
    out.text("units", "SI");
    out.number("end_time", scene.end_time);
    out.count("seed", scene.seed);
    if scene.gravity != [0.0; 3] {
        out.numbers("gravity", &scene.gravity);
    }
    for gas in &scene.gases {
        out.header("[[gas]]");
        out.text("name", &gas.name);
        out.number("molar_mass", gas.molar_mass);
        match &gas.heat {
            HeatCapacity::Constant(cv) => out.number("cv", *cv),
            HeatCapacity::Curve(cp) => out.numbers("cp", cp),
        }
    }
    for wall in &scene.walls {
        write_wall(&mut out, wall);
    }
    for chamber in &scene.chambers {
        out.header("[[chamber]]");
        out.text("name", &chamber.name);
        if let Some(region) = &chamber.region {
            out.entry("region", &region_table(region));
        }
        if let Some(inside) = chamber.inside {
            out.text("inside", &scene.fabrics[inside].name);
        }
        out.number("pressure", chamber.pressure);
        out.number("temperature", chamber.temperature);
        out.entry("gas", &mixture_table(&chamber.mixture, &scene.gases));
    }
    for opening in &scene.openings {
        out.header("[[opening]]");
        out.text("name", &opening.name);
        let names = opening.between.map(|index| quoted(&scene.chambers[index].name));
        out.entry("between", &format!("[{}, {}]", names[0], names[1]));
        out.number("area", opening.area);
        out.number("length", opening.length);
    }
    for orifice in &scene.orifices {
        out.header("[[orifice]]");
        out.text("name", &orifice.name);
        out.numbers("position", &orifice.position);
        out.numbers("direction", &orifice.direction);
        out.number("area", orifice.area);
        out.curve("mass_flow", &orifice.mass_flow);
        out.curve("temperature", &orifice.temperature);
        out.entry("gas", &mixture_table(&orifice.mixture, &scene.gases));
        if let Some(jet) = &orifice.jet {
            let speed = match jet.speed {
                JetSpeed::Mach(mach) => format!("mach = {}", shown(mach)),
                JetSpeed::Velocity(velocity) => format!("velocity = {}", shown(velocity)),
            };
            let angle = shown(degrees(jet.cone_angle));
            out.entry("jet", &format!("{{ {speed}, cone_angle = {angle} }}"));
        }
    }
    for probe in &scene.probes {
        out.header("[[probe]]");
        out.text("name", &probe.name);
        out.entry("region", &region_table(&probe.region));
    }
    for surface in &scene.surfaces {
        out.header("[[surface]]");
        out.text("name", &surface.name);
        out.text("wall", &scene.walls[surface.wall].name);
        write_face(&mut out, surface.face, &scene.walls[surface.wall]);
    }
    for vent in &scene.vents {
        write_vent(&mut out, vent, scene);
    }
    for motion in &scene.motions {
        write_motion(&mut out, motion, scene);
    }
    scene.fabrics.iter().for_each(|fabric| write_fabric(&mut out, fabric));
    write_settings(&mut out, scene);
    out.into_text()
}

fn write_wall(out: &mut TomlLines, wall: &Wall) {
    out.header("[[wall]]");
    out.text("name", &wall.name);
    let holes: &[Hole] = match &wall.shape {
        Shape::Box { min, max, thickness, holes } => {
            out.text("shape", "box");
            out.numbers("min", min);
            out.numbers("max", max);
            if let Some(thickness) = thickness {
                out.number("thickness", *thickness);
            }
            holes
        }
        Shape::Cylinder { base, axis, radius, height, segments } => {
            out.text("shape", "cylinder");
            out.numbers("base", base);
            out.numbers("axis", axis);
            out.number("radius", *radius);
            out.number("height", *height);
            out.count("segments", u64::from(*segments));
            &[]
        }
        Shape::Sphere { center, radius, subdivisions } => {
            out.text("shape", "sphere");
            out.numbers("center", center);
            out.number("radius", *radius);
            out.count("subdivisions", u64::from(*subdivisions));
            &[]
        }
        Shape::Plane { center, normal, u, size, thickness, holes } => {
            out.text("shape", "plane");
            out.numbers("center", center);
            out.numbers("normal", normal);
            out.numbers("u", u);
            out.numbers("size", size);
            out.number("thickness", *thickness);
            holes
        }
        Shape::Mesh { path, scale, parts: _ } => {
            out.text("shape", "mesh");
            out.text("file", &path.to_string_lossy());
            out.number("scale", *scale);
            &[]
        }
    };
    match wall.gas {
        GasSide::Inside => out.text("gas", "inside"),
        GasSide::Outside => out.text("gas", "outside"),
        GasSide::Both => {}
    }
    write_surface(out, &wall.surface);
    for part in &wall.parts {
        out.header("[[wall.part]]");
        write_part(out, &wall.face_name(part.face), &part.surface);
    }
    for hole in holes {
        out.header("[[wall.hole]]");
        out.text("name", &hole.name);
        write_face(out, Some(hole.face).filter(|face| *face != Face::Plane), wall);
        out.numbers("center", &hole.center);
        match hole.outline {
            Outline::Rectangle { size } => out.numbers("size", &size),
            Outline::Circle { diameter, segments } => {
                out.number("diameter", diameter);
                out.count("segments", u64::from(segments));
            }
        }
        if hole.flow_only {
            out.flag("flow_only", true);
        }
    }
}

fn write_vent(out: &mut TomlLines, vent: &Vent, scene: &Scene) {
    out.header("[[vent]]");
    out.text("name", &vent.name);
    match scene.fabric_at(vent.wall).map(|index| &scene.fabrics[index]) {
        Some(fabric) => {
            out.text("fabric", &fabric.name);
            if let Some(face) = vent.face {
                out.text("face", &fabric.face_name(face));
            }
        }
        None => {
            out.text("wall", &scene.walls[vent.wall].name);
            write_face(out, vent.face, &scene.walls[vent.wall]);
        }
    }
    if let Some(chamber) = vent.chamber {
        out.text("chamber", &scene.chambers[chamber].name);
    }
    if let Some(disc) = &vent.disc {
        out.numbers("position", &disc.center);
        out.number("diameter", disc.diameter);
    }
    if let Some(area) = vent.area {
        out.number("area", area);
    }
    match &vent.flow {
        VentFlow::Discharge(curve) => out.curve("discharge", curve),
        VentFlow::DischargeByPressure(curve) => out.curve("discharge_by_pressure", curve),
        VentFlow::LeakVelocity(curve) => out.curve("leak_velocity", curve),
    }
    out.number("opening_pressure", vent.opening_pressure);
    if scene.fabric_at(vent.wall).is_none() {
        out.number("external_pressure", vent.external_pressure);
    }
}

fn write_motion(out: &mut TomlLines, motion: &Motion, scene: &Scene) {
    out.header("[[motion]]");
    out.text("wall", &scene.walls[motion.wall].name);
    out.numbers("direction", &motion.direction);
    match &motion.course {
        Course::Velocity(curve) => out.curve("velocity", curve),
        Course::Displacement(curve) => out.curve("displacement", curve),
    }
}

fn write_face(out: &mut TomlLines, face: Option<Face>, wall: &Wall) {
    if let Some(face) = face {
        out.text("face", &wall.face_name(face));
    }
}

fn write_settings(out: &mut TomlLines, scene: &Scene) {
    let model = &scene.model.clone().heeded();
    out.header("[model]");
    if let Some(method) = model.method {
        out.text("method", method.name());
    }
    if let Some(particles) = model.particles {
        out.count("particles", particles);
    }
    for (key, value) in [
        ("diameter", model.diameter),
        ("occupancy", model.occupancy),
        ("time_step", model.time_step),
        ("collision_number", model.collision_number),
    ] {
        if let Some(value) = value {
            out.number(key, value);
        }
    }
    match model.diameter_cap {
        Some(DiameterCap::Off) => out.text("diameter_cap", "off"),
        Some(DiameterCap::Spacings(spacings)) => out.number("diameter_cap", spacings),
        None => {}
    }
    if let Some(rounds) = model.rounds {
        out.count("rounds", u64::from(rounds));
    }
    match model.switch {
        Some(Switch::At(time)) => out.number("switch", time),
        Some(Switch::WhenUniform { lasting }) => {
            out.text("switch", "when-uniform");
            out.number("uniform_for", lasting);
        }
        None => {}
    }
    let wish = &model.wish;
    let millions = wish.device_rate.map(|rate| 1e-6 * rate);
    for (key, value) in [("accuracy", wish.accuracy), ("time_budget", wish.time_budget), ("device_rate", millions)] {
        if let Some(value) = value {
            out.number(key, value);
        }
    }
    if let Some(budget) = wish.particle_budget {
        out.count("particle_budget", budget);
    }
    out.header("[output]");
    out.count("rows", u64::from(scene.output.rows));
    out.count("snapshots", u64::from(scene.output.snapshots));
    if let Some(report) = scene.output.report {
        out.flag("report", report);
    }
}

fn mixture_table(mixture: &Mixture, gases: &[Gas]) -> String {
    let parts: Vec<String> = mixture
        .0
        .iter()
        .map(|&(gas, fraction)| format!("{} = {}", quoted(&gases[gas].name), shown(fraction)))
        .collect();
    format!("{{ {} }}", parts.join(", "))
}

/// The degrees that read back as just this angle; rounding can move the plain conversion by a unit.
fn degrees(radians: f64) -> f64 {
    let near = radians.to_degrees();
    [near, near.next_up(), near.next_down()].into_iter().find(|degrees| degrees.to_radians() == radians).unwrap_or(near)
}
