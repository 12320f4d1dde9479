//! What the tallies of the coarse blocks say of the gas in them: density and heat, and from them the rate of
//! collisions and the share that is left of the cross-section where gas is dense (method.md, "Collisions").

use crate::gas::kinetics;
use crate::plan::Plan;
use crate::scene::Method;
use crate::subdomain::{BlockSum, FULL_SHARE, Scales};

/// The volume of a block with less gas volume than this share of a full one is too uncertain for a density of
/// its own: all such blocks count as one, so that the gas of a vessel thinner than a block counts too.
const LEAST_VOLUME: f64 = 0.05;

pub struct BlockGas {
    /// Gas volume of each block, m3.
    volumes: Vec<f64>,
    full: f64,
    /// sigma^2 pi sqrt(16 / (pi m_lightest / m_ref)): rate = this x n x sqrt(kT/m_ref). Where particles have no diameter sqrt(m_ref / m_lightest):
    /// then it is this x n^(1/3) x sqrt(kT/m_ref), in which a particle of thermal speed flies a mean spacing.
    rate: f64,
    by_spacing: bool,
    energy_unit: f64,
    cap: Option<Cap>,
}

/// The largest diameter, m, and how many mean spacings it may have.
#[derive(Debug, Clone, Copy)]
struct Cap {
    diameter: f64,
    spacings: f64,
}

/// Particles that see the same gas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Collisions per particle and second.
    pub rate: f64,
    pub number: u64,
}

impl BlockGas {
    pub fn new(plan: &Plan, volumes: Vec<f64>) -> BlockGas {
        let scales = Scales::new(plan);
        let lightest = plan.gases.iter().map(|gas| gas.molar_mass).fold(f64::INFINITY, f64::min);
        let heaviest = scales.reference_mass / plan.moles_per_particle;
        let pi = std::f64::consts::PI;
        let block_edge = plan.grid.cell * f64::from(1u32 << plan.block_cells_log2);
        BlockGas {
            rate: match plan.method {
                Method::None => 0.0,
                Method::HalfTurn => (heaviest / lightest).sqrt(),
                _ => plan.diameter * plan.diameter * pi * (16.0 / pi * heaviest / lightest).sqrt(),
            },
            by_spacing: plan.method == Method::HalfTurn,
            energy_unit: scales.block_energy,
            cap: plan.diameter_cap.map(|spacings| Cap { diameter: plan.diameter, spacings }),
            volumes,
            full: block_edge.powi(3),
        }
    }

    /// Of each block in [`FULL_SHARE`]ths, what is left of the cross-section; empty without a cap.
    pub fn shares(&self, blocks: &[BlockSum]) -> Vec<u32> {
        let Some(cap) = self.cap else { return Vec::new() };
        let (slivers, volume) = self.slivers(blocks);
        let of_slivers = cap.share(density(&slivers, volume));
        let of_block = |(block, &volume): (&BlockSum, &f64)| {
            if self.has_room(volume) { cap.share(density(block, volume)) } else { of_slivers }
        };
        blocks.iter().zip(&self.volumes).map(of_block).collect()
    }

    /// Entries of [`BlockGas::shares`].
    pub fn entries(&self) -> usize {
        if self.cap.is_some() { self.volumes.len() } else { 0 }
    }

    /// The collision rates in all gas, with these shares.
    pub fn parts(&self, blocks: &[BlockSum], shares: &[u32]) -> Vec<Part> {
        let share = |index: usize| shares.get(index).map_or(1.0, |&share| f64::from(share) / f64::from(FULL_SHARE));
        let mut parts = Vec::with_capacity(blocks.len());
        let mut sliver = None;
        for (index, (block, &volume)) in blocks.iter().zip(&self.volumes).enumerate() {
            if !self.has_room(volume) {
                sliver = Some(index);
            } else if block.number > 0 {
                parts.push(Part { rate: share(index) * self.collision_rate(block, volume), number: block.number });
            }
        }
        let (slivers, volume) = self.slivers(blocks);
        if let Some(index) = sliver.filter(|_| slivers.number > 0 && volume > 0.0) {
            parts.push(Part { rate: share(index) * self.collision_rate(&slivers, volume), number: slivers.number });
        }
        parts
    }

    fn has_room(&self, volume: f64) -> bool {
        volume > LEAST_VOLUME * self.full
    }

    /// All blocks without a density of their own. Empty ones too: with the few particles of a sliver, those that chance
    /// filled are too dense.
    fn slivers(&self, blocks: &[BlockSum]) -> (BlockSum, f64) {
        let (mut all, mut room) = (BlockSum { number: 0, energy: 0 }, 0.0);
        for (block, &volume) in blocks.iter().zip(&self.volumes).filter(|(_, volume)| !self.has_room(**volume)) {
            all.number += block.number;
            all.energy += block.energy;
            room += volume;
        }
        (all, room)
    }

    /// Collisions per particle and second in gas of this volume, m3.
    fn collision_rate(&self, gas: &BlockSum, volume: f64) -> f64 {
        let kt = 2.0 / 3.0 * gas.energy as f64 / self.energy_unit / gas.number as f64;
        let density = density(gas, volume);
        self.rate * if self.by_spacing { libm::cbrt(density) } else { density } * kt.sqrt()
    }
}

impl Cap {
    /// (sigma/sigma_max)^2, never nothing.
    fn share(self, density: f64) -> u32 {
        // Of most blocks it is known without a root that it is all, with room for any rounding.
        let least_spacing = self.diameter / self.spacings;
        if density * least_spacing.powi(3) < 1.0 - 1e-9 {
            return FULL_SHARE;
        }
        let ratio = kinetics::capped_diameter(self.diameter, Some(self.spacings), density) / self.diameter;
        ((ratio * ratio * f64::from(FULL_SHARE)).round() as u32).max(1)
    }
}

/// 1/m3, less one standard error: the noise of small blocks is no peak.
fn density(gas: &BlockSum, volume: f64) -> f64 {
    let number = gas.number as f64;
    if gas.number == 0 || volume <= 0.0 { 0.0 } else { (number - number.sqrt()) / volume }
}

#[cfg(test)]
pub mod tests {
    use super::*;

    /// A rate of n sqrt(kT) in blocks of 1 m3.
    pub fn block_gas(volumes: Vec<f64>) -> BlockGas {
        BlockGas { rate: 1.0, by_spacing: false, energy_unit: 1.0, volumes, full: 1.0, cap: None }
    }

    /// kT = 1.
    pub fn block(number: u64) -> BlockSum {
        BlockSum { number, energy: 3 * number / 2 }
    }

    fn surely(number: f64) -> f64 {
        number - number.sqrt()
    }

    #[test]
    fn gas_in_slivers_counts_as_a_whole() {
        let rates = |volumes: &[f64], numbers: &[u64]| -> Vec<f64> {
            let blocks: Vec<BlockSum> = numbers.iter().map(|&number| block(number)).collect();
            block_gas(volumes.to_vec()).parts(&blocks, &[]).iter().map(|part| part.rate).collect()
        };
        // A vessel thinner than a block: its density is that of all its blocks, however they share the volume.
        assert_eq!(rates(&[0.01, 0.03], &[60, 20]), [surely(80.0) / 0.04]);
        assert_eq!(rates(&[0.0, 0.04], &[60, 20]), [surely(80.0) / 0.04]);
        assert_eq!(rates(&[0.01, 0.03], &[80, 0]), [surely(80.0) / 0.04]);
        assert_eq!(rates(&[1.0, 1e-6], &[1000, 2])[0], surely(1000.0));
        assert_eq!(rates(&[1.0, 1e-6], &[0, 0]), [0.0; 0]);
    }

    /// sigma^2 ~ n^(-2/3) from the cap on; the rate then grows with the cube root of the density.
    #[test]
    fn the_cross_section_falls_where_gas_is_dense() {
        let volumes = vec![1.0, 1.0, 1.0, 0.01, 0.03];
        let cap = Some(Cap { diameter: 1.0, spacings: surely(1000.0).cbrt() });
        let gas = BlockGas { cap, ..block_gas(volumes) };
        let blocks = [block(1000), block(8000), block(0), block(100), block(220)];
        let shares = gas.shares(&blocks);
        let expected = |density: f64| (surely(1000.0) / density).powf(2.0 / 3.0);
        let near = |share: u32, expected: f64| (f64::from(share) / f64::from(FULL_SHARE) - expected).abs() < 2e-5;
        assert_eq!([shares[0], shares[2]], [FULL_SHARE; 2]);
        assert!(near(shares[1], expected(surely(8000.0))), "{shares:?}");
        assert!(near(shares[3], expected(surely(320.0) / 0.04)) && shares[4] == shares[3], "{shares:?}");
        let parts = gas.parts(&blocks, &shares);
        assert_eq!(parts.iter().map(|part| part.number).collect::<Vec<_>>(), [1000, 8000, 320]);
        let growth = parts[1].rate / parts[0].rate;
        assert!((growth - (surely(8000.0) / surely(1000.0)).cbrt()).abs() < 1e-3, "{growth}");
        assert_eq!(block_gas(vec![1.0]).shares(&[block(1_000_000)]), Vec::<u32>::new());
        assert_eq!(Cap { diameter: 1e10, spacings: 1.0 }.share(1e30), 1);
        // The first that have less than all are those of the diameter's own spacing.
        let cap = Cap { diameter: 0.3, spacings: 0.7 };
        let least = (0.7f64 / 0.3).powi(3);
        assert_eq!([0.0, 0.5, 1.0 - 1e-8, 1.0 + 1e-8].map(|part| cap.share(part * least)), [FULL_SHARE; 4]);
        assert!(cap.share(1.001 * least) < FULL_SHARE);
    }
}
