//! What a forecast needs to know of the geometry, beside what every plan does: what the columns of the history see,
//! where gas flows in, and which chambers touch without a wall between them.

use crate::scene::SurfaceId;

/// Measured where the scene wishes an accuracy or has a budget.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outlook {
    /// The chamber that each orifice blows into.
    pub sources: Vec<Option<usize>>,
    /// Of each surface of the scene.
    pub surfaces: Vec<SeenSurface>,
    /// Of each probe of the scene.
    pub probes: Vec<SeenProbe>,
    /// Pairs of chambers between which a part of the border is neither wall nor a hole of one.
    pub borders: Vec<[usize; 2]>,
    /// Surfaces that keep a temperature.
    pub heated: Vec<SeenHeat>,
    /// Where vents stand for holes, what that makes of the pressure of each chamber; else empty.
    pub modelled: Vec<Modelled>,
}

/// Relative errors of a pressure by vents that stand for holes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Modelled {
    /// What is behind them is left out, but for the pressure at the start.
    pub left_out: f64,
    /// Their discharge coefficient is known to two per cent.
    pub coefficients: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub struct SeenSurface {
    /// Chambers that press on it, with the area, m2.
    pub faces: Vec<(usize, f64)>,
    /// All of a wall, not a face of it.
    pub whole: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenProbe {
    /// That of its middle.
    pub chamber: usize,
    /// m3 of gas.
    pub volume: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenHeat {
    pub surface: SurfaceId,
    pub chamber: usize,
    /// m2.
    pub area: f64,
}
