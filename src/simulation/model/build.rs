//! From a scene to what a run needs: the vessel, what was measured of it, and the plan. Opens no device.

use super::enclosed::{in_bags, nodes_over_volume};
use super::error::ModelError;
use super::fabric::Surfaces;
use super::facing::Known;
use super::flow_only;
use super::flow_only::Part;
use super::measure::measured;
use super::moving::Moving;
use super::orifices::{check_discs, check_orifices};
use super::outlook::outlook;
use super::parting_planes::planes_between;
use super::places::along;
use super::surface_models::SurfaceModels;
use crate::fabric::recoils;
use crate::gas::{Inflow, InflowParticles};
use crate::geometry::Vessel;
use crate::plan::{
    Choice, Limit, Measured, Outlook, Plan, PlanError, Quantity, Reason, choose, limit, modelling_errors,
    notes_of_reach, plan, significant, smoothings,
};
use crate::scene::{Method, Orifice, Scene};
use crate::subdomain::Memory;

pub struct Model {
    pub scene: Scene,
    pub vessel: Vessel,
    pub plan: Plan,
    pub surface_models: SurfaceModels,
    /// The walls that move; `vessel` has them as they are at the start.
    pub moving: Moving,
    /// The surfaces that deform.
    pub fabric: Surfaces,
    /// Of each orifice whether it is inside of closed fabric; at the start, and so for ever.
    pub orifices_inside: Vec<bool>,
    /// m3 of gas in each probe.
    pub probe_volumes: Vec<f64>,
    /// Of a scene that wished an accuracy or had a budget: what was chosen, now part of `scene`, and why.
    pub choice: Option<Choice>,
}

impl Model {
    /// # Errors
    /// If the walls are not closed, an orifice is not in the gas, no plan can be made, or a control volume, which the run is or may become,
    /// knows nothing of a probe or a surface.
    pub fn new(mut scene: Scene) -> Result<Model, ModelError> {
        let mut seen = Survey::new(&scene)?;
        let mut choice = None;
        if scene.model.wish.is_any() && !scene.fabrics.is_empty() {
            return Err(ModelError::FabricWith { what: "`accuracy`, `time_budget` or `particle_budget`".into() });
        }
        if scene.model.wish.is_any() {
            let (chosen, part) = chosen(&scene, &seen)?;
            if let Some((of_part, seen_of_part)) = part {
                (scene, seen) = (of_part, seen_of_part);
            }
            // From here on the scene is one that says it all, so that it can be resumed and refined as any other.
            scene.model = chosen.request.clone();
            choice = Some(chosen);
        }
        let mut plan = plan(&scene, &seen.measured)?;
        plan.inventory.notes.extend(notes_of_reach(&scene, &seen.measured, || seen.outlook(&scene)));
        if plan.method == Method::ControlVolume || scene.model.switch.is_some() {
            Known::of(&scene, &seen.vessel)?;
        }
        refuse_with_fabric(&scene, &plan)?;
        if plan.method != Method::ControlVolume {
            check_discs(&scene, &seen.vessel)?;
        }
        let Survey { vessel, surface_models, moving, fabric, probe_volumes, .. } = seen;
        let orifices_inside = orifices_inside(&scene, &vessel);
        refuse_outer_orifices(&scene, &orifices_inside)?;
        Ok(Model { scene, vessel, plan, surface_models, moving, fabric, orifices_inside, probe_volumes, choice })
    }

    /// Passes of smoothing of what hits give the nodes of elastic fabric.
    pub fn smoothings(&self) -> u32 {
        let lightest = self.fabric.membranes.as_ref().map(|membranes| membranes.lightest_node);
        let heaviest = self.plan.gases.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max);
        lightest.map_or(0, |node| smoothings(heaviest * self.plan.moles_per_particle / node))
    }

    /// The mass of a particle of the heaviest gas over that with which each triangle of elastic fabric recoils from a hit; empty without.
    pub fn recoils(&self) -> Vec<f64> {
        let heaviest = self.plan.gases.iter().map(|gas| gas.molar_mass).fold(0.0, f64::max);
        let mass = heaviest * self.plan.moles_per_particle;
        let of_membranes = self.fabric.membranes.as_ref().map(|membranes| {
            let inverse = recoils(&membranes.inverse_masses, &self.fabric.triangles, self.smoothings());
            inverse.into_iter().map(|inverse| mass * inverse).collect()
        });
        of_membranes.unwrap_or_default()
    }

    /// All that will flow in.
    pub fn inflow(&self) -> Inflow {
        let Model { scene, plan, .. } = self;
        let particles = InflowParticles {
            gases: &plan.species(),
            moles_per_particle: plan.moles_per_particle,
            seed: plan.seed,
            first_id: plan.initial_particles as u32,
        };
        Inflow::new(&scene.orifices, plan.end_time, particles)
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

    /// What is no warning, of the walls and of the scene.
    pub fn notes(&self) -> Vec<String> {
        let of_vessel = self.vessel.notes(self.scene.units);
        [of_vessel, self.moving.notes(), self.fabric.notes.clone(), self.plan.inventory.notes.clone()].concat()
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
struct Survey {
    vessel: Vessel,
    surface_models: SurfaceModels,
    moving: Moving,
    fabric: Surfaces,
    probe_volumes: Vec<f64>,
    measured: Measured,
}

impl Survey {
    fn new(scene: &Scene) -> Result<Survey, ModelError> {
        let mut vessel = Vessel::build(&scene.walls).map_err(|error| error.told_in(scene.units))?;
        let mut fabric = Surfaces::of(scene, &vessel)?;
        fabric.planes = planes_between(&fabric, &fabric.places(0.0))?;
        vessel.bags = fabric.bags(0.0)?;
        refuse_open_chambers(scene, &vessel)?;
        check_orifices(scene, &vessel)?;
        let surface_models = SurfaceModels::new(scene, &vessel, &fabric)?;
        let mut moving = Moving::new(scene, &vessel)?;
        moving.deform(scene, &vessel, &fabric)?;
        let probe_volumes: Vec<f64> = scene.probes.iter().map(|probe| vessel.gas_volume_in(&probe.region)).collect();
        let lightest_node = fabric.membranes.as_ref().map(|membranes| membranes.lightest_node);
        let measured = measured(scene, &vessel, &surface_models, &moving, &probe_volumes);
        let measured = Measured { lightest_node, nodes_over_volume: nodes_over_volume(&fabric), ..measured };
        let measured = in_bags(scene, &vessel, &fabric, &orifices_inside(scene, &vessel), measured);
        Ok(Survey { vessel, surface_models, moving, fabric, probe_volumes, measured })
    }

    fn outlook(&self, scene: &Scene) -> Outlook {
        outlook(scene, &self.vessel, &self.measured, &self.surface_models)
    }
}

/// What is not done yet beside surfaces that deform.
fn refuse_with_fabric(scene: &Scene, plan: &Plan) -> Result<(), ModelError> {
    if scene.fabrics.is_empty() {
        return Ok(());
    }
    let what = match plan.method {
        Method::HalfTurn | Method::ClosestApproach | Method::None => match scene.model.switch {
            None => return Ok(()),
            Some(_) => "`switch`".into(),
        },
        other => format!("the method `{}`", other.name()),
    };
    Err(ModelError::FabricWith { what })
}

/// The gas before its disc is inside of closed fabric.
fn orifices_inside(scene: &Scene, vessel: &Vessel) -> Vec<bool> {
    let before = |orifice: &Orifice| along(orifice.position, orifice.direction, 1e-3 * orifice.area.sqrt());
    let inside = |point| vessel.bags.iter().flatten().any(|bag| bag.contains(point));
    scene.orifices.iter().map(|orifice| inside(before(orifice))).collect()
}

/// Where a pressure is in place of gas none flows in.
fn refuse_outer_orifices(scene: &Scene, inside: &[bool]) -> Result<(), ModelError> {
    let Some(fabric) = scene.fabrics.iter().find(|fabric| fabric.external_pressure.is_some()) else { return Ok(()) };
    match scene.orifices.iter().zip(inside).find(|(_, inside)| !**inside) {
        None => Ok(()),
        Some((orifice, _)) => Err(ModelError::Fabric {
            fabric: fabric.name.clone(),
            problem: format!(
                "orifice \"{}\" lies outside of fabric, where the `external_pressure` is in place of gas",
                orifice.name
            ),
        }),
    }
}

/// What is inside of an open surface is not known.
fn refuse_open_chambers(scene: &Scene, vessel: &Vessel) -> Result<(), ModelError> {
    for chamber in &scene.chambers {
        if let Some(fabric) = chamber.inside
            && vessel.bag_of(chamber).is_none()
        {
            let (chamber, fabric) = (chamber.name.clone(), scene.fabrics[fabric].name.clone());
            return Err(ModelError::OpenFabric { chamber, fabric });
        }
    }
    Ok(())
}

/// What is chosen for a scene with a wish; with the part of the scene that is left where holes are modelled, if that is the better
/// choice (docs/explanation/planner.md).
fn chosen(scene: &Scene, seen: &Survey) -> Result<(Choice, Option<(Scene, Survey)>), ModelError> {
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
fn model_holes(whole: (&Scene, &Measured, &Outlook), part: Part) -> Result<(Choice, Part, Survey), String> {
    let seen = Survey::new(&part.scene).map_err(|error| error.to_string())?;
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

#[cfg(test)]
mod tests;
