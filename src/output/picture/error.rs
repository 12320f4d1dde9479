//! What can go wrong with a picture.

use std::path::PathBuf;

use crate::geometry::GeometryError;
use crate::gpu::GpuError;
use crate::output::OutputError;
use crate::scene::SceneError;

#[derive(Debug, thiserror::Error, miette::Diagnostic)]
pub enum PictureError {
    #[error(transparent)]
    Output(#[from] OutputError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Geometry(#[from] GeometryError),
    #[error(transparent)]
    #[diagnostic(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    #[diagnostic(help("`corpuscle adapters` lists the devices; --size makes a smaller picture"))]
    Gpu(#[from] GpuError),
    #[error("{}: the run has written no snapshots", path.display())]
    #[diagnostic(help("`snapshots = 20` in [output] of the scene makes 20 beside that of the start: run it again so"))]
    NoSnapshots { path: PathBuf },
    #[error("{}: its particles have no subdomains", path.display())]
    #[diagnostic(help(
        "only a run among several ranks has them, such as one with --subdomains 4; take another --color-by"
    ))]
    NoSubdomains { path: PathBuf },
    #[error("{}: there is no fabric beside it", path.display())]
    #[diagnostic(help("leave out --fabric: a run without fabric has none to be drawn"))]
    NoFabric { path: PathBuf },
    #[error("{}: it has a particle of gas {gas}, the scene of the run has {known} gases, from 0", path.display())]
    #[diagnostic(help("the snapshots and scene.toml are of different runs"))]
    UnknownGas { path: PathBuf, gas: u8, known: usize },
}
