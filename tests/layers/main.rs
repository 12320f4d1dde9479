//! Laws: a module of `src` imports only modules of layers below its own, a room of `simulation` only rooms below it, and no
//! files import each other in a circle.
//!
//! `cli -> study -> simulation -> subdomain, fabric, partition, ranks, output -> gpu, plan -> gas, geometry
//! -> scene`; besides, `gpu`, `partition` and `ranks` import no module of ours.

mod imports;

use std::path::Path;

use imports::Imports;

/// From the top down; modules of one layer do not import each other.
const LAYERS: &[&[&str]] = &[
    &["cli"],
    &["study"],
    &["simulation"],
    &["subdomain", "fabric", "partition", "ranks", "output"],
    &["gpu", "plan"],
    &["gas", "geometry"],
    &["scene"],
];

/// Those of `simulation`, likewise; its errors and the state of a run are files of their own among them.
const ROOMS: &[&[&str]] = &[
    &["timeloop"],
    &["coupling"],
    &["refine"],
    &["run_state"],
    &["zero_d"],
    &["parallel"],
    &["error"],
    &["accounting"],
    &["control"],
    &["model"],
];

/// Modules that stand on their own.
const ALONE: &[&str] = &["gpu", "partition", "ranks"];

fn level(levels: &[&[&str]], name: &str) -> Option<usize> {
    levels.iter().position(|names| names.contains(&name))
}

/// The part of a path at a depth, without the ending of a file.
fn part(path: &str, depth: usize) -> &str {
    path.split('/').nth(depth).map_or("", |part| part.trim_end_matches(".rs"))
}

/// What is wrong with the imports between the parts at `depth` of the files below `within`.
fn violations(imports: &Imports, within: &str, depth: usize, levels: &[&[&str]]) -> Vec<String> {
    let mut wrong = Vec::new();
    let known = |file: &String| file.starts_with(within) && !["lib", "main", "mod"].contains(&part(file, depth));
    for (file, from) in imports.files.iter().zip(&imports.from).filter(|(file, _)| known(file)) {
        let own = part(file, depth);
        let Some(at) = level(levels, own) else {
            wrong.push(format!("{file}: `{own}` is in no layer"));
            continue;
        };
        for (&other, names) in from {
            let other = &imports.files[other];
            let below = level(levels, part(other, depth)) > Some(at) && !ALONE.contains(&own);
            if other.starts_with(within) && part(other, depth) != own && !below {
                wrong.push(format!("{file} imports {names:?} of {other}"));
            }
        }
    }
    wrong
}

/// Each circle with the imports that make it.
fn circles(imports: &Imports) -> Vec<String> {
    let told = |circle: &Vec<usize>| {
        let within = |&file: &usize| {
            let from = imports.from[file].iter().filter(|(other, _)| circle.contains(other));
            from.map(move |(&other, names)| {
                format!("  {}: {names:?} of {}\n", imports.files[file], imports.files[other])
            })
        };
        circle.iter().flat_map(within).collect::<String>()
    };
    imports.circles().iter().map(told).collect()
}

#[test]
fn imports_point_down_and_in_no_circle() {
    let imports = Imports::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    let seen: usize = imports.from.iter().map(|from| from.len()).sum();
    assert!(seen > 1000, "only {seen} imports were seen: the search has gone blind");
    let mut wrong = violations(&imports, "", 0, LAYERS);
    wrong.extend(violations(&imports, "simulation/", 1, ROOMS));
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    let circles = circles(&imports);
    assert!(circles.is_empty(), "files that import each other in a circle:\n{}", circles.join("\n"));
}

fn of(files: &[(&str, &str)]) -> Imports {
    let texts: Vec<(String, String)> = files.iter().map(|&(path, text)| (path.into(), text.into())).collect();
    Imports::of(&texts)
}

/// The check can fail: each way to write an upward or sideways import is found, and no other.
#[test]
fn a_violation_is_found() {
    let wrong = |path: &str, text: &str| {
        let plan = ("plan/mod.rs", "mod text;\npub use text::table;\npub struct Plan;\npub fn plan() {}");
        let text_of_plan = ("plan/text.rs", "pub fn table() {}");
        let others = [("gas/mod.rs", "pub struct Gas;"), ("scene/mod.rs", "pub struct Scene;"), plan, text_of_plan];
        violations(&of(&[&[(path, text)], &others[..]].concat()), "", 0, LAYERS).len()
    };
    assert_eq!(wrong("gas/x.rs", "use crate::plan::Plan;"), 1);
    assert_eq!(wrong("gas/x.rs", "fn f(x: &crate::plan::Plan) {}"), 1);
    assert_eq!(wrong("gas/x.rs", "fn f() { format!(\"{}\", crate::plan::table()); }"), 1);
    assert_eq!(wrong("gas/x.rs", "use super::super::plan;\nfn f() { plan::plan() }"), 1);
    assert_eq!(wrong("geometry/x.rs", "use crate::{gas::Gas, scene::Scene};"), 1);
    assert_eq!(wrong("gpu/x.rs", "use crate::scene::Scene;"), 1);
    assert_eq!(wrong("toolbox/x.rs", ""), 1);
    // Downward, within the module, in a comment, in a test, or a name of its own.
    assert_eq!(wrong("plan/x.rs", "use crate::gas::Gas;\nuse super::text::table;\n// see crate::cli::Arguments"), 0);
    assert_eq!(wrong("gas/x.rs", "#[cfg(test)]\nmod tests { use crate::plan::Plan; }"), 0);
    assert_eq!(wrong("gas/x.rs", "mod plan { pub struct Plan; }\nuse plan::Plan;"), 0);
}

/// A name that is passed on leads to the file behind it: a folder's `mod.rs` that only passes on is in no circle.
#[test]
fn a_circle_is_found() {
    let a = ("gas/a.rs", "use super::B;\npub struct A;");
    let passes = ("gas/mod.rs", "mod a;\nmod b;\npub use a::A;\npub use b::B;");
    assert_eq!(circles(&of(&[a, ("gas/b.rs", "pub struct B;"), passes])), [""; 0]);
    for back in ["use super::A;\npub struct B;", "pub struct B(crate::gas::A);", "use super::a;\npub type B = a::A;"] {
        assert_eq!(circles(&of(&[a, ("gas/b.rs", back), passes])).len(), 1, "{back}");
    }
    let own = ("gas/mod.rs", "mod a;\npub struct B;\nfn f(_: a::A) {}");
    assert_eq!(circles(&of(&[a, own])).len(), 1, "a `mod.rs` with items of its own counts");
    let long =
        [("gas/c.rs", "pub use crate::gas::d::D;\npub struct C(D);"), ("gas/d.rs", "pub struct D(super::e::E);")];
    let end = [("gas/e.rs", "pub struct E(super::c::C);"), ("gas/mod.rs", "mod c;\nmod d;\nmod e;")];
    let circle = circles(&of(&[long, end].concat()));
    assert!(circle.len() == 1 && circle[0].matches(" of ").count() == 3, "{circle:?}");
}
