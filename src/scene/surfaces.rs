//! The surfaces of a scene: of each wall its own, and those of its parts.

use super::surface_model::{SurfaceId, SurfaceModel, WallHeat};
use super::types::{Face, Scene, Wall};

impl Scene {
    /// The fabric that an index past those of all walls stands for.
    pub fn fabric_at(&self, wall: usize) -> Option<usize> {
        wall.checked_sub(self.walls.len()).filter(|&index| index < self.fabrics.len())
    }

    /// All surfaces: each wall's own, then those of its parts; then the fabrics.
    pub fn surface_ids(&self) -> impl Iterator<Item = SurfaceId> + '_ {
        let of_wall = |(wall, own): (usize, &Wall)| {
            let parts = (0..own.parts.len()).map(Some);
            std::iter::once(None).chain(parts).map(move |part| SurfaceId { wall, part })
        };
        let of_fabric = |index: usize| SurfaceId { wall: self.walls.len() + index, part: None };
        self.walls.iter().enumerate().flat_map(of_wall).chain((0..self.fabrics.len()).map(of_fabric))
    }

    pub fn surface_model(&self, id: SurfaceId) -> &SurfaceModel {
        if let Some(index) = self.fabric_at(id.wall) {
            return &self.fabrics[index].surface;
        }
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
        if let Some(index) = self.fabric_at(id.wall) {
            return self.fabrics[index].name.clone();
        }
        let wall = &self.walls[id.wall];
        match id.part {
            None => wall.name.clone(),
            Some(part) => format!("{}/{}", wall.name, wall.parts[part].face.name(wall)),
        }
    }

    /// As sentences begin that are about it.
    pub fn surface_title(&self, id: SurfaceId) -> String {
        let kind = if self.fabric_at(id.wall).is_some() { "fabric" } else { "wall" };
        format!("{kind} `{}`", self.surface_name(id))
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
