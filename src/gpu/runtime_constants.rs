//! Runtime constants: numbers of a scene that a kernel reads from a uniform, where its source has them as override constants.
//!
//! A kernel compiled for its numbers is the fastest, and of no use to a scene of other numbers: a driver compiles it anew, which takes a software device some
//! tenths of a second for each. One that reads them serves every scene that has the same ones, and is in the driver's cache once one of those has run.

use super::source::{Constants, KernelSource};

/// A kernel's text with variables in place of override constants, which its entry point first reads from a uniform.
#[derive(Debug, Clone, PartialEq)]
pub struct RuntimeConstants {
    pub text: String,
    /// The uniform's binding number.
    pub binding: u32,
    /// What is in it.
    pub words: Vec<u32>,
}

impl RuntimeConstants {
    /// Override constants that `runtime` names and `constants` gives are read; `None` if there are none. `text` is one of the
    /// kernel's.
    ///
    /// # Errors
    /// If a value is none of its type, or the text is not as this expects it; with the reason.
    pub fn of(
        kernel: &KernelSource,
        text: &str,
        constants: &Constants,
        runtime: &[&str],
    ) -> Result<Option<RuntimeConstants>, String> {
        let (mut made, mut members, mut stores) = (String::new(), String::new(), String::new());
        let mut words = Vec::new();
        for line in text.lines() {
            let declared = declared(line).filter(|(name, _)| runtime.contains(name));
            let given = declared.and_then(|(name, of)| {
                let (_, value) = constants.iter().find(|(given, _)| *given == name)?;
                Some((name, of, *value))
            });
            match given {
                Some((name, of, value)) => {
                    words.push(word(of, value).ok_or_else(|| format!("{name} is {value}, which is no {of}"))?);
                    made += &format!("var<private> {name}: {of};\n");
                    members += &format!("    {name}: {of},\n");
                    stores += &format!("    {name} = runtime_constants.{name};\n");
                }
                None => made = made + line + "\n",
            }
        }
        if words.is_empty() {
            return Ok(None);
        }
        let head = made.find(&format!("fn {}(", kernel.entry_point));
        let body = head.and_then(|head| Some(head + made[head..].find("{\n")? + 2));
        made.insert_str(body.ok_or("no body of the entry point")?, "    read_runtime_constants();\n");
        let binding = kernel.bindings.iter().map(|binding| binding.index + 1).max().unwrap_or(0);
        made += &format!(
            "struct RuntimeConstants {{\n{members}}}\n\
             @group(0) @binding({binding}) var<uniform> runtime_constants: RuntimeConstants;\n\
             fn read_runtime_constants() {{\n{stores}}}\n"
        );
        Ok(Some(RuntimeConstants { text: made, binding, words }))
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
    use super::*;

    const PROBE: &str = "override EDGE: f32;\noverride CELLS: u32 = 1;\noverride FLAG: bool = true;\n\
                         @compute @workgroup_size(64)\nfn probe(@builtin(local_invocation_index) i: u32) {\n}\n";

    #[test]
    fn runtime_constants_become_variables_that_are_read_first() {
        let probe = KernelSource::probe(PROBE);
        let constants = [("FLAG", 0.0), ("CELLS", 7.0), ("EDGE", 0.1)];
        let of = |runtime: &[&str]| RuntimeConstants::of(&probe, PROBE, &constants, runtime);
        let both = of(&["CELLS", "EDGE", "MORE"]).unwrap().unwrap();
        assert_eq!((both.words, both.binding), (vec![0.1f32.to_bits(), 7], 0));
        assert_eq!(
            both.text,
            "var<private> EDGE: f32;\nvar<private> CELLS: u32;\noverride FLAG: bool = true;\n\
             @compute @workgroup_size(64)\nfn probe(@builtin(local_invocation_index) i: u32) {\n    read_runtime_constants();\n}\n\
             struct RuntimeConstants {\n    EDGE: f32,\n    CELLS: u32,\n}\n\
             @group(0) @binding(0) var<uniform> runtime_constants: RuntimeConstants;\n\
             fn read_runtime_constants() {\n    EDGE = runtime_constants.EDGE;\n    CELLS = runtime_constants.CELLS;\n}\n"
        );
        assert_eq!(of(&["MORE"]), Ok(None));
        assert_eq!(of(&["FLAG"]), Err("FLAG is 0, which is no bool".into()));
    }

    #[test]
    fn values_that_a_type_has_not_are_refused() {
        for (of, value) in [("u32", 0.5), ("u32", -1.0), ("u32", 4_294_967_296.0), ("f32", 1e39), ("f32", f64::NAN)] {
            assert_eq!(word(of, value), None, "{of} {value}");
        }
        assert_eq!(word("u32", 4_294_967_295.0), Some(u32::MAX));
    }
}
