//! Which triangles of the walls are no mirrors, and what they are: a *placed model* is what a wall, or a part of it, has in one
//! chamber with the same vents, so that one state of the gas and one table entry serve all of it.

use super::error::ModelError;
use super::fabric::Surfaces;
use super::fabric_surfaces::{OnFabric, check_parts};
use super::fronts::Front;
use super::placed_model::PlacedModel;
use super::vent_places::{Beyond, VentPlace, area, corners, on_face, places};
use crate::geometry::{Triangle, Vessel};
use crate::scene::{Disc, Scene};

const NOBODY: u32 = u32::MAX;

#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceModels {
    /// The placed model of each triangle of the vessel, the first of several where chambers share it, or `u32::MAX` for a mirror; empty
    /// if all are.
    pub of_triangle: Vec<u32>,
    /// The same of each triangle of fabric: the first of two, that of the side which its normal points to.
    pub of_sheet: Vec<u32>,
    pub placed: Vec<PlacedModel>,
    /// Of the scene's vents.
    pub vents: Vec<VentPlace>,
    /// Of each vent on fabric its triangles; the area of its place is theirs, wherever they go.
    pub vent_triangles: Vec<Vec<u32>>,
}

impl SurfaceModels {
    /// # Errors
    /// If a vent has no place, or none can say which chamber it empties; if a mesh of fabric has not the parts that the scene names.
    pub fn new(scene: &Scene, vessel: &Vessel, fabric: &Surfaces) -> Result<SurfaceModels, ModelError> {
        check_parts(scene, fabric)?;
        if scene.has_mirrors_only() && scene.vents.is_empty() {
            return Ok(SurfaceModels::default());
        }
        let fronts = fronts(scene, vessel);
        let places = places(scene, vessel, &fronts)?;
        let mut models = SurfaceModels::default();
        // While walls are placed theirs are known alone; those of fabric are on no wall.
        let unplaced = VentPlace { chamber: usize::MAX, area: 0.0, beyond: Beyond::Nothing, open_sheet: None };
        models.vents = vec![unplaced; scene.vents.len()];
        places.into_iter().for_each(|(index, place)| models.vents[index] = place);
        for (triangle, front) in vessel.triangles.iter().zip(&fronts) {
            let index = match front {
                None => NOBODY,
                Some(front) => models.place(scene, vessel, triangle, front),
            };
            models.of_triangle.push(index);
        }
        let on_fabric = OnFabric::new(scene, fabric, models.placed.len())?;
        models.placed.extend(on_fabric.placed);
        models.of_sheet = on_fabric.of_sheet;
        models.vent_triangles = vec![Vec::new(); scene.vents.len()];
        on_fabric.triangles.into_iter().for_each(|(index, own)| models.vent_triangles[index] = own);
        on_fabric.vents.into_iter().for_each(|(index, place)| models.vents[index] = place);
        Ok(models)
    }

    /// The placed model of a triangle, with what of its area is before each chamber.
    fn place(&mut self, scene: &Scene, vessel: &Vessel, triangle: &Triangle, front: &Front) -> u32 {
        let wall = triangle.wall as usize;
        let surface = scene.surface_of(wall, triangle.face);
        let vents_of = |chamber: usize| -> Vec<usize> {
            let on_it = |index: &usize| on_face(&scene.vents[*index], wall, triangle.face);
            (0..scene.vents.len()).filter(|&index| self.vents[index].chamber == chamber).filter(on_it).collect()
        };
        let parts: Vec<(usize, f64, Vec<usize>)> =
            front.shares().into_iter().map(|(chamber, share)| (chamber, share, vents_of(chamber))).collect();
        if scene.surface_model(surface).is_mirror() && parts.iter().all(|(.., vents)| vents.is_empty()) {
            return NOBODY;
        }
        let shared = parts.len() > 1;
        // All chambers of a chain stand one after the other.
        let is_chain = |first: usize| {
            let end = first + parts.len();
            let own = self.placed.get(first..end).unwrap_or_default();
            let same = |(model, (chamber, _, vents)): (&PlacedModel, &(usize, f64, Vec<usize>))| {
                (model.surface, model.chamber, model.shared) == (surface, Some(*chamber), shared)
                    && model.vents == *vents
            };
            own.len() == parts.len() && own.iter().zip(&parts).all(same) && own[parts.len() - 1].next.is_none()
        };
        let known = (0..self.placed.len()).find(|&first| is_chain(first));
        let first = known.unwrap_or(self.placed.len());
        let whole = area(corners(vessel, triangle.vertices));
        for (k, (chamber, share, vents)) in parts.iter().enumerate() {
            if known.is_none() {
                let next = (k + 1 < parts.len()).then_some(first + k + 1);
                let vents = vents.clone();
                let chamber = Some(*chamber);
                self.placed.push(PlacedModel { surface, chamber, area: 0.0, vents, next, shared, inner: false });
            }
            self.placed[first + k].area += share * whole;
        }
        first as u32
    }

    /// Whether some vent is on fabric.
    pub fn has_vents_on_fabric(&self) -> bool {
        self.vent_triangles.iter().any(|own| !own.is_empty())
    }

    /// Whether some vent leads to other gas.
    pub fn has_passages(&self) -> bool {
        self.vents.iter().any(|place| place.beyond != Beyond::Nothing)
    }

    /// Entries of the device's table of vents: a vent that lies on several placed models has several.
    pub fn vent_entries(&self) -> usize {
        self.placed.iter().map(|placed| placed.vents.len()).sum()
    }
}

/// What lies before each triangle that is no mirror, or of whose wall a vent is.
fn fronts(scene: &Scene, vessel: &Vessel) -> Vec<Option<Front>> {
    let front = |triangle: &Triangle| {
        let wall = triangle.wall as usize;
        let vents = || scene.vents.iter().filter(|vent| vent.wall == wall);
        let is_mirror = scene.surface_model(scene.surface_of(wall, triangle.face)).is_mirror();
        if is_mirror && vents().next().is_none() {
            return None;
        }
        let on_it = vents().filter(|vent| on_face(vent, wall, triangle.face));
        let discs: Vec<&Disc> = on_it.filter_map(|vent| vent.disc.as_ref()).collect();
        Some(Front::of(scene, vessel, corners(vessel, triangle.vertices), &discs))
    };
    vessel.triangles.iter().map(front).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulation::Model;

    /// A box in a box: gas in both, and these vents.
    fn model(vents: &str, wall: &str) -> Result<Model, ModelError> {
        let text = format!(
            "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
             [[wall]]\nname = \"outer\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.2, 0.2, 0.2]\ngas = \"inside\"\n{wall}\
             [[wall]]\nname = \"inner\"\nshape = \"box\"\nmin = [0.05, 0.05, 0.05]\nmax = [0.1, 0.1, 0.1]\nthickness = 0.001\n\
             [[chamber]]\nname = \"inside\"\nregion = {{ box = {{ min = [0.05, 0.05, 0.05], max = [0.1, 0.1, 0.1] }} }}\n\
             pressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             [[chamber]]\nname = \"around\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
             {vents}[model]\nparticles = 2000\n"
        );
        Model::new(crate::scene::parse(&text, "test.toml", std::path::Path::new("")).unwrap())
    }

    fn vent(name: &str, keys: &str) -> String {
        format!("[[vent]]\nname = \"{name}\"\ndischarge = 0.1\n{keys}\n")
    }

    const DISC: &str = "wall = \"outer\"\nface = \"+x\"\nposition = [0.2, 0.1, 0.1]\ndiameter = 0.05";

    #[test]
    fn mirrors_have_no_coats() {
        assert_eq!(model("", "").unwrap().surface_models, SurfaceModels::default());
    }

    /// The earlier vent has the disc, the later one the rest of the wall.
    #[test]
    fn places_share_the_wall_in_order() {
        let disc = std::f64::consts::PI * 0.025 * 0.025;
        let close = |found: f64, expected: f64| (found - expected).abs() < 1e-3 * disc;
        let both = vent("disc", DISC) + &vent("all", "wall = \"outer\"");
        let surface_models = model(&both, "").unwrap().surface_models;
        assert!(close(surface_models.vents[0].area, disc), "{} {disc}", surface_models.vents[0].area);
        assert!(close(surface_models.vents[1].area, 0.24 - disc), "{}", surface_models.vents[1].area);
        assert!(surface_models.vents.iter().all(|place| place.chamber == 1));
        // One placed model with both, and one for the other faces.
        assert_eq!((surface_models.placed.len(), surface_models.vent_entries()), (2, 3));
        let area: f64 = surface_models.placed.iter().map(|placed| placed.area).sum();
        assert!((area - 0.24).abs() < 1e-12);
        // The other way round nothing is left for the disc.
        let covered = vent("all", "wall = \"outer\"") + &vent("disc", DISC);
        assert!(matches!(model(&covered, ""), Err(ModelError::VentNowhere { vent }) if vent == "disc"));
        // A place by other gas than that of the vent's chamber is told with that gas.
        let elsewhere = vent("disc", &format!("{DISC}\nchamber = \"inside\""));
        let told = model(&elsewhere, "").err().map(|error| error.to_string()).unwrap_or_default();
        assert!(told.contains("borders on \"around\", not on its `chamber`, \"inside\""), "{told}");
    }

    /// The inner box borders on both chambers; so does its heat.
    #[test]
    fn a_wall_between_chambers_has_a_coat_for_each() {
        let two = vent("two", "wall = \"inner\"");
        let Err(error) = model(&two, "") else { panic!("which chamber?") };
        assert!(error.to_string().contains("\"inside\", \"around\""), "{error}");
        let one = vent("one", "wall = \"inner\"\nchamber = \"inside\"");
        let surface_models = model(&one, "").unwrap().surface_models;
        assert!(
            (surface_models.vents[0].area - 6.0 * 0.05 * 0.05).abs() < 1e-12 && surface_models.vents[0].chamber == 0
        );
        assert_eq!(surface_models.placed.len(), 1);
        let heated = model(&one, "temperature = 400.0\n").unwrap().surface_models;
        assert_eq!(
            heated.placed.iter().map(|placed| (placed.surface.wall, placed.chamber)).collect::<Vec<_>>(),
            [(0, Some(1)), (1, Some(0))]
        );
    }

    /// In a box of two chambers that border in the middle of its faces, a disc is of the chamber that it is before, whatever the triangles of
    /// its face; a face that both share has a model for each, with its share of the area.
    #[test]
    fn a_place_is_of_the_gas_before_it() {
        let two = |vents: &str, wall: &str| {
            let text = format!(
                "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
                 [[wall]]\nname = \"outer\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.25, 0.12, 0.4]\ngas = \"inside\"\n{wall}\
                 [[chamber]]\nname = \"low\"\nregion = {{ box = {{ min = [0, 0, 0], max = [0.25, 0.12, 0.16] }} }}\n\
                 pressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
                 [[chamber]]\nname = \"high\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
                 {vents}[model]\nparticles = 2000\n"
            );
            Model::new(crate::scene::parse(&text, "test.toml", std::path::Path::new("")).unwrap())
        };
        let disc = |z: f64, more: &str| {
            let keys =
                format!("wall = \"outer\"\nface = \"+x\"\nposition = [0.25, 0.06, {z}]\ndiameter = 0.08\n{more}");
            two(&vent("v", &keys), "")
        };
        let full = std::f64::consts::PI * 0.04 * 0.04;
        for (z, chamber) in [(0.06, 0), (0.09, 0), (0.11, 0), (0.21, 1), (0.26, 1), (0.3, 1), (0.34, 1)] {
            let found = disc(z, "").unwrap().surface_models;
            let place = found.vents[0];
            assert!(place.chamber == chamber && (place.area / full - 1.0).abs() < 2e-3, "{z}: {place:?}");
            // What the other chamber has of the face is a mirror.
            let with_vents: Vec<Option<usize>> =
                found.placed.iter().filter(|placed| !placed.vents.is_empty()).map(|placed| placed.chamber).collect();
            assert!(
                with_vents.iter().all(|&own| own == Some(chamber)) && !with_vents.is_empty(),
                "{z}: {:?}",
                found.placed
            );
            let other = disc(z, &format!("chamber = \"{}\"", ["high", "low"][chamber]));
            assert!(matches!(other, Err(ModelError::VentElsewhere { .. })), "{z}");
        }
        let error = disc(0.16, "").err().map(|error| error.to_string()).unwrap_or_default();
        assert!(error.contains("borders on the chambers \"low\", \"high\""), "{error}");
        let half = disc(0.16, "chamber = \"low\"").unwrap().surface_models.vents[0];
        assert!(half.chamber == 0 && (half.area / full - 0.5).abs() < 2e-3, "{half:?}");

        let face = |chamber: &str| vent(chamber, &format!("wall = \"outer\"\nface = \"+x\"\nchamber = \"{chamber}\""));
        let found = two(&(face("low") + &face("high")), "temperature = 300.0\nheat_transfer = 50.0\n").unwrap();
        let areas = found.surface_models.vents.iter().map(|place| place.area / 0.048);
        for (share, expected) in areas.zip([0.4, 0.6]) {
            assert!((share - expected).abs() < 2e-3, "{share} {expected}");
        }
        let of = |chamber: usize| {
            let own = found.surface_models.placed.iter().filter(|placed| placed.chamber == Some(chamber));
            own.map(|placed| placed.area).sum::<f64>()
        };
        let sides = 2.0 * (0.25 + 0.12);
        let expected = [0.16 * sides + 0.03, 0.24 * sides + 0.03];
        for (chamber, expected) in expected.into_iter().enumerate() {
            assert!((of(chamber) / expected - 1.0).abs() < 2e-3, "{chamber}: {} {expected}", of(chamber));
        }
    }

    /// A part has a placed model of its own, the rest of the wall another, whatever a vent on it does; a mirror has none.
    #[test]
    fn parts_have_coats_of_their_own() {
        let part = "[[wall.part]]\nface = \"+x\"\ntemperature = 600.0\n";
        let found = |vents: &str, wall: &str| {
            let Model { scene, surface_models, .. } = model(vents, wall).unwrap();
            let of = |placed: &PlacedModel| {
                (scene.surface_name(placed.surface), (1e4 * placed.area).round() as u32, placed.vents.len())
            };
            surface_models.placed.iter().map(of).collect::<Vec<_>>()
        };
        assert_eq!(found("", part), [("outer/+x".to_string(), 400, 0)]);
        let all = found("", &format!("friction = 0.5\n{part}"));
        assert_eq!(all.len(), 2);
        assert!(all.contains(&("outer/+x".into(), 400, 0)) && all.contains(&("outer".into(), 2000, 0)), "{all:?}");
        assert_eq!(found(&vent("disc", DISC), part), [("outer/+x".to_string(), 400, 1)]);
    }

    /// What a probability cannot pass is told before the run.
    #[test]
    fn a_vent_too_large_for_its_place_is_warned_of() {
        let warnings = |keys: &str| model(&vent("disc", &format!("{DISC}\n{keys}")), "").unwrap().plan.warnings;
        let told = |keys: &str, what: &str| warnings(keys).iter().any(|warning| warning.contains(what));
        // C23 = .1: .0685 of p / sqrt(RT) on all of the place.
        assert!(!told("", "vent `disc`"), "{:?}", warnings(""));
        assert!(told("area = 0.004", "clipped"));
        assert!(told("area = 0.02", "it cannot"));
        let wall = |keys: &str| model("", keys).unwrap().plan.warnings;
        assert!(wall("temperature = 300.0\nheat_transfer = 2e5\n").iter().any(|w| w.contains("heat-transfer")));
        assert!(wall("temperature = 300.0\nheat_transfer = 100.0\n").is_empty());
    }
}
