//! What a surface is before the gas of one chamber: a row of the device's table of surface models.

use crate::scene::SurfaceId;

#[derive(Debug, Clone, PartialEq)]
pub struct PlacedModel {
    pub surface: SurfaceId,
    /// None of fabric's side on which no chamber is.
    pub chamber: Option<usize>,
    /// m2; of fabric at the start.
    pub area: f64,
    /// Indices of the scene's vents that lie on it, at least in part.
    pub vents: Vec<usize>,
    /// Of triangles that several chambers share: the model before the gas of the next of them.
    pub next: Option<usize>,
    pub(super) shared: bool,
    /// Of fabric: it is that of the side which normals point away from.
    pub inner: bool,
}

impl PlacedModel {
    /// Of both sides of fabric, that of the side which its normals point to first.
    pub(super) fn of_fabric(
        surface: SurfaceId,
        chambers: [Option<usize>; 2],
        vents: [Vec<usize>; 2],
    ) -> [PlacedModel; 2] {
        let [outside, inside] = chambers;
        let [outwards, inwards] = vents;
        [(outside, outwards, false), (inside, inwards, true)].map(|(chamber, vents, inner)| PlacedModel {
            surface,
            chamber,
            area: 0.0,
            vents,
            next: None,
            shared: false,
            inner,
        })
    }
}
