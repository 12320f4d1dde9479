//! TOML, line by line, with numbers that read back as they were.

use std::fmt::Write;

use super::region::Region;
use super::types::Curve;

/// The text so far.
#[derive(Default)]
pub(super) struct TomlLines(String);

impl TomlLines {
    pub(super) fn into_text(self) -> String {
        self.0
    }

    pub(super) fn entry(&mut self, key: &str, value: &str) {
        // Writing to a String cannot fail.
        let _ = writeln!(self.0, "{key} = {value}");
    }
    pub(super) fn header(&mut self, header: &str) {
        let _ = writeln!(self.0, "\n{header}");
    }
    pub(super) fn text(&mut self, key: &str, value: &str) {
        self.entry(key, &quoted(value));
    }
    pub(super) fn number(&mut self, key: &str, value: f64) {
        self.entry(key, &shown(value));
    }
    pub(super) fn count(&mut self, key: &str, value: u64) {
        self.entry(key, &value.to_string());
    }
    pub(super) fn flag(&mut self, key: &str, value: bool) {
        self.entry(key, &value.to_string());
    }
    pub(super) fn numbers(&mut self, key: &str, values: &[f64]) {
        self.entry(key, &array(values));
    }
    pub(super) fn curve(&mut self, key: &str, curve: &Curve) {
        let points: Vec<String> = curve.points.iter().map(|point| array(point)).collect();
        self.entry(key, &format!("[{}]", points.join(", ")));
    }
}

pub(super) fn region_table(region: &Region) -> String {
    match region {
        Region::Box { min, max } => format!("{{ box = {{ min = {}, max = {} }} }}", array(min), array(max)),
        Region::Sphere { center, radius } => {
            format!("{{ sphere = {{ center = {}, radius = {} }} }}", array(center), shown(*radius))
        }
        Region::Cylinder { base, axis, radius, height } => format!(
            "{{ cylinder = {{ base = {}, axis = {}, radius = {}, height = {} }} }}",
            array(base),
            array(axis),
            shown(*radius),
            shown(*height)
        ),
    }
}

/// The shortest decimal that reads back as the same number.
pub(super) fn shown(number: f64) -> String {
    format!("{number:?}")
}

fn array(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|&v| shown(v)).collect();
    format!("[{}]", values.join(", "))
}

pub(super) fn quoted(text: &str) -> String {
    toml::Value::from(text).to_string()
}
