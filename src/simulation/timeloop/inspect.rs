//! What studies of single steps look at.

use super::simulation::Simulation;
use crate::simulation::error::SimulationError;
use crate::subdomain::{GpuFlight, GpuParticle};

impl Simulation<'_> {
    /// Keeps the flights of each step from now on, for [`Simulation::flights`].
    ///
    /// # Errors
    /// If the device has no memory for them.
    pub fn watch_flights(&mut self) -> Result<(), SimulationError> {
        Ok(self.subdomain.watch_flights(self.device)?)
    }

    /// The flights of the last step of the run so far, with ids, in the order of
    /// [`Simulation::particles`]: for tests and studies of single steps, after [`Simulation::settle`]. None that are not
    /// [watched](Simulation::watch_flights).
    ///
    /// # Errors
    /// If the device fails.
    pub fn flights(&self) -> Result<Vec<(u32, GpuFlight)>, SimulationError> {
        let particles = self.subdomain.particles(self.device)?;
        let flights = self.subdomain.flights(self.device)?;
        Ok(particles.iter().map(GpuParticle::id).zip(flights).collect())
    }

    /// The particles, in the order of the device, after [`Simulation::settle`]: before it the device may have stalled.
    ///
    /// # Errors
    /// If the device fails.
    pub fn particles(&self) -> Result<Vec<GpuParticle>, SimulationError> {
        Ok(self.subdomain.particles(self.device)?)
    }
}
