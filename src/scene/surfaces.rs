//! The surfaces of a scene: of each wall and fabric its own, and those of its parts.

use super::surface_model::{SurfaceId, SurfaceModel, SurfacePart, WallHeat};
use super::types::{Face, Scene};

impl Scene {
    /// The fabric that an index past those of all walls stands for.
    pub fn fabric_at(&self, wall: usize) -> Option<usize> {
        wall.checked_sub(self.walls.len()).filter(|&index| index < self.fabrics.len())
    }

    /// The surface model of a wall or a fabric, and those of its parts.
    fn models_of(&self, wall: usize) -> (&SurfaceModel, &[SurfacePart]) {
        match self.fabric_at(wall).map(|index| &self.fabrics[index]) {
            Some(fabric) => (&fabric.surface, &fabric.surface_parts),
            None => (&self.walls[wall].surface, &self.walls[wall].parts),
        }
    }

    /// All surfaces: each wall's own, then those of its parts; then those of the fabrics in the same way.
    pub fn surface_ids(&self) -> impl Iterator<Item = SurfaceId> + '_ {
        (0..self.walls.len() + self.fabrics.len()).flat_map(|wall| {
            let parts = (0..self.models_of(wall).1.len()).map(Some);
            std::iter::once(None).chain(parts).map(move |part| SurfaceId { wall, part })
        })
    }

    pub fn surface_model(&self, id: SurfaceId) -> &SurfaceModel {
        let (whole, parts) = self.models_of(id.wall);
        id.part.map_or(whole, |part| &parts[part].surface)
    }

    /// What a triangle of a wall or a fabric belongs to; `face` is the part of it that the triangle is in.
    pub fn surface_of(&self, wall: usize, face: Option<Face>) -> SurfaceId {
        let part = self.models_of(wall).1.iter().position(|part| face == Some(part.face));
        SurfaceId { wall, part }
    }

    /// As reports and columns call it: the wall's or the fabric's name, of a part `wall/part`.
    pub fn surface_name(&self, id: SurfaceId) -> String {
        let face = id.part.map(|part| self.models_of(id.wall).1[part].face);
        let (whole, part) = match self.fabric_at(id.wall).map(|index| &self.fabrics[index]) {
            Some(fabric) => (&fabric.name, face.map(|face| fabric.face_name(face))),
            None => (&self.walls[id.wall].name, face.map(|face| self.walls[id.wall].face_name(face))),
        };
        part.map_or_else(|| whole.clone(), |part| format!("{whole}/{part}"))
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
