//! What can be wrong with the walls of a scene. Each error names the wall, and its file where it has one.

#[derive(Debug, Clone, PartialEq, thiserror::Error, miette::Diagnostic)]
pub enum GeometryError {
    #[error("{wall}: the file cannot be read: {reason}")]
    #[diagnostic(help(
        "give the path of an STL (binary or ASCII) or OBJ file, absolute or relative to the working directory"
    ))]
    Unreadable { wall: String, reason: String },

    #[error("{wall}: there are no triangles in it")]
    #[diagnostic(help("export the surface as triangles or polygons; points, lines and curves are not walls"))]
    Empty { wall: String },

    #[error("{wall}: {count} vertices have a coordinate that is not a finite number (first: {first})")]
    #[diagnostic(help("NaN or infinite coordinates come from a failed export; also check the scale"))]
    NotFinite { wall: String, count: usize, first: String },

    #[error("{wall}: {count} triangles have no area (first: {first})")]
    #[diagnostic(help(
        "remove triangles with equal or collinear corners in the mesh tool (\"remove degenerate faces\")"
    ))]
    Degenerate { wall: String, count: usize, first: String },

    #[error("{wall}: the surface leaks: {count} edges belong to one triangle only (first: {first})")]
    #[diagnostic(help(
        "close the surface: merge vertices that should be one, fill holes, and let neighbouring triangles share whole edges"
    ))]
    OpenEdges { wall: String, count: usize, first: String },

    #[error("{wall}: {count} edges are shared by more than two triangles (first: {first})")]
    #[diagnostic(help(
        "sheets must not meet along an edge; give each sheet a thickness, or delete doubled and internal faces"
    ))]
    CrowdedEdges { wall: String, count: usize, first: String },

    #[error("{wall}: neighbouring triangles are turned opposite ways at {count} edges (first: {first})")]
    #[diagnostic(help(
        "make the orientation consistent in the mesh tool (\"recalculate normals\"); which side they point to is found here"
    ))]
    Orientation { wall: String, count: usize, first: String },

    #[error("{wall}: a part of the surface is inside out, or two cavities overlap (seen at {place})")]
    #[diagnostic(help("parts must not be nested with the same orientation: turn the inner shell round, or delete it"))]
    InsideOut { wall: String, place: String },

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

    #[error("{wall}: the triangle at {place} lies outside the cell grid")]
    OutsideGrid { wall: String, place: String },

    #[error("{wall}: the triangle at {place} has no area once its corners are rounded to {quantum:.3e} m")]
    #[diagnostic(help("remove slivers from the mesh, or use smaller cells"))]
    DegenerateOnGrid { wall: String, place: String, quantum: f64 },
}
