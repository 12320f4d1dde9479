//! Fabric, resolved: surfaces with gas on both sides that rest, go where a file says, or are elastic membranes.

use std::path::{Path, PathBuf};

use super::course::Course;
use super::face::Face;
use super::region::Region;
use super::surface_model::{SurfaceModel, SurfacePart};

/// A surface that deforms. Its files are in absolute paths; metres = file units x `scale`.
#[derive(Debug, Clone, PartialEq)]
pub struct Fabric {
    pub name: String,
    /// STL or OBJ, by extension: the surface at the start.
    pub mesh: PathBuf,
    pub scale: f64,
    /// Where its nodes are over time, of a membrane those that are held. Without either its nodes rest.
    pub motion: Option<PathBuf>,
    /// It turns as a whole, of a membrane the nodes that are held; then it has no file of its motion.
    pub turn: Option<Turn>,
    /// The gas moves it.
    pub membrane: Option<Membrane>,
    /// What both of its sides do to the gas that hits them, but those of its `surface_parts`.
    pub surface: SurfaceModel,
    /// Each part of its mesh at most once.
    pub surface_parts: Vec<SurfacePart>,
    /// The names of those of its mesh's parts that the scene names: `Face::Part` counts in it.
    pub parts: Vec<String>,
    /// Pa, the same everywhere outside of closed fabric, where no gas is then.
    pub external_pressure: Option<f64>,
}

/// A turn about an axis at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Turn {
    /// A unit vector; the turn is counter-clockwise seen from where it points to.
    pub axis: [f64; 3],
    /// On the axis, m.
    pub center: [f64; 3],
    /// Radians in place of m.
    pub course: Course,
}

/// An elastic surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Membrane {
    pub material: FabricMaterial,
    /// STL or OBJ with the same triangles as the mesh, free of stress; the mesh itself if there is none.
    pub reference: Option<PathBuf>,
    pub fixed: Fixed,
    /// Lengths of the reference over those of its file at the start, and when they are as in the file, s; `None`: they stay.
    pub reference_scale: f64,
    pub reference_time: Option<f64>,
    /// Beside that of the material, kg/m2 of the reference as it is in its file.
    pub added_mass: f64,
    /// Coulomb's coefficient on walls.
    pub wall_friction: f64,
}

/// What a membrane is of, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FabricMaterial {
    /// m.
    pub thickness: f64,
    /// kg/m3.
    pub density: f64,
    pub elasticity: Elasticity,
    /// Share of the critical damping of the shortest waves, 0 to 1, where the fabric is taut.
    pub damping: f64,
}

/// Plane stress; moduli in Pa. `fibre` is the direction of the warp, in space: in each triangle its part along the stress-free
/// triangle counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Elasticity {
    Isotropic {
        young: f64,
        poisson: f64,
    },
    /// `young` along the warp and the weft; `poisson` is the contraction along the weft of a pull along the warp, and its square is
    /// less than the ratio of the first modulus to the second.
    Orthotropic {
        young: [f64; 2],
        poisson: f64,
        shear: f64,
        fibre: [f64; 3],
    },
    /// Warp and weft do not know of each other.
    Woven {
        young: [f64; 2],
        shear: f64,
        fibre: [f64; 3],
    },
}

/// The nodes of a membrane that are held: at rest, or where its motion takes them.
#[derive(Debug, Clone, PartialEq)]
pub enum Fixed {
    Nothing,
    /// Those of edges that have one triangle.
    Edge,
    /// Those in one of these regions, m.
    Within(Vec<Region>),
}

impl Fabric {
    /// As scenes write a part of its mesh.
    pub fn face_name(&self, face: Face) -> String {
        face.name(&self.parts)
    }

    /// The files that a run keeps copies of: its mesh, the file of its motion, its reference. (Of a series of files no copy is kept: what
    /// it names would not be with it.)
    pub fn files(&self) -> impl Iterator<Item = &PathBuf> {
        let motion = self.motion.as_ref().filter(|path| is_one_file(path));
        let reference = self.membrane.as_ref().and_then(|membrane| membrane.reference.as_ref());
        std::iter::once(&self.mesh).chain(motion).chain(reference)
    }

    /// The same.
    pub fn files_mut(&mut self) -> impl Iterator<Item = &mut PathBuf> {
        let motion = self.motion.as_mut().filter(|path| is_one_file(path));
        let reference = self.membrane.as_mut().and_then(|membrane| membrane.reference.as_mut());
        std::iter::once(&mut self.mesh).chain(motion).chain(reference)
    }
}

/// The keys of [`Fabric::files`] in a scene file, in their order.
pub const FABRIC_FILES: [&str; 3] = ["file", "motion", "reference"];

/// Whether a file of a fabric stands for itself, and does not name others.
pub fn is_one_file(path: &Path) -> bool {
    !path.extension().is_some_and(|ending| ending == "pvd" || ending == "series")
}
