//! What a model becomes before a device is asked: the walls and the gas by cells, zones and patches.

use crate::geometry::{MovingWalls, TriangleGrid, Vessel, block_volumes, cell_gas, still_points};
use crate::scene::{Face, Method};
use crate::simulation::accounting::row::Layout;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::model::patches::patches;
use crate::simulation::model::vent_places::Beyond;
use crate::simulation::parallel::initial_particles::find_room;
use crate::subdomain::{CellTable, Fabric, GpuZone, Patches, Walls, zone_inside, zone_of, zone_plane};

/// The part of a set-up that the host makes alone.
pub struct HostSetup {
    pub walls: Walls,
    pub fabric: Fabric,
    /// Of the method `cell`.
    pub cells: CellTable,
    pub zones: Vec<GpuZone>,
    /// Behind them, the planes that part closed fabrics.
    pub planes: Vec<GpuZone>,
    pub patches: Patches,
    pub layout: Layout,
    /// Gas volume of each coarse block, m3.
    pub volumes: Vec<f64>,
}

impl HostSetup {
    /// # Errors
    /// If the walls do not survive the rounding to the grid of positions, or a cell has too many parts.
    pub fn new(model: &Model) -> Result<HostSetup, SimulationError> {
        let plan = &model.plan;
        let motion = |wall: usize| model.moving.motion_of(wall);
        let margin = Walls::tolerance(&plan.grid);
        let still = model.vessel.without(|wall| motion(wall).is_some());
        let moving = MovingWalls { still: &still, count: model.moving.count(), number: &motion };
        let triangle_grid = TriangleGrid::build_still(&model.vessel, &plan.grid, margin, &moving)
            .map_err(|error| error.told_in(model.scene.units))?;
        let (patch, patches) = patches(model);
        let parts = |triangle: usize| {
            let wall = &model.scene.walls[model.vessel.triangles[triangle].wall as usize];
            !wall.is_convex_cavity()
        };
        let walls = Walls::new(&triangle_grid, &plan.grid, &patch, &model.surface_models.of_triangle, parts)
            .moving(&triangle_grid, |source| motion(model.vessel.triangles[source].wall as usize));
        let cells = match plan.method {
            Method::Cell => cell_table(model, &still, &triangle_grid, parts)?,
            _ => CellTable::default(),
        };
        let (zones, planes) = zones(model);
        let counted = Patches {
            surfaces: patches.len() + 2 * model.fabric.all.len(),
            surface_models: model.surface_models.placed.len(),
            vents: model.scene.vents.len(),
            passages: if model.surface_models.has_passages() { model.scene.vents.len() } else { 0 },
            motions: model.moving.count(),
            fabrics: model.fabric.all.len(),
            membrane: model.fabric.is_elastic(),
            smoothed: model.smoothings() > 0,
        };
        Ok(HostSetup {
            walls,
            fabric: model
                .fabric
                .for_device(&plan.grid, model.moving.count(), patches.len(), &model.surface_models.of_sheet)
                .recoiling(&model.recoils()),
            cells,
            zones,
            planes,
            patches: counted,
            layout: layout(model, &patch, &patches),
            volumes: volumes_of_blocks(model, &still)?,
        })
    }
}

/// Whether a run of the model could begin, as far as the host can tell without a device.
///
/// # Errors
/// As a run's set-up and its first particles.
pub fn check_setup(model: &Model) -> Result<(), SimulationError> {
    if model.plan.method == Method::ControlVolume {
        return Ok(());
    }
    HostSetup::new(model)?;
    find_room(model)
}

/// The gas of the cells, as walls at rest leave it.
fn cell_table(
    model: &Model,
    still: &Vessel,
    triangles: &TriangleGrid,
    parts: impl Fn(usize) -> bool + Sync,
) -> Result<CellTable, SimulationError> {
    let grid = &model.plan.grid;
    if model.moving.is_empty() {
        return Ok(CellTable::new(&cell_gas(&model.vessel, grid, triangles, parts), grid)?);
    }
    let still = still.clone().measured()?;
    let gas = cell_gas(&still, grid, triangles, parts);
    let points = still_points(&still, grid, triangles, &model.moving.swept_cells(grid));
    Ok(CellTable::new(&gas, grid)?.moving(&gas, &points))
}

/// Without the walls that move: a block that one of them covers in part counts with all of its volume.
fn volumes_of_blocks(model: &Model, still: &Vessel) -> Result<Vec<f64>, SimulationError> {
    let plan = &model.plan;
    if model.moving.is_empty() {
        return Ok(block_volumes(&model.vessel, &plan.grid, plan.block_cells_log2));
    }
    Ok(block_volumes(&still.clone().measured()?, &plan.grid, plan.block_cells_log2))
}

/// Everything, the chambers, the probes; and the planes behind them.
fn zones(model: &Model) -> (Vec<GpuZone>, Vec<GpuZone>) {
    let grid = &model.plan.grid;
    let first = 1 + model.scene.chambers.len() + model.scene.probes.len();
    let mut planes = Vec::new();
    let chambers = model.scene.chambers.iter().enumerate().map(|(index, chamber)| GpuZone {
        carried: model.moving.carried.get(index).copied().unwrap_or(0),
        ..match chamber.inside {
            Some(fabric) => {
                let own = &model.fabric.planes[fabric];
                let begin = first + planes.len();
                planes.extend(own.iter().map(|plane| zone_plane(plane.point, plane.normal, grid)));
                let zone = zone_inside(model.fabric.swept(fabric), grid);
                return GpuZone { carried: begin as u32, planes: own.len() as u32, ..zone };
            }
            None => zone_of(chamber.region.as_ref(), grid),
        }
    });
    let probes = model.scene.probes.iter().map(|probe| zone_of(Some(&probe.region), grid));
    let zones = std::iter::once(zone_of(None, grid)).chain(chambers).chain(probes).collect();
    (zones, planes)
}

fn layout(model: &Model, of_triangle: &[u32], patches: &[(u32, Option<Face>)]) -> Layout {
    let Model { scene, vessel, plan, surface_models, moving, probe_volumes, .. } = model;
    let area_of = |wall: u32, face: Option<Face>| -> f64 {
        let vertex = |index: u32| glam::DVec3::from(vessel.vertices[index as usize]);
        let own = |patch: &u32| patches[*patch as usize] == (wall, face);
        let triangles = vessel.triangles.iter().zip(of_triangle).filter(|(_, patch)| own(patch));
        triangles
            .map(|(triangle, _)| {
                let [a, b, c] = triangle.vertices.map(vertex);
                0.5 * (b - a).cross(c - a).length()
            })
            .sum()
    };
    let surfaces = scene.surfaces.iter().map(|surface| {
        let members = patches.iter().enumerate().filter(|(_, (wall, face))| {
            *wall as usize == surface.wall && (surface.face.is_none() || *face == surface.face)
        });
        let members: Vec<usize> = members.map(|(index, _)| index).collect();
        let area = members.iter().map(|&index| area_of(patches[index].0, patches[index].1)).sum();
        (members, area)
    });
    let walls = scene.heated_surfaces().map(|(surface, _)| {
        let own = surface_models.placed.iter().enumerate().filter(|(_, placed)| placed.surface == surface);
        let members: Vec<usize> = own.map(|(index, _)| index).collect();
        let area = members.iter().map(|&index| surface_models.placed[index].area).sum();
        (members, area)
    });
    Layout {
        walls: walls.collect(),
        vents: surface_models.vents.iter().map(|place| place.beyond != Beyond::Nothing).collect(),
        surface_models: surface_models.placed.len(),
        motions: moving.count(),
        fabrics: model.fabric.all.len(),
        elastic: model.fabric.is_elastic(),
        patches: patches.len(),
        volumes: plan.chambers.iter().map(|chamber| chamber.volume).chain(probe_volumes.iter().copied()).collect(),
        chambers: scene.chambers.len(),
        surfaces: surfaces.collect(),
    }
}
