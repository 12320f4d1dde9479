//! What fabric does to the gas on its sides: which of its triangles are no mirrors, and where its vents are.
//!
//! A vent of fabric is a set of triangles: all, those of a part of the mesh, those whose middles are near a place at the
//! start; of several vents the first has a triangle. The set stays, wherever its triangles go. Gas passes from inside of closed fabric out,
//! and through an open sheet to the side with less pressure.

use glam::DVec3;

use super::error::ModelError;
use super::fabric::{Surface, Surfaces};
use super::placed_model::PlacedModel;
use super::vent_places::{Beyond, VentPlace};
use crate::scene::{Face, Scene, SurfaceId, Vent};

const NOBODY: u32 = u32::MAX;

/// Of all fabrics.
#[derive(Default)]
pub struct OnFabric {
    /// Of each triangle the first of two placed models, that of the side which its normal points to; or `u32::MAX` for a mirror.
    pub of_sheet: Vec<u32>,
    pub placed: Vec<PlacedModel>,
    /// The vents of fabrics, by their indices in the scene.
    pub vents: Vec<(usize, VentPlace)>,
    /// And their triangles.
    pub triangles: Vec<(usize, Vec<u32>)>,
}

impl OnFabric {
    /// `first`: placed models of walls, behind which those of fabric are.
    ///
    /// # Errors
    /// If a vent has no place, or its fabric no inside.
    pub fn new(scene: &Scene, surfaces: &Surfaces, first: usize) -> Result<OnFabric, ModelError> {
        let mut found = OnFabric::default();
        let nodes: Vec<DVec3> = surfaces.places(0.0).into_iter().map(DVec3::from).collect();
        for (index, surface) in surfaces.all.iter().enumerate() {
            let triangles = &surfaces.triangles[surface.triangles.clone()];
            let corners: Vec<[DVec3; 3]> =
                triangles.iter().map(|triangle| triangle.map(|node| nodes[node as usize])).collect();
            found.add(scene, (index, surface), &corners, first)?;
        }
        Ok(found)
    }

    fn add(
        &mut self,
        scene: &Scene,
        (index, surface): (usize, &Surface),
        corners: &[[DVec3; 3]],
        first: usize,
    ) -> Result<(), ModelError> {
        let wall = scene.walls.len() + index;
        let own: Vec<usize> = (0..scene.vents.len()).filter(|&vent| scene.vents[vent].wall == wall).collect();
        for &vent in &own {
            check(scene, &scene.vents[vent], index, surface)?;
        }
        let model = SurfaceId { wall, part: None };
        let is_mirror = scene.surface_model(model).is_mirror();
        let sides = sides(scene, index, surface.closed);
        let mut areas = vec![0.0; own.len()];
        let mut held = vec![Vec::new(); own.len()];
        let start = self.placed.len();
        for (triangle, corners) in corners.iter().enumerate() {
            let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            let holder = own.iter().position(|&vent| holds(scene, &scene.vents[vent], (surface, triangle), corners));
            if let Some(holder) = holder {
                areas[holder] += area;
                held[holder].push((surface.triangles.start + triangle) as u32);
            }
            if is_mirror && holder.is_none() {
                self.of_sheet.push(NOBODY);
                continue;
            }
            let vents: Vec<usize> = holder.map(|holder| own[holder]).into_iter().collect();
            let known = (start..self.placed.len()).step_by(2).find(|&outer| self.placed[outer + 1].vents == vents);
            let outer = known.unwrap_or_else(|| {
                let outwards = if surface.closed { Vec::new() } else { vents.clone() };
                self.placed.extend(PlacedModel::of_fabric(model, sides, [outwards, vents]));
                self.placed.len() - 2
            });
            self.placed[outer..outer + 2].iter_mut().for_each(|side| side.area += area);
            self.of_sheet.push((first + outer) as u32);
        }
        for ((&vent, area), triangles) in own.iter().zip(areas).zip(held) {
            self.triangles.push((vent, triangles));
            self.vents.push((vent, place(scene, (vent, area), (index, surface), sides)?));
        }
        Ok(())
    }
}

/// The chambers on the side that the normals point to, and on the other.
fn sides(scene: &Scene, index: usize, closed: bool) -> [Option<usize>; 2] {
    let rest = scene.chambers.iter().position(|chamber| chamber.inside.is_none());
    let inside = scene.chambers.iter().position(|chamber| chamber.inside == Some(index));
    let outside = if scene.fabrics[index].external_pressure.is_some() { None } else { rest };
    if closed { [outside, inside.or(rest)] } else { [rest, rest] }
}

/// That a vent can be of a fabric.
fn check(scene: &Scene, vent: &Vent, index: usize, surface: &Surface) -> Result<(), ModelError> {
    let refused = |problem: &str| ModelError::Fabric {
        fabric: surface.name.clone(),
        problem: format!("vent \"{}\" {problem}", vent.name),
    };
    if surface.closed && scene.chambers.iter().all(|chamber| chamber.inside != Some(index)) {
        return Err(refused("lets the gas of a chamber out, and none is `inside` of this fabric"));
    }
    if !surface.closed && scene.chambers.iter().all(|chamber| chamber.inside.is_some()) {
        return Err(refused(
            "lets gas through an open sheet, and there is none around it: no chamber is outside of all fabric",
        ));
    }
    if let Some(Face::Part(part)) = vent.face {
        let name = &scene.fabrics[index].parts[part as usize];
        if !surface.names.contains(name) {
            let known: Vec<String> = surface.names.iter().map(|name| format!("\"{name}\"")).collect();
            let has = if known.is_empty() { "none".into() } else { known.join(", ") };
            return Err(refused(&format!("is on its part \"{name}\", and the parts of its mesh are: {has}")));
        }
    }
    Ok(())
}

/// Whether a triangle is of a vent.
fn holds(scene: &Scene, vent: &Vent, (surface, triangle): (&Surface, usize), corners: &[DVec3; 3]) -> bool {
    let in_part = match (vent.face, scene.fabric_at(vent.wall)) {
        (Some(Face::Part(part)), Some(index)) => {
            let own = surface.parts[triangle].map(|own| &surface.names[own as usize]);
            own == Some(&scene.fabrics[index].parts[part as usize])
        }
        _ => true,
    };
    let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
    in_part && vent.disc.is_none_or(|disc| middle.distance(DVec3::from(disc.center)) <= 0.5 * disc.diameter)
}

fn place(
    scene: &Scene,
    (vent, area): (usize, f64),
    (index, surface): (usize, &Surface),
    [outside, inside]: [Option<usize>; 2],
) -> Result<VentPlace, ModelError> {
    let Some(chamber) = inside.filter(|_| area > 0.0) else {
        let problem = format!(
            "vent \"{}\" has no triangle: the middle of none is within half its `diameter` of its `position`, or earlier vents have them",
            scene.vents[vent].name
        );
        return Err(ModelError::Fabric { fabric: surface.name.clone(), problem });
    };
    let gone = scene.fabrics[index].external_pressure.is_some();
    let beyond = if gone { Beyond::Nothing } else { Beyond::Gas(outside) };
    Ok(VentPlace { chamber, area, beyond, open_sheet: (!surface.closed).then_some(index) })
}
