//! Kinetic theory of the modelled gas: rates, lengths and the spin exchange (docs/explanation/method.md, "The gas",
//! "Collisions", "Spin exchange").
//!
//! Works per molecule, per particle or per mole alike: only kT/m enters, passed as `thermal_square`
//! = kT/m = R T / M, m2/s2. Number densities are those of the particles, 1/m3.

use std::f64::consts::{PI, SQRT_2};

/// kT/m of a gas, m2/s2, from its temperature (K) and molar mass (kg/mol).
pub fn thermal_square(temperature: f64, molar_mass: f64) -> f64 {
    crate::scene::GAS_CONSTANT * temperature / molar_mass
}

/// sqrt(8 kT / (pi m)), m/s.
pub fn mean_speed(thermal_square: f64) -> f64 {
    (8.0 / PI * thermal_square).sqrt()
}

/// gbar = sqrt(16 kT / (pi m)) of two molecules of the same mass, m/s.
pub fn mean_relative_speed(thermal_square: f64) -> f64 {
    (16.0 / PI * thermal_square).sqrt()
}

/// lambda = 1 / (sqrt2 pi n sigma^2), m; infinite without collisions.
pub fn mean_free_path(number_density: f64, diameter: f64) -> f64 {
    1.0 / (SQRT_2 * PI * number_density * diameter * diameter)
}

/// The diameter (m) of a given mean free path (m).
pub fn diameter_of_path(number_density: f64, mean_free_path: f64) -> f64 {
    (1.0 / (SQRT_2 * PI * number_density * mean_free_path)).sqrt()
}

/// Mean free path of the real molecules of a gas of a concentration (mol/m3), m: that of rigid spheres of the size of
/// nitrogen and air, 3.7e-10 m (helium 2.2e-10, SF6 5.5e-10: handbooks, from viscosities).
pub fn molecular_mean_free_path(concentration: f64) -> f64 {
    const MOLECULE: f64 = 3.7e-10;
    const AVOGADRO: f64 = 6.022_140_76e23;
    mean_free_path(concentration * AVOGADRO, MOLECULE)
}

/// tau = 1 / (n pi sigma^2 gbar), s: the mean time between two collisions of one particle.
pub fn collision_time(number_density: f64, diameter: f64, thermal_square: f64) -> f64 {
    1.0 / (number_density * PI * diameter * diameter * mean_relative_speed(thermal_square))
}

/// f = n pi sigma^3 / 6.
pub fn occupancy(number_density: f64, diameter: f64) -> f64 {
    number_density * PI / 6.0 * diameter * diameter * diameter
}

/// Pressure of rigid spheres over n k T at an occupancy f: (1 + f + f^2 - f^3) / (1 - f)^3 (Carnahan and Starling
/// 1969; docs/explanation/method.md, "Collisions").
pub fn rigid_compressibility(occupancy: f64) -> f64 {
    let f = occupancy;
    (1.0 + f + f * f - f * f * f) / ((1.0 - f) * (1.0 - f) * (1.0 - f))
}

/// The diameter (m) of a given occupancy.
pub fn diameter(number_density: f64, occupancy: f64) -> f64 {
    libm::cbrt(6.0 * occupancy / (PI * number_density))
}

/// d = n^(-1/3), m.
pub fn mean_spacing(number_density: f64) -> f64 {
    1.0 / libm::cbrt(number_density)
}

/// lambda/d of rigid spheres that fill this part of space, were they without order: 1 / (sqrt2 pi (6 f/pi)^(2/3)).
pub fn mean_free_path_over_spacing(occupancy: f64) -> f64 {
    mean_free_path(1.0, diameter(1.0, occupancy))
}

/// A collision diameter, m, in gas of this density: at most `cap` of its mean spacings.
pub fn capped_diameter(diameter: f64, cap: Option<f64>, number_density: f64) -> f64 {
    match cap {
        Some(cap) if number_density > 0.0 => diameter.min(cap * mean_spacing(number_density)),
        _ => diameter,
    }
}

/// The mean free path that belongs to the measured viscosity of closest-approach, in units of the mean
/// spacing d (docs/explanation/method.md, "Collisions"): .83, .79, .69, .66 at f = .1, .12, .2, .4. Below f = .1 the
/// kinetic lambda/d scaled to meet the table; constant above .4.
pub fn effective_mean_free_path_over_spacing(occupancy: f64) -> f64 {
    const TABLE: [[f64; 2]; 4] = [[0.1, 0.83], [0.12, 0.79], [0.2, 0.69], [0.4, 0.66]];
    if occupancy <= TABLE[0][0] {
        // lambda/d ~ sigma^-2 ~ f^(-2/3) at fixed n.
        return TABLE[0][1] * libm::pow(TABLE[0][0] / occupancy, 2.0 / 3.0);
    }
    for pair in TABLE.windows(2) {
        let [[f0, l0], [f1, l1]] = [pair[0], pair[1]];
        if occupancy <= f1 {
            return l0 + (l1 - l0) * (occupancy - f0) / (f1 - f0);
        }
    }
    TABLE[3][1]
}

/// Kinematic viscosity of the method `half-turn` over d c0, in collision cells of 14 particles and steps of .6 d/c0; known to .03.
pub const HALF_TURN_VISCOSITY: f64 = 0.21;

/// The mean free paths, in mean spacings, by which a hole acts on gas of the method `half-turn`, into vacuum and by small differences of pressure. Into vacuum
/// its collision cells count, not its viscosity: a square hole of 8.9, 12, 15, 19 and 24 spacings has Cd .77, .79, .79, .81 and .82 (2 to 10 runs
/// each; `corpuscle verify half-turn-orifice --full` prints such), as one of Kn .5 to .7 d over the radius. By small differences it is that of particles of the usual occupancy (.12) with its kinematic viscosity, .21 d c0;
/// what these have is .783 lambda c0 times 1.31 ([`viscosity_of_crowds`]).
pub const HALF_TURN_PATHS: [f64; 2] = [0.55, HALF_TURN_VISCOSITY / 0.783 / 1.31];

/// How many times as viscous as their kinetic mean free path says particles are that crowd at this occupancy, over those at .12, about
/// which the discharge of holes was measured.
pub fn viscosity_of_crowds(occupancy: f64) -> f64 {
    const USUAL: f64 = 0.12;
    let over_kinetic = |f: f64| effective_mean_free_path_over_spacing(f) / mean_free_path_over_spacing(f);
    if occupancy <= USUAL { 1.0 } else { over_kinetic(occupancy) / over_kinetic(USUAL) }
}

/// What collisions across a cell carry, over the gas' own viscosity: this times the square of the cell's edge over the mean free path
/// (Alexander, Garcia and Alder, Phys. Fluids 10, 1540 (1998)).
pub const ACROSS_CELLS: f64 = 16.0 / (45.0 * PI);

/// How many times as viscous as the gas itself collisions within cells make it; `edge`: of a cell, over the mean free path. A hole acts on
/// such gas as one of so many times its Knudsen number: how far that holds, `docs/reference/limits.md`, `cell-edge`.
pub fn viscosity_of_cells(edge: f64) -> f64 {
    1.0 + ACROSS_CELLS * edge * edge
}

/// gamma = (5 + zeta) / (3 + zeta).
pub fn heat_capacity_ratio(spin_dof: f64) -> f64 {
    (5.0 + spin_dof) / (3.0 + spin_dof)
}

/// The smallest collision number Z that the exchange can give: that of P = 1. Zero without spin.
pub fn least_collision_number(spin_dof: f64) -> f64 {
    if spin_dof <= 0.0 {
        return 0.0;
    }
    (1.0 + spin_dof / 4.0) / (1.0 - 0.5 * spin_dof / (spin_dof + 4.0))
}

/// The probability P that a particle takes part in the spin exchange of a collision, for a collision
/// number Z: P = (1 - sqrt(1 - 2 a P0)) / a, a = zeta / (zeta + 4), P0 = (1 + zeta/4) / Z (docs/explanation/method.md,
/// "Spin exchange"). Zero for zeta = 0; `None` where Z is less than [`least_collision_number`].
pub fn exchange_probability(spin_dof: f64, collision_number: f64) -> Option<f64> {
    if spin_dof <= 0.0 {
        return Some(0.0);
    }
    let a = spin_dof / (spin_dof + 4.0);
    let p0 = (1.0 + spin_dof / 4.0) / collision_number;
    // Z exactly at its least value may miss 1 by rounding.
    let probability = (1.0 - (1.0 - 2.0 * a * p0).max(0.0).sqrt()) / a;
    (collision_number >= least_collision_number(spin_dof) * (1.0 - 1e-12)).then_some(probability.min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64, tolerance: f64) -> bool {
        (a / b - 1.0).abs() < tolerance
    }

    /// Nitrogen at 293 K: 470.6 m/s.
    #[test]
    fn mean_speed_of_nitrogen() {
        let speed = mean_speed(thermal_square(293.0, 0.0280134));
        assert!(close(speed, 470.6, 1e-3), "{speed}");
        assert!(!close(speed, 476.0, 1e-3));
    }

    /// Nitrogen at 293 K and 1 atm: 65 nm (handbooks: 66).
    #[test]
    fn molecules_meet_after_65_nm() {
        let path = molecular_mean_free_path(101_325.0 / (crate::scene::GAS_CONSTANT * 293.0));
        assert!(close(path, 66e-9, 0.03), "{path}");
    }

    /// The table of docs/explanation/method.md, "Collisions".
    #[test]
    fn rigid_spheres_press_harder() {
        for (f, expected) in [(0.01, 1.041), (0.03, 1.130), (0.1, 1.521), (0.2, 2.406), (0.3, 3.974)] {
            assert!((rigid_compressibility(f) - expected).abs() < 6e-4, "{f}: {}", rigid_compressibility(f));
        }
        assert_eq!(rigid_compressibility(0.0), 1.0);
    }

    /// lambda = cbar tau, with gbar = sqrt2 cbar.
    #[test]
    fn lengths_and_times_agree() {
        let (n, sigma, c2) = (1.6e7, 2.4e-3, 9e4);
        assert!(close(mean_free_path(n, sigma), mean_speed(c2) * collision_time(n, sigma, c2), 1e-14));
        assert!(close(occupancy(n, diameter(n, 0.12)), 0.12, 1e-14));
        // f = .12 is sigma = .61 d, and lambda = sigma there within 2 %.
        assert!(close(diameter(n, 0.12), 0.612 * mean_spacing(n), 1e-3));
        assert!(close(mean_free_path(n, diameter(n, 0.12)), diameter(n, 0.12), 0.02));
        assert!(mean_free_path(n, 0.0).is_infinite());
    }

    #[test]
    fn gas_in_coarser_cells_is_more_viscous() {
        assert!(close(viscosity_of_cells(1.0), 1.1132, 1e-4));
        // A tenth more viscous for cells as long as a free path, twice as viscous for those of plans at f = .12.
        let edge = libm::cbrt(6.0) / mean_free_path_over_spacing(0.12);
        assert!(close(viscosity_of_cells(edge), 2.02, 0.01), "{}", viscosity_of_cells(edge));
    }

    /// At the usual occupancy the kinetic mean free path counts; denser gas is more viscous than by that: at a third of the space .55 d c0
    /// (docs/explanation/method.md, "Collisions") where the kinetic path has .24.
    #[test]
    fn crowds_are_more_viscous() {
        assert_eq!([0.0, 0.05, 0.12].map(viscosity_of_crowds), [1.0; 3]);
        assert!(close(viscosity_of_crowds(0.34), 1.7, 0.02), "{}", viscosity_of_crowds(0.34));
        assert!(viscosity_of_crowds(0.1201) < 1.001);
    }

    #[test]
    fn effective_mean_free_path_meets_its_table_and_falls() {
        for (f, expected) in [(0.1, 0.83), (0.12, 0.79), (0.2, 0.69), (0.4, 0.66), (0.7, 0.66)] {
            assert!(close(effective_mean_free_path_over_spacing(f), expected, 1e-12));
        }
        let falls = |a, b| effective_mean_free_path_over_spacing(a) > effective_mean_free_path_over_spacing(b);
        assert!(falls(0.05, 0.1) && falls(0.0999, 0.1001) && falls(0.2, 0.3));
        assert!(!falls(0.3, 0.2));
    }

    /// Both particles' exchanges together relax at the rate that defines Z: P - a P^2 / 2 = P0.
    #[test]
    fn exchange_probability_solves_its_equation() {
        for zeta in [1.0, 2.0, 5.0] {
            for z in [5.0, 20.0] {
                let p = exchange_probability(zeta, z).unwrap();
                let a = zeta / (zeta + 4.0);
                assert!(close(p - 0.5 * a * p * p, (1.0 + zeta / 4.0) / z, 1e-12));
                assert!(!close(p, (1.0 + zeta / 4.0) / z, 1e-3), "the correction is not negligible");
            }
            let least = least_collision_number(zeta);
            assert!(close(exchange_probability(zeta, least).unwrap(), 1.0, 1e-9));
            assert_eq!(exchange_probability(zeta, 0.99 * least), None);
        }
        assert_eq!(exchange_probability(0.0, 5.0), Some(0.0));
    }

    #[test]
    fn heat_capacity_ratios() {
        assert_eq!(heat_capacity_ratio(0.0), 5.0 / 3.0);
        assert_eq!(heat_capacity_ratio(2.0), 1.4);
    }
}
