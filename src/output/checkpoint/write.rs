//! Writing a checkpoint in two steps: every rank its particles, then one rank all the rest and the name.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::OutputState;
use super::error::CheckpointError;
use super::layout::{
    KEPT, MANIFEST, PLAN, RECORD_BYTES, REMOVED_SUFFIX, SCENE, STATE, complete, folder_name, is_left_over,
    particle_file,
};
use super::manifest::{FileRecord, Manifest};
use super::origin::Origin;
use super::read::Checkpoint;
use crate::output::error::PARTIAL_SUFFIX;

/// When in a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    pub step: u64,
    /// s.
    pub time: f64,
    /// All particles of all ranks.
    pub particles: u64,
    /// Particles that have entered so far, initial ones included: ids are below.
    pub ids: u64,
}

/// All of a checkpoint that is not particles.
#[derive(Debug, Clone, Copy)]
pub struct RunContext<'a, S> {
    pub origin: &'a Origin,
    /// Of the time loop.
    pub state: &'a S,
    pub output: &'a OutputState,
}

/// One checkpoint that is being written. Every rank has its own for the same folder, on a file system that they share.
#[derive(Debug)]
pub struct CheckpointWriter {
    parent: PathBuf,
    partial: PathBuf,
    step: u64,
}

impl CheckpointWriter {
    /// Of the checkpoint at `step` in the folder `parent`, which need not be there yet.
    pub fn new(parent: &Path, step: u64) -> CheckpointWriter {
        let partial = parent.join(folder_name(step) + PARTIAL_SUFFIX);
        CheckpointWriter { parent: parent.to_path_buf(), partial, step }
    }

    /// Writes the particles of a rank, records of [`RECORD_BYTES`]; they are on the disc when this returns.
    ///
    /// # Errors
    /// If the system refuses.
    pub fn particles(&self, rank: usize, records: &[u8]) -> Result<FileRecord, CheckpointError> {
        if !records.len().is_multiple_of(RECORD_BYTES) {
            let problem = format!("{} bytes are no whole number of records of {RECORD_BYTES}", records.len());
            return Err(CheckpointError::Encode { what: "the particles", problem });
        }
        fs::create_dir_all(&self.partial).map_err(CheckpointError::io("create", &self.partial))?;
        let record = self.compressed(&particle_file(rank), records)?;
        flush_folder(&self.partial)?;
        Ok(FileRecord { particles: (records.len() / RECORD_BYTES) as u64, ..record })
    }

    /// Once all ranks have written: adds the rest, gives the folder its name, and removes older checkpoints.
    /// Returns the checkpoint's folder. On one rank only.
    ///
    /// # Errors
    /// If particles are missing, or the system refuses; then older checkpoints are as they were.
    pub fn commit<S: Serialize>(
        self,
        particles: Vec<FileRecord>,
        moment: &Moment,
        context: RunContext<'_, S>,
    ) -> Result<PathBuf, CheckpointError> {
        let RunContext { origin, state, output } = context;
        let found = particles.iter().map(|file| file.particles).sum();
        if found != moment.particles {
            return Err(CheckpointError::Particles { found, expected: moment.particles });
        }
        let state = postcard::to_stdvec(&(output, state))
            .map_err(|error| CheckpointError::Encode { what: "the state", problem: error.to_string() })?;
        let mut files = vec![
            self.plain(SCENE, origin.scene.as_bytes())?,
            self.plain(PLAN, origin.plan.as_bytes())?,
            self.compressed(STATE, &state)?,
        ];
        files.extend(particles);
        let manifest = Manifest {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            step: self.step,
            time: moment.time,
            particles: moment.particles,
            ids: moment.ids,
            units: Some(origin.units.name().to_owned()),
            adapter: origin.adapter.clone(),
            file: files,
            mesh: origin.meshes.clone(),
        };
        self.plain(MANIFEST, manifest.to_text()?.as_bytes())?;
        self.remove_strays(&manifest)?;
        flush_folder(&self.partial)?;
        let path = self.take_name(&manifest)?;
        self.remove_older()?;
        Ok(path)
    }

    /// What an earlier attempt of more ranks may have left.
    fn remove_strays(&self, manifest: &Manifest) -> Result<(), CheckpointError> {
        for entry in fs::read_dir(&self.partial).map_err(CheckpointError::io("list", &self.partial))? {
            let entry = entry.map_err(CheckpointError::io("list", &self.partial))?;
            let name = entry.file_name().to_string_lossy().into_owned();
            if name != MANIFEST && !manifest.file.iter().any(|file| file.name == name) {
                fs::remove_file(entry.path()).map_err(CheckpointError::io("remove", &entry.path()))?;
            }
        }
        Ok(())
    }

    fn take_name(&self, manifest: &Manifest) -> Result<PathBuf, CheckpointError> {
        let path = self.parent.join(folder_name(self.step));
        if path.exists() {
            // The same moment of the same run: what stands there is as good, and never goes before the new one stands.
            let same = |there: &Manifest| {
                (there.time, there.particles, there.ids) == (manifest.time, manifest.particles, manifest.ids)
            };
            if Checkpoint::open(&path).is_ok_and(|there| same(there.manifest())) {
                remove(&self.partial)?;
                return Ok(path);
            }
            remove(&path)?;
        }
        fs::rename(&self.partial, &path).map_err(CheckpointError::io("rename", &self.partial))?;
        flush_folder(&self.parent)?;
        Ok(path)
    }

    /// All but the newest complete ones, and what kills have left behind.
    fn remove_older(&self) -> Result<(), CheckpointError> {
        let mut all = complete(&self.parent)?;
        all.truncate(all.len().saturating_sub(KEPT));
        for (_, path) in all {
            remove(&path)?;
        }
        for entry in fs::read_dir(&self.parent).map_err(CheckpointError::io("list", &self.parent))? {
            let path = entry.map_err(CheckpointError::io("list", &self.parent))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            if is_left_over(&name) {
                fs::remove_dir_all(&path).map_err(CheckpointError::io("remove", &path))?;
            }
        }
        Ok(())
    }

    fn plain(&self, name: &str, content: &[u8]) -> Result<FileRecord, CheckpointError> {
        self.file(name, |out| out.write_all(content))
    }

    fn compressed(&self, name: &str, content: &[u8]) -> Result<FileRecord, CheckpointError> {
        self.file(name, |out| {
            let mut encoder = zstd::Encoder::new(out, 1)?;
            encoder.set_pledged_src_size(Some(content.len() as u64))?;
            encoder.write_all(content)?;
            encoder.finish()?;
            Ok(())
        })
    }

    /// Writes a file of the partial folder through to the disc.
    fn file(
        &self,
        name: &str,
        write: impl FnOnce(&mut Measured<'_>) -> io::Result<()>,
    ) -> Result<FileRecord, CheckpointError> {
        let path = self.partial.join(name);
        fs::create_dir_all(&self.partial).map_err(CheckpointError::io("create", &self.partial))?;
        let file = File::create(&path).map_err(CheckpointError::io("create", &path))?;
        let mut out = Measured { file: &file, bytes: 0, crc: crc32fast::Hasher::new() };
        write(&mut out).and_then(|()| file.sync_all()).map_err(CheckpointError::io("write", &path))?;
        Ok(FileRecord { name: name.to_owned(), bytes: out.bytes, crc32: out.crc.finalize(), particles: 0 })
    }
}

/// A file with the length and checksum of what went into it.
struct Measured<'a> {
    file: &'a File,
    bytes: u64,
    crc: crc32fast::Hasher,
}

impl Write for Measured<'_> {
    fn write(&mut self, content: &[u8]) -> io::Result<usize> {
        let count = self.file.write(content)?;
        self.bytes += count as u64;
        self.crc.update(&content[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Removes the complete checkpoints after `step`: to be called where a run goes on from that of `step`, because the
/// outputs that later ones count on are cut back.
///
/// # Errors
/// If the system refuses.
pub fn forget_after(parent: &Path, step: u64) -> Result<(), CheckpointError> {
    for (_, path) in complete(parent)?.into_iter().filter(|(own, _)| *own > step) {
        tracing::info!("{} is of the run beyond this point, which is done anew: removed", path.display());
        remove(&path)?;
    }
    Ok(())
}

/// Takes the name away first: a folder with a plain name is always whole.
fn remove(path: &Path) -> Result<(), CheckpointError> {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(REMOVED_SUFFIX);
    let doomed = path.with_file_name(name);
    if doomed.exists() {
        fs::remove_dir_all(&doomed).map_err(CheckpointError::io("remove", &doomed))?;
    }
    fs::rename(path, &doomed).map_err(CheckpointError::io("remove", path))?;
    fs::remove_dir_all(&doomed).map_err(CheckpointError::io("remove", &doomed))
}

/// Its entries are on the disc when this returns.
fn flush_folder(path: &Path) -> Result<(), CheckpointError> {
    File::open(path).and_then(|folder| folder.sync_all()).map_err(CheckpointError::io("flush", path))
}
