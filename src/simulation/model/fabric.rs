//! The surfaces that deform: their triangles, where their nodes are at a time, and what is inside of them.
//!
//! Places of nodes are a function of the clock, made on the host in f64: the same on any number of ranks, and nothing that a
//! checkpoint must remember. In a step each node has one velocity, that which takes it from its place at the start to that at the end.

use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;

use super::error::ModelError;
use super::fabric_obstacles::Bodies;
use super::fabric_paths::{Path, read};
use super::membranes::Membranes;
use super::plane::Plane;
use crate::geometry::{Bag, GeometryError, Grid, Vessel};
use crate::scene::{Chamber, Scene};
use crate::subdomain::{Fabric, GpuSheet};

/// A mirror.
const NOBODY: u32 = u32::MAX;
/// Moments of a run at which edges and volumes are measured, beside those of the frames.
const MOMENTS: u32 = 64;
/// Frames of a run at which they are measured, at most.
const MOST_FRAMES: usize = 4096;
/// How far an edge of elastic fabric is thought to stretch at most.
const STRETCHED: f64 = 1.25;
/// Places of nodes that are kept of a surface to find what parts it from others, at most.
const MOST_POINTS: usize = 1 << 20;

/// Where all nodes are at a time, s, in m.
type Places = dyn Fn(f64) -> Vec<[f64; 3]> + Send + Sync;

/// One surface of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    pub name: String,
    /// Its triangles are a stretch of all.
    pub triangles: Range<usize>,
    /// It encloses a space; its triangles are counter-clockwise seen from outside.
    pub closed: bool,
    /// The gas moves it.
    pub elastic: bool,
    /// The part of the mesh that each of its triangles is of, by its place among the names.
    pub parts: Vec<Option<u32>>,
    pub names: Vec<String>,
}

/// How the nodes of all surfaces move.
#[derive(Clone)]
pub struct Course {
    pub places: Arc<Places>,
    /// When the velocities of nodes change, s; empty of nodes that rest.
    pub bends: Vec<f64>,
    /// m/s.
    pub fastest: f64,
}

/// All surfaces that deform.
#[derive(Clone, Default)]
pub struct Surfaces {
    pub all: Vec<Surface>,
    pub triangles: Vec<[u32; 3]>,
    course: Option<Course>,
    /// Times in order at which surfaces are measured, s.
    pub moments: Vec<f64>,
    longest_edge: f64,
    /// The corners of what each sweeps in the run, m; of elastic ones, of what they are at the start.
    swept: Vec<[DVec3; 2]>,
    /// Whether each turns as a whole.
    turns: Vec<bool>,
    /// The planes between each closed one and the other closed ones.
    pub planes: Vec<Vec<Plane>>,
    /// Of elastic ones, whose nodes move by forces: where they are only a run knows.
    pub membranes: Option<Membranes>,
    /// What is doubtful of the files.
    pub notes: Vec<String>,
    /// Of tests: makes a mistake in what the device knows, to show that they find it.
    pub mistaken: Option<fn(&mut Fabric)>,
}

impl Surfaces {
    /// Of a run that ends at a time, s.
    pub fn new(all: Vec<Surface>, triangles: Vec<[u32; 3]>, course: Course, end: f64) -> Surfaces {
        let even = (0..=MOMENTS).map(|k| end * f64::from(k) / f64::from(MOMENTS));
        let within = course.bends.iter().copied().filter(|&time| 0.0 < time && time < end).take(MOST_FRAMES);
        let mut moments: Vec<f64> = if course.bends.is_empty() { vec![0.0] } else { even.chain(within).collect() };
        moments.sort_by(f64::total_cmp);
        moments.dedup();
        let mut longest_edge: f64 = 0.0;
        let mut swept = vec![[DVec3::INFINITY, DVec3::NEG_INFINITY]; all.len()];
        for (k, &moment) in moments.iter().enumerate() {
            let nodes: Vec<DVec3> = (course.places)(moment).into_iter().map(DVec3::from).collect();
            let edge = |[a, b]: [u32; 2]| nodes[a as usize].distance(nodes[b as usize]);
            // (Of elastic ones but the start is known.)
            for (swept, surface) in swept.iter_mut().zip(&all).filter(|(_, surface)| k == 0 || !surface.elastic) {
                let own = &triangles[surface.triangles.clone()];
                let corners = own.iter().flatten().map(|&node| nodes[node as usize]);
                *swept = corners.fold(*swept, |[low, high], corner| [low.min(corner), high.max(corner)]);
                let edges = own.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).map(edge);
                let stretch = if surface.elastic { STRETCHED } else { 1.0 };
                longest_edge = edges.fold(longest_edge, |longest, edge| longest.max(stretch * edge));
            }
        }
        Surfaces {
            turns: vec![false; all.len()],
            planes: vec![Vec::new(); all.len()],
            all,
            triangles,
            course: Some(course),
            moments,
            longest_edge,
            swept,
            membranes: None,
            notes: Vec::new(),
            mistaken: None,
        }
    }

    /// Whether forces move some.
    pub fn is_elastic(&self) -> bool {
        self.membranes.is_some()
    }

    /// The triangles of a surface, and its nodes.
    pub fn parts(&self, surface: usize) -> (Range<usize>, Range<usize>) {
        let triangles = self.all[surface].triangles.clone();
        let nodes = || self.triangles[triangles.clone()].iter().flatten().map(|&node| node as usize);
        let nodes = nodes().min().unwrap_or(0)..nodes().max().map_or(0, |last| last + 1);
        (triangles, nodes)
    }

    /// Those of a scene; their files are read here.
    ///
    /// # Errors
    /// If a file cannot be read, is of another mesh, or has nodes that jump.
    pub fn of(scene: &Scene, vessel: &Vessel) -> Result<Surfaces, ModelError> {
        if scene.fabrics.is_empty() {
            return Ok(Surfaces::default());
        }
        let (mut all, mut triangles, mut paths, mut notes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let mut first_node = 0;
        let mut membranes = Membranes::new();
        refuse_gas_outside(scene)?;
        let is_elastic = scene.fabrics.iter().any(|fabric| fabric.membrane.is_some());
        for fabric in &scene.fabrics {
            let read = read(fabric, scene.units)?;
            if is_elastic {
                membranes.add(fabric, &read.mesh)?;
            }
            notes.extend(read.notes);
            let first = triangles.len();
            triangles.extend(read.mesh.triangles.iter().map(|corners| corners.map(|node| node + first_node)));
            first_node += read.mesh.nodes.len() as u32;
            all.push(Surface {
                name: fabric.name.clone(),
                triangles: first..triangles.len(),
                closed: read.mesh.is_closed(),
                elastic: fabric.membrane.is_some(),
                parts: read.mesh.parts,
                names: read.mesh.names,
            });
            paths.push(read.path);
        }
        let mut bends: Vec<f64> = paths.iter().flat_map(Path::bends).collect();
        bends.sort_by(f64::total_cmp);
        bends.dedup();
        let fastest = paths.iter().map(Path::fastest).fold(0.0, f64::max);
        let arcs: Vec<Option<[DVec3; 2]>> = paths.iter().map(|path| path.arcs(scene.end_time)).collect();
        let places = move |time: f64| -> Vec<[f64; 3]> { paths.iter().flat_map(|own| own.at(time)).collect() };
        if is_elastic {
            membranes.bodies = Bodies::of(scene, vessel, membranes.thickest, &places(0.0));
            notes.extend(membranes.bodies.notes());
        }
        let course = Course { places: Arc::new(places), bends, fastest };
        let mut surfaces = Surfaces {
            notes,
            membranes: is_elastic.then_some(membranes),
            ..Surfaces::new(all, triangles, course, scene.end_time)
        };
        for (index, arcs) in arcs.into_iter().enumerate().filter(|(index, _)| !surfaces.all[*index].elastic) {
            // (Moments know but places on them.)
            surfaces.turns[index] = arcs.is_some();
            surfaces.swept[index] = arcs.unwrap_or(surfaces.swept[index]);
        }
        Ok(surfaces)
    }

    pub fn is_empty(&self) -> bool {
        self.course.is_none()
    }

    /// The speed of the fastest node, m/s.
    pub fn fastest(&self) -> f64 {
        self.course.as_ref().map_or(0.0, |course| course.fastest)
    }

    /// m.
    pub fn places(&self, time: f64) -> Vec<[f64; 3]> {
        self.course.as_ref().map_or_else(Vec::new, |course| (course.places)(time))
    }

    /// The corners of a box and of all that the surfaces sweep, m.
    pub fn bounds(&self, (low, high): ([f64; 3], [f64; 3])) -> ([f64; 3], [f64; 3]) {
        let (low, high) = self
            .swept
            .iter()
            .fold((DVec3::from(low), DVec3::from(high)), |(low, high), own| (low.min(own[0]), high.max(own[1])));
        (low.to_array(), high.to_array())
    }

    /// The corners of what one of them sweeps in the run, m; without end of an elastic one.
    pub fn swept(&self, index: usize) -> ([f64; 3], [f64; 3]) {
        if self.all[index].elastic {
            return ([f64::NEG_INFINITY; 3], [f64::INFINITY; 3]);
        }
        (self.swept[index][0].to_array(), self.swept[index][1].to_array())
    }

    /// A closed surface that has come over a plane between it and another, with its nodes at these places, m.
    pub fn over_a_plane(&self, nodes: &[[f64; 3]]) -> Option<usize> {
        let is_over = |&index: &usize| {
            self.planes[index].iter().any(|plane| {
                let beyond =
                    |node: &[f64; 3]| (DVec3::from(*node) - DVec3::from(plane.point)).dot(plane.normal.into()) > 0.0;
                nodes[self.parts(index).1].iter().any(beyond)
            })
        };
        (0..self.all.len()).find(is_over)
    }

    /// Points whose convex hull holds all that a surface is at in the run, of an elastic one at the start, m.
    pub fn hull(&self, index: usize) -> Vec<DVec3> {
        let [low, high] = self.swept[index];
        let (_, nodes) = self.parts(index);
        if self.all[index].elastic {
            return self.places(0.0)[nodes].iter().copied().map(DVec3::from).collect();
        }
        // (Moments know but places on arcs.)
        if self.turns[index] || nodes.len() * self.moments.len() > MOST_POINTS {
            let corner = |k: u32| std::array::from_fn(|axis| if k >> axis & 1 == 0 { low[axis] } else { high[axis] });
            return (0..8).map(|k| DVec3::from_array(corner(k))).collect();
        }
        self.moments.iter().flat_map(|&moment| self.places(moment)[nodes.clone()].to_vec()).map(DVec3::from).collect()
    }

    /// What the device knows of them; their works are tallied behind those of so many walls that move, the sides of each, the outer
    /// and the inner, behind so many patches of walls.
    /// `models` are those of each triangle ([`SurfaceModels::of_sheet`](super::surface_models::SurfaceModels)), empty if all are mirrors.
    pub fn for_device(&self, grid: &Grid, motions: usize, patches: usize, models: &[u32]) -> Fabric {
        let mut sheets = Vec::with_capacity(self.triangles.len());
        for (index, surface) in self.all.iter().enumerate() {
            let own = surface.triangles.clone().map(|triangle| (triangle, self.triangles[triangle]));
            sheets.extend(own.map(|(triangle, [a, b, c])| GpuSheet {
                a,
                b,
                c,
                closed: u32::from(surface.closed),
                surface: (patches + 2 * index) as u32,
                surface_model: models.get(triangle).copied().unwrap_or(NOBODY),
                work: (motions + index) as u32,
                recoil: 0.0,
            }));
        }
        let nodes = self.places(0.0);
        let elastic = self.is_elastic().then(|| {
            let corner = |node: u32| DVec3::from(nodes[node as usize]);
            let edges = self.triangles.iter().map(|&[a, b, c]| {
                let [a, b, c] = [a, b, c].map(corner);
                a.distance(b).max(b.distance(c)).max(c.distance(a))
            });
            // Of a box as large as the edge stretched, and what it flies in a step.
            edges.map(|edge| (((STRETCHED * edge + grid.cell) / grid.cell).ceil() as u64 + 1).pow(3)).sum()
        });
        let mut fabric = Fabric { nodes: nodes.len(), sheets, gap: Fabric::gap_of(grid, self.longest_edge), elastic };
        if let Some(mistaken) = self.mistaken {
            mistaken(&mut fabric);
        }
        fabric
    }

    /// The velocities of nodes beside or in elastic fabric that follow a course, in each of the steps of an interval, m/s; nothing without such nodes.
    pub fn led_velocities(&self, start: f64, dt: f64, steps: u32) -> Vec<[f64; 3]> {
        if !self.membranes.as_ref().is_some_and(Membranes::is_led) {
            return Vec::new();
        }
        let mut before = self.places(start);
        let mut all = Vec::with_capacity(steps as usize * before.len());
        for k in 1..=steps {
            let after = self.places(start + f64::from(k) * dt);
            let velocity =
                |(from, to): (&[f64; 3], &[f64; 3])| std::array::from_fn(|axis| (to[axis] - from[axis]) / dt);
            all.extend(before.iter().zip(&after).map(velocity));
            before = after;
        }
        all
    }

    /// Where the nodes are at the start of each of the steps of an interval and at the end of the last, quanta.
    pub fn steps(&self, grid: &Grid, start: f64, dt: f64, steps: u32) -> Vec<[u32; 4]> {
        let quanta = |place: f64, axis: usize| ((place - grid.origin[axis]) / grid.quantum()).round() as i64 as u32;
        let moments = if self.is_empty() || self.is_elastic() { 0 } else { steps + 1 };
        let nodes = (0..moments).flat_map(|k| self.places(start + f64::from(k) * dt));
        nodes.map(|place| [quanta(place[0], 0), quanta(place[1], 1), quanta(place[2], 2), 0]).collect()
    }

    /// What chambers and probes gain where surfaces enclose so much more, m3: bags gain it, and the chamber around them loses it.
    pub fn gained(scene: &Scene, grown: &[f64]) -> Vec<f64> {
        let inside: f64 = scene.chambers.iter().filter_map(|chamber| chamber.inside).map(|bag| grown[bag]).sum();
        let of = |chamber: &Chamber| chamber.inside.map_or(-inside, |bag| grown[bag]);
        scene.chambers.iter().map(of).chain(scene.probes.iter().map(|_| 0.0)).collect()
    }

    /// The volume that each surface encloses at a time, m3 (of an open one it has no meaning), and its area, m2.
    pub fn measures(&self, time: f64) -> Vec<[f64; 2]> {
        self.measures_of(&self.places(time))
    }

    /// The same of nodes at these places, m.
    pub fn measures_of(&self, nodes: &[[f64; 3]]) -> Vec<[f64; 2]> {
        let corner = |node: u32| DVec3::from(nodes[node as usize]);
        let of = |surface: &Surface| {
            let own = &self.triangles[surface.triangles.clone()];
            // Seen from one of its nodes, so that a surface far from the origin loses no digits.
            let origin = own.first().map_or(DVec3::ZERO, |triangle| corner(triangle[0]));
            let [six_volumes, two_areas] = own.iter().fold([0.0, 0.0], |[volume, area], &[a, b, c]| {
                let [a, b, c] = [a, b, c].map(|node| corner(node) - origin);
                [volume + a.dot(b.cross(c)), area + (b - a).cross(c - a).length()]
            });
            [six_volumes / 6.0, 0.5 * two_areas]
        };
        self.all.iter().map(of).collect()
    }

    /// The closed surfaces at a time, s; none in place of an open one.
    ///
    /// # Errors
    /// If one is not closed after all.
    pub fn bags(&self, time: f64) -> Result<Vec<Option<Bag>>, GeometryError> {
        self.bags_of(&self.places(time))
    }

    /// The same of nodes at these places, m.
    ///
    /// # Errors
    /// If one is not closed after all.
    pub fn bags_of(&self, nodes: &[[f64; 3]]) -> Result<Vec<Option<Bag>>, GeometryError> {
        let bag = |surface: &Surface| {
            let own = &self.triangles[surface.triangles.clone()];
            Bag::new(nodes, own, &format!("fabric `{}`", surface.name))
        };
        self.all.iter().map(|surface| Ok(if surface.closed { Some(bag(surface)?) } else { None })).collect()
    }
}

/// Where a pressure is given in place of gas there is none.
fn refuse_gas_outside(scene: &Scene) -> Result<(), ModelError> {
    let pressed = scene.fabrics.iter().find(|fabric| fabric.external_pressure.is_some());
    let around = scene.chambers.iter().find(|chamber| chamber.inside.is_none());
    if let (Some(fabric), Some(chamber)) = (pressed, around) {
        let problem = format!(
            "it has an `external_pressure`, and around it is the gas of chamber \"{}\": leave out one",
            chamber.name
        );
        return Err(ModelError::Fabric { fabric: fabric.name.clone(), problem });
    }
    Ok(())
}
