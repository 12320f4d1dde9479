//! Forces of triangles of membranes against f64, and the search of orthotropic stress by brute force.

use corpuscle::fabric::{
    Elasticity, Element, GpuElementForces, Hold, Law, Material, Membrane, MembraneInput, MembraneState, Model, Stress,
};
use corpuscle::geometry::Grid;
use corpuscle::gpu::Recording;
use glam::DVec3;

use crate::rig::{U, device};

pub const THICKNESS: f64 = 3.3e-4;
pub const MATERIALS: [Material; 4] = [
    material(Elasticity::Isotropic { young: 4e8, poisson: 0.3 }),
    material(Elasticity::Isotropic { young: 4e8, poisson: 0.0 }),
    material(Elasticity::Orthotropic { young: [4e8, 1.5e8], poisson: 0.4, shear: 6e7 }),
    material(Elasticity::Woven { young: [4e8, 3e8], shear: 5e6 }),
];

const fn material(elasticity: Elasticity) -> Material {
    Material { elasticity, density: 800.0, damping: 0.05 }
}

pub fn grid() -> Grid {
    Grid::around([-1.0; 3], [1.0; 3], 0.1).expect("a grid")
}

/// Random numbers of a test.
pub struct Random(pub u64);

impl Random {
    /// In 0..1.
    pub fn next(&mut self) -> f64 {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In -most..most.
    pub fn within(&mut self, most: f64) -> f64 {
        most * (2.0 * self.next() - 1.0)
    }

    pub fn vector(&mut self, most: f64) -> DVec3 {
        DVec3::new(self.within(most), self.within(most), self.within(most))
    }
}

/// Triangles of a test, each with three nodes of its own.
#[derive(Default)]
pub struct Triangles {
    pub nodes: Vec<[f64; 3]>,
    pub velocities: Vec<[f64; 3]>,
    pub elements: Vec<Element>,
}

impl Triangles {
    /// One of a random reference that is stretched by a symmetric tensor (1 + E), turned and moved anywhere.
    pub fn add(&mut self, random: &mut Random, stretch: [f64; 3]) {
        let second = [0.03 * (0.5 + random.next()), 0.0];
        let third = [random.within(0.02), 0.03 * (0.5 + random.next())];
        let (x, y) = (random.vector(1.0).normalize(), random.vector(1.0));
        let y = (y - x * x.dot(y)).normalize();
        let at = random.vector(0.9);
        let place = |[a, b]: [f64; 2]| {
            let along = a * (1.0 + stretch[0]) + b * stretch[2];
            let across = a * stretch[2] + b * (1.0 + stretch[1]);
            (at + along * x + across * y).to_array()
        };
        self.nodes.extend([place([0.0; 2]), place(second), place(third)]);
        self.velocities.extend([(); 3].map(|()| random.vector(20.0).to_array()));
        let material = self.elements.len() % MATERIALS.len();
        let fibre = random.within(3.0);
        let pressure = random.within(1e4);
        self.elements.push(Element { second, third, thickness: THICKNESS, material, fibre, pressure });
    }

    pub fn membrane(&self) -> (Membrane, MembraneState) {
        let count = self.nodes.len();
        let triangles: Vec<[u32; 3]> = (0..self.elements.len() as u32).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let input = MembraneInput {
            grid: &grid(),
            nodes: &self.nodes,
            velocities: &self.velocities,
            triangles: &triangles,
            elements: &self.elements,
            materials: &MATERIALS,
            added_masses: &vec![0.0; count],
            frictions: &[],
            holds: &vec![Hold::Free; count],
            gravity: [0.0; 3],
            substeps: 1,
            steps_per_interval: 1,
            impulse_unit: 1e-12,
            drag: 0.0,
        };
        let membrane = Membrane::new(device(), &input).expect("a membrane");
        membrane.set_step(device(), 1e-7);
        let start = membrane.read_state(device()).expect("a state");
        run(&membrane, 0..1);
        (membrane, start)
    }
}

pub fn run(membrane: &Membrane, slots: std::ops::Range<u32>) {
    let mut recording = Recording::new(device());
    slots.for_each(|slot| membrane.step(&mut recording, slot));
    let submission = recording.submit();
    device().wait(&submission).expect("a step");
}

/// Random strains of four sizes; and the hard cases: equal eigenvalues, uniaxial states, the edge between taut and wrinkled, none at all, collapse.
fn strains(random: &mut Random) -> Vec<[f64; 3]> {
    let mut all = Vec::new();
    for size in [1e-1, 1e-2, 1e-3, 1e-5] {
        for _ in 0..200 {
            all.push([random.within(size), random.within(size), random.within(size)]);
        }
    }
    for _ in 0..20 {
        let e = random.within(1e-2);
        all.extend([
            [e, e, 0.0],
            [e, e, 1e-9],
            [e, e * (1.0 + 1e-7), 1e-9 * e],
            [e, -e, 0.0],
            [e, 0.0, 0.0],
            [0.0, e, 0.0],
            [e.abs(), -0.3 * e.abs(), 0.0],
            [e.abs(), -0.3 * e.abs() * (1.0 + 1e-6), 0.0],
            [0.0, 0.0, e],
            [0.0; 3],
            [-0.9, e, 0.0],
            [-1.0, -1.0, 0.0],
        ]);
    }
    all
}

pub fn vector(words: [f32; 3]) -> DVec3 {
    DVec3::from_array(words.map(f64::from))
}

/// How far the forces of the device may be from those of f64: some roundings of what is added.
fn check_forces(model: &Model, state: &MembraneState, found: &[GpuElementForces]) -> Result<f64, String> {
    let places = state.places(model);
    let mut worst: f64 = 0.0;
    for (k, (triangle, found)) in model.triangles.iter().zip(found).enumerate() {
        let corners = triangle.nodes.map(|node| places[node as usize]);
        let velocities = triangle.nodes.map(|node| vector(state.nodes[node as usize].velocity));
        let expected = model.forces(triangle, corners, velocities);
        // The strain is known to some units of its own size, and what stiffness that has: of the force on an edge.
        let edges = [corners[1] - corners[0], corners[2] - corners[0]];
        let strain = model.strain(triangle, edges);
        let size = strain.iter().map(|e| e.abs()).fold(0.0, f64::max);
        let gradient = triangle.gradients.as_flattened().iter().map(|g| g.abs()).fold(0.0, f64::max);
        let edge = edges[0].length() + edges[1].length();
        let stretched = triangle.volume * 5e8 * gradient * gradient * edge;
        // A place is one to half a unit of its remainder.
        let lattice = 2.0 * edge * gradient * gradient * model.quantum * U;
        let bound = (200.0 * U * (size + size * size) + 40.0 * lattice) * stretched;
        for (of_device, of_host) in [(found.second, expected.strain[0]), (found.third, expected.strain[1])] {
            let off = (vector(of_device) - of_host).length();
            worst = worst.max(off / bound);
            ensure(off <= bound, || format!("{k} {strain:?}: {of_device:?} {of_host} {off:e} {bound:e}"))?;
        }
        let off = (vector(found.pressed) - expected.pressure).length();
        ensure(off <= 8.0 * U * 1e4 * edge * edge, || format!("{k}: pressure {off:e}"))?;
        let energy = (f64::from(found.energy) - expected.energy).abs();
        let most = (200.0 * U * size + 40.0 * lattice) * size * triangle.volume * 5e8 + 1e-30;
        ensure(energy <= most, || format!("{k}: energy {energy:e} {most:e}"))?;
        // Where two directions bear nearly the same, or nearly none, the damping of one is as right as that of the other.
        let rate = 20.0 * 4.0 * edge * gradient * gradient;
        let damping = 1e-3 * triangle.volume * triangle.viscosity * rate * gradient * gradient * edge;
        let sure = size > 1e-4 && found.state == state_of(&expected.taut);
        let pairs = [(found.damped_second, expected.damping[0]), (found.damped_third, expected.damping[1])];
        for (of_device, of_host) in pairs {
            let off = (vector(of_device) - of_host).length();
            ensure(!sure || off <= damping, || format!("{k} {strain:?}: damping {off:e} {damping:e}"))?;
        }
    }
    Ok(worst)
}

fn ensure(holds: bool, otherwise: impl FnOnce() -> String) -> Result<(), String> {
    if holds { Ok(()) } else { Err(otherwise()) }
}

fn state_of(taut: &corpuscle::fabric::Taut) -> u32 {
    match taut {
        corpuscle::fabric::Taut::Nothing => 0,
        corpuscle::fabric::Taut::Along(_) => 1,
        corpuscle::fabric::Taut::Both => 2,
    }
}

#[test]
fn forces_of_triangles_are_those_of_f64() {
    let mut random = Random(1);
    let mut triangles = Triangles::default();
    for strain in strains(&mut random) {
        // Each with every material.
        for _ in 0..MATERIALS.len() {
            triangles.add(&mut random, strain);
        }
    }
    let (membrane, start) = triangles.membrane();
    let found = membrane.read_forces(device()).expect("forces");
    let worst = check_forces(membrane.model(), &start, &found).expect("forces of f64");
    let states = [0, 1, 2].map(|state| found.iter().filter(|forces| forces.state == state).count());
    println!("{} triangles, {states:?} slack, wrinkled, taut; at most {worst:.2} of the bound", found.len());
    assert!(states.iter().all(|&count| count > 200), "{states:?}");
    // The check can fail: a force that is off by a thousandth.
    let mut wrong = found.clone();
    let large = wrong.iter().position(|forces| vector(forces.second).length() > 1.0).expect("a force");
    wrong[large].second = wrong[large].second.map(|f| 1.001 * f);
    assert!(check_forces(membrane.model(), &start, &wrong).is_err());
}

/// The relaxed energy is the most that S:E - S:C:S/2 is for any stress without compression: by brute force over uniaxial ones.
#[test]
fn relaxed_stress_is_that_of_a_search_of_all_directions() {
    let mut random = Random(2);
    for material in &MATERIALS {
        let law = Law { compression: 0.0, ..Law::new(&material.elasticity) };
        let c = law.compliance;
        for size in [1e-1, 1e-3, 1e-6] {
            for _ in 0..200 {
                let strain = [random.within(size), random.within(size), random.within(size)];
                let Stress { energy, .. } = law.stress(strain);
                let along = |k: u32| {
                    let angle = f64::from(k) * std::f64::consts::PI / 2000.0;
                    let (s, c) = angle.sin_cos();
                    c * c * strain[0] + s * s * strain[1] + 2.0 * s * c * strain[2]
                };
                let uniaxial = |k: u32| {
                    let x = (f64::from(k) * std::f64::consts::PI / 1000.0).cos();
                    let flexibility = (c[0] + c[1] * x + c[2] * x * x) / law.young;
                    0.5 * along(k).max(0.0).powi(2) / flexibility
                };
                let most = (0..2000).map(uniaxial).fold(0.0, f64::max);
                let sheet = law.as_a_sheet(strain);
                let taut = corpuscle::fabric::principal(sheet)[1] >= 0.0;
                let unit = size * size * 4e8;
                assert!(energy >= most - 1e-6 * unit, "{material:?} {strain:?}: {energy} {most}");
                assert!(taut || energy <= most + 1e-4 * unit, "{material:?} {strain:?}: {energy} {most}");
            }
        }
    }
}
