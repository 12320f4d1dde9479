//! What numbers of scenes usually are.

use crate::plan::text::as_written;
use crate::scene::{Curve, Dimension, GAS_CONSTANT, UnitSystem};

/// What a number is of, where that decides its range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// The longest edge of the box around a wall.
    Extent,
    Pressure,
    Temperature,
    MolarMass,
    MolarHeat,
    MassFlow,
    HeatTransfer,
    Speed,
    Discharge,
    /// Of what gas flows through.
    Area,
    /// Of fabric, as its density and modulus.
    Thickness,
    Density,
    Young,
    Acceleration,
    EndTime,
    Steps,
}

/// From the least to the most that is usual, SI, both included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    pub kind: Kind,
    pub dimension: Dimension,
    pub least: f64,
    pub most: f64,
    /// What is commonest: of several units the one that comes nearest is named.
    pub(super) usual: f64,
}

impl Range {
    pub(super) fn holds(&self, value: f64) -> bool {
        // Rounding is not beyond it. A coefficient of just the most is: in t, mm, s a round number of W/(m2 K) is as large.
        let rounding = if self.kind == Kind::HeatTransfer { -1e-9 } else { 1e-9 };
        value >= self.least * (1.0 - 1e-9) && value <= self.most * (1.0 + rounding)
    }

    pub(super) fn words(&self, units: UnitSystem) -> String {
        let shown = |si: f64| as_written(si / units.factor(self.dimension));
        let unit = units.symbol(self.dimension);
        let bounds = if self.least > 0.0 {
            let below = if self.kind == Kind::HeatTransfer { "below " } else { "" };
            format!("{} to {below}{}", shown(self.least), shown(self.most))
        } else {
            format!("at most {}", shown(self.most))
        };
        format!("{bounds} {unit}").trim_end().to_string()
    }
}

const fn range(kind: Kind, dimension: Dimension, [least, most]: [f64; 2], usual: f64) -> Range {
    Range { kind, dimension, least, most, usual }
}

/// All ranges. From a pressure cell to a gas gun in pressure, from cryogenic hydrogen's neighbours to propellant flames in
/// temperature; 20 R is more than any gas of an inflator has (hexane: 17 R), an inflator gives a few kg/s, free convection and
/// jets give 1 to 1e3 W/(m2 K), gas in guns and engines less than 1e4, and no gas here is faster than 1e4 m/s. Fabric of airbags is of .2 to .5 mm, 800 kg/m3 and
/// some .4 GPa; films are thinner, rubber is softer, and fibres are stiffer.
pub const RANGES: &[Range] = &[
    range(Kind::Extent, Dimension::Length, [1e-3, 10.0], 0.3),
    range(Kind::Pressure, Dimension::Pressure, [1e3, 1e8], 101_325.0),
    range(Kind::Temperature, Dimension::Temperature, [150.0, 4000.0], 300.0),
    range(Kind::MolarMass, Dimension::MolarMass, [1e-3, 0.5], 0.029),
    range(Kind::MolarHeat, Dimension::MolarHeat, [0.0, 20.0 * GAS_CONSTANT], 29.0),
    range(Kind::MassFlow, Dimension::MassFlow, [0.0, 100.0], 1.0),
    range(Kind::HeatTransfer, Dimension::HeatTransfer, [0.1, 1e4], 50.0),
    range(Kind::Speed, Dimension::Velocity, [0.0, 1e4], 300.0),
    range(Kind::Discharge, Dimension::Pure, [0.0, 1.0], 0.7),
    range(Kind::Area, Dimension::Area, [1e-8, 1.0], 5e-4),
    range(Kind::Thickness, Dimension::Length, [1e-5, 5e-3], 3e-4),
    range(Kind::Density, Dimension::Density, [50.0, 5000.0], 800.0),
    range(Kind::Young, Dimension::Pressure, [1e6, 5e11], 4e8),
    range(Kind::Acceleration, Dimension::Acceleration, [0.0, 1000.0], 9.81),
    range(Kind::EndTime, Dimension::Time, [1e-6, 100.0], 0.02),
    range(Kind::Steps, Dimension::Pure, [0.0, 1e8], 1e4),
];

pub(super) fn range_of(kind: Kind) -> &'static Range {
    RANGES.iter().find(|range| range.kind == kind).unwrap_or(&RANGES[0])
}

pub(super) fn most(curve: &Curve) -> f64 {
    largest(curve.points.iter().map(|point| point[1].abs()))
}

pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}
