//! The sample of the particles that a page shows: the same ones in every snapshot, chosen by a hash of their ids.
//!
//! A particle's speed is its own, its temperature that of the gas about it ([`local_temperatures`]). That is made of up to
//! [`MOST_MEASURED`] particles, those of the sample among them.

use std::path::Path;

use super::super::OutputError;
use super::super::local_temperature::local_temperatures;
use super::super::snapshot_read::{Snapshot, SnapshotEntry, snapshots_of};
use super::surfaces::Surfaces;
use super::{extent, packed};

/// Particles of a snapshot that temperatures are made of, about.
const MOST_MEASURED: u64 = 200_000;
/// Particles of a snapshot that are shown, and of all snapshots together, about.
const MOST_SHOWN: u64 = 20_000;
const MOST_OF_ALL: u64 = 400_000;
/// Snapshots that are shown at most.
const MOST_FRAMES: usize = 60;

/// A snapshot's sample, SI.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Frame {
    /// s.
    pub time: f64,
    /// All particles; the lists are of the sample.
    pub count: u64,
    pub position: Vec<[f64; 3]>,
    /// m/s.
    pub speed: Vec<f32>,
    /// K.
    pub temperature: Vec<f32>,
    pub gas: Vec<u8>,
    /// Empty of a run on one device.
    pub subdomain: Vec<u32>,
    /// None of a scene without.
    pub fabric: Surfaces,
}

/// The samples of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cloud {
    pub gases: Vec<String>,
    pub frames: Vec<Frame>,
    /// Snapshots that there are.
    pub snapshots: usize,
    /// Of the particles.
    pub share: f64,
    /// Snapshots that could not be read, and why.
    pub unreadable: Vec<String>,
}

impl Cloud {
    /// Of the snapshots in the folder of a run. `molar_masses`, kg/mol, by gas.
    ///
    /// # Errors
    /// If the list of snapshots is broken. (A snapshot that is broken is told of and left out.)
    pub fn read(run: &Path, molar_masses: &[f64]) -> Result<Cloud, OutputError> {
        let all = snapshots_of(run)?;
        let mut cloud = Cloud { snapshots: all.len(), share: 1.0, ..Cloud::default() };
        let chosen = spread(&all);
        // The last one has the most, unless gas leaves; of none more is held than is asked for.
        let mut frames: Vec<Sampled> = Vec::new();
        for entry in &chosen {
            let fabric = Surfaces::fabric(entry, chosen.len());
            match Snapshot::read(entry).and_then(|snapshot| Ok((snapshot, fabric?))) {
                Ok((snapshot, fabric)) => {
                    if cloud.gases.is_empty() {
                        cloud.gases.clone_from(&snapshot.gas_names);
                    }
                    let share = share(MOST_SHOWN.min(MOST_OF_ALL / chosen.len() as u64), snapshot.ids.len() as u64);
                    cloud.share = cloud.share.min(share);
                    let mut sampled = Sampled::of(&snapshot, entry.time, cloud.share, molar_masses);
                    sampled.frame.fabric = fabric;
                    frames.push(sampled);
                }
                Err(error) => cloud.unreadable.push(error.to_string()),
            }
        }
        let least = cloud.share;
        cloud.frames = frames.into_iter().map(|sampled| sampled.thinned(least)).collect();
        Ok(cloud)
    }

    pub fn has_subdomains(&self) -> bool {
        self.frames.iter().any(|frame| !frame.subdomain.is_empty())
    }

    /// Lowest and highest corner, m; `None` without particles.
    pub fn corners(&self) -> Option<[[f64; 3]; 2]> {
        extent::of(self.frames.iter().flat_map(|frame| &frame.position))
    }

    /// The range of a list that leaves out the outermost thousandths, so that single particles do not set it.
    pub fn range(&self, list: impl Fn(&Frame) -> &[f32]) -> [f64; 2] {
        let mut values: Vec<f32> = self.frames.iter().flat_map(&list).copied().collect();
        values.retain(|value| value.is_finite());
        values.sort_unstable_by(f32::total_cmp);
        let Some(last) = values.len().checked_sub(1) else { return [0.0, 1.0] };
        let cut = values.len() / 1000;
        [f64::from(values[cut]), f64::from(values[last - cut])]
    }
}

/// The first, the last and some between.
fn spread(all: &[SnapshotEntry]) -> Vec<&SnapshotEntry> {
    let shown = all.len().min(MOST_FRAMES);
    (0..shown).map(|k| &all[k * (all.len() - 1) / (shown - 1).max(1)]).collect()
}

fn share(shown: u64, of: u64) -> f64 {
    if of > shown { shown as f64 / of as f64 } else { 1.0 }
}

/// A frame with the ids of its particles: a later snapshot may ask for fewer of them.
struct Sampled {
    ids: Vec<u32>,
    frame: Frame,
}

impl Sampled {
    fn of(snapshot: &Snapshot, time: f64, shown: f64, molar_masses: &[f64]) -> Sampled {
        let count = snapshot.ids.len() as u64;
        let measured = shown.max(share(MOST_MEASURED, count));
        let within = |share: f64| move |&index: &usize| is_shown(snapshot.ids[index], share);
        let all: Vec<usize> = (0..snapshot.ids.len()).filter(within(measured)).collect();
        let mass = |gas: u8| molar_masses.get(usize::from(gas)).copied().unwrap_or(0.029);
        let gas = |&index: &usize| (snapshot.positions[index], snapshot.velocities[index], mass(snapshot.gases[index]));
        let kelvin = local_temperatures(&all.iter().map(gas).collect::<Vec<_>>());
        let mut sampled = Sampled { ids: Vec::new(), frame: Frame { time, count, ..Frame::default() } };
        for (&index, kelvin) in all.iter().zip(kelvin).filter(|(index, _)| within(shown)(index)) {
            let frame = &mut sampled.frame;
            sampled.ids.push(snapshot.ids[index]);
            frame.position.push(snapshot.positions[index]);
            frame.speed.push(snapshot.velocities[index].iter().map(|v| v * v).sum::<f32>().sqrt());
            frame.temperature.push(kelvin as f32);
            frame.gas.push(snapshot.gases[index]);
            frame.subdomain.extend(snapshot.subdomains.as_ref().and_then(|ranks| ranks.get(index)));
        }
        sampled
    }

    /// With those of its particles that a smaller sample has.
    fn thinned(self, share: f64) -> Frame {
        let Sampled { ids, mut frame } = self;
        let stays: Vec<bool> = ids.iter().map(|&id| is_shown(id, share)).collect();
        keep(&mut frame.position, &stays);
        keep(&mut frame.speed, &stays);
        keep(&mut frame.temperature, &stays);
        keep(&mut frame.gas, &stays);
        keep(&mut frame.subdomain, &stays);
        frame
    }
}

/// Leaves the values that stay; a list without values has none to leave.
fn keep<T>(values: &mut Vec<T>, stays: &[bool]) {
    let mut stay = stays.iter();
    values.retain(|_| stay.next().copied().unwrap_or(false));
}

/// Whether a particle is in a sample of this share. Ids are dealt out in the order of the gas: the hash (multiplication by
/// 2^32 over the golden ratio, then the high bits once more) breaks that.
fn is_shown(id: u32, share: f64) -> bool {
    let mixed = id.wrapping_mul(0x9e37_79b9);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca6b);
    f64::from(mixed ^ (mixed >> 13)) < share * (f64::from(u32::MAX) + 1.0)
}

/// For a page: values in 16-bit steps of their range.
pub fn steps(values: &[f32], range: [f64; 2]) -> String {
    packed::shorts(values.iter().map(|&value| packed::step(f64::from(value), range)))
}

#[cfg(test)]
mod tests;
