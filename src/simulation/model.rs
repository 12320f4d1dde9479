//! From a scene to what a run needs: the vessel, what was measured of it, and the plan. Opens no device.

use glam::DVec3;

use crate::geometry::{GeometryError, Narrowest, Vessel, WallInfo, region_contains};
use crate::plan::{
    Choice, Limit, Measured, MeasuredVent, MeasuredWall, Outlook, Plan, PlanError, Quantity, Reason, choose, limit,
    modelling_errors, plan, significant,
};
use crate::scene::{Dimension, Method, Opening, Orifice, Scene};
use crate::subdomain::Memory;

use super::coats::Coats;
use super::flow_only::{self, Part};
use super::moving::{Moving, extent};
use super::outlook::outlook;
use super::uniform::{Known, NoChamber};

pub struct Model {
    pub scene: Scene,
    pub vessel: Vessel,
    pub plan: Plan,
    pub coats: Coats,
    /// The walls that move; `vessel` has them as they are drawn.
    pub moving: Moving,
    /// m3 of gas in each probe.
    pub probe_volumes: Vec<f64>,
    /// Of a scene that wished an accuracy or had a budget: what was chosen, now part of `scene`, and why.
    pub choice: Option<Choice>,
}

#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum ModelError {
    #[error(transparent)]
    #[diagnostic(transparent)]
    Geometry(#[from] GeometryError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Plan(#[from] PlanError),
    #[error("orifice \"{orifice}\": its disc, {found} lies in or behind a wall")]
    #[diagnostic(help(
        "move `position` into the gas or onto a wall, let `direction` point into the gas, or make `area` smaller (it is in the \
         unit of the scene, length times length)"
    ))]
    OrificeInWall { orifice: String, found: String },
    #[error(
        "wall \"{wall}\" moves, and is the surface of a space of gas: only bodies with the gas outside of them move"
    )]
    #[diagnostic(help(
        "give the vessel as a wall at rest, and the piston as a body of its own that reaches into its walls"
    ))]
    MovingCavity { wall: String },
    #[error("wall \"{wall}\" sweeps over {what}: what lets gas in or out must stay free of moving walls")]
    #[diagnostic(help("move it out of the box that the wall passes through from its first to its last place"))]
    Swept { what: String, wall: String },
    #[error(
        "chamber \"{chamber}\" is squeezed to {share:.1e} of its volume at {time:.4e} s; a thousandth is the least"
    )]
    #[diagnostic(help("let the wall stop earlier: it must not leave the vessel, nor close a chamber"))]
    Squeezed { chamber: String, share: f64, time: f64 },
    #[error(
        "chamber \"{chamber}\": one side of its box lies in the moving walls {walls}, and can go along with one of them"
    )]
    #[diagnostic(help("let the side lie in the wall that is to take it along"))]
    SideOfTwo { chamber: String, walls: String },
    #[error("vent \"{vent}\": no gas lies before its place, or an earlier vent has all of it")]
    #[diagnostic(help("a disc has its centre on the wall, and a face belongs to a box; `chamber` must border on it"))]
    VentNowhere { vent: String },
    #[error("vent \"{vent}\": its place borders on the chambers {chambers}, and a vent empties one")]
    #[diagnostic(help("say which with `chamber`, or give one vent for each"))]
    VentOfSeveral { vent: String, chambers: String },
    #[error(transparent)]
    #[diagnostic(transparent)]
    NoChamber(#[from] NoChamber),
}

impl Model {
    /// # Errors
    /// If the walls are not closed, an orifice is not in the gas, no plan can be made, or a control volume, which the run is or may become,
    /// knows nothing of a probe or a surface.
    pub fn new(mut scene: Scene) -> Result<Model, ModelError> {
        let mut seen = Seen::new(&scene)?;
        let mut choice = None;
        if scene.model.wish.is_any() {
            let (chosen, part) = chosen(&scene, &seen)?;
            if let Some((of_part, seen_of_part)) = part {
                (scene, seen) = (of_part, seen_of_part);
            }
            // From here on the scene is one that says it all, so that it can be resumed and refined as any other.
            scene.model = chosen.request.clone();
            choice = Some(chosen);
        }
        let plan = plan(&scene, &seen.measured)?;
        if plan.method == Method::ControlVolume || scene.model.switch.is_some() {
            Known::of(&scene, &seen.vessel)?;
        }
        if plan.method != Method::ControlVolume {
            check_discs(&scene, &seen.vessel)?;
        }
        let Seen { vessel, coats, moving, probe_volumes, .. } = seen;
        Ok(Model { scene, vessel, plan, coats, moving, probe_volumes, choice })
    }

    /// The plan with the reasons and the forecast of the choice, and what memory it takes, for people. `plan` is what runs
    /// and checkpoints go by.
    pub fn explained(&self) -> Plan {
        let mut plan = self.plan.clone();
        plan.warnings = plan.told();
        plan.inventory.doubts.clear();
        if let Some(choice) = &self.choice {
            choice.explain(&mut plan);
        } else if plan.method != Method::ControlVolume {
            plan.reasons.extend(flow_only::names(&self.scene).into_iter().map(|hole| Reason {
                quantity: format!("hole {hole}"),
                value: "resolved".into(),
                why: "`flow_only` lets a plan with an accuracy or a budget model it".into(),
            }));
        }
        if let Some(memory) = Memory::of(&plan, !self.moving.is_empty()) {
            let value = format!("{} MB", significant(memory.all / 1e6));
            let growth = if plan.method.has_rounds() { "; more where lists of neighbours grow" } else { "" };
            let why = format!(
                "on one device, all particles there: {} bytes per particle, {} per cell{growth}",
                memory.per_particle,
                significant(memory.per_cell)
            );
            plan.reasons.push(Reason { quantity: "device memory".into(), value, why });
        }
        plan
    }

    /// The walls as they are at a time, s.
    pub fn vessel_at(&self, time: f64) -> std::borrow::Cow<'_, Vessel> {
        if self.moving.is_empty() {
            return std::borrow::Cow::Borrowed(&self.vessel);
        }
        std::borrow::Cow::Owned(self.moving.vessel_at(&self.vessel, time))
    }
}

/// What a scene's walls are, and what was measured of them.
struct Seen {
    vessel: Vessel,
    coats: Coats,
    moving: Moving,
    probe_volumes: Vec<f64>,
    measured: Measured,
}

impl Seen {
    fn new(scene: &Scene) -> Result<Seen, ModelError> {
        let vessel = Vessel::build(&scene.walls).map_err(|error| error.told_in(scene.units))?;
        check_orifices(scene, &vessel)?;
        let coats = Coats::new(scene, &vessel)?;
        let moving = Moving::new(scene, &vessel)?;
        let probe_volumes: Vec<f64> = scene.probes.iter().map(|probe| vessel.gas_volume_in(&probe.region)).collect();
        let measured = measured(scene, &vessel, &coats, &moving, &probe_volumes);
        Ok(Seen { vessel, coats, moving, probe_volumes, measured })
    }

    fn outlook(&self, scene: &Scene) -> Outlook {
        outlook(scene, &self.vessel, &self.measured, &self.coats)
    }
}

/// What is chosen for a scene with a wish; with the part of the scene that is left where holes are modelled, if that is the better
/// choice (specification, section 6.2).
fn chosen(scene: &Scene, seen: &Seen) -> Result<(Choice, Option<(Scene, Seen)>), ModelError> {
    let whole = seen.outlook(scene);
    let resolved = choose(scene, &seen.measured, &whole);
    let part = match flow_only::part(scene, &seen.vessel, &seen.measured) {
        None => return Ok((resolved?, None)),
        Some(part) => part,
    };
    let modelled = part.and_then(|part| model_holes((scene, &seen.measured, &whole), part));
    let wish = &scene.model.wish;
    match (resolved, modelled) {
        // What flows into empty space behind a hole no forecast knows either.
        (Err(error @ PlanError::EmptySpace { .. }), _) => Err(error.into()),
        (Ok(mut resolved), Err(why)) => {
            resolved.hole_notes(flow_only::names(scene), &format!("; it cannot be modelled: {why}"));
            Ok((resolved, None))
        }
        (Err(PlanError::Accuracy { asked, floor, best, remedy }), Err(why)) => {
            let remedy = format!("{remedy}; the holes that are `flow_only` cannot be modelled: {why}");
            Err(PlanError::Accuracy { asked, floor, best, remedy }.into())
        }
        (Err(error), Err(_)) => Err(error.into()),
        (Ok(mut resolved), Ok((modelled, ..))) if !modelled.is_better_than(&resolved, wish) => {
            let why = format!("; modelled as a vent it would be no better: {}", modelled.in_short());
            resolved.hole_notes(flow_only::names(scene), &why);
            Ok((resolved, None))
        }
        (resolved, Ok((mut modelled, part, seen))) => {
            let beside = match &resolved {
                Ok(resolved) => format!("resolved: {}", resolved.in_short()),
                Err(error) => format!("resolved, {error}"),
            };
            modelled.holes_modelled(&part.holes, &beside);
            Ok((modelled, Some((part.scene, seen))))
        }
    }
}

/// The choice for a part of the scene whose holes are modelled, or why it cannot be.
fn model_holes(whole: (&Scene, &Measured, &Outlook), part: Part) -> Result<(Choice, Part, Seen), String> {
    let seen = Seen::new(&part.scene).map_err(|error| error.to_string())?;
    let own = seen.outlook(&part.scene);
    let sights = [whole, (&part.scene, &seen.measured, &own)];
    let errors = modelling_errors(sights, &part.kept, &part.vents).map_err(|error| error.to_string())?;
    let outlook = Outlook { modelled: errors, ..own };
    let choice = choose(&part.scene, &seen.measured, &outlook).map_err(|error| format!("then {error}"))?;
    if choice.request.method == Some(Method::None) {
        return Err("free flight through a hole is not the flow of a vent".into());
    }
    let explicit = Scene { model: choice.request.clone(), ..part.scene.clone() };
    let planned = plan(&explicit, &seen.measured).map_err(|error| format!("then {error}"))?;
    for vent in part.vents.iter().filter_map(|&vent| planned.vents.get(vent)) {
        let clipped = |limit: &Limit| !limit.bound.holds(vent.largest_flux);
        if limit(Quantity::VentFlux, planned.method).is_some_and(clipped) {
            return Err(format!(
                "the vent in place of \"{}\" would ask for {} p/sqrt(RT/M) of its face, more than a vent can pass with its enthalpy",
                vent.name,
                significant(vent.largest_flux)
            ));
        }
    }
    Ok((choice, part, seen))
}

/// What the plan needs to know of the geometry.
pub(super) fn measured(
    scene: &Scene,
    vessel: &Vessel,
    coats: &Coats,
    moving: &Moving,
    probe_volumes: &[f64],
) -> Measured {
    let (bounds_min, bounds_max) = moving.bounds(vessel);
    let chamber_volumes = vessel.chamber_volumes(&scene.chambers);
    let Narrowest { gap, body } = vessel.narrowest();
    Measured {
        gas_volume: vessel.gas_volume(),
        motion: moving.measured(&chamber_volumes),
        chamber_volumes,
        bounds_min,
        bounds_max,
        openings: found_openings(scene, vessel),
        smallest_gap: gap,
        thinnest_body: body,
        wall_area: vessel.walls.iter().map(|wall| wall.area).sum(),
        probe_volumes: probe_volumes.to_vec(),
        vents: coats.vents.iter().map(|place| MeasuredVent { chamber: place.chamber, area: place.area }).collect(),
        heated: coats.coats.iter().map(|coat| (coat.wall, coat.chamber)).collect(),
        walls: vessel.walls.iter().enumerate().map(|(index, wall)| measured_wall(vessel, index, wall)).collect(),
    }
}

fn measured_wall(vessel: &Vessel, index: usize, wall: &WallInfo) -> MeasuredWall {
    let (min, max) = extent(vessel, |of, _| of == index);
    MeasuredWall { min, max, area: wall.area, volume: wall.volume, cavity: wall.cavity }
}

/// The chamber that a point of the gas belongs to.
pub fn chamber_of(scene: &Scene, vessel: &Vessel, point: [f64; 3]) -> Option<usize> {
    let holds = |chamber: &crate::scene::Chamber| chamber.region.as_ref().is_none_or(|r| region_contains(r, point));
    if vessel.is_gas(point) { scene.chambers.iter().position(holds) } else { None }
}

fn along(point: [f64; 3], direction: [f64; 3], distance: f64) -> [f64; 3] {
    std::array::from_fn(|axis| point[axis] + direction[axis] * distance)
}

/// Holes of walls that join two chambers.
fn found_openings(scene: &Scene, vessel: &Vessel) -> Vec<Opening> {
    vessel
        .holes
        .iter()
        .filter_map(|hole| {
            // A little beyond either face of the wall.
            let reach = 0.5 * hole.thickness + 1e-3 * hole.area.sqrt();
            let side = |sign: f64| chamber_of(scene, vessel, along(hole.center, hole.normal, sign * reach));
            let (a, b) = (side(-1.0)?, side(1.0)?);
            (a != b).then(|| Opening {
                name: hole.name.clone(),
                between: [a, b],
                area: hole.area,
                // The radius of a round hole: see `gas::discharge`.
                length: 2.0 * hole.area / hole.perimeter,
            })
        })
        .collect()
}

fn orifice_in_wall(scene: &Scene, orifice: &Orifice, point: DVec3) -> ModelError {
    let (factor, unit) = (scene.units.factor(Dimension::Length), scene.units.symbol(Dimension::Length));
    let [x, y, z] = point.to_array().map(|m| significant(m / factor));
    let radius = significant((orifice.area / std::f64::consts::PI).sqrt() / factor);
    let found = format!("of a radius of {radius} {unit}, is not in the gas: ({x}, {y}, {z}) {unit}");
    ModelError::OrificeInWall { orifice: orifice.name.clone(), found }
}

/// The middle of an orifice's disc, lifted a little off its wall, the disc's normal, and its radius, a little less, m.
fn disc_of(orifice: &Orifice) -> (DVec3, DVec3, f64) {
    let radius = (orifice.area / std::f64::consts::PI).sqrt();
    let normal = DVec3::from(orifice.direction);
    (DVec3::from(orifice.position) + normal * (1e-4 * radius), normal, 0.999 * radius)
}

/// A ring of points just inside each orifice's disc must lie in the gas.
fn check_orifices(scene: &Scene, vessel: &Vessel) -> Result<(), ModelError> {
    for orifice in &scene.orifices {
        let (center, normal, radius) = disc_of(orifice);
        let (u, v) = normal.any_orthonormal_pair();
        for k in 0..=8 {
            let angle = std::f64::consts::TAU * f64::from(k) / 8.0;
            let arm = if k == 8 { 0.0 } else { radius };
            let point = center + arm * (libm::cos(angle) * u + libm::sin(angle) * v);
            if !vessel.is_gas(point.into()) {
                return Err(orifice_in_wall(scene, orifice, point));
            }
        }
    }
    Ok(())
}

/// No wall may cross a disc on which particles are born.
fn check_discs(scene: &Scene, vessel: &Vessel) -> Result<(), ModelError> {
    for orifice in &scene.orifices {
        let (center, normal, radius) = disc_of(orifice);
        let corners = vessel.triangles.iter().map(|triangle| triangle.vertices.map(|v| vessel.vertices[v as usize]));
        let crossed = corners.filter_map(|corners| nearest_crossing(corners.map(DVec3::from), center, normal));
        if let Some(point) = crossed.into_iter().find(|point| point.distance(center) < radius) {
            return Err(orifice_in_wall(scene, orifice, point));
        }
    }
    Ok(())
}

/// Where a triangle crosses a plane, the point that is nearest to one of the plane.
fn nearest_crossing(corners: [DVec3; 3], center: DVec3, normal: DVec3) -> Option<DVec3> {
    let above = corners.map(|corner| normal.dot(corner - center));
    let mut ends = (0..3).map(|k| (k, (k + 1) % 3)).filter(|&(a, b)| (above[a] > 0.0) != (above[b] > 0.0));
    let mut end = || ends.next().map(|(a, b)| corners[a].lerp(corners[b], above[a] / (above[a] - above[b])));
    let (from, to) = (end()?, end()?);
    let along = to - from;
    let share = (center - from).dot(along) / along.length_squared();
    // (Of a triangle that touches the plane in a point alone the share is no number.)
    Some(from + along * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Method, parse};
    use crate::subdomain::{Features, Patches};

    fn model(text: &str) -> Model {
        Model::new(parse(text, "test.toml", std::path::Path::new("")).unwrap()).unwrap()
    }

    const BOX: &str = "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
        [[wall]]\nname = \"box\"\nshape = \"box\"\nmin = [0.0, 0.0, 0.0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n\
        [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n";

    fn refusal(text: &str) -> Option<String> {
        let scene = parse(text, "test.toml", std::path::Path::new("")).unwrap();
        Model::new(scene).err().map(|error| error.to_string())
    }

    /// A plate may cross a disc between all points of its ring.
    #[test]
    fn an_orifice_that_a_wall_crosses_is_refused() {
        let with = |height: f64| {
            let plate = format!(
                "[[wall]]\nname = \"plate\"\nshape = \"plane\"\ncenter = [0.05, 0.05, {height}]\nnormal = [0.0, 0.0, 1.0]\n\
                 u = [1.0, 0.0, 0.0]\nsize = [0.12, 0.12]\nthickness = 0.002\n"
            );
            let orifice = "[[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.05, 0.05]\ndirection = [1.0, 0.0, 0.0]\n\
                area = 0.002\ngas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 2.0], [1e-3, 2.0]]\n";
            refusal(&format!("{BOX}{plate}{orifice}"))
        };
        let refused = with(0.06).expect("a plate crosses the disc");
        assert!(
            refused.contains("orifice \"inlet\": its disc, of a radius of 0.02523 m, is not in the gas: ("),
            "{refused}"
        );
        // The disc's radius is 25.2 mm.
        assert_eq!(with(0.0765), None);
    }

    /// An orifice as wide as a cylinder of facets has its ring on their corners; a control volume has no use for its disc.
    #[test]
    fn an_orifice_as_wide_as_its_cylinder_is_for_control_volumes() {
        let with = |share: f64, model: &str| {
            let area = share * std::f64::consts::PI * 0.05 * 0.05;
            refusal(&format!(
                "end_time = 1e-3\n[[gas]]\nname = \"air\"\nmolar_mass = 0.029\ngamma = 1.4\n\
                 [[wall]]\nname = \"tube\"\nshape = \"cylinder\"\nbase = [0.0, 0.0, 0.0]\naxis = [1.0, 0.0, 0.0]\n\
                 radius = 0.05\nheight = 0.2\nsegments = 24\ngas = \"inside\"\n\
                 [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300.0\ngas = \"air\"\n\
                 [[orifice]]\nname = \"inlet\"\nposition = [0.0, 0.0, 0.0]\ndirection = [1.0, 0.0, 0.0]\narea = {area}\n\
                 gas = \"air\"\ntemperature = 300.0\nmass_flow = [[0.0, 0.1], [1e-3, 0.1]]\n[model]\n{model}\n"
            ))
        };
        assert!(with(1.0, "particles = 1000").expect("facets cut some off").contains("not in the gas"));
        assert_eq!(with(1.0, "method = \"control-volume\""), None);
        // The middles of 24 facets are at .997 of the radius.
        assert_eq!(with(0.99, "particles = 1000"), None);
    }

    /// What a run would only find when it switches, or writes its rows, is refused before.
    #[test]
    fn a_probe_that_a_control_volume_does_not_know_is_refused() {
        let probe = "[[probe]]\nname = \"p\"\nregion = { sphere = { center = [-0.01, 0.05, 0.05], radius = 0.03 } }\n";
        let with = |model: &str| refusal(&format!("{BOX}{probe}[model]\n{model}\n"));
        for model in ["switch = 2.5e-4", "method = \"control-volume\""] {
            let refused = with(model).expect(model);
            assert!(refused.contains("the middle of probe \"p\""), "{refused}");
        }
        assert_eq!(with("particles = 1000"), None);
    }

    /// Vents, heat and fast walls by the one table: a vent of more than hits its place for particles alone, heat that is cut for
    /// control volumes too.
    #[test]
    fn what_hits_cannot_carry_is_warned_of() {
        let vent = include_str!("../../scenes/vent.toml");
        let piston = include_str!("../../scenes/piston.toml");
        let warned = |text: &str, method: Method, change: &dyn Fn(&mut Scene), part: &str| {
            let mut scene = parse(text, "test.toml", std::path::Path::new("")).unwrap();
            change(&mut scene);
            scene.model = crate::scene::ModelRequest { method: Some(method), ..Default::default() };
            let plan = Model::new(scene).unwrap().plan;
            plan.warnings.iter().filter(|text| text.contains(part)).count()
        };
        let hot = |scene: &mut Scene| {
            let heat = scene.walls.iter_mut().find_map(|wall| wall.heat.as_mut()).unwrap();
            heat.transfer = crate::scene::HeatTransfer::Coefficient(1e7);
        };
        let [particles, volume] = [Method::ClosestApproach, Method::ControlVolume];
        for method in [particles, volume] {
            assert_eq!(warned(vent, method, &|_| (), "all hits can carry"), 0);
            assert_eq!(warned(vent, method, &hot, "all hits can carry"), 1);
        }
        let wide = |scene: &mut Scene| scene.vents.iter_mut().for_each(|vent| vent.area = Some(1.0));
        assert_eq!(warned(vent, particles, &|_| (), "largest flux"), 0);
        assert!(warned(vent, particles, &wide, "of all hits on it") > 0);
        assert_eq!(warned(vent, volume, &wide, "largest flux"), 0);
        let cold = |scene: &mut Scene| scene.chambers.iter_mut().for_each(|chamber| chamber.temperature = 0.005);
        assert_eq!(warned(piston, particles, &|_| (), "of the coldest gas"), 0);
        assert_eq!(warned(piston, particles, &cold, "of the coldest gas"), 1);
    }

    /// The plan's mass flow of a vent is that of the start: of one that the pressure of the start opens, and of no other.
    #[test]
    fn a_vent_that_is_open_at_the_start_flows_then() {
        let flow = |opening: f64| {
            let mut scene =
                parse(include_str!("../../scenes/vent.toml"), "test.toml", std::path::Path::new("")).unwrap();
            scene.chambers.iter_mut().for_each(|chamber| chamber.pressure = 3e5);
            scene.vents[0].opening_pressure = opening;
            Model::new(scene).unwrap().plan.vents[0].initial_mass_flow
        };
        assert!(flow(0.0) > 0.0);
        assert_eq!((flow(1.0), flow(1e9)), (flow(0.0), 0.0));
    }

    /// What the plan says is left out is what the kernels are compiled without, scene by scene.
    #[test]
    fn kernels_are_compiled_without_what_the_scene_lacks() {
        let helium = include_str!("../../scenes/box.toml").replace("gamma = 1.4", "gamma = 1.6667");
        let scenes = [
            include_str!("../../scenes/box.toml"),
            include_str!("../../scenes/effusion.toml"),
            include_str!("../../scenes/tank.toml"),
            include_str!("../../scenes/vent.toml"),
            include_str!("../../scenes/corner.toml"),
            include_str!("../../scenes/piston.toml"),
            &helium,
        ];
        let mut ever = [[false; 2]; 8];
        for text in scenes {
            let model = model(text);
            let (_, patches) = crate::simulation::setup::patches(&model);
            let patches = Patches {
                surfaces: patches.len(),
                coats: model.coats.coats.len(),
                vents: model.scene.vents.len(),
                motions: model.moving.count(),
            };
            let features = Features::of(&model.plan, patches, false, false);
            let flags = [
                ("collisions", features.collisions),
                ("spin energy", features.spin),
                ("heat capacities that depend on the temperature", features.curves),
                ("inflow", features.orifices),
                ("measured surfaces", features.surfaces),
                ("walls that are no mirrors", features.coats),
                ("vents", features.vents),
                ("walls that move", features.moving),
            ];
            for (index, (name, compiled)) in flags.into_iter().enumerate() {
                assert_eq!(model.plan.left_out.contains(&name), !compiled, "{}: {name}", model.scene.title);
                ever[index][usize::from(compiled)] = true;
            }
        }
        // The check can fail: but for curves, each was once there and once not.
        assert!(ever.iter().enumerate().all(|(index, seen)| index == 2 || (seen[0] && seen[1])), "{ever:?}");
        assert!(model(&helium).plan.left_out.contains(&"spin energy"));
    }
}
