//! What walls do to the gas that hits them: each wall has a surface model, and named parts of it may have their own.

use super::types::{Face, Scene, Wall};

/// A surface that keeps its temperature and takes heat from the gas, or gives it (specification, section 4 "Rigid wall").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallHeat {
    /// K.
    pub temperature: f64,
    pub transfer: HeatTransfer,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum HeatTransfer {
    /// The share of the hits that leave with the temperature of the wall, 0 to 1.
    Accommodation(f64),
    /// W/(m2 K).
    Coefficient(f64),
}

/// How a surface sends back what hits it. The default is a mirror: smooth and adiabatic.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceModel {
    /// `None`: adiabatic.
    pub heat: Option<WallHeat>,
    /// Share of the other hits that leave in a random direction with the speed they had: a rough wall, without heat.
    pub friction: f64,
}

impl SurfaceModel {
    pub fn is_mirror(&self) -> bool {
        self.heat.is_none() && self.friction == 0.0
    }
}

/// A named part of a wall whose surface differs from the rest of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallPart {
    pub face: Face,
    /// With the wall's where the scene gives none.
    pub surface: SurfaceModel,
}

/// What has one surface model: a wall's part, or what the parts leave of the wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SurfaceId {
    pub wall: usize,
    /// Index in the wall's `parts`.
    pub part: Option<usize>,
}

impl Scene {
    /// All surfaces: each wall's own, then those of its parts.
    pub fn surface_ids(&self) -> impl Iterator<Item = SurfaceId> + '_ {
        let of_wall = |(wall, own): (usize, &Wall)| {
            let parts = (0..own.parts.len()).map(Some);
            std::iter::once(None).chain(parts).map(move |part| SurfaceId { wall, part })
        };
        self.walls.iter().enumerate().flat_map(of_wall)
    }

    pub fn surface_model(&self, id: SurfaceId) -> &SurfaceModel {
        let wall = &self.walls[id.wall];
        id.part.map_or(&wall.surface, |part| &wall.parts[part].surface)
    }

    /// What a triangle of a wall belongs to; `face` is the part of the wall that it is in.
    pub fn surface_of(&self, wall: usize, face: Option<Face>) -> SurfaceId {
        let part = self.walls[wall].parts.iter().position(|part| face == Some(part.face));
        SurfaceId { wall, part }
    }

    /// As reports and columns call it: the wall's name, of a part `wall/part`.
    pub fn surface_name(&self, id: SurfaceId) -> String {
        let wall = &self.walls[id.wall];
        match id.part {
            None => wall.name.clone(),
            Some(part) => format!("{}/{}", wall.name, wall.parts[part].face.name(wall)),
        }
    }

    /// The surfaces that keep a temperature, in the order of [`Scene::surface_ids`].
    pub fn heated_surfaces(&self) -> impl Iterator<Item = (SurfaceId, WallHeat)> + '_ {
        self.surface_ids().filter_map(|id| Some((id, self.surface_model(id).heat?)))
    }

    /// Whether anything exchanges heat with the gas.
    pub fn has_heat(&self) -> bool {
        self.heated_surfaces().next().is_some()
    }

    /// Whether all surfaces are smooth and adiabatic.
    pub fn has_mirrors_only(&self) -> bool {
        self.surface_ids().all(|id| self.surface_model(id).is_mirror())
    }
}
