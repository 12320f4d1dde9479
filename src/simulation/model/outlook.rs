//! What a forecast needs to know of the vessel ([`Outlook`]): measured only for scenes that wish an accuracy or have a
//! budget, but for which chambers touch.

use glam::DVec3;

use super::facing::facing;
use super::places::chamber_of;
use super::surface_models::SurfaceModels;
use crate::geometry::{FoundHole, Vessel, region_bounds, region_volume};
use crate::plan::{Measured, Outlook, SeenHeat, SeenProbe, SeenSurface};
use crate::scene::{Opening, Orifice, Region, Scene};

/// Points along an edge of a region's face, around a cylinder, and on a sphere by its square.
const POINTS: u32 = 16;
/// An open border is that much more open than the holes in it.
const OPEN: f64 = 2.0;

pub fn outlook(scene: &Scene, vessel: &Vessel, measured: &Measured, surface_models: &SurfaceModels) -> Outlook {
    let surfaces = scene.surfaces.iter().map(|surface| {
        // A surface without gas before it is refused by the run itself.
        let faces = facing(scene, vessel, surface).unwrap_or_default();
        let faces = faces.iter().map(|face| (face.chamber, face.area)).collect();
        SeenSurface { faces, whole: surface.face.is_none() }
    });
    let probes = scene.probes.iter().map(|probe| {
        let (low, high) = region_bounds(&probe.region);
        let middle = std::array::from_fn(|axis| 0.5 * (low[axis] + high[axis]));
        // One whose middle lies in a wall is taken for the last chamber's, which has the rest of the space.
        let chamber = chamber_of(scene, vessel, middle).unwrap_or(scene.chambers.len() - 1);
        SeenProbe { chamber, volume: vessel.gas_volume_in(&probe.region) }
    });
    let heated = surface_models.placed.iter().filter(|placed| scene.surface_model(placed.surface).heat.is_some());
    Outlook {
        sources: scene.orifices.iter().map(|orifice| source(scene, vessel, orifice)).collect(),
        surfaces: surfaces.collect(),
        probes: probes.collect(),
        borders: measured.touching.clone(),
        heated: heated
            .filter_map(|placed| {
                Some(SeenHeat { surface: placed.surface, chamber: placed.chamber?, area: placed.area })
            })
            .collect(),
        modelled: Vec::new(),
    }
}

/// The chamber that an orifice blows into.
pub fn source(scene: &Scene, vessel: &Vessel, orifice: &Orifice) -> Option<usize> {
    // Just off the wall that an orifice may lie on.
    let radius = (orifice.area / std::f64::consts::PI).sqrt();
    let point = std::array::from_fn(|axis| orifice.position[axis] + 1e-3 * radius * orifice.direction[axis]);
    chamber_of(scene, vessel, point)
}

/// Pairs of chambers that are open to each other over more than the holes of walls between them. What lies in a hole is none of it, also
/// where the hole is covered and joins nothing.
pub fn borders(scene: &Scene, vessel: &Vessel, found: &[Opening]) -> Vec<[usize; 2]> {
    let mut open: Vec<([usize; 2], f64)> = Vec::new();
    for (index, chamber) in scene.chambers.iter().enumerate() {
        let Some(region) = &chamber.region else { continue };
        let lift = 1e-4 * libm::cbrt(region_volume(region));
        for (point, outward, area) in surface_of(region) {
            let at = |distance: f64| chamber_of(scene, vessel, (point + distance * outward).to_array());
            let (Some(inside), Some(outside)) = (at(-lift), at(lift)) else { continue };
            if inside != index || outside == index || vessel.holes.iter().any(|hole| is_in_hole(hole, point, 0.0)) {
                continue;
            }
            let pair = [index.min(outside), index.max(outside)];
            match open.iter_mut().find(|known| known.0 == pair) {
                Some(known) => known.1 += area,
                None => open.push((pair, area)),
            }
        }
    }
    let holes = |pair: [usize; 2]| -> f64 {
        let declared = scene.openings.iter().filter(|own| found.iter().all(|found| found.name != own.name));
        let joins = |opening: &&Opening| opening.between == pair || opening.between == [pair[1], pair[0]];
        found.iter().chain(declared).filter(joins).map(|opening| opening.area).sum()
    };
    open.into_iter().filter(|&(pair, area)| area > (OPEN - 1.0) * holes(pair)).map(|(pair, _)| pair).collect()
}

/// Whether a place lies in a hole, its ends included, or before it by no more than `before`, m.
pub(super) fn is_in_hole(hole: &FoundHole, place: DVec3, before: f64) -> bool {
    let (middle, normal) = (DVec3::from(hole.center), DVec3::from(hole.normal));
    let rounding = 1e-6 * hole.perimeter;
    if (place - middle).dot(normal).abs() > 0.5 * hole.thickness + before + rounding {
        return false;
    }
    let corners: Vec<DVec3> = hole.outline.iter().map(|&corner| DVec3::from(corner)).collect();
    let beside = |k: usize| {
        let (from, to) = (corners[k], corners[(k + 1) % corners.len()]);
        (to - from).cross(place - from).dot(normal)
    };
    // The outline may run either way round.
    let (least, most) = (0..corners.len()).map(beside).fold((0.0, 0.0), |(a, b), x| (f64::min(a, x), f64::max(b, x)));
    let rounding = rounding * hole.perimeter;
    least >= -rounding || most <= rounding
}

/// Whether chambers border, over more than the holes of walls, on gas space that is in no chamber.
pub fn is_open_to_empty(scene: &Scene, vessel: &Vessel) -> bool {
    let mut open = 0.0;
    for (index, chamber) in scene.chambers.iter().enumerate() {
        let Some(region) = &chamber.region else { continue };
        let lift = 1e-4 * libm::cbrt(region_volume(region));
        for (point, outward, area) in surface_of(region) {
            let [inside, outside] = [-lift, lift].map(|distance| (point + distance * outward).to_array());
            let leaves = chamber_of(scene, vessel, inside) == Some(index) && vessel.is_gas(outside);
            if leaves && chamber_of(scene, vessel, outside).is_none() {
                open += area;
            }
        }
    }
    open > OPEN * vessel.holes.iter().map(|hole| hole.area).sum::<f64>()
}

/// Points of the surface of a region with the unit normal outwards and the area that each stands for, m2.
pub(super) fn surface_of(region: &Region) -> Vec<(DVec3, DVec3, f64)> {
    let count = f64::from(POINTS);
    let place = |k: u32| (f64::from(k) + 0.5) / count;
    let grid = || (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j)));
    match region {
        Region::Box { min, max } => {
            let (low, size) = (DVec3::from(*min), DVec3::from(*max) - DVec3::from(*min));
            let mut points = Vec::new();
            for axis in 0..3 {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let area = size[u] * size[v] / (count * count);
                for end in [0.0, 1.0] {
                    let mut outward = DVec3::ZERO;
                    outward[axis] = 2.0 * end - 1.0;
                    points.extend(grid().map(|(i, j)| {
                        let mut share = DVec3::ZERO;
                        (share[axis], share[u], share[v]) = (end, place(i), place(j));
                        (low + share * size, outward, area)
                    }));
                }
            }
            points
        }
        Region::Sphere { center, radius } => {
            // Equal steps of the height cut a sphere into equal areas.
            let area = 4.0 * std::f64::consts::PI * radius * radius / (count * count);
            grid()
                .map(|(i, j)| {
                    let height = 2.0 * place(i) - 1.0;
                    let angle = std::f64::consts::TAU * place(j);
                    let around = (1.0 - height * height).sqrt();
                    let outward = DVec3::new(around * libm::cos(angle), around * libm::sin(angle), height);
                    (DVec3::from(*center) + *radius * outward, outward, area)
                })
                .collect()
        }
        Region::Cylinder { base, axis, radius, height } => {
            let (base, axis) = (DVec3::from(*base), DVec3::from(*axis).normalize());
            let (u, v) = axis.any_orthonormal_pair();
            let around = |j: u32| {
                let angle = std::f64::consts::TAU * place(j);
                libm::cos(angle) * u + libm::sin(angle) * v
            };
            let side = std::f64::consts::TAU * radius * height / (count * count);
            let end = std::f64::consts::PI * radius * radius / (count * count);
            let sides = grid().map(|(i, j)| (base + height * place(i) * axis + *radius * around(j), around(j), side));
            let ends = [(base, -axis), (base + *height * axis, axis)];
            // Equal steps of the square of the distance cut a disc into equal areas.
            let discs = ends.into_iter().flat_map(|(middle, outward)| {
                grid().map(move |(i, j)| (middle + *radius * place(i).sqrt() * around(j), outward, end))
            });
            sides.chain(discs).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Model;

    /// The areas are those of the shapes, and the points lie on them with their normals outwards.
    #[test]
    fn surfaces_of_regions() {
        let area = |region: &Region| surface_of(region).iter().map(|point| point.2).sum::<f64>();
        let cuboid = Region::Box { min: [0.0; 3], max: [1.0, 2.0, 3.0] };
        assert!((area(&cuboid) - 22.0).abs() < 1e-9);
        let sphere = Region::Sphere { center: [1.0; 3], radius: 2.0 };
        assert!((area(&sphere) - 16.0 * std::f64::consts::PI).abs() < 1e-9);
        let cylinder = Region::Cylinder { base: [0.0; 3], axis: [0.0, 0.0, 1.0], radius: 1.0, height: 2.0 };
        assert!((area(&cylinder) - 6.0 * std::f64::consts::PI).abs() < 1e-9);
        for region in [cuboid, sphere, cylinder] {
            for (point, outward, _) in surface_of(&region) {
                let inside = |by: f64| crate::geometry::region_contains(&region, (point + by * outward).to_array());
                assert!(inside(-1e-6) && !inside(1e-6), "{region:?} {point}");
            }
        }
    }

    fn borders_of(text: &str) -> Vec<[usize; 2]> {
        let scene = crate::scene::parse(text, "test.toml", std::path::Path::new("")).unwrap();
        let Model { scene, vessel, surface_models, moving, .. } = Model::new(scene).unwrap();
        let measured = crate::simulation::model::measure::measured(&scene, &vessel, &surface_models, &moving, &[]);
        outlook(&scene, &vessel, &measured, &surface_models).borders
    }

    /// Chambers on two sides of a wall with a hole do not touch; a corner of a box touches the rest.
    #[test]
    fn chambers_touch_where_no_wall_is() {
        assert!(borders_of(include_str!("../../../scenes/tank.toml")).is_empty());
        assert!(borders_of(include_str!("../../../scenes/effusion.toml")).is_empty());
        assert_eq!(borders_of(include_str!("../../../scenes/corner.toml")), [[0, 1]]);
    }
}
