//! What is on a picture, before it is drawn.

use std::ops::Range;

use glam::DVec3;

use super::colours::Colour;
use super::surface::Surface;

/// Lengths in m, or in the unit of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    pub title: String,
    /// Below the title.
    pub caption: String,
    pub balls: Vec<(DVec3, Colour)>,
    /// How many balls there are at most on pictures of one series: it sets their size.
    pub most_balls: usize,
    /// They hide what is behind them.
    pub meshes: Vec<Surface>,
    pub panes: Vec<Pane>,
    pub key: Key,
    pub unit: LengthUnit,
}

/// A surface that lets through what is behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Pane {
    pub surface: Surface,
    pub colour: Colour,
    /// Of 255; several panes lie one behind the other.
    pub opacity: u8,
}

/// What the colours of the balls mean.
#[derive(Debug, Clone, PartialEq)]
pub enum Key {
    Nothing,
    Kinds(Vec<(String, Colour)>),
    Values(Scale),
}

/// A quantity with its unit, and what lies between the ends of the colours.
#[derive(Debug, Clone, PartialEq)]
pub struct Scale {
    pub quantity: &'static str,
    pub range: Range<f64>,
}

impl Scale {
    /// From 0, the first of the ends, to 1.
    pub fn share(&self, value: f64) -> f64 {
        (value - self.range.start) / (self.range.end - self.range.start)
    }
}

/// The unit of lengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LengthUnit {
    Metre,
    /// That of a mesh file, which says none.
    OfFile,
}

impl Picture {
    /// All that is to be seen.
    pub fn points(&self) -> impl Iterator<Item = DVec3> {
        let surfaces = self.meshes.iter().chain(self.panes.iter().map(|pane| &pane.surface));
        surfaces.flat_map(|surface| surface.vertices.iter().copied()).chain(self.balls.iter().map(|ball| ball.0))
    }
}
