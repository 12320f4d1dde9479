//! `corpuscle render`: pictures of a run's snapshots, or of a mesh.

use std::path::{Path, PathBuf};

use super::CliError;
use super::arguments::RenderArguments;
use super::terminal::say;
use crate::geometry::read_surface;
use crate::gpu::Device;
use crate::output::grouped;
use crate::output::picture::{
    Camera, Colouring, FabricLook, Key, LengthUnit, Picture, PictureError, RunPictures, Studio, Surface, frame,
};

pub fn render(raw: RenderArguments) -> Result<(), CliError> {
    match (raw.subject.is_dir(), raw.subject.is_file()) {
        (true, _) => render_run(&raw),
        (_, true) => render_mesh(&raw),
        _ => Err(CliError::NoSubject { path: raw.subject }),
    }
}

fn render_run(raw: &RenderArguments) -> Result<(), CliError> {
    let run = RunPictures::open(&raw.subject).map_err(CliError::Picture)?;
    let chosen = chosen(raw, &run);
    let colouring = raw.color_by.map_or(Colouring::Gas, Colouring::from);
    if raw.fabric.is_some() {
        run.check_fabric(chosen[0]).map_err(CliError::Picture)?;
    }
    let fabric = raw.fabric.map_or(FabricLook::Clear, FabricLook::from);
    let series = run.series(&chosen, colouring).map_err(CliError::Picture)?;
    let device = Device::open(raw.gpu.as_deref())?;
    let studio = Studio::new(&device)?;
    let out = raw.out.clone().unwrap_or_else(|| beside(&raw.subject));
    // One camera for all: walls that move stay in sight.
    let places = run.places(&chosen).map_err(CliError::Picture)?;
    let camera = Camera::around(raw.view, frame(raw.size, &series.key), places.into_iter());
    for (number, &index) in chosen.iter().enumerate() {
        let picture = run.picture(index, &series, fabric).map_err(CliError::Picture)?;
        let path = if raw.movie { numbered(&out, number) } else { out.clone() };
        paint(&studio, &camera, &picture, &path)?;
    }
    Ok(())
}

/// The snapshots that are shown, by number.
fn chosen(raw: &RenderArguments, run: &RunPictures) -> Vec<usize> {
    let snapshots = run.snapshots();
    match raw.time {
        _ if raw.movie => (0..snapshots.len()).collect(),
        None => vec![snapshots.len() - 1],
        Some(time) => {
            let (nearest, is_near) = run.nearest(time);
            if !is_near {
                let found = 1e3 * snapshots[nearest].time;
                tracing::warn!(
                    "no snapshot within half an interval of {} ms: the nearest, which is shown, is of {found:.4} ms",
                    1e3 * time
                );
            }
            vec![nearest]
        }
    }
}

fn render_mesh(raw: &RenderArguments) -> Result<(), CliError> {
    let of_runs = [
        ("--time", raw.time.is_some()),
        ("--color-by", raw.color_by.is_some()),
        ("--fabric", raw.fabric.is_some()),
        ("--movie", raw.movie),
    ];
    if let Some((option, _)) = of_runs.into_iter().find(|(_, given)| *given) {
        return Err(CliError::OptionOfRuns { option, path: raw.subject.clone() });
    }
    let (vertices, triangles) =
        read_surface(&raw.subject).map_err(PictureError::Geometry).map_err(CliError::Picture)?;
    let name = raw.subject.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let count = grouped(triangles.len() as u64);
    let picture = Picture {
        title: name,
        caption: format!("{count} triangles"),
        balls: Vec::new(),
        most_balls: 0,
        meshes: vec![Surface { vertices, triangles }],
        panes: Vec::new(),
        key: Key::Nothing,
        unit: LengthUnit::OfFile,
    };
    let device = Device::open(raw.gpu.as_deref())?;
    let camera = Camera::around(raw.view, frame(raw.size, &picture.key), picture.points());
    let out = raw.out.clone().unwrap_or_else(|| beside(&raw.subject));
    paint(&Studio::new(&device)?, &camera, &picture, &out)
}

fn paint(studio: &Studio<'_>, camera: &Camera, picture: &Picture, path: &Path) -> Result<(), CliError> {
    let image = studio.paint(camera, picture).map_err(PictureError::Gpu).map_err(CliError::Picture)?;
    image.write_png(path)?;
    say(&format!("{}\n", path.display()))
}

/// `results/tank.png` of `results/tank`, `sheet.png` of `sheet.obj`.
fn beside(subject: &Path) -> PathBuf {
    // A folder may be called `.`, and have a dot in its name.
    let whole = subject.canonicalize().unwrap_or_else(|_| subject.to_path_buf());
    let name = if whole.is_dir() { whole.file_name() } else { whole.file_stem() };
    let mut name = name.unwrap_or_default().to_os_string();
    name.push(".png");
    let folder = if subject.file_name().is_some() { subject } else { &whole };
    folder.with_file_name(name)
}

/// `tank_000003.png` of `tank.png`.
fn numbered(path: &Path, number: usize) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_os_string();
    name.push(format!("_{number:06}.png"));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_beside_what_they_show() {
        assert_eq!(beside(Path::new("results/none.obj")), Path::new("results/none.png"));
        assert_eq!(numbered(Path::new("a/tank.png"), 12), Path::new("a/tank_000012.png"));
        let dir = tempfile::tempdir().unwrap();
        let run = dir.path().join("tank.x2");
        std::fs::create_dir(&run).unwrap();
        assert_eq!(beside(&run), dir.path().join("tank.x2.png"));
    }
}
