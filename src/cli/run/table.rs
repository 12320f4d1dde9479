//! The columns of `history.csv` and their values.
//!
//! A column is called `owner:quantity`, for instance `inner:pressure_pa`. Names are unique among the chambers, the probes, the
//! surfaces, the walls and the vents, each list for itself, and hold no colon. No quantity of a wall or of a vent is one of anything
//! else, so these have their names whatever others are called. Chambers have theirs, too; a surface called like a chamber is
//! `surface:NAME`, and a probe called like a chamber or a surface is `probe:NAME`. So no column of what is there is renamed by a key
//! that is given, or by a probe or a surface that is added.

use super::reference::Reference;
use crate::output::Column;
use crate::scene::Scene;
use crate::simulation::{Row, ZoneState};

/// The part before the quantity, of everything that has columns.
pub struct Owners {
    pub chambers: Vec<String>,
    pub probes: Vec<String>,
    pub surfaces: Vec<String>,
    /// Walls, and parts of walls, that exchange heat.
    pub walls: Vec<String>,
    pub vents: Vec<String>,
    /// Walls that move.
    pub motions: Vec<String>,
    /// Surfaces that deform.
    pub fabrics: Vec<String>,
}

impl Owners {
    pub fn of(scene: &Scene) -> Owners {
        let chambers: Vec<&str> = scene.chambers.iter().map(|chamber| chamber.name.as_str()).collect();
        let probes: Vec<&str> = scene.probes.iter().map(|probe| probe.name.as_str()).collect();
        let surfaces: Vec<&str> = scene.surfaces.iter().map(|surface| surface.name.as_str()).collect();
        let vents: Vec<&str> = scene.vents.iter().map(|vent| vent.name.as_str()).collect();
        let moving: Vec<&str> = scene.motions.iter().map(|motion| scene.walls[motion.wall].name.as_str()).collect();
        let owned = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let apart = |kind: &str, own: &[&str], earlier: &[&str]| -> Vec<String> {
            let named = |name: &&str| {
                if earlier.contains(name) { format!("{kind}:{name}") } else { (*name).to_owned() }
            };
            own.iter().map(named).collect()
        };
        Owners {
            probes: apart("probe", &probes, &[chambers.as_slice(), &surfaces].concat()),
            surfaces: apart("surface", &surfaces, &chambers),
            chambers: owned(&chambers),
            walls: scene.heated_surfaces().map(|(id, _)| scene.surface_name(id)).collect(),
            vents: owned(&vents),
            motions: owned(&moving),
            fabrics: scene.fabrics.iter().map(|fabric| fabric.name.clone()).collect(),
        }
    }
}

/// Of a chamber's pressure and of its reference: the heads that the chart looks for.
pub fn pressure_columns(owner: &str) -> [Column; 2] {
    [Column::new(format!("{owner}:pressure"), "pa"), Column::new(format!("{owner}:reference_pressure"), "pa")]
}

pub fn time_column() -> Column {
    Column::new("time", "s")
}

/// Of elastic fabric.
const ENERGIES: [&str; 3] = ["kinetic", "strain", "damped"];

/// Of a chamber, in scenes in which it changes.
pub fn volume_column(owner: &str) -> Column {
    Column::new(format!("{owner}:volume"), "m3")
}

const AXES: [&str; 3] = ["x", "y", "z"];

pub fn columns(scene: &Scene) -> Vec<Column> {
    let owners = Owners::of(scene);
    let mut columns =
        vec![time_column(), Column::new("window_end", "s"), Column::new("step", "s"), Column::new("particles", "")];
    for owner in &owners.chambers {
        columns.extend(pressure_columns(owner));
        columns.push(Column::new(format!("{owner}:temperature"), "k"));
        columns.push(Column::new(format!("{owner}:reference_temperature"), "k"));
        if !scene.motions.is_empty() || !scene.fabrics.is_empty() {
            columns.push(volume_column(owner));
        }
        flow_columns(&mut columns, owner, scene);
    }
    for owner in &owners.probes {
        columns.push(Column::new(format!("{owner}:pressure"), "pa"));
        columns.push(Column::new(format!("{owner}:temperature"), "k"));
        flow_columns(&mut columns, owner, scene);
    }
    for owner in &owners.surfaces {
        columns.push(Column::new(format!("{owner}:pressure"), "pa"));
        columns.extend(AXES.map(|axis| Column::new(format!("{owner}:impulse_{axis}"), "kg_m_s")));
        columns.push(Column::new(format!("{owner}:hits"), ""));
    }
    for owner in &owners.walls {
        columns.push(Column::new(format!("{owner}:heat"), "j"));
        columns.push(Column::new(format!("{owner}:heat_flux"), "w_m2"));
    }
    for owner in &owners.vents {
        columns.push(Column::new(format!("{owner}:mass_flow"), "kg_s"));
        columns.push(Column::new(format!("{owner}:wanted_mass_flow"), "kg_s"));
        columns.push(Column::new(format!("{owner}:discharge"), ""));
        columns.push(Column::new(format!("{owner}:wanted_discharge"), ""));
        columns.push(Column::new(format!("{owner}:mass"), "kg"));
        columns.push(Column::new(format!("{owner}:enthalpy"), "j"));
    }
    for owner in &owners.motions {
        columns.push(Column::new(format!("{owner}:displacement"), "m"));
        columns.push(Column::new(format!("{owner}:velocity"), "m_s"));
        columns.push(Column::new(format!("{owner}:work"), "j"));
        columns.push(Column::new(format!("{owner}:power"), "w"));
    }
    for owner in &owners.fabrics {
        columns.push(Column::new(format!("{owner}:enclosed_volume"), "m3"));
        columns.push(Column::new(format!("{owner}:area"), "m2"));
        columns.push(Column::new(format!("{owner}:outer_pressure"), "pa"));
        columns.push(Column::new(format!("{owner}:inner_pressure"), "pa"));
        columns.push(Column::new(format!("{owner}:work"), "j"));
        columns.push(Column::new(format!("{owner}:power"), "w"));
        if scene.fabrics.iter().any(|fabric| fabric.membrane.is_some()) {
            columns.extend(ENERGIES.map(|energy| Column::new(format!("{owner}:{energy}_energy"), "j")));
        }
    }
    columns
}

fn flow_columns(columns: &mut Vec<Column>, owner: &str, scene: &Scene) {
    columns.push(Column::new(format!("{owner}:density"), "kg_m3"));
    columns.extend(AXES.map(|axis| Column::new(format!("{owner}:velocity_{axis}"), "m_s")));
    columns.extend(scene.gases.iter().map(|gas| Column::new(format!("{owner}:particles:{}", gas.name), "")));
}

/// The values of a row, in the order of the columns.
pub fn values(row: &Row, reference: &Reference) -> Vec<f64> {
    let mut values = vec![row.time, row.window[1], row.step, row.particles as f64];
    for (chamber, state) in row.chambers.iter().enumerate() {
        let [pressure, temperature] = reference.at(row.time, chamber);
        values.extend([state.pressure, pressure, state.temperature, temperature]);
        if !row.motions.is_empty() || !row.fabrics.is_empty() {
            values.push(state.volume);
        }
        push_flow(&mut values, state);
    }
    for state in &row.probes {
        values.extend([state.pressure, state.temperature]);
        push_flow(&mut values, state);
    }
    for surface in &row.surfaces {
        values.push(surface.pressure);
        values.extend(surface.impulse);
        values.push(surface.hits as f64);
    }
    for wall in &row.walls {
        values.extend([wall.heat, wall.heat_flux]);
    }
    for vent in &row.vents {
        values.extend([vent.mass_flow, vent.wanted_mass_flow, vent.discharge, vent.wanted_discharge]);
        values.extend([vent.mass, vent.enthalpy]);
    }
    for motion in &row.motions {
        values.extend([motion.displacement, motion.velocity, motion.work, motion.power]);
    }
    for fabric in &row.fabrics {
        values.extend([fabric.volume, fabric.area, fabric.pressure[0], fabric.pressure[1], fabric.work, fabric.power]);
        values.extend(fabric.energies.iter().flat_map(|own| [own.kinetic, own.strain, own.damped]));
    }
    values
}

fn push_flow(values: &mut Vec<f64>, state: &ZoneState) {
    values.push(state.density);
    values.extend(state.velocity);
    values.extend(&state.particles);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::History;
    use crate::scene::{load, parse, to_toml};
    use std::path::Path;

    fn scene(name: &str) -> Scene {
        load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name)).unwrap()
    }

    #[test]
    fn names_that_lists_share_say_their_list_and_others_do_not() {
        let text = to_toml(&scene("tank.toml"));
        let shared = text.replace("name = \"vent jet\"", "name = \"inner\"");
        assert_ne!(shared, text);
        let owners = Owners::of(&parse(&shared, "tank.toml", Path::new("")).unwrap());
        assert_eq!(owners.chambers, ["inner", "tank"]);
        assert_eq!(owners.probes, ["probe:inner"]);
        assert_eq!(owners.surfaces, ["far wall"]);
    }

    /// Whatever else is given, the columns that were there are there: a temperature of a wall called like a chamber, a vent, a motion,
    /// a probe, a second gas.
    #[test]
    fn no_column_is_renamed_by_another_key() {
        let before = scene("tank.toml");
        let heads = |scene: &Scene| columns(scene).iter().map(Column::header).collect::<Vec<_>>();
        let [vents, pistons] = ["vent.toml", "piston.toml"].map(scene);
        let mut more = before.clone();
        let heat = vents.walls.iter().find_map(|wall| wall.surface.heat);
        more.walls.iter_mut().for_each(|wall| wall.surface.heat = heat);
        assert!(heat.is_some() && more.walls.iter().any(|wall| wall.name == before.chambers[1].name));
        let probe = before.probes[0].clone();
        for name in [&before.chambers[0].name, &before.surfaces[0].name, &before.walls[0].name] {
            more.probes.push(crate::scene::Probe { name: name.clone(), ..probe.clone() });
        }
        more.vents.push(crate::scene::Vent { name: before.chambers[0].name.clone(), ..vents.vents[0].clone() });
        more.motions.push(crate::scene::Motion { wall: 0, ..pistons.motions[0].clone() });
        more.gases.push(crate::scene::Gas { name: "another".into(), ..before.gases[0].clone() });
        let after = heads(&more);
        for head in heads(&before) {
            assert!(after.contains(&head), "{head} is not in {after:?}");
        }
        assert!(History::new(&columns(&more)).is_ok());
    }

    /// Whatever the names, the history takes the columns; without the list's name it would not.
    #[test]
    fn columns_are_unique_however_the_lists_share_names() {
        let mut same = scene("tank.toml");
        for name in [&mut same.chambers[0].name, &mut same.probes[0].name, &mut same.surfaces[0].name] {
            *name = "a".into();
        }
        assert!(History::new(&columns(&same)).is_ok());
        let [pressure, _] = pressure_columns("a");
        assert!(History::new(&[pressure.clone(), pressure]).is_err());
    }
}
