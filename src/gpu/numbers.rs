//! Kernels that read the numbers of a scene, where the source compiles them in.
//!
//! A kernel made for numbers is the fastest, and of no use to a scene of other numbers: a driver compiles it anew, which takes a software device some tenths
//! of a second for each. One that reads them is the same for every scene that has the same, and in the driver's cache once one of those has run.

use super::kernel::{Constants, KernelSource};

/// A kernel's source with variables for numbers, which its entry point reads first from a uniform.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    pub text: String,
    /// Of the uniform.
    pub binding: u32,
    /// What is in it.
    pub words: Vec<u32>,
}

impl Reading {
    /// Of the override constants those that `numbers` names and `constants` gives are read; `None` if there are none.
    ///
    /// # Errors
    /// If a value is none of its type, or the source is not as this expects it; with the reason.
    pub fn of(
        kernel: &KernelSource,
        source: &str,
        constants: &Constants,
        numbers: &[&str],
    ) -> Result<Option<Reading>, String> {
        let (mut text, mut members, mut stores) = (String::new(), String::new(), String::new());
        let mut words = Vec::new();
        for line in source.lines() {
            let number = declared(line).filter(|(name, _)| numbers.contains(name));
            let given = number.and_then(|(name, of)| {
                let (_, value) = constants.iter().find(|(given, _)| *given == name)?;
                Some((name, of, *value))
            });
            match given {
                Some((name, of, value)) => {
                    words.push(word(of, value).ok_or_else(|| format!("{name} is {value}, which is no {of}"))?);
                    text += &format!("var<private> {name}: {of};\n");
                    members += &format!("    {name}: {of},\n");
                    stores += &format!("    {name} = scene_numbers.{name};\n");
                }
                None => text = text + line + "\n",
            }
        }
        if words.is_empty() {
            return Ok(None);
        }
        let head = text.find(&format!("fn {}(", kernel.entry_point));
        let body = head.and_then(|head| Some(head + text[head..].find("{\n")? + 2));
        text.insert_str(body.ok_or("no body of the entry point")?, "    read_scene_numbers();\n");
        let binding = kernel.bindings.iter().map(|binding| binding.index + 1).max().unwrap_or(0);
        text += &format!(
            "struct SceneNumbers {{\n{members}}}\n\
             @group(0) @binding({binding}) var<uniform> scene_numbers: SceneNumbers;\n\
             fn read_scene_numbers() {{\n{stores}}}\n"
        );
        Ok(Some(Reading { text, binding, words }))
    }
}

/// The name and the type of an override constant, if the line declares one.
fn declared(line: &str) -> Option<(&str, &str)> {
    let (name, rest) = line.strip_prefix("override ")?.split_once(':')?;
    Some((name, rest.split(['=', ';']).next()?.trim()))
}

/// A value in the type, rounded as the compiler rounds it.
fn word(of: &str, value: f64) -> Option<u32> {
    match of {
        "f32" => Some(value as f32).filter(|value| value.is_finite()).map(f32::to_bits),
        "u32" => Some(value as u32).filter(|&whole| f64::from(whole) == value),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use wgpu::naga::front::wgsl;
    use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

    use super::*;
    use crate::gpu::{Form, KERNELS};

    const PROBE: &str = "override EDGE: f32;\noverride CELLS: u32 = 1;\noverride FLAG: bool = true;\n\
                         @compute @workgroup_size(64)\nfn probe(@builtin(local_invocation_index) i: u32) {\n}\n";

    #[test]
    fn numbers_become_variables_that_are_read_first() {
        let probe = KernelSource::probe(PROBE);
        let constants = [("FLAG", 0.0), ("CELLS", 7.0), ("EDGE", 0.1)];
        let reading = |numbers: &[&str]| Reading::of(&probe, PROBE, &constants, numbers);
        let both = reading(&["CELLS", "EDGE", "MORE"]).unwrap().unwrap();
        assert_eq!((both.words, both.binding), (vec![0.1f32.to_bits(), 7], 0));
        assert_eq!(
            both.text,
            "var<private> EDGE: f32;\nvar<private> CELLS: u32;\noverride FLAG: bool = true;\n\
             @compute @workgroup_size(64)\nfn probe(@builtin(local_invocation_index) i: u32) {\n    read_scene_numbers();\n}\n\
             struct SceneNumbers {\n    EDGE: f32,\n    CELLS: u32,\n}\n\
             @group(0) @binding(0) var<uniform> scene_numbers: SceneNumbers;\n\
             fn read_scene_numbers() {\n    EDGE = scene_numbers.EDGE;\n    CELLS = scene_numbers.CELLS;\n}\n"
        );
        assert_eq!(reading(&["MORE"]), Ok(None));
        assert_eq!(reading(&["FLAG"]), Err("FLAG is 0, which is no bool".into()));
    }

    #[test]
    fn values_that_a_type_has_not_are_refused() {
        for (of, value) in [("u32", 0.5), ("u32", -1.0), ("u32", 4_294_967_296.0), ("f32", 1e39), ("f32", f64::NAN)] {
            assert_eq!(word(of, value), None, "{of} {value}");
        }
        assert_eq!(word("u32", 4_294_967_295.0), Some(u32::MAX));
    }

    /// All that could be a number is made one: if that is valid, so is any part of it.
    #[test]
    fn every_kernel_in_every_form_can_read_its_numbers() {
        let mut found = 0;
        for kernel in KERNELS {
            for form in [Form::Plain, Form::Software, Form::Gpu] {
                let source = kernel.of(form);
                let fixed = ["WORKGROUP", "SCAN_THREADS"];
                let names: Vec<&str> = source
                    .lines()
                    .filter_map(declared)
                    .filter(|(name, of)| *of != "bool" && !fixed.contains(name))
                    .map(|(name, _)| name)
                    .collect();
                let constants: Vec<(&'static str, f64)> =
                    kernel.overrides.iter().map(|&(name, _)| (name, 1.0)).collect();
                let Some(reading) = Reading::of(kernel, source, &constants, &names).unwrap() else {
                    continue;
                };
                let module = wgsl::parse_str(&reading.text)
                    .unwrap_or_else(|error| panic!("{}: {}", kernel.name, error.emit_to_string(&reading.text)));
                let checked = Validator::new(ValidationFlags::all(), Capabilities::SUBGROUP).validate(&module);
                checked.unwrap_or_else(|error| panic!("{}: {error:?}", kernel.name));
                found += 1;
            }
        }
        assert!(found > 60, "{found}");
    }
}
