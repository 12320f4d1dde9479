//! Law: the documents are short enough to be read.
//!
//! `cargo test --release --locked --test docs measures -- --nocapture` prints all of it. A word is what stands between two
//! spaces and has a letter or a digit, in tables and code, too. A paragraph is prose between two empty lines, an item of a
//! list one of its own; tables, headings and code are none.

use std::fs;
use std::path::Path;

use super::{documents, root};

/// Of the README and of all pages of the book but those for developers.
const USER_WORDS: usize = 29_300;
const PERFORMANCE_WORDS: usize = 2_000;
const PERFORMANCE_LINES: usize = 150;
const ARCHITECTURE_BYTES: usize = 12_000;
const PARAGRAPH_WORDS: usize = 120;
const LINE_CHARACTERS: usize = 300;

fn words(text: &str) -> usize {
    text.split_whitespace().filter(|word| word.chars().any(char::is_alphanumeric)).count()
}

/// The lines that are prose, empty ones where something else is: number from 1, and text.
fn prose(text: &str) -> Vec<(usize, &str)> {
    let mut in_block = false;
    let lines = text.lines().enumerate().map(|(k, line)| {
        let fence = line.trim_start().starts_with("```");
        in_block ^= fence;
        let other = fence || in_block || line.trim_start().starts_with(['|', '#']);
        (k + 1, if other { "" } else { line })
    });
    lines.collect()
}

fn is_item(line: &str) -> bool {
    let line = line.trim_start();
    let digits = line.trim_start_matches(|c: char| c.is_ascii_digit());
    line.starts_with("- ") || line.starts_with("* ") || (digits.len() < line.len() && digits.starts_with(". "))
}

/// The paragraphs: their first line, and their words.
fn paragraphs(text: &str) -> Vec<(usize, usize)> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    let mut open = false;
    for (number, line) in prose(text) {
        if line.trim().is_empty() {
            open = false;
        } else if open && !is_item(line) {
            found.last_mut().unwrap().1 += words(line);
        } else {
            found.push((number, words(line)));
            open = true;
        }
    }
    found
}

/// What is too long in a document, with its place.
fn too_long(name: &str, text: &str) -> Vec<String> {
    let blocks = paragraphs(text).into_iter().filter(|&(_, words)| words > PARAGRAPH_WORDS);
    let mut long: Vec<String> =
        blocks.map(|(line, words)| format!("{name}:{line}: a paragraph of {words} words")).collect();
    let lines = prose(text).into_iter().map(|(line, text)| (line, text.chars().count()));
    let lines = lines.filter(|&(_, characters)| characters > LINE_CHARACTERS);
    long.extend(lines.map(|(line, characters)| format!("{name}:{line}: a line of {characters} characters")));
    long
}

fn read(path: &Path) -> (String, String) {
    let name = path.strip_prefix(root()).unwrap().display().to_string();
    (name, fs::read_to_string(path).unwrap())
}

fn is_for_users(name: &str) -> bool {
    name == "README.md" || (name.starts_with("docs/") && !name.starts_with("docs/dev/"))
}

#[test]
fn measures_of_the_documents() {
    let all: Vec<(String, String)> = documents().iter().map(|path| read(path)).collect();
    let text_of = |wanted: &str| &all.iter().find(|(name, _)| name == wanted).unwrap().1;
    let performance = text_of("docs/reference/performance.md");
    let (performance_words, performance_lines) = (words(performance), performance.lines().count());
    let architecture = text_of("ARCHITECTURE.md").len();
    let mut total = 0;
    for (name, text) in all.iter().filter(|(name, _)| is_for_users(name)) {
        println!("{:6} words  {name}", words(text));
        total += words(text);
    }
    let long: Vec<String> = all.iter().flat_map(|(name, text)| too_long(name, text)).collect();
    println!("{total:6} words of user documents, at most {USER_WORDS}");
    println!("{performance_words:6} words of performance.md, at most {PERFORMANCE_WORDS}");
    println!("{architecture:6} bytes of ARCHITECTURE.md, at most {ARCHITECTURE_BYTES}");
    println!(
        "{:6} paragraphs over {PARAGRAPH_WORDS} words or lines of prose over {LINE_CHARACTERS} characters",
        long.len()
    );
    assert!(total <= USER_WORDS, "{total}");
    assert!(performance_words <= PERFORMANCE_WORDS && performance_lines <= PERFORMANCE_LINES);
    assert!(architecture <= ARCHITECTURE_BYTES, "{architecture}");
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn what_is_too_long_is_found() {
    let (block, line) = ("word ".repeat(41), "w".repeat(301));
    let three = format!("{block}\n{block}\n{block}\n");
    let text =
        format!("# Head\n\n{three}\n- {block}\n- {block}\n- {block}\n\n{line}\n\n| {line} |\n\n```\n{line}\n```\n");
    let expected = ["page:3: a paragraph of 123 words", "page:11: a line of 301 characters"];
    assert_eq!(too_long("page", &text), expected);
    assert_eq!(words("a | 1.5 -- b-c"), 3);
}
