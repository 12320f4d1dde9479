//! The collision cells of the method `half-turn` in a gas, divided as `shaders/collision_cells.wgsl` does it.

use crate::geometry::Grid;
use crate::subdomain::{GpuParticle, MOST_MEMBERS, TILE_BITS};

/// Fewer particles have no gradient (`shaders/shared/relaxed.wgsl`).
const LEAST_FITTED: u32 = 6;
/// Cells of the grid in a tile.
const BINS: usize = 1 << (3 * TILE_BITS);

/// Those of two particles and more: who is alone flies on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct CollisionCells {
    pub number: f64,
    /// Of these, those with a gradient.
    pub fitted: f64,
    /// The particles in them.
    pub members: f64,
    /// Halvings on the way to them, of each cell of the grid for itself.
    pub halvings: f64,
}

impl CollisionCells {
    /// In steps in which tiles begin at the first cell of the grid and are halved along z first.
    pub fn of(particles: &[GpuParticle], grid: &Grid) -> CollisionCells {
        let tiles = grid.cells.map(|cells| cells.div_ceil(1 << TILE_BITS) as usize);
        let mut counts = vec![[0_u32; BINS]; tiles.iter().product()];
        for particle in particles {
            let cell = grid.cell_of(particle.position);
            let [x, y, z] = cell.map(|at| (at >> TILE_BITS) as usize);
            if let Some(tile) = counts.get_mut((z * tiles[1] + y) * tiles[0] + x) {
                tile[place_in_tile(cell)] += 1;
            }
        }
        let mut found = CollisionCells::default();
        counts.iter().for_each(|tile| found.divide(tile));
        found
    }

    /// In so many steps.
    pub fn times(self, steps: f64) -> CollisionCells {
        let CollisionCells { number, fitted, members, halvings } = self;
        let [number, fitted, members, halvings] = [number, fitted, members, halvings].map(|amount| amount * steps);
        CollisionCells { number, fitted, members, halvings }
    }

    fn divide(&mut self, bins: &[u32]) {
        let members: u32 = bins.iter().sum();
        if bins.len() > 1 && members > MOST_MEMBERS {
            self.halvings += bins.len() as f64;
            let (first, second) = bins.split_at(bins.len() / 2);
            self.divide(first);
            self.divide(second);
        } else if members > 1 {
            self.number += 1.0;
            self.members += f64::from(members);
            self.fitted += f64::from(u8::from(members >= LEAST_FITTED));
        }
    }
}

/// In the order in which each half of a tile, and each half of a half, is one stretch (`shaders/shared/local.wgsl`).
fn place_in_tile(cell: [u32; 3]) -> usize {
    let bit = |axis: usize, of: u32| ((cell[axis] >> of) & 1) as usize;
    (0..TILE_BITS).rev().fold(0, |place, of| place << 3 | bit(2, of) << 2 | bit(1, of) << 1 | bit(0, of))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_are_halved_where_they_are_full() {
        let grid = Grid::around([0.0; 3], [1.0; 3], 0.05).unwrap();
        let edge = 1 << grid.cell_bits;
        let at = |cell: [u32; 3]| GpuParticle { position: cell.map(|k| k * edge + 1), ..bytemuck::Zeroable::zeroed() };
        let crowd = |cell: [u32; 3], count: usize| vec![at(cell); count];
        let of = |crowds: &[&[GpuParticle]]| CollisionCells::of(&crowds.concat(), &grid);
        let [one, most] = [crowd([1, 1, 1], 1), crowd([1, 1, 1], MOST_MEMBERS as usize)];
        assert_eq!(of(&[&one]), CollisionCells::default());
        let whole = CollisionCells { number: 1.0, fitted: 1.0, members: 21.0, halvings: 0.0 };
        assert_eq!(of(&[&most]), whole);
        // One more on the other side of z: all 64 cells see that.
        let halved = CollisionCells { halvings: 64.0, ..whole };
        assert_eq!(of(&[&most, &crowd([1, 1, 2], 1)]), halved);
        // On the other side of x: those of the other half of z need it no more, those of the other half of y neither.
        assert_eq!(of(&[&most, &crowd([2, 1, 1], 1)]), CollisionCells { halvings: 64.0 + 32.0 + 16.0, ..whole });
        // A cell is not halved, whatever is in it; another tile is another.
        let deep = of(&[&most, &one, &crowd([6, 1, 1], 2)]);
        assert_eq!(deep, CollisionCells { number: 2.0, fitted: 1.0, members: 24.0, halvings: 126.0 });
    }
}
