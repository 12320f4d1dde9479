//! Surfaces that deform as the device sees them: triangles, and in each step of an interval where their nodes are.
//!
//! Nodes lie on the lattice of positions and fly straight within a step. Which triangles may touch a cell is found on the device in
//! each step (`shaders/list_fabric.wgsl`); the host knows how much room that takes at most, by the same boxes of integers.

use crate::geometry::Grid;
use crate::gpu::{Device, GpuError};

use super::layout::{GpuSheet, GpuSwept};
use super::registry::{FABRIC_FIRST, NODE_IMPULSE_WORDS, SHEET_MARGIN};

/// How near a flight comes to a sheet, as a share of the longest edge of a triangle and a cell: f32 sums of distances of that size err
/// by a tenth of it.
const GAP: f64 = 2e-6;
/// And at least, in quanta of positions.
const LEAST_GAP: f64 = 32.0;
/// Entries of lists for each triangle of elastic fabric that there is room for at first, where intervals can run again.
pub const FIRST_ENTRIES: u64 = 4;
/// Of an entry or a record.
const ENTRY_WORDS: usize = 4;

/// The surfaces that deform.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fabric {
    pub nodes: usize,
    pub sheets: Vec<GpuSheet>,
    /// How near a flight comes to a sheet, m.
    pub gap: f64,
    /// Of elastic fabric, whose nodes move by forces: the entries of lists that there is room for. Else it is known from the places of nodes.
    pub elastic: Option<u64>,
}

impl Fabric {
    /// The gap of sheets whose longest edge is ever so long, m.
    pub fn gap_of(grid: &Grid, longest_edge: f64) -> f64 {
        (GAP * (longest_edge + 2.0 * grid.cell)).max(LEAST_GAP * grid.quantum())
    }

    /// With the reference mass over that with which each triangle recoils from a hit; none of fabric that gas does not move.
    #[must_use]
    pub fn recoiling(mut self, recoils: &[f64]) -> Fabric {
        for (sheet, recoil) in self.sheets.iter_mut().zip(recoils) {
            sheet.recoil = *recoil as f32;
        }
        self
    }
}

/// Where the nodes are, and which triangles are in which cells.
pub struct FabricBuffers {
    pub nodes: wgpu::Buffer,
    pub cells: wgpu::Buffer,
    /// Those of lists, and records of as many cells.
    pub entries: wgpu::Buffer,
    /// What each triangle sweeps in the step ([`GpuSwept`]).
    pub swept: wgpu::Buffer,
    /// What the gas gives to each node of elastic fabric in a step.
    pub impulses: wgpu::Buffer,
    /// Of its nodes, smoothed, m/s.
    pub velocities: wgpu::Buffer,
    /// Entries of lists that there is room for, and cells with lists.
    pub room: u64,
    pub listed: u64,
}

/// The words of `fabric_cells` for lists of so many cells.
pub fn words_of_cells(cells: u64) -> u64 {
    u64::from(FABRIC_FIRST) + cells + cells.div_ceil(32)
}

impl FabricBuffers {
    /// # Errors
    /// If the device has no memory for it.
    pub fn new(
        device: &Device,
        fabric: &Fabric,
        steps: u32,
        [room, listed]: [u64; 2],
    ) -> Result<FabricBuffers, GpuError> {
        let pushed = if fabric.elastic.is_some() { fabric.nodes as u64 } else { 0 };
        let listed = if fabric.nodes > 0 { listed } else { 0 };
        Ok(FabricBuffers {
            nodes: device.storage::<[u32; 4]>("nodes", (fabric.nodes as u64 * (u64::from(steps) + 1)).max(1))?,
            cells: lists(device, listed)?,
            entries: entries(device, room)?,
            swept: device.storage::<GpuSwept>("fabric_swept", (fabric.sheets.len() as u64).max(1))?,
            velocities: device.storage::<[f32; 4]>("node_velocities", pushed.max(1))?,
            impulses: device.storage::<[u32; NODE_IMPULSE_WORDS as usize]>("node_impulses", pushed.max(1))?,
            room,
            listed,
        })
    }

    /// Makes room for so many entries and cells, if there is less; what is in these lists is lost. Whether anything has changed.
    ///
    /// # Errors
    /// If the device has no memory for it.
    pub fn make_room(&mut self, device: &Device, [room, listed]: [u64; 2]) -> Result<bool, GpuError> {
        let (more_entries, more_cells) = (room > self.room, listed > self.listed);
        if more_entries {
            (self.entries, self.room) = (entries(device, room)?, room);
        }
        if more_cells {
            (self.cells, self.listed) = (lists(device, listed)?, listed);
        }
        Ok(more_entries || more_cells)
    }
}

fn lists(device: &Device, cells: u64) -> Result<wgpu::Buffer, GpuError> {
    device.storage::<u32>("fabric_cells", words_of_cells(cells))
}

fn entries(device: &Device, room: u64) -> Result<wgpu::Buffer, GpuError> {
    device.storage::<[u32; ENTRY_WORDS]>("fabric_entries", 2 * room.max(1))
}

/// The most entries that lists of a step have in the cells of a box: `nodes` are the places of all nodes, one moment of an interval after the other.
pub fn most_entries(grid: &Grid, fabric: &Fabric, nodes: &[[u32; 4]], listed: ([u32; 3], [u32; 3])) -> u64 {
    let margin = (f64::from(SHEET_MARGIN) * fabric.gap / grid.quantum()).ceil() as i64 + 1;
    let cells_along = |low: i64, high: i64, axis: usize| {
        let last = i64::from(grid.cells[axis]) - 1;
        let cell = |place: i64| (place >> grid.cell_bits).clamp(0, last);
        let (first, size) = (i64::from(listed.0[axis]), i64::from(listed.1[axis]));
        (cell(high + margin).min(first + size - 1) - cell(low - margin).max(first) + 1).max(0) as u64
    };
    let moments = nodes.len() / fabric.nodes.max(1);
    let of_step = |step: usize| -> u64 {
        let at = |moment: usize, node: u32| nodes[(step + moment) * fabric.nodes + node as usize];
        let of_sheet = |sheet: &GpuSheet| -> u64 {
            let corners = [sheet.a, sheet.b, sheet.c].map(|node| [at(0, node), at(1, node)]);
            (0..3)
                .map(|axis| {
                    // (Below the origin a place wraps.)
                    let places = || {
                        corners.iter().flatten().map(|place| i64::from(place[axis].wrapping_add(1 << 30)) - (1 << 30))
                    };
                    let [low, high] = [places().min(), places().max()].map(Option::unwrap_or_default);
                    cells_along(low, high, axis)
                })
                .product()
        };
        fabric.sheets.iter().map(of_sheet).sum()
    };
    (0..moments.saturating_sub(1)).map(of_step).max().unwrap_or(0)
}
