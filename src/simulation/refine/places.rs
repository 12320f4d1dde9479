//! Where children are: each flies from its parent by a random displacement, off walls as particles fly.
//!
//! The displacement is uniform in a cube of the parent's share of the volume, so that even gas becomes even gas without
//! holes or heaps. Mirrored at walls, and not refused there, the children of an even gas are even up to the wall. A path
//! that ends in another chamber (through a hole) or in no gas is sampled again, the later tries nearer to the parent.

use glam::DVec3;

use crate::gas::{Draws, Purpose};
use crate::geometry::{CellClass, GeometryError, TriangleGrid, block_volumes, region_contains};
use crate::simulation::model::build::Model;
use crate::subdomain::{GpuParticle, Walls};

const TRIES: i32 = 12;
/// Tries at full length; each later one is half as long as that before.
const FULL_TRIES: i32 = 6;
const MOST_BOUNCES: u32 = 16;
/// A block with less gas than this share of its volume does not tell a density.
const LEAST_VOLUME: f64 = 0.05;
/// How far beyond its edges a triangle is still hit, as a share of its size: neighbours leave no crack.
const EDGE: f64 = 1e-9;

struct Facet {
    corner: DVec3,
    edges: [DVec3; 2],
    /// Into the gas.
    normal: DVec3,
}

/// The space of the parents.
pub struct Places<'a> {
    parent: &'a Model,
    walls: TriangleGrid,
    /// Of the triangles of `walls`; one without area is never hit.
    facets: Vec<Facet>,
    /// How far behind a wall a parent may be by rounding, m.
    tolerance: f64,
    /// Edge of the cube of a particle's share of the volume in each coarse block, m.
    shares: Vec<f64>,
}

impl<'a> Places<'a> {
    pub fn new(parent: &'a Model, parents: &[GpuParticle]) -> Result<Places<'a>, GeometryError> {
        let Model { vessel, plan, .. } = parent;
        let tolerance = Walls::tolerance(&plan.grid);
        let vertex = |index: u32| DVec3::from(vessel.vertices[index as usize]);
        let facets = vessel.triangles.iter().map(|triangle| {
            let [a, b, c] = triangle.vertices.map(vertex);
            Facet { corner: a, edges: [b - a, c - a], normal: (b - a).cross(c - a).normalize_or_zero() }
        });
        let walls =
            TriangleGrid::build(vessel, &plan.grid, tolerance).map_err(|error| error.told_in(parent.scene.units))?;
        let mut places = Places { parent, walls, facets: facets.collect(), tolerance, shares: Vec::new() };
        places.shares = places.measure(parents);
        Ok(places)
    }

    fn measure(&self, parents: &[GpuParticle]) -> Vec<f64> {
        let Model { vessel, plan, .. } = self.parent;
        let volumes = block_volumes(vessel, &plan.grid, plan.block_cells_log2);
        let mut numbers = vec![0u64; volumes.len()];
        for parent in parents {
            numbers[self.block(parent)] += 1;
        }
        let full = (plan.grid.cell * f64::from(1u32 << plan.block_cells_log2)).powi(3);
        let everywhere = vessel.gas_volume() / parents.len().max(1) as f64;
        let share = |(volume, number): (f64, u64)| {
            let known = volume > LEAST_VOLUME * full && number > 0;
            libm::cbrt(if known { volume / number as f64 } else { everywhere })
        };
        volumes.into_iter().zip(numbers).map(share).collect()
    }

    fn block(&self, particle: &GpuParticle) -> usize {
        let plan = &self.parent.plan;
        let [nx, ny, _] = plan.grid.blocks(plan.block_cells_log2).map(|n| n as usize);
        let [x, y, z] = self.cell(particle.position).map(|c| (c >> plan.block_cells_log2) as usize);
        (z * ny + y) * nx + x
    }

    /// The nearest cell that may hold gas.
    fn cell(&self, position: [u32; 3]) -> [u32; 3] {
        let grid = &self.parent.plan.grid;
        let cell = grid.cell_of(position);
        std::array::from_fn(|axis| cell[axis].clamp(1, grid.cells[axis] - 2))
    }

    pub fn metres(&self, parent: &GpuParticle) -> [f64; 3] {
        self.parent.plan.grid.to_metres(parent.position)
    }

    /// The chamber that a point belongs to if it is gas; their number where none has it.
    pub fn chamber(&self, point: [f64; 3]) -> usize {
        let chambers = &self.parent.scene.chambers;
        let holds = |chamber: &crate::scene::Chamber| chamber.region.as_ref().is_none_or(|r| region_contains(r, point));
        chambers.iter().position(holds).unwrap_or(chambers.len())
    }

    /// A place for a child, m; `None` if none was found.
    pub fn draw(&self, parent: &GpuParticle, seed: u64, id: u32) -> Option<[f64; 3]> {
        let from = self.metres(parent);
        let (edge, home) = (self.shares[self.block(parent)], self.chamber(from));
        let class = self.walls.class[self.parent.plan.grid.cell_index(self.cell(parent.position))];
        let free = class == CellClass::Clear && 0.5 * edge <= self.parent.plan.grid.cell;
        let mut draws = Draws::new(seed, Purpose::RefinedPosition, id);
        for attempt in 0..TRIES {
            let length = edge * 0.5f64.powi((attempt + 1 - FULL_TRIES).max(0));
            let displacement = DVec3::from([(); 3].map(|()| length * (draws.uniform() - 0.5)));
            let end = if free { Some(DVec3::from(from) + displacement) } else { self.fly(from.into(), displacement) };
            let Some(end) = end.map(|end| end.to_array()) else { continue };
            if (free || self.parent.vessel.is_gas(end)) && self.chamber(end) == home {
                return Some(end);
            }
        }
        None
    }

    /// The end of a path that walls reflect.
    fn fly(&self, mut from: DVec3, mut left: DVec3) -> Option<DVec3> {
        for _ in 0..MOST_BOUNCES {
            let Some((share, normal)) = self.first_hit(from, left) else { return Some(from + left) };
            from += share * left;
            left *= 1.0 - share;
            left -= 2.0 * left.dot(normal) * normal;
        }
        None
    }

    /// The share of the path before its first wall, and the wall's normal.
    fn first_hit(&self, from: DVec3, path: DVec3) -> Option<(f64, DVec3)> {
        let grid = &self.parent.plan.grid;
        let (low, high) = (from.min(from + path), from.max(from + path));
        let cell = |place: DVec3, axis: usize| {
            let cells = (place[axis] - grid.origin[axis]) / grid.cell;
            (cells.max(0.0) as u32).min(grid.cells[axis] - 1)
        };
        let range = |axis: usize| cell(low, axis)..=cell(high, axis);
        let mut first: Option<(f64, DVec3)> = None;
        for z in range(2) {
            for y in range(1) {
                for x in range(0) {
                    for &k in self.walls.in_cell(grid.cell_index([x, y, z])) {
                        let facet = &self.facets[k as usize];
                        if let Some(share) = facet.hit(from, path, self.tolerance)
                            && first.is_none_or(|(best, _)| share < best)
                        {
                            first = Some((share, facet.normal));
                        }
                    }
                }
            }
        }
        first
    }
}

impl Facet {
    /// The share of a path out of the gas after which it hits; zero where it starts behind by the tolerance.
    fn hit(&self, from: DVec3, path: DVec3, tolerance: f64) -> Option<f64> {
        let speed = -path.dot(self.normal);
        let height = (from - self.corner).dot(self.normal);
        if speed <= 0.0 || height > speed || height < -2.0 * tolerance {
            return None;
        }
        let place = from + height / speed * path - self.corner;
        let [a, b] = self.edges;
        let area = a.cross(b).dot(self.normal);
        let (u, v) = (place.cross(b).dot(self.normal) / area, a.cross(place).dot(self.normal) / area);
        (u >= -EDGE && v >= -EDGE && u + v <= 1.0 + EDGE).then(|| (height / speed).max(0.0))
    }
}
