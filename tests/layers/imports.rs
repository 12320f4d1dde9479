//! Which file of a crate names items of which other file.
//!
//! A path leads to the file that defines the item: a name that a module passes on with `pub use` counts for the file
//! behind it. Test modules count for nothing.

use proc_macro2::{TokenStream, TokenTree};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree};

/// The names of an absolute path, from below the crate's root.
type Names = Vec<String>;

/// What one file says: its module, what it defines, what it gives names to, and which paths stand in it.
#[derive(Default)]
struct Source {
    module: Names,
    defines: BTreeSet<String>,
    aliases: BTreeMap<String, Names>,
    globs: Vec<Names>,
    paths: Vec<Names>,
}

/// The files of a folder `src`, and for each the files that it imports from with the names of what it imports.
pub struct Imports {
    pub files: Vec<String>,
    pub from: Vec<BTreeMap<usize, BTreeSet<String>>>,
}

impl Imports {
    pub fn read(src: &Path) -> Self {
        let mut texts = Vec::new();
        texts_below(src, src, &mut texts);
        texts.sort();
        Self::of(&texts)
    }

    /// `texts`: each file's path below `src` and its text.
    pub fn of(texts: &[(String, String)]) -> Self {
        let sources: Vec<Source> = texts.iter().map(|(path, text)| Source::new(path, text)).collect();
        let modules = sources.iter().enumerate().map(|(file, source)| (source.module.clone(), file)).collect();
        let crates = Crate { sources: &sources, modules };
        let imported = |file: usize| {
            let mut from = BTreeMap::<usize, BTreeSet<String>>::new();
            for path in &sources[file].paths {
                if let Some((found, name)) = crates.definition(path, 0).filter(|&(found, _)| found != file) {
                    from.entry(found).or_default().insert(name);
                }
            }
            from
        };
        Self {
            files: texts.iter().map(|(path, _)| path.clone()).collect(),
            from: (0..sources.len()).map(imported).collect(),
        }
    }

    /// The groups of files each of which leads back to itself, shortest names first.
    pub fn circles(&self) -> Vec<Vec<usize>> {
        let reach: Vec<BTreeSet<usize>> = (0..self.files.len()).map(|file| self.reached(file)).collect();
        let mut done = BTreeSet::new();
        let mut circles = Vec::new();
        for file in 0..self.files.len() {
            let circle: Vec<usize> =
                reach[file].iter().copied().filter(|&other| reach[other].contains(&file)).collect();
            if !circle.is_empty() && done.insert(circle.clone()) {
                circles.push(circle);
            }
        }
        circles
    }

    fn reached(&self, file: usize) -> BTreeSet<usize> {
        let (mut reached, mut next) = (BTreeSet::new(), vec![file]);
        while let Some(file) = next.pop() {
            next.extend(self.from[file].keys().filter(|&&other| reached.insert(other)));
        }
        reached
    }
}

fn texts_below(src: &Path, folder: &Path, into: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            texts_below(src, &path, into);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let inside = path.strip_prefix(src).expect("below src").to_string_lossy().into_owned();
            into.push((inside, fs::read_to_string(&path).expect("text")));
        }
    }
}

struct Crate<'a> {
    sources: &'a [Source],
    modules: BTreeMap<Names, usize>,
}

impl Crate<'_> {
    /// The file that defines what `path` names, and its name there. None for a module, and for what is not of this crate.
    fn definition(&self, path: &[String], depth: usize) -> Option<(usize, String)> {
        let mut at = 0;
        while at < path.len() && self.modules.contains_key(&path[..=at]) {
            at += 1;
        }
        let name = path.get(at)?;
        let &file = self.modules.get(&path[..at])?;
        let source = &self.sources[file];
        if source.defines.contains(name) {
            return Some((file, name.clone()));
        }
        if depth > 20 {
            return None;
        }
        if let Some(target) = source.aliases.get(name) {
            let longer: Names = target.iter().chain(&path[at + 1..]).cloned().collect();
            // Of `self::x`, where x is a module's own name, nothing new is found.
            return (longer != path).then(|| self.definition(&longer, depth + 1)).flatten();
        }
        source.globs.iter().find_map(|glob| {
            let longer: Names = glob.iter().chain(&path[at..]).cloned().collect();
            self.definition(&longer, depth + 1)
        })
    }
}

impl Source {
    fn new(path: &str, text: &str) -> Self {
        let stem = path.strip_suffix(".rs").expect("a source file");
        let module =
            stem.split('/').filter(|&part| !matches!(part, "mod" | "lib" | "main")).map(str::to_owned).collect();
        let parsed = syn::parse_file(text).unwrap_or_else(|error| panic!("{path}: {error}"));
        let mut source = Self { module, ..Self::default() };
        if !is_test(&parsed.attrs) && path != "main.rs" && !path.ends_with("tests.rs") && !path.contains("/tests/") {
            source.visit_file(&parsed);
        }
        source
    }

    /// The absolute path of one that stands here.
    fn absolute(&self, path: &[String]) -> Option<Names> {
        let mut module = self.module.clone();
        let mut names = path.iter().peekable();
        match names.peek()?.as_str() {
            "crate" => {
                module.clear();
                names.next();
            }
            "self" => drop(names.next()),
            "super" => {
                while names.next_if(|name| *name == "super").is_some() {
                    module.pop()?;
                }
            }
            _ => {}
        }
        module.extend(names.cloned());
        Some(module)
    }

    fn note(&mut self, path: &[String]) {
        if let Some(path) = self.absolute(path) {
            self.paths.push(path);
        }
    }

    fn note_use(&mut self, tree: &UseTree, before: &mut Names, passed_on: bool) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.note_use(&path.tree, before, passed_on);
                before.pop();
            }
            UseTree::Name(name) => self.note_name(&name.ident.to_string(), None, before, passed_on),
            UseTree::Rename(name) => {
                self.note_name(&name.ident.to_string(), Some(name.rename.to_string()), before, passed_on);
            }
            UseTree::Glob(_) => self.globs.extend(self.absolute(before)),
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.note_use(tree, before, passed_on);
                }
            }
        }
    }

    fn note_name(&mut self, name: &str, renamed: Option<String>, before: &[String], passed_on: bool) {
        let mut path = before.to_vec();
        if name != "self" {
            path.push(name.to_owned());
        }
        let Some(target) = self.absolute(&path) else { return };
        if !passed_on {
            self.paths.push(target.clone());
        }
        let alias = renamed.or(path.last().cloned());
        self.aliases.extend(alias.map(|alias| (alias, target)));
    }

    /// The paths in a macro's text.
    fn note_tokens(&mut self, tokens: TokenStream) {
        let mut path = Names::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(ident) => {
                    if colons != 2 && !path.is_empty() {
                        self.note(&std::mem::take(&mut path));
                    }
                    path.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                other => {
                    self.note(&std::mem::take(&mut path));
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.note_tokens(group.stream());
                    }
                }
            }
        }
        self.note(&path);
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("cfg")
            && attribute.parse_args::<syn::Ident>().is_ok_and(|argument| argument == "test")
    })
}

impl<'ast> Visit<'ast> for Source {
    fn visit_item(&mut self, item: &'ast Item) {
        let (name, attributes) = match item {
            Item::Const(item) => (Some(&item.ident), &item.attrs),
            Item::Enum(item) => (Some(&item.ident), &item.attrs),
            Item::Fn(item) => (Some(&item.sig.ident), &item.attrs),
            Item::Static(item) => (Some(&item.ident), &item.attrs),
            Item::Struct(item) => (Some(&item.ident), &item.attrs),
            Item::Trait(item) => (Some(&item.ident), &item.attrs),
            Item::Type(item) => (Some(&item.ident), &item.attrs),
            Item::Mod(item) => (item.content.as_ref().map(|_| &item.ident), &item.attrs),
            Item::Macro(item) => (item.ident.as_ref(), &item.attrs),
            Item::Use(item) => (None, &item.attrs),
            Item::Impl(item) => (None, &item.attrs),
            _ => return visit::visit_item(self, item),
        };
        if is_test(attributes) {
            return;
        }
        self.defines.extend(name.map(ToString::to_string));
        match item {
            Item::Use(item) => {
                let passed_on = !matches!(item.vis, syn::Visibility::Inherited);
                self.note_use(&item.tree, &mut Names::new(), passed_on);
            }
            // Of an inline module the paths are read as if they stood outside.
            _ => visit::visit_item(self, item),
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Names = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.note(&names);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        self.note_tokens(item.tokens.clone());
        visit::visit_macro(self, item);
    }
}
