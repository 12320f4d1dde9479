//! Runs of a scene by several ranks of one process on one device.

use std::sync::Arc;

use corpuscle::gpu::{AdapterDescription, Device, KernelVariant};
use corpuscle::partition::By;
use corpuscle::ranks::{Communicator, Pace, in_process};
use corpuscle::simulation::{
    BalanceMode, BalanceOptions, Ghosts, HaloOptions, InitialParticles, Model, Options, Outcome, Setup, Shuffle,
    Simulation, SimulationError, initial_particles,
};

use crate::bits::{Bits, assert_same};
use crate::whole_run::{Run, Witness};

/// What must not matter.
#[derive(Clone, Copy)]
pub struct Way {
    pub ranks: usize,
    pub mode: BalanceMode,
    /// Found by trying if it is not said.
    pub halo_rounds: Option<u32>,
    pub ghosts: Option<Ghosts>,
    pub pace: Pace,
    pub batch: Option<u32>,
    pub order: Option<&'static Shuffle>,
    /// Where the run stops before its end.
    pub stop: Option<u64>,
    pub by: By,
    /// Kernels over short lists are dispatched over all the places that these have, as on a GPU, where all odd numbers of ranks have it. On a
    /// software device few ways do: several ranks with few particles take up to ten times as long.
    pub over_places: bool,
}

impl Way {
    pub fn new(ranks: usize, mode: BalanceMode, halo_rounds: impl Into<Option<u32>>) -> Way {
        let halo_rounds = halo_rounds.into();
        // Both paces, whole and small batches.
        let pace = if (ranks as u32 + halo_rounds.unwrap_or_default()).is_multiple_of(2) {
            Pace::Together
        } else {
            Pace::OneAtATime
        };
        let ghosts = halo_rounds.map(|_| if ranks.is_multiple_of(2) { Ghosts::OnDemand } else { Ghosts::All });
        Way {
            ranks,
            mode,
            halo_rounds,
            ghosts,
            pace,
            batch: None,
            order: None,
            stop: None,
            by: By::Cost,
            over_places: false,
        }
    }

    pub fn over_places(self) -> Way {
        Way { over_places: true, ..self }
    }

    pub fn name(&self) -> String {
        let Way { ranks, mode, halo_rounds, ghosts, pace, batch, order, over_places, .. } = self;
        let over = if *over_places { ", over places" } else { "" };
        let order = if order.is_some() { ", another order" } else { "" };
        format!(
            "{ranks} ranks, {mode:?}, halo for {halo_rounds:?} rounds, ghosts {ghosts:?}, {pace:?}, \
             batches of {batch:?}{order}{over}"
        )
    }

    fn options(&self, device: &Device) -> Options<'static> {
        // Looks at the balance after every interval, and acts on the least imbalance that pays.
        let balance = BalanceOptions { mode: self.mode, by: self.by, every: 1, threshold: 1.0 };
        let halo = HaloOptions { rounds: self.halo_rounds, ghosts: self.ghosts };
        // Lists that grow on the way: those of one device fit from the start.
        let lists_start_short = true;
        Options {
            batch: self.batch,
            halo,
            balance,
            stop_after_steps: self.stop,
            lists_start_short,
            dispatch_by_lengths: if device.adapter().is_cpu() {
                !self.over_places
            } else {
                self.ranks.is_multiple_of(2)
            },
            ..Options::default()
        }
    }
}

/// A communicator put around another.
pub type Wrap = dyn for<'a> Fn(&'a dyn Communicator) -> Box<dyn Communicator + 'a> + Sync;

/// A scene on a device, for any number of ranks.
pub struct World<'a> {
    model: &'a Model,
    one: Vec<(Setup, Device)>,
    several: (Setup, Device),
}

/// The variants of kernels of one rank, in turn, and of several. What these are compared with has the variant that the device takes first. A software device rounds alike in
/// all, so these have the others; a GPU need not, and its ranks have its own.
fn variants(adapter: &AdapterDescription) -> (Vec<KernelVariant>, KernelVariant) {
    match adapter.variants()[..] {
        [first, .., last] if adapter.is_cpu() => {
            (adapter.variants().into_iter().filter(|&variant| variant != first).collect(), last)
        }
        _ => (vec![adapter.variants()[0]], adapter.variants()[0]),
    }
}

impl<'a> World<'a> {
    pub fn new(model: &'a Model) -> World<'a> {
        let first = Device::open(None).expect("an adapter");
        let (of_one, of_several) = variants(first.adapter());
        let made = |ranks, variant| {
            let device = Device::open_in(None, variant).expect("an adapter");
            (Setup::new(model, &device, ranks, None).expect("a set-up"), device)
        };
        let one = of_one.into_iter().map(|variant| made(1, variant)).collect();
        World { model, one, several: made(2, of_several) }
    }

    /// What rank 0 sees; all ranks must see the same rows and counts.
    #[track_caller]
    pub fn run(&self, way: &Way) -> Run {
        self.try_run(way, None).unwrap_or_else(|error| panic!("{}: {error}", way.name()))
    }

    pub fn try_run(&self, way: &Way, wrap: Option<&Wrap>) -> Result<Run, String> {
        if way.ranks > 1 {
            return self.try_run_on(&self.several, way, wrap);
        }
        let mut runs = Vec::new();
        for one in &self.one {
            runs.push(self.try_run_on(one, way, wrap)?);
        }
        for other in runs.iter().skip(1) {
            assert_same("another variant of the kernels", &Bits::of(&runs[0]), &Bits::of(other));
        }
        Ok(runs.swap_remove(0))
    }

    fn try_run_on(&self, on: &(Setup, Device), way: &Way, wrap: Option<&Wrap>) -> Result<Run, String> {
        let (setup, device) = on;
        let mut setup = setup.clone();
        if let Some(order) = way.order {
            let mut particles = initial_particles(self.model).expect("the gas of the start");
            order(&mut particles);
            setup.particles = InitialParticles::Listed(Arc::new(particles));
        }
        let of_rank = |comm: &dyn Communicator| -> Result<(Witness, Outcome), SimulationError> {
            let wrapped = wrap.map(|wrap| wrap(comm));
            let comm = wrapped.as_deref().unwrap_or(comm);
            let mut witness = Witness::default();
            let run = Simulation::among(self.model, device, &setup, comm, way.options(device))
                .and_then(|simulation| simulation.run(&mut witness));
            if let Err(error) = &run {
                comm.fail(&error.to_string(), 1);
            }
            Ok((witness, run?))
        };
        let results = in_process(way.ranks, way.pace, of_rank).map_err(|error| error.to_string())?;
        let mut results = results.into_iter().collect::<Result<Vec<_>, _>>().map_err(|error| error.to_string())?;
        for (witness, outcome) in &results[1..] {
            assert_eq!(witness.rows, results[0].0.rows, "all ranks know the history");
            assert_eq!(outcome.collisions, results[0].1.collisions);
        }
        let (witness, outcome) = results.swap_remove(0);
        Ok(Run { rows: witness.rows, snapshots: witness.snapshots, outcome })
    }
}
