//! What all subdomains of one device share: the plan, the compiled kernels, the walls, the zones.

use crate::gpu::{Device, GpuError, KernelVariant};
use crate::plan::Plan;
use crate::scene::Method;

use super::buffers::TallyWords;
use super::constants::{Features, Patches, Specialisation, block_counts, constants, runtime_constants_of, tally_loops};
use super::domain_buffers::DomainBuffers;
use super::domain_input::{DomainInput, KernelChoice};
use super::fabric::Fabric;
use super::kernels::Compiled;
use super::registry::{BLOCK_WORDS, ZONE_WORDS};
use super::sizes::SURFACE_COPIES;
use super::walls::BodyLists;

pub struct Domain {
    pub(super) plan: Plan,
    pub(super) features: Features,
    pub(super) constants: Vec<(&'static str, f64)>,
    has_runtime_constants: bool,
    pub(super) compiled: Compiled,
    /// Of the kernels.
    pub(super) variant: KernelVariant,
    /// Of a thread of the tally.
    pub(super) tally_loops: u32,
    pub(super) buffers: DomainBuffers,
    pub(super) words: TallyWords,
    pub(super) patches: Patches,
    pub(super) vent_entries: usize,
    pub(super) blocks: usize,
    pub(super) zones: usize,
    /// Cells whose gas walls part.
    pub(super) divided_cells: u64,
    /// Cells that moving walls may touch, at most.
    pub(super) moved_cells: u64,
    /// Of the walls that move.
    pub(super) bodies: Vec<BodyLists>,
    pub(super) fabric: Fabric,
}

impl Domain {
    /// # Errors
    /// If the device refuses a kernel, or the walls are over its limits.
    pub fn new(device: &Device, input: &DomainInput<'_>) -> Result<Domain, GpuError> {
        let plan = input.plan;
        // (Cells without a table of parts are cut where walls may stand in them.)
        let divided = input.cells.divided > 0
            || plan.method == Method::HalfTurn && input.walls.parting.iter().any(|&word| word != 0);
        let needed = Features::of(plan, input.patches, divided, input.among_others);
        let features = match input.kernels {
            KernelChoice::Fitting | KernelChoice::Fixed => needed,
            KernelChoice::AllFeatures => needed.with_all(),
        };
        let blocks = block_counts(plan).iter().map(|&n| n as usize).product();
        let words = TallyWords {
            zones: input.zones.len() * plan.gases.len() * ZONE_WORDS as usize,
            surfaces: SURFACE_COPIES * input.patches.copy_words(),
            blocks: blocks * BLOCK_WORDS as usize + plan.ladder_levels as usize,
        };
        let tally_loops = tally_loops(device, plan);
        let specialisation = Specialisation {
            plan,
            features,
            patches: input.patches,
            walls: input.walls,
            fabric: input.fabric,
            tally_loops,
        };
        let constants = constants(&specialisation);
        let runtime = if input.kernels == KernelChoice::Fixed { &[] } else { runtime_constants_of(device, plan) };
        Ok(Domain {
            plan: plan.clone(),
            features,
            has_runtime_constants: !runtime.is_empty(),
            compiled: Compiled::new(device, features, &constants, runtime)?,
            variant: device.variant(),
            tally_loops,
            constants,
            buffers: DomainBuffers::new(device, input)?,
            words,
            patches: input.patches,
            vent_entries: input.vent_entries,
            blocks,
            zones: input.zones.len(),
            divided_cells: input.cells.divided,
            moved_cells: input.cells.still.len() as u64,
            bodies: input.walls.bodies.clone(),
            fabric: input.fabric.clone(),
        })
    }

    pub fn features(&self) -> Features {
        self.features
    }

    /// Whether its kernels read numbers of the scene from a uniform.
    pub fn has_runtime_constants(&self) -> bool {
        self.has_runtime_constants
    }

    /// The most particles that room is made for ahead of need: a device alone has at most all that the plan has.
    pub(super) fn most_particles(&self) -> u64 {
        if self.features.halo { u64::MAX } else { self.plan.particles }
    }
}
