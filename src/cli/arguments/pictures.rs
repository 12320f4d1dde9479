//! The verb that makes pictures: what it takes.

use std::path::PathBuf;

use clap::{Args, ValueEnum, ValueHint};

use super::runs::EXIT_CODES;
use crate::output::picture::{Colouring, FabricLook, View};

#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct RenderArguments {
    /// The folder of a run with snapshots, or a mesh (OBJ, STL)
    #[arg(value_name = "DIR|MESH", value_hint = ValueHint::AnyPath)]
    pub subject: PathBuf,
    /// The time whose nearest snapshot is shown, such as 10ms [default: the last]
    #[arg(long, value_name = "TIME", value_parser = time, allow_negative_numbers = true, conflicts_with = "movie")]
    pub time: Option<f64>,
    /// What the colours of the particles say [default: gas]
    #[arg(long, value_enum, value_name = "WHAT")]
    pub color_by: Option<ColorBy>,
    /// How fabric is drawn [default: clear]
    #[arg(long, value_enum, value_name = "HOW")]
    pub fabric: Option<Fabric>,
    /// Whence it is seen: `iso`, `front` (along +y), `side` (along -x), `top`, or degrees from the front and above it
    #[arg(long, value_name = "VIEW", default_value = "iso", value_parser = view, allow_hyphen_values = true)]
    pub view: View,
    /// Pixels of the picture
    #[arg(long, value_name = "WIDTHxHEIGHT", default_value = "1280x800", value_parser = size)]
    pub size: [u32; 2],
    /// All snapshots, as NAME_000000.png and so on
    #[arg(long)]
    pub movie: bool,
    /// The picture [default: beside the folder or the mesh, with its name and .png]
    #[arg(short, long, value_name = "FILE.png", value_hint = ValueHint::FilePath, value_parser = png)]
    pub out: Option<PathBuf>,
    /// The device, by its index or PCI id in `corpuscle adapters` [default: the first]
    #[arg(long, value_name = "INDEX|PCI")]
    pub gpu: Option<String>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ColorBy {
    Gas,
    Speed,
    Temperature,
    Subdomain,
}

impl From<ColorBy> for Colouring {
    fn from(by: ColorBy) -> Colouring {
        match by {
            ColorBy::Gas => Colouring::Gas,
            ColorBy::Speed => Colouring::Speed,
            ColorBy::Temperature => Colouring::Temperature,
            ColorBy::Subdomain => Colouring::Subdomain,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Fabric {
    Clear,
    Opaque,
    None,
}

impl From<Fabric> for FabricLook {
    fn from(fabric: Fabric) -> FabricLook {
        match fabric {
            Fabric::Clear => FabricLook::Clear,
            Fabric::Opaque => FabricLook::Opaque,
            Fabric::None => FabricLook::Left,
        }
    }
}

/// Longer units first: each ends in an `s`.
const UNITS: [(&str, f64); 4] = [("ms", 1e-3), ("us", 1e-6), ("\u{b5}s", 1e-6), ("s", 1.0)];

/// Seconds.
fn time(text: &str) -> Result<f64, String> {
    let with_unit = UNITS.iter().find_map(|(unit, factor)| Some((text.strip_suffix(unit)?.trim(), factor)));
    let seconds = with_unit.and_then(|(number, factor)| Some(number.parse::<f64>().ok()? * factor));
    let seconds = seconds.filter(|seconds| seconds.is_finite() && *seconds >= 0.0);
    seconds.ok_or_else(|| "expected a time from 0 on with its unit, such as 10ms, 0.01s or 250us".into())
}

fn view(text: &str) -> Result<View, String> {
    text.parse()
}

const EDGES: std::ops::RangeInclusive<u32> = 200..=8192;

fn size(text: &str) -> Result<[u32; 2], String> {
    let edges = text
        .split_once(['x', 'X'])
        .and_then(|(width, height)| Some([width.parse::<u32>().ok()?, height.parse::<u32>().ok()?]));
    edges
        .filter(|edges| edges.iter().all(|edge| EDGES.contains(edge)))
        .ok_or_else(|| format!("expected pixels such as 1280x800, each edge from {} to {}", EDGES.start(), EDGES.end()))
}

fn png(text: &str) -> Result<PathBuf, String> {
    let path = PathBuf::from(text);
    let is_png = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png"));
    is_png.then_some(path).ok_or_else(|| "expected a name that ends in .png".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_has_its_unit() {
        for (text, seconds) in
            [("10ms", 0.01), ("2.5 ms", 0.0025), ("1e-3s", 1e-3), ("250us", 250.0 * 1e-6), ("0s", 0.0)]
        {
            assert_eq!(time(text), Ok(seconds), "{text}");
        }
        for wrong in ["10", "ms", "-1ms", "nans", "infs", "10min", ""] {
            assert!(time(wrong).unwrap_err().contains("10ms"), "{wrong}");
        }
    }

    #[test]
    fn a_size_is_two_edges_and_a_picture_a_png() {
        assert_eq!(size("1280x800"), Ok([1280, 800]));
        for wrong in ["1280", "1280x", "199x400", "400x8193", "-400x400", "4e2x400"] {
            assert!(size(wrong).is_err(), "{wrong}");
        }
        assert!(png("a.PNG").is_ok() && png("png").is_err() && png("a.jpg").is_err());
    }
}
