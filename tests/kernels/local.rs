//! A device among others, for tests: its cells, their halo, and the cells of the others.

use corpuscle::subdomain::{GpuPeer, GpuStep};

use crate::rig::*;

type Cell = [u32; 3];

/// The cells c with low <= c < high.
#[derive(Debug, Clone, Copy)]
pub struct Extent {
    pub low: Cell,
    pub high: Cell,
}

impl Extent {
    pub fn holds(&self, cell: Cell) -> bool {
        self.away(cell) == 0
    }

    /// Layers of cells between a cell and these; 0 in them.
    pub fn away(&self, cell: Cell) -> u32 {
        let along = |k: usize| self.low[k].saturating_sub(cell[k]).max((cell[k] + 1).saturating_sub(self.high[k]));
        (0..3).map(along).max().unwrap_or(0)
    }
}

/// In the world of [`World::plain`], whose gas is in 6 x 7 x 8 cells or one more for each.
pub struct Local {
    pub grid: Cell,
    pub own: Extent,
    /// Own cells that nobody has in his halo.
    pub inner: Extent,
    /// Cells with bins, with the border layer that stays empty.
    pub bins: Extent,
    pub depth: u32,
    pub others: Vec<Extent>,
}

impl Local {
    /// In the middle: others below it in x, above it in x, and behind those above, who share no ghosts with it.
    /// Nobody owns what lies beyond it in y.
    pub fn new(world: &World) -> Local {
        let grid = world.grid.cells;
        let own = Extent { low: [3, 2, 2], high: [5, 5, 7] };
        let depth = 1;
        let across = |from: u32, to: u32| Extent { low: [from, 1, 1], high: [to, grid[1] - 1, grid[2] - 1] };
        Local {
            grid,
            own,
            inner: Extent { low: [4, 3, 3], high: [5, 4, 6] },
            bins: Extent { low: [1, 0, 0], high: [7, 7, 9] },
            depth,
            others: vec![across(1, 3), across(5, 6), across(6, grid[0] - 1)],
        }
    }

    pub fn step(&self) -> GpuStep {
        let size: Cell = std::array::from_fn(|k| self.bins.high[k] - self.bins.low[k]);
        GpuStep {
            low: self.bins.low,
            size,
            bins: size.iter().product(),
            own_low: self.own.low,
            own_high: self.own.high,
            depth: self.depth,
            inner_low: self.inner.low,
            inner_high: self.inner.high,
            peers: self.others.len() as u32,
            near_peers: 2,
            // All in the layers of cells around are needed as ghosts.
            near2: 1 << 20,
            ..GpuStep::default()
        }
    }

    pub fn peers(&self) -> Vec<GpuPeer> {
        let signed = |cell: Cell| cell.map(|c| c as i32);
        let peer = |other: &Extent| GpuPeer { low: signed(other.low), high: signed(other.high), ..GpuPeer::default() };
        self.others.iter().map(peer).collect()
    }

    /// The bin of a cell, if it has one that may be filled.
    pub fn bin(&self, cell: Cell) -> Option<u32> {
        let size = self.step().size;
        let at: [i64; 3] = std::array::from_fn(|k| i64::from(cell[k]) - i64::from(self.bins.low[k]));
        let inside = (0..3).all(|k| at[k] >= 1 && at[k] < i64::from(size[k]) - 1);
        let [x, y, z] = at.map(|a| a as u32);
        inside.then(|| (z * size[1] + y) * size[0] + x)
    }

    /// All cells whose bins may be filled, in the order of their bins.
    pub fn cells(&self) -> Vec<Cell> {
        let [low, high] = [self.bins.low, self.bins.high];
        let mut cells = Vec::new();
        for z in low[2] + 1..high[2] - 1 {
            for y in low[1] + 1..high[1] - 1 {
                for x in low[0] + 1..high[0] - 1 {
                    cells.push([x, y, z]);
                }
            }
        }
        cells
    }

    /// `cell_index` of the shaders.
    pub fn index(&self, cell: Cell) -> u32 {
        (cell[2] * self.grid[1] + cell[1]) * self.grid[0] + cell[0]
    }
}
