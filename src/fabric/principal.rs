//! Principal strains and stresses of a triangle, as engineers give them.
//!
//! The stretches are the roots of the eigenvalues of C = F^T F = 1 + 2E; a strain is a stretch less one. A stress is force over the width and
//! thickness without stress: a singular value of F S, s1^2 + s2^2 = tr(S C S), s1 s2 = det S sqrt(det C). (The present width of a wrinkled
//! triangle is not that of its fabric.) Of a wrinkled triangle one is zero, of a slack one both: the share of an elastic sheet's stress that
//! keeps modes stiff ([`super::law::COMPRESSION`]) is left out.

use glam::DVec3;

use super::law::{Law, Taut, contracted, principal};
use super::model::{Model, Triangle};

/// The larger first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    pub strains: [f64; 2],
    /// Pa.
    pub stresses: [f64; 2],
    pub taut: Taut,
}

impl Model {
    /// Of a triangle whose corners are at these places, m.
    pub fn principal(&self, triangle: &Triangle, [a, b, c]: [DVec3; 3]) -> Principal {
        let strain = self.strain(triangle, [b - a, c - a]);
        let law = Law { compression: 0.0, ..self.laws[triangle.material] };
        let found = law.stress(strain);
        let squares = [1.0 + 2.0 * strain[0], 1.0 + 2.0 * strain[1], 2.0 * strain[2]];
        let determinant = |[xx, yy, xy]: [f64; 3]| xx * yy - xy * xy;
        let [xx, yy, xy] = found.stress;
        let trace = contracted([xx * xx + xy * xy, yy * yy + xy * xy, xy * (xx + yy)], squares);
        let stresses = match found.taut {
            Taut::Nothing => [0.0; 2],
            Taut::Along(_) => [trace.sqrt(), 0.0],
            Taut::Both => {
                let product = determinant(found.stress) * determinant(squares).max(0.0).sqrt();
                let [sum, difference] =
                    [trace + 2.0 * product, trace - 2.0 * product].map(|square| square.max(0.0).sqrt());
                [0.5 * (sum + difference), 0.5 * (sum - difference)]
            }
        };
        let strains = principal(strain).map(|strain| {
            let stretch = (1.0 + 2.0 * strain).max(0.0).sqrt();
            // (So that small strains keep their digits.)
            2.0 * strain / (stretch + 1.0)
        });
        Principal { strains, stresses, taut: found.taut }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fabric::{Elasticity, Element, Hold, Material, MembraneInput};
    use crate::geometry::Grid;

    const YOUNG: f64 = 4e8;
    const POISSON: f64 = 0.3;

    /// A triangle with sides of .1 m along x and y without stress.
    fn model(elasticity: Elasticity) -> Model {
        let places = [[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]];
        let input = MembraneInput {
            grid: &Grid { origin: [-1.0; 3], cell: 0.01, cells: [200; 3], cell_bits: 20 },
            nodes: &places,
            velocities: &[[0.0; 3]; 3],
            triangles: &[[0, 1, 2]],
            elements: &[Element::of_places(places, 3e-4, 0)],
            materials: &[Material { elasticity, density: 800.0, damping: 0.0 }],
            added_masses: &[0.0; 3],
            frictions: &[],
            holds: &[Hold::Free; 3],
            gravity: [0.0; 3],
            substeps: 1,
            steps_per_interval: 1,
            impulse_unit: 1.0,
            drag: 0.0,
        };
        Model::new(&input).expect("a membrane")
    }

    /// Stretched by two factors along x and y, then turned.
    fn stretched(elasticity: Elasticity, [x, y]: [f64; 2]) -> Principal {
        let model = model(elasticity);
        let turn = glam::DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -0.5).normalize(), 0.7);
        let corner = |u: f64, v: f64| turn * DVec3::new(0.1 * x * u, 0.1 * y * v, 0.0);
        model.principal(&model.triangles[0], [corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)])
    }

    fn assert_near(found: [f64; 2], expected: [f64; 2], size: f64) {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-6 * size, "{found} instead of {expected}");
        }
    }

    /// Under both stretches S = D E, and force over the width without stress is that times the stretch.
    #[test]
    fn a_sheet_pulled_both_ways_has_the_forces_of_its_law() {
        let (x, y) = (1.02, 1.01);
        let found = stretched(Elasticity::Isotropic { young: YOUNG, poisson: POISSON }, [x, y]);
        assert_eq!(found.taut, Taut::Both);
        assert_near(found.strains, [0.02, 0.01], 1.0);
        let green = [x, y].map(|stretch| 0.5 * (stretch * stretch - 1.0));
        let modulus = YOUNG / (1.0 - POISSON * POISSON);
        let stress = |own: f64, other: f64| modulus * (own + POISSON * other);
        assert_near(found.stresses, [x * stress(green[0], green[1]), y * stress(green[1], green[0])], YOUNG);
        // The check can fail: without the stretch it would be off.
        assert!((found.stresses[0] - stress(green[0], green[1])).abs() > 1e-5 * YOUNG);
    }

    #[test]
    fn a_wrinkled_sheet_pulls_one_way_and_a_slack_one_not_at_all() {
        for elasticity in [
            Elasticity::Isotropic { young: YOUNG, poisson: POISSON },
            Elasticity::Woven { young: [YOUNG, YOUNG], shear: 5e6 },
        ] {
            let (x, y) = (1.01, 0.97);
            let found = stretched(elasticity, [x, y]);
            assert!(matches!(found.taut, Taut::Along(_)));
            assert_near(found.strains, [0.01, -0.03], 1.0);
            assert_near(found.stresses, [x * YOUNG * 0.5 * (x * x - 1.0), 0.0], YOUNG);
            assert_eq!(found.stresses[1], 0.0);
            let slack = stretched(elasticity, [0.99, 0.98]);
            assert_eq!((slack.taut, slack.stresses), (Taut::Nothing, [0.0; 2]));
            assert_near(slack.strains, [-0.01, -0.02], 1.0);
        }
    }
}
