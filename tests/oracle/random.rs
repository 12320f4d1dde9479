//! Philox 4x32-10 from its definition (Salmon, Moraes, Dror, Shaw 2011), and a stream of draws for making
//! random inputs.

/// Four random words of a counter under a key.
pub fn philox(counter: [u32; 4], key: [u32; 2]) -> [u32; 4] {
    let (mut c, mut k) = (counter, key);
    for round in 0..10 {
        if round > 0 {
            k = [k[0].wrapping_add(0x9E37_79B9), k[1].wrapping_add(0xBB67_AE85)];
        }
        let first = 0xD251_1F53_u64 * u64::from(c[0]);
        let second = 0xCD9E_8D57_u64 * u64::from(c[2]);
        let high = |product: u64| (product >> 32) as u32;
        c = [high(second) ^ c[1] ^ k[0], second as u32, high(first) ^ c[3] ^ k[1], first as u32];
    }
    c
}

/// The uniform in (0, 1) that collisions make of a word: its upper 24 bits and a half.
pub fn unit_interval(word: u32) -> f64 {
    (f64::from(word >> 8) + 0.5) / f64::from(1 << 24)
}

/// Successive draws for random inputs.
pub struct Stream {
    key: u32,
    used: u32,
}

impl Stream {
    pub fn new(key: u32) -> Stream {
        Stream { key, used: 0 }
    }

    pub fn word(&mut self) -> u32 {
        self.used += 1;
        philox([self.used, 0, 0, 0], [self.key, 0x7465_7374])[0]
    }

    pub fn uniform(&mut self) -> f64 {
        (f64::from(self.word()) + 0.5) / 4_294_967_296.0
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    pub fn below(&mut self, limit: u32) -> u32 {
        (self.uniform() * f64::from(limit)) as u32
    }

    /// Standard normal (Box and Muller 1958).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }

    pub fn normals(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.normal())
    }

    /// A uniform direction.
    pub fn direction(&mut self) -> [f64; 3] {
        super::vector::unit(self.normals())
    }

    /// Gamma variate of unit scale for a shape that is a whole multiple of one half: a sum of half squares of
    /// normals.
    pub fn half_chi_square(&mut self, degrees: u32) -> f64 {
        (0..degrees).map(|_| 0.5 * self.normal().powi(2)).sum()
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for k in (1..items.len()).rev() {
            items.swap(k, self.below(k as u32 + 1) as usize);
        }
    }
}
