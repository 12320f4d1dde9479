//! The patches of walls whose forces are tallied.

use super::build::Model;
use crate::scene::Face;

/// A patch is one face of one wall: of boxes each, of others each that a surface is of, and the rest. Each triangle's patch,
/// and the list of patches; none in a scene without surfaces.
pub fn patches(model: &Model) -> (Vec<u32>, Vec<(u32, Option<Face>)>) {
    let mut patches = Vec::new();
    if model.scene.surfaces.is_empty() {
        return (Vec::new(), patches);
    }
    let of_triangle = model
        .vessel
        .triangles
        .iter()
        .map(|triangle| {
            let measured = |face: &Face| {
                let surfaces = &model.scene.surfaces;
                let of_box = matches!(face, Face::Box { .. });
                of_box || surfaces.iter().any(|s| s.wall == triangle.wall as usize && s.face == Some(*face))
            };
            let key = (triangle.wall, triangle.face.filter(measured));
            let known = patches.iter().position(|patch| *patch == key);
            known.unwrap_or_else(|| {
                patches.push(key);
                patches.len() - 1
            }) as u32
        })
        .collect();
    (of_triangle, patches)
}
