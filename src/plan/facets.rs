//! What facets make of round walls: they keep the volume (`geometry::round`), so no pressure is wrong by them, but not the
//! surface.

use super::Reason;
use super::limits::{Quantity, Warning};
use super::text::significant;
use crate::geometry::facets;
use crate::scene::{Method, Scene, Shape};

pub fn reasons(scene: &Scene, reasons: &mut Vec<Reason>) {
    reasons.extend(scene.walls.iter().filter_map(|wall| {
        let round = facets(&wall.shape)?;
        Some(Reason {
            quantity: format!("wall {}", wall.name),
            value: format!("{} facets", round.count),
            why: format!(
                "they enclose the volume of the round body, and lie up to {} % of its radius beside its surface",
                significant(100.0 * round.stray)
            ),
        })
    }));
}

pub fn warnings(scene: &Scene, method: Method) -> Vec<String> {
    let of_wall = scene.walls.iter().filter_map(|wall| {
        let round = facets(&wall.shape)?;
        let remedy = match wall.shape {
            Shape::Sphere { .. } => "more `subdivisions`",
            _ => "more `segments`",
        };
        Warning::by_table(Quantity::Facets, method, &format!("wall `{}`", wall.name), round.stray, remedy)
    });
    of_wall.map(|warning| warning.text).collect()
}
