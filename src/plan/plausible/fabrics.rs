//! Materials of membranes that no fabric has.

use super::named::Named;
use super::range::{Kind, range_of};
use crate::scene::{Elasticity, Fabric, Scene};

pub fn doubts(scene: &Scene) -> Vec<Option<String>> {
    let falling = scene.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let all = Named { subject: "the scene".into(), key: "gravity", units: scene.units };
    let mut found = vec![all.check(Kind::Acceleration, falling)];
    found.extend(scene.fabrics.iter().flat_map(|fabric| of_fabric(scene, fabric)));
    found
}

fn of_fabric(scene: &Scene, fabric: &Fabric) -> Vec<Option<String>> {
    let named = |key| Named { subject: format!("fabric `{}`", fabric.name), key, units: scene.units };
    let mut found = vec![fabric.external_pressure.and_then(|outside| {
        let external = named("external_pressure");
        let highest = range_of(Kind::Pressure).most;
        // Vacuum is no mistake.
        external
            .atmosphere(outside)
            .or_else(|| if outside > highest { external.check(Kind::Pressure, outside) } else { None })
    })];
    let Some(membrane) = &fabric.membrane else { return found };
    let material = &membrane.material;
    let moduli = match material.elasticity {
        Elasticity::Isotropic { young, .. } => vec![young],
        Elasticity::Orthotropic { young, .. } | Elasticity::Woven { young, .. } => young.to_vec(),
    };
    found.push(named("thickness").check(Kind::Thickness, material.thickness));
    found.push(named("density").check(Kind::Density, material.density));
    found.push(moduli.into_iter().find_map(|young| named("young").check(Kind::Young, young)));
    found
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::super::by_scene;
    use super::*;
    use crate::scene::{FabricMaterial, Fixed, Membrane, SurfaceModel};

    fn told(material: FabricMaterial) -> String {
        let text = include_str!("../../../scenes/box.toml");
        let mut scene = crate::scene::parse(text, "box.toml", std::path::Path::new("")).expect("a scene");
        scene.fabrics.push(Fabric {
            turn: None,
            name: "bag".into(),
            mesh: PathBuf::new(),
            scale: 1.0,
            motion: None,
            membrane: Some(Membrane {
                material,
                reference: None,
                fixed: Fixed::Nothing,
                reference_scale: 1.0,
                reference_time: None,
                added_mass: 0.0,
                wall_friction: 0.0,
            }),
            surface: SurfaceModel::default(),
            surface_parts: Vec::new(),
            parts: Vec::new(),
            external_pressure: None,
        });
        by_scene(&scene).join("\n")
    }

    /// Numbers in a unit that is not the scene's are told with the unit that they are probably in.
    #[test]
    fn units_by_mistake_are_told() {
        let sound = FabricMaterial {
            thickness: 3.3e-4,
            density: 800.0,
            elasticity: Elasticity::Isotropic { young: 4e8, poisson: 0.3 },
            damping: 0.05,
        };
        let soft = Elasticity::Woven { young: [400.0, 400.0], shear: 5.0, fibre: [1.0, 0.0, 0.0] };
        assert_eq!(told(sound), "");
        for (material, sentence) in [
            (
                FabricMaterial { thickness: 0.33, ..sound },
                "fabric `bag`: thickness 0.33 m, usual is 1e-5 to 0.005 m: is it in mm?",
            ),
            (FabricMaterial { density: 0.8, ..sound }, "is it in g/cm3?"),
            (FabricMaterial { elasticity: soft, ..sound }, "young 400 Pa, usual is"),
            (FabricMaterial { elasticity: soft, ..sound }, "is it in MPa?"),
        ] {
            assert!(told(material).contains(sentence), "{}", told(material));
        }
    }
}
