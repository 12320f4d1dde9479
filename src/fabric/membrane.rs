//! A membrane on a device: its buffers, and the dispatches of a step.

use crate::gpu::{BoundKernel, Device, GpuError, Kernel, Pass, Recording, fold};

use super::energies::Energies;
use super::error::MembraneError;
use super::input::{Hold, MembraneInput, Obstacle, Relaxation};
use super::law::Law;
use super::layout::{
    GpuElastic, GpuElement, GpuElementForces, GpuMembraneNode, GpuMembraneStep, GpuNodeConstants, GpuObstacle,
    GpuSubstep,
};
use super::model::{Model, Triangle};
use super::obstacles::on_device;
use super::registry::{MOST_OBSTACLES, PHASE};
use super::shaders::shader;
use super::smoothing::neighbours;
use super::state::{IMPULSE_WORDS, MembraneState};

/// Threads of a workgroup of the kernels.
const WORKGROUP: u32 = 64;

/// A membrane, whole. A step of the gas is [`Membrane::step`] and then the gas's own flights against `nodes`; what they give is added to `impulses`.
pub struct Membrane {
    model: Model,
    /// Places on the lattice, `array<vec4<u32>>`: those at the start of step `slot` of an interval at `slot * NODES`, those at its end behind them.
    pub nodes: wgpu::Buffer,
    /// What the gas gave in its last step, in the input's unit: of each node three signed sums of two words, the low one first. The next step takes and clears
    /// them.
    pub impulses: wgpu::Buffer,
    /// With which the gas sees nodes fly, m/s, `array<vec4<f32>>`: those of the flights between `nodes`, smoothed.
    pub node_velocities: wgpu::Buffer,
    /// Of each node a [`GpuMembraneNode`].
    pub state: wgpu::Buffer,
    /// A word: how often a node would have left the grid, or was nowhere. A run with any is wrong.
    pub faults: wgpu::Buffer,
    elastic: wgpu::Buffer,
    element_forces: wgpu::Buffer,
    membrane_step: wgpu::Buffer,
    prescribed: wgpu::Buffer,
    obstacles: wgpu::Buffer,
    /// That of no length.
    no_step: GpuMembraneStep,
    forces_of_elements: BoundKernel,
    move_nodes: BoundKernel,
    take_impulses: BoundKernel,
    /// Of impulses and of velocities, to and fro.
    smooth: [[BoundKernel; 2]; 2],
    /// Passes of smoothing, to and fro.
    smoothings: u32,
    element_groups: [u32; 3],
    node_groups: [u32; 3],
    /// Bytes from one substep to the next in their uniform.
    stride: u32,
}

impl Membrane {
    /// # Errors
    /// If the input does not hold together, a node lies outside the grid, or the device has no room.
    pub fn new(device: &Device, input: &MembraneInput<'_>) -> Result<Membrane, MembraneError> {
        let model = Model::new(input)?;
        let (count, elements) = (input.nodes.len(), model.triangles.len());
        let state = device.storage_of("membrane_nodes", &initial_nodes(input)?)?;
        let slots = (u64::from(input.steps_per_interval) + 1) * count as u64;
        let nodes = device.storage::<[u32; 4]>("nodes", slots)?;
        let impulses = device.storage::<u32>("impulses", (count * IMPULSE_WORDS) as u64)?;
        let element_forces = device.storage::<GpuElementForces>("element_forces", elements as u64)?;
        let (corners, constants) = corners_of_nodes(&model, input.frictions);
        let corners = device.storage_of("corners", &corners)?;
        let constants = device.storage_of("node_constants", &constants)?;
        let of_device: Vec<GpuElement> = model.triangles.iter().map(element).collect();
        let of_device = device.storage_of("elements", &of_device)?;
        let laws: Vec<GpuElastic> = model.laws.iter().map(elastic).collect();
        let elastic = device.storage_of("elastic", &laws)?;
        let held = held_velocities(&model.holds);
        let prescribed = device.storage_of("prescribed", &held.repeat(prescribed_steps(input) as usize))?;
        let obstacles = device.storage::<GpuObstacle>("obstacles", u64::from(MOST_OBSTACLES))?;
        let faults = device.storage::<u32>("faults", 1)?;
        let [given, node_velocities, smoothed] =
            [(); 3].map(|()| device.storage::<[f32; 4]>("node_velocities", count as u64));
        let (given, node_velocities, smoothed) = (given?, node_velocities?, smoothed?);
        let is_free: Vec<bool> = input.holds.iter().map(|hold| *hold == Hold::Free).collect();
        let (neighbours, starts) = neighbours(&is_free, input.triangles);
        let neighbours = device.storage_of("neighbours", &neighbours)?;
        let starts = device.storage_of("neighbour_starts", &starts)?;
        let membrane_step = device.uniform("membrane_step", size_of::<GpuMembraneStep>() as u64)?;
        let stride = device.limits().min_uniform_buffer_offset_alignment.max(size_of::<GpuSubstep>() as u32);
        let substep = substeps(device, input, stride)?;
        let bind = |name: &str, [from, to]: [&wgpu::Buffer; 2]| {
            let kernel = Kernel::new(device, shader(name)?, &[("WORKGROUP", f64::from(WORKGROUP))])?;
            kernel.bind(device, |name| match name {
                "given" => Some(&given),
                "node_velocities" => Some(&node_velocities),
                "neighbours" => Some(&neighbours),
                "neighbour_starts" => Some(&starts),
                "smooth_from" => Some(from),
                "smooth_to" => Some(to),
                "substep" => Some(&substep),
                "membrane_step" => Some(&membrane_step),
                "elastic" => Some(&elastic),
                "elements" => Some(&of_device),
                "element_forces" => Some(&element_forces),
                "corners" => Some(&corners),
                "node_constants" => Some(&constants),
                "prescribed" => Some(&prescribed),
                "obstacles" => Some(&obstacles),
                "membrane_nodes" => Some(&state),
                "impulses" => Some(&impulses),
                "nodes" => Some(&nodes),
                "faults" => Some(&faults),
                _ => None,
            })
        };
        let nothing = [&given, &smoothed];
        let (forces_of_elements, move_nodes) = (bind("element_forces", nothing)?, bind("move_nodes", nothing)?);
        let smooth = |of: &wgpu::Buffer| -> Result<[BoundKernel; 2], GpuError> {
            Ok([bind("smooth_nodes", [of, &smoothed])?, bind("smooth_nodes", [&smoothed, of])?])
        };
        let (take_impulses, smooth) = (bind("take_impulses", nothing)?, [smooth(&given)?, smooth(&node_velocities)?]);
        let groups = |items: usize| fold(items as u64, WORKGROUP, device.limits().max_compute_workgroups_per_dimension);
        Ok(Membrane {
            no_step: step_of_no_length(input, count, elements),
            element_groups: groups(elements),
            node_groups: groups(count),
            model,
            nodes,
            impulses,
            state,
            faults,
            elastic,
            element_forces,
            membrane_step,
            prescribed,
            obstacles,
            forces_of_elements,
            move_nodes,
            take_impulses,
            smooth,
            smoothings: 0,
            node_velocities,
            stride,
        })
    }

    /// With so many passes, a multiple of two, that smooth what the gas gives nodes, and how it sees them fly.
    #[must_use]
    pub fn smoothed(self, passes: u32) -> Membrane {
        Membrane { smoothings: passes.div_ceil(2), ..self }
    }

    fn smooth(&self, pass: &mut Pass<'_>, [to, fro]: &[BoundKernel; 2]) {
        for _ in 0..self.smoothings {
            to.dispatch(pass, 0, self.node_groups);
            fro.dispatch(pass, 0, self.node_groups);
        }
    }

    /// The same on the host.
    pub fn model(&self) -> &Model {
        &self.model
    }

    pub fn node_count(&self) -> u32 {
        self.no_step.nodes
    }

    /// The length of the gas's steps from the next submission on, s: before the first step, and where it changes.
    pub fn set_step(&self, device: &Device, dt: f64) {
        self.divide_step(device, dt, self.no_step.substeps);
    }

    /// The same, in so many steps of the fabric, no more than the input's.
    pub fn divide_step(&self, device: &Device, dt: f64, substeps: u32) {
        let of_fabric = (dt / f64::from(substeps)) as f32;
        let step = GpuMembraneStep { dt: of_fabric, gas_dt: dt as f32, substeps, ..self.no_step };
        device.write(&self.membrane_step, 0, &[step]);
    }

    /// The velocities of prescribed nodes in each of the gas's steps of an interval, from the next submission on, m/s: one for each node, step by step; those
    /// of others count for nothing. Of fewer steps the last counts for the rest.
    ///
    /// # Errors
    /// If they are none of whole steps, or of more than an interval has.
    pub fn prescribe(&self, device: &Device, velocities: &[[f64; 3]]) -> Result<(), MembraneError> {
        let (found, nodes, steps) = (velocities.len(), self.model.holds.len(), self.no_step.prescribed_steps as usize);
        let given = found / nodes;
        if found == 0 || found != given * nodes || given > steps {
            return Err(MembraneError::Count { what: "velocities", found, expected: steps * nodes });
        }
        let of_step = |own: &[[f64; 3]]| -> Vec<[f32; 4]> {
            let holds = own.iter().zip(&self.model.holds).map(|(velocity, hold)| match hold {
                Hold::Prescribed(_) => Hold::Prescribed(*velocity),
                other => *other,
            });
            held_velocities(&holds.collect::<Vec<_>>())
        };
        let mut all: Vec<[f32; 4]> = velocities.chunks_exact(nodes).flat_map(of_step).collect();
        for _ in given..steps {
            all.extend_from_within((given - 1) * nodes..given * nodes);
        }
        device.write(&self.prescribed, 0, &all);
        Ok(())
    }

    /// The obstacles from the next submission on, half-spaces; one that moves anew for each interval.
    ///
    /// # Errors
    /// If there are too many, or one is none.
    pub fn set_obstacles(&self, device: &Device, obstacles: &[Obstacle]) -> Result<(), MembraneError> {
        self.set_bodies(device, &obstacles.iter().map(|&face| vec![face]).collect::<Vec<_>>())
    }

    /// The same of convex bodies, each by its faces.
    ///
    /// # Errors
    /// If they have too many, or one is none.
    pub fn set_bodies(&self, device: &Device, bodies: &[Vec<Obstacle>]) -> Result<(), MembraneError> {
        device.write(&self.obstacles, 0, &on_device(bodies, &self.model, self.no_step.limit)?);
        Ok(())
    }

    /// The references of the materials from a time on, s, and the next submission, for an interval.
    pub fn relax(&self, device: &Device, relaxations: &[Relaxation], time: f64) {
        let laws = self.model.laws.iter().zip(relaxations);
        let of_device = laws.map(|(law, relaxation)| {
            let [loose, tightening] = relaxation.line(time).map(|number| number as f32);
            GpuElastic { loose, tightening, ..elastic(law) }
        });
        let of_device: Vec<GpuElastic> = of_device.collect();
        device.write(&self.elastic, 0, &of_device);
    }

    /// The steps of the fabric in step `slot` of an interval of the gas: takes `impulses`, writes its part of `nodes`.
    pub fn step(&self, recording: &mut Recording<'_>, slot: u32) {
        self.divided_step(recording, slot, self.no_step.substeps);
    }

    /// The same, after [`Membrane::divide_step`] in as many.
    pub fn divided_step(&self, recording: &mut Recording<'_>, slot: u32, substeps: u32) {
        let mut pass = recording.phase(PHASE);
        let first = slot * self.no_step.substeps;
        let [given, velocities] = &self.smooth;
        self.take_impulses.dispatch(&mut pass, 0, self.node_groups);
        self.smooth(&mut pass, given);
        for substep in 0..substeps {
            let at = (first + substep) * self.stride;
            self.forces_of_elements.dispatch(&mut pass, at, self.element_groups);
            self.move_nodes.dispatch(&mut pass, at, self.node_groups);
        }
        self.smooth(&mut pass, velocities);
    }

    /// Copies all that the next step depends on, on the device, for an interval that may run again.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn save(&self, device: &Device, encoder: &mut wgpu::CommandEncoder) -> Result<wgpu::Buffer, GpuError> {
        let (state, impulses) = (self.state.size(), self.impulses.size());
        let saved = device.storage::<u32>("saved_membrane", (state + impulses) / 4)?;
        encoder.copy_buffer_to_buffer(&self.state, 0, &saved, 0, state);
        encoder.copy_buffer_to_buffer(&self.impulses, 0, &saved, state, impulses);
        Ok(saved)
    }

    /// Back to what was saved.
    pub fn restore(&self, encoder: &mut wgpu::CommandEncoder, saved: &wgpu::Buffer) {
        let (state, impulses) = (self.state.size(), self.impulses.size());
        encoder.copy_buffer_to_buffer(saved, 0, &self.state, 0, state);
        encoder.copy_buffer_to_buffer(saved, state, &self.impulses, 0, impulses);
    }

    /// Waits for the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn read_state(&self, device: &Device) -> Result<MembraneState, GpuError> {
        let count = self.model.masses.len();
        Ok(MembraneState {
            nodes: device.read(&self.state, count)?,
            impulses: device.read(&self.impulses, count * IMPULSE_WORDS)?,
        })
    }

    /// From the next submission on.
    ///
    /// # Errors
    /// If it is none of this membrane.
    pub fn write_state(&self, device: &Device, state: &MembraneState) -> Result<(), MembraneError> {
        let (found, expected) = (state.nodes.len(), self.model.masses.len());
        if found != expected || state.impulses.len() != expected * IMPULSE_WORDS {
            return Err(MembraneError::State { found, expected });
        }
        device.write(&self.state, 0, &state.nodes);
        device.write(&self.impulses, 0, &state.impulses);
        Ok(())
    }

    /// Of each triangle at the start of the last step of the fabric, waiting for the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn read_forces(&self, device: &Device) -> Result<Vec<GpuElementForces>, GpuError> {
        device.read(&self.element_forces, self.model.triangles.len())
    }

    /// How often nodes would have left the grid, waiting for the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn read_faults(&self, device: &Device) -> Result<u32, GpuError> {
        Ok(device.read::<u32>(&self.faults, 1)?[0])
    }

    /// The account, waiting for the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn energies(&self, device: &Device) -> Result<Energies, GpuError> {
        Ok(Energies::of(&self.model, &device.read::<GpuMembraneNode>(&self.state, self.model.masses.len())?))
    }
}

fn step_of_no_length(input: &MembraneInput<'_>, nodes: usize, elements: usize) -> GpuMembraneStep {
    let grid = input.grid;
    GpuMembraneStep {
        dt: 0.0,
        gas_dt: 0.0,
        quantum: grid.quantum() as f32,
        quanta: (1.0 / grid.quantum()) as f32,
        gravity: input.gravity.map(|g| g as f32),
        drag: input.drag as f32,
        limit: grid.cells.map(|cells| cells << grid.cell_bits),
        nodes: nodes as u32,
        elements: elements as u32,
        substeps: input.substeps,
        impulse_unit: input.impulse_unit as f32,
        prescribed_steps: prescribed_steps(input),
    }
}

/// Steps of an interval that have velocities of held nodes of their own.
fn prescribed_steps(input: &MembraneInput<'_>) -> u32 {
    let moves = input.holds.iter().any(|hold| matches!(hold, Hold::Prescribed(_)));
    if moves { input.steps_per_interval } else { 1 }
}

fn initial_nodes(input: &MembraneInput<'_>) -> Result<Vec<GpuMembraneNode>, MembraneError> {
    let (grid, quantum) = (input.grid, input.grid.quantum());
    let node = |(node, (&place, velocity)): (usize, (&[f64; 3], &[f64; 3]))| {
        let fixed = grid.to_fixed(place).ok_or(MembraneError::Outside { node, place })?;
        let exact = |axis: usize| (place[axis] - grid.origin[axis]) / quantum;
        let velocity = velocity.map(|v| v as f32);
        Ok(GpuMembraneNode {
            place: fixed,
            remainder: std::array::from_fn(|axis| (exact(axis) - f64::from(fixed[axis])) as f32),
            velocity,
            seen: velocity,
            ..GpuMembraneNode::default()
        })
    };
    input.nodes.iter().zip(input.velocities).enumerate().map(node).collect()
}

/// Of each node its triangles, four times each and which corner it is, by rising triangle; and what does not change.
fn corners_of_nodes(model: &Model, frictions: &[f64]) -> (Vec<u32>, Vec<GpuNodeConstants>) {
    let mut of_nodes = vec![Vec::new(); model.masses.len()];
    for (k, triangle) in model.triangles.iter().enumerate() {
        for (corner, &node) in triangle.nodes.iter().enumerate() {
            of_nodes[node as usize].push(4 * k as u32 + corner as u32);
        }
    }
    let mut corners = Vec::with_capacity(3 * model.triangles.len());
    let mut constants = Vec::with_capacity(of_nodes.len());
    for (node, ((own, &mass), hold)) in of_nodes.iter().zip(&model.masses).zip(&model.holds).enumerate() {
        let first = corners.len() as u32;
        corners.extend(own);
        let held = u32::from(*hold != Hold::Free);
        let friction = frictions.get(node).copied().unwrap_or(0.0) as f32;
        constants.push(GpuNodeConstants { mass: mass as f32, held, first, end: corners.len() as u32, friction });
    }
    (corners, constants)
}

fn held_velocities(holds: &[Hold]) -> Vec<[f32; 4]> {
    let velocity = |hold: &Hold| match hold {
        Hold::Free | Hold::Fixed => [0.0; 4],
        Hold::Prescribed([x, y, z]) => [*x as f32, *y as f32, *z as f32, 0.0],
    };
    holds.iter().map(velocity).collect()
}

fn element(triangle: &Triangle) -> GpuElement {
    // What the kernel adds to the squares of the edges.
    let [second2, third2, second_third] = triangle.metric.map(|square| {
        let opposite = square.wrapping_neg() as u64;
        [opposite as u32, (opposite >> 32) as u32]
    });
    let [second, third] = triangle.gradients.map(|gradient| gradient.map(|g| g as f32));
    GpuElement {
        nodes: triangle.nodes,
        elastic: triangle.material as u32,
        second,
        third,
        second2,
        third2,
        second_third,
        volume: triangle.volume as f32,
        viscosity: triangle.viscosity as f32,
        pressure: triangle.pressure as f32,
        ..GpuElement::default()
    }
}

fn elastic(law: &Law) -> GpuElastic {
    let d = &law.stiffness;
    GpuElastic {
        stiffness: [d.along, d.across, d.coupling, d.shear].map(|modulus| modulus as f32),
        compliance: law.compliance.map(|c| c as f32),
        young: law.young as f32,
        share: law.compression as f32,
        isotropic: u32::from(law.isotropic),
        ..GpuElastic::default()
    }
}

/// The uniform of all substeps of an interval, each at a multiple of `stride`.
fn substeps(device: &Device, input: &MembraneInput<'_>, stride: u32) -> Result<wgpu::Buffer, GpuError> {
    let count = input.steps_per_interval * input.substeps;
    let buffer = device.uniform("substep", u64::from(count) * u64::from(stride))?;
    let words = stride as usize / 4;
    let mut table = vec![0_u32; count as usize * words];
    for (k, entry) in table.chunks_exact_mut(words).enumerate() {
        entry[0] = k as u32 / input.substeps;
        entry[1] = k as u32 % input.substeps;
    }
    device.write(&buffer, 0, &table);
    Ok(buffer)
}
