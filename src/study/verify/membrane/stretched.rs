//! Membranes whose rim is moved: uniform strain, the pull of a wrinkled strip, the work of a closed loop of strains.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::fabric::{Elasticity, Element, Hold, Law, Material};
use crate::geometry::TriangleMesh;
use crate::gpu::Device;
use crate::study::StudyError;

use super::sheet::{FABRIC, Sheet, THICKNESS, YOUNG};
use crate::study::verify::{Check, Effort, Findings};

/// A number between -1 and 1 for each two numbers.
pub fn scatter(k: u32, which: u32) -> f64 {
    let mut z = (u64::from(k) << 32 | u64::from(which)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

/// The patch test: an irregular mesh whose rim is under a uniform strain has it everywhere, when it has come to rest in at most so many steps.
pub fn irregular(device: &Device, most_steps: u32) -> Result<Check, StudyError> {
    let (squares, edge) = (6, 0.08);
    let side = f64::from(squares) * edge;
    let mut sheet = Sheet::rectangle([squares; 2], edge);
    let on_rim = |p: DVec3| [p.x, p.y].iter().any(|&x| x < 1e-9 || x > side - 1e-9);
    sheet.moved(|k, place| {
        let off = DVec3::new(scatter(k, 0), scatter(k, 1), 0.0) * (0.3 * edge);
        if on_rim(place) { place } else { place + off }
    });
    let mut sheet = Sheet::new(sheet.mesh, THICKNESS, |place| place);
    sheet.fix(on_rim);
    let flat: Vec<DVec3> = sheet.mesh.nodes.iter().copied().map(DVec3::from).collect();
    let strained = |p: DVec3| DVec3::new(1.010 * p.x + 0.004 * p.y, 0.002 * p.x + 1.006 * p.y, 0.0);
    // Nodes within begin a little beside where they should come to.
    sheet.moved(|k, place| {
        let off = DVec3::new(scatter(k, 2), scatter(k, 3), scatter(k, 4)) * (0.02 * edge);
        if on_rim(place) { strained(place) } else { strained(place) + off }
    });
    let run = sheet.run(device, 1.0)?;
    run.rest(1e-14, most_steps)?;
    let off = run.places()?.iter().zip(&flat).map(|(found, flat)| found.distance(strained(*flat))).fold(0.0, f64::max);
    Ok(Check::of("farthest node from its place, m", 0.0, (off, 0.0), 1e-6))
}

pub fn patch(device: &Device, _: Effort) -> Result<Findings, StudyError> {
    Ok(vec![irregular(device, 20_000)?].into())
}

/// A strip that its ends make longer, and narrower by a share of that. Where this is more than Poisson's ratio it wrinkles, and pulls with E e alone.
pub fn pull(device: &Device, narrowing: f64) -> Result<Check, StudyError> {
    let (squares, edge) = ([16, 4], 0.025);
    let [length, width] = squares.map(|n| f64::from(n) * edge);
    let stretch: f64 = 0.005;
    let mut sheet = Sheet::rectangle(squares, edge);
    let at_end = |p: DVec3| p.x < 1e-9 || p.x > length - 1e-9;
    sheet.fix(at_end);
    sheet.moved(|k, p| {
        let off = DVec3::new(scatter(k, 0), scatter(k, 1), scatter(k, 2)) * 1e-4;
        let narrow = DVec3::new((1.0 + stretch) * p.x, (1.0 - narrowing * stretch) * p.y, 0.0);
        if at_end(p) { narrow } else { narrow + off }
    });
    let run = sheet.run(device, 1.0)?;
    run.rest(1e-10, 20_000)?;
    run.steps(1)?;
    // What the triangles put on the nodes of the far end.
    let forces = run.membrane.read_forces(device)?;
    let mut pull = 0.0;
    for (triangle, forces) in run.mesh.triangles.iter().zip(&forces) {
        let x = |v: [f32; 3]| f64::from(v[0]);
        let on = [-x(forces.second) - x(forces.third), x(forces.second), x(forces.third)];
        let at_far_end = |node: u32| run.mesh.nodes[node as usize][0] > length;
        pull -= triangle.iter().zip(on).filter(|(node, _)| at_far_end(**node)).map(|(_, f)| f).sum::<f64>();
    }
    // Of Green's strain and the second stress of Piola and Kirchhoff; the force is (1 + e) S A.
    let strain = stretch + 0.5 * stretch * stretch;
    let stress = pull / ((1.0 + stretch) * width * THICKNESS);
    Ok(Check::of("S/(E e)", 1.0, (stress / (YOUNG * strain), 0.0), 1e-3))
}

pub fn strip(device: &Device, _: Effort) -> Result<Findings, StudyError> {
    Ok(vec![pull(device, 0.5)?].into())
}

/// Of a closed path of strains through taut, wrinkled and slack states: where it is, 0 to 1.
pub fn deformed(path: f64, place: [f64; 2]) -> DVec3 {
    let (size, angle) = (4e-3, TAU * path);
    let xx = size * (0.3 + angle.cos());
    let yy = size * (0.1 + angle.sin());
    let xy = 0.8 * size * (2.0 * angle).sin();
    let [x, y] = place;
    DVec3::new((1.0 + xx) * x + xy * y, (1.0 + yy) * y, 0.0)
}

/// Begins and ends at rest.
pub fn eased(share: f64) -> f64 {
    share - (TAU * share).sin() / TAU
}

const CORNERS: [[f64; 2]; 3] = [[0.0, 0.0], [0.03, 0.0], [0.008, 0.025]];
pub const ORTHOTROPIC: Elasticity = Elasticity::Orthotropic { young: [4e8, 1.5e8], poisson: 0.3, shear: 4e7 };
pub const WOVEN: Elasticity = Elasticity::Woven { young: [4e8, 3e8], shear: 5e6 };

/// The work that is left when a triangle has gone through the loop, over its largest energy of strain.
pub fn loop_on_device(device: &Device, elasticity: Elasticity, steps: u32) -> Result<f64, StudyError> {
    let flat = CORNERS.map(|[x, y]| DVec3::new(x, y, 0.0));
    let nodes = CORNERS.map(|corner| deformed(0.0, corner).to_array()).to_vec();
    let mesh = TriangleMesh { nodes, triangles: vec![[0, 1, 2]], parts: vec![None], names: Vec::new() };
    let mut sheet = Sheet::new(mesh, THICKNESS, |place| place);
    let element = Element::of_places(flat.map(|p| p.to_array()), THICKNESS, 0);
    sheet.elements = vec![Element { fibre: 0.4, ..element }];
    sheet.material = Material { elasticity, damping: 0.0, ..FABRIC };
    sheet.holds = vec![Hold::Prescribed([0.0; 3]); 3];
    let run = sheet.run(device, 1.0)?;
    let place = |step: u32, corner| deformed(eased(f64::from(step) / f64::from(steps)), corner);
    let model = run.membrane.model();
    let mut most: f64 = 0.0;
    for step in 0..steps {
        let velocities = CORNERS.map(|corner| ((place(step + 1, corner) - place(step, corner)) / run.dt).to_array());
        run.membrane.prescribe(device, &velocities)?;
        run.steps(1)?;
        most = most.max(model.strain_energy(&CORNERS.map(|corner| place(step, corner))));
    }
    Ok(run.energies()?.holds / most)
}

/// The same on the host, with any rule for the stress of a strain.
pub fn loop_on_host(law: &Law, rule: impl Fn([f64; 3]) -> [f64; 3], steps: u32) -> f64 {
    let strain = |step: u32| {
        let path = eased(f64::from(step) / f64::from(steps));
        let [x, y] = [[1.0, 0.0], [0.0, 1.0]].map(|axis| deformed(path, axis));
        [0.5 * (x.length_squared() - 1.0), 0.5 * (y.length_squared() - 1.0), 0.5 * x.dot(y)]
    };
    let (mut work, mut most) = (0.0, 0.0_f64);
    for step in 0..steps {
        let (before, after) = (strain(step), strain(step + 1));
        let mean: [f64; 3] = std::array::from_fn(|i| 0.5 * (rule(before)[i] + rule(after)[i]));
        let change: [f64; 3] = std::array::from_fn(|i| after[i] - before[i]);
        work += mean[0] * change[0] + mean[1] * change[1] + 2.0 * mean[2] * change[2];
        most = most.max(law.stress(before).energy);
    }
    work / most
}

pub fn loops(device: &Device, _: Effort) -> Result<Findings, StudyError> {
    let fabrics = [("isotropic", FABRIC.elasticity), ("orthotropic", ORTHOTROPIC), ("woven", WOVEN)];
    let check = |(name, elasticity)| {
        let left = loop_on_device(device, elasticity, 2000)?;
        Ok(Check::of(format!("{name}: work left/peak"), 0.0, (left, 0.0), 1e-4))
    };
    fabrics.into_iter().map(check).collect()
}
