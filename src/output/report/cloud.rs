//! The sample of the particles that a page shows: the same ones in every snapshot, chosen by a hash of their ids.
//!
//! A particle's speed is its own. Its temperature is that of the gas around it: of the M_i = molar masses of the particles of
//! a block of about [`BLOCK`] particles, T = sum M_i |v_i - u|^2 / (3 R (n - 1)) with u the velocity of the block's mass; all
//! particles of the snapshot count, not the sample only.

use std::path::{Path, PathBuf};

use super::super::OutputError;
use super::super::names::SNAPSHOT_FOLDER;
use super::super::vtk_reader::VtkFile;
use super::packed;
use crate::scene::GAS_CONSTANT;

/// Particles of a block, about.
const BLOCK: f64 = 64.0;
/// Blocks along an axis at most.
const MOST_BLOCKS: f64 = 96.0;
/// Particles of a snapshot that are shown, and of all snapshots together, about.
const MOST_SHOWN: u64 = 20_000;
const MOST_OF_ALL: u64 = 400_000;
/// Snapshots that are shown at most.
const MOST_FRAMES: usize = 60;

/// The snapshots that a folder lists.
#[derive(Debug, Clone, PartialEq)]
pub struct Listed {
    /// s.
    pub time: f64,
    pub path: PathBuf,
}

/// In the order of their times; empty if the folder has none.
///
/// # Errors
/// If the list is not as a run writes it.
pub fn listed(run: &Path) -> Result<Vec<Listed>, OutputError> {
    let folder = run.join(SNAPSHOT_FOLDER);
    let path = folder.join("particles.pvd");
    if !path.exists() {
        return Ok(Vec::new());
    }
    let text = std::fs::read_to_string(&path).map_err(OutputError::io("read", &path))?;
    let entry = |line: &str| -> Option<Listed> {
        let value = |name: &str| line.split(&format!("{name}=\"")).nth(1)?.split('"').next();
        Some(Listed { time: value("timestep")?.parse().ok()?, path: folder.join(value("file")?) })
    };
    let lines = text.lines().enumerate().filter(|(_, line)| line.starts_with("<DataSet"));
    lines
        .map(|(number, line)| {
            let problem = "no entry of a snapshot, `<DataSet timestep=\"...\" ... file=\"...\"/>`".to_owned();
            entry(line).ok_or(OutputError::BadRow { path: path.clone(), line: number as u64 + 1, problem })
        })
        .collect()
}

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
        let all = listed(run)?;
        let chosen = spread(&all);
        let mut cloud = Cloud { snapshots: all.len(), share: 1.0, ..Cloud::default() };
        let mut files = Vec::new();
        for one in chosen {
            match VtkFile::open(&one.path).and_then(|file| Ok((file.count("NumberOfPoints")?, file))) {
                Ok((count, file)) => files.push((one.time, count, file)),
                Err(error) => cloud.unreadable.push(error.to_string()),
            }
        }
        let most = files.iter().map(|(_, count, _)| *count).max().unwrap_or(0);
        let all: u64 = files.iter().map(|(_, count, _)| *count).sum();
        let share = |shown: u64, of: u64| if of > shown { shown as f64 / of as f64 } else { 1.0 };
        cloud.share = share(MOST_SHOWN, most).min(share(MOST_OF_ALL, all));
        for (time, count, mut file) in files {
            if cloud.gases.is_empty() {
                cloud.gases = file.names("gas_names");
            }
            match Particles::read(&mut file) {
                Ok(particles) => cloud.frames.push(particles.sample(time, count, cloud.share, molar_masses)),
                Err(error) => cloud.unreadable.push(error.to_string()),
            }
        }
        Ok(cloud)
    }

    pub fn has_subdomains(&self) -> bool {
        self.frames.iter().any(|frame| !frame.subdomain.is_empty())
    }

    /// Lowest and highest corner, m; `None` without particles.
    pub fn corners(&self) -> Option<[[f64; 3]; 2]> {
        let points = || self.frames.iter().flat_map(|frame| &frame.position);
        points().next()?;
        let end = |pick: fn(f64, f64) -> f64, start: f64| {
            points().fold([start; 3], |end, point| std::array::from_fn(|axis| pick(end[axis], point[axis])))
        };
        Some([end(f64::min, f64::INFINITY), end(f64::max, f64::NEG_INFINITY)])
    }

    /// The range of a list that leaves out the outermost thousandths, so that single particles do not set it.
    pub fn range(&self, list: impl Fn(&Frame) -> &[f32]) -> [f64; 2] {
        let mut values: Vec<f32> = self.frames.iter().flat_map(|frame| list(frame)).copied().collect();
        values.retain(|value| value.is_finite());
        values.sort_unstable_by(f32::total_cmp);
        let Some(last) = values.len().checked_sub(1) else { return [0.0, 1.0] };
        let cut = values.len() / 1000;
        [f64::from(values[cut]), f64::from(values[last - cut])]
    }
}

/// The first, the last and some between.
fn spread(all: &[Listed]) -> Vec<&Listed> {
    let shown = all.len().min(MOST_FRAMES);
    (0..shown).map(|k| &all[k * (all.len() - 1) / (shown - 1).max(1)]).collect()
}

/// All particles of a snapshot, as the file has them.
struct Particles {
    id: Vec<u32>,
    gas: Vec<u8>,
    position: Vec<[f64; 3]>,
    velocity: Vec<[f32; 3]>,
    subdomain: Vec<u32>,
}

impl Particles {
    fn read(file: &mut VtkFile) -> Result<Particles, OutputError> {
        let triples = |values: Vec<f64>| values.as_chunks::<3>().0.to_vec();
        let velocity = file.values("velocity", "Float32", 3, f32::from_le_bytes)?;
        let subdomain =
            if file.has("subdomain") { file.values("subdomain", "UInt32", 1, u32::from_le_bytes)? } else { Vec::new() };
        let read = Particles {
            id: file.values("id", "UInt32", 1, u32::from_le_bytes)?,
            gas: file.values("gas", "UInt8", 1, u8::from_le_bytes)?,
            position: triples(file.values("position", "Float64", 3, f64::from_le_bytes)?),
            velocity: velocity.as_chunks::<3>().0.to_vec(),
            subdomain,
        };
        let found = [read.gas.len(), read.position.len(), read.velocity.len()];
        let among = if read.subdomain.is_empty() { read.id.len() } else { read.subdomain.len() };
        if found.iter().chain([&among]).any(|&length| length != read.id.len()) {
            return Err(file.bad(format!("its arrays are not all of {} particles", read.id.len())));
        }
        Ok(read)
    }

    fn sample(&self, time: f64, count: u64, share: f64, molar_masses: &[f64]) -> Frame {
        let temperatures = self.temperatures(molar_masses);
        let mut frame = Frame { time, count, ..Frame::default() };
        for (index, _) in self.id.iter().enumerate().filter(|(_, id)| is_shown(**id, share)) {
            let speed = self.velocity[index].iter().map(|v| v * v).sum::<f32>().sqrt();
            frame.position.push(self.position[index]);
            frame.speed.push(speed);
            frame.temperature.push(temperatures[index]);
            frame.gas.push(self.gas[index]);
            frame.subdomain.extend(self.subdomain.get(index));
        }
        frame
    }

    /// Of the gas around each particle.
    fn temperatures(&self, molar_masses: &[f64]) -> Vec<f32> {
        let blocks = Blocks::of(&self.position);
        let mut sums = vec![Sums::default(); blocks.count()];
        let mut whole = Sums::default();
        let places: Vec<u32> = self.position.iter().map(|position| blocks.place(position) as u32).collect();
        for ((&place, velocity), &gas) in places.iter().zip(&self.velocity).zip(&self.gas) {
            let mass = molar_masses.get(usize::from(gas)).copied().unwrap_or(0.029);
            sums[place as usize].add(mass, velocity);
            whole.add(mass, velocity);
        }
        let mean = whole.temperature().unwrap_or(0.0) as f32;
        let of_block: Vec<f32> =
            sums.iter().map(|sums| sums.temperature().map_or(mean, |kelvin| kelvin as f32)).collect();
        places.iter().map(|&place| of_block[place as usize]).collect()
    }
}

/// Whether a particle is in a sample of this share. Ids are dealt out in the order of the gas: the hash (multiplication by
/// 2^32 over the golden ratio, then the high bits once more) breaks that.
fn is_shown(id: u32, share: f64) -> bool {
    let mixed = id.wrapping_mul(0x9e37_79b9);
    let mixed = (mixed ^ (mixed >> 15)).wrapping_mul(0x85eb_ca6b);
    f64::from(mixed ^ (mixed >> 13)) < share * (f64::from(u32::MAX) + 1.0)
}

#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    count: f64,
    mass: f64,
    momentum: [f64; 3],
    square: f64,
}

impl Sums {
    fn add(&mut self, mass: f64, velocity: &[f32; 3]) {
        self.count += 1.0;
        self.mass += mass;
        for (sum, v) in self.momentum.iter_mut().zip(velocity) {
            *sum += mass * f64::from(*v);
            self.square += mass * f64::from(*v).powi(2);
        }
    }

    /// K; unknown of a single particle.
    fn temperature(&self) -> Option<f64> {
        let drift: f64 = self.momentum.iter().map(|p| p * p).sum::<f64>() / self.mass;
        (self.count >= 2.0).then(|| (self.square - drift).max(0.0) / (3.0 * GAS_CONSTANT * (self.count - 1.0)))
    }
}

/// A grid of cubes over all particles.
struct Blocks {
    low: [f64; 3],
    edge: f64,
    counts: [usize; 3],
}

impl Blocks {
    fn of(positions: &[[f64; 3]]) -> Blocks {
        let end = |pick: fn(f64, f64) -> f64, start: f64| {
            positions.iter().fold([start; 3], |end, point| std::array::from_fn(|axis| pick(end[axis], point[axis])))
        };
        let (low, high) = (end(f64::min, f64::INFINITY), end(f64::max, f64::NEG_INFINITY));
        let extent: [f64; 3] = std::array::from_fn(|axis| (high[axis] - low[axis]).max(0.0));
        let longest = extent.iter().copied().fold(0.0, f64::max);
        let volume: f64 = extent.iter().map(|edge| edge.max(1e-3 * longest)).product();
        let wanted = (volume * BLOCK / positions.len().max(1) as f64).cbrt();
        let edge = wanted.max(longest / MOST_BLOCKS).max(f64::MIN_POSITIVE);
        let counts = extent.map(|own| if longest > 0.0 { (own / edge) as usize + 1 } else { 1 });
        Blocks { low, edge, counts }
    }

    fn count(&self) -> usize {
        self.counts.iter().product()
    }

    fn place(&self, position: &[f64; 3]) -> usize {
        let index = |axis: usize| (((position[axis] - self.low[axis]) / self.edge) as usize).min(self.counts[axis] - 1);
        (index(2) * self.counts[1] + index(1)) * self.counts[0] + index(0)
    }
}

/// For a page: positions and values in 16 bits of their ranges.
pub fn steps(values: &[f32], range: [f64; 2]) -> String {
    packed::shorts(values.iter().map(|&value| packed::step(f64::from(value), range)))
}

#[cfg(test)]
mod tests;
