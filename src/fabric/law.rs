//! The stress of a membrane that bears tension only, by its relaxed (tension-field) energy (Pipkin, IMA J. Appl. Math. 36 (1986) 85).
//!
//! W(E) is the least energy with any wrinkles, max over stresses S without compression of S:E - S:C:S/2, and S = dW/dE. With S^ = D:E:
//! - lowest principal S^ >= 0: S = S^, W = S^:E/2;
//! - else along the t that maximises e_t/sqrt(C_t), if that is positive: S = (e_t/C_t) t t^T, W = e_t^2/(2 C_t); of an isotropic sheet t is
//!   along the larger principal strain and C_t = 1/E;
//! - else S = 0;
//!
//! then S <- (1 - k) S + k S^ with k = [`COMPRESSION`], so that no mode is without stiffness. In f64 what `shaders/membrane/shared/stress.wgsl` does.

use super::elastic::{Elasticity, Stiffness};

/// The share of an elastic sheet's stress that a slack membrane has.
pub const COMPRESSION: f64 = 1e-3;

/// Directions from which the search for the one that bears tension begins, and its steps.
const STARTS: usize = 16;
const REFINEMENTS: usize = 12;
/// Cosine, sine and the tangent of half the angle between two starts, a turn over [`STARTS`].
const BETWEEN: [f64; 2] = [0.923_879_532_511_286_7, 0.382_683_432_365_089_8];
const HALF_BETWEEN: f64 = 0.198_912_367_379_658;

/// Symmetric: xx, yy, xy.
pub type Symmetric = [f64; 3];

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law {
    pub stiffness: Stiffness,
    /// C(a) E1 = c0 + c1 x + c2 x^2 with x = cos 2a.
    pub compliance: [f64; 3],
    /// Along the fibre, Pa.
    pub young: f64,
    pub isotropic: bool,
    /// k.
    pub compression: f64,
}

/// What bears tension.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Taut {
    Nothing,
    /// A direction, by its doubled angle (cos 2a, sin 2a).
    Along([f64; 2]),
    Both,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stress {
    /// Pa.
    pub stress: Symmetric,
    /// J/m3.
    pub energy: f64,
    pub taut: Taut,
}

/// S:E.
pub fn contracted(stress: Symmetric, strain: Symmetric) -> f64 {
    stress[0] * strain[0] + stress[1] * strain[1] + 2.0 * stress[2] * strain[2]
}

/// Mean and deviator: along d a tensor has mean + dot(deviator, d).
fn split(tensor: Symmetric) -> (f64, [f64; 2]) {
    (0.5 * (tensor[0] + tensor[1]), [0.5 * (tensor[0] - tensor[1]), tensor[2]])
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// The eigenvalues, the larger first.
pub fn principal(tensor: Symmetric) -> [f64; 2] {
    let (mean, other) = split(tensor);
    let radius = libm::hypot(other[0], other[1]);
    [mean + radius, mean - radius]
}

impl Law {
    pub fn new(elasticity: &Elasticity) -> Law {
        Law {
            stiffness: elasticity.stiffness(),
            compliance: elasticity.compliance(),
            young: elasticity.young(),
            isotropic: elasticity.is_isotropic(),
            compression: COMPRESSION,
        }
    }

    /// S^ = D:E, of a sheet that bears compression, too.
    pub fn as_a_sheet(&self, strain: Symmetric) -> Symmetric {
        let d = &self.stiffness;
        [
            d.along * strain[0] + d.coupling * strain[1],
            d.coupling * strain[0] + d.across * strain[1],
            2.0 * d.shear * strain[2],
        ]
    }

    pub fn stress(&self, strain: Symmetric) -> Stress {
        let sheet = self.as_a_sheet(strain);
        let full = 0.5 * contracted(sheet, strain);
        if principal(sheet)[1] >= 0.0 {
            return Stress { stress: sheet, energy: full, taut: Taut::Both };
        }
        let (mean, other) = split(strain);
        let direction = if self.isotropic { turned_to(other) } else { self.steepest(mean, other) };
        let along = (mean + dot(other, direction)).max(0.0);
        let pull = along * self.young / self.flexibility(direction[0]);
        let dyad = [0.5 * (1.0 + direction[0]), 0.5 * (1.0 - direction[0]), 0.5 * direction[1]];
        let k = self.compression;
        Stress {
            stress: std::array::from_fn(|i| (1.0 - k) * pull * dyad[i] + k * sheet[i]),
            energy: (1.0 - k) * 0.5 * pull * along + k * full,
            taut: if along > 0.0 { Taut::Along(direction) } else { Taut::Nothing },
        }
    }

    /// C_t E1.
    fn flexibility(&self, x: f64) -> f64 {
        let c = self.compliance;
        c[0] + x * (c[1] + x * c[2])
    }

    /// The direction that maximises e_t/sqrt(C_t): from the best of some starts by Newton's steps that stay in a bracket. (Turned by an angle by the tangent of
    /// its half, so without a function that systems round differently.)
    fn steepest(&self, mean: f64, other: [f64; 2]) -> [f64; 2] {
        let value = |d: [f64; 2]| (mean + dot(other, d)) / self.flexibility(d[0]).sqrt();
        let (mut start, mut best, mut most) = ([1.0, 0.0], [1.0, 0.0], f64::NEG_INFINITY);
        for _ in 0..STARTS {
            let here = value(start);
            if here > most {
                (most, best) = (here, start);
            }
            start = turned(start, BETWEEN);
        }
        let (mut low, mut high, mut half) = (-HALF_BETWEEN, HALF_BETWEEN, 0.0);
        let mut direction = best;
        for _ in 0..REFINEMENTS {
            let [slope, bend] = self.slope(mean, other, direction);
            if slope > 0.0 {
                low = half
            } else {
                high = half
            }
            let next = half - 0.5 * (1.0 + half * half) * slope / bend;
            half = if bend < 0.0 && (low..=high).contains(&next) { next } else { 0.5 * (low + high) };
            let size = 1.0 + half * half;
            direction = turned(best, [(1.0 - half * half) / size, 2.0 * half / size]);
        }
        direction
    }

    /// Of e_t/sqrt(C_t) along a direction: its slope times a positive number, and the change of that, with the doubled angle.
    fn slope(&self, mean: f64, other: [f64; 2], [x, y]: [f64; 2]) -> [f64; 2] {
        let c = self.compliance;
        let along = dot(other, [x, y]);
        let (strain, strain1) = (mean + along, other[1] * x - other[0] * y);
        let flexibility = self.flexibility(x);
        let flexibility1 = -(c[1] + 2.0 * c[2] * x) * y;
        let flexibility2 = -(c[1] * x + 2.0 * c[2] * (x * x - y * y));
        [
            strain1 * flexibility - 0.5 * strain * flexibility1,
            0.5 * strain1 * flexibility1 - along * flexibility - 0.5 * strain * flexibility2,
        ]
    }
}

fn turned([x, y]: [f64; 2], [cosine, sine]: [f64; 2]) -> [f64; 2] {
    [x * cosine - y * sine, x * sine + y * cosine]
}

fn turned_to(other: [f64; 2]) -> [f64; 2] {
    let size = libm::hypot(other[0], other[1]);
    if size > 0.0 { other.map(|x| x / size) } else { [1.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    pub(super) const FABRICS: [Elasticity; 3] = [
        Elasticity::Isotropic { young: 4e8, poisson: 0.3 },
        Elasticity::Orthotropic { young: [4e8, 2e8], poisson: 0.3, shear: 5e7 },
        Elasticity::Woven { young: [4e8, 3e8], shear: 5e6 },
    ];

    proptest! {
        /// S = dW/dE, W is convex between two strains, and no energy is below that of the relaxed sheet.
        #[test]
        fn stress_has_a_potential(
            a in prop::array::uniform3(-1e-2..1e-2f64),
            b in prop::array::uniform3(-1e-2..1e-2f64),
            which in 0..3usize,
        ) {
            let law = Law::new(&FABRICS[which]);
            let energy = |strain| law.stress(strain).energy;
            let step = 1e-7;
            for i in 0..3 {
                let moved = |by: f64| { let mut strain = a; strain[i] += by; energy(strain) };
                let slope = (moved(step) - moved(-step)) / (2.0 * step);
                let expected = law.stress(a).stress[i] * if i == 2 { 2.0 } else { 1.0 };
                // What the curvature of W may do to a difference over 1e-7.
                prop_assert!((slope - expected).abs() < 1e-7 * 2e9, "{i}: {slope} {expected}");
            }
            let middle = std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
            prop_assert!(energy(middle) <= 0.5 * (energy(a) + energy(b)) + 1e-9 * 4e8 * 1e-4);
            prop_assert!(energy(a) <= 0.5 * contracted(law.as_a_sheet(a), a) * (1.0 + 1e-12));
            prop_assert!(energy(a) >= 0.0);
        }

        /// But for the share k there is no compression.
        #[test]
        fn a_membrane_bears_no_compression(strain in prop::array::uniform3(-1e-2..1e-2f64), which in 0..3usize) {
            let law = Law { compression: 0.0, ..Law::new(&FABRICS[which]) };
            let [most, least] = principal(law.stress(strain).stress);
            prop_assert!(least >= -1e-12 * most.max(1.0), "{least}");
        }
    }

    /// Uniaxial: under tension along an axis with any contraction beyond Poisson's, S = E e.
    #[test]
    fn a_wrinkled_strip_pulls_with_its_young_modulus() {
        for elasticity in FABRICS {
            let law = Law { compression: 0.0, ..Law::new(&elasticity) };
            let found = law.stress([1e-3, -2e-3, 0.0]);
            assert!((found.stress[0] / (1e-3 * elasticity.young()) - 1.0).abs() < 1e-9, "{found:?}");
            assert!(matches!(found.taut, Taut::Along([x, _]) if x > 1.0 - 1e-9), "{found:?}");
            assert_eq!(law.stress([-1e-3, -1e-3, 0.0]).taut, Taut::Nothing);
            assert_eq!(law.stress([1e-3, 1e-3, 0.0]).taut, Taut::Both);
        }
    }
}
