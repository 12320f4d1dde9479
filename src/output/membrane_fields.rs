//! What a snapshot has of elastic fabric beside its triangles: arrays of its file.

use super::OutputError;
use super::vtk::{Array, Section};

/// Fabric at a time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FabricSnapshot {
    /// m.
    pub nodes: Vec<[f64; 3]>,
    /// `None` where no fabric is elastic.
    pub fields: Option<MembraneFields>,
}

/// Of all nodes and triangles.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MembraneFields {
    /// m/s.
    pub velocities: Vec<[f32; 3]>,
    pub triangles: Vec<TriangleField>,
}

/// Of a triangle; the larger principal value first.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct TriangleField {
    /// Change of length over the length without stress.
    pub strain: [f32; 2],
    /// Force over the width and thickness without stress, Pa.
    pub stress: [f32; 2],
    /// 0 slack, 1 wrinkled, 2 taut.
    pub tension: u8,
}

impl MembraneFields {
    /// # Errors
    /// If they are those of other nodes and triangles.
    pub(super) fn check(&self, nodes: usize, triangles: usize) -> Result<(), OutputError> {
        for (what, found, expected) in
            [("velocities of nodes", self.velocities.len(), nodes), ("triangles", self.triangles.len(), triangles)]
        {
            if found != expected {
                return Err(OutputError::FieldCount { what, found, expected });
            }
        }
        Ok(())
    }

    pub(super) fn of_nodes(&self) -> Section<'_> {
        let velocity =
            Array::new("velocity", "Float32", self.velocities.iter(), |velocity| velocity.map(f32::to_le_bytes));
        Section { element: "PointData", attributes: r#" Vectors="velocity""#, arrays: vec![velocity.in_unit("m/s")] }
    }

    pub(super) fn of_triangles(&self) -> Vec<Array<'_>> {
        let scalar = |name: &'static str, of: fn(&TriangleField) -> f32| {
            Array::new(name, "Float32", self.triangles.iter(), move |triangle| [of(triangle).to_le_bytes()])
        };
        vec![
            scalar("max_principal_strain", |triangle| triangle.strain[0]),
            scalar("min_principal_strain", |triangle| triangle.strain[1]),
            scalar("max_principal_stress", |triangle| triangle.stress[0]).in_unit("Pa"),
            scalar("min_principal_stress", |triangle| triangle.stress[1]).in_unit("Pa"),
            Array::new("tension", "UInt8", self.triangles.iter(), |triangle| [[triangle.tension]]),
        ]
    }
}
