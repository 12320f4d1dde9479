//! Where vents are: what of the triangles of a wall is the place of each, and before the gas of which chamber.

use glam::DVec3;

use super::error::ModelError;
use super::fronts::{Corners, EVEN_SPLITS, Front, before, is_mixed, middle, quarters};
use crate::geometry::Vessel;
use crate::scene::{Chamber, Disc, Face, Scene, Vent};

/// A triangle is split so often at most where the edge of a vent runs through it, or the border of two chambers through a vent, and no
/// further than this share of the vent's diameter.
const MOST_SPLITS: u32 = 24;
const FINEST: f64 = 1e-3;
/// Share of a vent's place that is rounding.
const LEAST: f64 = 1e-3;

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VentPlace {
    pub chamber: usize,
    /// m2 of wall, or of fabric at the start.
    pub area: f64,
    pub beyond: Beyond,
    /// The fabric, if that is open: gas of one chamber is on both sides, and flows to the side with less pressure.
    pub open_sheet: Option<usize>,
}

/// Where gas goes that passes a vent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Beyond {
    /// Out of the run.
    Nothing,
    /// To the other side of fabric: to the gas of a chamber, or to space that was empty at the start.
    Gas(Option<usize>),
}

pub fn on_face(vent: &Vent, wall: usize, face: Option<Face>) -> bool {
    vent.wall == wall && (vent.face.is_none() || vent.face == face)
}

pub fn corners(vessel: &Vessel, vertices: [u32; 3]) -> Corners {
    vertices.map(|index| DVec3::from(vessel.vertices[index as usize]))
}

pub fn area([a, b, c]: Corners) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// The chamber and the area of the place of each vent on a wall. Where places overlap the earlier vent has the wall.
pub fn places(scene: &Scene, vessel: &Vessel, fronts: &[Option<Front>]) -> Result<Vec<(usize, VentPlace)>, ModelError> {
    let place = |(index, (vent, areas)): (usize, (&Vent, &Vec<f64>))| -> Result<(usize, VentPlace), ModelError> {
        match touched(areas)[..] {
            [chamber] => {
                Ok((index, VentPlace { chamber, area: areas[chamber], beyond: Beyond::Nothing, open_sheet: None }))
            }
            [] => Err(without_gas(scene, vessel, fronts, vent)),
            ref several => {
                Err(ModelError::VentOfSeveral { vent: vent.name.clone(), chambers: names(&scene.chambers, several) })
            }
        }
    };
    let all = areas(scene, vessel, fronts, &scene.vents);
    let on_walls = |(_, (vent, _)): &(usize, (&Vent, &Vec<f64>))| scene.fabric_at(vent.wall).is_none();
    scene.vents.iter().zip(&all).enumerate().filter(on_walls).map(place).collect()
}

/// The chambers of a place, by its areas.
fn touched(areas: &[f64]) -> Vec<usize> {
    let whole: f64 = areas.iter().sum();
    (0..areas.len()).filter(|&chamber| areas[chamber] > LEAST * whole).collect()
}

/// m2 of each of some vents before each chamber.
fn areas(scene: &Scene, vessel: &Vessel, fronts: &[Option<Front>], vents: &[Vent]) -> Vec<Vec<f64>> {
    let mut areas = vec![vec![0.0; scene.chambers.len()]; vents.len()];
    for (triangle, front) in vessel.triangles.iter().zip(fronts) {
        let Some(front) = front else { continue };
        let empties = |vent: &Vent, chamber: usize| vent.chamber.is_none_or(|own| own == chamber);
        let mut here: Vec<usize> =
            (0..vents.len()).filter(|&index| on_face(&vents[index], triangle.wall as usize, triangle.face)).collect();
        let whole = corners(vessel, triangle.vertices);
        let at = |point: DVec3| before(scene, vessel, whole, point);
        let border: Option<&dyn Fn(DVec3) -> Option<usize>> = match front {
            Front::One(chamber) => {
                here.retain(|&index| empties(&vents[index], *chamber));
                None
            }
            Front::Shared(_) => Some(&at),
        };
        let finest = FINEST * whole.iter().map(|corner| corner.distance(middle(whole))).fold(0.0, f64::max);
        let cut = Cut { vents, here: &here, border, finest };
        cut.add(whole, MOST_SPLITS, &mut |part| {
            let chamber = match front {
                Front::One(chamber) => Some(*chamber),
                Front::Shared(_) => at(middle(part)),
            };
            let own = |&&index: &&usize| {
                chamber.is_some_and(|chamber| empties(&vents[index], chamber)) && holds(&vents[index], middle(part))
            };
            if let (Some(chamber), Some(&vent)) = (chamber, here.iter().find(own)) {
                areas[vent][chamber] += area(part);
            }
        });
    }
    areas
}

fn names(chambers: &[Chamber], indices: &[usize]) -> String {
    let names: Vec<String> = indices.iter().map(|&index| format!("\"{}\"", chambers[index].name)).collect();
    names.join(", ")
}

/// Why a vent has no place: its place borders on other chambers than its own, or on none.
fn without_gas(scene: &Scene, vessel: &Vessel, fronts: &[Option<Front>], vent: &Vent) -> ModelError {
    let name = vent.name.clone();
    let Some(own) = vent.chamber else { return ModelError::VentNowhere { vent: name } };
    let of_any = Vent { chamber: None, ..vent.clone() };
    let areas = areas(scene, vessel, fronts, &[of_any]).remove(0);
    let others: Vec<usize> = touched(&areas).into_iter().filter(|&chamber| chamber != own).collect();
    if others.is_empty() || areas[own] > 0.0 {
        return ModelError::VentNowhere { vent: name };
    }
    let (others, own) = (names(&scene.chambers, &others), names(&scene.chambers, &[own]));
    ModelError::VentElsewhere { vent: name, borders: format!("{others}, not on its `chamber`, {own}") }
}

fn holds(vent: &Vent, place: DVec3) -> bool {
    vent.disc.is_none_or(|disc| place.distance(DVec3::from(disc.center)) <= 0.5 * disc.diameter)
}

/// How a triangle is cut into parts that are of a vent or not, and each before the gas of one chamber.
struct Cut<'a> {
    vents: &'a [Vent],
    /// Those that lie on the triangle.
    here: &'a [usize],
    /// The chamber before a point, where several share the triangle.
    border: Option<&'a dyn Fn(DVec3) -> Option<usize>>,
    /// m, of parts on the border of two chambers where a vent has all of the face.
    finest: f64,
}

impl Cut<'_> {
    fn add(&self, triangle: Corners, splits: u32, add: &mut dyn FnMut(Corners)) {
        if self.here.is_empty() {
            return;
        }
        let place = middle(triangle);
        let reach = triangle.iter().map(|corner| corner.distance(place)).fold(0.0, f64::max);
        let away = |disc: &Disc| place.distance(DVec3::from(disc.center)) - 0.5 * disc.diameter;
        let discs = || self.here.iter().filter_map(|&index| self.vents[index].disc.as_ref());
        // Whether the edge of a disc may run through the triangle.
        let cut = |disc: &Disc| away(disc).abs() < reach && reach > FINEST * disc.diameter;
        // The border of two chambers counts where a vent is.
        let finest = self.here.iter().filter_map(|&index| match &self.vents[index].disc {
            None => Some(self.finest),
            Some(disc) => (away(disc) < reach).then_some(FINEST * disc.diameter),
        });
        let finest = finest.reduce(f64::min);
        let is_even = MOST_SPLITS - splits < EVEN_SPLITS;
        let shared = |at: &dyn Fn(DVec3) -> Option<usize>| {
            finest.is_some_and(|finest| is_even || reach > finest && is_mixed(triangle, at))
        };
        if splits > 0 && (discs().any(cut) || self.border.is_some_and(shared)) {
            quarters(triangle).into_iter().for_each(|part| self.add(part, splits - 1, add));
        } else {
            add(triangle);
        }
    }
}
