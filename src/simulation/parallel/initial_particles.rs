//! How the particles of a start come to the ranks that own them; no rank ever has all of them.
//!
//! Each rank draws or reads an equal share. The ranks cut the space by histograms of their shares, and then hand each other
//! what the other owns, so many at a time. A rank holds its share, what it owns, and what is on its way.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

use crate::gas::{Correction, FillError, Filling, InitialGas, Particle, Space};
use crate::geometry::{Bag, Grid, region_bounds};
use crate::output::Checkpoint;
use crate::ranks::{Communicator, RankError};
use crate::simulation::error::SimulationError;
use crate::simulation::model::build::Model;
use crate::subdomain::{GpuParticle, Scales, StateError};

/// What a rank hands on at once of its share.
const BATCH: usize = 1 << 14;

/// The particles of a start, before they are anyone's.
#[derive(Clone)]
pub enum InitialParticles {
    /// Of a scene that starts: by id.
    Sampled(Initial),
    /// Of a run that goes on: as they are in the files.
    Saved(Arc<Checkpoint>),
    /// In the memory that all ranks of the process share: for tests and studies.
    Listed(Arc<Vec<GpuParticle>>),
}

/// What makes the initial gas exact, once a rank of the process has wanted to know it.
#[derive(Clone, Default)]
pub struct Initial(Arc<OnceLock<Result<Vec<Correction>, FillError>>>);

impl InitialParticles {
    fn number(&self, model: &Model) -> u64 {
        match self {
            InitialParticles::Sampled(_) => model.plan.initial_particles,
            InitialParticles::Saved(checkpoint) => checkpoint.manifest().particles,
            InitialParticles::Listed(all) => all.len() as u64,
        }
    }

    /// An equal part of the particles for each rank, in whose order they are.
    ///
    /// # Errors
    /// If the gas does not fit the walls, or a file is not as it was written.
    pub fn share(&self, model: &Model, comm: &dyn Communicator) -> Result<Cow<'_, [GpuParticle]>, SimulationError> {
        let wanted = share(self.number(model), comm.rank(), comm.size());
        Ok(match self {
            InitialParticles::Sampled(_) if comm.size() == 1 => Cow::Owned(initial_particles(model)?),
            InitialParticles::Sampled(initial) => Cow::Owned(initial.part(model, wanted)?),
            InitialParticles::Saved(checkpoint) => {
                let mut own = Vec::with_capacity((wanted.end - wanted.start) as usize);
                checkpoint
                    .records(wanted, &mut |piece| own.extend(bytemuck::pod_collect_to_vec::<u8, GpuParticle>(piece)))?;
                Cow::Owned(own)
            }
            InitialParticles::Listed(all) => Cow::Borrowed(&all[wanted.start as usize..wanted.end as usize]),
        })
    }

    /// What this rank owns, of all ranks' shares. Collective.
    ///
    /// # Errors
    /// If another rank fails, or a particle gets lost.
    pub fn own(
        &self,
        model: &Model,
        comm: &dyn Communicator,
        share: Cow<'_, [GpuParticle]>,
        owner: impl Fn(&GpuParticle) -> usize,
    ) -> Result<Vec<GpuParticle>, SimulationError> {
        match self {
            InitialParticles::Listed(all) => {
                Ok(all.iter().filter(|particle| owner(particle) == comm.rank()).copied().collect())
            }
            _ if comm.size() == 1 => Ok(share.into_owned()),
            _ => hand_out(share.into_owned(), self.number(model), comm, owner),
        }
    }
}

impl Initial {
    fn part(&self, model: &Model, wanted: Range<u64>) -> Result<Vec<GpuParticle>, SimulationError> {
        let ids = wanted.start as u32..wanted.end as u32;
        with_gas(model, |gas| {
            let corrections = self.0.get_or_init(|| gas.corrections()).as_ref().map_err(FillError::clone)?;
            let scales = Scales::new(&model.plan);
            let sided = Sided::new(model);
            let stored = |particle| Ok(sided.stored(&particle?, &scales)?);
            gas.part(corrections, ids)?.map(stored).collect()
        })
    }
}

/// The initial gas, by id.
///
/// # Errors
/// If it does not fit the walls.
pub fn initial_particles(model: &Model) -> Result<Vec<GpuParticle>, SimulationError> {
    let particles = with_gas(model, |gas| Ok(gas.all()?))?;
    let scales = Scales::new(&model.plan);
    let sided = Sided::new(model);
    let stored = particles.iter().map(|particle| sided.stored(particle, &scales));
    Ok(stored.collect::<Result<_, _>>()?)
}

/// Tells particles of a start on which side of closed fabric they are.
struct Sided<'a> {
    grid: &'a Grid,
    bags: &'a [Option<Bag>],
}

impl Sided<'_> {
    fn new(model: &Model) -> Sided<'_> {
        Sided { grid: &model.plan.grid, bags: &model.vessel.bags }
    }

    fn stored(&self, particle: &Particle, scales: &Scales) -> Result<GpuParticle, StateError> {
        let mut stored = GpuParticle::from_host(particle, self.grid, scales)?;
        if self.bags.iter().flatten().any(|bag| bag.contains(particle.position)) {
            stored.tag |= GpuParticle::INSIDE;
        }
        Ok(stored)
    }
}

/// Finds a place for a particle of each gas in each chamber.
///
/// # Errors
/// If the initial gas does not fit the walls.
pub fn find_room(model: &Model) -> Result<(), SimulationError> {
    with_gas(model, |gas| Ok(gas.find_room()?))
}

/// The uniform point of a solid for four numbers between 0 and 1, m.
type PointOf<'a> = Box<dyn Fn([f64; 4]) -> [f64; 3] + 'a>;

fn with_gas<T>(
    model: &Model,
    act: impl FnOnce(&InitialGas<'_>) -> Result<T, SimulationError>,
) -> Result<T, SimulationError> {
    let Model { scene, vessel, plan, .. } = model;
    let in_chamber: Vec<Box<dyn Fn([f64; 3]) -> bool>> = (0..scene.chambers.len())
        .map(|index| -> Box<dyn Fn([f64; 3]) -> bool> {
            Box::new(move |point| scene.chambers.iter().position(|chamber| vessel.is_of(chamber, point)) == Some(index))
        })
        .collect();
    let in_bags: Vec<Option<PointOf<'_>>> = scene
        .chambers
        .iter()
        .map(|asked| -> Option<PointOf<'_>> {
            let bag = vessel.bag_of(asked)?;
            Some(Box::new(|uniform| bag.point(uniform)))
        })
        .collect();
    let fillings: Vec<Filling<'_>> = scene
        .chambers
        .iter()
        .zip(&plan.chambers)
        .zip(in_chamber.iter().zip(&in_bags))
        .map(|((asked, planned), (inside, bag))| {
            let space = match bag {
                Some(point) => Space::Solid(point),
                None => {
                    let (min, max) = asked.region.as_ref().map_or(vessel.bounds, region_bounds);
                    Space::Box { min, max }
                }
            };
            Filling { counts: &planned.particles, temperature: asked.temperature, space, in_chamber: inside }
        })
        .collect();
    act(&InitialGas {
        chambers: &fillings,
        gases: &plan.species(),
        is_gas: &|point| vessel.is_gas(point),
        moles_per_particle: plan.moles_per_particle,
        seed: plan.seed,
    })
}

/// Which of so many particles are a rank's share.
fn share(number: u64, rank: usize, ranks: usize) -> Range<u64> {
    let start = |rank: usize| (u128::from(number) * rank as u128 / ranks as u128) as u64;
    start(rank)..start(rank + 1)
}

/// Gives every particle of this rank's share to its owner; returns what the others' shares and its own have for this one.
fn hand_out(
    mut share: Vec<GpuParticle>,
    number: u64,
    comm: &dyn Communicator,
    owner: impl Fn(&GpuParticle) -> usize,
) -> Result<Vec<GpuParticle>, SimulationError> {
    let (rank, ranks) = (comm.rank(), comm.size());
    let mut own = Vec::with_capacity(share.len());
    // As often as the largest share needs, the same on all ranks.
    for _ in 0..number.div_ceil(ranks as u64).div_ceil(BATCH as u64) {
        let mut messages = vec![Vec::new(); ranks];
        for particle in share.drain(share.len().saturating_sub(BATCH)..) {
            let owner = owner(&particle);
            if owner == rank {
                own.push(particle);
            } else {
                messages[owner].extend_from_slice(bytemuck::bytes_of(&particle));
            }
        }
        let others = || (0..ranks).filter(|&other| other != rank);
        for other in others() {
            comm.send(other, std::mem::take(&mut messages[other]))?;
        }
        for other in others() {
            own.extend(bytemuck::pod_collect_to_vec::<u8, GpuParticle>(&whole(comm.receive(other)?, other)?));
        }
    }
    let found = comm.sum(vec![own.len() as u64])?[0];
    if found == number { Ok(own) } else { Err(SimulationError::Dealt { found, expected: number }) }
}

/// A message of whole particles.
fn whole(message: Vec<u8>, rank: usize) -> Result<Vec<u8>, RankError> {
    let sound = message.len().is_multiple_of(size_of::<GpuParticle>());
    if sound { Ok(message) } else { Err(RankError::Garbled { rank }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::{Pace, in_process};

    fn particle(id: u32) -> GpuParticle {
        GpuParticle { tag: GpuParticle::tag(0, id), ..GpuParticle::default() }
    }

    /// Shares are equal, and all particles are in one.
    #[test]
    fn shares_are_equal() {
        for (number, ranks) in [(0, 3), (2, 7), (1000, 7), ((1 << 28) - 1, 384)] {
            let shares: Vec<Range<u64>> = (0..ranks).map(|rank| share(number, rank, ranks)).collect();
            assert_eq!((shares[0].start, shares[ranks - 1].end), (0, number));
            assert!(shares.windows(2).all(|pair| pair[0].end == pair[1].start));
            assert!(shares.iter().all(|share| (share.end - share.start).abs_diff(number / ranks as u64) <= 1));
        }
    }

    /// Whoever has them first: also all in one rank's hands, and in more than one go.
    #[test]
    fn every_particle_comes_to_its_owner_once() {
        let by_turns = |id: u32| id as usize % 3;
        let to_one = |_| 2;
        let unevenly = |id: u32| if id > 5 { 2 } else { 0 };
        let laws: [&(dyn Fn(u32) -> usize + Sync); 3] = [&by_turns, &to_one, &unevenly];
        for number in [0, 1, 11, 4 * BATCH as u64 + 5] {
            for (k, law) in laws.into_iter().enumerate() {
                let dealt = in_process(3, Pace::Together, |comm: &dyn Communicator| {
                    let mine = share(number, comm.rank(), comm.size()).map(|id| particle(id as u32)).collect();
                    hand_out(mine, number, comm, |particle| law(particle.id())).unwrap()
                });
                for (rank, dealt) in dealt.unwrap().into_iter().enumerate() {
                    let mut found: Vec<u32> = dealt.iter().map(GpuParticle::id).collect();
                    found.sort_unstable();
                    let owned: Vec<u32> = (0..number as u32).filter(|&id| law(id) == rank).collect();
                    assert!(
                        found == owned,
                        "{number} particles, law {k}: rank {rank} has {} of {}",
                        found.len(),
                        owned.len()
                    );
                }
            }
        }
    }
}
