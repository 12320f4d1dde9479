use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use proptest::prelude::*;

use super::layout::{FORMAT, ID_OFFSET, MANIFEST, PLAN, SCENE, STATE, folder_name};
use super::*;
use crate::output::AppendedState;
use crate::scene::UnitSystem;

/// Particles `ids`, each a record with its id where the device has it and a gas above it.
fn records(ids: impl Iterator<Item = u32>) -> Vec<u8> {
    ids.flat_map(|id| {
        let mut record = [id as u8; RECORD_BYTES];
        record[ID_OFFSET..ID_OFFSET + 4].copy_from_slice(&(id | (3 << 28)).to_le_bytes());
        record
    })
    .collect()
}

fn output() -> OutputState {
    let file = AppendedState { bytes: 12, crc32: 7 };
    OutputState { history: HistoryState { rows: 1, file }, snapshots: None }
}

fn origin() -> Origin {
    let adapter = Adapter { name: "a \"quoted\" adapter".into(), driver: "driver 1".into() };
    Origin {
        scene: "title = \"a\"\n".into(),
        plan: "a = 1\nb = 2\n".into(),
        meshes: Vec::new(),
        adapter,
        units: UnitSystem::TMmS,
    }
}

/// Infinities, and integers beyond 64 bits.
type State = (u64, f64, i128, String);

fn state() -> State {
    (5, f64::INFINITY, -(1i128 << 100), "tally".into())
}

fn commit(
    writer: CheckpointWriter,
    files: Vec<FileRecord>,
    moment: &Moment,
    origin: &Origin,
) -> Result<PathBuf, CheckpointError> {
    writer.commit(files, moment, RunContext { origin, state: &state(), output: &output() })
}

fn moment(step: u64, particles: u64) -> Moment {
    Moment { step, time: 0.1 * step as f64, particles, ids: particles }
}

/// A checkpoint of the particles 0.. in files of these counts.
fn written(parent: &Path, step: u64, counts: &[u32]) -> PathBuf {
    let writer = CheckpointWriter::new(parent, step);
    let mut first = 0;
    let files: Vec<FileRecord> = counts
        .iter()
        .enumerate()
        .map(|(rank, count)| {
            first += count;
            writer.particles(rank, &records(first - count..first)).unwrap()
        })
        .collect();
    commit(writer, files, &moment(step, first.into()), &origin()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The text with its causes, as users see it.
fn text(error: &dyn std::error::Error) -> String {
    error.source().map_or_else(|| error.to_string(), |source| format!("{error}\n{}", text(source)))
}

fn refusal(path: &Path) -> String {
    text(&Checkpoint::open(path).unwrap_err())
}

#[test]
fn a_checkpoint_reads_back_as_written_whatever_the_number_of_ranks() {
    for counts in [&[10][..], &[0, 7, 3], &[1; 12], &[0]] {
        let dir = tempfile::tempdir().unwrap();
        let path = written(&dir.path().join("checkpoints"), 320, counts);
        assert_eq!(latest(dir.path()).unwrap(), path);
        let read = Checkpoint::open(&path).unwrap();
        assert_eq!(read.state::<State>().unwrap(), (output(), state()));
        assert_eq!((read.scene().unwrap(), read.plan().unwrap()), (origin().scene, origin().plan));
        assert_eq!((read.manifest().step, read.manifest().time), (320, 32.0));
        assert_eq!(read.particle_files(), counts.len());
        let particles: Vec<u8> = (0..counts.len()).flat_map(|file| read.particles(file).unwrap()).collect();
        assert_eq!(particles, records(0..counts.iter().sum()));
        let other = Checkpoint::open_checked(&path).unwrap();
        assert_eq!(other.particles(0).unwrap(), read.particles(0).unwrap());
    }
}

/// Any part of the particles, across files, comes in order and in pieces of bounded size.
#[test]
fn parts_of_the_particles_are_read_piece_by_piece() {
    let dir = tempfile::tempdir().unwrap();
    let counts = [9000, 0, 5, 13_000];
    let number: u32 = counts.iter().sum();
    let read = Checkpoint::open(&written(dir.path(), 320, &counts)).unwrap();
    let ends = [0, 1, 4096, 8999, 9000, 9003, 9005, 9006, 20_000, number];
    for (k, &start) in ends.iter().enumerate() {
        for &end in &ends[k..] {
            let (mut found, mut largest) = (Vec::new(), 0);
            let mut take = |piece: &[u8]| {
                largest = largest.max(piece.len());
                found.extend_from_slice(piece);
            };
            read.records(start.into()..end.into(), &mut take).unwrap();
            assert!(found == records(start..end), "particles {start} to {end}");
            assert!(largest <= read::PIECE * RECORD_BYTES);
        }
    }
    // A file is believed only as a whole, however little of it is wanted.
    let file = read.path().join("particles-0003.bin");
    let mut bytes = fs::read(&file).unwrap();
    *bytes.last_mut().unwrap() ^= 1;
    fs::write(&file, bytes).unwrap();
    let mut taken = 0;
    let error = read.records(9005..9006, &mut |piece| taken += piece.len()).unwrap_err();
    assert!(text(&error).contains("its checksum is") && taken == 0, "{error}");
    read.records(0..9005, &mut |piece| taken += piece.len()).unwrap();
    assert_eq!(taken, 9005 * RECORD_BYTES);
}

/// Any alteration anywhere is refused with the file's name, and never a panic.
fn altered(whole: &BTreeMap<String, Vec<u8>>, name: &str, content: Option<&[u8]>) -> String {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join(folder_name(320));
    fs::create_dir(&path).unwrap();
    for (other, bytes) in whole {
        let bytes = if other == name { content } else { Some(bytes.as_slice()) };
        if let Some(bytes) = bytes {
            fs::write(path.join(other), bytes).unwrap();
        }
    }
    let error = refusal(&path);
    assert!(error.contains(name), "{error}");
    // The rank that did not check all must see it when it reads the file.
    let read_all = || -> Result<(), CheckpointError> {
        let read = Checkpoint::open_checked(&path)?;
        read.scene()?;
        read.plan()?;
        read.state::<State>()?;
        (0..read.particle_files()).try_for_each(|file| read.particles(file).map(drop))
    };
    assert!(read_all().is_err());
    error
}

/// A sound checkpoint's files.
fn whole() -> &'static BTreeMap<String, Vec<u8>> {
    static WHOLE: std::sync::OnceLock<BTreeMap<String, Vec<u8>>> = std::sync::OnceLock::new();
    WHOLE.get_or_init(|| {
        let dir = tempfile::tempdir().unwrap();
        let path = written(dir.path(), 320, &[40, 0, 25]);
        names(&path).into_iter().map(|name| (name.clone(), fs::read(path.join(&name)).unwrap())).collect()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn whatever_is_altered_is_refused(
        file in any::<prop::sample::Index>(),
        at in any::<prop::sample::Index>(),
        kind in 0..5,
        bit in 0..8u32,
        more in proptest::collection::vec(any::<u8>(), 1..40),
    ) {
        let whole = whole();
        let names: Vec<&String> = whole.keys().collect();
        let name = names[file.index(names.len())];
        let mut content = whole[name].clone();
        let at = at.index(content.len());
        match kind {
            0 => content[at] ^= 1 << bit,
            1 => content.truncate(at),
            2 => content.extend(&more),
            3 => drop(content.splice(at..at, more)),
            _ => {
                let end = (at + more.len()).min(content.len());
                content[at..end].copy_from_slice(&more[..end - at]);
            }
        }
        prop_assume!(content != whole[name]);
        altered(whole, name, Some(&content));
    }
}

/// Every single bit of the small files: none is without a guard.
#[test]
fn every_bit_of_the_manifest_counts() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), 320, &[3]).join(MANIFEST);
    let sound = fs::read(&path).unwrap();
    assert!(Manifest::from_bytes(&path, &sound).is_ok());
    for bit in 0..8 * sound.len() {
        let mut flipped = sound.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(Manifest::from_bytes(&path, &flipped).is_err(), "bit {bit}");
    }
    for length in 0..sound.len() {
        assert!(Manifest::from_bytes(&path, &sound[..length]).is_err(), "{length} bytes");
    }
}

/// The reason is told: which file, what was found, what was expected.
#[test]
fn each_fault_has_its_reason() {
    let whole = whole();
    let particles = "particles-0002.bin";
    let bytes = &whole[particles];
    let short = altered(whole, particles, Some(&bytes[..10]));
    assert!(short.contains("has 10 bytes") && short.contains(&format!("{} were written", bytes.len())), "{short}");
    assert!(altered(whole, particles, None).contains("is missing from the checkpoint"));
    let mut flipped = bytes.clone();
    flipped[9] ^= 64;
    assert!(altered(whole, particles, Some(&flipped)).contains("its checksum is"));
    assert!(altered(whole, MANIFEST, None).contains("is missing"));
    let manifest = String::from_utf8(whole[MANIFEST].clone()).unwrap();
    let foreign = altered(whole, MANIFEST, Some(b"[package]\nname = 1\n"));
    assert!(foreign.contains("no checkpoint's manifest") && foreign.contains("[package]"), "{foreign}");
    let [own, next] = [FORMAT, FORMAT + 1].map(|format| format!("format {format}"));
    let other = altered(whole, MANIFEST, Some(manifest.replace(&own, &next).as_bytes()));
    assert!(other.contains(&format!("checkpoint {next}, this program reads {own}")), "{other}");
    let edited = altered(whole, MANIFEST, Some(manifest.replace("step = 320", "step = 321").as_bytes()));
    assert!(edited.contains("truncated or altered"), "{edited}");
}

/// What sound checksums cannot tell: files of other particles than the manifest's, or of another state.
#[test]
fn particles_that_are_twice_or_beyond_there_are_refused() {
    let refused = |ids: Vec<u32>, moment: Moment| {
        let dir = tempfile::tempdir().unwrap();
        let writer = CheckpointWriter::new(dir.path(), moment.step);
        let files = vec![writer.particles(0, &records(ids.into_iter())).unwrap()];
        let path = commit(writer, files, &moment, &origin()).unwrap();
        refusal(&path)
    };
    let miscounted = |claimed: u64| {
        let dir = tempfile::tempdir().unwrap();
        let writer = CheckpointWriter::new(dir.path(), 1);
        let file = FileRecord { particles: claimed, ..writer.particles(0, &records(0..3)).unwrap() };
        refusal(&commit(writer, vec![file], &moment(1, claimed), &origin()).unwrap())
    };
    assert!(miscounted(2).contains("it holds more than 64 bytes"), "{}", miscounted(2));
    assert!(miscounted(4).contains("it has 96 bytes of particles, 128 were written"), "{}", miscounted(4));
    assert!(refused(vec![0, 1, 1], moment(1, 3)).contains("particle 1 is in the checkpoint twice"));
    assert!(refused(vec![0, 1, 3], moment(1, 3)).contains("particle 3, and only 3 had entered"));
    assert!(refused(vec![0, 1], Moment { ids: 1, ..moment(1, 2) }).contains("files hold 2 particles"));
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), 1, &[2]);
    let wrong = Checkpoint::open(&path).unwrap().state::<(u8, u8)>();
    assert!(text(&wrong.unwrap_err()).contains("state.bin"));
}

#[test]
fn particles_that_a_rank_did_not_write_are_missed() {
    let dir = tempfile::tempdir().unwrap();
    let writer = CheckpointWriter::new(dir.path(), 3);
    let files = vec![writer.particles(0, &records(0..5)).unwrap()];
    let error = commit(writer, files, &moment(3, 9), &origin()).unwrap_err();
    assert_eq!(error.to_string(), "5 particles were handed over for a checkpoint of 9");
    assert!(latest(dir.path()).is_err());
    assert!(CheckpointWriter::new(dir.path(), 3).particles(0, &[0; 33]).is_err());
}

/// The last two stay, and what a killed attempt has left is neither used nor kept.
#[test]
fn older_checkpoints_go_when_a_new_one_stands() {
    let dir = tempfile::tempdir().unwrap();
    written(dir.path(), 100, &[2]);
    written(dir.path(), 200, &[2]);
    let killed = CheckpointWriter::new(dir.path(), 300);
    for rank in 0..3 {
        killed.particles(rank, &records(0..2)).unwrap();
    }
    drop(killed);
    assert_eq!(latest(dir.path()).unwrap(), dir.path().join("step-0000000200"));
    assert_eq!(names(dir.path()), ["step-0000000100", "step-0000000200", "step-0000000300.partial"]);
    // The same step again, by fewer ranks: nothing of the attempt is in it.
    let path = written(dir.path(), 300, &[2]);
    assert_eq!(names(dir.path()), ["step-0000000200", "step-0000000300"]);
    assert_eq!(names(&path), [MANIFEST, "particles-0000.bin", PLAN, SCENE, STATE]);
    Checkpoint::open(&path).unwrap();
    CheckpointWriter::new(dir.path(), 350).particles(0, &[]).unwrap();
    fs::rename(dir.path().join("step-0000000200"), dir.path().join("step-0000000200.removed")).unwrap();
    written(dir.path(), 12_345_678_901, &[2]);
    assert_eq!(names(dir.path()), ["step-0000000300", "step-12345678901"]);
}

/// A second checkpoint at one step leaves a sound one; a broken one in its place is replaced.
#[test]
fn a_step_may_be_written_again() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), 100, &[2]);
    let first = fs::metadata(path.join(STATE)).unwrap().modified().unwrap();
    assert_eq!(written(dir.path(), 100, &[1, 1]), path);
    assert_eq!(fs::metadata(path.join(STATE)).unwrap().modified().unwrap(), first);
    fs::write(path.join(STATE), "broken").unwrap();
    assert!(Checkpoint::open(&path).is_err());
    written(dir.path(), 100, &[1, 1]);
    assert_eq!(Checkpoint::open(&path).unwrap().particle_files(), 2);
    assert_eq!(names(dir.path()), ["step-0000000100"]);
}

/// Never run on from an older one unasked: the newest is refused, and the message names the one before.
#[test]
fn a_broken_newest_checkpoint_is_not_passed_over() {
    let dir = tempfile::tempdir().unwrap();
    let old = written(&dir.path().join("checkpoints"), 100, &[2]);
    let new = written(&dir.path().join("checkpoints"), 200, &[2]);
    fs::remove_file(new.join(SCENE)).unwrap();
    let named = latest(dir.path()).unwrap();
    assert_eq!(named, new);
    let error = Checkpoint::open(&named).unwrap_err();
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    assert!(help.contains(&old.display().to_string()), "{help}");
    assert!(Checkpoint::open(&latest(&old).unwrap()).is_ok());
    let help = |path: &Path| miette::Diagnostic::help(&Checkpoint::open(path).unwrap_err()).unwrap().to_string();
    fs::remove_file(old.join(SCENE)).unwrap();
    assert!(help(&old).contains("no older one"));
}

#[test]
fn checkpoints_of_a_run_that_is_done_anew_go() {
    let dir = tempfile::tempdir().unwrap();
    written(dir.path(), 100, &[2]);
    written(dir.path(), 200, &[2]);
    forget_after(dir.path(), 200).unwrap();
    assert_eq!(names(dir.path()).len(), 2);
    forget_after(dir.path(), 100).unwrap();
    assert_eq!(names(dir.path()), ["step-0000000100"]);
}

#[test]
fn where_there_is_none_the_folder_is_named() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("step-0000000001.partial")).unwrap();
    fs::create_dir(dir.path().join("step-7")).unwrap();
    let error = latest(dir.path()).unwrap_err().to_string();
    assert!(error.contains("no complete checkpoint") && error.contains(&dir.path().display().to_string()), "{error}");
    let error = latest(&dir.path().join("none")).unwrap_err().to_string();
    assert!(error.ends_with("none does not exist"), "{error}");
}

/// A mesh is not in the checkpoint: it must be the one of the start, where it was or as the copy in the run's folder.
#[test]
fn a_changed_mesh_is_refused() {
    let dir = tempfile::tempdir().unwrap();
    let parent = dir.path().join("run/checkpoints");
    let mesh = dir.path().join("a.stl");
    fs::write(&mesh, "solid a").unwrap();
    let text = include_str!("../../../scenes/box.toml");
    let scene = |path: &Path| {
        let mut scene = crate::scene::parse(text, "box.toml", Path::new("")).unwrap();
        scene.walls[0].shape = crate::scene::Shape::Mesh { path: path.to_path_buf(), scale: 1.0, parts: vec![] };
        Origin::new(&scene, String::new(), Adapter::default())
    };
    let origin = scene(&mesh).unwrap();
    assert_eq!(origin.meshes.len(), 1);
    let writer = CheckpointWriter::new(&parent, 1);
    let files = vec![writer.particles(0, &[]).unwrap()];
    let path = commit(writer, files, &moment(1, 0), &origin).unwrap();
    assert_eq!(Checkpoint::open(&path).unwrap().meshes().unwrap(), std::slice::from_ref(&mesh));
    fs::write(&mesh, "solid b").unwrap();
    let error = refusal(&path);
    assert!(error.contains("a.stl has 7 bytes") && error.contains("the copy of it"), "{error}");
    fs::remove_file(&mesh).unwrap();
    assert!(refusal(&path).contains("a.stl cannot be read"));
    assert!(scene(&mesh).is_err());
    let copy = origin.meshes[0].copy_in(&dir.path().join("run"));
    fs::create_dir_all(copy.parent().unwrap()).unwrap();
    fs::write(&copy, "solid a").unwrap();
    let checkpoint = Checkpoint::open(&path).unwrap();
    let text = checkpoint.scene_here().unwrap();
    assert!(text.contains(copy.to_str().unwrap()) && !text.contains(mesh.to_str().unwrap()), "{text}");
    let mut here = crate::scene::parse(&text, "scene.toml", Path::new("")).unwrap();
    checkpoint.restore_names(&mut here);
    assert_eq!(crate::scene::to_toml(&here), checkpoint.scene().unwrap());
    fs::write(&copy, "solid c").unwrap();
    assert!(refusal(&path).contains("a.stl cannot be read"));
}

/// Another adapter or version may continue, and says so; another plan may not.
#[test]
fn other_machines_are_warned_of_and_other_plans_refused() {
    let dir = tempfile::tempdir().unwrap();
    let read = Checkpoint::open(&written(dir.path(), 1, &[2])).unwrap();
    assert_eq!(read.warnings(&origin().adapter), Vec::<String>::new());
    let warnings = read.warnings(&Adapter { driver: "driver 2".into(), ..origin().adapter });
    assert!(warnings.len() == 1 && warnings[0].contains("driver 1") && warnings[0].contains("driver 2"));
    read.check_plan("a = 1\nb = 2\n").unwrap();
    let error = read.check_plan("a = 1\nb = 3\n").unwrap_err().to_string();
    assert!(error.contains("\"b = 3\" where \"b = 2\" stood"), "{error}");
    assert!(read.check_plan("a = 1\nb = 2\nc = 3\n").is_err() && read.check_plan("a = 1\n").is_err());
    // The version is the manifest's: one of another program with the same format.
    let text = fs::read_to_string(read.path().join(MANIFEST)).unwrap();
    let own = format!("version = \"{}\"", env!("CARGO_PKG_VERSION"));
    let above = &text[..text.trim_end().rfind('\n').unwrap() + 1];
    let other = above.replace(&own, "version = \"9.9.9\"");
    assert_ne!(other, above);
    let other = format!("{other}# crc32 of the lines above: {:08x}\n", crc32fast::hash(other.as_bytes()));
    fs::write(read.path().join(MANIFEST), other).unwrap();
    let warnings = Checkpoint::open(read.path()).unwrap().warnings(&origin().adapter);
    assert!(warnings.len() == 1 && warnings[0].contains("9.9.9"), "{warnings:?}");
}

/// A manifest with sound checksums that claims what cannot be is refused before memory is taken for it.
#[test]
fn lengths_that_a_manifest_claims_take_no_memory() {
    let dir = tempfile::tempdir().unwrap();
    let path = written(dir.path(), 1, &[2]);
    let sound = Checkpoint::open(&path).unwrap().manifest().clone();
    let claim = |alter: &dyn Fn(&mut Manifest)| {
        let mut manifest = sound.clone();
        alter(&mut manifest);
        fs::write(path.join(MANIFEST), manifest.to_text().unwrap()).unwrap();
        refusal(&path)
    };
    let last = sound.file.len() - 1;
    let many = 1u64 << 50;
    let claimed = claim(&|manifest| {
        (manifest.file[last].particles, manifest.particles, manifest.ids) = (many, many, many);
    });
    assert!(claimed.contains("64 bytes of particles"), "{claimed}");
    assert!(claim(&|manifest| manifest.file[last].bytes = 1 << 60).contains("bytes where"));
    assert!(claim(&|manifest| manifest.file[last].particles = 1 << 62).contains("are said to be there"));
    assert!(
        claim(&|manifest| manifest.file[last].name = "../particles-0000.bin".into()).contains("none of a checkpoint")
    );
    assert!(claim(&|manifest| manifest.file.push(manifest.file[0].clone())).contains("twice"));
    assert!(claim(&|manifest| drop(manifest.file.remove(0))).contains("does not name scene.toml"));
}

#[test]
fn the_run_of_a_checkpoint_is_found_from_wherever_it_is_named() {
    let step = "step-0000000064";
    let inside = |folder: &str| Path::new(folder).join(step);
    assert_eq!(run_folder(Path::new("a/b"), &inside("a/b/checkpoints")), Path::new("a/b"));
    assert_eq!(run_folder(Path::new("."), &inside("./checkpoints")), Path::new("."));
    let whole = std::path::absolute("a/b").unwrap();
    for from in [Path::new("a/b/checkpoints"), &inside("a/b/checkpoints")] {
        assert_eq!(run_folder(from, &inside("a/b/checkpoints")), whole);
    }
    assert_eq!(
        run_folder(Path::new("checkpoints"), &inside("checkpoints")),
        std::path::absolute("").unwrap_or_else(|_| std::env::current_dir().unwrap())
    );
}
