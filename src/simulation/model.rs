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
use super::outlook::{is_open_to_empty, outlook};
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
         unit of the scene, length times length); the side of a round wall is of facets, and a flat disc has its middle further in"
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
    #[error("vent \"{vent}\": its place borders on {borders}")]
    #[diagnostic(help("name the chamber whose gas it lets out, or leave `chamber` out"))]
    VentElsewhere { vent: String, borders: String },
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
    let empty = vessel.gas_volume() - chamber_volumes.iter().sum::<f64>();
    Measured {
        open_to_empty: empty > 1e-3 * vessel.gas_volume() && is_open_to_empty(scene, vessel),
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
        coated: coats.coats.iter().map(|coat| (coat.surface, coat.chamber)).collect(),
        walls: vessel.walls.iter().enumerate().map(|(index, wall)| measured_wall(vessel, index, wall)).collect(),
    }
}

fn measured_wall(vessel: &Vessel, index: usize, wall: &WallInfo) -> MeasuredWall {
    let (min, max) = extent(vessel, |of, _| of == index);
    let outside = vessel.outside_share(index);
    MeasuredWall { min, max, area: wall.area, volume: wall.volume, cavity: wall.cavity, outside }
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
mod tests;
