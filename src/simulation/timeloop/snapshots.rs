//! The particles of all ranks, at the times that the scene asks for and at the end.

use super::elastic_fabric::ElasticFabric;
use super::simulation::Simulation;
use crate::output::FabricSnapshot;
use crate::simulation::SimulationError;
use crate::simulation::timeloop::observer::Observer;
use crate::subdomain::GpuParticle;

/// Particles by id, and the rank that owns each.
type Owned = (Vec<GpuParticle>, Vec<u32>);

impl Simulation<'_> {
    pub fn snapshot_due(&self) -> bool {
        let asked = self.model.scene.output.snapshots;
        let due = f64::from(self.progress.next_snapshot) / f64::from(asked.max(1));
        asked > 0 && (self.control.clock.progress() >= due * (1.0 - 1e-12) || self.control.clock.done())
    }

    pub fn snapshot(&mut self, observer: &mut dyn Observer) -> Result<(), SimulationError> {
        let asked = self.model.scene.output.snapshots;
        if asked == 0 {
            return Ok(());
        }
        let own = self.subdomain.particles(self.device)?;
        self.count_passed(&own)?;
        if let Some((particles, owners)) = self.gather(own)? {
            if let Some(decomposition) = &self.parallel.decomposition {
                observer.boxes(&decomposition.boxes(&self.model.plan.grid));
            }
            if !self.model.fabric.is_empty() {
                observer.fabric(self.fabric_snapshot());
            }
            observer.snapshot(self.control.clock.time(), &particles, &owners)?;
        }
        while self.snapshot_due() && self.progress.next_snapshot <= asked {
            self.progress.next_snapshot += 1;
        }
        Ok(())
    }

    /// The fabric at the time of the clock, with nothing under way.
    pub(super) fn fabric_snapshot(&self) -> FabricSnapshot {
        let fields = self.fabric.as_ref().map(ElasticFabric::fields);
        FabricSnapshot { nodes: self.fabric_nodes(), fields }
    }

    /// All particles by id, and the rank that owns each, at rank 0. Collective.
    pub fn gather(&self, own: Vec<GpuParticle>) -> Result<Option<Owned>, SimulationError> {
        let Some(messages) = self.ranks.comm().gather(bytemuck::cast_slice(&own).to_vec())? else {
            return Ok(None);
        };
        let mut all = Vec::new();
        for (rank, message) in (0..).zip(messages) {
            let particles: Vec<GpuParticle> = bytemuck::pod_collect_to_vec(&message);
            all.extend(particles.into_iter().map(|particle| (particle, rank)));
        }
        all.sort_unstable_by_key(|(particle, _)| particle.id());
        Ok(Some(all.into_iter().unzip()))
    }
}
