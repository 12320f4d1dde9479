//! What a model becomes on a device, and where its particles come from.

use std::sync::Arc;

use super::host_setup::HostSetup;
use crate::gpu::Device;
use crate::output::Checkpoint;
use crate::scene::Method;
use crate::simulation::accounting::row::Layout;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::parallel::initial_particles::{Initial, InitialParticles, initial_particles};
use crate::subdomain::{Domain, DomainInput, GpuParticle, KernelChoice};

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
        let HostSetup { walls, fabric, cells, zones, planes, patches, layout, volumes } = HostSetup::new(model)?;
        let input = DomainInput {
            plan,
            walls: &walls,
            fabric: &fabric,
            cells: &cells,
            zones: &zones,
            planes: &planes,
            patches,
            vent_entries: model.surface_models.vent_entries(),
            among_others: ranks > 1,
            kernels,
        };
        Ok(Setup {
            domain: Arc::new(Domain::new(device, &input)?),
            layout,
            patches: patches.surfaces,
            volumes: Arc::new(volumes),
            cut_by: None,
            particles,
        })
    }
}
