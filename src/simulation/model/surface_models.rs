//! Which triangles of the walls are no mirrors, and what they are: a *placed model* is what a wall, or a part of it, has in one
//! chamber with the same vents, so that one state of the gas and one table entry serve all of it.

use glam::DVec3;

use super::error::ModelError;
use super::places::chamber_of;
use crate::geometry::Vessel;
use crate::scene::{Chamber, Disc, Scene, SurfaceId, Vent};

const NOBODY: u32 = u32::MAX;
/// Points of a triangle that are asked for the chamber on its gas side: a lattice of this many along each side.
const LATTICE: u32 = 8;
/// A triangle is split so often at most where the edge of a vent runs through it, and no further than this share of the
/// vent's diameter.
const MOST_SPLITS: u32 = 24;
const FINEST: f64 = 1e-3;

#[derive(Debug, Clone, PartialEq, Default)]
pub struct SurfaceModels {
    /// The placed model of each triangle of the vessel, or `u32::MAX` for a mirror; empty if all are.
    pub of_triangle: Vec<u32>,
    pub placed: Vec<PlacedModel>,
    /// Of the scene's vents.
    pub vents: Vec<VentPlace>,
}

#[derive(Debug, Clone, PartialEq)]
pub struct PlacedModel {
    pub surface: SurfaceId,
    pub chamber: usize,
    /// m2.
    pub area: f64,
    /// Indices of the scene's vents that lie on it, at least in part.
    pub vents: Vec<usize>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VentPlace {
    pub chamber: usize,
    /// m2 of wall.
    pub area: f64,
}

impl SurfaceModels {
    /// # Errors
    /// If a vent has no place, or none can say which chamber it empties.
    pub fn new(scene: &Scene, vessel: &Vessel) -> Result<SurfaceModels, ModelError> {
        if scene.has_mirrors_only() && scene.vents.is_empty() {
            return Ok(SurfaceModels::default());
        }
        let mirrors = |id: SurfaceId| scene.surface_model(id).is_mirror();
        let has_vents = |wall: usize| scene.vents.iter().any(|vent| vent.wall == wall);
        let chambers: Vec<Option<usize>> = vessel
            .triangles
            .iter()
            .map(|triangle| {
                let wall = triangle.wall as usize;
                let modelled = !mirrors(scene.surface_of(wall, triangle.face)) || has_vents(wall);
                modelled.then(|| chamber_before(scene, vessel, corners(vessel, triangle.vertices)))
            })
            .collect();
        let places = places(scene, vessel, &chambers)?;
        let mut placed: Vec<PlacedModel> = Vec::new();
        let mut of_triangle = Vec::with_capacity(vessel.triangles.len());
        for (triangle, chamber) in vessel.triangles.iter().zip(&chambers) {
            let Some(chamber) = *chamber else {
                of_triangle.push(NOBODY);
                continue;
            };
            let wall = triangle.wall as usize;
            let surface = scene.surface_of(wall, triangle.face);
            let vents: Vec<usize> = (0..scene.vents.len())
                .filter(|&index| places[index].chamber == chamber && on_face(&scene.vents[index], wall, triangle.face))
                .collect();
            if mirrors(surface) && vents.is_empty() {
                of_triangle.push(NOBODY);
                continue;
            }
            let same =
                |model: &PlacedModel| model.surface == surface && model.chamber == chamber && model.vents == vents;
            let index = placed.iter().position(same).unwrap_or_else(|| {
                placed.push(PlacedModel { surface, chamber, area: 0.0, vents: vents.clone() });
                placed.len() - 1
            });
            placed[index].area += area(corners(vessel, triangle.vertices));
            of_triangle.push(index as u32);
        }
        Ok(SurfaceModels { of_triangle, placed, vents: places })
    }

    /// Entries of the device's table of vents: a vent that lies on several placed models has several.
    pub fn vent_entries(&self) -> usize {
        self.placed.iter().map(|placed| placed.vents.len()).sum()
    }
}

fn on_face(vent: &Vent, wall: usize, face: Option<crate::scene::Face>) -> bool {
    vent.wall == wall && (vent.face.is_none() || vent.face == face)
}

fn corners(vessel: &Vessel, vertices: [u32; 3]) -> [DVec3; 3] {
    vertices.map(|index| DVec3::from(vessel.vertices[index as usize]))
}

fn area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

/// The chamber that most of the triangle's gas side lies in; the last if it faces no gas.
fn chamber_before(scene: &Scene, vessel: &Vessel, [a, b, c]: [DVec3; 3]) -> usize {
    let normal = (b - a).cross(c - a).normalize();
    let (min, max) = vessel.bounds;
    let off = 1e-6 * (DVec3::from(max) - DVec3::from(min)).max_element() * normal;
    let mut found = vec![0; scene.chambers.len()];
    for i in 0..LATTICE {
        for j in 0..LATTICE - i {
            let share = |k: u32| (f64::from(k) + 1.0 / 3.0) / f64::from(LATTICE);
            let point = a + (b - a) * share(i) + (c - a) * share(j) + off;
            if let Some(chamber) = chamber_of(scene, vessel, point.to_array()) {
                found[chamber] += 1;
            }
        }
    }
    let last = found.len() - 1;
    (0..last).fold(last, |best, chamber| if found[chamber] > found[best] { chamber } else { best })
}

/// The chamber and the area of each vent's place. Where places overlap the earlier vent has the wall.
fn places(scene: &Scene, vessel: &Vessel, chambers: &[Option<usize>]) -> Result<Vec<VentPlace>, ModelError> {
    // By vent and chamber.
    let mut areas = vec![vec![0.0; scene.chambers.len()]; scene.vents.len()];
    for (triangle, chamber) in vessel.triangles.iter().zip(chambers) {
        let Some(chamber) = *chamber else { continue };
        let here: Vec<usize> = (0..scene.vents.len())
            .filter(|&index| {
                let vent = &scene.vents[index];
                on_face(vent, triangle.wall as usize, triangle.face) && vent.chamber.is_none_or(|own| own == chamber)
            })
            .collect();
        add_areas(&scene.vents, &here, corners(vessel, triangle.vertices), MOST_SPLITS, &mut |vent, area| {
            areas[vent][chamber] += area;
        });
    }
    let place = |(vent, areas): (&Vent, &Vec<f64>)| -> Result<VentPlace, ModelError> {
        let whole = areas.iter().sum::<f64>();
        let touched: Vec<usize> = (0..areas.len()).filter(|&chamber| areas[chamber] > 1e-6 * whole).collect();
        match touched[..] {
            [chamber] => Ok(VentPlace { chamber, area: areas[chamber] }),
            [] => Err(without_gas(scene, vessel, chambers, vent)),
            _ => Err(ModelError::VentOfSeveral { vent: vent.name.clone(), chambers: names(&scene.chambers, &touched) }),
        }
    };
    scene.vents.iter().zip(&areas).map(place).collect()
}

fn names(chambers: &[Chamber], indices: &[usize]) -> String {
    let names: Vec<String> = indices.iter().map(|&index| format!("\"{}\"", chambers[index].name)).collect();
    names.join(", ")
}

/// Why a vent has no place: its place borders on other chambers than its own, or on none.
fn without_gas(scene: &Scene, vessel: &Vessel, chambers: &[Option<usize>], vent: &Vent) -> ModelError {
    let name = vent.name.clone();
    let Some(own) = vent.chamber else { return ModelError::VentNowhere { vent: name } };
    let mut areas = vec![0.0; scene.chambers.len()];
    for (triangle, chamber) in vessel.triangles.iter().zip(chambers) {
        let Some(chamber) = chamber.filter(|_| on_face(vent, triangle.wall as usize, triangle.face)) else { continue };
        let corners = corners(vessel, triangle.vertices);
        add_areas(std::slice::from_ref(vent), &[0], corners, MOST_SPLITS, &mut |_, area| areas[chamber] += area);
    }
    let others: Vec<usize> = (0..areas.len()).filter(|&chamber| chamber != own && areas[chamber] > 0.0).collect();
    if others.is_empty() || areas[own] > 0.0 {
        return ModelError::VentNowhere { vent: name };
    }
    let (others, own) = (names(&scene.chambers, &others), names(&scene.chambers, &[own]));
    ModelError::VentElsewhere { vent: name, borders: format!("{others}, not on its `chamber`, {own}") }
}

/// Adds the parts of a triangle to the first vent that holds them.
fn add_areas(vents: &[Vent], here: &[usize], triangle: [DVec3; 3], splits: u32, add: &mut dyn FnMut(usize, f64)) {
    if here.is_empty() {
        return;
    }
    let [a, b, c] = triangle;
    let middle = (a + b + c) / 3.0;
    let reach = triangle.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
    let holds = |disc: &Disc| middle.distance(DVec3::from(disc.center)) <= 0.5 * disc.diameter;
    // Whether the edge of a disc may run through the triangle.
    let cut = |disc: &Disc| {
        let away = middle.distance(DVec3::from(disc.center)) - 0.5 * disc.diameter;
        away.abs() < reach && reach > FINEST * disc.diameter
    };
    let discs = || here.iter().filter_map(|&index| vents[index].disc.as_ref());
    if splits > 0 && discs().any(cut) {
        let [ab, bc, ca] = [(a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0];
        for part in [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]] {
            add_areas(vents, here, part, splits - 1, add);
        }
    } else if let Some(&first) = here.iter().find(|&&index| vents[index].disc.as_ref().is_none_or(holds)) {
        add(first, area(triangle));
    }
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
            [(0, 1), (1, 0)]
        );
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
