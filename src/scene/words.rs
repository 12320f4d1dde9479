//! What other programs, and other tables of the format, call what is asked for here: for hints where a key or a value is unknown.

pub(super) const REGION: &str = "for example region = { box = { min = [0, 0, 0], max = [1, 1, 1] } }";

/// Keys, what they are called in some table of the format, and what else there is to say.
const KEYS: &[(&[&str], &str, &str)] = &[
    (&["diameter"], "radius", ", half of it"),
    (&["radius"], "diameter", ", twice that"),
    (&["length"], "height", ""),
    (&["origin", "center", "centre", "start"], "base", ", the middle of the lower end"),
    (&["center", "centre", "origin", "location", "point"], "position", ""),
    (
        &["position", "center", "box", "sphere", "cylinder", "point"],
        "region",
        ": region = { sphere = { center = [0, 0, 0], radius = 1 } }",
    ),
    (&["centre", "origin", "position"], "center", ""),
    (&["normal", "axis", "dir", "vector"], "direction", ""),
    (&["direction", "normal"], "axis", ""),
    (&["molecular_weight", "mw", "molecular_mass", "mass", "m"], "molar_mass", ", per mole"),
    (&["p", "p0", "pres"], "pressure", ""),
    (&["t", "t0", "temp"], "temperature", ""),
    (&["t_end", "tend", "endtim", "termination_time", "run_time", "duration", "time"], "end_time", ""),
    (&["dt", "timestep", "step"], "time_step", ""),
    (&["n", "np", "number_of_particles", "n_particles", "num_particles"], "particles", ""),
    (&["cd", "c23", "coefficient", "discharge_coefficient"], "discharge", ""),
    (&["mdot", "m_dot", "mass_rate", "flow", "flow_rate", "mass_flow_rate"], "mass_flow", ""),
    (&["kappa", "gam", "cp_over_cv"], "gamma", ""),
    (&["h", "htc", "alpha"], "heat_transfer", ""),
    (&["type", "kind"], "shape", ""),
    (&["path", "mesh", "stl", "filename"], "file", ""),
    (&["composition", "species", "mixture", "fractions"], "gas", ""),
    (&["e", "ea", "modulus", "youngs_modulus", "young_modulus", "elastic_modulus", "eb"], "young", ""),
    (&["nu", "pr", "prba", "prab", "poisson_ratio"], "poisson", ""),
    (&["g", "gab", "shear_modulus"], "shear", ""),
    (&["rho", "ro", "mass_density"], "density", ""),
    (&["h", "t", "t1", "thick"], "thickness", ""),
    (&["damp", "xi", "damping_ratio"], "damping", ""),
    (&["fiber", "warp", "direction", "aopt"], "fibre", ", the direction of the warp"),
    (&["mat", "mat_fabric", "membrane"], "material", ": [fabric.material], below its [[fabric]]"),
    (&["spc", "boundary", "held", "fix"], "fixed", ""),
    (&["reference_geometry", "isrefg", "flat"], "reference", ", a mesh file"),
    (&["p_ext", "ambient_pressure", "atmospheric_pressure", "pressure"], "external_pressure", ""),
];

/// Keys and where they stand, where that is one table alone, or before all tables.
const HOMES: &[(&[&str], &str)] = &[
    (
        &["end_time", "units", "title", "seed", "gravity"],
        "stands before the first table of the file: what follows a header belongs to its table",
    ),
    (
        &[
            "particles",
            "method",
            "occupancy",
            "time_step",
            "rounds",
            "collision_number",
            "switch",
            "accuracy",
            "particle_budget",
            "time_budget",
            "device_rate",
        ],
        "is a key of [model]",
    ),
    (&["rows", "snapshots"], "is a key of [output]"),
    (&["hole"], "is a part of a wall: [[wall.hole]], below its [[wall]]"),
    (
        &["thickness", "density", "young", "poisson", "shear", "fibre", "damping"],
        "is a key of a fabric's material: [fabric.material], below its [[fabric]]",
    ),
    (&["jet"], "is a key of an [[orifice]]"),
    (&["molar_mass", "gamma", "cp", "cv"], "is a key of a [[gas]]"),
];

/// A hint for a key that is unknown where `known` are allowed.
pub(super) fn other_key(unknown: &str, known: &[&str]) -> Option<String> {
    let lower = unknown.to_lowercase();
    if let Some((key, more)) = same(&lower, known) {
        return Some(format!("did you mean `{key}`{more}?"));
    }
    let home = HOMES.iter().find(|(names, _)| names.contains(&lower.as_str()))?;
    Some(format!("`{lower}` {}", home.1))
}

/// Of the known keys the one that other programs call so, and what else there is to say of it.
fn same(lower: &str, known: &[&str]) -> Option<(&'static str, &'static str)> {
    let found = KEYS.iter().find(|(names, key, _)| names.contains(&lower) && known.contains(key));
    found.map(|(_, key, more)| (*key, *more))
}

/// Of the known keys the one that other programs call so.
pub fn key_of_other_name(name: &str, known: &[&str]) -> Option<&'static str> {
    same(&name.to_lowercase(), known).map(|(key, _)| key)
}

/// A hint for a value that is unknown where `known` are allowed.
pub(super) fn other_value(unknown: &str, known: &[&str]) -> Option<String> {
    const VALUES: &[(&[&str], &str)] = &[
        (&["dsmc", "ntc", "bird", "collide"], "cell"),
        (&["cpm", "particle", "particles", "airbag_particle"], "closest-approach"),
        (&["uniform", "ucv", "cv", "uniform-pressure"], "control-volume"),
        (&["free", "free-molecular", "ballistic"], "none"),
        (&["cuboid", "brick", "block", "cube"], "box"),
        (&["ball"], "sphere"),
        (&["tube", "pipe"], "cylinder"),
        (&["plate", "disc", "rectangle"], "plane"),
        (&["stl", "obj", "file"], "mesh"),
    ];
    let lower = unknown.to_lowercase().replace(['_', ' '], "-");
    if known == ["box", "sphere", "cylinder"] {
        return Some(REGION.to_string());
    }
    // The same words in another order.
    let parts = |text: &str| {
        let mut parts: Vec<String> = text.to_lowercase().split(['-', '_', ' ', ',']).map(str::to_string).collect();
        parts.sort();
        parts
    };
    let turned = known.iter().find(|name| parts(name) == parts(&lower));
    let named = VALUES.iter().find(|(names, name)| names.contains(&lower.as_str()) && known.contains(name));
    let meant = turned.copied().or(named.map(|(_, name)| *name))?;
    Some(format!("did you mean `{meant}`?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_of_another_program_or_table_leads_home() {
        let hint = |unknown: &str, known: &[&str]| other_key(unknown, known).unwrap_or_default();
        assert_eq!(hint("diameter", &["center", "radius"]), "did you mean `radius`, half of it?");
        assert_eq!(hint("t_end", &["title", "end_time"]), "did you mean `end_time`?");
        assert!(hint("end_time", &["rows", "snapshots"]).contains("before the first table"));
        assert!(hint("hole", &["wall"]).contains("[[wall.hole]]"));
        assert_eq!(other_key("viscosity", &["rows"]), None);
        assert_eq!(other_value("mm-ms-kg", &["SI", "kg-mm-ms", "t-mm-s"]).unwrap(), "did you mean `kg-mm-ms`?");
        assert_eq!(other_value("dsmc", &["cell", "none"]).unwrap(), "did you mean `cell`?");
        assert_eq!(other_value("dsmc", &["box"]), None);
    }
}
