//! The control volume of a run: the same chambers, openings and curves without space. The reference of runs of
//! particles, and the method `control-volume` itself.

use crate::gas::kinetics::HALF_TURN_PATHS;
use crate::gas::{
    Beginning, Collisions, ControlVolume, HeatedWall, Lost, OpenVent, Reservoir, Source, State, Swept, moles_at,
};
use crate::plan::{OpeningPlan, Plan};
use crate::scene::{Course, Curve, Method, Opening, Scene, SurfaceId};
use crate::simulation::model::build::Model;
use crate::simulation::model::places::chamber_of;
use crate::simulation::model::vent_places::Beyond;

/// The reference states of the chambers at `times` (s, ascending); outer index time.
pub fn reference(model: &Model, times: &[f64]) -> Vec<Vec<State>> {
    volume(model).solve(&initial(&model.scene, &model.plan), times)
}

/// The reference states of the chambers at the last of these moments (s, ascending), where their volumes, m3, are known: of a scene whose fabric
/// the gas moves, as it was seen to move until then.
pub fn reference_of_volumes(model: &Model, moments: &[f64], volumes: &[Vec<f64>]) -> Vec<State> {
    let of_chambers = volume(model);
    let change = |now: &Vec<f64>| now.iter().zip(&of_chambers.volumes).map(|(now, start)| now - start).collect();
    let (start, end) = (vec![0.0; of_chambers.volumes.len()], moments.last().copied().unwrap_or(0.0));
    let swept = Swept {
        // Displaced by a metre a second: volumes are by time.
        course: Course::Displacement(Curve { points: vec![[0.0, 0.0], [end, end]] }),
        at: std::iter::once(0.0).chain(moments.iter().copied()).collect(),
        change: std::iter::once(start).chain(volumes.iter().map(change)).collect(),
    };
    let followed = ControlVolume { swept: vec![swept], ..of_chambers };
    followed.solve(&initial(&model.scene, &model.plan), &[end]).pop().unwrap_or_default()
}

/// As [`reference`], and what has left through walls that keep a temperature (those of [`heated_walls`]) and vents.
pub fn reference_with_losses(model: &Model, times: &[f64]) -> Vec<(Vec<State>, Lost)> {
    volume(model).solve_with_losses(&initial(&model.scene, &model.plan), times)
}

/// As [`reference_with_losses`], from a later state of particles on: as a control volume knows the gas, in the continuum
/// unless its particles do not collide.
pub fn continued_with_losses(model: &Model, beginning: &Beginning, times: &[f64]) -> Vec<(Vec<State>, Lost)> {
    let collisions = if model.plan.method == Method::None { Collisions::None } else { Collisions::Continuum };
    ControlVolume { collisions, ..volume(model) }.solve_from(beginning, times)
}

fn volume(model: &Model) -> ControlVolume {
    let Model { scene, plan, .. } = model;
    let sources = scene.orifices.iter().filter_map(|orifice| {
        // Just off the wall that an orifice may lie on.
        let radius = (orifice.area / std::f64::consts::PI).sqrt();
        let point = std::array::from_fn(|axis| orifice.position[axis] + 1e-3 * radius * orifice.direction[axis]);
        let chamber = chamber_of(scene, &model.vessel, point)?;
        Some(Source { chamber, orifice: orifice.clone() })
    });
    ControlVolume {
        gases: plan.species(),
        volumes: plan.chambers.iter().map(|chamber| chamber.volume).collect(),
        sources: sources.collect(),
        openings: plan.openings.iter().map(opening).collect(),
        walls: walls(model),
        vents: vents(model),
        swept: model.moving.swept.clone(),
        collisions: match plan.method {
            Method::None => Collisions::None,
            Method::ControlVolume => Collisions::Continuum,
            Method::HalfTurn => {
                Collisions::Spacings { paths: HALF_TURN_PATHS, moles_per_particle: plan.moles_per_particle }
            }
            _ => Collisions::Particles {
                diameter: plan.diameter,
                cap: plan.diameter_cap,
                // Of the gas; what cells do to it is an error of the method.
                cell: None,
                moles_per_particle: plan.moles_per_particle,
            },
        },
    }
}

/// The scene's surfaces that the heat of [`Lost`] went to.
pub fn heated_walls(model: &Model) -> Vec<SurfaceId> {
    let with_gas = model.surface_models.placed.iter().filter(|placed| placed.chamber.is_some());
    with_gas.map(|placed| placed.surface).filter(|&surface| model.scene.surface_model(surface).heat.is_some()).collect()
}

fn walls(model: &Model) -> Vec<HeatedWall> {
    let surface_models = model.surface_models.placed.iter();
    let heated = surface_models.filter_map(|placed| {
        let heat = model.scene.surface_model(placed.surface).heat?;
        Some(HeatedWall { chamber: placed.chamber?, area: placed.area, heat })
    });
    heated.collect()
}

fn vents(model: &Model) -> Vec<OpenVent> {
    let places = model.scene.vents.iter().zip(&model.surface_models.vents);
    let open = places.map(|(vent, place)| OpenVent {
        chamber: place.chamber,
        area: vent.area.unwrap_or(place.area),
        vent: vent.clone(),
        behind: match place.beyond {
            Beyond::Gas(chamber) => chamber,
            Beyond::Nothing => None,
        },
    });
    open.collect()
}

fn opening(planned: &OpeningPlan) -> Opening {
    Opening { name: planned.name.clone(), between: planned.between, area: planned.area, length: planned.length }
}

/// What the chambers hold at the start. Of a run of particles those that are there, so that the rounding of their
/// number is not taken for an error of the method.
pub fn initial(scene: &Scene, plan: &Plan) -> Vec<Reservoir> {
    let chambers = scene.chambers.iter().zip(&plan.chambers);
    chambers
        .map(|(asked, planned)| {
            let moles = if plan.method == Method::ControlVolume {
                let all = moles_at(asked.pressure, planned.volume, asked.temperature);
                let mut by_gas = vec![0.0; plan.gases.len()];
                for &(gas, fraction) in &asked.mixture.0 {
                    by_gas[gas] += all * fraction;
                }
                by_gas
            } else {
                planned.particles.iter().map(|&n| n as f64 * plan.moles_per_particle).collect()
            };
            Reservoir { moles, temperature: asked.temperature }
        })
        .collect()
}
