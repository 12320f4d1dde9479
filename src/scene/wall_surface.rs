//! The keys of the surfaces of walls and fabrics, and of parts that have their own.

use super::errors::{Problem, quote};
use super::numbers::{bounded, not_negative, positive};
use super::parts::Parts;
use super::raw::RawWall;
use super::raw_fabric::RawFabric;
use super::raw_part::RawPart;
use super::raw_values::At;
use super::surface_model::{HeatTransfer, SurfaceModel, SurfacePart, WallHeat};
use super::types::{Face, UnitSystem};
use super::units::Quantity;

#[derive(Clone, Copy)]
struct Keys<'a> {
    /// Whose they are, in words.
    owner: &'static str,
    temperature: Option<&'a At<f64>>,
    accommodation: Option<&'a At<f64>>,
    heat_transfer: Option<&'a At<f64>>,
    friction: Option<&'a At<f64>>,
}

impl<'a> Keys<'a> {
    fn of_wall(raw: &'a RawWall) -> Keys<'a> {
        Keys {
            owner: "wall",
            temperature: raw.temperature.as_ref(),
            accommodation: raw.accommodation.as_ref(),
            heat_transfer: raw.heat_transfer.as_ref(),
            friction: raw.friction.as_ref(),
        }
    }

    fn of_part(raw: &'a RawPart, owner: &'static str) -> Keys<'a> {
        Keys {
            owner,
            temperature: raw.temperature.as_ref(),
            accommodation: raw.accommodation.as_ref(),
            heat_transfer: raw.heat_transfer.as_ref(),
            friction: raw.friction.as_ref(),
        }
    }

    fn of_fabric(raw: &'a RawFabric) -> Keys<'a> {
        Keys {
            owner: "fabric",
            temperature: raw.temperature.as_ref(),
            accommodation: raw.accommodation.as_ref(),
            heat_transfer: raw.heat_transfer.as_ref(),
            friction: raw.friction.as_ref(),
        }
    }

    fn are_none(&self) -> bool {
        [self.temperature, self.accommodation, self.heat_transfer, self.friction].iter().all(Option::is_none)
    }

    /// What is not given is that of the whole; `accommodation` and `heat_transfer` are two ways to say one thing.
    fn or(self, whole: Keys<'a>) -> Keys<'a> {
        let own_transfer = self.accommodation.is_some() || self.heat_transfer.is_some();
        let transfer = if own_transfer { &self } else { &whole };
        Keys {
            owner: self.owner,
            temperature: self.temperature.or(whole.temperature),
            accommodation: transfer.accommodation,
            heat_transfer: transfer.heat_transfer,
            friction: self.friction.or(whole.friction),
        }
    }

    fn model(&self, units: UnitSystem) -> Result<SurfaceModel, Problem> {
        Ok(SurfaceModel { heat: self.heat(units)?, friction: self.friction.map_or(Ok(0.0), |at| share(at, units))? })
    }

    fn heat(&self, units: UnitSystem) -> Result<Option<WallHeat>, Problem> {
        let Some(temperature) = self.temperature else {
            let given = [("accommodation", self.accommodation), ("heat_transfer", self.heat_transfer)];
            return match given.into_iter().find_map(|(key, at)| at.map(|at| (key, at))) {
                None => Ok(None),
                Some((key, at)) => Err(Problem::value(
                    &at.span,
                    format!("`{key}` of a {} without `temperature`", self.owner),
                    format!("`{key}` together with `temperature`"),
                )),
            };
        };
        let transfer = match (self.accommodation, self.heat_transfer) {
            (Some(_), Some(at)) => {
                return Err(Problem::value(
                    &at.span,
                    "both `accommodation` and `heat_transfer`",
                    "at most one of them: each follows from the other and the state of the gas",
                ));
            }
            (None, None) => HeatTransfer::Accommodation(1.0),
            (Some(at), None) => HeatTransfer::Accommodation(share(at, units)?),
            (None, Some(at)) => HeatTransfer::Coefficient(not_negative(at, Quantity::HeatTransfer, units)?),
        };
        Ok(Some(WallHeat { temperature: positive(temperature, Quantity::Temperature, units)?, transfer }))
    }
}

fn share(at: &At<f64>, units: UnitSystem) -> Result<f64, Problem> {
    bounded(at, Quantity::Pure, units, "a number from 0 to 1", |share| (0.0..=1.0).contains(&share))
}

/// The surface model of both sides of a fabric, but those of its parts.
pub(super) fn of_fabric(raw: &RawFabric, units: UnitSystem) -> Result<SurfaceModel, Problem> {
    Keys::of_fabric(raw).model(units)
}

/// The surface model of all that is in none of the wall's parts.
pub(super) fn of_wall(raw: &RawWall, units: UnitSystem) -> Result<SurfaceModel, Problem> {
    Keys::of_wall(raw).model(units)
}

/// The parts of the wall of this index in the scene.
pub(super) fn of_parts_of_wall(
    raw: &RawWall,
    wall: usize,
    names: &Parts,
    units: UnitSystem,
) -> Result<Vec<SurfacePart>, Problem> {
    const WHOLE: &str = "the keys of a whole wall stand in its [[wall]], without a [[wall.part]]";
    let face = |name: &At<String>| names.find_or(name, wall, WHOLE);
    of_parts(&raw.part, Keys::of_wall(raw), "part of a wall", face, units)
}

/// The parts of the fabric of this index in the scene.
pub(super) fn of_parts_of_fabric(
    raw: &RawFabric,
    fabric: usize,
    names: &Parts,
    units: UnitSystem,
) -> Result<Vec<SurfacePart>, Problem> {
    const WHOLE: &str = "the keys of a whole fabric stand in its [[fabric]], without a [[fabric.part]]";
    let face = |name: &At<String>| names.find_of_fabric(name, fabric).map_err(|problem| problem.hint(WHOLE));
    of_parts(&raw.part, Keys::of_fabric(raw), "part of a fabric", face, units)
}

/// Parts that the file calls `owner`; what they do not give is that of the `whole`.
fn of_parts(
    raw: &[At<RawPart>],
    whole: Keys<'_>,
    owner: &'static str,
    face_of: impl Fn(&At<String>) -> Result<Face, Problem>,
    units: UnitSystem,
) -> Result<Vec<SurfacePart>, Problem> {
    let mut parts: Vec<SurfacePart> = Vec::new();
    for at in raw {
        let name = &at.value.face;
        let face = face_of(name)?;
        if let Some(first) = parts.iter().position(|part| part.face == face) {
            let found = format!("{} for the second time", quote(&name.value));
            let problem = Problem::value(&name.span, found, format!("each {owner} once"));
            return Err(problem.clash(&raw[first].value.face.span));
        }
        let own = Keys::of_part(&at.value, owner);
        if own.are_none() {
            let keys = "at least one of `temperature`, `accommodation`, `heat_transfer`, `friction`";
            return Err(Problem::value(&at.span, "a part without a key of its surface", keys));
        }
        parts.push(SurfacePart { face, surface: own.or(whole).model(units)? });
    }
    Ok(parts)
}
