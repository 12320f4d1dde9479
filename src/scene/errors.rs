//! What is wrong with a scene file, said so that its author can mend it: where (file, line, dotted
//! field), what was found, what is allowed, and what was probably meant.

use std::ops::Range;
use std::path::{Path, PathBuf};

use miette::{Diagnostic, NamedSource, SourceSpan};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Problems reported from one file; more would bury the first.
const MOST_REPORTED: usize = 20;

/// Files of a folder among which one that was meant is looked for.
const MOST_FILES: usize = 4096;

/// Longest text quoted from a file in a message, in characters.
const LONGEST_QUOTE: usize = 60;

/// Why a scene was refused.
#[derive(Debug, thiserror::Error, Diagnostic)]
pub enum SceneError {
    #[error("the scene file {} is a link to {}, which does not exist", path.display(), target.display())]
    #[diagnostic(help("mend the link, or give the path of the file itself"))]
    Dangling { path: PathBuf, target: PathBuf },
    #[error("cannot read the scene file {}: {reason}", path.display())]
    #[diagnostic(help("give the path of a readable TOML file, for example scenes/tank.toml"))]
    Unreadable { path: PathBuf, reason: std::io::Error },
    #[error("the scene file {} holds more than {limit} bytes", path.display())]
    #[diagnostic(help("a scene is a TOML text; large geometry belongs into a mesh file that a wall names by `file`"))]
    TooLarge { path: PathBuf, limit: u64 },
    #[error("the scene file {}, line {line}: found byte 0x{byte:02x} at offset {offset}, allowed: UTF-8 text", path.display())]
    #[diagnostic(help("save the file as UTF-8 (a TOML file is UTF-8 by definition)"))]
    NotText { path: PathBuf, line: usize, offset: usize, byte: u8 },
    #[error(transparent)]
    #[diagnostic(transparent)]
    Invalid(Box<InvalidScene>),
}

/// A file that could be read but does not describe a scene: the first problem, and the others as related.
#[derive(Debug, thiserror::Error, Diagnostic)]
#[error("{name}, line {line}: {first}")]
pub struct InvalidScene {
    name: String,
    /// Of the first problem, from 1.
    line: usize,
    first: Problem,
    #[source_code]
    text: NamedSource<String>,
    #[label("{label}")]
    span: SourceSpan,
    label: Box<str>,
    #[label("first one")]
    earlier: Option<SourceSpan>,
    #[help]
    hint: Option<Box<str>>,
    #[related]
    others: Vec<Problem>,
}

impl InvalidScene {
    /// All problems in the order in which they were found (at most 20).
    pub fn problems(&self) -> impl Iterator<Item = &Problem> {
        std::iter::once(&self.first).chain(&self.others)
    }
}

/// One thing that is wrong in the text.
#[derive(Debug, Clone, thiserror::Error, Diagnostic)]
#[error("{}{text}", field.as_ref().map(|f| format!("`{f}`: ")).unwrap_or_default())]
pub struct Problem {
    /// Dotted path such as `orifice[0].mass_flow`; `None` of a text that is not TOML. Until the report is
    /// made only what the path ends with below the span: the key that is missing there.
    field: Option<Box<str>>,
    text: Box<str>,
    #[label("{label}")]
    span: SourceSpan,
    label: Box<str>,
    #[label("first one")]
    earlier: Option<SourceSpan>,
    #[help]
    hint: Option<Box<str>>,
    /// It may well follow from another, and is told only where there is none.
    follows: bool,
}

impl Problem {
    /// The value at `span` is `found`, which is not `allowed`.
    pub(super) fn value(span: &Range<usize>, found: impl Into<String>, allowed: impl AsRef<str>) -> Problem {
        let found = found.into();
        Problem {
            field: None,
            text: format!("found {found}, allowed: {}", allowed.as_ref()).into(),
            span: span.clone().into(),
            label: found.into(),
            earlier: None,
            hint: None,
            follows: false,
        }
    }

    /// The table at `span` lacks `key`.
    pub(super) fn missing(span: &Range<usize>, key: &str, allowed: impl AsRef<str>) -> Problem {
        let mut problem = Problem::value(span, format!("no `{key}`"), allowed);
        problem.field = Some(key.into());
        problem
    }

    /// The text is not TOML.
    pub(super) fn syntax(span: &Range<usize>, message: &str) -> Problem {
        let mut problem = Problem::value(span, "", "");
        problem.text = format!("not TOML: {message}").into();
        problem.label = "cannot be read".into();
        problem
    }

    pub(super) fn hint(mut self, hint: &str) -> Problem {
        self.hint = Some(hint.into());
        self
    }

    /// "did you mean" the candidate nearest to `found`, if one is near.
    pub(super) fn meant<'a>(mut self, found: &str, candidates: impl IntoIterator<Item = &'a str>) -> Problem {
        if let Some(best) = nearest(found, candidates) {
            self.hint = Some(format!("did you mean `{best}`?").into());
        }
        self
    }

    /// One that probably follows from another problem.
    pub(super) fn following(mut self) -> Problem {
        self.follows = true;
        self
    }

    /// The place of the first one of two that clash.
    pub(super) fn clash(mut self, earlier: &Range<usize>) -> Problem {
        self.earlier = Some(earlier.clone().into());
        self
    }

    /// Byte range in the file.
    pub fn span(&self) -> Range<usize> {
        self.span.offset()..self.span.offset() + self.span.len()
    }

    /// Dotted path such as `orifice[0].mass_flow`; `None` of a text that is not TOML.
    pub fn field(&self) -> Option<&str> {
        self.field.as_deref()
    }
}

impl SceneError {
    /// The report on `text` (called `name`) with these problems, in the order of their places in the file.
    pub(super) fn invalid(name: &str, text: &str, mut problems: Vec<Problem>) -> SceneError {
        if problems.iter().any(|problem| !problem.follows) {
            problems.retain(|problem| !problem.follows);
        }
        problems.sort_by_key(|p| p.span.offset());
        problems.truncate(MOST_REPORTED);
        let document = DeTable::parse(text).ok();
        for problem in &mut problems {
            let mut path = document.as_ref().map(|d| field_at(d.get_ref(), &problem.span())).unwrap_or_default();
            if let Some(key) = &problem.field {
                push_key(&mut path, key);
            }
            problem.field = (!path.is_empty()).then(|| path.into());
            problem.clamp(text);
        }
        let mut problems = problems.into_iter();
        let first = problems.next().unwrap_or_else(|| Problem::syntax(&(0..0), "unknown problem"));
        SceneError::Invalid(Box::new(InvalidScene {
            name: name.to_string(),
            line: 1 + text.as_bytes()[..first.span.offset()].iter().filter(|&&b| b == b'\n').count(),
            text: NamedSource::new(name, text.to_string()),
            span: first.span,
            label: first.label.clone(),
            earlier: first.earlier,
            hint: first.hint.clone(),
            first,
            others: problems.collect(),
        }))
    }
}

impl Problem {
    /// Keeps the span inside the text and on character borders, which the renderer relies on.
    fn clamp(&mut self, text: &str) {
        let border = |mut at: usize| {
            at = at.min(text.len());
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            at
        };
        let span = self.span();
        let (start, end) = (border(span.start), border(span.end));
        self.span = (start..end.max(start)).into();
    }
}

/// The dotted path of the innermost key or value of the document whose span holds all of `span`.
fn field_at(document: &DeTable<'_>, span: &Range<usize>) -> String {
    let mut best = (usize::MAX, String::new());
    if span.start < span.end {
        search_table(document, span, &mut String::new(), &mut best);
    }
    best.1
}

/// A child is looked into even where its parent does not hold the span: the span of `[[wall]]` is its header.
fn search_table(table: &DeTable<'_>, span: &Range<usize>, path: &mut String, best: &mut (usize, String)) {
    for (key, value) in table.iter() {
        let length = path.len();
        push_key(path, key.get_ref());
        offer(&key.span(), span, path, best);
        search_value(value, span, path, best);
        path.truncate(length);
    }
}

fn search_value(value: &Spanned<DeValue<'_>>, span: &Range<usize>, path: &mut String, best: &mut (usize, String)) {
    offer(&value.span(), span, path, best);
    match value.get_ref() {
        DeValue::Table(table) => search_table(table, span, path, best),
        DeValue::Array(array) => {
            for (index, element) in array.iter().enumerate() {
                let length = path.len();
                path.push_str(&format!("[{index}]"));
                search_value(element, span, path, best);
                path.truncate(length);
            }
        }
        _ => {}
    }
}

fn offer(outer: &Range<usize>, inner: &Range<usize>, path: &str, best: &mut (usize, String)) {
    let holds = outer.start <= inner.start && inner.end <= outer.end;
    // Of equal spans the deeper one, which comes later.
    if holds && outer.len() <= best.0 {
        *best = (outer.len(), path.to_string());
    }
}

fn push_key(path: &mut String, key: &str) {
    if !path.is_empty() {
        path.push('.');
    }
    let bare = !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-');
    path.push_str(&if bare { key.to_string() } else { quote(key) });
}

/// The candidate that `found` most likely is a misspelling of.
fn nearest<'a>(found: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // The distance costs time and memory of length times length.
    if found.len() > LONGEST_QUOTE {
        return None;
    }
    let fold = |s: &str| s.to_lowercase().replace(['_', '-', ' '], "");
    let (folded, tolerance) = (fold(found), (found.chars().count() / 3).max(1));
    // Of those that are as near the one that is nearer letter by letter: `+z` for `z+`.
    candidates
        .into_iter()
        .filter(|candidate| candidate.len() <= LONGEST_QUOTE)
        .map(|candidate| (strsim::damerau_levenshtein(&folded, &fold(candidate)), candidate))
        .filter(|(distance, _)| *distance <= tolerance)
        .min_by_key(|(distance, candidate)| (*distance, strsim::damerau_levenshtein(found, candidate)))
        .map(|(_, candidate)| candidate)
}

/// The mesh file in the folder of `path` whose name is most like that of `path`. A name of two letters is like none but itself.
pub(super) fn near_mesh(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let stem = |name: &str| name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_lowercase();
    let wanted = stem(path.file_name()?.to_str()?);
    let entries = std::fs::read_dir(folder).ok()?.take(MOST_FILES).flatten();
    let is_mesh = |name: &String| {
        let name = name.to_lowercase();
        name.ends_with(".stl") || name.ends_with(".obj")
    };
    let mut names: Vec<String> = entries.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.retain(is_mesh);
    // Folders list in any order.
    names.sort();
    let stems: Vec<String> = names.iter().map(|name| stem(name)).collect();
    let known: Vec<&str> = stems.iter().map(String::as_str).collect();
    let near = match known.iter().find(|known| **known == wanted) {
        Some(same) => same,
        None if wanted.chars().count() > 2 => nearest(&wanted, known.iter().copied())?,
        None => return None,
    };
    let place = stems.iter().position(|stem| stem == near)?;
    Some(names[place].clone())
}

/// In quotes, control characters escaped, shortened.
pub(super) fn quote(text: &str) -> String {
    let mut shown: String = text.chars().take(LONGEST_QUOTE).collect();
    if shown.len() < text.len() {
        shown.push_str("...");
    }
    format!("{shown:?}")
}

/// "`a`, `b`, `c`".
pub(super) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    const MOST_LISTED: usize = 24;
    let names: Vec<String> = names.into_iter().map(|name| format!("`{name}`")).collect();
    let shown = names[..names.len().min(MOST_LISTED)].join(", ");
    if names.len() > MOST_LISTED { format!("{shown}, and {} more", names.len() - MOST_LISTED) } else { shown }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_word_is_traced_to_the_nearest_candidate_and_a_strange_one_to_none() {
        let keys = ["molar_mass", "mass_flow", "cp", "cv"];
        assert_eq!(nearest("molarmass", keys), Some("molar_mass"));
        assert_eq!(nearest("massflow", keys), Some("mass_flow"));
        assert_eq!(nearest("pc", keys), Some("cp"));
        assert_eq!(nearest("z+", ["-x", "+x", "-z", "+z"]), Some("+z"));
        assert_eq!(nearest("viscosity", keys), None);
        assert_eq!(nearest(&"x".repeat(10_000), keys), None);
    }

    #[test]
    fn a_span_leads_to_its_dotted_path() {
        let text = "[[wall]]\nname = 'a'\n[[wall.hole]]\ncenter = [1, 2]\n[[wall]]\ngas = { 'my gas' = 3 }\n";
        let document = DeTable::parse(text).unwrap();
        let path = |needle: &str| {
            let start = text.find(needle).unwrap();
            field_at(document.get_ref(), &(start..start + needle.len()))
        };
        assert_eq!(path("2"), "wall[0].hole[0].center[1]");
        assert_eq!(path("[1, 2]"), "wall[0].hole[0].center");
        assert_eq!(path("3"), "wall[1].gas.\"my gas\"");
        assert_eq!(path("[[wall.hole]]"), "wall[0].hole[0]");
        assert_ne!(path("'a'"), path("3"));
    }
}
