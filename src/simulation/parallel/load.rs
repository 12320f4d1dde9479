//! What a rank has to do, told to all ranks with the sums of an interval's tallies.

use super::exchange::Traffic;
use crate::partition::{Measurement, Work};
use crate::ranks::Communicator;
use crate::subdomain::{GridCells, Tallies};

/// What a rank had to do in the last step of an interval, and what it did besides.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Load {
    /// Device time of the step, s; where the device does not time, from submissions to their ends.
    pub seconds: f64,
    /// Those of them that go with lists of neighbours, where the device times and the method has them.
    pub pair_seconds: Option<f64>,
    /// Ghosts included.
    pub particles: u64,
    /// Entries of the neighbour lists.
    pub candidates: u64,
    /// Particles that may meet a wall.
    pub walls: u64,
    /// Cells of its grid, those of its halo included.
    pub cells: u64,
    /// Of candidates and walls those of ghosts.
    pub ghost_candidates: u64,
    pub ghost_walls: u64,
    /// Triangles of fabric in the cells of its particles, for each particle; and of ghosts alone.
    pub sheets: u64,
    pub ghost_sheets: u64,
    /// Particles and cells that it owns.
    pub owned: u64,
    pub own_cells: u64,
    /// In the interval: particles that came from another owner, and bytes that were sent.
    pub moved: u64,
    pub bytes: u64,
    /// Wall time of the interval, s.
    pub wall: f64,
    /// Spent on a rebalance and on bringing the particles home, s.
    pub rebalancing: f64,
}

const LOAD_WORDS: usize = 16;

impl Load {
    /// `seconds`: all, and those of pairs; `present`: particles here; `traffic`: that of the interval.
    pub fn new(
        (seconds, pair_seconds): (f64, Option<f64>),
        present: u32,
        cells: GridCells,
        own: &Tallies,
        traffic: &Traffic,
    ) -> Load {
        Load {
            seconds,
            pair_seconds,
            particles: present.into(),
            candidates: own.counters.candidates.into(),
            walls: own.counters.near_walls.into(),
            cells: cells.all,
            ghost_candidates: own.counters.ghost_candidates.into(),
            ghost_walls: own.counters.ghost_walls.into(),
            sheets: own.counters.sheets.into(),
            ghost_sheets: own.counters.ghost_sheets.into(),
            owned: own.blocks.iter().map(|block| block.number).sum(),
            own_cells: cells.own,
            moved: own.counters.moved.into(),
            bytes: traffic.bytes,
            wall: traffic.wall_seconds,
            rebalancing: traffic.rebalancing_seconds,
        }
    }

    /// For a sum over ranks: this rank's words among zeros.
    pub fn to_words(self, comm: &dyn Communicator) -> Vec<u64> {
        let mut words = vec![0; LOAD_WORDS * comm.size()];
        let nanoseconds = |seconds: f64| (1e9 * seconds) as u64;
        let own = [
            nanoseconds(self.seconds),
            self.particles,
            self.candidates,
            self.walls,
            self.owned,
            self.moved,
            self.bytes,
            nanoseconds(self.rebalancing),
            nanoseconds(self.wall),
            // 0 is no time.
            self.pair_seconds.map_or(0, |seconds| 1 + nanoseconds(seconds)),
            self.cells,
            self.own_cells,
            self.ghost_candidates,
            self.ghost_walls,
            self.sheets,
            self.ghost_sheets,
        ];
        words[LOAD_WORDS * comm.rank()..][..LOAD_WORDS].copy_from_slice(&own);
        words
    }

    /// Takes every rank's load from the end of the sums.
    pub fn from_words(sums: &mut Vec<u64>, ranks: usize) -> Vec<Load> {
        let words = sums.split_off(sums.len().saturating_sub(LOAD_WORDS * ranks));
        let load = |w: &[u64]| Load {
            seconds: 1e-9 * w[0] as f64,
            particles: w[1],
            candidates: w[2],
            walls: w[3],
            owned: w[4],
            moved: w[5],
            bytes: w[6],
            rebalancing: 1e-9 * w[7] as f64,
            wall: 1e-9 * w[8] as f64,
            pair_seconds: w[9].checked_sub(1).map(|nanoseconds| 1e-9 * nanoseconds as f64),
            cells: w[10],
            own_cells: w[11],
            ghost_candidates: w[12],
            ghost_walls: w[13],
            sheets: w[14],
            ghost_sheets: w[15],
        };
        words.chunks_exact(LOAD_WORDS).map(load).collect()
    }

    /// Of one step.
    pub fn work(&self) -> Work {
        Work {
            particles: self.particles,
            candidates: self.candidates,
            wall_tests: self.walls,
            sheet_tests: self.sheets,
            cells: self.cells,
            steps: 1,
        }
    }

    /// What of it was of ghosts and of the cells around the own ones.
    pub fn of_halo(&self) -> Work {
        Work {
            particles: self.particles.saturating_sub(self.owned),
            candidates: self.ghost_candidates,
            wall_tests: self.ghost_walls,
            sheet_tests: self.ghost_sheets,
            cells: self.cells.saturating_sub(self.own_cells),
            steps: 0,
        }
    }

    pub fn measurement(&self) -> Measurement {
        Measurement { work: self.work(), seconds: self.seconds, pair_seconds: self.pair_seconds }
    }
}
