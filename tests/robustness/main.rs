//! Malformed scenes: each is refused with a message that tells its author what to mend, and none panics.
//!
//! Every file of `bad/` is `sound.toml` with one fault (a few stand alone); its message is a snapshot
//! in `snapshots/`, which `cargo insta review` (or INSTA_UPDATE=always) renews.

use std::path::{Path, PathBuf};

use corpuscle::scene::{self, SceneError};
use proptest::prelude::*;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/robustness")
}

fn bad_files() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder().join("bad")).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// As on a terminal of 100 columns without colours.
fn rendered(error: &SceneError) -> String {
    let mut out = String::new();
    miette::GraphicalReportHandler::new_themed(miette::GraphicalTheme::unicode_nocolor())
        .with_width(100)
        .render_report(&mut out, error)
        .unwrap();
    // Lines that end in blanks do not survive editors.
    out.lines().map(|line| line.trim_end().to_string() + "\n").collect()
}

/// The file's text as if it lay in the current folder, so that messages hold no path of this machine.
fn refusal(path: &Path) -> Option<SceneError> {
    let text = std::fs::read_to_string(path).unwrap();
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    scene::parse(&text, &name, Path::new("")).err()
}

#[test]
fn every_bad_scene_is_refused_with_its_message() {
    let files = bad_files();
    assert!(files.len() >= 45, "{} files", files.len());
    for path in files {
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        let error = refusal(&path).unwrap_or_else(|| panic!("{stem} was accepted"));
        insta::assert_snapshot!(stem, rendered(&error));
    }
}

/// Every message has the file, the line and (of a text that is TOML) the field, what was found and what is allowed.
#[test]
fn every_message_says_where_what_and_what_instead() {
    for path in bad_files() {
        let Some(SceneError::Invalid(invalid)) = refusal(&path) else { panic!("{}", path.display()) };
        let message = invalid.to_string();
        let name = path.file_name().unwrap().to_string_lossy();
        assert!(message.starts_with(&format!("{name}, line ")), "{message}");
        let syntax = name.starts_with("syntax_") || message.contains("not TOML: ");
        for problem in invalid.problems() {
            assert!(syntax || problem.field().is_some(), "{message}");
            let text = problem.to_string();
            assert!(syntax || (text.contains("found ") && text.contains(", allowed: ")), "{text}");
        }
    }
}

/// The check can fail: without its fault the file is a scene.
#[test]
fn the_sound_scene_is_accepted() {
    let error = refusal(&folder().join("sound.toml"));
    assert!(error.is_none(), "{}", rendered(&error.unwrap()));
}

#[test]
fn files_that_cannot_be_read_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let load = |name: &str, bytes: Option<&[u8]>| {
        let path = folder.path().join(name);
        if let Some(bytes) = bytes {
            std::fs::write(&path, bytes).unwrap();
        }
        let error = scene::load(&path).unwrap_err();
        (rendered(&error), error)
    };
    let (text, error) = load("missing.toml", None);
    assert!(matches!(error, SceneError::Unreadable { .. }) && text.contains("missing.toml"), "{text}");
    let (text, error) = load("latin.toml", Some(b"title = 'ok'\n# caf\xe9\n"));
    assert!(matches!(error, SceneError::NotText { line: 2, offset: 18, byte: 0xe9, .. }), "{text}");
    let (text, error) = load("binary.toml", Some(&[0, 159, 146, 150]));
    assert!(matches!(error, SceneError::NotText { .. }), "{text}");
    let (text, error) = load("huge.toml", Some(&vec![b'#'; (16 << 20) + 1]));
    assert!(matches!(error, SceneError::TooLarge { .. }), "{text}");
    let (text, error) = load("large_but_read.toml", Some(&vec![b'#'; 16 << 20]));
    assert!(matches!(error, SceneError::Invalid(_)), "{}", text.len());
    let (text, error) = load("empty.toml", Some(b""));
    assert!(matches!(error, SceneError::Invalid(_)), "{text}");
    #[cfg(unix)]
    {
        let link = folder.path().join("link.toml");
        std::os::unix::fs::symlink("moved/away.toml", &link).unwrap();
        let error = scene::load(&link).unwrap_err();
        assert!(matches!(error, SceneError::Dangling { .. }), "{}", rendered(&error));
        assert!(rendered(&error).contains("moved/away.toml, which does not exist"), "{}", rendered(&error));
    }
    let error = scene::load(folder.path()).unwrap_err();
    assert!(matches!(error, SceneError::Unreadable { .. }), "{}", rendered(&error));
}

/// Depth must not cost stack: not that of arrays, tables, dotted keys or headers.
#[test]
fn deeply_nested_texts_are_refused() {
    const DEPTH: usize = 100_000;
    for text in [
        format!("x = {}", "[".repeat(DEPTH)),
        format!("x = {}1{}", "[".repeat(DEPTH), "]".repeat(DEPTH)),
        format!("x = {}", "{ x = ".repeat(DEPTH)),
        format!("{}x = 1", "x.".repeat(DEPTH)),
        format!("[{}x]", "x.".repeat(DEPTH)),
        format!("[[gas]]\n[gas{}]", ".x".repeat(DEPTH)),
        format!("[[chamber]]\nregion{} = 1", ".box".repeat(DEPTH)),
    ] {
        let error = scene::parse(&text, "deep.toml", Path::new("")).unwrap_err();
        assert!(!error.to_string().is_empty());
    }
}

fn tank() -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/tank.toml")).unwrap()
}

/// Reads, and shows what is wrong: neither may panic.
fn survives(text: &str) {
    match scene::parse(text, "mutated.toml", Path::new("")) {
        Ok(scene) => assert!(scene::parse(&scene::to_toml(&scene), "again.toml", Path::new("")).is_ok()),
        Err(error) => assert!(!rendered(&error).is_empty()),
    }
}

/// What a hasty editor might leave behind.
const FRAGMENTS: [&str; 24] = [
    "nan",
    "-inf",
    "1e308",
    "-1",
    "0",
    "0x10",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'''",
    "=",
    "\n",
    "[[wall]]\n",
    "[model]\n",
    "true",
    "1979-05-27",
    "\u{e9}",
    "\u{feff}",
    "\r",
    "\0",
    "box",
    "99999999999999999999",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn mutated_scenes_never_panic(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0usize..12, prop::sample::select(&FRAGMENTS[..])), 1..5)
    ) {
        let mut text: Vec<char> = tank().chars().collect();
        for (place, removed, inserted) in edits {
            let start = place.index(text.len());
            let end = (start + removed).min(text.len());
            text.splice(start..end, inserted.chars());
        }
        survives(&text.into_iter().collect::<String>());
    }

    #[test]
    fn truncated_scenes_never_panic(place in any::<prop::sample::Index>()) {
        let text = tank();
        survives(&text[..text.floor_char_boundary(place.index(text.len()))]);
    }

    #[test]
    fn scenes_with_swapped_values_never_panic(from in any::<prop::sample::Index>(), to in any::<prop::sample::Index>()) {
        // Whole values change places, so that the text mostly stays TOML and reaches the validation.
        let text = tank();
        let lines: Vec<&str> = text.lines().collect();
        let keyed: Vec<usize> = (0..lines.len()).filter(|&i| lines[i].contains(" = ") && !lines[i].starts_with('#')).collect();
        let (from, to) = (keyed[from.index(keyed.len())], keyed[to.index(keyed.len())]);
        let key = lines[to].split(" = ").next().unwrap();
        let value = lines[from].split_once(" = ").unwrap().1;
        let swapped = format!("{key} = {value}");
        let mutated: Vec<&str> = lines.iter().enumerate().map(|(i, line)| if i == to { &swapped } else { *line }).collect();
        survives(&mutated.join("\n"));
    }
}
