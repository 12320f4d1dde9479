//! What can be wrong with the walls of a scene. Each error names the wall, and its file where it has one; places are
//! told in the scene's unit of length.

use std::fmt;

use crate::scene::{Shape, UnitSystem};
use glam::DVec3;

/// How many offenders an error lists.
const LISTED: usize = 3;
/// How near to 1 the ratio of two units is that are the same.
const SAME: f64 = 1e-9;
/// Names of parts that are listed.
const MOST_NAMES: usize = 24;

/// The first places of an error, each of one point or several (m), and how they are told.
#[derive(Debug, Clone, PartialEq)]
pub struct Places(Box<Listed>);

#[derive(Debug, Clone, PartialEq)]
struct Listed {
    places: Vec<Vec<DVec3>>,
    /// Between the points of a place.
    between: &'static str,
    units: UnitSystem,
    /// m per unit of the mesh file that the places are of.
    file: Option<f64>,
}

impl Places {
    pub(super) fn of(places: impl Iterator<Item = Vec<DVec3>>, between: &'static str) -> Places {
        Places(Box::new(Listed { places: places.take(LISTED).collect(), between, units: UnitSystem::Si, file: None }))
    }

    /// Tells them in the unit of length of these units.
    pub fn told_in(mut self, units: UnitSystem) -> Places {
        self.0.units = units;
        self
    }

    pub(super) fn one(place: DVec3) -> Places {
        Places::of(std::iter::once(vec![place]), "")
    }
}

impl fmt::Display for Places {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Listed { places, between, units, file } = &*self.0;
        let (factor, symbol) = units.length();
        let between = if between.is_empty() { " ".to_string() } else { format!(" {between} ") };
        let listed = |places: &[Vec<DVec3>], factor: f64| {
            let point = |p: &DVec3| format!("({})", p.to_array().map(|x| short(x / factor)).join(", "));
            let place = |points: &Vec<DVec3>| points.iter().map(point).collect::<Vec<_>>().join(&between);
            places.iter().map(place).collect::<Vec<_>>().join("; ")
        };
        write!(f, "in {symbol}: {}", listed(places, factor))?;
        match file {
            // The first is enough to find it there.
            Some(file) if (file / factor - 1.0).abs() > SAME => {
                write!(f, ", in the numbers of the file: {}", listed(&places[..places.len().min(1)], *file))
            }
            _ => Ok(()),
        }
    }
}

/// Five significant digits, without zeros behind them.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.4e}").parse().unwrap_or(x);
    match rounded.abs() {
        // No minus before a zero.
        0.0 => "0".into(),
        small if !(1e-4..1e7).contains(&small) && rounded.is_finite() => format!("{rounded:e}"),
        _ => rounded.to_string(),
    }
}

#[derive(Debug, Clone, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum GeometryError {
    #[error("{wall}: the file cannot be read: {reason}")]
    #[diagnostic(help("give an STL (binary or ASCII) or OBJ file; its path is relative to the folder of the scene"))]
    Unreadable { wall: String, reason: String },

    #[error("{wall}: there are no triangles in it")]
    #[diagnostic(help("export the surface as triangles or polygons; points, lines and curves are not walls"))]
    Empty { wall: String },

    #[error("{wall}: {count} vertices have a coordinate that is not a finite number (first {first})")]
    #[diagnostic(help("NaN or infinite coordinates come from a failed export; also check the scale"))]
    NotFinite { wall: String, count: usize, first: Places },

    #[error("{wall}: {count} triangles have no area (first {first})")]
    #[diagnostic(help("remove triangles with collinear corners in the mesh tool (\"remove degenerate faces\")"))]
    Degenerate { wall: String, count: usize, first: Places },

    #[error("{wall}: the surface leaks: {count} edges belong to one triangle only (first {first})")]
    #[diagnostic(help(
        "close the surface: merge vertices that should be one, fill holes, and let neighbouring triangles share whole edges"
    ))]
    OpenEdges { wall: String, count: usize, first: Places },

    #[error("{wall}: {count} edges are shared by more than two triangles (first {first})")]
    #[diagnostic(help(
        "sheets must not meet along an edge; give each sheet a thickness, or delete doubled and internal faces"
    ))]
    CrowdedEdges { wall: String, count: usize, first: Places },

    #[error("{wall}: neighbouring triangles are turned opposite ways at {count} edges (first {first})")]
    #[diagnostic(help(
        "make the orientation consistent in the mesh tool (\"recalculate normals\"); which side they point to is found here"
    ))]
    Orientation { wall: String, count: usize, first: Places },

    #[error("{wall}: a part of the surface is inside out, or two cavities overlap (seen {place})")]
    #[diagnostic(help("parts must not be nested with the same orientation: turn the inner shell round, or delete it"))]
    InsideOut { wall: String, place: Places },

    #[error("{wall}: the surface crosses itself: {count} pairs of triangles meet beside their edges (first {first})")]
    #[diagnostic(help(
        "repair it in the mesh tool (\"self-intersections\"): cut the parts where they meet, or give bodies that overlap as meshes of their own"
    ))]
    Crossing { wall: String, count: usize, first: Places },

    #[error("{wall}: {count} pairs of triangles are a sheet without thickness in the gas (first {first})")]
    #[diagnostic(help("remove the doubled triangles, or give the sheet a thickness"))]
    Sheet { wall: String, count: usize, first: Places },

    #[error("{wall}: no part is called {part_and_known}")]
    #[diagnostic(help(
        "parts are the solids of an ASCII STL file, and the groups (or objects) of an OBJ file; a binary STL file has none"
    ))]
    NoPart { wall: String, part_and_known: String },

    #[error("{wall}: the surface encloses no volume")]
    #[diagnostic(help("a wall is a closed surface with a solid on one side and gas on the other"))]
    NoVolume { wall: String },

    #[error("{wall}: gas on the {found} side does not fit this shape; allowed: {allowed}")]
    #[diagnostic(help(
        "a shape with a thickness is a solid with gas on both sides; any other has it either inside or outside"
    ))]
    Side { wall: String, found: &'static str, allowed: &'static str },

    #[error("{wall}: {what}")]
    #[diagnostic(help("lengths must be positive and finite, and a box needs min < max on every axis"))]
    Shape { wall: String, what: String },

    #[error("{wall}: hole `{hole}` {what}")]
    #[diagnostic(help(
        "a hole lies wholly within one face of a wall with a thickness (of a box: within the cavity's face), apart from other holes"
    ))]
    Hole { wall: String, hole: String, what: String },

    #[error("no wall encloses the gas")]
    #[diagnostic(help(
        "one closed wall must have the gas inside (`gas = \"inside\"`); solids alone leave the gas unbounded"
    ))]
    Unbounded,

    #[error("the walls leave no space for gas")]
    #[diagnostic(help(
        "gas is where every wall with gas inside encloses it and no solid is; two separate cavities must come from one mesh file"
    ))]
    NoGas,

    #[error("{count} triangles and vertices are more than the 2^32 that fit an index")]
    TooMany { count: usize },

    #[error("{wall}: the triangle {place} lies outside the cell grid")]
    OutsideGrid { wall: String, place: Places },

    #[error("{wall}: the triangle {place} has no area once its corners are rounded to {quantum:.3e} m")]
    #[diagnostic(help("remove slivers from the mesh, or use smaller cells"))]
    DegenerateOnGrid { wall: String, place: Places, quantum: f64 },
}

impl GeometryError {
    /// Tells places in the unit of length of these units.
    pub fn told_in(mut self, units: UnitSystem) -> GeometryError {
        if let Some(places) = self.places() {
            places.0.units = units;
        }
        self
    }

    /// Tells places also as they stand in the wall's file, if it is of one.
    pub(super) fn of_wall(mut self, shape: &Shape) -> GeometryError {
        if let (Shape::Mesh { scale, .. }, Some(places)) = (shape, self.places()) {
            places.0.file = Some(*scale);
        }
        self
    }

    fn places(&mut self) -> Option<&mut Places> {
        use GeometryError::*;
        match self {
            NotFinite { first: places, .. }
            | Degenerate { first: places, .. }
            | OpenEdges { first: places, .. }
            | CrowdedEdges { first: places, .. }
            | Orientation { first: places, .. }
            | Crossing { first: places, .. }
            | Sheet { first: places, .. }
            | InsideOut { place: places, .. }
            | OutsideGrid { place: places, .. }
            | DegenerateOnGrid { place: places, .. } => Some(places),
            Unreadable { .. }
            | Empty { .. }
            | NoPart { .. }
            | NoVolume { .. }
            | Side { .. }
            | Shape { .. }
            | Hole { .. }
            | Unbounded
            | NoGas
            | TooMany { .. } => None,
        }
    }

    pub(super) fn no_part(wall: &str, part: &str, known: Vec<String>) -> GeometryError {
        let names: Vec<String> = known.iter().take(MOST_NAMES).map(|name| format!("`{name}`")).collect();
        let known = match known.len() {
            0 => "the file has no named parts".to_string(),
            count if count > MOST_NAMES => format!("known: {}, and {} more", names.join(", "), count - MOST_NAMES),
            _ => format!("known: {}", names.join(", ")),
        };
        GeometryError::NoPart { wall: wall.into(), part_and_known: format!("`{part}`; {known}") }
    }
}
