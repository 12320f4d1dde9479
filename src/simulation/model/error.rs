//! Why a scene cannot be modelled.

use crate::geometry::GeometryError;
use crate::plan::PlanError;

/// A probe or a surface of which a control volume knows nothing.
#[derive(Debug, thiserror::Error, miette::Diagnostic)]
#[error("{what}, ({:.4}, {:.4}, {:.4}) m, is in no chamber: a control volume knows nothing there", point[0], point[1], point[2])]
#[diagnostic(help("move it into the gas, or leave it out"))]
pub struct NoChamber {
    pub(in crate::simulation) what: String,
    pub(in crate::simulation) point: [f64; 3],
}

#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum ModelError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Geometry(#[from] GeometryError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Plan(#[from] PlanError),
    #[error("orifice \"{orifice}\": its disc, {found} lies in or behind a wall")]
    #[diagnostic(help(
        "move `position` into the gas or onto a wall, let `direction` point into the gas, or make `area` smaller (it is in the \
         unit of the scene, length times length); the side of a round wall is of facets, and a flat disc has its middle further in{hint}"
    ))]
    OrificeInWall { orifice: String, found: String, hint: String },
    #[error("orifice \"{orifice}\": `direction` points into the wall: the gas lies behind its disc")]
    #[diagnostic(help("{hint}"))]
    OrificeIntoWall { orifice: String, hint: String },
    #[error(
        "wall \"{wall}\" moves, and is the surface of a space of gas: only bodies with the gas outside of them move"
    )]
    #[diagnostic(help(
        "give the vessel as a wall at rest, and the piston as a body of its own that reaches into its walls"
    ))]
    MovingCavity { wall: String },
    #[error("wall \"{wall}\" sweeps over {what}: what lets gas in or out must stay free of moving walls")]
    #[diagnostic(help("move it out of the box that the wall passes through from its first to its last place"))]
    Swept { what: String, wall: String },
    #[error(
        "chamber \"{chamber}\" is squeezed to {share:.1e} of its volume at {time:.4e} s; a thousandth is the least"
    )]
    #[diagnostic(help("let the wall stop earlier: it must not leave the vessel, nor close a chamber"))]
    Squeezed { chamber: String, share: f64, time: f64 },
    #[error(
        "chamber \"{chamber}\": one side of its box lies in the moving walls {walls}, and can go along with one of them"
    )]
    #[diagnostic(help("let the side lie in the wall that is to take it along"))]
    SideOfTwo { chamber: String, walls: String },
    #[error("fabric \"{fabric}\": {problem}")]
    #[diagnostic(help("see the reference of meshes for what its files hold"))]
    Fabric { fabric: String, problem: String },
    #[error("chamber \"{chamber}\" is inside of the fabric \"{fabric}\", whose surface is open")]
    #[diagnostic(help("close its mesh: each edge is an edge of two triangles; an open sheet has no inside"))]
    OpenFabric { chamber: String, fabric: String },
    #[error("{what} is not possible in a scene with [[fabric]]")]
    #[diagnostic(help(
        "leave it out; the methods `half-turn`, `closest-approach` and `none` know surfaces that deform"
    ))]
    FabricWith { what: String },
    #[error("vent \"{vent}\": no gas lies before its place, or an earlier vent has all of it")]
    #[diagnostic(help("a disc has its centre on the wall, and `face` is a part of it; `chamber` must border on it"))]
    VentNowhere { vent: String },
    #[error("vent \"{vent}\": its place borders on {borders}")]
    #[diagnostic(help("name the chamber whose gas it lets out, or leave `chamber` out"))]
    VentElsewhere { vent: String, borders: String },
    #[error("vent \"{vent}\": its place borders on the chambers {chambers}, and a vent empties one")]
    #[diagnostic(help("say which with `chamber`, or give one vent for each"))]
    VentOfSeveral { vent: String, chambers: String },
    #[error(transparent)]
    #[diagnostic(transparent)]
    NoChamber(#[from] NoChamber),
}
