//! Values by their names in the scene, and sentences about those that are beyond their ranges.

use super::range::{Kind, Range, range_of};
use super::units::{atmosphere_in, likely, question};
use crate::plan::text::as_written;
use crate::scene::{Dimension, UnitSystem};

/// How a value of a scene is named: whose it is, and by which key.
pub struct Named<'a> {
    pub subject: String,
    pub key: &'a str,
    pub units: UnitSystem,
}

impl Named<'_> {
    fn value(&self, si: f64, dimension: Dimension) -> String {
        let unit = self.units.symbol(dimension);
        format!("{}: {} {} {unit}", self.subject, self.key, as_written(si / self.units.factor(dimension)))
            .trim_end()
            .into()
    }

    /// A warning if the value, SI, is beyond the range of its kind.
    pub fn check(&self, kind: Kind, si: f64) -> Option<String> {
        let range = range_of(kind);
        let question = question(&likely(range, si, self.units));
        (!range.holds(si)).then(|| self.beyond(range, si, &question))
    }

    pub fn beyond(&self, range: &Range, si: f64, rest: &str) -> String {
        format!("{}, usual is {}{rest}", self.value(si, range.dimension), range.words(self.units))
    }

    /// The digits of an atmosphere in another unit.
    pub fn atmosphere(&self, si: f64) -> Option<String> {
        let unit = atmosphere_in(si / self.units.factor(Dimension::Pressure), self.units)?;
        let range = range_of(Kind::Pressure);
        let (value, usual) = (self.value(si, Dimension::Pressure), range.words(self.units));
        Some(format!("{value} has the digits of an atmosphere, usual is {usual}: is it in {unit}?"))
    }
}
