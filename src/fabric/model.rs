//! A membrane on the host, in f64: checked, its triangles with what does not change.
//!
//! Total Lagrangian triangles of constant strain. With the edges e2, e3 from the first corner and the gradients g2, g3 of the shares N of the others in the reference,
//! F = e2 g2^T + e3 g3^T, E = (F^T F - I)/2 = sum of (e_i.e_j - e0_i.e0_j) g_i g_j^T / 2, and the force on corner a is -V F S g_a, V the reference's volume.
//! Damping adds S = 2 eta dE/dt along what bears tension, eta = xi rho c h/2 with the wave speed c and the least height h. Pressure p puts p A n/3 on each
//! corner. Masses are lumped: a third of a triangle's on each corner.
//!
//! A reference whose lengths are s times the true ones ([`Model::sizes`]) has (C/s^2 - 1)/2 in place of E, with C = 1 + 2E, and s^2 V in place of V; forces
//! stay -V F S g_a.

use std::ops::Range;

use glam::DVec3;

use super::elastic::Material;
use super::error::{MembraneError, check};
use super::input::{Element, Hold, MembraneInput};
use super::law::{Law, Stress, Symmetric, Taut};

/// Edges of a reference in quanta: their squares have a sum in 63 bits.
const LONGEST_EDGE: f64 = 1_073_741_824.0;

/// A triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    pub nodes: [u32; 3],
    pub material: usize,
    /// Of the second corner's share and of the third's, in the axes of the fibre, 1/m.
    pub gradients: [[f64; 2]; 2],
    /// Of the reference's edges: squares of the second's and the third's, and their product, quanta^2.
    pub metric: [i64; 3],
    /// m3.
    pub volume: f64,
    /// eta, Pa s.
    pub viscosity: f64,
    /// Pa.
    pub pressure: f64,
}

/// What a triangle puts on its corners, N; on the first minus the sum of the others, but for pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Forces {
    pub strain: [DVec3; 2],
    pub damping: [DVec3; 2],
    /// On each corner.
    pub pressure: DVec3,
    /// J.
    pub energy: f64,
    pub taut: Taut,
}

#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    pub origin: [f64; 3],
    /// m.
    pub quantum: f64,
    pub triangles: Vec<Triangle>,
    pub laws: Vec<Law>,
    /// Of each material the lengths of its reference over the true ones: 1, but of one that changes.
    pub sizes: Vec<f64>,
    /// kg.
    pub masses: Vec<f64>,
    pub holds: Vec<Hold>,
}

impl Model {
    /// # Errors
    /// If lists do not fit each other, or a number is none that a membrane has.
    pub fn new(input: &MembraneInput<'_>) -> Result<Model, MembraneError> {
        check_lists(input)?;
        for (k, material) in input.materials.iter().enumerate() {
            material.check(&format!("material {k}"))?;
        }
        let mut masses = input.added_masses.to_vec();
        for (node, &mass) in masses.iter().enumerate() {
            let sound = mass >= 0.0 && mass.is_finite();
            check(sound, || format!("the added mass of node {node}"), mass, "kg, not negative")?;
        }
        let mut triangles = Vec::with_capacity(input.triangles.len());
        for (k, (nodes, element)) in input.triangles.iter().zip(input.elements).enumerate() {
            let (materials, material) = (input.materials, element.material);
            let known = materials.get(material);
            let known = known.ok_or(MembraneError::NoMaterial { triangle: k, material, materials: materials.len() })?;
            let triangle = triangle(k, *nodes, element, known, input.grid.quantum())?;
            for &node in nodes {
                let count = masses.len();
                let mass = masses.get_mut(node as usize);
                *mass.ok_or(MembraneError::NoNode { triangle: k, node, nodes: count })? +=
                    known.density * triangle.volume / 3.0;
            }
            triangles.push(triangle);
        }
        let unloaded = |(mass, hold): (&f64, &Hold)| *mass <= 0.0 && *hold == Hold::Free;
        if let Some(node) = masses.iter().zip(input.holds).position(unloaded) {
            return Err(MembraneError::NoMass { node });
        }
        Ok(Model {
            origin: input.grid.origin,
            quantum: input.grid.quantum(),
            triangles,
            laws: input.materials.iter().map(|material| Law::new(&material.elasticity)).collect(),
            sizes: vec![1.0; input.materials.len()],
            masses,
            holds: input.holds.to_vec(),
        })
    }

    /// Green's strain of a triangle with these edges from its first corner, m.
    pub fn strain(&self, triangle: &Triangle, edges: [DVec3; 2]) -> Symmetric {
        let [e2, e3] = edges;
        let metric = [e2.length_squared(), e3.length_squared(), e2.dot(e3)];
        let unit = self.quantum * self.quantum;
        let strain = by_gradients(triangle, std::array::from_fn(|i| metric[i] - triangle.metric[i] as f64 * unit));
        let square = self.square(triangle);
        let grown = 0.5 * (1.0 - square);
        [(strain[0] + grown) / square, (strain[1] + grown) / square, strain[2] / square]
    }

    /// s^2.
    fn square(&self, triangle: &Triangle) -> f64 {
        self.sizes[triangle.material].powi(2)
    }

    /// Of a triangle whose corners are at these places, m; in the axes of its fibre.
    pub fn stress(&self, triangle: &Triangle, corners: [DVec3; 3]) -> Stress {
        let [a, b, c] = corners;
        self.laws[triangle.material].stress(self.strain(triangle, [b - a, c - a]))
    }

    /// What a triangle puts on its corners at these places (m) with these velocities (m/s).
    pub fn forces(&self, triangle: &Triangle, corners: [DVec3; 3], velocities: [DVec3; 3]) -> Forces {
        let edges = [corners[1] - corners[0], corners[2] - corners[0]];
        let rates = [velocities[1] - velocities[0], velocities[2] - velocities[0]];
        let found = self.stress(triangle, corners);
        let metric_rate = [
            2.0 * edges[0].dot(rates[0]),
            2.0 * edges[1].dot(rates[1]),
            edges[0].dot(rates[1]) + edges[1].dot(rates[0]),
        ];
        let square = self.square(triangle);
        let rate = in_tension(found.taut, by_gradients(triangle, metric_rate).map(|rate| rate / square));
        Forces {
            strain: triangle.pull(edges, found.stress),
            damping: triangle.pull(edges, rate.map(|rate| 2.0 * triangle.viscosity * rate)),
            pressure: edges[0].cross(edges[1]) * (triangle.pressure / 6.0),
            energy: triangle.volume * square * found.energy,
            taut: found.taut,
        }
    }

    /// Of all triangles with nodes at these places (m), J.
    pub fn strain_energy(&self, places: &[DVec3]) -> f64 {
        self.strain_energy_of(0..self.triangles.len(), places)
    }

    /// Of these triangles.
    pub fn strain_energy_of(&self, triangles: Range<usize>, places: &[DVec3]) -> f64 {
        let energy = |triangle: &Triangle| {
            let corners = triangle.nodes.map(|node| places[node as usize]);
            triangle.volume * self.square(triangle) * self.stress(triangle, corners).energy
        };
        self.triangles[triangles].iter().map(energy).sum()
    }
}

fn check_lists(input: &MembraneInput<'_>) -> Result<(), MembraneError> {
    let nodes = input.nodes.len();
    let lists = [
        ("velocities", input.velocities.len(), nodes),
        ("added masses", input.added_masses.len(), nodes),
        ("holds", input.holds.len(), nodes),
        ("frictions", if input.frictions.is_empty() { nodes } else { input.frictions.len() }, nodes),
        ("elements", input.elements.len(), input.triangles.len()),
    ];
    for (what, found, expected) in lists {
        if found != expected {
            return Err(MembraneError::Count { what, found, expected });
        }
    }
    let substeps = f64::from(input.substeps);
    check(input.substeps > 0, || "fabric steps in a step".into(), substeps, "one at least")?;
    let steps = f64::from(input.steps_per_interval);
    check(input.steps_per_interval > 0, || "steps in an interval".into(), steps, "one at least")?;
    let unit = input.impulse_unit;
    check(unit > 0.0 && unit.is_finite(), || "the unit of impulses".into(), unit, "kg m/s, positive")?;
    check(input.drag >= 0.0 && input.drag.is_finite(), || "the drag".into(), input.drag, "1/s, not negative")?;
    for g in input.gravity {
        check(g.is_finite(), || "gravity".into(), g, "m/s2, finite")?;
    }
    Ok(())
}

fn triangle(
    k: usize,
    nodes: [u32; 3],
    element: &Element,
    material: &Material,
    quantum: f64,
) -> Result<Triangle, MembraneError> {
    let of = |what: &str| format!("{what} of triangle {k}");
    let thickness = element.thickness;
    check(thickness > 0.0 && thickness.is_finite(), || of("the thickness"), thickness, "m, positive")?;
    check(element.pressure.is_finite(), || of("the pressure"), element.pressure, "Pa, finite")?;
    let area = element.area();
    check(area > 0.0 && area.is_finite(), || of("the reference area"), area, "m2, positive (counter-clockwise)")?;
    let length = libm::hypot(element.second[0], element.second[1]).max(libm::hypot(element.third[0], element.third[1]));
    check(length < LONGEST_EDGE * quantum, || of("the reference edge"), length, "less than 2^30 quanta of the grid")?;
    // In the axes of the fibre.
    let (sine, cosine) = (libm::sin(element.fibre), libm::cos(element.fibre));
    let turned = |[x, y]: [f64; 2]| [cosine * x + sine * y, cosine * y - sine * x];
    let ([a, b], [c, d]) = (turned(element.second), turned(element.third));
    let determinant = 2.0 * area;
    let dot = |p: [f64; 2], q: [f64; 2]| ((p[0] * q[0] + p[1] * q[1]) / (quantum * quantum)).round() as i64;
    let volume = area * thickness;
    check(element.fibre.is_finite(), || of("the fibre's angle"), element.fibre, "rad, finite")?;
    Ok(Triangle {
        nodes,
        material: element.material,
        gradients: [[d / determinant, -c / determinant], [-b / determinant, a / determinant]],
        metric: [
            dot(element.second, element.second),
            dot(element.third, element.third),
            dot(element.second, element.third),
        ],
        volume,
        viscosity: 0.5 * material.damping * material.density * material.wave_speed() * element.height(),
        pressure: element.pressure,
    })
}

/// Half the sum of changes of the metric (22, 33, 23) with both gradients.
fn by_gradients(triangle: &Triangle, metric: [f64; 3]) -> Symmetric {
    let [p, q] = triangle.gradients;
    let sum = |i: usize, k: usize| {
        metric[0] * p[i] * p[k] + metric[1] * q[i] * q[k] + metric[2] * (p[i] * q[k] + q[i] * p[k])
    };
    [0.5 * sum(0, 0), 0.5 * sum(1, 1), 0.5 * sum(0, 1)]
}

impl Triangle {
    /// -V F S g: what a stress puts on the second corner and on the third.
    pub fn pull(&self, edges: [DVec3; 2], stress: Symmetric) -> [DVec3; 2] {
        let by = |p: [f64; 2], q: [f64; 2]| {
            p[0] * (stress[0] * q[0] + stress[2] * q[1]) + p[1] * (stress[2] * q[0] + stress[1] * q[1])
        };
        let [p, q] = self.gradients;
        let mixed = by(p, q);
        [
            -self.volume * (by(p, p) * edges[0] + mixed * edges[1]),
            -self.volume * (mixed * edges[0] + by(q, q) * edges[1]),
        ]
    }

    /// The columns of F, of the axes of the fibre.
    pub fn deformation(&self, edges: [DVec3; 2]) -> [DVec3; 2] {
        let [p, q] = self.gradients;
        [p[0] * edges[0] + q[0] * edges[1], p[1] * edges[0] + q[1] * edges[1]]
    }
}

/// The part of a rate of strain that is along what bears tension.
fn in_tension(taut: Taut, rate: Symmetric) -> Symmetric {
    match taut {
        Taut::Nothing => [0.0; 3],
        Taut::Both => rate,
        Taut::Along([x, y]) => {
            let along = 0.5 * ((1.0 + x) * rate[0] + (1.0 - x) * rate[1]) + y * rate[2];
            [0.5 * (1.0 + x) * along, 0.5 * (1.0 - x) * along, 0.5 * y * along]
        }
    }
}
