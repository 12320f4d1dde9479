//! Whether what is in a folder may be replaced.
//!
//! Without `force` only what the new run would leave in the same way: results of an earlier run of the same scene that has
//! reached its end. With `force` all results. What is read (the scene, its meshes, a checkpoint) is never replaced.

use std::fs;
use std::path::{Path, PathBuf};

use super::super::OutputError;
use super::super::checkpoint::latest;
use super::super::meshes::MeshRecord;
use super::super::names::{
    AUDIT_FILE, HISTORY_FILE, HISTORY_MEAN_FILE, PARETO_FILE, SCENE_FILE, STABILITY_FILE, SWEEP_FILE,
};
use super::contents::Contents;

/// Who asks for a folder.
#[derive(Debug, Clone, Copy)]
pub struct Claim<'a> {
    pub content: Content,
    /// The scene as it will be recorded, TOML; none if the folder will have none.
    pub scene: Option<&'a str>,
    /// The meshes that it names.
    pub meshes: &'a [MeshRecord],
    /// Files and folders that are read.
    pub inputs: &'a [PathBuf],
    pub force: bool,
}

/// What a folder is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    Run,
    /// Runs of several seeds.
    Seeds,
    Sweep,
    Pareto,
    Stability,
}

impl Content {
    fn name(self) -> &'static str {
        match self {
            Content::Run => "a run",
            Content::Seeds => "runs of several seeds",
            Content::Sweep => "a sweep",
            Content::Pareto => "a chart of error against cost",
            Content::Stability => "a stability map",
        }
    }

    /// What results say that they are; none are there if a run failed before it began.
    fn found(folder: &Path, contents: &Contents) -> Option<Content> {
        let has = |name: &str| folder.join(name).exists();
        let known = [
            (has(SWEEP_FILE), Content::Sweep),
            (has(PARETO_FILE), Content::Pareto),
            (has(STABILITY_FILE), Content::Stability),
            (has(HISTORY_MEAN_FILE) || !contents.seeds.is_empty(), Content::Seeds),
            (has(AUDIT_FILE) || latest(folder).is_ok() || rows(folder) > 0, Content::Run),
        ];
        known.into_iter().find_map(|(there, content)| there.then_some(content))
    }
}

impl Claim<'_> {
    /// # Errors
    /// Why `folder` cannot be had, and what can be done.
    pub(super) fn judge(&self, folder: &Path) -> Result<(), OutputError> {
        let contents = Contents::of(folder)?;
        self.spare_inputs(folder, &contents)?;
        if self.force {
            return Ok(());
        }
        let path = || folder.to_path_buf();
        if let Some(foreign) = contents.foreign() {
            return Err(OutputError::FolderInUse { path: path(), foreign });
        }
        let Some(found) = Content::found(folder, &contents) else { return Ok(()) };
        if let Some(mut state) = unfinished(folder, found) {
            if let Some(difference) = self.difference(folder).filter(|_| found == self.content) {
                state += &format!("; but it is of another scene, which `resume` keeps: {difference}");
            }
            return Err(OutputError::Unfinished { path: path(), state });
        }
        if found != self.content {
            return Err(OutputError::OtherContent { path: path(), found: found.name(), wanted: self.content.name() });
        }
        match self.difference(folder) {
            Some(difference) => Err(OutputError::OtherScene { path: path(), difference }),
            None => Ok(()),
        }
    }

    /// What is read is not among what is removed, by whatever path.
    fn spare_inputs(&self, folder: &Path, contents: &Contents) -> Result<(), OutputError> {
        // By what a link leads to, and by the place of the link itself.
        let places = |path: &Path| {
            let there = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
            let own = there.canonicalize().ok().zip(path.file_name()).map(|(parent, name)| parent.join(name));
            [path.canonicalize().ok(), own].into_iter().flatten().collect::<Vec<_>>()
        };
        let inputs: Vec<(&PathBuf, Vec<PathBuf>)> = self.inputs.iter().map(|input| (input, places(input))).collect();
        for doomed in contents.results.iter().chain(&contents.links) {
            let doomed = places(doomed);
            let read = inputs.iter().find(|(_, input)| input.iter().any(|i| doomed.iter().any(|d| d.starts_with(i))));
            if let Some((input, _)) = read {
                return Err(OutputError::OverInput { path: folder.to_path_buf(), input: (*input).clone() });
            }
        }
        Ok(())
    }

    /// What is not the same in the results of another scene.
    fn difference(&self, folder: &Path) -> Option<String> {
        let scene = self.scene?;
        let there = fs::read_to_string(folder.join(SCENE_FILE)).unwrap_or_default();
        if there != scene {
            let (mut own, mut others) = (scene.lines(), there.lines());
            loop {
                match (own.next(), others.next()) {
                    (own, other) if own == other && own.is_some() => {}
                    (own, other) => {
                        let line = |line: Option<&str>| line.map_or("nothing".to_owned(), |line| format!("`{line}`"));
                        return Some(format!("{} there, {} in this one", line(other), line(own)));
                    }
                }
            }
        }
        let changed = self.meshes.iter().find(|mesh| self.content == Content::Run && !mesh.copy_in(folder).is_file());
        changed.map(|mesh| format!("the mesh {} was another", mesh.path.display()))
    }
}

/// Rows of the history.
fn rows(folder: &Path) -> usize {
    let text = fs::read_to_string(folder.join(HISTORY_FILE)).unwrap_or_default();
    text.lines().count().saturating_sub(1)
}

/// How far a run that has not ended has got; none if it has.
fn unfinished(folder: &Path, content: Content) -> Option<String> {
    match content {
        Content::Run if !folder.join(AUDIT_FILE).exists() => {
            if latest(folder).is_ok() {
                let resume = format!("`corpuscle resume {}` goes on with it", folder.display());
                return Some(format!("a run that has not reached its end: {resume}"));
            }
            let rows = rows(folder);
            let few = if rows == 1 { "1 row".to_owned() } else { format!("{rows} rows") };
            Some(format!("a run that has not reached its end ({few} of history, no checkpoint to go on from)"))
        }
        Content::Seeds if !folder.join(HISTORY_MEAN_FILE).exists() => {
            Some("runs of several seeds that have not all reached their ends".to_owned())
        }
        _ => None,
    }
}
