//! Named parts of walls and fabrics.

/// A named part of a wall or a fabric.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// `axis` 0..3, and whether it is the face at the larger coordinate; of a hollow box that of its cavity.
    Box {
        axis: usize,
        positive: bool,
    },
    /// What is around the shell of a hollow box.
    Outside,
    /// Where the holes of a plane are.
    Plane,
    /// The side of a plane that its normal points out of; the other one; what joins them, walls of holes included.
    Front,
    Back,
    Rim,
    /// The ends and the side of a cylinder.
    Base,
    Top,
    Side,
    /// A part of a mesh, by its place in the `parts` of the shape or the fabric.
    Part(u32),
}

impl Face {
    /// As scenes write it; `parts` are the names of a mesh's parts.
    pub fn name(self, parts: &[String]) -> String {
        match self {
            Face::Box { axis, positive } => format!("{}{}", if positive { '+' } else { '-' }, ["x", "y", "z"][axis]),
            Face::Part(part) => parts.get(part as usize).cloned().unwrap_or_default(),
            Face::Outside => "outside".into(),
            Face::Plane => String::new(),
            Face::Front => "front".into(),
            Face::Back => "back".into(),
            Face::Rim => "rim".into(),
            Face::Base => "base".into(),
            Face::Top => "top".into(),
            Face::Side => "side".into(),
        }
    }
}
