//! Rows of the history: averages over a window of whole step intervals, from the integer tallies.
//!
//! Of a zone of volume V with N particles of nu moles, mass M and thermal kinetic energy
//! W = Wk - M u^2 / 2: p = 2 W / (3 V), T = 2 W / (3 N nu R) (docs/explanation/method.md, "The gas"). Of a surface: the
//! normal impulse of its hits over area and time.

use serde::{Deserialize, Serialize};

use super::row::{FabricState, Layout, MotionState, Row, SurfaceState, VentState, WallState, ZoneState};
use crate::plan::Plan;
use crate::scene::GAS_CONSTANT;
use crate::simulation::control::state_error::RunStateError;
use crate::simulation::control::surface_states::VentTarget;
use crate::subdomain::{Scales, SurfaceSum, Tallies, VentSum, ZoneSum};

/// An interval: so many steps of this length, s, of which so many were tallied.
#[derive(Debug, Clone, Copy)]
pub struct Sampled {
    pub dt: f64,
    pub steps: u32,
    pub samples: u32,
}

/// What a vent has passed in a window, or since the start.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Passed {
    left: [i64; 16],
    energy: i128,
    wanted: f64,
    isentropic: f64,
}

impl Passed {
    fn add(&mut self, sum: &VentSum, wanted: &VentTarget) {
        for (total, left) in self.left.iter_mut().zip(sum.left) {
            *total += left;
        }
        self.energy += i128::from(sum.energy);
        self.wanted += wanted.mass;
        self.isentropic += wanted.isentropic;
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
struct Sum {
    number: f64,
    velocity: [f64; 3],
    kinetic: f64,
}

/// The window that is being filled.
pub struct Averages {
    layout: Layout,
    gases: Vec<f64>,
    moles_per_particle: f64,
    scales: Scales,
    heaviest: f64,
    start: f64,
    steps: u64,
    /// Sum of step lengths over the tallies.
    weight: f64,
    /// Zone-major, then gas, without the zone of everything.
    sums: Vec<Sum>,
    /// Per patch, in the window: impulse, normal impulse, hits.
    patches: Vec<SurfaceSum>,
    /// Per patch since the start.
    received: Vec<[i128; 3]>,
    /// Energy that each placed surface model took, in the window and since the start.
    heat: Vec<[i128; 2]>,
    /// What each vent passed, the same.
    passed: Vec<[Passed; 2]>,
    /// Work of the gas on each moving wall, in the window and since the start.
    works: Vec<[i128; 2]>,
    /// Where walls move, the volume of each zone times the weight.
    room: Vec<f64>,
}

/// The open window, and what walls have received.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AveragesState {
    start: f64,
    steps: u64,
    weight: f64,
    sums: Vec<Sum>,
    /// Normal impulse and hits of each patch: the rest of its sum is not used.
    patches: Vec<(i64, i64)>,
    pub received: Vec<[i128; 3]>,
    heat: Vec<[i128; 2]>,
    passed: Vec<[Passed; 2]>,
    works: Vec<[i128; 2]>,
    room: Vec<f64>,
}

/// What a window has sums of.
#[derive(Debug, Clone, Copy)]
pub struct Counts {
    pub zones: usize,
    pub gases: usize,
    pub patches: usize,
    pub surface_models: usize,
    pub vents: usize,
}

impl AveragesState {
    /// An empty window that starts at a time, s: of a run that is measured from there on, and whose walls are at rest.
    pub fn starting_at(start: f64, counts: &Counts) -> AveragesState {
        let &Counts { zones, gases, patches, surface_models, vents } = counts;
        AveragesState {
            start,
            steps: 0,
            weight: 0.0,
            sums: vec![Sum::default(); zones * gases],
            patches: vec![(0, 0); patches],
            received: vec![[0; 3]; patches],
            heat: vec![[0; 2]; surface_models],
            passed: vec![[Passed::default(); 2]; vents],
            works: Vec::new(),
            room: Vec::new(),
        }
    }
}

impl Averages {
    pub fn new(plan: &Plan, layout: Layout, patches: usize) -> Averages {
        let scales = Scales::new(plan);
        let zones = layout.volumes.len();
        Averages {
            gases: plan.gases.iter().map(|gas| gas.molar_mass).collect(),
            moles_per_particle: plan.moles_per_particle,
            heaviest: scales.reference_mass / plan.moles_per_particle,
            scales,
            start: 0.0,
            steps: 0,
            weight: 0.0,
            sums: vec![Sum::default(); zones * plan.gases.len()],
            patches: vec![SurfaceSum::default(); patches],
            received: vec![[0; 3]; patches],
            heat: vec![[0; 2]; layout.surface_models],
            passed: vec![[Passed::default(); 2]; layout.vents.len()],
            works: vec![[0; 2]; layout.motions + layout.fabrics + usize::from(layout.elastic)],
            room: if layout.motions + layout.fabrics > 0 { vec![0.0; zones] } else { Vec::new() },
            layout,
        }
    }

    /// Adds an interval; `wanted` is what its vents should have passed.
    pub fn add(&mut self, tallies: &Tallies, sampled: Sampled, wanted: &[VentTarget]) {
        let Sampled { dt, steps, samples } = sampled;
        self.steps += u64::from(steps);
        self.weight += dt * f64::from(samples);
        let zones = tallies.zones.iter().skip(self.gases.len());
        for (sum, measured) in self.sums.iter_mut().zip(zones) {
            let ZoneSum { number, velocity, kinetic, .. } = *measured;
            sum.number += dt * number as f64;
            sum.kinetic += dt * kinetic as f64;
            for (total, velocity) in sum.velocity.iter_mut().zip(velocity) {
                *total += dt * velocity as f64;
            }
        }
        for ((patch, received), measured) in self.patches.iter_mut().zip(&mut self.received).zip(&tallies.surfaces) {
            patch.normal += measured.normal;
            patch.hits += measured.hits;
            for (total, impulse) in received.iter_mut().zip(measured.impulse) {
                *total += i128::from(impulse);
            }
        }
        self.add_losses(tallies, wanted);
    }

    /// Of the chambers and probes at the start, m3.
    pub fn initial_volumes(&self) -> &[f64] {
        &self.layout.volumes
    }

    /// Adds the mean volumes of the interval's tallies, m3, where walls move.
    pub fn add_room(&mut self, Sampled { dt, samples, .. }: Sampled, volumes: &[f64]) {
        for (room, volume) in self.room.iter_mut().zip(volumes) {
            *room += dt * f64::from(samples) * volume;
        }
    }

    fn add_losses(&mut self, tallies: &Tallies, wanted: &[VentTarget]) {
        for (heat, placed) in self.heat.iter_mut().zip(&tallies.surface_models) {
            for total in heat {
                *total += i128::from(placed.energy);
            }
        }
        for (work, sum) in self.works.iter_mut().zip(&tallies.works) {
            for total in work {
                *total += i128::from(sum.energy);
            }
        }
        for ((passed, sum), wanted) in self.passed.iter_mut().zip(&tallies.vents).zip(wanted) {
            for total in passed {
                total.add(sum, wanted);
            }
        }
        // What a vent should have passed stands with what left.
        for (passed, sum) in self.passed.iter_mut().zip(&tallies.passages) {
            for total in passed {
                total.add(sum, &VentTarget::default());
            }
        }
    }

    pub fn state(&self) -> AveragesState {
        AveragesState {
            start: self.start,
            steps: self.steps,
            weight: self.weight,
            sums: self.sums.clone(),
            patches: self.patches.iter().map(|patch| (patch.normal, patch.hits)).collect(),
            received: self.received.clone(),
            heat: self.heat.clone(),
            passed: self.passed.clone(),
            works: self.works.clone(),
            room: self.room.clone(),
        }
    }

    /// # Errors
    /// If the state is that of another scene's averages; then nothing is changed.
    pub fn restore(&mut self, state: &AveragesState) -> Result<(), RunStateError> {
        for (what, found, expected) in [
            ("sums over zones", state.sums.len(), self.sums.len()),
            ("patches of wall", state.patches.len(), self.patches.len()),
            ("impulses of patches", state.received.len(), self.received.len()),
            ("surface models of walls", state.heat.len(), self.heat.len()),
            ("vents", state.passed.len(), self.passed.len()),
            ("moving walls", state.works.len(), self.works.len()),
            ("volumes of zones", state.room.len(), self.room.len()),
        ] {
            if found != expected {
                return Err(RunStateError::differs(what, found as u64, expected as u64));
            }
        }
        if !(state.start.is_finite() && state.weight.is_finite() && state.weight >= 0.0) {
            return Err(RunStateError::Impossible { what: "the open window of the averages has no length" });
        }
        (self.start, self.steps, self.weight) = (state.start, state.steps, state.weight);
        self.sums.clone_from(&state.sums);
        let patch = |&(normal, hits): &(i64, i64)| SurfaceSum { normal, hits, ..SurfaceSum::default() };
        self.patches = state.patches.iter().map(patch).collect();
        self.received.clone_from(&state.received);
        self.heat.clone_from(&state.heat);
        self.passed.clone_from(&state.passed);
        self.works.clone_from(&state.works);
        self.room.clone_from(&state.room);
        Ok(())
    }

    /// Whether the window holds a tally.
    pub fn ready(&self) -> bool {
        self.weight > 0.0
    }

    /// The row of the window that ends at `end`, s; starts the next.
    pub fn row(&mut self, end: f64, particles: u64) -> Row {
        let states: Vec<ZoneState> = (0..self.layout.volumes.len()).map(|zone| self.zone(zone)).collect();
        let duration = end - self.start;
        let surfaces = self.layout.surfaces.iter().map(|(patches, area)| self.surface(patches, *area, duration));
        let row = Row {
            time: 0.5 * (self.start + end),
            window: [self.start, end],
            step: duration / self.steps as f64,
            particles,
            surfaces: surfaces.collect(),
            walls: self
                .layout
                .walls
                .iter()
                .map(|(surface_models, area)| self.wall(surface_models, *area, duration))
                .collect(),
            vents: self.passed.iter().map(|passed| self.vent(passed, duration)).collect(),
            motions: self.works[..self.layout.motions].iter().map(|work| self.motion(work, duration)).collect(),
            fabrics: (0..self.layout.fabrics).map(|fabric| self.fabric(fabric, duration)).collect(),
            chambers: states[..self.layout.chambers].to_vec(),
            probes: states[self.layout.chambers..].to_vec(),
        };
        self.start = end;
        self.steps = 0;
        self.weight = 0.0;
        self.sums.fill(Sum::default());
        self.patches.fill(SurfaceSum::default());
        self.heat.iter_mut().for_each(|heat| heat[0] = 0);
        self.passed.iter_mut().for_each(|passed| passed[0] = Passed::default());
        self.works.iter_mut().for_each(|work| work[0] = 0);
        self.room.fill(0.0);
        row
    }

    fn zone(&self, zone: usize) -> ZoneState {
        let gases = self.gases.len();
        // Of fabric at rest no room is told.
        let room = self.room.get(zone).filter(|room| **room > 0.0);
        let volume = room.map_or(self.layout.volumes[zone], |room| room / self.weight);
        let (mut mass, mut kinetic, mut number) = (0.0, 0.0, 0.0);
        let mut momentum = [0.0; 3];
        let mut particles = Vec::with_capacity(gases);
        for (sum, molar_mass) in self.sums[zone * gases..(zone + 1) * gases].iter().zip(&self.gases) {
            let own = molar_mass * self.moles_per_particle;
            let count = sum.number / self.weight;
            particles.push(count);
            number += count;
            mass += own * count;
            kinetic += own * sum.kinetic / self.weight / self.scales.energy;
            for (total, velocity) in momentum.iter_mut().zip(sum.velocity) {
                *total += own * velocity / self.weight / self.scales.velocity;
            }
        }
        if number == 0.0 {
            return ZoneState { particles, volume, ..ZoneState::default() };
        }
        let velocity = momentum.map(|p| p / mass);
        let bulk = 0.5 * mass * velocity.iter().map(|v| v * v).sum::<f64>();
        let thermal = kinetic - bulk;
        ZoneState {
            pressure: 2.0 / 3.0 * thermal / volume,
            temperature: 2.0 / 3.0 * thermal / (number * self.moles_per_particle * GAS_CONSTANT),
            density: mass / volume,
            velocity,
            particles,
            volume,
        }
    }

    fn impulse_unit(&self) -> f64 {
        self.heaviest * self.moles_per_particle / self.scales.velocity
    }

    fn surface(&self, patches: &[usize], area: f64, duration: f64) -> SurfaceState {
        let mut state = SurfaceState::default();
        let (mut normal, mut received) = (0i64, [0i128; 3]);
        for &patch in patches {
            normal += self.patches[patch].normal;
            state.hits += self.patches[patch].hits.unsigned_abs();
            for (total, own) in received.iter_mut().zip(self.received[patch]) {
                *total += own;
            }
        }
        state.pressure = normal as f64 * self.impulse_unit() / (area * duration);
        state.impulse = received.map(|units| units as f64 * self.impulse_unit());
        state
    }

    fn energy_unit(&self) -> f64 {
        self.scales.reference_mass / self.scales.energy
    }

    fn wall(&self, surface_models: &[usize], area: f64, duration: f64) -> WallState {
        let sum = |since: usize| surface_models.iter().map(|&placed| self.heat[placed][since]).sum::<i128>() as f64;
        WallState::new(sum(1) * self.energy_unit(), sum(0) * self.energy_unit(), area, duration)
    }

    fn mass(&self, passed: &Passed) -> f64 {
        let of_gas = |(molar_mass, &left): (&f64, &i64)| molar_mass * self.moles_per_particle * left as f64;
        self.gases.iter().zip(&passed.left).map(of_gas).sum()
    }

    fn vent(&self, [window, all]: &[Passed; 2], duration: f64) -> VentState {
        let mass = self.mass(window);
        let over = |mass: f64| if window.isentropic > 0.0 { mass / window.isentropic } else { 0.0 };
        VentState {
            mass_flow: mass / duration,
            wanted_mass_flow: window.wanted / duration,
            discharge: over(mass),
            wanted_discharge: over(window.wanted),
            mass: self.mass(all),
            enthalpy: all.energy as f64 * self.energy_unit(),
        }
    }

    /// Where it is the time loop knows.
    fn motion(&self, work: &[i128; 2], duration: f64) -> MotionState {
        let [window, all] = work.map(|work| -(work as f64) * self.energy_unit() + 0.0);
        MotionState { work: all, power: window / duration, ..MotionState::default() }
    }

    /// How large it is the time loop knows: of the pressures here are the forces, N.
    fn fabric(&self, fabric: usize, duration: f64) -> FabricState {
        let MotionState { work, power, .. } = self.motion(&self.works[self.layout.motions + fabric], duration);
        let force = |side: usize| {
            let normal = self.patches[self.layout.patches + 2 * fabric + side].normal;
            normal as f64 * self.impulse_unit() / duration
        };
        FabricState { pressure: [force(0), force(1)], work, power, ..FabricState::default() }
    }

    /// What elastic fabric has taken from the gas in recoiling since the start, J.
    pub fn total_recoil(&self) -> f64 {
        let of_recoil = self.works.get(self.layout.motions + self.layout.fabrics);
        of_recoil.map_or(0.0, |work| work[1] as f64 * self.energy_unit())
    }

    /// The work that fabric has done on the gas since the start, J.
    pub fn total_work_of_fabric(&self) -> f64 {
        let own = &self.works[self.layout.motions..];
        -(own.iter().map(|work| work[1]).sum::<i128>() as f64) * self.energy_unit() + 0.0
    }

    /// All the work that walls and fabric have done on the gas since the start, J.
    pub fn total_work(&self) -> f64 {
        -(self.works.iter().map(|work| work[1]).sum::<i128>() as f64) * self.energy_unit() + 0.0
    }

    /// All that walls have taken since the start, J.
    pub fn total_heat(&self) -> f64 {
        self.heat.iter().map(|heat| heat[1]).sum::<i128>() as f64 * self.energy_unit()
    }

    /// All that has left the run through vents since the start: particles, kg, J.
    pub fn total_vented(&self) -> (u64, f64, f64) {
        self.total_passed(false)
    }

    /// All that has passed vents to other gas of the run since the start; none where no vent leads there.
    pub fn total_through_fabric(&self) -> Option<(u64, f64, f64)> {
        self.layout.vents.contains(&true).then(|| self.total_passed(true))
    }

    fn total_passed(&self, to_gas: bool) -> (u64, f64, f64) {
        let own = || {
            self.passed.iter().zip(&self.layout.vents).filter(|(_, leads)| **leads == to_gas).map(|([_, all], _)| all)
        };
        let number = own().flat_map(|all| all.left).sum::<i64>();
        // (The sum of nothing is -0.)
        let mass = own().map(|all| self.mass(all)).sum::<f64>() + 0.0;
        let energy = own().map(|all| all.energy).sum::<i128>() as f64;
        (number.unsigned_abs(), mass, energy * self.energy_unit())
    }

    /// All that walls have received since the start, kg m/s.
    pub fn total_impulse(&self) -> [f64; 3] {
        let mut total = [0i128; 3];
        for received in &self.received {
            for axis in 0..3 {
                total[axis] += received[axis];
            }
        }
        total.map(|units| units as f64 * self.impulse_unit())
    }
}
