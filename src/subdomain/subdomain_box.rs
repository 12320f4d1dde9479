//! Where a subdomain lies in the global grid of cells, and among which others.

use crate::plan::Plan;

use super::constants::box_bits;

/// A box of cells, low <= c < high.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cells {
    pub low: [u32; 3],
    pub high: [u32; 3],
}

impl Cells {
    /// The cells that particles can be in: all but the border layer of the grid; where boxes are made of tiles, all tiles that have some.
    pub fn inside(plan: &Plan) -> Cells {
        let bits = box_bits(plan.method);
        if bits == 0 {
            return Cells { low: [1; 3], high: plan.grid.cells.map(|cells| cells - 1) };
        }
        Cells { low: [0; 3], high: plan.grid.cells.map(|cells| (((cells - 2) >> bits) + 1) << bits) }
    }
}

/// How many cells of the grid a subdomain has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct GridCells {
    /// With bins: the own ones, the halo and a layer around it.
    pub all: u64,
    pub own: u64,
}

/// Which of the outermost ghosts that choose partners do so. The choice of a ghost matters only if a particle farther
/// in has chosen it; all choices are functions of the state, so this changes no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Ghosts {
    /// Those that were chosen: little work, three dispatches more a round.
    OnDemand,
    /// All, with the own particles.
    All,
}

/// The cells of a subdomain, its halo, and the others.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SubdomainBox {
    /// The cells whose particles it owns.
    pub own: Cells,
    /// Layers of cells around them in which its ghosts are (`shaders/shared/halo.wgsl`): twice the rounds between two exchanges, none
    /// where particles collide within their cells.
    pub depth: u32,
    pub ghosts: Ghosts,
    /// The cells that others own, in the order of the messages; the first `near` of them overlap with this
    /// one's halo.
    pub peers: Vec<Cells>,
    pub near: usize,
    /// Layers of cells around the own ones beyond which no particle of this one's is thought to fly in a step, or one that needs it might
    /// be no peer; 0 if all others are, or none needs ghosts.
    pub flight: u32,
    /// Layers of cells around the own ones beyond which no flight of its particles is thought to come: there triangles of fabric are listed. None: in all
    /// cells.
    pub fabric: Option<u32>,
    /// Whether the particles may be anywhere (after a rebalance or a restart), not only near their owner.
    pub scattered: bool,
    /// Whether it is made of tiles (the method `half-turn`), which begin a cell farther in every other step: no particle needs to know of one in another.
    pub tiled: bool,
}

impl SubdomainBox {
    /// A subdomain that owns all cells.
    pub fn alone(plan: &Plan) -> SubdomainBox {
        SubdomainBox {
            own: Cells::inside(plan),
            depth: 0,
            ghosts: Ghosts::All,
            peers: Vec::new(),
            near: 0,
            flight: 0,
            fabric: None,
            scattered: false,
            tiled: box_bits(plan.method) > 0,
        }
    }

    /// Whether there are no others.
    pub fn is_alone(&self) -> bool {
        self.peers.is_empty()
    }

    /// The cells that have bins: the own ones, the halo and an empty border layer, within the grid; of tiles the own ones. Low corner
    /// and size.
    pub(super) fn bins(&self, grid: [u32; 3]) -> ([u32; 3], [u32; 3]) {
        if self.tiled {
            return (self.own.low, std::array::from_fn(|axis| self.own.high[axis] - self.own.low[axis]));
        }
        let around = self.depth + 1;
        let low = self.own.low.map(|low| low.saturating_sub(around));
        let size = std::array::from_fn(|axis| (self.own.high[axis] + around).min(grid[axis]) - low[axis]);
        (low, size)
    }

    /// The cells in which triangles of fabric are listed, wherever the tiles begin. Low corner and size.
    pub(super) fn fabric_cells(&self, grid: [u32; 3]) -> ([u32; 3], [u32; 3]) {
        let Some(layers) = self.fabric else { return ([0; 3], grid) };
        let low = self.own.low.map(|low| low.saturating_sub(layers));
        let shift = u32::from(self.tiled);
        (low, std::array::from_fn(|axis| (self.own.high[axis] + shift + layers).min(grid[axis]) - low[axis]))
    }

    /// How many these are.
    pub(super) fn cells_with_fabric_lists(&self, grid: [u32; 3]) -> u64 {
        self.fabric_cells(grid).1.iter().map(|&cells| u64::from(cells)).product()
    }

    pub(super) fn cells(&self, grid: [u32; 3]) -> GridCells {
        let number = |size: [u32; 3]| size.iter().map(|&n| u64::from(n)).product();
        let own = std::array::from_fn(|axis| self.own.high[axis] - self.own.low[axis]);
        GridCells { all: number(self.bins(grid).1), own: number(own) }
    }

    /// The own cells that no other subdomain has in its halo; none of them where particles are scattered.
    pub(super) fn inner(&self, grid: [u32; 3]) -> Cells {
        if self.scattered {
            return Cells { low: [0; 3], high: [0; 3] };
        }
        let shrink = |axis: usize| {
            let (low, high) = (self.own.low[axis], self.own.high[axis]);
            let low = if low > 1 { (low + self.depth).min(high) } else { low };
            let at_end = high + 1 == grid[axis];
            (low, if at_end { high } else { high.saturating_sub(self.depth).max(low) })
        };
        let bounds: [(u32, u32); 3] = std::array::from_fn(shrink);
        Cells { low: bounds.map(|bound| bound.0), high: bounds.map(|bound| bound.1) }
    }

    /// The layer up to which pairs are settled in a round: the knowledge of the ghosts shrinks by two layers a
    /// round until the next exchange.
    pub(super) fn reach(&self, round: u32) -> u32 {
        match self.depth / 2 {
            0 => 0,
            rounds => 2 * (rounds - 1 - round % rounds),
        }
    }

    /// Whether some ghosts choose only when asked.
    pub fn has_on_demand_ghosts(&self) -> bool {
        self.depth > 0 && self.ghosts == Ghosts::OnDemand
    }

    /// Whether the ghosts must be brought up to date before this round.
    pub fn stale(&self, round: u32) -> bool {
        let rounds = self.depth / 2;
        rounds > 0 && round > 0 && round.is_multiple_of(rounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(depth: u32) -> SubdomainBox {
        let own = Cells { low: [1, 10, 4], high: [9, 20, 8] };
        SubdomainBox {
            own,
            depth,
            ghosts: Ghosts::OnDemand,
            peers: Vec::new(),
            near: 0,
            flight: 0,
            fabric: None,
            scattered: false,
            tiled: false,
        }
    }

    /// Fabric is listed around the own cells, wherever the tiles begin, within the grid; or in all cells.
    #[test]
    fn fabric_is_listed_around_the_own_cells() {
        let grid = [10, 30, 12];
        assert_eq!(place(0).fabric_cells(grid), ([0; 3], grid));
        let listed = SubdomainBox { fabric: Some(3), ..place(0) };
        assert_eq!(listed.fabric_cells(grid), ([0, 7, 1], [10, 16, 10]));
        let tiled = SubdomainBox { tiled: true, ..listed };
        assert_eq!(tiled.fabric_cells(grid), ([0, 7, 1], [10, 17, 11]));
    }

    /// The halo ends at the border of the grid; faces without neighbours have no particles to send.
    #[test]
    fn the_halo_stays_within_the_grid() {
        let grid = [10, 40, 40];
        assert_eq!(place(4).bins(grid), ([0, 5, 0], [10, 20, 13]));
        assert_eq!(place(4).inner(grid), Cells { low: [1, 14, 8], high: [9, 16, 8] });
        assert_eq!(SubdomainBox { scattered: true, ..place(4) }.inner(grid).high, [0; 3]);
    }

    /// The last round before an exchange settles only pairs with an own particle.
    #[test]
    fn knowledge_shrinks_by_two_layers_a_round() {
        let reach: Vec<u32> = (0..6).map(|round| place(6).reach(round)).collect();
        assert_eq!(reach, [4, 2, 0, 4, 2, 0]);
        let stale: Vec<u32> = (0..9).filter(|&round| place(6).stale(round)).collect();
        assert_eq!(stale, [3, 6]);
        assert!((0..9).all(|round| place(0).reach(round) == 0 && !place(0).stale(round)));
    }
}
