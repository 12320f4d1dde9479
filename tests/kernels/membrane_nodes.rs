//! The motion of a membrane's nodes against f64: forces, impulses of gas, holds, gravity, obstacles; what is saved, and what is refused.

use corpuscle::fabric::{Element, Energies, Hold, Membrane, MembraneInput, MembraneState, Obstacle};
use glam::DVec3;

use crate::membrane::{MATERIALS, Random, THICKNESS, Triangles, grid, run, vector};
use crate::rig::device;

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
            frictions: &[],
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

/// Nodes that fall on a plane that rises and drifts end on it, with its velocity; what it does is in the account. None comes below it.
#[test]
fn obstacles_stop_nodes() {
    let mut triangles = Triangles::default();
    for _ in 0..20 {
        triangles.add(&mut Random(7), [0.0; 3]);
    }
    triangles.elements.iter_mut().for_each(|element| element.pressure = 0.0);
    let mut random = Random(8);
    let start = DVec3::new(0.1, 0.2, 0.3);
    let normal = DVec3::new(1.0, -2.0, 2.0).normalize();
    for node in triangles.nodes.chunks_exact_mut(3) {
        // Each triangle parallel to the face, some mm before it.
        let along = normal.any_orthonormal_vector();
        let (across, height) = (normal.cross(along), 0.002 * (0.5 + random.next()));
        let shape = [[0.0; 2], [0.03, 0.0], [0.01, 0.02]];
        for (place, [x, y]) in node.iter_mut().zip(shape) {
            *place = (start + height * normal + x * along + y * across).to_array();
        }
    }
    for (element, nodes) in triangles.elements.iter_mut().zip(triangles.nodes.chunks_exact(3)) {
        *element = Element::of_places([nodes[0], nodes[1], nodes[2]], THICKNESS, 0);
    }
    let slip = normal.any_orthonormal_vector() * 2.0;
    triangles.velocities = vec![(slip - 3.0 * normal).to_array(); triangles.nodes.len()];
    let (membrane, _) = triangles.membrane();
    let before = membrane.energies(device()).expect("energies");
    let rising = 0.5;
    let dt = 2e-6;
    membrane.set_step(device(), dt);
    for step in 0..500 {
        let place = (start + f64::from(step) * dt * rising * normal).to_array();
        let (normal, velocity) = ((3.0 * normal).to_array(), (rising * normal).to_array());
        let plane = Obstacle { place, normal, velocity, friction: 0.25 };
        membrane.set_obstacles(device(), &[plane]).expect("an obstacle");
        run(&membrane, 0..1);
    }
    let state = membrane.read_state(device()).expect("a state");
    let end = start + 500.0 * dt * rising * normal;
    for (node, place) in state.nodes.iter().zip(state.places(membrane.model())) {
        let height = (place - end).dot(normal);
        assert!(height.abs() < 3.0 * membrane.model().quantum + 1e-8, "{height:e}");
        let velocity = vector(node.velocity);
        assert!((velocity.dot(normal) - rising).abs() < 2e-3, "{velocity}");
        // The impulse was m 3.5 m/s: friction took .25 of that.
        let slipped = velocity - velocity.dot(normal) * normal;
        assert!((slipped.length() - (2.0 - 0.25 * 3.5)).abs() < 2e-3, "{slipped}");
    }
    let after = membrane.energies(device()).expect("energies");
    assert!((after.balance() - before.balance()).abs() < 1e-4 * before.kinetic, "{before:?} {after:?}");
    assert!(after.friction > 0.1 * before.kinetic && after.obstacles < 0.0, "{after:?}");
    let bad = |obstacle| membrane.set_obstacles(device(), &[obstacle]).unwrap_err().to_string();
    let good = Obstacle { place: [0.0; 3], normal: [0.0, 0.0, 1.0], velocity: [0.0; 3], friction: 0.0 };
    assert!(bad(Obstacle { normal: [0.0; 3], ..good }).contains("the normal of obstacle 0"));
    assert!(bad(Obstacle { friction: -1.0, ..good }).contains("the friction of obstacle 0"));
    assert!(bad(Obstacle { place: [0.0, 0.0, 1e9], ..good }).contains("the distance of obstacle 0"));
    assert!(membrane.set_obstacles(device(), &[good; 257]).is_err());
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
        frictions: &[],
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
    refused(MembraneInput { substeps: 0, ..good }, "one at least");
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

/// Passes of smoothing over neighbours along the edges of triangles, by the degrees of both.
fn smoothed(values: &[DVec3], triangles: &[[u32; 3]], passes: u32) -> Vec<DVec3> {
    let are_neighbours =
        |a: usize, b: usize| a != b && triangles.iter().any(|t| t.contains(&(a as u32)) && t.contains(&(b as u32)));
    let count = values.len();
    let degree = |a: usize| (0..count).filter(|&b| are_neighbours(a, b)).count();
    (0..passes).fold(values.to_vec(), |values, _| {
        let of = |a: usize| {
            let others = (0..count).filter(|&b| are_neighbours(a, b));
            let more = others.map(|b| (values[b] - values[a]) / (1 + degree(a).max(degree(b))) as f64);
            values[a] + more.sum::<DVec3>()
        };
        (0..count).map(of).collect()
    })
}

/// What nodes take is smoothed as the velocities are with which the gas sees them, and its sum is that of what was given.
#[test]
fn impulses_and_velocities_are_smoothed_alike() {
    let membrane = Sheet { holds: vec![Hold::Free; 9], substeps: 2 }.membrane().smoothed(4);
    let triangles: Vec<[u32; 3]> = membrane.model().triangles.iter().map(|triangle| triangle.nodes).collect();
    let mut state = membrane.read_state(device()).expect("a state");
    let given: Vec<[i64; 3]> =
        (0..9i64).map(|k| [1_000_000_000 * (k % 4), -3_000_000 * k * k, 5_000_000_000 - k]).collect();
    let words = given.as_flattened().iter().flat_map(|&word| [word as u32, (word >> 32) as u32]);
    state.impulses = words.collect();
    membrane.write_state(device(), &state).expect("written");
    membrane.set_step(device(), 4e-6);
    run(&membrane, 0..1);
    let found = membrane.read_state(device()).expect("a state").nodes;
    let velocities: Vec<[f32; 4]> = device().read(&membrane.node_velocities, 9).expect("velocities");
    let impulses: Vec<DVec3> = given.iter().map(|j| DVec3::from_array(j.map(|j| j as f64 * UNIT))).collect();
    let expected = smoothed(&impulses, &triangles, 4);
    let seen: Vec<DVec3> = found.iter().map(|node| vector(node.seen)).collect();
    let smoothed_seen = smoothed(&seen, &triangles, 4);
    let size = |all: &[DVec3]| all.iter().map(|one| one.length()).fold(0.0, f64::max);
    for node in 0..9 {
        // (Half of it in each of the two steps.)
        let taken = 2.0 * vector(found[node].given);
        let [x, y, z, _] = velocities[node].map(f64::from);
        assert!((taken - expected[node]).length() < 1e-6 * size(&impulses), "{node}: {taken}, {}", expected[node]);
        assert!((DVec3::new(x, y, z) - smoothed_seen[node]).length() < 1e-6 * size(&seen), "{node}");
        assert!((taken - impulses[node]).length() > 1e-3 * size(&impulses), "{node}: not smoothed");
    }
    let sum = |all: &[DVec3]| all.iter().sum::<DVec3>();
    assert!((sum(&expected) - sum(&impulses)).length() < 1e-12 * size(&impulses));
}
