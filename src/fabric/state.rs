//! What a membrane is at a moment, as it lies on the device: all that its next step depends on.

use glam::DVec3;

use super::error::MembraneError;
use super::layout::GpuMembraneNode;
use super::model::Model;

/// The words of a node's impulses: three sums of two words.
pub const IMPULSE_WORDS: usize = 6;

#[derive(Debug, Clone, PartialEq)]
pub struct MembraneState {
    pub nodes: Vec<GpuMembraneNode>,
    /// What the gas gave in its last step: of each node three components of two words, the low one first.
    pub impulses: Vec<u32>,
}

impl MembraneState {
    pub fn bytes(&self) -> Vec<u8> {
        [bytemuck::cast_slice(&self.nodes), bytemuck::cast_slice(&self.impulses)].concat()
    }

    /// From [`MembraneState::bytes`].
    ///
    /// # Errors
    /// If they are not those of so many nodes.
    pub fn of_bytes(bytes: &[u8], nodes: usize) -> Result<MembraneState, MembraneError> {
        let each = size_of::<GpuMembraneNode>() + 4 * IMPULSE_WORDS;
        if bytes.len() != nodes * each {
            return Err(MembraneError::State { found: bytes.len() / each, expected: nodes });
        }
        let (of_nodes, of_impulses) = bytes.split_at(nodes * size_of::<GpuMembraneNode>());
        Ok(MembraneState {
            nodes: bytemuck::pod_collect_to_vec(of_nodes),
            impulses: bytemuck::pod_collect_to_vec(of_impulses),
        })
    }

    /// Where each node is, m.
    pub fn places(&self, model: &Model) -> Vec<DVec3> {
        self.nodes.iter().map(|node| place(node, model)).collect()
    }
}

/// Where a node is, m.
pub fn place(node: &GpuMembraneNode, model: &Model) -> DVec3 {
    let quanta = |axis: usize| f64::from(node.place[axis]) + f64::from(node.remainder[axis]);
    DVec3::from_array(std::array::from_fn(|axis| model.origin[axis] + model.quantum * quanta(axis)))
}
