//! Meshes of STL and OBJ: what is read, and what is refused with its line.

mod crossed;
mod forms;
mod parts;
mod solids;

use std::path::{Path, PathBuf};

use corpuscle::geometry::{GeometryError, Vessel};
use corpuscle::scene::{Scene, parse};
use tempfile::TempDir;

/// A corner of a box: which end of each axis.
const CORNERS: [[usize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
/// The faces of a box, counter-clockwise from outside: -z, +z, -y, +x, +y, -x.
const FACES: [[usize; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

/// The two triangles of each face of a box, normals outwards.
fn cube(min: [f64; 3], max: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
    let corner = |k: usize| std::array::from_fn(|axis| [min, max][CORNERS[k][axis]][axis]);
    FACES.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]].map(|t| t.map(corner))).collect()
}

fn turned(mut triangles: Vec<[[f64; 3]; 3]>) -> Vec<[[f64; 3]; 3]> {
    triangles.iter_mut().for_each(|t| t.swap(1, 2));
    triangles
}

/// A `solid` of an ASCII STL file.
fn solid(name: &str, triangles: &[[[f64; 3]; 3]]) -> String {
    let vertex = |c: &[f64; 3]| format!("   vertex {} {} {}\n", c[0], c[1], c[2]);
    let facet = |t: &[[f64; 3]; 3]| {
        let corners: String = t.iter().map(vertex).collect();
        format!(" facet normal 0 0 0\n  outer loop\n{corners}  endloop\n endfacet\n")
    };
    let facets: String = triangles.iter().map(facet).collect();
    format!("solid {name}\n{facets}endsolid {name}\n")
}

/// A box of 1 L as an OBJ file.
fn cube_obj() -> String {
    let vertex = |c: &[usize; 3]| format!("v {}\n", c.map(|end| ["0", "0.1"][end]).join(" "));
    let face = |f: &[usize; 4]| format!("f {}\n", f.map(|k| (k + 1).to_string()).join(" "));
    CORNERS.iter().map(vertex).chain(FACES.iter().map(face)).collect()
}

/// A folder with one mesh.
struct Mesh {
    folder: TempDir,
    name: String,
}

impl Mesh {
    fn new(name: &str, bytes: impl AsRef<[u8]>) -> Mesh {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(name), bytes).unwrap();
        Mesh { folder, name: name.into() }
    }

    /// A scene with the mesh as a vessel, or in a room of 1 L; `more` goes before the model.
    fn scene_text(&self, gas: &str, more: &str) -> String {
        let room =
            "[[wall]]\nname = \"room\"\nshape = \"box\"\nmin = [0, 0, 0]\nmax = [0.1, 0.1, 0.1]\ngas = \"inside\"\n";
        let room = if gas == "outside" { room } else { "" };
        format!(
            "end_time = 2e-4\n[[gas]]\nname = \"n2\"\nmolar_mass = 0.028\ngamma = 1.4\n{room}\
             [[wall]]\nname = \"v\"\nshape = \"mesh\"\nfile = \"{}\"\ngas = \"{gas}\"\n\
             [[chamber]]\nname = \"all\"\npressure = 1e5\ntemperature = 300\ngas = \"n2\"\n{more}\
             [model]\nparticles = 2000\nmethod = \"none\"\n[output]\nrows = 4\nsnapshots = 0\n",
            self.name
        )
    }

    fn scene(&self, gas: &str, more: &str) -> Scene {
        parse(&self.scene_text(gas, more), "test.toml", self.folder.path()).unwrap()
    }

    /// The scene as a file.
    fn scene_file(&self, gas: &str, more: &str) -> PathBuf {
        let path = self.folder.path().join("scene.toml");
        std::fs::write(&path, self.scene_text(gas, more)).unwrap();
        path
    }

    fn vessel(&self, gas: &str) -> Result<Vessel, GeometryError> {
        Vessel::build(&self.scene(gas, "").walls)
    }

    /// In litres.
    fn volume(&self, gas: &str) -> f64 {
        match self.vessel(gas) {
            Ok(vessel) => 1e3 * vessel.gas_volume(),
            Err(error) => panic!("{}: {error}", self.name),
        }
    }

    fn error(&self, gas: &str) -> String {
        self.vessel(gas).map(|vessel| vessel.gas_volume()).expect_err(&self.name).to_string()
    }
}

/// f32 coordinates round to 4e-8 of a length.
fn near(found: f64, expected: f64) -> bool {
    (found / expected - 1.0).abs() < 1e-6
}

/// A mesh that the repository has.
fn kept(name: &str) -> Mesh {
    let path = super::input(name);
    let file = Path::new(name).file_name().unwrap().to_string_lossy().into_owned();
    Mesh::new(&file, std::fs::read(path).unwrap())
}
