//! Curves, and how far something has moved by one.

/// Piecewise linear; at least one point, strictly increasing abscissae.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    pub points: Vec<[f64; 2]>,
}

/// How far a wall has moved; curves are constant beyond their ends.
#[derive(Debug, Clone, PartialEq)]
pub enum Course {
    /// m/s against s.
    Velocity(Curve),
    /// m against s, from where the wall is drawn; starts at [0, 0].
    Displacement(Curve),
}
