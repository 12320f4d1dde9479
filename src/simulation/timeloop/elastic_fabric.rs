//! Elastic fabric of a run: it moves between the gas's steps, by what these gave its nodes.
//!
//! A step of the gas flies against nodes that go straight from where they are at its start to where they are at its end
//! ([`Membrane::step`] puts both there before it), and adds to `impulses` what its hits give them. Among ranks these integers are summed
//! before the next step, and each rank moves the whole fabric alike.
//!
//! What the host knows of it comes with the tallies of an interval: where nodes were when zones were tallied, and the state at its end.

use std::borrow::Cow;

use glam::DVec3;

use crate::fabric::{
    Energies, GpuMembraneNode, Membrane, MembraneInput, MembraneState, Principal, Relaxation, Taut, Triangle, place,
};
use crate::gpu::{Device, Readback, Recording};
use crate::output::{FabricAccount, MembraneFields, TriangleField};
use crate::ranks::Communicator;
use crate::simulation::accounting::row::FabricEnergies;
use crate::simulation::control::interval::Interval;
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::simulation::model::fabric::Surface;
use crate::simulation::model::membranes::Membranes;
use crate::simulation::run_state::FabricState;
use crate::subdomain::{Scales, Subdomain};

/// The volume of a flat bag over its area to the power of 3/2, by rounding, at most.
const FLAT: f64 = 1e-6;
/// Bytes of a place on the lattice.
const PLACE: u64 = size_of::<[u32; 4]>() as u64;

pub struct ElasticFabric<'a> {
    model: &'a Model,
    membranes: &'a Membranes,
    membrane: Membrane,
    /// Of the state, s.
    time: f64,
    /// kg m/s.
    impulse_unit: f64,
    /// The state at the end of the last interval read.
    state: Vec<GpuMembraneNode>,
    /// Where its nodes are, m.
    nodes: Vec<[f64; 3]>,
    /// Of each surface, at the start of the run, m3.
    initial_volumes: Vec<f64>,
    /// Kinetic and strain energy, then, J.
    start: [f64; 2],
    /// Since the last row: times of tallies, and the volume and area of each surface summed over them.
    window: (u64, Vec<[f64; 2]>),
}

/// As it was before an interval.
pub struct SavedFabric {
    state: wgpu::Buffer,
    /// Of the fabric in each step of the interval.
    substeps: u32,
}

impl<'a> ElasticFabric<'a> {
    /// That of a scene, if it has any; the subdomain follows it.
    ///
    /// # Errors
    /// If it is none that a device can have.
    pub fn new(
        model: &'a Model,
        device: &Device,
        subdomain: &mut Subdomain,
    ) -> Result<Option<ElasticFabric<'a>>, SimulationError> {
        let Some(membranes) = &model.fabric.membranes else { return Ok(None) };
        let (plan, scales) = (&model.plan, Scales::new(&model.plan));
        let places = model.fabric.places(0.0);
        let impulse_unit = scales.reference_mass / scales.velocity;
        let input = MembraneInput {
            grid: &plan.grid,
            nodes: &places,
            velocities: &vec![[0.0; 3]; places.len()],
            triangles: &model.fabric.triangles,
            elements: &membranes.elements,
            materials: &membranes.materials,
            added_masses: &membranes.added_masses,
            frictions: &membranes.frictions,
            holds: &membranes.holds,
            gravity: model.scene.gravity,
            substeps: substeps(plan.time_step, membranes.longest_step),
            steps_per_interval: plan.steps_per_interval,
            impulse_unit,
            drag: 0.0,
        };
        let membrane = Membrane::new(device, &input)?.smoothed(model.smoothings());
        membrane.set_bodies(device, &membranes.bodies.faces)?;
        membrane.relax(device, &membranes.relaxations, 0.0);
        subdomain.follow_fabric(device, [&membrane.nodes, &membrane.impulses, &membrane.node_velocities])?;
        let state = membrane.read_state(device)?.nodes;
        let energies = Energies::of(&host_model(membranes, &membrane, 0.0), &state);
        let nodes = lattice_places(model, &state);
        let measures = model.fabric.measures_of(&nodes);
        Ok(Some(ElasticFabric {
            model,
            impulse_unit,
            start: [energies.kinetic, energies.strain],
            initial_volumes: measures.iter().map(|[volume, _]| *volume).collect(),
            window: (0, vec![[0.0; 2]; measures.len()]),
            membranes,
            time: 0.0,
            membrane,
            state,
            nodes,
        }))
    }

    /// Where its nodes are at the end of the last interval read, m.
    pub fn nodes(&self) -> &[[f64; 3]] {
        &self.nodes
    }

    /// What the gas gives to each node in a step.
    pub fn impulses(&self) -> &wgpu::Buffer {
        &self.membrane.impulses
    }

    /// Steps are those of an interval from here on; keeps what there is before them.
    ///
    /// # Errors
    /// If the device has no memory for that.
    pub fn begin_interval(&self, rec: &mut Recording<'_>, interval: &Interval) -> Result<SavedFabric, SimulationError> {
        let (device, dt) = (rec.device(), interval.dt);
        let substeps = substeps(dt, self.membranes.longest_step);
        self.membrane.divide_step(device, dt, substeps);
        self.membrane.relax(device, &self.membranes.relaxations, interval.start);
        if !self.model.moving.is_empty() {
            let end = interval.start + dt * f64::from(interval.steps);
            let shift_of = |wall, time| self.model.moving.shift_of(wall, time);
            let bodies = self.membranes.bodies.between(shift_of, [interval.start, end]);
            self.membrane.set_bodies(device, &bodies)?;
        }
        let led = self.model.fabric.led_velocities(interval.start, dt, interval.steps);
        if !led.is_empty() {
            self.membrane.prescribe(device, &led)?;
        }
        Ok(SavedFabric { state: self.membrane.save(device, rec.encoder())?, substeps })
    }

    /// Moves it through a step of the gas, the one at this place of an interval that began so.
    pub fn step(&self, rec: &mut Recording<'_>, slot: u32, begun: &SavedFabric) {
        self.membrane.divided_step(rec, slot, begun.substeps);
    }

    /// Back to what was kept before an interval.
    pub fn restore(&self, device: &Device, saved: &SavedFabric) {
        let mut encoder = device.encoder();
        self.membrane.restore(&mut encoder, &saved.state);
        device.submit(encoder);
    }

    /// Copies what the host is to know of an interval: the state, whether a node was lost, and the nodes at the tallies of zones.
    ///
    /// # Errors
    /// If the device has no memory for the copy.
    pub fn encode_readback(&self, rec: &mut Recording<'_>, tallied: &[bool]) -> Result<wgpu::Buffer, SimulationError> {
        let nodes = PLACE * self.nodes.len() as u64;
        let tallies = tallied.iter().filter(|tallied| **tallied).count() as u64;
        let state = self.membrane.state.size();
        let staging = rec.device().staging(state + PLACE + tallies * nodes)?;
        let encoder = rec.encoder();
        encoder.copy_buffer_to_buffer(&self.membrane.state, 0, &staging, 0, state);
        encoder.copy_buffer_to_buffer(&self.membrane.faults, 0, &staging, state, 4);
        let ends = (1u64..).zip(tallied).filter(|(_, tallied)| **tallied).map(|(end, _)| end);
        for (place, end) in (0u64..).zip(ends) {
            let offset = state + PLACE + place * nodes;
            encoder.copy_buffer_to_buffer(&self.membrane.nodes, end * nodes, &staging, offset, nodes);
        }
        Ok(staging)
    }

    /// Reads what was copied of an interval; by how much each surface had grown since the start of the run when zones were tallied, on average,
    /// m3.
    ///
    /// # Errors
    /// If the device failed, or a node left the grid.
    pub fn read(
        &mut self,
        device: &Device,
        readback: Readback,
        interval: &Interval,
    ) -> Result<Vec<f64>, SimulationError> {
        self.time = interval.start + interval.dt * f64::from(interval.steps);
        let (bytes, _) = readback.finish(device, <[u8]>::to_vec)?;
        let (state, rest) = bytes.split_at(size_of::<GpuMembraneNode>() * self.nodes.len());
        let (faults, moments) = rest.split_at(PLACE as usize);
        let faults: Vec<u32> = bytemuck::pod_collect_to_vec(faults);
        if faults[0] > 0 {
            return Err(SimulationError::LostNodes { times: faults[0] });
        }
        self.state = bytemuck::pod_collect_to_vec(state);
        self.nodes = lattice_places(self.model, &self.state);
        let moments: Vec<[u32; 4]> = bytemuck::pod_collect_to_vec(moments);
        let surfaces = &self.model.fabric;
        self.refuse_over_a_plane(&self.nodes)?;
        let mut grown = vec![0.0; self.initial_volumes.len()];
        let tallies = moments.chunks_exact(self.nodes.len()).len();
        for moment in moments.chunks_exact(self.nodes.len()) {
            let places: Vec<[f64; 3]> =
                moment.iter().map(|&[x, y, z, _]| self.model.plan.grid.to_metres([x, y, z])).collect();
            self.refuse_over_a_plane(&places)?;
            let measures = surfaces.measures_of(&places);
            let is_inside_out = |(own, [volume, area]): &(&Surface, &[f64; 2])| {
                own.closed && own.elastic && *volume < -FLAT * area.powf(1.5)
            };
            if let Some((surface, _)) = surfaces.all.iter().zip(&measures).find(is_inside_out) {
                return Err(SimulationError::InsideOut { fabric: surface.name.clone(), time: self.time });
            }
            for ((grown, initial), [volume, _]) in grown.iter_mut().zip(&self.initial_volumes).zip(&measures) {
                *grown += (volume - initial) / tallies as f64;
            }
            self.window.0 += 1;
            for (sum, measure) in self.window.1.iter_mut().zip(measures) {
                *sum = [sum[0] + measure[0], sum[1] + measure[1]];
            }
        }
        Ok(grown)
    }

    /// By planes between closed fabrics particles know which of them they are inside of.
    fn refuse_over_a_plane(&self, nodes: &[[f64; 3]]) -> Result<(), SimulationError> {
        let surfaces = &self.model.fabric;
        surfaces.over_a_plane(nodes).map_or(Ok(()), |index| {
            Err(SimulationError::OverPlane { fabric: surfaces.all[index].name.clone(), time: self.time })
        })
    }

    /// The mean volume and area of each surface since the last call, m3 and m2; as they are, if there was no tally since.
    pub fn mean_measures(&mut self) -> Vec<[f64; 2]> {
        let (count, sums) = std::mem::replace(&mut self.window, (0, vec![[0.0; 2]; self.initial_volumes.len()]));
        if count == 0 {
            return self.model.fabric.measures_of(&self.nodes);
        }
        sums.into_iter().map(|sum| sum.map(|sum| sum / count as f64)).collect()
    }

    /// Of each surface, at the end of the last interval read.
    pub fn energies(&self) -> Vec<FabricEnergies> {
        let host = self.half_a_step_before();
        let of = |surface: usize| {
            let (triangles, nodes) = self.model.fabric.parts(surface);
            if !self.model.fabric.all[surface].elastic {
                return FabricEnergies::default();
            }
            let own = Energies::of_part(&host, &self.state, triangles, nodes);
            FabricEnergies { kinetic: own.kinetic, strain: own.strain, damped: own.damped }
        };
        (0..self.initial_volumes.len()).map(of).collect()
    }

    /// The fields of nodes and triangles at the end of the last interval read; triangles of no membrane have no strain.
    pub fn fields(&self) -> MembraneFields {
        let membrane = &*host_model(self.membranes, &self.membrane, self.time);
        let places = self.state.iter().map(|node| place(node, membrane)).collect::<Vec<_>>();
        let of_triangles = self.model.fabric.all.iter().flat_map(|surface| {
            let own = membrane.triangles[surface.triangles.clone()].iter();
            own.map(move |triangle| (triangle, surface.elastic))
        });
        let field = |(triangle, elastic): (&Triangle, bool)| {
            let corners = triangle.nodes.map(|node| places[node as usize]);
            let Principal { strains, stresses, taut } = membrane.principal(triangle, corners);
            let tension = match taut {
                Taut::Nothing => 0,
                Taut::Along(_) => 1,
                Taut::Both => 2,
            };
            let known = TriangleField {
                strain: strains.map(|strain| strain as f32),
                stress: stresses.map(|stress| stress as f32),
                tension,
            };
            if elastic { known } else { TriangleField::default() }
        };
        MembraneFields {
            velocities: self.state.iter().map(|node| node.velocity).collect(),
            triangles: of_triangles.map(field).collect(),
        }
    }

    /// As it is for the energies, whose strain is that of then.
    fn half_a_step_before(&self) -> Cow<'_, crate::fabric::Model> {
        let step = self.state.first().map_or(0.0, |node| f64::from(node.dt));
        host_model(self.membranes, &self.membrane, self.time - 0.5 * step)
    }

    /// The account since the start of the run, but for what it has from the gas; nothing is under way. Collective.
    ///
    /// # Errors
    /// If the device or another rank fails.
    pub fn account(&self, device: &Device, comm: &dyn Communicator) -> Result<FabricAccount, SimulationError> {
        let now = Energies::of(&self.half_a_step_before(), &self.state);
        let [kinetic, strain] = self.start;
        Ok(FabricAccount {
            from_gas: 0.0,
            from_pressure: now.pressure,
            from_gravity: now.gravity,
            from_supports: now.holds + now.obstacles - now.friction + now.reference,
            kinetic: [kinetic, now.kinetic],
            strain: [strain, now.strain],
            damped: now.damped,
            ledger: now.ledger + self.pending(device, &self.pending_impulses(device, comm)?)?,
        })
    }

    /// What hits of the last step gave, which nodes have not taken yet, J.
    fn pending(&self, device: &Device, impulses: &[u64]) -> Result<f64, SimulationError> {
        let given = |([x, y, z, _], impulse): (&[f32; 4], &[u64])| -> f64 {
            let impulse = DVec3::from_array(std::array::from_fn(|axis| impulse[axis] as i64 as f64));
            self.impulse_unit * impulse.dot(DVec3::from_array([*x, *y, *z].map(f64::from)))
        };
        let velocities: Vec<[f32; 4]> = device.read(&self.membrane.node_velocities, self.nodes.len())?;
        Ok(velocities.iter().zip(impulses.chunks_exact(3)).map(given).sum())
    }

    fn pending_impulses(&self, device: &Device, comm: &dyn Communicator) -> Result<Vec<u64>, SimulationError> {
        let own: Vec<u64> = device.read(&self.membrane.impulses, 3 * self.nodes.len())?;
        Ok(comm.sum(own)?)
    }

    /// All that the run is continued from; nothing is under way. Collective.
    ///
    /// # Errors
    /// If the device or another rank fails.
    pub fn state(&self, device: &Device, comm: &dyn Communicator) -> Result<FabricState, SimulationError> {
        Ok(FabricState {
            membrane: bytemuck::pod_collect_to_vec(bytemuck::cast_slice::<_, u32>(&self.state)),
            impulses: self.pending_impulses(device, comm)?,
            window: self.window.clone(),
            start: self.start,
        })
    }

    /// Goes on from a state at a time, s; one rank has the impulses that all have given together.
    ///
    /// # Errors
    /// If it is that of another fabric.
    pub fn put(
        &mut self,
        device: &Device,
        known: &FabricState,
        (is_first, time): (bool, f64),
    ) -> Result<(), SimulationError> {
        self.time = time;
        let words = size_of::<GpuMembraneNode>() / 4 * self.nodes.len();
        for (what, found, expected) in [
            ("words of nodes of fabric", known.membrane.len(), words),
            ("impulses on fabric", known.impulses.len(), 3 * self.nodes.len()),
            ("surfaces of fabric", known.window.1.len(), self.initial_volumes.len()),
        ] {
            if found != expected {
                return Err(RunStateError::differs(what, found as u64, expected as u64).into());
            }
        }
        let nodes: Vec<GpuMembraneNode> = bytemuck::pod_collect_to_vec(&known.membrane);
        let mut impulses: Vec<u32> = bytemuck::pod_collect_to_vec(&known.impulses);
        if !is_first {
            impulses.fill(0);
        }
        self.membrane.write_state(device, &MembraneState { nodes: nodes.clone(), impulses })?;
        self.nodes = lattice_places(self.model, &nodes);
        self.state = nodes;
        self.window.clone_from(&known.window);
        self.start = known.start;
        Ok(())
    }
}

/// On the host, with references as they are at a time, s.
fn host_model<'m>(membranes: &Membranes, membrane: &'m Membrane, time: f64) -> Cow<'m, crate::fabric::Model> {
    if membranes.relaxations.iter().all(|relaxation| *relaxation == Relaxation::NONE) {
        return Cow::Borrowed(membrane.model());
    }
    let mut model = membrane.model().clone();
    model.sizes = membranes.relaxations.iter().map(|relaxation| relaxation.at(time)).collect();
    Cow::Owned(model)
}

/// Steps of the fabric in one of the gas, s.
fn substeps(dt: f64, longest: f64) -> u32 {
    (dt / longest).ceil().max(1.0) as u32
}

/// Where the gas sees them, m.
fn lattice_places(model: &Model, nodes: &[GpuMembraneNode]) -> Vec<[f64; 3]> {
    nodes.iter().map(|node| model.plan.grid.to_metres(node.place)).collect()
}
