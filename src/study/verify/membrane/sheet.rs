//! A membrane that a case makes, and its run on a device without gas.

use glam::DVec3;

use crate::fabric::{
    Elasticity, Element, Energies, Hold, Material, Membrane, MembraneError, MembraneInput, longest_step,
};
use crate::geometry::{Grid, MeshError, MeshShape, TriangleMesh};
use crate::gpu::{Device, GpuError, Recording};
use crate::study::StudyError;

/// The fabric of the cases: 470 dtex, coated.
pub const THICKNESS: f64 = 3.3e-4;
pub const YOUNG: f64 = 4e8;
pub const DENSITY: f64 = 800.0;
pub const FABRIC: Material = Material {
    elasticity: Elasticity::Isotropic { young: YOUNG, poisson: 0.3 },
    density: DENSITY,
    damping: Material::DAMPING,
};

/// Steps between two waits for the device.
const BATCH: u32 = 64;

impl From<MembraneError> for StudyError {
    fn from(error: MembraneError) -> StudyError {
        match error {
            MembraneError::Device(error) => StudyError::Device(error),
            other => StudyError::Device(GpuError::Trouble { reason: other.to_string() }),
        }
    }
}

impl From<MeshError> for StudyError {
    fn from(error: MeshError) -> StudyError {
        StudyError::Device(GpuError::Trouble { reason: error.to_string() })
    }
}

/// What is made.
#[derive(Debug, Clone)]
pub struct Sheet {
    pub mesh: TriangleMesh,
    pub velocities: Vec<DVec3>,
    pub elements: Vec<Element>,
    pub material: Material,
    pub holds: Vec<Hold>,
    /// m/s2.
    pub gravity: [f64; 3],
    /// m around the mesh that nodes may come to.
    pub room: f64,
}

impl Sheet {
    /// Of a mesh at rest; `flat` is where a node is when there is no stress, as triangles alone.
    pub fn new(mesh: TriangleMesh, thickness: f64, flat: impl Fn(DVec3) -> DVec3) -> Sheet {
        let place = |&node: &u32| flat(DVec3::from(mesh.nodes[node as usize])).to_array();
        let element = |corners: &[u32; 3]| {
            let [a, b, c] = corners;
            Element::of_places([place(a), place(b), place(c)], thickness, 0)
        };
        Sheet {
            elements: mesh.triangles.iter().map(element).collect(),
            velocities: vec![DVec3::ZERO; mesh.nodes.len()],
            holds: vec![Hold::Free; mesh.nodes.len()],
            mesh,
            material: FABRIC,
            gravity: [0.0; 3],
            room: 0.1,
        }
    }

    /// A bag as its flat cut says it, blown up by a pressure.
    pub fn bag(shape: MeshShape, thickness: f64, pressure: f64) -> Result<Sheet, StudyError> {
        let mut sheet = Sheet::new(shape.mesh([0.0; 3])?, thickness, |place| place.with_z(0.0));
        sheet.press(pressure);
        let [low, high] = sheet.mesh.bounds().map(DVec3::from);
        sheet.room = 0.5 * (high - low).max_element();
        Ok(sheet)
    }

    /// A rectangle of squares in the plane z = 0 from the origin, their diagonals by turns; node (i, j) is at `places(i, j)`.
    pub fn rectangle(squares: [u32; 2], edge: f64) -> Sheet {
        let [n, m] = squares;
        let number = |i: u32, j: u32| j * (n + 1) + i;
        let nodes =
            (0..=m).flat_map(|j| (0..=n).map(move |i| [f64::from(i) * edge, f64::from(j) * edge, 0.0])).collect();
        let two = |i: u32, j: u32| {
            let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
            if (i + j).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
        };
        let triangles: Vec<[u32; 3]> = (0..m).flat_map(|j| (0..n).flat_map(move |i| two(i, j))).collect();
        let parts = vec![None; triangles.len()];
        let mesh = TriangleMesh { nodes, triangles, parts, names: Vec::new() };
        Sheet::new(mesh, THICKNESS, |place| place)
    }

    pub fn press(&mut self, pressure: f64) {
        self.elements.iter_mut().for_each(|element| element.pressure = pressure);
    }

    /// Moves nodes, each by its number and place, not their reference.
    pub fn moved(&mut self, to: impl Fn(u32, DVec3) -> DVec3) {
        for (k, node) in (0..).zip(&mut self.mesh.nodes) {
            *node = to(k, DVec3::from(*node)).to_array();
        }
    }

    /// Fixes the nodes that are where `at` says.
    pub fn fix(&mut self, at: impl Fn(DVec3) -> bool) {
        for (hold, &node) in self.holds.iter_mut().zip(&self.mesh.nodes) {
            if at(DVec3::from(node)) {
                *hold = Hold::Fixed;
            }
        }
    }

    /// What it is made from, for `make`.
    pub fn input<R>(&self, make: impl FnOnce(&MembraneInput<'_>) -> Result<R, MembraneError>) -> Result<R, StudyError> {
        let [low, high] = self.mesh.bounds().map(DVec3::from);
        let (low, high) = (low - self.room, high + self.room);
        let cell = (high - low).max_element() / 16.0;
        let grid = Grid::around(low.to_array(), high.to_array(), cell)
            .map_err(|error| GpuError::Trouble { reason: error.to_string() })?;
        let velocities: Vec<[f64; 3]> = self.velocities.iter().map(DVec3::to_array).collect();
        Ok(make(&MembraneInput {
            grid: &grid,
            nodes: &self.mesh.nodes,
            velocities: &velocities,
            triangles: &self.mesh.triangles,
            elements: &self.elements,
            materials: &[self.material],
            added_masses: &vec![0.0; self.mesh.nodes.len()],
            frictions: &[],
            holds: &self.holds,
            gravity: self.gravity,
            substeps: 1,
            steps_per_interval: BATCH,
            impulse_unit: 1.0,
            drag: 0.0,
        })?)
    }

    /// s.
    pub fn longest_step(&self) -> f64 {
        longest_step(&self.elements, &[self.material])
    }

    /// On a device, with a step of `share` times the longest.
    pub fn run<'a>(&self, device: &'a Device, share: f64) -> Result<Run<'a>, StudyError> {
        let membrane = self.input(|input| Membrane::new(device, input))?;
        let dt = share * self.longest_step();
        membrane.set_step(device, dt);
        Ok(Run { device, membrane, mesh: self.mesh.clone(), dt })
    }
}

/// A membrane that moves.
pub struct Run<'a> {
    pub device: &'a Device,
    pub membrane: Membrane,
    /// Its triangles; the nodes are those of the start.
    pub mesh: TriangleMesh,
    /// s.
    pub dt: f64,
}

impl Run<'_> {
    pub fn steps(&self, count: u32) -> Result<(), StudyError> {
        let mut left = count;
        while left > 0 {
            let batch = left.min(BATCH);
            let mut recording = Recording::new(self.device);
            (0..batch).for_each(|slot| self.membrane.step(&mut recording, slot));
            let submission = recording.submit();
            self.device.wait(&submission)?;
            left -= batch;
        }
        Ok(())
    }

    /// No node left the grid.
    fn check(&self) -> Result<(), StudyError> {
        let faults = self.membrane.read_faults(self.device)?;
        if faults == 0 {
            return Ok(());
        }
        Err(GpuError::Trouble { reason: format!("nodes of the membrane left its grid, {faults} times") }.into())
    }

    pub fn energies(&self) -> Result<Energies, StudyError> {
        self.check()?;
        Ok(self.membrane.energies(self.device)?)
    }

    pub fn places(&self) -> Result<Vec<DVec3>, StudyError> {
        self.check()?;
        Ok(self.membrane.read_state(self.device)?.places(self.membrane.model()))
    }

    /// The mesh as it is now.
    pub fn shape(&self) -> Result<TriangleMesh, StudyError> {
        let nodes = self.places()?.iter().map(DVec3::to_array).collect();
        Ok(TriangleMesh { nodes, ..self.mesh.clone() })
    }

    /// Comes to rest: wherever the energy of motion has passed a peak, all nodes stop (kinetic damping). It ends when peaks are below `share` of the largest, or
    /// after `most` steps.
    pub fn rest(&self, share: f64, most: u32) -> Result<Rest, StudyError> {
        const LOOK: u32 = 16;
        let (mut last, mut largest, mut steps) = (0.0, 0.0_f64, 0);
        let masses = &self.membrane.model().masses;
        while steps < most {
            self.steps(LOOK)?;
            steps += LOOK;
            let mut state = self.membrane.read_state(self.device)?;
            let speed2 = |v: [f32; 3]| v.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>();
            let kinetic: f64 =
                state.nodes.iter().zip(masses).map(|(node, mass)| 0.5 * mass * speed2(node.velocity)).sum();
            if kinetic >= last {
                last = kinetic;
                continue;
            }
            largest = largest.max(last);
            if last < share * largest {
                return Ok(Rest { steps, peak: last / largest });
            }
            last = 0.0;
            for node in &mut state.nodes {
                (node.velocity, node.dt) = ([0.0; 3], 0.0);
            }
            self.membrane.write_state(self.device, &state)?;
        }
        Ok(Rest { steps, peak: last / largest })
    }
}

/// How a membrane came to rest.
#[derive(Debug, Clone, Copy)]
pub struct Rest {
    pub steps: u32,
    /// The last peak of the energy of motion over the largest.
    pub peak: f64,
}
