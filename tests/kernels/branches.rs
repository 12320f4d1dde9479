//! What branches ask. Mesa's lavapipe of 22.3 makes a kernel for the values of uniforms that a branch asks alone, and some kernels anew at each
//! dispatch that has other values; so none asks for what changes from step to step.

use std::collections::BTreeSet;

use corpuscle::subdomain::KERNELS;
use naga::{AddressSpace, Block, Expression, Function, Handle, Module, Statement, TypeInner};

/// Members of the uniform `step` that differ from step to step of an interval. (`round` and what goes with it take as many values as a plan has rounds.)
const CHANGING: [&str; 12] = [
    "count",
    "newborns",
    "newborn_offset",
    "newborn_first_id",
    "index",
    "dt",
    "arrivals",
    "total",
    "first",
    "tallies_left",
    "slot",
    "next_newborns",
];

/// Whether a value is known from uniforms and constants alone; `members` are those of uniforms that it is of. What comes through arguments and
/// variables is taken for another's.
fn is_uniform(module: &Module, function: &Function, value: Handle<Expression>, members: &mut BTreeSet<String>) -> bool {
    let mut all = |values: &[Handle<Expression>]| {
        // All of them are looked at.
        values.iter().filter(|&&value| !is_uniform(module, function, value, members)).count() == 0
    };
    match &function.expressions[value] {
        Expression::Literal(_) | Expression::Constant(_) | Expression::Override(_) | Expression::ZeroValue(_) => true,
        Expression::Load { pointer } => match member(module, function, *pointer) {
            Some(name) => {
                members.insert(name);
                true
            }
            None => false,
        },
        Expression::Compose { components, .. } => all(components),
        Expression::Access { base, index } => all(&[*base, *index]),
        Expression::AccessIndex { base: value, .. }
        | Expression::Splat { value, .. }
        | Expression::Swizzle { vector: value, .. }
        | Expression::Unary { expr: value, .. }
        | Expression::Relational { argument: value, .. }
        | Expression::As { expr: value, .. } => all(&[*value]),
        Expression::Binary { left, right, .. } => all(&[*left, *right]),
        Expression::Select { condition, accept, reject } => all(&[*condition, *accept, *reject]),
        Expression::Math { arg, arg1, arg2, arg3, .. } => {
            all(&[Some(*arg), *arg1, *arg2, *arg3].into_iter().flatten().collect::<Vec<_>>())
        }
        _ => false,
    }
}

/// The member of a uniform that a pointer is to, or into.
fn member(module: &Module, function: &Function, pointer: Handle<Expression>) -> Option<String> {
    let Expression::AccessIndex { base, index } = function.expressions[pointer] else { return None };
    let Expression::GlobalVariable(variable) = function.expressions[base] else {
        return member(module, function, base);
    };
    let variable = &module.global_variables[variable];
    let TypeInner::Struct { members, .. } = &module.types[variable.ty].inner else { return None };
    (variable.space == AddressSpace::Uniform).then(|| members[index as usize].name.clone().unwrap_or_default())
}

/// The values that branches and the ends of loops ask for, and who is called.
fn walk(block: &Block, asked: &mut Vec<Handle<Expression>>, called: &mut Vec<Handle<Function>>) {
    for statement in block {
        match statement {
            Statement::Block(block) => walk(block, asked, called),
            Statement::If { condition, accept, reject } => {
                asked.push(*condition);
                walk(accept, asked, called);
                walk(reject, asked, called);
            }
            Statement::Switch { selector, cases } => {
                asked.push(*selector);
                cases.iter().for_each(|case| walk(&case.body, asked, called));
            }
            Statement::Loop { body, continuing, break_if } => {
                asked.extend(break_if);
                walk(body, asked, called);
                walk(continuing, asked, called);
            }
            Statement::Call { function, .. } => called.push(*function),
            _ => {}
        }
    }
}

/// What branches of a shader, and of the functions that it calls, ask uniforms alone for: members, and the function where.
fn asked_of_uniforms(source: &str) -> BTreeSet<(String, String)> {
    let module = naga::front::wgsl::parse_str(source).expect("the build has parsed it");
    let (mut found, mut seen, mut next) = (BTreeSet::new(), BTreeSet::new(), Vec::new());
    let mut look = |function: &Function, next: &mut Vec<Handle<Function>>| {
        let mut asked = Vec::new();
        walk(&function.body, &mut asked, next);
        for value in asked {
            let mut members = BTreeSet::new();
            if is_uniform(&module, function, value, &mut members) {
                found.extend(members.into_iter().map(|name| (name, function.name.clone().unwrap_or_default())));
            }
        }
    };
    module.entry_points.iter().for_each(|entry| look(&entry.function, &mut next));
    while let Some(function) = next.pop() {
        if seen.insert(function) {
            look(&module.functions[function], &mut next);
        }
    }
    found
}

#[test]
fn no_branch_asks_uniforms_alone_for_what_changes_from_step_to_step() {
    let mut found = BTreeSet::new();
    for kernel in KERNELS {
        for source in kernel.variants.iter().flatten().chain([&kernel.source]) {
            let asked = asked_of_uniforms(source).into_iter();
            found.extend(
                asked.filter(|(member, _)| CHANGING.contains(&member.as_str())).map(|asked| (asked, kernel.name)),
            );
        }
    }
    assert!(found.is_empty(), "a member of a uniform, the function, the kernel: {found:?} (src/subdomain/registry.rs)");
}

#[test]
fn a_branch_that_asks_a_uniform_alone_is_seen() {
    let asked = |branch: &str| {
        let text = format!(
            "struct Step {{ slot: u32, low: vec3<u32> }}\n@group(0) @binding(0) var<uniform> step: Step;\n\
             @group(0) @binding(1) var<storage, read_write> words: array<u32>;\n\
             fn deeper(k: u32) {{ {branch} }}\n\
             @compute @workgroup_size(64)\nfn probe(@builtin(global_invocation_id) id: vec3<u32>) {{ deeper(id.x); }}\n"
        );
        asked_of_uniforms(&text).into_iter().map(|(member, _)| member).collect::<Vec<_>>()
    };
    assert_eq!(asked("if (step.slot + 1u > 2u) { words[k] = 0u; }"), ["slot"]);
    assert_eq!(asked("if (max(step.low.y, step.slot) > 2u && k > 1u) { words[k] = 0u; }"), ["low", "slot"]);
    assert_eq!(asked("for (var i = 0u; k < 3u; i++) { if (step.low.x == 1u) { break; } }"), ["low"]);
    let none: [&str; 0] = [];
    assert_eq!(asked("if (step.slot > k || words[k] < step.slot) { words[k] = step.slot; }"), none);
}
