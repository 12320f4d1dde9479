//! The build refuses a broken shader and says where the fault is: in its own file, not in the joined source.

// The build script's `main` is the only thing this test does not call.
#[allow(dead_code)]
#[path = "../build.rs"]
mod build;

use std::path::Path;

const REGISTRY: build::Registry<'static> = build::Registry {
    numbers: &[&[("ONE", 1)]],
    buffers: &["values", "more"],
    stepped: "more",
    path: "src/subdomain/registry.rs",
};

const KERNEL: &str = "//! Doubles a value.\n//! uses: double.wgsl\n//! phase: advect\n\
    var<storage, read_write> values: array<u32>;\n\
    @compute @workgroup_size(64)\n\
    fn main(@builtin(global_invocation_id) id: vec3<u32>) {\n    values[id.x] = double(values[id.x]);\n}\n";
const DOUBLE: &str = "//! Shared arithmetic.\n//! uses: two.wgsl\nfn double(x: u32) -> u32 {\n    return TWO * x;\n}\n";
const TWO: &str = "const TWO = 2u;";

fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    std::fs::create_dir(dir.path().join("shared")).unwrap();
    for (name, text) in files {
        std::fs::write(dir.path().join(name), text).unwrap();
    }
    dir
}

fn error(files: &[(&str, &str)]) -> String {
    let dir = folder(files);
    match build::kernels(dir.path(), REGISTRY) {
        Ok(_) => panic!("accepted"),
        Err(message) => message.replace(&dir.path().display().to_string(), "shaders"),
    }
}

#[test]
fn a_kernel_holds_what_it_uses_once_and_before_it() {
    let dir = folder(&[
        ("advect.wgsl", &KERNEL.replace("double.wgsl", "double.wgsl two.wgsl")),
        ("shared/double.wgsl", DOUBLE),
        ("shared/two.wgsl", TWO),
        ("shared/idle.wgsl", TWO),
        ("notes.txt", "not a shader"),
    ]);
    let (kernels, unused) = build::kernels(dir.path(), REGISTRY).unwrap();
    assert_eq!(kernels.len(), 1);
    assert_eq!(kernels[0].name, "advect");
    let source = &kernels[0].source;
    assert_eq!(source.matches(TWO).count(), 1);
    assert!(source.find(TWO) < source.find("fn double") && source.find("fn double") < source.find("fn main"));
    assert_eq!(unused, [dir.path().join("shared/idle.wgsl")]);
    let values = build::Bound { index: 0, name: "values".into(), access: "ReadWrite", stepped: None };
    assert_eq!(kernels[0].bindings, [values]);
    let table = build::table(&kernels);
    let start = "pub static KERNELS: &[KernelSource] = &[\nKernelSource { name: \"advect\", entry_point: \"main\", \
        phases: &[\"advect\"], bindings: &[Binding { index: 0, name: \"values\", access: Access::ReadWrite, \
        stepped: None }, ], overrides: &[], source: \"const ONE: u32 = 1u;\\nconst TWO = 2u;\\n";
    assert!(table.starts_with(start), "{table}");
}

#[test]
fn without_shaders_the_table_is_empty() {
    let (kernels, unused) = build::kernels(Path::new("no/such/folder"), REGISTRY).unwrap();
    assert!(unused.is_empty());
    assert_eq!(build::table(&kernels), "pub static KERNELS: &[KernelSource] = &[\n];\n");
}

#[test]
fn a_fault_is_reported_with_its_own_file_and_line() {
    let in_shared = error(&[
        ("advect.wgsl", KERNEL),
        ("shared/double.wgsl", &DOUBLE.replace("TWO * x", "THREE * x")),
        ("shared/two.wgsl", TWO),
    ]);
    assert!(
        in_shared.contains("kernel shaders/advect.wgsl: no definition in scope for identifier: `THREE`"),
        "{in_shared}"
    );
    assert!(in_shared.contains("shaders/shared/double.wgsl:4:12"), "{in_shared}");
    assert!(in_shared.contains("    return THREE * x;\n               ^^^^^\n"), "{in_shared}");

    let in_kernel = error(&[
        ("advect.wgsl", &KERNEL.replace("double(values", "double(f32(1) + values")),
        ("shared/double.wgsl", DOUBLE),
        ("shared/two.wgsl", TWO),
    ]);
    assert!(in_kernel.contains("shaders/advect.wgsl:7:"), "{in_kernel}");
}

#[test]
fn what_parses_but_is_not_valid_is_refused() {
    let message = error(&[
        ("advect.wgsl", &KERNEL.replace("@workgroup_size(64)", "@workgroup_size(0)")),
        ("shared/double.wgsl", DOUBLE),
        ("shared/two.wgsl", TWO),
    ]);
    assert!(
        message.contains("error in kernel shaders/advect.wgsl") && message.to_lowercase().contains("workgroup"),
        "{message}"
    );
    // A capability that no adapter need have.
    let wide =
        error(&[("wide.wgsl", "@compute @workgroup_size(1)\nfn main() {\n    var x = 1.0lf;\n    x = x + x;\n}\n")]);
    assert!(wide.contains("shaders/wide.wgsl"), "{wide}");
    assert!(error(&[("empty.wgsl", "const A = 1;\n")]).contains("needs one entry point"));
}

#[test]
fn a_missing_shared_file_and_every_broken_kernel_are_named() {
    let message = error(&[("a.wgsl", KERNEL), ("b.wgsl", "fn main( {}\n")]);
    assert!(message.contains("shaders/a.wgsl:2: error: uses double.wgsl"), "{message}");
    assert!(message.contains("kernel shaders/b.wgsl"), "{message}");
}

#[test]
fn files_that_use_each_other_end() {
    let dir = folder(&[
        ("advect.wgsl", KERNEL),
        ("shared/double.wgsl", DOUBLE),
        ("shared/two.wgsl", &format!("//! uses: double.wgsl\n{TWO}")),
    ]);
    assert_eq!(build::kernels(dir.path(), REGISTRY).unwrap().0.len(), 1);
}

/// Another variant of a shared file makes another source of the kernels that use it, as valid as the first.
#[test]
fn a_variant_of_a_shared_file_makes_another_source() {
    let twice = DOUBLE.replace("TWO * x", "x + x");
    let second = |text: &str| {
        folder(&[
            ("advect.wgsl", KERNEL),
            ("bin.wgsl", &KERNEL.replace("double.wgsl", "two.wgsl").replace("double", "TWO * ")),
            ("shared/double.wgsl", DOUBLE),
            ("shared/double.software.wgsl", text),
            ("shared/two.wgsl", TWO),
        ])
    };
    let dir = second(&twice);
    let (kernels, unused) = build::kernels(dir.path(), REGISTRY).unwrap();
    assert!(unused.is_empty(), "{unused:?}");
    assert!(kernels[0].source.contains("TWO * x") && !kernels[0].source.contains("x + x"));
    let [for_software, for_gpus] = &kernels[0].variants;
    let for_software = for_software.as_ref().expect("another source");
    assert!(for_software.contains("x + x") && !for_software.contains("TWO * x"), "{for_software}");
    assert_eq!(for_gpus, &None, "there is no such form");
    assert_eq!(kernels[1].variants, [None, None], "it uses no file of which there are other variants");

    let kernel = error(&[("advect.software.wgsl", "fn main() {}\n")]);
    assert!(kernel.contains("shaders/advect.software.wgsl: error: only files of shared/ have variants"), "{kernel}");
    let broken = |text: &str| build::kernels(second(text).path(), REGISTRY).err().expect("an error");
    let named = broken(&twice.replace("x + x", "x + y"));
    assert!(named.contains("double.software.wgsl:4:"), "{named}");
    let bound = "var<storage, read_write> more: array<u32>;\n".to_owned();
    let other = broken(&(bound + &twice.replace("x + x", "x + more[0]")));
    assert!(other.contains("other bindings or constants"), "{other}");
}

/// A buffer has the binding number of its place in the registry, whatever a shader calls it.
#[test]
fn buffers_are_bound_by_the_registry() {
    let kernel = |head: &str, declared: &str| {
        format!("{head}{declared}@compute @workgroup_size(1)\nfn main() {{\n    sums[0] = ONE;\n}}\n")
    };
    let declared = "var<storage, read_write> sums: array<u32>;\n";
    let dir = folder(&[("tally.wgsl", &kernel("//! binds: more as sums\n", declared))]);
    let (kernels, _) = build::kernels(dir.path(), REGISTRY).unwrap();
    let bound = build::Bound { index: 1, name: "more".into(), access: "ReadWrite", stepped: Some(4) };
    assert_eq!(kernels[0].bindings, [bound]);
    assert!(kernels[0].source.contains("@group(0) @binding(1) var<storage, read_write> sums"));
    let unknown = error(&[("tally.wgsl", &kernel("", declared))]);
    assert_eq!(unknown, "shaders/tally.wgsl:1: error: no buffer sums in src/subdomain/registry.rs");
    let numbered = error(&[("tally.wgsl", &kernel("", &format!("@group(0) @binding(1) {declared}")))]);
    assert!(numbered.starts_with("shaders/tally.wgsl:1: error: binding numbers are those of"), "{numbered}");
    let wrong = error(&[("tally.wgsl", &kernel("//! binds: more = sums\n", declared))]);
    assert_eq!(wrong, "shaders/tally.wgsl:1: error: found 'binds: more = sums', allowed: BUFFER as NAME");
}

/// The kernels that only a bench compiles are as valid as the step's.
#[test]
fn the_kernels_of_the_benches_are_valid() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/kernels");
    let mut found = 0;
    for entry in std::fs::read_dir(&folder).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        let module = naga::front::wgsl::parse_str(&text)
            .unwrap_or_else(|error| panic!("{}: {}", path.display(), error.emit_to_string(&text)));
        let mut validator = naga::valid::Validator::new(naga::valid::ValidationFlags::all(), build::CAPABILITIES);
        validator.validate(&module).unwrap_or_else(|error| panic!("{}: {error:?}", path.display()));
        found += module.entry_points.len();
    }
    assert!(found >= 6);
}

const PICTURE: &str = "//! Draws triangles.\n//! uses: view.wgsl\n//! binds: items as corners\n\
    var<storage, read> corners: array<vec4<f32>>;\n\
    @vertex\nfn vertex(@builtin(vertex_index) k: u32) -> @builtin(position) vec4<f32> {\n    return view * corners[k];\n}\n\
    @fragment\nfn fragment() -> @location(0) vec4<f32> {\n    return vec4<f32>(1.0);\n}\n";
const VIEW: &str = "var<uniform> view: mat4x4<f32>;\n";

/// Shaders of pictures are joined and checked like kernels, and have the two entry points.
#[test]
fn shaders_of_pictures_are_checked() {
    let found = |text: &str| {
        let dir = folder(&[("surface.wgsl", text), ("shared/view.wgsl", VIEW), ("shared/idle.wgsl", VIEW)]);
        let place = dir.path().display().to_string();
        build::render::shaders(dir.path())
            .map(|(shaders, unused)| (shaders, unused.len()))
            .map_err(|message| message.replace(&place, "render"))
    };
    let refused = |text: &str| found(text).map(|_| ()).unwrap_err();
    let (shaders, unused) = found(PICTURE).unwrap();
    assert_eq!((shaders.len(), shaders[0].name.as_str(), unused), (1, "surface", 1));
    assert!(shaders[0].source.contains("@group(0) @binding(0) var<uniform> view"));
    assert!(shaders[0].source.contains("@group(0) @binding(1) var<storage, read> corners"));
    assert!(build::render::table(&shaders).contains("RenderSource { name: \"surface\", source: "));
    let unknown = refused(&PICTURE.replace("view * corners", "views * corners"));
    assert!(unknown.contains("render/surface.wgsl:7:12: unknown identifier"), "{unknown}");
    let alone = refused(&PICTURE.replace("fn fragment", "fn paint"));
    assert!(alone.contains("needs an @fragment fn fragment"), "{alone}");
    let unbound = refused(&PICTURE.replace("items as corners", "things as corners"));
    assert!(unbound.contains("no buffer things in build/render.rs"), "{unbound}");
}
