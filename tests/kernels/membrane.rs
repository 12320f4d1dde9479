//! The kernels of `shaders/membrane/` against f64: forces of random triangles, the search of orthotropic stress by brute force, and the motion of nodes.

use corpuscle::fabric::{
    Elasticity, Element, Energies, GpuElementForces, Hold, Law, Material, Membrane, MembraneInput, MembraneState,
    Model, Stress,
};
use corpuscle::geometry::Grid;
use corpuscle::gpu::Recording;
use glam::DVec3;

use crate::rig::{U, device};

const THICKNESS: f64 = 3.3e-4;
const MATERIALS: [Material; 4] = [
    material(Elasticity::Isotropic { young: 4e8, poisson: 0.3 }),
    material(Elasticity::Isotropic { young: 4e8, poisson: 0.0 }),
    material(Elasticity::Orthotropic { young: [4e8, 1.5e8], poisson: 0.4, shear: 6e7 }),
    material(Elasticity::Woven { young: [4e8, 3e8], shear: 5e6 }),
];

const fn material(elasticity: Elasticity) -> Material {
    Material { elasticity, density: 800.0, damping: 0.05 }
}

fn grid() -> Grid {
    Grid::around([-1.0; 3], [1.0; 3], 0.1).expect("a grid")
}

/// Random numbers of a test.
struct Random(u64);

impl Random {
    /// In 0..1.
    fn next(&mut self) -> f64 {
        // SplitMix64.
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In -most..most.
    fn within(&mut self, most: f64) -> f64 {
        most * (2.0 * self.next() - 1.0)
    }

    fn vector(&mut self, most: f64) -> DVec3 {
        DVec3::new(self.within(most), self.within(most), self.within(most))
    }
}

/// Triangles of a test, each with three nodes of its own.
#[derive(Default)]
struct Triangles {
    nodes: Vec<[f64; 3]>,
    velocities: Vec<[f64; 3]>,
    elements: Vec<Element>,
}

impl Triangles {
    /// One of a random reference that is stretched by a symmetric tensor (1 + E), turned and moved anywhere.
    fn add(&mut self, random: &mut Random, stretch: [f64; 3]) {
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

    fn membrane(&self) -> (Membrane, MembraneState) {
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

fn run(membrane: &Membrane, slots: std::ops::Range<u32>) {
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

fn vector(words: [f32; 3]) -> DVec3 {
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

/// A sheet of a few triangles that share nodes, with everything that acts on nodes.
struct Sheet {
    holds: Vec<Hold>,
    substeps: u32,
}

const UNIT: f64 = 1e-13;
const GRAVITY: [f64; 3] = [1.0, -2.0, -9.81];

impl Sheet {
    fn nodes(&self) -> (Vec<[f64; 3]>, Vec<[f64; 3]>) {
        let mut random = Random(3);
        let nodes = (0..9).map(|k| {
            let flat = DVec3::new(f64::from(k % 3), f64::from(k / 3), 0.0) * 0.025;
            (flat + random.vector(1e-4)).to_array()
        });
        let nodes = nodes.collect();
        (nodes, (0..9).map(|_| random.vector(3.0).to_array()).collect())
    }

    fn membrane(&self) -> Membrane {
        let (nodes, velocities) = self.nodes();
        let corner = |i: u32, j: u32| 3 * j + i;
        let squares = (0..2).flat_map(|j| (0..2).map(move |i| (i, j)));
        let triangles: Vec<[u32; 3]> = squares
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect();
        let flat = |node: u32| [f64::from(node % 3) * 0.025, f64::from(node / 3) * 0.025];
        let elements: Vec<Element> = triangles
            .iter()
            .enumerate()
            .map(|(k, t)| Element { pressure: 500.0, ..Element::of_flat_places(t.map(flat), THICKNESS, k % 4) })
            .collect();
        let input = MembraneInput {
            grid: &grid(),
            nodes: &nodes,
            velocities: &velocities,
            triangles: &triangles,
            elements: &elements,
            materials: &MATERIALS,
            added_masses: &[1e-5; 9],
            holds: &self.holds,
            gravity: GRAVITY,
            substeps: self.substeps,
            steps_per_interval: 4,
            impulse_unit: UNIT,
            drag: 0.0,
        };
        Membrane::new(device(), &input).expect("a membrane")
    }
}

fn holds() -> Vec<Hold> {
    let mut holds = vec![Hold::Free; 9];
    holds[0] = Hold::Fixed;
    holds[2] = Hold::Prescribed([1.0, 2.0, -3.0]);
    holds
}

/// One step of the gas with impulses: velocities, places and works are those of f64, step by step of the fabric.
#[test]
fn nodes_move_as_in_f64() {
    for substeps in [1, 4] {
        let membrane = Sheet { holds: holds(), substeps }.membrane();
        let model = membrane.model().clone();
        let mut state = membrane.read_state(device()).expect("a state");
        let given: Vec<[i64; 3]> =
            (0..9i64).map(|k| [1_000_000 * k - 4_000_000, 8_000_000_000 - k, -7_000_000_000 * (k % 2)]).collect();
        let words = given.as_flattened().iter().flat_map(|&word| [word as u32, (word >> 32) as u32]);
        state.impulses = words.collect();
        membrane.write_state(device(), &state).expect("written");
        let dt = 4e-6;
        membrane.set_step(device(), dt);
        run(&membrane, 0..1);
        let found = membrane.read_state(device()).expect("a state");
        assert!(found.impulses.iter().all(|&word| word == 0), "they are taken");

        let mut places = state.places(&model);
        let mut velocities: Vec<DVec3> = state.nodes.iter().map(|node| vector(node.velocity)).collect();
        let (starts, at_start) = (places.clone(), velocities.clone());
        let step = dt / f64::from(substeps);
        let impulses: Vec<DVec3> = given.iter().map(|j| DVec3::from_array(j.map(|j| j as f64 * UNIT))).collect();
        let (mut gas, mut ledger) = (0.0, impulses.iter().zip(&velocities).map(|(j, v)| j.dot(*v)).sum::<f64>());
        for substep in 0..substeps {
            let kick = if substep == 0 { 0.5 * step } else { step };
            let mut forces = vec![DVec3::ZERO; 9];
            for triangle in &model.triangles {
                let own = triangle.nodes.map(|node| node as usize);
                let on = model.forces(triangle, own.map(|n| places[n]), own.map(|n| velocities[n]));
                let internal = [0, 1].map(|k| on.strain[k] + on.damping[k]);
                forces[own[0]] += on.pressure - internal[0] - internal[1];
                forces[own[1]] += on.pressure + internal[0];
                forces[own[2]] += on.pressure + internal[1];
            }
            for node in 0..9 {
                let taken = impulses[node] / f64::from(substeps);
                let all = taken + kick * (forces[node] + model.masses[node] * DVec3::from_array(GRAVITY));
                let next = match model.holds[node] {
                    Hold::Free => velocities[node] + all / model.masses[node],
                    Hold::Fixed => DVec3::ZERO,
                    Hold::Prescribed(velocity) => DVec3::from_array(velocity),
                };
                let mean = 0.5 * (velocities[node] + next);
                gas += taken.dot(mean);
                ledger -= taken.dot(mean);
                velocities[node] = next;
                places[node] += step * next;
            }
        }
        let ends = found.places(&model);
        for node in 0..9 {
            let off = (vector(found.nodes[node].velocity) - velocities[node]).length();
            assert!(off < 3e-5 * at_start[node].length().max(10.0), "{node}: {off:e}");
            let seen = vector(found.nodes[node].seen);
            let mean = (ends[node] - starts[node]) / dt;
            assert!((seen - mean).length() < 1.1 * model.quantum / dt + 1e-5 * mean.length(), "{node}: {seen} {mean}");
            assert!((ends[node] - places[node]).length() < 1e-4 * dt * 10.0, "{node}");
        }
        let energies = Energies::of(&model, &found.nodes);
        assert!((energies.gas - gas).abs() < 1e-4 * gas.abs(), "{} {gas}", energies.gas);
        assert!((energies.ledger - ledger).abs() < 1e-4 * gas.abs(), "{} {ledger}", energies.ledger);
        // The gas sees where they are at the start and at the end.
        let seen: Vec<[u32; 4]> = device().read(&membrane.nodes, 18).expect("nodes");
        for node in 0..9 {
            assert_eq!(seen[node][..3], state.nodes[node].place);
            assert_eq!(seen[9 + node][..3], found.nodes[node].place);
        }
    }
}

/// All impulses together change the energy of motion, exactly but for rounding: with the work of strain, by differences of its energy.
#[test]
fn works_are_what_changes_the_energy() {
    let membrane = Sheet { holds: holds(), substeps: 2 }.membrane();
    membrane.set_step(device(), 2e-6);
    run(&membrane, 0..1);
    let start = membrane.energies(device()).expect("energies");
    for _ in 0..100 {
        run(&membrane, 0..4);
    }
    let end = membrane.energies(device()).expect("energies");
    println!("{start:?}\n{end:?}");
    assert!(end.damped > 1e-3 * end.pressure.abs() && end.holds.abs() > 0.0 && end.gravity.abs() > 0.0);
    let drift = end.balance() - start.balance();
    assert!(drift.abs() < 2e-3 * (end.kinetic + end.strain + end.damped), "{drift:e}");
    let unbalanced = Energies { damped: 0.0, ..end };
    assert!((unbalanced.balance() - start.balance()).abs() > 2e-3 * (end.kinetic + end.strain + end.damped));
}

/// A node slower than a quantum a step moves by its remainder.
#[test]
fn slow_nodes_move() {
    let mut triangles = Triangles::default();
    triangles.add(&mut Random(5), [0.0; 3]);
    let dt = 1e-7;
    let slow = 0.01 * grid().quantum() / dt;
    triangles.velocities = vec![[slow, -slow, 0.0]; 3];
    triangles.elements[0].pressure = 0.0;
    let (membrane, start) = triangles.membrane();
    for _ in 0..999 {
        run(&membrane, 0..1);
    }
    let model = membrane.model();
    let end = membrane.read_state(device()).expect("a state");
    for (before, after) in start.places(model).iter().zip(end.places(model)) {
        let quanta = (after - *before) / model.quantum;
        assert!((quanta - DVec3::new(10.0, -10.0, 0.0)).length() < 0.1, "{quanta}");
    }
}

/// What was saved on the device, and what was read and written back, go on to the same bits.
#[test]
fn a_membrane_goes_on_from_what_was_saved() {
    let membrane = Sheet { holds: holds(), substeps: 2 }.membrane();
    membrane.set_step(device(), 2e-6);
    run(&membrane, 0..3);
    let state = membrane.read_state(device()).expect("a state");
    let mut encoder = device().encoder();
    let saved = membrane.save(device(), &mut encoder).expect("a copy");
    device().submit(encoder);
    run(&membrane, 0..4);
    let expected = membrane.read_state(device()).expect("a state");
    let mut encoder = device().encoder();
    membrane.restore(&mut encoder, &saved);
    device().submit(encoder);
    run(&membrane, 0..4);
    assert_eq!(membrane.read_state(device()).expect("a state").bytes(), expected.bytes());

    let other = Sheet { holds: holds(), substeps: 2 }.membrane();
    other.set_step(device(), 2e-6);
    let copy = MembraneState::of_bytes(&state.bytes(), 9).expect("a state");
    other.write_state(device(), &copy).expect("written");
    run(&other, 0..4);
    assert_eq!(other.read_state(device()).expect("a state").bytes(), expected.bytes());
    assert!(MembraneState::of_bytes(&state.bytes()[1..], 9).is_err());
}

/// A node that would leave the grid is counted, and stays.
#[test]
fn nodes_that_leave_the_grid_are_faults() {
    let mut triangles = Triangles::default();
    triangles.add(&mut Random(6), [0.0; 3]);
    triangles.velocities = vec![[1e9, 0.0, 0.0], [0.0; 3], [f64::NAN, 0.0, 0.0]];
    let (membrane, start) = triangles.membrane();
    assert!(membrane.read_faults(device()).expect("faults") >= 2);
    let end = membrane.read_state(device()).expect("a state");
    assert_eq!(end.nodes[0].place, start.nodes[0].place);
}

/// What cannot be a membrane is refused, with what was found where.
#[test]
fn bad_membranes_are_refused() {
    let nodes = [[0.0; 3], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]];
    let grid = grid();
    let triangles = [[0, 1, 2]];
    let element = Element::of_places(nodes, THICKNESS, 0);
    let elements = [element];
    let good = MembraneInput {
        grid: &grid,
        nodes: &nodes,
        velocities: &[[0.0; 3]; 3],
        triangles: &triangles,
        elements: &elements,
        materials: &MATERIALS,
        added_masses: &[0.0; 3],
        holds: &[Hold::Free; 3],
        gravity: [0.0; 3],
        substeps: 1,
        steps_per_interval: 1,
        impulse_unit: UNIT,
        drag: 0.0,
    };
    assert!(Membrane::new(device(), &good).is_ok());
    let refused = |input: MembraneInput<'_>, words: &str| {
        let message = Membrane::new(device(), &input).err().expect("refused").to_string();
        assert!(message.contains(words), "{message}");
    };
    refused(MembraneInput { substeps: 3, ..good }, "a power of two");
    refused(MembraneInput { holds: &[Hold::Free; 2], ..good }, "2 holds, expected 3");
    refused(MembraneInput { triangles: &[[0, 1, 7]], ..good }, "triangle 0 names node 7");
    refused(MembraneInput { elements: &[Element { material: 9, ..element }], ..good }, "material 9");
    refused(
        MembraneInput { elements: &[Element { thickness: 0.0, ..element }], ..good },
        "the thickness of triangle 0",
    );
    refused(MembraneInput { elements: &[Element { second: [-0.1, 0.0], ..element }], ..good }, "counter-clockwise");
    refused(MembraneInput { impulse_unit: f64::NAN, ..good }, "the unit of impulses");
    refused(MembraneInput { added_masses: &[-1.0, 0.0, 0.0], ..good }, "the added mass of node 0");
    refused(MembraneInput { triangles: &[], elements: &[], ..good }, "node 0 is free and has no mass");
    refused(MembraneInput { nodes: &[[0.0; 3], [0.1, 0.0, 0.0], [9.0, 0.1, 0.0]], ..good }, "node 2 at");
}
