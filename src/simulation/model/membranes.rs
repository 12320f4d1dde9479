//! What elastic fabric is made of: of each triangle its stress-free shape and material, of each node whether it is held, its added mass and
//! friction.

use glam::DVec3;

use super::error::ModelError;
use super::fabric_obstacles::Bodies;
use crate::fabric::{Elasticity, Element, Hold, Material, Relaxation, longest_step};
use crate::geometry::{TriangleMesh, region_contains};
use crate::scene::{self, Fixed};

/// A step of the fabric is at most this part of the longest stable one: fabric that gas shakes slack and taut by turns loses energy with the
/// square of the step (in `scenes/teabag.toml` .74 % of what the gas does at half of it, .18 % at a quarter).
const CAREFUL: f64 = 0.35;

/// Of all surfaces of a scene, in their order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Membranes {
    pub elements: Vec<Element>,
    pub materials: Vec<Material>,
    /// Of each material.
    pub relaxations: Vec<Relaxation>,
    /// Of each node.
    pub holds: Vec<Hold>,
    /// kg.
    pub added_masses: Vec<f64>,
    /// mu on walls.
    pub frictions: Vec<f64>,
    /// The longest step of the fabric, s; infinite if none is elastic.
    pub longest_step: f64,
    /// Of the thickest, m.
    pub thickest: f64,
    /// kg, of those that are free.
    pub lightest_node: f64,
    /// Of each node, 1/kg; 0 of those that are held.
    pub inverse_masses: Vec<f64>,
    /// What stops nodes.
    pub bodies: Bodies,
}

/// What surfaces are of that are not elastic, beside elastic ones: all of their nodes are held, so that no number of it counts, and it is so thin
/// that it has next to no energy.
const NO_MATERIAL: Material =
    Material { elasticity: Elasticity::Isotropic { young: 1.0, poisson: 0.0 }, density: 1.0, damping: 0.0 };
const NO_THICKNESS: f64 = 1e-12;

impl Membranes {
    pub fn new() -> Membranes {
        Membranes { longest_step: f64::INFINITY, lightest_node: f64::INFINITY, ..Membranes::default() }
    }

    /// Whether some nodes follow a course.
    pub fn is_led(&self) -> bool {
        self.holds.iter().any(|hold| matches!(hold, Hold::Prescribed(_)))
    }

    /// Adds a surface; its mesh is in m.
    ///
    /// # Errors
    /// If its reference is another mesh, or nothing is free to move.
    pub fn add(&mut self, fabric: &scene::Fabric, mesh: &TriangleMesh) -> Result<(), ModelError> {
        let refused = |problem: String| ModelError::Fabric { fabric: fabric.name.clone(), problem };
        let material = self.materials.len();
        let Some(membrane) = &fabric.membrane else {
            self.materials.push(NO_MATERIAL);
            let corners = |triangle: &[u32; 3]| triangle.map(|node| mesh.nodes[node as usize]);
            let element = |triangle| Element::of_places(corners(triangle), NO_THICKNESS, material);
            self.elements.extend(mesh.triangles.iter().map(element));
            self.relaxations.push(Relaxation::NONE);
            self.holds.extend(vec![held(fabric); mesh.nodes.len()]);
            self.added_masses.extend(vec![0.0; mesh.nodes.len()]);
            self.frictions.extend(vec![0.0; mesh.nodes.len()]);
            self.inverse_masses.extend(vec![0.0; mesh.nodes.len()]);
            return Ok(());
        };
        let reference = match &membrane.reference {
            None => mesh.nodes.clone(),
            Some(path) => reference(path, fabric.scale, mesh).map_err(refused)?,
        };
        let mut own = elements(&membrane.material, mesh, &reference, material);
        if let Some(flat) = own.iter().position(|element| element.area() <= 0.0) {
            return Err(refused(format!("triangle {} of what it is free of stress has no area", flat + 1)));
        }
        // Along the normal, which points outwards.
        let pressure = -fabric.external_pressure.unwrap_or(0.0);
        own.iter_mut().for_each(|element| element.pressure = pressure);
        let of = &membrane.material;
        let known = Material { elasticity: elasticity(&of.elasticity), density: of.density, damping: of.damping };
        self.materials.push(known);
        self.relaxations.push(Relaxation { scale: membrane.reference_scale, time: membrane.reference_time });
        // (A small reference is stiff.)
        let shortest = membrane.reference_scale.min(1.0);
        self.longest_step = self.longest_step.min(CAREFUL * shortest * longest_step(&own, &self.materials));
        let holds = holds(&membrane.fixed, mesh, held(fabric));
        if membrane.fixed != Fixed::Nothing && holds.iter().all(|hold| *hold == Hold::Free) {
            return Err(refused(
                "its `fixed` holds none of its nodes: no region has one, or it has no open edge".into(),
            ));
        }
        if !holds.contains(&Hold::Free) {
            return Err(refused(
                "all of its nodes are `fixed`, so that the gas moves none: leave out its `material`".into(),
            ));
        }
        self.thickest = self.thickest.max(of.thickness);
        let mut added = vec![0.0; mesh.nodes.len()];
        let mut masses = added.clone();
        for (triangle, element) in mesh.triangles.iter().zip(&own) {
            let (more, material) = (membrane.added_mass, of.density * element.thickness);
            for &node in triangle {
                added[node as usize] += more * element.area() / 3.0;
                masses[node as usize] += (more + material) * element.area() / 3.0;
            }
        }
        let free = masses.iter().zip(&holds).filter(|(_, hold)| **hold == Hold::Free).map(|(mass, _)| *mass);
        self.lightest_node = free.fold(self.lightest_node, f64::min);
        let inverse = |(mass, hold): (&f64, &Hold)| if *hold == Hold::Free { 1.0 / mass } else { 0.0 };
        self.inverse_masses.extend(masses.iter().zip(&holds).map(inverse));
        self.elements.extend(own);
        self.holds.extend(holds);
        self.added_masses.extend(added);
        self.frictions.extend(vec![membrane.wall_friction; mesh.nodes.len()]);
        Ok(())
    }
}

fn elasticity(of: &scene::Elasticity) -> Elasticity {
    match *of {
        scene::Elasticity::Isotropic { young, poisson } => Elasticity::Isotropic { young, poisson },
        scene::Elasticity::Orthotropic { young, poisson, shear, .. } => {
            Elasticity::Orthotropic { young, poisson, shear }
        }
        scene::Elasticity::Woven { young, shear, .. } => Elasticity::Woven { young, shear },
    }
}

/// The triangles with nodes at the places of a reference, m.
fn elements(of: &scene::FabricMaterial, mesh: &TriangleMesh, reference: &[[f64; 3]], material: usize) -> Vec<Element> {
    let fibre = match of.elasticity {
        scene::Elasticity::Isotropic { .. } => None,
        scene::Elasticity::Orthotropic { fibre, .. } | scene::Elasticity::Woven { fibre, .. } => {
            Some(DVec3::from(fibre))
        }
    };
    let element = |triangle: &[u32; 3]| {
        let corners = triangle.map(|node| reference[node as usize]);
        let [a, b, c] = corners.map(DVec3::from);
        let along = (b - a).normalize_or_zero();
        let across = (b - a).cross(c - a).cross(b - a).normalize_or_zero();
        let angle = fibre.map_or(0.0, |fibre| libm::atan2(fibre.dot(across), fibre.dot(along)));
        Element { fibre: angle, ..Element::of_places(corners, of.thickness, material) }
    };
    mesh.triangles.iter().map(element).collect()
}

/// Where the nodes of a mesh are free of stress, m.
fn reference(path: &std::path::Path, scale: f64, mesh: &TriangleMesh) -> Result<Vec<[f64; 3]>, String> {
    let mut read = TriangleMesh::read(path).map_err(|error| error.to_string())?;
    read.nodes.iter_mut().flatten().for_each(|x| *x *= scale);
    // (The mesh may have been turned outwards.)
    let sorted = |triangles: &[[u32; 3]]| -> Vec<[u32; 3]> {
        let sorted = |mut corners: [u32; 3]| {
            corners.sort_unstable();
            corners
        };
        triangles.iter().copied().map(sorted).collect()
    };
    if read.nodes.len() != mesh.nodes.len() || sorted(&read.triangles) != sorted(&mesh.triangles) {
        return Err(format!(
            "its reference {} has {} nodes and {} triangles, and its mesh {} and {}: they must be one mesh, in one order",
            path.display(),
            read.nodes.len(),
            read.triangles.len(),
            mesh.nodes.len(),
            mesh.triangles.len()
        ));
    }
    Ok(read.nodes)
}

/// How nodes of a fabric are held that are.
fn held(fabric: &scene::Fabric) -> Hold {
    if fabric.motion.is_some() || fabric.turn.is_some() { Hold::Prescribed([0.0; 3]) } else { Hold::Fixed }
}

fn holds(fixed: &Fixed, mesh: &TriangleMesh, held: Hold) -> Vec<Hold> {
    let mut holds = vec![Hold::Free; mesh.nodes.len()];
    match fixed {
        Fixed::Nothing => {}
        Fixed::Edge => {
            let mut edges = std::collections::HashMap::new();
            for &[a, b, c] in &mesh.triangles {
                for [one, other] in [[a, b], [b, c], [c, a]] {
                    *edges.entry([one.min(other), one.max(other)]).or_insert(0) += 1;
                }
            }
            let open = edges.into_iter().filter(|(_, triangles)| *triangles == 1);
            open.flat_map(|(edge, _)| edge).for_each(|node| holds[node as usize] = held);
        }
        Fixed::Within(regions) => {
            for (hold, &place) in holds.iter_mut().zip(&mesh.nodes) {
                if regions.iter().any(|region| region_contains(region, place)) {
                    *hold = held;
                }
            }
        }
    }
    holds
}
