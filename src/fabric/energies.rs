//! The account of a membrane, from what the device has.
//!
//! Velocities are those of half a step before the places. The energy of motion is exactly that of these velocities; that of strain is taken half a step back, where the
//! nodes were then. So to the square of the step, from the start on,
//!
//! kinetic + strain + damped + friction = (both at the start) + pressure + gravity + holds + obstacles + reference + gas, and gas + ledger = what
//! the gas gave.

use std::ops::Range;

use glam::DVec3;

use super::layout::GpuMembraneNode;
use super::model::Model;
use super::registry::{
    WORK_DAMPING, WORK_FRICTION, WORK_GAS, WORK_GRAVITY, WORK_HOLDS, WORK_LEDGER, WORK_OBSTACLES, WORK_PRESSURE,
    WORK_REFERENCE,
};
use super::state::place;

/// J; works since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Energies {
    /// Of motion, half a step before the nodes' places.
    pub kinetic: f64,
    /// Of strain, then.
    pub strain: f64,
    /// What damping took.
    pub damped: f64,
    /// Of the uniform pressures.
    pub pressure: f64,
    pub gravity: f64,
    /// Of what holds nodes.
    pub holds: f64,
    /// What nodes took of what the gas gave.
    pub gas: f64,
    /// What the gas gave less that: it was given to nodes with the velocity of one step, and taken with that of the next.
    pub ledger: f64,
    /// Of obstacles that push nodes off: of one at rest what stops there, negative.
    pub obstacles: f64,
    /// What friction on obstacles took; negative where one that moves has dragged more along.
    pub friction: f64,
    /// What references that change their size did on strain.
    pub reference: f64,
}

impl Energies {
    pub fn of(model: &Model, nodes: &[GpuMembraneNode]) -> Energies {
        Energies::of_part(model, nodes, 0..model.triangles.len(), 0..nodes.len())
    }

    /// Of these triangles and nodes alone.
    pub fn of_part(model: &Model, nodes: &[GpuMembraneNode], triangles: Range<usize>, part: Range<usize>) -> Energies {
        let middle = |node: &GpuMembraneNode| {
            let velocity = DVec3::from_array(node.velocity.map(f64::from));
            place(node, model) - 0.5 * f64::from(node.dt) * velocity
        };
        let middles: Vec<DVec3> = nodes.iter().map(middle).collect();
        let kinetic = |(node, mass): (&GpuMembraneNode, &f64)| {
            0.5 * mass * node.velocity.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>()
        };
        let own = &nodes[part.clone()];
        let work = |which: u32| -> f64 {
            let sums = own.iter().map(|node| node.work[which as usize]);
            sums.map(|[sum, excess]| f64::from(sum) - f64::from(excess)).sum()
        };
        Energies {
            kinetic: own.iter().zip(&model.masses[part]).map(kinetic).sum(),
            strain: model.strain_energy_of(triangles, &middles),
            damped: -work(WORK_DAMPING),
            pressure: work(WORK_PRESSURE),
            gravity: work(WORK_GRAVITY),
            holds: work(WORK_HOLDS),
            gas: work(WORK_GAS),
            ledger: work(WORK_LEDGER),
            obstacles: work(WORK_OBSTACLES),
            friction: -work(WORK_FRICTION),
            reference: work(WORK_REFERENCE),
        }
    }

    /// What is there less what was put in; its change from the start is what the integration lost or made.
    pub fn balance(&self) -> f64 {
        let there = self.kinetic + self.strain + self.damped + self.friction;
        there - self.pressure - self.gravity - self.holds - self.obstacles - self.reference - self.gas
    }
}
