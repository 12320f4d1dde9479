//! What a model becomes on a device: walls, zones and patches; and where its particles come from.

use std::sync::Arc;

use crate::geometry::{MovingWalls, TriangleGrid, Vessel, block_volumes, cell_gas, still_points};
use crate::gpu::Device;
use crate::output::Checkpoint;
use crate::scene::{Face, Method};
use crate::simulation::accounting::averages::Layout;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::model::patches::patches;
use crate::simulation::parallel::initial_particles::{Initial, InitialParticles, initial_particles};
use crate::subdomain::{CellTable, Domain, DomainInput, GpuParticle, GpuZone, KernelChoice, Patches, Walls, zone_of};

/// What the ranks that share a device have in common; made once for all of them.
#[derive(Clone)]
pub struct Setup {
    pub domain: Arc<Domain>,
    pub layout: Layout,
    pub patches: usize,
    /// Gas volume of each coarse block, m3.
    pub volumes: Arc<Vec<f64>>,
    /// What the space is cut by at the start, if not by the particles.
    pub cut_by: Option<InitialParticles>,
    pub particles: InitialParticles,
}

/// The order in which the initial particles are handed to the device; results must not depend on it.
pub type Shuffle = dyn Fn(&mut [GpuParticle]) + Sync;

impl Setup {
    /// `ranks`: how many the particles will be shared among.
    ///
    /// # Errors
    /// If the scene does not fit the device.
    pub fn new(
        model: &Model,
        device: &Device,
        ranks: usize,
        shuffle: Option<&Shuffle>,
    ) -> Result<Setup, SimulationError> {
        let Some(shuffle) = shuffle else {
            return Setup::build(
                model,
                device,
                ranks,
                InitialParticles::Sampled(Initial::default()),
                KernelChoice::Fitting,
            );
        };
        let mut particles = initial_particles(model)?;
        shuffle(&mut particles);
        Setup::with_particles(model, device, ranks, particles)
    }

    /// For one device, with kernels that read no number of the scene: to see that those that do give the same.
    ///
    /// # Errors
    /// As [`Setup::new`].
    pub fn fixed(model: &Model, device: &Device) -> Result<Setup, SimulationError> {
        Setup::build(model, device, 1, InitialParticles::Sampled(Initial::default()), KernelChoice::Fixed)
    }

    /// For one device, with kernels as if the scene had all that a scene may have: to see what it saves that they have not.
    ///
    /// # Errors
    /// As [`Setup::new`].
    pub fn whole(model: &Model, device: &Device) -> Result<Setup, SimulationError> {
        Setup::build(model, device, 1, InitialParticles::Sampled(Initial::default()), KernelChoice::AllFeatures)
    }

    /// For a run that goes on: all particles of that moment instead of the initial ones.
    ///
    /// # Errors
    /// If the scene does not fit the device.
    pub fn with_particles(
        model: &Model,
        device: &Device,
        ranks: usize,
        particles: Vec<GpuParticle>,
    ) -> Result<Setup, SimulationError> {
        Setup::build(model, device, ranks, InitialParticles::Listed(Arc::new(particles)), KernelChoice::Fitting)
    }

    /// For a run that goes on from a checkpoint.
    ///
    /// # Errors
    /// If the scene does not fit the device.
    pub fn from_checkpoint(
        model: &Model,
        device: &Device,
        ranks: usize,
        checkpoint: Checkpoint,
    ) -> Result<Setup, SimulationError> {
        Setup::build(model, device, ranks, InitialParticles::Saved(Arc::new(checkpoint)), KernelChoice::Fitting)
    }

    fn build(
        model: &Model,
        device: &Device,
        ranks: usize,
        particles: InitialParticles,
        kernels: KernelChoice,
    ) -> Result<Setup, SimulationError> {
        let plan = &model.plan;
        if plan.method == Method::ControlVolume {
            return Err(SimulationError::NoParticles);
        }
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
        let zones = zones(model);
        let tallied = Patches {
            surfaces: patches.len(),
            surface_models: model.surface_models.placed.len(),
            vents: model.scene.vents.len(),
            motions: model.moving.count(),
        };
        let input = DomainInput {
            plan,
            walls: &walls,
            cells: &cells,
            zones: &zones,
            patches: tallied,
            vent_entries: model.surface_models.vent_entries(),
            among_others: ranks > 1,
            kernels,
        };
        Ok(Setup {
            domain: Arc::new(Domain::new(device, &input)?),
            layout: layout(model, &patch, &patches),
            patches: patches.len(),
            volumes: Arc::new(volumes_of_blocks(model, &still)?),
            cut_by: None,
            particles,
        })
    }
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

/// Everything, the chambers, the probes.
fn zones(model: &Model) -> Vec<GpuZone> {
    let grid = &model.plan.grid;
    let chambers = model.scene.chambers.iter().enumerate().map(|(index, chamber)| GpuZone {
        carried: model.moving.carried.get(index).copied().unwrap_or(0),
        ..zone_of(chamber.region.as_ref(), grid)
    });
    let probes = model.scene.probes.iter().map(|probe| zone_of(Some(&probe.region), grid));
    std::iter::once(zone_of(None, grid)).chain(chambers).chain(probes).collect()
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
        vents: scene.vents.len(),
        surface_models: surface_models.placed.len(),
        motions: moving.count(),
        volumes: plan.chambers.iter().map(|chamber| chamber.volume).chain(probe_volumes.iter().copied()).collect(),
        chambers: scene.chambers.len(),
        surfaces: surfaces.collect(),
    }
}
