//! Law: the documents name only what is there, and name all of it.
//!
//! Relative links and their anchors lead somewhere; every path of the repository in a code span or a code
//! block exists; every whole scene in them can be read; every verb of the README is one of the program; `ARCHITECTURE.md`
//! names every folder of `src`, the page of kernels every shader; the summary of the book lists every page, and the page of
//! the command line is that of today; no figure is left open or not shown. `tests/docs/measures.rs` holds how long they are.

mod measures;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Folders whose names make a word of code a path of the repository.
const FOLDERS: &[&str] = &["src", "shaders", "tests", "benches", "docs", "scenes", "scripts", ".ci"];
/// Endings that make a word without a folder the name of a file of the repository.
const ENDINGS: &[&str] = &["rs", "wgsl", "sh", "md"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn documents() -> Vec<PathBuf> {
    let mut found: Vec<PathBuf> =
        ["README.md", "ARCHITECTURE.md", "CHANGELOG.md"].iter().map(|name| root().join(name)).collect();
    found.extend(files(&root().join("docs")).into_iter().filter(|path| path.extension().is_some_and(|e| e == "md")));
    found
}

/// All files below a folder, sorted.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() { found.extend(files(&path)) } else { found.push(path) }
    }
    found.sort();
    found
}

/// A document's prose without code, and its code: spans and blocks.
fn parts(text: &str) -> (String, String) {
    let (mut prose, mut code) = (String::new(), String::new());
    let mut in_block = false;
    for line in text.lines() {
        if line.trim_start().starts_with("```") {
            in_block = !in_block;
        } else if in_block {
            code += line;
            code.push('\n');
        } else {
            prose += line;
            prose.push('\n');
        }
    }
    let mut plain = String::new();
    for (k, piece) in prose.split('`').enumerate() {
        let into = if k % 2 == 1 { &mut code } else { &mut plain };
        *into += piece;
        into.push(' ');
    }
    (plain, code)
}

/// The targets of `[text](target)` within the repository.
fn links(prose: &str) -> Vec<&str> {
    let targets = prose.split("](").skip(1).filter_map(|rest| rest.split(')').next());
    targets.filter(|target| !target.contains("://")).collect()
}

/// The anchors of a document's headings, as GitHub makes them.
fn anchors(text: &str) -> Vec<String> {
    let headings = text.lines().filter_map(|line| line.strip_prefix('#')).map(|line| line.trim_start_matches('#'));
    headings
        .map(|heading| {
            let kept = heading.trim().to_lowercase();
            let kept = kept.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
            kept.map(|c| if c == ' ' { '-' } else { c }).collect()
        })
        .collect()
}

/// The words of code that are paths or names of files of the repository.
fn paths(code: &str) -> Vec<&str> {
    let words = code.split_whitespace().map(|word| {
        let word = word.trim_matches(|c| ",;()[]\"'".contains(c));
        let word = word.split(':').next().unwrap_or(word).trim_end_matches('.');
        word.strip_prefix("./").unwrap_or(word).trim_end_matches('/')
    });
    let is_name = |c: char| c.is_ascii_alphanumeric() || "_./*-".contains(c);
    words
        .filter(|word| !word.is_empty() && word.chars().all(is_name))
        .filter(|word| match word.split_once('/') {
            Some((first, _)) => FOLDERS.contains(&first),
            None => word.rsplit_once('.').is_some_and(|(stem, end)| !stem.is_empty() && ENDINGS.contains(&end)),
        })
        .collect()
}

fn is_there(path: &str, known: &[PathBuf]) -> bool {
    if let Some((folder, pattern)) = path.rsplit_once('/').filter(|(_, last)| last.contains('*')) {
        let (start, end) = pattern.split_once('*').unwrap_or((pattern, ""));
        let names = known.iter().filter(|file| file.parent() == Some(&root().join(folder)));
        let mut names = names.filter_map(|file| file.file_name()?.to_str());
        return names.any(|name| name.starts_with(start) && name.ends_with(end));
    }
    root().join(path).exists() || (!path.contains('/') && known.iter().any(|file| file.ends_with(path)))
}

/// What a document in `folder` names that is not there.
fn missing(text: &str, folder: &Path) -> Vec<String> {
    let (prose, code) = parts(text);
    let known: Vec<PathBuf> = FOLDERS.iter().flat_map(|name| files(&root().join(name))).collect();
    let mut missing: Vec<String> =
        paths(&code).into_iter().filter(|path| !is_there(path, &known)).map(str::to_owned).collect();
    for target in links(&prose) {
        let (path, anchor) = target.split_once('#').unwrap_or((target, ""));
        let there = match fs::read_to_string(folder.join(path)) {
            _ if path.is_empty() => anchors(text).iter().any(|known| known == anchor),
            Ok(other) => anchor.is_empty() || anchors(&other).iter().any(|known| known == anchor),
            Err(_) => anchor.is_empty() && folder.join(path).exists(),
        };
        if !there {
            missing.push(target.to_owned());
        }
    }
    missing
}

#[test]
fn documents_name_only_what_is_there() {
    let mut all = Vec::new();
    for path in documents() {
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let name = path.strip_prefix(root()).unwrap().display().to_string();
        all.extend(missing(&text, path.parent().unwrap()).into_iter().map(|what| format!("{name}: {what}")));
    }
    assert!(all.is_empty(), "not there:\n{}", all.join("\n"));
}

#[test]
fn what_is_not_there_is_found() {
    let text = "# A Heading: one\n\
        [good](README.md) [good](docs/reference/scenes.md#units) [good](#a-heading-one) [web](https://example.org/none)\n\
        [bad](docs/none.md) [bad](docs/reference/scenes.md#none) [bad](#none) ![bad](docs/figures/none.svg)\n\
        `src/lib.rs`, `./scripts/run.sh scenes/tank.toml --particles 20000`, `shaders/*.wgsl`, `settle.wgsl`,\n\
        `results/tank/none.csv`, `a / b`, `src/none/`, `none.wgsl`, `shaders/none*.wgsl`\n\
        ```sh\ncorpuscle check scenes/none.toml\n```\n";
    let expected = [
        "scenes/none.toml",
        "src/none",
        "none.wgsl",
        "shaders/none*.wgsl",
        "docs/none.md",
        "docs/reference/scenes.md#none",
        "#none",
        "docs/figures/none.svg",
    ];
    assert_eq!(missing(text, root()), expected);
}

/// The folders of `src` that a map does not name.
fn unnamed_folders(map: &str) -> Vec<String> {
    let (_, code) = parts(map);
    let named = paths(&code);
    let entries = fs::read_dir(root().join("src")).unwrap().flatten().filter(|entry| entry.path().is_dir());
    let folders = entries.map(|entry| format!("src/{}", entry.file_name().to_string_lossy()));
    let mut unnamed: Vec<String> = folders.filter(|folder| !named.contains(&folder.as_str())).collect();
    unnamed.sort();
    unnamed
}

/// The shaders that a page does not name.
fn unnamed_shaders(page: &str) -> Vec<String> {
    let (_, code) = parts(page);
    let named = paths(&code);
    let shaders = files(&root().join("shaders")).into_iter();
    let names = shaders.map(|path| path.file_name().unwrap().to_string_lossy().into_owned());
    names.filter(|name| !named.iter().any(|word| word.rsplit('/').next() == Some(name))).collect()
}

#[test]
fn the_architecture_names_every_folder_and_the_page_of_kernels_every_shader() {
    let map = fs::read_to_string(root().join("ARCHITECTURE.md")).unwrap();
    assert_eq!(unnamed_folders(&map), Vec::<String>::new());
    assert_eq!(unnamed_folders(&map.replace("src/gas/", "gas")), ["src/gas"]);
    let page = fs::read_to_string(root().join("docs/dev/kernels.md")).unwrap();
    assert_eq!(unnamed_shaders(&page), Vec::<String>::new());
    assert_eq!(unnamed_shaders(&page.replace("settle.wgsl", "settle")), ["settle.wgsl"]);
}

/// The pages of the book that its summary does not list, once each.
fn unlisted(summary: &str) -> Vec<String> {
    let book = root().join("docs");
    let pages = files(&book).into_iter().filter(|path| path.extension().is_some_and(|end| end == "md"));
    let names = pages.map(|path| path.strip_prefix(&book).unwrap().display().to_string());
    let names = names.filter(|name| name != "SUMMARY.md");
    names.filter(|name| summary.matches(&format!("]({name})")).count() != 1).collect()
}

/// The figures of the book that no document shows.
fn unshown(documents: &[String]) -> Vec<String> {
    let figures =
        files(&root().join("docs")).into_iter().filter(|path| path.extension().is_some_and(|end| end == "svg"));
    let names = figures.map(|path| path.file_name().unwrap().to_string_lossy().into_owned());
    names.filter(|name| !documents.iter().any(|text| text.contains(&format!("/{name})")))).collect()
}

#[test]
fn every_figure_is_shown() {
    let mut texts: Vec<String> = documents().iter().map(|path| fs::read_to_string(path).unwrap()).collect();
    assert_eq!(unshown(&texts), Vec::<String>::new());
    for text in &mut texts {
        *text = text.replace("step.svg", "");
    }
    assert_eq!(unshown(&texts), ["step.svg"]);
}

/// Stands for `mdbook build`, which wants just this beside links that lead somewhere.
#[test]
fn the_summary_lists_every_page() {
    let summary = fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    assert_eq!(unlisted(&summary), Vec::<String>::new());
    assert_eq!(unlisted(&summary.replace("(reference/scenes.md)", "()")), ["reference/scenes.md"]);
    let settings: toml::Table = fs::read_to_string(root().join("book.toml")).unwrap().parse().unwrap();
    assert_eq!(settings["book"]["src"].as_str(), Some("docs"));
}

/// The page is what `corpuscle man --markdown` prints: that command writes it anew.
#[test]
fn the_page_of_the_command_line_is_that_of_today() {
    let output = Command::new(env!("CARGO_BIN_EXE_corpuscle")).args(["man", "--markdown"]).output().unwrap();
    let printed = String::from_utf8(output.stdout).unwrap();
    assert!(printed.contains("## run") && printed.contains("`--particles <N>`"), "{printed}");
    let page = fs::read_to_string(root().join("docs/reference/command-line.md")).unwrap();
    assert!(page == printed, "docs/reference/command-line.md is not what `corpuscle man --markdown` prints");
}

/// The words that follow the program's name in code.
fn verbs(code: &str) -> Vec<&str> {
    let words: Vec<&str> = code.split_whitespace().collect();
    let after = words.windows(2).filter(|pair| pair[0] == "corpuscle").map(|pair| pair[1]);
    let mut verbs: Vec<&str> = after.filter(|word| word.chars().all(|c| c.is_ascii_lowercase())).collect();
    verbs.sort_unstable();
    verbs.dedup();
    verbs
}

/// Whether the program has help for a verb.
fn has_verb(verb: &str) -> bool {
    let output = Command::new(env!("CARGO_BIN_EXE_corpuscle")).args([verb, "--help"]).output().unwrap();
    output.status.success() && String::from_utf8_lossy(&output.stdout).contains("Usage")
}

#[test]
fn the_verbs_of_the_readme_are_those_of_the_program() {
    let text = fs::read_to_string(root().join("README.md")).unwrap();
    let (_, code) = parts(&text);
    let found = verbs(&code);
    assert!(found.contains(&"run") && found.contains(&"plan"), "{found:?}");
    let unknown: Vec<&str> = found.into_iter().filter(|verb| !has_verb(verb)).collect();
    assert!(unknown.is_empty(), "no such verbs: {unknown:?}");
    assert!(!has_verb("frobnicate"));
}

/// A figure that still waits for its command is marked with two braces.
#[test]
fn no_figure_is_left_open() {
    for path in documents() {
        let text = fs::read_to_string(&path).unwrap();
        let open: Vec<&str> = text.lines().filter(|line| line.contains("{{")).collect();
        assert!(open.is_empty(), "{}:\n{}", path.display(), open.join("\n"));
    }
}

/// The TOML blocks of a document that are whole scenes.
fn scenes(text: &str) -> Vec<&str> {
    let blocks = text.split("```toml\n").skip(1).filter_map(|rest| rest.split("```").next());
    blocks.filter(|block| block.contains("end_time")).collect()
}

#[test]
fn every_scene_in_the_documents_can_be_read() {
    let mut seen = 0;
    for path in documents() {
        let text = fs::read_to_string(&path).unwrap();
        for scene in scenes(&text) {
            let read = corpuscle::scene::parse(scene, &path.display().to_string(), root());
            assert!(read.is_ok(), "{}: {}\n{scene}", path.display(), read.unwrap_err());
            let misspelt = scene.replace("molar_mass", "molar_mas");
            assert!(corpuscle::scene::parse(&misspelt, "misspelt", root()).is_err());
            seen += 1;
        }
    }
    assert!(seen >= 2, "{seen}");
}
