//! The counts of a sweep that are emulated.

use crate::gpu::Device;
use crate::partition::By;
use crate::simulation::{Ghosts, HaloOptions, Initial, InitialParticles, Model, Setup};
use crate::study::Strategy;
use crate::study::emulation::{Emulated, Emulator, State};
use crate::study::modelled::{Costs, Gpu, Network, Point, point};
use crate::study::state::{Moment, weights};

use super::super::CliError;
use super::super::arguments::{EmulationArguments, TuningArguments};
use super::super::settings::model_of;
use super::plan::SweepPlan;

/// Steps of an interval that is measured in an emulation: of the first and last another thing is measured.
pub(super) const EMULATED_STEPS: u32 = 3;

/// So few steps are no time to try what is faster, and what is compared must have one halo.
pub(super) fn halo(raw: &TuningArguments) -> HaloOptions {
    let asked = HaloOptions::from(raw);
    HaloOptions { rounds: asked.rounds.or(Some(1)), ghosts: asked.ghosts.or(Some(Ghosts::OnDemand)) }
}

/// The states of a count, and how many steps of the run each stands for.
type Emulations = Vec<(f64, Emulated)>;

/// What an emulation found.
pub(super) struct Emulation {
    pub adapter: String,
    /// On the fewest devices.
    pub particles: u64,
    pub costs: Costs,
    pub points: Vec<Point>,
}

impl SweepPlan {
    pub(super) fn emulate(&self, device: &Device) -> Result<Emulation, CliError> {
        let path = &self.raw.scene.scene;
        let (network, gpu) = assumed(&self.raw.emulation);
        let by = By::from(self.raw.tuning.balance_by);
        let halo = halo(&self.raw.tuning);
        let emulator = Emulator { device, intervals: self.raw.emulation.intervals as usize, by, halo };
        let pairs = self.pairs(&self.devices);
        let mut of_pairs: Vec<Emulations> = vec![Vec::new(); pairs.len()];
        let mut particles = Vec::new();
        // Where each device has its own particles, a count has a scene of its own.
        let one = model_of(path, self.scene.clone())?.plan.particles;
        let groups: Vec<&[usize]> =
            if self.raw.runs.weak { self.devices.chunks(1).collect() } else { vec![&self.devices] };
        let mut first = 0;
        for group in groups {
            let held = self.raw.runs.weak.then(|| one * group[0] as u64);
            let of_group = self.pairs(group);
            for at in 0..self.moments.len().max(1) {
                let (count, emulated) = self.emulate_state(&emulator, at, held, &of_group)?;
                particles.push(count);
                for (states, own) in of_pairs[first..].iter_mut().zip(emulated) {
                    states.push(own);
                }
            }
            first += of_group.len();
        }
        let costs = Costs::fit(of_pairs.iter().flatten().flat_map(|(_, emulated)| &emulated.shares));
        let points = of_pairs.iter().zip(&pairs).filter_map(|(states, &(devices, _))| {
            let states: Vec<(f64, &Emulated)> = states.iter().map(|(steps, state)| (*steps, state)).collect();
            let particles = if self.raw.runs.weak { one * devices as u64 } else { particles[0] };
            point(&states, particles as f64, &costs, &network, &gpu)
        });
        let adapter = device.adapter().info.name.clone();
        Ok(Emulation { adapter, particles: particles[0], costs, points: points.collect() })
    }

    /// Emulates one state, `held` particles of it if not as many as it has, for these counts and strategies; returns
    /// how many particles it has, and for each pair what was found and the steps that it stands for.
    fn emulate_state(
        &self,
        emulator: &Emulator<'_>,
        at: usize,
        held: Option<u64>,
        pairs: &[(usize, Strategy)],
    ) -> Result<(u64, Emulations), CliError> {
        let device = emulator.device;
        let path = &self.raw.scene.scene;
        let moment = self.moments.get(at);
        let mut scene = moment.map_or(&self.scene, |moment| &moment.model.scene).clone();
        scene.model.particles = held.or(scene.model.particles);
        // A device alone has its intervals as they are: it exchanges nothing from which a step could be told.
        let alone = model_of(path, scene.clone())?;
        let mut among = model_of(path, scene)?;
        among.plan.steps_per_interval = EMULATED_STEPS;
        let steps = match moment {
            Some(_) => weights(&self.moments)[at],
            None => among.plan.estimated_steps,
        };
        let name = moment.map_or_else(|| "the start".to_owned(), Moment::name);
        let set_up = |model: &Model, ranks: usize| -> Result<Setup, CliError> {
            let Some(moment) = moment else { return Ok(Setup::new(model, device, ranks, None)?) };
            let setup = Setup::with_particles(model, device, ranks, moment.particles.clone())?;
            // Cuts of the start of the run are made by the gas of then.
            Ok(Setup { cut_by: Some(InitialParticles::Sampled(Initial::default())), ..setup })
        };
        let several = pairs.iter().any(|&(devices, _)| devices > 1);
        let shared = several.then(|| set_up(&among, 2)).transpose()?;
        let mut found = Vec::with_capacity(pairs.len());
        for &(devices, strategy) in pairs {
            let model = if devices == 1 { &alone } else { &among };
            let own = if devices == 1 { Some(set_up(model, 1)?) } else { None };
            let Some(setup) = own.as_ref().or(shared.as_ref()) else { unreachable!("several devices share a set-up") };
            let run = moment.map(|moment| &moment.run);
            let state = State { name: name.clone(), model, setup, run, steps };
            tracing::info!("{name}: {devices} subdomains, {}", strategy.title());
            found.push((steps, emulator.emulate(&state, devices, strategy)?));
        }
        Ok((among.plan.particles, found))
    }
}

fn assumed(raw: &EmulationArguments) -> (Network, Gpu) {
    let network =
        Network { latency: 1e-6 * raw.latency_us, overhead: 1e-6 * raw.message_us, bandwidth: 1e9 * raw.bandwidth_gbs };
    let gpu = Gpu { unit: 1e-9 * raw.gpu_particle_ns, pass: 1e-6 * raw.gpu_pass_us, wait: 1e-6 * raw.gpu_wait_us };
    (network, gpu)
}
