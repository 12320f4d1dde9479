//! Fixed-point positions and cells (method.md, "Equal bits"), in exact integers. The only floating-point
//! numbers are the f32 products that move a position, each rounded once as IEEE 754 says.

/// Cells per axis, quanta per cell = 2^`bits`, f32 quanta per metre.
#[derive(Debug, Clone, Copy)]
pub struct Cells {
    pub counts: [u32; 3],
    pub bits: u32,
    pub quanta_per_metre: f32,
}

impl Cells {
    /// p moved at v m/s for so many seconds, to the nearest quantum (ties to even), modulo 2^32.
    pub fn shifted(&self, p: [u32; 3], v: [f32; 3], time: f32) -> [u32; 3] {
        std::array::from_fn(|k| {
            let quanta = ((v[k] * self.quanta_per_metre) * time).round_ties_even();
            p[k].wrapping_add(quanta as i32 as u32)
        })
    }

    /// The mid-step position.
    pub fn middle(&self, p: [u32; 3], v: [f32; 3], dt: f32) -> [u32; 3] {
        self.shifted(p, v, 0.5 * dt)
    }

    /// A coordinate with its sign: from -2^30 on, up to 3 2^30.
    pub fn signed(x: u32) -> i64 {
        if x < 3 << 30 { i64::from(x) } else { i64::from(x) - (1 << 32) }
    }

    /// The cell of a point, or the nearest that has neighbours on all sides.
    pub fn cell(&self, p: [u32; 3]) -> [u32; 3] {
        std::array::from_fn(|k| (Cells::signed(p[k]) >> self.bits).clamp(1, i64::from(self.counts[k]) - 2) as u32)
    }

    pub fn index(&self, cell: [u32; 3]) -> u32 {
        (cell[2] * self.counts[1] + cell[1]) * self.counts[0] + cell[0]
    }

    pub fn count(&self) -> usize {
        self.counts.iter().map(|&n| n as usize).product()
    }

    /// Whether two points come close enough for a neighbour list by the packed rule: the distance of their packed
    /// coordinates is below the square root of `near2`, for a whole cell 128 + sqrt(3) units.
    pub fn packed_near(&self, p: [u32; 3], q: [u32; 3], near2: u32) -> bool {
        let (p, q) = (self.units(p), self.units(q));
        (0..3).map(|k| (q[k] - p[k]).pow(2)).sum::<i64>() < i64::from(near2)
    }

    /// Whether two points are nearer than the edge of a cell, exactly.
    pub fn nearer_than_a_cell(&self, p: [u32; 3], q: [u32; 3]) -> bool {
        let d2 = (0..3).map(|k| Cells::signed(q[k]) - Cells::signed(p[k])).map(|d| i128::from(d * d)).sum::<i128>();
        d2 < 1 << (2 * self.bits)
    }

    /// A point's coordinates, no more than a cell beyond the grid, in 1/128 cells, rounded down.
    fn units(&self, p: [u32; 3]) -> [i64; 3] {
        std::array::from_fn(|k| {
            let end = i64::from(self.counts[k]) + 1;
            Cells::signed(p[k]).clamp(-1 << self.bits, (end << self.bits) - 1) >> (self.bits - 7)
        })
    }

    /// These modulo 8 cells in one word, with the mark of a point beyond its cell.
    pub fn packed(&self, p: [u32; 3]) -> u32 {
        let units = self.units(p);
        let part = |k: usize| (units[k].rem_euclid(1024) as u32) << (10 * k);
        part(0) | part(1) | part(2) | u32::from(self.astray(p)) << 30
    }

    /// Whether a point is beyond its cell.
    pub fn astray(&self, p: [u32; 3]) -> bool {
        (0..3).any(|k| Cells::signed(p[k]) >> self.bits != i64::from(self.cell(p)[k]))
    }

    /// Whether the cells of two points are the same or neighbours.
    pub fn touching(&self, p: [u32; 3], q: [u32; 3]) -> bool {
        self.cell(p).iter().zip(self.cell(q)).all(|(&a, b)| a.abs_diff(b) <= 1)
    }
}
