//! What fabric does to the gas on its sides: which of its triangles are no mirrors, and where its vents are.
//!
//! The triangles of a part of the mesh have the surface model of that part where the scene gives one, the others the fabric's.
//!
//! A vent of fabric is a set of triangles: all, those of a part of the mesh, those whose middles are near a place at the
//! start; of several vents the first has a triangle. The set stays, wherever its triangles go. Gas passes from inside of closed fabric out,
//! and through an open sheet to the side with less pressure.

use glam::DVec3;

use super::error::ModelError;
use super::fabric::{Surface, Surfaces};
use super::placed_model::PlacedModel;
use super::vent_places::{Beyond, VentPlace};
use crate::scene::{Fabric, Face, Scene, Vent};

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
        let faces = faces(&scene.fabrics[index], surface);
        let sides = sides(scene, index, surface.closed);
        let mut areas = vec![0.0; own.len()];
        let mut held = vec![Vec::new(); own.len()];
        let start = self.placed.len();
        for (triangle, corners) in corners.iter().enumerate() {
            let area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            let holder = own.iter().position(|&vent| holds(&scene.vents[vent], faces[triangle], corners));
            if let Some(holder) = holder {
                areas[holder] += area;
                held[holder].push((surface.triangles.start + triangle) as u32);
            }
            let model = scene.surface_of(wall, faces[triangle]);
            if scene.surface_model(model).is_mirror() && holder.is_none() {
                self.of_sheet.push(NOBODY);
                continue;
            }
            let vents: Vec<usize> = holder.map(|holder| own[holder]).into_iter().collect();
            let is_same = |outer: &usize| {
                let inner = &self.placed[outer + 1];
                inner.surface == model && inner.vents == vents
            };
            let known = (start..self.placed.len()).step_by(2).find(is_same);
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
    match vent.face.map(|face| scene.fabrics[index].face_name(face)) {
        Some(name) if !has_part(surface, &name) => {
            Err(refused(&format!("is on its part \"{name}\", and the parts of its mesh are: {}", known_parts(surface))))
        }
        _ => Ok(()),
    }
}

/// That fabrics have the parts that are given surfaces of their own.
///
/// # Errors
/// If a mesh has no triangle of such a part.
pub fn check_parts(scene: &Scene, surfaces: &Surfaces) -> Result<(), ModelError> {
    for (fabric, surface) in scene.fabrics.iter().zip(&surfaces.all) {
        let mut names = fabric.surface_parts.iter().map(|part| fabric.face_name(part.face));
        if let Some(name) = names.find(|name| !has_part(surface, name)) {
            let problem = format!("its mesh has no such part, and the parts of its mesh are: {}", known_parts(surface));
            // Called as its surface is, so that the error has the line of the part.
            return Err(ModelError::Fabric { fabric: format!("{}/{name}", fabric.name), problem });
        }
    }
    Ok(())
}

/// A name without a triangle is no part.
fn has_part(surface: &Surface, name: &str) -> bool {
    surface.parts.iter().flatten().any(|&part| surface.names[part as usize] == name)
}

fn known_parts(surface: &Surface) -> String {
    let known = surface.names.iter().filter(|name| has_part(surface, name));
    let known: Vec<String> = known.map(|name| format!("\"{name}\"")).collect();
    if known.is_empty() { "none".into() } else { known.join(", ") }
}

/// The part of each triangle, if the scene names it.
fn faces(fabric: &Fabric, surface: &Surface) -> Vec<Option<Face>> {
    let face = |name: &String| fabric.parts.iter().position(|used| used == name).map(|part| Face::Part(part as u32));
    let of_name: Vec<Option<Face>> = surface.names.iter().map(face).collect();
    surface.parts.iter().map(|part| part.and_then(|part| of_name[part as usize])).collect()
}

/// Whether a triangle of this part is of a vent.
fn holds(vent: &Vent, face: Option<Face>, corners: &[DVec3; 3]) -> bool {
    let in_part = vent.face.is_none_or(|own| face == Some(own));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::MeshShape;
    use crate::simulation::Model;

    /// A closed cylinder in a box, with these keys of it; the mesh has the parts `side`, `base` and `top`.
    fn model(keys: &str) -> Result<Model, ModelError> {
        let folder = tempfile::tempdir().unwrap();
        let can = MeshShape::Cylinder { radius: 0.03, height: 0.05, around: 12, along: None, closed: true };
        can.mesh([0.05; 3]).unwrap().write(&folder.path().join("can.obj"), 1.0).unwrap();
        let text = format!(
            "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
             [[chamber]]\nname = \"in\"\ninside = \"bag\"\npressure = 2e5\ntemperature = 300.0\ngas = \"air\"\n\
             [[chamber]]\nname = \"out\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             [[fabric]]\nname = \"bag\"\nfile = \"can.obj\"\n{keys}\n[model]\nmethod = \"none\"\nparticles = 2000\n"
        );
        Model::new(crate::scene::parse(&text, "test.toml", folder.path()).unwrap())
    }

    fn part(face: &str, keys: &str) -> String {
        format!("[[fabric.part]]\nface = \"{face}\"\n{keys}\n")
    }

    /// m2, of the triangles of a part.
    fn area(model: &Model, name: &str) -> f64 {
        let (surface, nodes) = (&model.fabric.all[0], model.fabric.places(0.0));
        let own = model
            .fabric
            .triangles
            .iter()
            .zip(&surface.parts)
            .filter(|(_, part)| part.is_some_and(|part| surface.names[part as usize] == name));
        own.map(|(triangle, _)| {
            let [a, b, c] = triangle.map(|node| DVec3::from(nodes[node as usize]));
            0.5 * (b - a).cross(c - a).length()
        })
        .sum()
    }

    /// The placed models of a part's triangles, outer and inner by turns: the surface, the chamber, the area, m2, and the number of vents.
    fn found(model: &Model, name: &str) -> Vec<(String, Option<usize>, f64, usize)> {
        let surface = &model.fabric.all[0];
        let models = model.surface_models.of_sheet.iter().zip(&surface.parts);
        let own = models.filter(|(_, part)| part.is_some_and(|part| surface.names[part as usize] == name));
        let mut indices: Vec<u32> = own.map(|(index, _)| *index).filter(|&index| index != NOBODY).collect();
        indices.sort_unstable();
        indices.dedup();
        let sides = indices.iter().flat_map(|&outer| &model.surface_models.placed[outer as usize..outer as usize + 2]);
        let told = |placed: &PlacedModel| {
            let name = model.scene.surface_name(placed.surface);
            (name, placed.chamber, placed.area, placed.vents.len())
        };
        sides.map(told).collect()
    }

    /// Whether a part's triangles have one model without vents on both sides, of this surface and area.
    fn has(model: &Model, part: &str, surface: &str, area: f64) -> bool {
        let [outer, inner] = &found(model, part)[..] else { return false };
        let is = |side: &(String, Option<usize>, f64, usize), chamber: usize| {
            side.0 == surface && side.1 == Some(chamber) && (side.2 / area - 1.0).abs() < 1e-9 && side.3 == 0
        };
        is(outer, 1) && is(inner, 0)
    }

    /// The triangles of a part have its model, on both sides, the others that of the fabric; a mirror has none.
    #[test]
    fn parts_have_models_of_their_own() {
        let hot = part("top", "temperature = 600.0");
        let mirror = model(&hot).unwrap();
        // A polygon of twelve corners in a circle of 3 cm.
        let top = 3.0 * 0.03 * 0.03;
        assert!((area(&mirror, "top") / top - 1.0).abs() < 1e-6, "{}", area(&mirror, "top"));
        assert!(has(&mirror, "top", "bag/top", area(&mirror, "top")), "{:?}", found(&mirror, "top"));
        assert!(found(&mirror, "side").is_empty() && found(&mirror, "base").is_empty());

        let warm = model(&format!("temperature = 400.0\n{hot}{}", part("base", "friction = 0.5"))).unwrap();
        for (part, surface) in [("top", "bag/top"), ("base", "bag/base"), ("side", "bag")] {
            assert!(has(&warm, part, surface, area(&warm, part)), "{part}: {:?}", found(&warm, part));
        }

        // A smooth part of rough fabric is a mirror; all else is the fabric's.
        let smooth = model(&format!("friction = 0.5\n{}", part("side", "friction = 0.0"))).unwrap();
        let ends = area(&smooth, "base") + area(&smooth, "top");
        assert!(found(&smooth, "side").is_empty());
        assert!(has(&smooth, "top", "bag", ends) && has(&smooth, "base", "bag", ends), "{:?}", found(&smooth, "top"));
    }

    /// Those triangles of a part that a vent has keep the part's surface.
    #[test]
    fn a_vent_divides_a_part() {
        let vent = "[[vent]]\nname = \"v\"\nfabric = \"bag\"\nface = \"top\"\nposition = [0.05, 0.05, 0.075]\ndiameter = 0.03\n\
                    discharge = 0.1\n";
        let vented = model(&(part("top", "temperature = 600.0") + vent)).unwrap();
        let top = found(&vented, "top");
        assert!(top.len() == 4 && top.iter().all(|side| side.0 == "bag/top"), "{top:?}");
        let inner = || top.iter().filter(|side| side.1 == Some(0));
        let with_vent: f64 = inner().filter(|side| side.3 == 1).map(|side| side.2).sum();
        let all: f64 = inner().map(|side| side.2).sum();
        let place = vented.surface_models.vents[0].area;
        assert!((with_vent / place - 1.0).abs() < 1e-9 && place < 0.9 * all, "{top:?}");
        assert!((all / area(&vented, "top") - 1.0).abs() < 1e-9, "{top:?}");
    }

    #[test]
    fn a_part_that_the_mesh_has_not_is_refused() {
        for keys in ["temperature = 600.0", "friction = 0.0"] {
            let told = model(&part("lid", keys)).err().map(|error| error.to_string()).unwrap_or_default();
            let expected = "fabric \"bag/lid\": its mesh has no such part, and the parts of its mesh are: \"side\", \"base\", \"top\"";
            assert_eq!(told, expected);
        }
    }
}
