//! A plane that parts what two surfaces sweep.

/// A plane with a surface on the side that its normal points away from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    /// m.
    pub point: [f64; 3],
    /// Of unit length.
    pub normal: [f64; 3],
}
