//! Reading a checkpoint: nothing is believed before its checksum.

use std::fs::File;
use std::io::{Read, Seek};
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;

use super::OutputState;
use super::error::CheckpointError;
use super::layout::{ID_MASK, ID_OFFSET, MANIFEST, PLAN, RECORD_BYTES, SCENE, STATE, complete, particle_file};
use super::manifest::{self, Adapter, FileRecord, Manifest};
use crate::output::checksum::length_and_crc;
use crate::scene::{FABRIC_FILES, Fabric, Scene, Shape, UnitSystem, is_one_file};

/// The state is far smaller: it does not grow with the particles.
const MOST_STATE_BYTES: u64 = 1 << 30;
/// What is taken at once for a length that a file claims; more as data come.
const FIRST_ALLOCATION: u64 = 64 << 20;
/// Records that are read at once.
pub(super) const PIECE: usize = 1 << 12;

/// A checkpoint whose manifest is sound, with the rest checked as [`Checkpoint::open`] or the accessors say.
#[derive(Debug, Clone)]
pub struct Checkpoint {
    path: PathBuf,
    manifest: Manifest,
}

impl Checkpoint {
    /// Opens the checkpoint in the folder `path` and checks all of it: sizes, checksums, meshes, and that the particles'
    /// ids are each there once.
    ///
    /// # Errors
    /// Why it cannot be used, and which older one there is.
    pub fn open(path: &Path) -> Result<Checkpoint, CheckpointError> {
        let whole = || {
            let checkpoint = Checkpoint::manifest_of(path)?;
            checkpoint.check_files()?;
            checkpoint.check_ids()?;
            Ok(checkpoint)
        };
        let checkpoint = whole().map_err(|source| CheckpointError::Broken {
            path: path.to_path_buf(),
            source: Box::new(source),
            older: older_than(path),
        })?;
        // The checkpoint is sound; what it needs beside it may not be.
        checkpoint.meshes()?;
        Ok(checkpoint)
    }

    /// For other ranks than the one that has opened and checked it: reads the manifest only. What is read later is
    /// checked then.
    ///
    /// # Errors
    /// If the manifest is not sound.
    pub fn open_checked(path: &Path) -> Result<Checkpoint, CheckpointError> {
        Checkpoint::manifest_of(path)
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The scene, TOML.
    ///
    /// # Errors
    /// If the file is not as it was written.
    pub fn scene(&self) -> Result<String, CheckpointError> {
        self.text(SCENE)
    }

    /// The scene, TOML, with paths of meshes where they are now: the copies in the run's folder, or else the originals. Without
    /// meshes the same as [`Checkpoint::scene`].
    ///
    /// # Errors
    /// If a file is not as it was written.
    pub fn scene_here(&self) -> Result<String, CheckpointError> {
        let text = self.scene()?;
        let meshes = self.meshes()?;
        if meshes.is_empty() {
            return Ok(text);
        }
        let content = |problem: String| CheckpointError::Content { path: self.path.join(SCENE), problem };
        let mut scene: toml::Table = text.parse().map_err(|error: toml::de::Error| content(error.to_string()))?;
        let mut meshes = meshes.into_iter();
        // In the order of `meshes_of`.
        for (list, keys) in [("wall", &["file"][..]), ("fabric", &FABRIC_FILES)] {
            let entries = scene.get_mut(list).and_then(toml::Value::as_array_mut);
            for entry in entries.into_iter().flatten() {
                for &key in keys {
                    let kept = |file: &toml::Value| file.as_str().is_some_and(|name| is_one_file(Path::new(name)));
                    if let Some(file) = entry.get_mut(key)
                        && kept(file)
                        && let Some(mesh) = meshes.next()
                    {
                        *file = toml::Value::String(mesh.to_string_lossy().into_owned());
                    }
                }
            }
        }
        toml::to_string(&scene).map_err(|error| content(error.to_string()))
    }

    /// The unit system in which the run tells what it tells.
    pub fn units(&self) -> UnitSystem {
        let named = |system: &UnitSystem| self.manifest.units.as_deref() == Some(system.name());
        UnitSystem::ALL.into_iter().find(named).unwrap_or_default()
    }

    /// Gives the meshes of `scene`, read from [`Checkpoint::scene_here`], the paths that the run knows them by, and the scene its units.
    pub fn restore_names(&self, scene: &mut Scene) {
        scene.units = self.units();
        let paths = scene.walls.iter_mut().filter_map(|wall| match &mut wall.shape {
            Shape::Mesh { path, .. } => Some(path),
            _ => None,
        });
        let of_fabric = scene.fabrics.iter_mut().flat_map(Fabric::files_mut);
        for (path, record) in paths.chain(of_fabric).zip(&self.manifest.mesh) {
            path.clone_from(&record.path);
        }
    }

    /// Where the meshes are now, in the order of the walls.
    ///
    /// # Errors
    /// If one is nowhere as it was.
    pub fn meshes(&self) -> Result<Vec<PathBuf>, CheckpointError> {
        let whole = std::path::absolute(&self.path).unwrap_or_else(|_| self.path.clone());
        let run = whole.ancestors().nth(2).unwrap_or(&whole);
        self.manifest.mesh.iter().map(|record| record.find(run)).collect()
    }

    /// The plan, TOML.
    ///
    /// # Errors
    /// If the file is not as it was written.
    pub fn plan(&self) -> Result<String, CheckpointError> {
        self.text(PLAN)
    }

    /// That this program's plan of the scene is the checkpoint's: positions and times are in its units.
    ///
    /// # Errors
    /// If it is not.
    pub fn check_plan(&self, plan: &str) -> Result<(), CheckpointError> {
        let written = self.plan()?;
        if plan == written {
            return Ok(());
        }
        let (mut own, mut theirs) = (plan.lines(), written.lines());
        loop {
            let (found, expected) = (own.next(), theirs.next());
            if found != expected || found.is_none() {
                let line = |line: Option<&str>| line.unwrap_or_default().to_owned();
                let version = self.manifest.version.clone();
                return Err(CheckpointError::OtherPlan { version, found: line(found), expected: line(expected) });
            }
        }
    }

    /// What may make the continuation differ from that of the same machine and program.
    pub fn warnings(&self, adapter: &Adapter) -> Vec<String> {
        let mut warnings = Vec::new();
        let version = env!("CARGO_PKG_VERSION");
        if self.manifest.version != version {
            let theirs = &self.manifest.version;
            warnings
                .push(format!("the checkpoint was written by version {theirs}, this is {version}: bits may differ"));
        }
        let written = &self.manifest.adapter;
        if written != adapter {
            warnings.push(format!(
                "the checkpoint was computed on {} ({}), this is {} ({}): bits may differ from here on",
                written.name, written.driver, adapter.name, adapter.driver
            ));
        }
        warnings
    }

    /// The state of the time loop and of the files of the run.
    ///
    /// # Errors
    /// If the file is not as it was written, or holds another kind of state.
    pub fn state<S: DeserializeOwned>(&self) -> Result<(OutputState, S), CheckpointError> {
        let (path, bytes) = self.checked(self.record(STATE)?)?;
        let content = |problem: String| CheckpointError::Content { path: path.clone(), problem };
        let state = decompress(&bytes, MOST_STATE_BYTES).map_err(content)?;
        match postcard::take_from_bytes(&state) {
            Ok((state, [])) => Ok(state),
            Ok((_, rest)) => Err(content(format!("{} bytes follow the state", rest.len()))),
            Err(error) => Err(content(error.to_string())),
        }
    }

    /// Files of particles; any rank may read any of them.
    pub fn particle_files(&self) -> usize {
        self.manifest.particle_files().count()
    }

    /// The records of file `index`.
    ///
    /// # Errors
    /// If the file is not as it was written.
    pub fn particles(&self, index: usize) -> Result<Vec<u8>, CheckpointError> {
        let Some(record) = self.manifest.particle_files().nth(index) else {
            return Err(CheckpointError::Missing { path: self.path.join(particle_file(index)) });
        };
        let mut records = Vec::new();
        self.pieces(record, 0..record.particles, &mut |piece| records.extend_from_slice(piece))?;
        Ok(records)
    }

    /// The records `wanted` of all, counted through the files in their order, to `take` in pieces of at most
    /// [`PIECE`]: no more than a piece is held.
    ///
    /// # Errors
    /// If a file is not as it was written.
    pub fn records(&self, wanted: Range<u64>, take: &mut dyn FnMut(&[u8])) -> Result<(), CheckpointError> {
        let mut first = 0;
        for record in self.manifest.particle_files() {
            let own = wanted.start.max(first) - first..wanted.end.clamp(first, first + record.particles) - first;
            if own.start < own.end {
                self.pieces(record, own, take)?;
            }
            first += record.particles;
        }
        Ok(())
    }

    /// Records of one file, whose checksum is that of the bytes before any of them is taken.
    fn pieces(
        &self,
        record: &FileRecord,
        wanted: Range<u64>,
        take: &mut dyn FnMut(&[u8]),
    ) -> Result<(), CheckpointError> {
        let path = self.path.join(&record.name);
        let reading = || CheckpointError::reading(&path);
        let mut file = File::open(&path).map_err(reading())?;
        compare(&path, record, length_and_crc(&mut file).map_err(reading())?)?;
        file.rewind().map_err(reading())?;
        let content = |problem: String| CheckpointError::Content { path: path.clone(), problem };
        let mut decoder = zstd::Decoder::new(file).map_err(|error| content(error.to_string()))?;
        let mut piece = vec![0; PIECE * RECORD_BYTES];
        let mut done = 0;
        while done < wanted.end {
            let bytes = (PIECE as u64).min(wanted.end - done) as usize * RECORD_BYTES;
            let found = fill(&mut decoder, &mut piece[..bytes]).map_err(|error| content(error.to_string()))?;
            if found < bytes {
                let (found, expected) =
                    (done * RECORD_BYTES as u64 + found as u64, record.particles * RECORD_BYTES as u64);
                return Err(content(format!("it has {found} bytes of particles, {expected} were written")));
            }
            let skipped = wanted.start.saturating_sub(done).min((bytes / RECORD_BYTES) as u64) as usize;
            if skipped * RECORD_BYTES < bytes {
                take(&piece[skipped * RECORD_BYTES..bytes]);
            }
            done += (bytes / RECORD_BYTES) as u64;
        }
        if done == record.particles && fill(&mut decoder, &mut [0]).map_err(|error| content(error.to_string()))? > 0 {
            let most = record.particles * RECORD_BYTES as u64;
            return Err(content(format!("it holds more than {most} bytes")));
        }
        Ok(())
    }

    fn manifest_of(path: &Path) -> Result<Checkpoint, CheckpointError> {
        let file = path.join(MANIFEST);
        let bytes = read_up_to(&file, manifest::MOST_BYTES)?;
        let manifest = Manifest::from_bytes(&file, &bytes)?;
        Ok(Checkpoint { path: path.to_path_buf(), manifest })
    }

    fn check_files(&self) -> Result<(), CheckpointError> {
        for record in &self.manifest.file {
            let path = self.path.join(&record.name);
            let mut file = File::open(&path).map_err(CheckpointError::reading(&path))?;
            let found = length_and_crc(&mut file).map_err(CheckpointError::reading(&path))?;
            compare(&path, record, found)?;
        }
        Ok(())
    }

    /// Files were found sound one by one; they must also belong together.
    fn check_ids(&self) -> Result<(), CheckpointError> {
        let mut seen = SeenIds { ids: self.manifest.ids, bits: Vec::new() };
        for record in self.manifest.particle_files() {
            let problem = |problem: String| CheckpointError::Content { path: self.path.join(&record.name), problem };
            let mut trouble = None;
            self.pieces(record, 0..record.particles, &mut |piece| {
                let mut ids = piece.chunks_exact(RECORD_BYTES).map(id_of);
                trouble = trouble.take().or_else(|| ids.find_map(|id| seen.trouble(id)));
            })?;
            if let Some(trouble) = trouble {
                return Err(problem(trouble));
            }
        }
        Ok(())
    }

    fn record(&self, name: &str) -> Result<&FileRecord, CheckpointError> {
        let found = self.manifest.file.iter().find(|file| file.name == name);
        found.ok_or_else(|| CheckpointError::Missing { path: self.path.join(name) })
    }

    fn checked(&self, record: &FileRecord) -> Result<(PathBuf, Vec<u8>), CheckpointError> {
        let path = self.path.join(&record.name);
        let bytes = read_up_to(&path, record.bytes.saturating_add(1))?;
        compare(&path, record, (bytes.len() as u64, crc32fast::hash(&bytes)))?;
        Ok((path, bytes))
    }

    fn text(&self, name: &str) -> Result<String, CheckpointError> {
        let (path, bytes) = self.checked(self.record(name)?)?;
        String::from_utf8(bytes).map_err(|error| CheckpointError::Content { path, problem: error.to_string() })
    }
}

/// The ids of particles that were met, a bit each.
struct SeenIds {
    /// All are below.
    ids: u64,
    bits: Vec<u64>,
}

impl SeenIds {
    /// What is wrong with one more particle of this id.
    fn trouble(&mut self, id: u32) -> Option<String> {
        if u64::from(id) >= self.ids {
            return Some(format!("it has particle {id}, and only {} had entered", self.ids));
        }
        let (slot, bit) = (id as usize / 64, 1 << (id % 64));
        if slot >= self.bits.len() {
            self.bits.resize(slot + 1, 0);
        }
        if self.bits[slot] & bit != 0 {
            return Some(format!("particle {id} is in the checkpoint twice, so another is missing"));
        }
        self.bits[slot] |= bit;
        None
    }
}

fn id_of(record: &[u8]) -> u32 {
    let mut word = [0; 4];
    word.copy_from_slice(&record[ID_OFFSET..ID_OFFSET + 4]);
    u32::from_le_bytes(word) & ID_MASK
}

/// As many bytes as there are, and fit.
fn fill(source: &mut impl Read, into: &mut [u8]) -> std::io::Result<usize> {
    let mut found = 0;
    while found < into.len() {
        match source.read(&mut into[found..]) {
            Ok(0) => break,
            Ok(count) => found += count,
            Err(error) if error.kind() == std::io::ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(found)
}

/// The complete checkpoint before that of `path`.
fn older_than(path: &Path) -> Option<PathBuf> {
    let mut older = complete(path.parent()?).ok()?.into_iter().rev().map(|(_, other)| other);
    let name = path.file_name()?;
    older.find(|other| other.file_name().is_some_and(|other| other < name))
}

fn compare(path: &Path, record: &FileRecord, (bytes, crc32): (u64, u32)) -> Result<(), CheckpointError> {
    let path = || path.to_path_buf();
    if bytes != record.bytes {
        return Err(CheckpointError::Length { path: path(), found: bytes, expected: record.bytes });
    }
    if crc32 != record.crc32 {
        let expected = format!("{:08x}", record.crc32);
        return Err(CheckpointError::Checksum { path: path(), found: crc32, expected });
    }
    Ok(())
}

fn read_up_to(path: &Path, most: u64) -> Result<Vec<u8>, CheckpointError> {
    let file = File::open(path).map_err(CheckpointError::reading(path))?;
    let mut bytes = Vec::new();
    file.take(most).read_to_end(&mut bytes).map_err(CheckpointError::reading(path))?;
    Ok(bytes)
}

/// At most `most` bytes, or what is wrong.
fn decompress(bytes: &[u8], most: u64) -> Result<Vec<u8>, String> {
    let mut content = Vec::with_capacity(most.min(FIRST_ALLOCATION).min(64 * bytes.len() as u64) as usize);
    let decoder = zstd::Decoder::new(bytes).map_err(|error| error.to_string())?;
    let mut limited = decoder.take(most.saturating_add(1));
    limited.read_to_end(&mut content).map_err(|error| error.to_string())?;
    if content.len() as u64 > most { Err(format!("it holds more than {most} bytes")) } else { Ok(content) }
}
