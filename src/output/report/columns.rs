//! What the columns of a history are, by their heads: whose, of which quantity, in which unit; and their groups, a chart each.
//!
//! A head is `OWNER:quantity_unit` (docs/reference/outputs.md), or `quantity_unit` of what belongs to all of the run. Files
//! are in SI; a page shows the units of the scene. Every unit is M^a L^b T^c of the scene's mass, length and time, so that
//! its factor follows from those of the three.

use crate::scene::{Dimension, UnitSystem};

/// Endings of heads: text, powers of mass, length and time, and the unit's name in the three systems. Longer ones first where
/// one ends another.
const UNITS: [(&str, [i32; 3], [&str; 3]); 13] = [
    ("kg_m_s", [1, 1, -1], ["kg m/s", "kg mm/ms", "t mm/s"]),
    ("kg_m3", [1, -3, 0], ["kg/m3", "kg/mm3", "t/mm3"]),
    ("kg_s", [1, 0, -1], ["kg/s", "kg/ms", "t/s"]),
    ("w_m2", [1, 0, -3], ["W/m2", "J/(ms mm2)", "mJ/(s mm2)"]),
    ("m_s", [0, 1, -1], ["m/s", "mm/ms", "mm/s"]),
    ("m3", [0, 3, 0], ["m3", "mm3", "mm3"]),
    ("kg", [1, 0, 0], ["kg", "kg", "t"]),
    ("pa", [1, -1, -2], ["Pa", "GPa", "MPa"]),
    ("j", [1, 2, -2], ["J", "J", "mJ"]),
    ("w", [1, 2, -3], ["W", "J/ms", "mJ/s"]),
    ("k", [0, 0, 0], ["K", "K", "K"]),
    ("m", [0, 1, 0], ["m", "mm", "mm"]),
    ("s", [0, 0, 1], ["s", "ms", "s"]),
];

/// The unit of a column in a scene's system.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// SI units of it.
    pub factor: f64,
    /// Empty of a pure number.
    pub symbol: &'static str,
}

impl Unit {
    fn of(ending: Option<&str>, system: UnitSystem) -> Unit {
        let found = UNITS.iter().find(|(name, ..)| Some(*name) == ending);
        let Some((_, powers, symbols)) = found else { return Unit { factor: 1.0, symbol: "" } };
        let bases = [Dimension::Mass, Dimension::Length, Dimension::Time].map(|base| system.factor(base));
        let factor = bases.iter().zip(powers).map(|(base, &power)| base.powi(power)).product();
        let index = UnitSystem::ALL.iter().position(|&one| one == system).unwrap_or(0);
        Unit { factor, symbol: symbols[index] }
    }

    pub fn time(system: UnitSystem) -> Unit {
        Unit::of(Some("s"), system)
    }

    pub fn length(system: UnitSystem) -> Unit {
        Unit::of(Some("m"), system)
    }

    pub fn velocity(system: UnitSystem) -> Unit {
        Unit::of(Some("m_s"), system)
    }
}

/// What a line of a chart stands for; each is drawn in its own way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    Computed,
    /// Of the control volume.
    Reference,
    /// What a vent's law asks for.
    Wanted,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Meaning {
    /// Empty of what belongs to all of the run.
    pub owner: String,
    /// Without role and component: the chart that it is in.
    pub quantity: String,
    pub role: Role,
    /// An axis, or a gas; empty if there is one only.
    pub component: String,
    pub unit: Unit,
}

impl Meaning {
    pub fn of(head: &str, system: UnitSystem) -> Meaning {
        let (owner, rest) = match head.split_once(":particles:") {
            Some((owner, gas)) => {
                return Meaning {
                    owner: owner.to_owned(),
                    quantity: "particles of each gas".to_owned(),
                    role: Role::Computed,
                    component: gas.to_owned(),
                    unit: Unit::of(None, system),
                };
            }
            None => head.rsplit_once(':').unwrap_or(("", head)),
        };
        let ends = |ending: &str| rest.strip_suffix(ending).and_then(|rest| rest.strip_suffix('_'));
        let unit = UNITS.iter().find_map(|(ending, ..)| ends(ending).map(|name| (name, *ending)));
        let (name, ending) = unit.map_or((rest, None), |(name, ending)| (name, Some(ending)));
        let (name, role) = match (name.strip_prefix("reference_"), name.strip_prefix("wanted_")) {
            (Some(name), _) => (name, Role::Reference),
            (_, Some(name)) => (name, Role::Wanted),
            _ => (name, Role::Computed),
        };
        let axis =
            ["x", "y", "z"].into_iter().find_map(|axis| Some((name.strip_suffix(axis)?.strip_suffix('_')?, axis)));
        let (name, component) = axis.unwrap_or((name, ""));
        Meaning {
            owner: owner.to_owned(),
            quantity: name.replace('_', " "),
            role,
            component: component.to_owned(),
            unit: Unit::of(ending, system),
        }
    }

    /// Of the line, within its chart.
    pub fn label(&self) -> String {
        let owner = if self.owner.is_empty() { "all gas" } else { &self.owner };
        let component = if self.component.is_empty() { String::new() } else { format!(", {}", self.component) };
        let role = match self.role {
            Role::Computed => "",
            Role::Reference => ", control volume",
            Role::Wanted => ", as its law asks",
        };
        format!("{owner}{component}{role}")
    }

    /// With its unit.
    pub fn title(&self) -> String {
        let mut letters = self.quantity.chars();
        let first = letters.next().map(char::to_uppercase);
        let name: String = first.into_iter().flatten().chain(letters).collect();
        if self.unit.symbol.is_empty() { name } else { format!("{name}, {}", self.unit.symbol) }
    }
}

/// Charts that come first, in this order.
const FIRST: [&str; 9] =
    ["pressure", "temperature", "mass flow", "density", "velocity", "particles of each gas", "volume", "heat", "mass"];

/// The columns of each chart, by index, in the order of the page; `time_s` is the axis of all.
pub fn charts(columns: &[Meaning], axis: usize) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (index, column) in columns.iter().enumerate().filter(|(index, _)| *index != axis) {
        let same = |group: &&mut Vec<usize>| {
            let first = &columns[group[0]];
            first.quantity == column.quantity && first.unit == column.unit
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(index),
            None => groups.push(vec![index]),
        }
    }
    let place = |group: &Vec<usize>| {
        let own = FIRST.iter().position(|name| *name == columns[group[0]].quantity).unwrap_or(FIRST.len());
        (columns[group[0]].owner.is_empty(), own)
    };
    groups.sort_by_key(place);
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn meaning(head: &str) -> Meaning {
        Meaning::of(head, UnitSystem::Si)
    }

    #[test]
    fn heads_are_taken_apart() {
        let reference = meaning("inner:reference_pressure_pa");
        assert_eq!((reference.owner.as_str(), reference.quantity.as_str()), ("inner", "pressure"));
        assert_eq!((reference.role, reference.label().as_str()), (Role::Reference, "inner, control volume"));
        assert_eq!(reference.title(), "Pressure, Pa");
        let impulse = meaning("surface:far wall:impulse_x_kg_m_s");
        assert_eq!((impulse.owner.as_str(), impulse.component.as_str()), ("surface:far wall", "x"));
        assert_eq!(impulse.title(), "Impulse, kg m/s");
        // The name of a gas may end like a unit.
        let gas = meaning("inner:particles:argon_k");
        assert_eq!((gas.component.as_str(), gas.unit.symbol), ("argon_k", ""));
        assert_eq!(meaning("vent:wanted_discharge").label(), "vent, as its law asks");
        assert_eq!(meaning("particles").label(), "all gas");
    }

    /// Every factor is the product of powers that the scene's own units have where it has them.
    #[test]
    fn units_are_those_of_the_scene() {
        for system in UnitSystem::ALL {
            for (head, dimension) in [
                ("a:pressure_pa", Dimension::Pressure),
                ("time_s", Dimension::Time),
                ("a:velocity_x_m_s", Dimension::Velocity),
                ("a:mass_flow_kg_s", Dimension::MassFlow),
                ("a:volume_m3", Dimension::Volume),
                ("a:mass_kg", Dimension::Mass),
                ("a:displacement_m", Dimension::Length),
                ("a:temperature_k", Dimension::Temperature),
            ] {
                let unit = Meaning::of(head, system).unit;
                assert!((unit.factor / system.factor(dimension) - 1.0).abs() < 1e-12, "{head}");
                assert_eq!(unit.symbol, system.symbol(dimension), "{head}");
            }
        }
        let joule = |system| Meaning::of("w:heat_j", system).unit;
        assert!((joule(UnitSystem::KgMmMs).factor - 1.0).abs() < 1e-12);
        assert!((joule(UnitSystem::TMmS).factor / 1e-3 - 1.0).abs() < 1e-12);
    }

    /// Each column but the time is in one chart.
    #[test]
    fn every_column_is_drawn_once() {
        let heads = ["time_s", "step_s", "particles", "a:density_kg_m3", "a:pressure_pa", "a:reference_pressure_pa"];
        let columns: Vec<Meaning> = heads.iter().map(|head| meaning(head)).collect();
        assert_eq!(charts(&columns, 0), [vec![4, 5], vec![3], vec![1], vec![2]]);
    }
}
