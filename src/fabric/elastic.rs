//! Materials of fabric, and their stiffness in the axes of the fibre.
//!
//! Plane stress. Along the fibre 1, across it 2: S11 = D11 E11 + D12 E22, S22 = D12 E11 + D22 E22, S12 = 2 G E12, with
//! D11 = E1/(1 - n12 n21), D22 = E2/(1 - n12 n21), D12 = n12 D22, n21 = n12 E2/E1. A uniaxial stress at an angle a to the fibre strains along itself by
//! C(a) = cos^4 a/E1 + sin^4 a/E2 + (1/G - 2 n12/E1) sin^2 a cos^2 a.

use super::error::{MembraneError, check};

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Elasticity {
    /// Pa; Poisson's ratio.
    Isotropic { young: f64, poisson: f64 },
    /// Along the fibre and across it; `poisson` is the contraction across under tension along.
    Orthotropic { young: [f64; 2], poisson: f64, shear: f64 },
    /// Two directions of threads that do not know of each other.
    Woven { young: [f64; 2], shear: f64 },
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    pub elasticity: Elasticity,
    /// kg/m3.
    pub density: f64,
    /// Damping of stretching in shares of the critical one of the finest waves, xi.
    pub damping: f64,
}

impl Material {
    pub const DAMPING: f64 = 0.05;
}

/// Moduli of a material: D11, D22, D12 and G in Pa.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stiffness {
    pub along: f64,
    pub across: f64,
    pub coupling: f64,
    pub shear: f64,
}

impl Elasticity {
    pub fn is_isotropic(&self) -> bool {
        matches!(self, Elasticity::Isotropic { .. })
    }

    /// E1, E2, n12, G.
    fn moduli(&self) -> ([f64; 2], f64, f64) {
        match *self {
            Elasticity::Isotropic { young, poisson } => ([young; 2], poisson, young / (2.0 * (1.0 + poisson))),
            Elasticity::Orthotropic { young, poisson, shear } => (young, poisson, shear),
            Elasticity::Woven { young, shear } => (young, 0.0, shear),
        }
    }

    /// Along the fibre, Pa.
    pub fn young(&self) -> f64 {
        self.moduli().0[0]
    }

    pub fn stiffness(&self) -> Stiffness {
        let (young, poisson, shear) = self.moduli();
        let determinant = 1.0 - poisson * poisson * young[1] / young[0];
        let [along, across] = young.map(|young| young / determinant);
        Stiffness { along, across, coupling: poisson * across, shear }
    }

    /// C(a) E1 = c0 + c1 x + c2 x^2 with x = cos 2a.
    pub fn compliance(&self) -> [f64; 3] {
        let (young, poisson, shear) = self.moduli();
        let ratio = young[0] / young[1];
        let mixed = young[0] / shear - 2.0 * poisson;
        [0.25 * (1.0 + ratio + mixed), 0.5 * (1.0 - ratio), 0.25 * (1.0 + ratio - mixed)]
    }

    /// The largest modulus of a plane wave of stretching, Pa; of an isotropic sheet E/(1 - nu^2).
    fn stiffest(&self) -> f64 {
        let Stiffness { along, across, coupling, shear } = self.stiffness();
        let modulus = |k: u32| {
            let c2 = 0.5 * (1.0 + (std::f64::consts::PI * f64::from(k) / 180.0).cos());
            let s2 = 1.0 - c2;
            c2 * c2 * along + s2 * s2 * across + 2.0 * c2 * s2 * (coupling + 2.0 * shear)
        };
        (0..=180).map(modulus).fold(0.0, f64::max)
    }
}

impl Material {
    /// Of the fastest wave of stretching, m/s.
    pub fn wave_speed(&self) -> f64 {
        (self.elasticity.stiffest() / self.density).sqrt()
    }

    /// # Errors
    /// If a number is none that a fabric has; `name` says whose.
    pub fn check(&self, name: &str) -> Result<(), MembraneError> {
        let (young, poisson, shear) = self.elasticity.moduli();
        let positive = |what: &str, value: f64| {
            check(value > 0.0 && value.is_finite(), || format!("{what} of {name}"), value, "a positive number")
        };
        positive("the density", self.density)?;
        positive("the modulus along the fibre", young[0])?;
        positive("the modulus across the fibre", young[1])?;
        let bound = (young[0] / young[1]).sqrt();
        let range = if self.elasticity.is_isotropic() { -1.0..=0.5 } else { -bound..=bound };
        let sound = range.contains(&poisson) && poisson.abs() < bound;
        let expected = "above -1, at most .5 if isotropic, and below the root of the moduli's ratio";
        check(sound, || format!("Poisson's ratio of {name}"), poisson, expected)?;
        positive("the shear modulus", shear)?;
        let damping = (0.0..=1.0).contains(&self.damping);
        check(damping, || format!("the damping of {name}"), self.damping, "from 0 to 1")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ISOTROPIC: Elasticity = Elasticity::Isotropic { young: 4e8, poisson: 0.3 };
    const WOVEN: Elasticity = Elasticity::Woven { young: [4e8, 3e8], shear: 5e6 };

    /// The compliance along a direction is that of the inverse stiffness.
    #[test]
    fn compliance_is_the_inverse_of_stiffness() {
        let other = Elasticity::Orthotropic { young: [4e8, 1e8], poisson: 0.4, shear: 2e7 };
        for elasticity in [ISOTROPIC, WOVEN, other] {
            let d = elasticity.stiffness();
            let c = elasticity.compliance();
            for k in 0..12 {
                let a = 0.3 * f64::from(k);
                let (sine, cosine) = a.sin_cos();
                let stress = [cosine * cosine, sine * sine, sine * cosine];
                let determinant = d.along * d.across - d.coupling * d.coupling;
                let strain = [
                    (d.across * stress[0] - d.coupling * stress[1]) / determinant,
                    (d.along * stress[1] - d.coupling * stress[0]) / determinant,
                    stress[2] / (2.0 * d.shear),
                ];
                let along = strain[0] * stress[0] + strain[1] * stress[1] + 2.0 * strain[2] * stress[2];
                let x = (2.0 * a).cos();
                let found = (c[0] + c[1] * x + c[2] * x * x) / elasticity.young();
                assert!((found / along - 1.0).abs() < 1e-12, "{elasticity:?} {a}: {found} {along}");
            }
        }
    }

    #[test]
    fn waves_are_as_fast_as_the_stiffest_direction() {
        let speed = |elasticity| Material { elasticity, density: 800.0, damping: 0.05 }.wave_speed();
        assert!((speed(ISOTROPIC) / (4e8f64 / 800.0 / 0.91).sqrt() - 1.0).abs() < 1e-12);
        assert!((speed(WOVEN) / (4e8f64 / 800.0).sqrt() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn bad_materials_are_refused() {
        let good = Material { elasticity: ISOTROPIC, density: 800.0, damping: 0.05 };
        assert!(good.check("fabric").is_ok());
        let isotropic = |young, poisson| Elasticity::Isotropic { young, poisson };
        let orthotropic = |poisson| Elasticity::Orthotropic { young: [1e8, 4e8], poisson, shear: 1e7 };
        let bad = [
            Material { density: 0.0, ..good },
            Material { damping: -0.1, ..good },
            Material { damping: f64::NAN, ..good },
            Material { elasticity: isotropic(-1.0, 0.3), ..good },
            Material { elasticity: isotropic(1e8, 0.51), ..good },
            Material { elasticity: isotropic(1e8, -1.0), ..good },
            Material { elasticity: orthotropic(0.5), ..good },
            Material { elasticity: Elasticity::Woven { young: [1e8, 1e8], shear: 0.0 }, ..good },
        ];
        for material in bad {
            let message = material.check("curtain").unwrap_err().to_string();
            assert!(message.contains("curtain") && message.contains("expected"), "{message}");
        }
        assert!(Material { elasticity: orthotropic(0.49), ..good }.check("fabric").is_ok());
    }
}
