//! The buffers that all subdomains of a device share.

use crate::gpu::{Device, GpuError};

use super::domain_input::DomainInput;
use super::layout::{GpuGas, GpuSheet, GpuTriangle};
use super::state::{gas_table, mode_table, share_table};

/// The gases, the walls and the zones.
pub struct DomainBuffers {
    pub gases: wgpu::Buffer,
    pub modes: wgpu::Buffer,
    pub mass_shares: wgpu::Buffer,
    pub wall_start: wgpu::Buffer,
    pub wall_list: wgpu::Buffer,
    pub triangles: wgpu::Buffer,
    pub cell_class: wgpu::Buffer,
    pub parting: wgpu::Buffer,
    pub fabric: wgpu::Buffer,
    pub zones: wgpu::Buffer,
    pub cell_volume: wgpu::Buffer,
    pub cell_parts: wgpu::Buffer,
    pub still_gas: wgpu::Buffer,
}

impl DomainBuffers {
    pub fn new(device: &Device, input: &DomainInput<'_>) -> Result<DomainBuffers, GpuError> {
        let &DomainInput { plan, walls, fabric, cells, zones, planes, .. } = input;
        let (gases, modes) = (gas_table(plan), mode_table(plan));
        let mut table = [GpuGas::default(); 16];
        table[..gases.len()].copy_from_slice(&gases);
        let gas_buffer = device.uniform("gases", size_of_val(&table) as u64)?;
        device.write(&gas_buffer, 0, &table);
        let mode_buffer = device.uniform("modes", size_of_val(modes.as_slice()) as u64)?;
        device.write(&mode_buffer, 0, &modes);
        let shares = share_table(&gases);
        let share_buffer = device.uniform("mass_shares", size_of_val(shares.as_slice()) as u64)?;
        device.write(&share_buffer, 0, &shares);
        Ok(DomainBuffers {
            gases: gas_buffer,
            modes: mode_buffer,
            mass_shares: share_buffer,
            wall_start: device.storage_of("wall_start", &walls.start)?,
            wall_list: device.storage_of("wall_list", &walls.list)?,
            triangles: device.storage_of::<GpuTriangle>("triangles", &walls.triangles)?,
            cell_class: device.storage_of("cell_class", &walls.class)?,
            parting: device.storage_of("parting", &walls.parting)?,
            fabric: device.storage_of::<GpuSheet>("fabric", &fabric.sheets)?,
            zones: device.storage_of("zones", &[zones, planes].concat())?,
            cell_volume: device.storage_of("cell_volume", &cells.volume)?,
            cell_parts: device.storage_of("cell_parts", &cells.parts)?,
            still_gas: device.storage_of("still_gas", &cells.still)?,
        })
    }

    /// Of those that grow with the cells.
    pub fn cell_bytes(&self) -> u64 {
        let of_cells = [
            &self.wall_start,
            &self.wall_list,
            &self.cell_class,
            &self.parting,
            &self.cell_volume,
            &self.cell_parts,
            &self.still_gas,
        ];
        of_cells.iter().map(|buffer| buffer.size()).sum()
    }
}
