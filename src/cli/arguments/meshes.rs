//! The arguments of `corpuscle mesh`.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::counts::count;
use super::runs::EXIT_CODES;
use crate::scene::UnitSystem;

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct MeshArguments {
    /// `teabag`, `cushion`, `cylinder` or `sphere`; or a mesh (.obj, .stl) or frames of nodes (.nodes, .series, .pvd)
    #[arg(value_name = "SHAPE|FILE", value_hint = ValueHint::FilePath)]
    pub source: String,
    /// A file to write, by its ending: the mesh (.obj, .stl), or frames of its nodes (.nodes, .vtk.series); several times
    /// for several
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Vec<PathBuf>,
    /// Units of all numbers here and in the files: SI, kg-mm-ms, t-mm-s
    #[arg(long, value_name = "UNITS", default_value = "SI", value_parser = units)]
    pub units: UnitSystem,
    #[command(flatten)]
    pub shape: ShapeArguments,
    #[command(flatten)]
    pub motion: MotionArguments,
}

/// Each shape takes some of these.
#[derive(Debug, Args)]
#[command(next_help_heading = "Shapes")]
pub struct ShapeArguments {
    /// The middle of the shape [default: 0,0,0]
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = point)]
    pub center: Option<Point>,
    /// Of a teabag: its side
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub side: Option<f64>,
    /// Of a teabag: elements a side [default: 20]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u32>(0..=u64::from(u32::MAX)))]
    pub elements: Option<u32>,
    /// Between the two sheets of a teabag or cushion [default: a hundredth of side or radius]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub gap: Option<f64>,
    /// Of a cushion, cylinder or sphere
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub radius: Option<f64>,
    /// Of a cushion: rings from the middle to the rim [default: 12]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u32>(0..=u64::from(u32::MAX)))]
    pub rings: Option<u32>,
    /// Of a cylinder, along z
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    pub height: Option<f64>,
    /// Of a cylinder: elements around [default: 48]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u32>(0..=u64::from(u32::MAX)))]
    pub around: Option<u32>,
    /// Of a cylinder: elements along [default: as long as they are wide]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u32>(0..=u64::from(u32::MAX)))]
    pub along: Option<u32>,
    /// A cylinder with its ends
    #[arg(long)]
    pub closed: bool,
    /// Of a sphere: how often the triangles of an icosahedron are quartered [default: 3]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<u32>(0..=u64::from(u32::MAX)))]
    pub subdivisions: Option<u32>,
}

/// Of the nodes of a mesh.
#[derive(Debug, Args)]
#[command(next_help_heading = "Motion of the nodes")]
pub struct MotionArguments {
    /// From frame to frame each node moves at this speed into a direction by chance
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, conflicts_with = "scale_to", requires_all = ["frames", "until"])]
    pub shake: Option<f64>,
    /// How far from its place a node is shaken at most [default: a fifth of the least distance of two nodes]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true, requires = "shake")]
    pub amplitude: Option<f64>,
    /// Another seed is another shaking [default: 1]
    #[arg(long, value_name = "S", allow_negative_numbers = true, requires = "shake", value_parser = count::<u64>(0..=u64::MAX))]
    pub seed: Option<u64>,
    /// The mesh shrinks or grows to so many times its size, about its middle
    #[arg(long, value_name = "FACTOR", allow_negative_numbers = true, requires_all = ["frames", "until"])]
    pub scale_to: Option<f64>,
    /// Frames, the first at time 0
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count::<usize>(0..=u64::MAX))]
    pub frames: Option<usize>,
    /// The time of the last frame
    #[arg(long, value_name = "TIME", allow_negative_numbers = true)]
    pub until: Option<f64>,
    /// Note nodes that move faster than this
    #[arg(long, value_name = "SPEED", allow_negative_numbers = true, value_parser = limit)]
    pub speed_limit: Option<f64>,
}

/// Three coordinates.
#[derive(Debug, Clone, Copy)]
pub struct Point(pub [f64; 3]);

fn point(text: &str) -> Result<Point, String> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    let point = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    point.map(Point).ok_or_else(|| "three numbers with commas between them are possible, such as 0.1,0,-2".into())
}

fn units(text: &str) -> Result<UnitSystem, String> {
    let known = UnitSystem::ALL.into_iter().find(|units| units.name() == text);
    known.ok_or_else(|| format!("{} are possible", UnitSystem::ALL.map(UnitSystem::name).join(", ")))
}

fn limit(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(speed) if speed > 0.0 => Ok(speed),
        _ => Err("a number above 0 is possible".into()),
    }
}
