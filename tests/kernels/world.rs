//! Walls on a grid, for kernels to run among.

use corpuscle::geometry::{Grid, TriangleGrid, Vessel};
use corpuscle::scene::{GasSide, Shape, SurfaceModel, Wall};
use corpuscle::subdomain::{GpuParticle, Walls};

use crate::oracle::cells::Cells;
use crate::oracle::random::Stream;
use crate::oracle::vector::Vector;
use crate::oracle::walls::Triangle;

/// Cell classes of `shaders/shared/grid.wgsl`.
pub const CLEAR: u32 = 0;
pub const CUT: u32 = 2;
pub const SOLID: u32 = 3;

/// Walls on a grid. Positions in f64 are in metres from the grid's corner.
pub struct World {
    pub grid: Grid,
    pub walls: Walls,
    pub triangles: Vec<Triangle>,
    /// Corners of the box around the walls, m from the grid's corner.
    pub low: Vector,
    pub high: Vector,
}

pub fn wall(shape: Shape, gas: GasSide) -> Wall {
    Wall { name: "wall".into(), shape, gas, surface: SurfaceModel::default(), parts: Vec::new() }
}

/// A box of gas from the origin.
pub fn tank(size: Vector) -> Wall {
    wall(Shape::Box { min: [0.0; 3], max: size, thickness: None, holes: vec![] }, GasSide::Inside)
}

impl World {
    pub fn new(walls: &[Wall], cell: f64) -> World {
        let vessel = Vessel::build(walls).expect("closed walls");
        let (low, high) = vessel.bounds;
        let grid = Grid::around(low, high, cell).expect("a grid");
        let fixed = TriangleGrid::build(&vessel, &grid, Walls::tolerance(&grid)).expect("triangles on the grid");
        let metres = |corner: [i32; 3]| corner.map(|q| f64::from(q) * grid.quantum());
        let triangles = fixed.triangles.iter().map(|t| t.corners.map(metres)).collect();
        let from_corner = |p: Vector| std::array::from_fn(|k| p[k] - grid.origin[k]);
        let patch: Vec<u32> = (0..vessel.triangles.len() as u32).map(|k| k % 3).collect();
        World {
            walls: Walls::new(&fixed, &grid, &patch, &[], |_| true),
            triangles,
            low: from_corner(low),
            high: from_corner(high),
            grid,
        }
    }

    /// A tank of 6 x 7 x 8 cells.
    pub fn plain() -> World {
        World::new(&[tank([0.06, 0.07, 0.08])], 0.01)
    }

    pub fn cells(&self) -> Cells {
        Cells {
            counts: self.grid.cells,
            bits: self.grid.cell_bits,
            quanta_per_metre: (1.0 / self.grid.quantum()) as f32,
        }
    }

    /// Whether a triangle is listed in one of the 27 cells around.
    pub fn near_triangle(&self, cell: u32) -> bool {
        let [nx, ny, nz] = self.grid.cells.map(|n| n as i64);
        let (x, y, z) = (i64::from(cell) % nx, i64::from(cell) / nx % ny, i64::from(cell) / (nx * ny));
        (0..27i64).any(|k| {
            let (x, y, z) = (x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1);
            let inside = (0..nx).contains(&x) && (0..ny).contains(&y) && (0..nz).contains(&z);
            inside && self.has_triangle(((z * ny + y) * nx + x) as u32)
        })
    }

    /// Whether a triangle is listed in the cell.
    pub fn has_triangle(&self, cell: u32) -> bool {
        self.class(cell) == CUT
    }

    pub fn class(&self, cell: u32) -> u32 {
        self.walls.class[cell as usize / 16][0] >> (2 * (cell % 16)) & 3
    }

    /// Whether a flight may meet a wall: it leaves the cells around its own, or these have walls and it does not stay before their plane.
    pub fn may_hit(&self, particle: &GpuParticle, start: f32, dt: f32) -> bool {
        let cells = self.cells();
        let ends = [start, dt].map(|t| cells.shifted(particle.position, particle.velocity, t));
        let fastest = particle.velocity.iter().fold(0.0f32, |most, v| most.max(v.abs()));
        if fastest * (dt - start) * cells.quanta_per_metre >= (1u32 << cells.bits) as f32 {
            return true;
        }
        let place = cells.cell(ends[0]);
        let cell = cells.index(place);
        match self.class(cell) {
            CLEAR => false,
            SOLID => true,
            _ => {
                let first = cell / 16 * 16;
                let near = (first..cell).filter(|&before| ![CLEAR, SOLID].contains(&self.class(before))).count();
                let entry = self.walls.start[self.walls.class[first as usize / 16][1] as usize + near];
                // One plane, or the number of the entries with several.
                let planes = match entry[1].to_le_bytes() {
                    [a, b, c, 0x80] => {
                        let at = u32::from_le_bytes([a, b, c, 0]) as usize;
                        self.walls.start[at..at + 2].as_flattened().to_vec()
                    }
                    _ => vec![entry[1]],
                };
                let size = f64::from(1u32 << cells.bits);
                let from_middle = |p: [u32; 3]| -> Vector {
                    std::array::from_fn(|k| Cells::signed(p[k]) as f64 / size - f64::from(place[k]) - 0.5)
                };
                let [from, to] = ends.map(from_middle);
                let before = |plane: &u32| {
                    let [x, y, z, least] = plane.to_le_bytes().map(|byte| f64::from(byte as i8));
                    let along = |p: Vector| x * p[0] + y * p[1] + z * p[2];
                    along(from).min(along(to)) > corpuscle::geometry::CLEARANCE_UNIT * least
                };
                from.iter().any(|d| d.abs() > 0.5) || !planes.iter().all(before)
            }
        }
    }

    pub fn metres(&self, p: [u32; 3]) -> Vector {
        p.map(|q| Cells::signed(q) as f64 * self.grid.quantum())
    }

    pub fn fixed(&self, p: Vector) -> [u32; 3] {
        p.map(|x| (x / self.grid.quantum()).round() as i64 as u32)
    }

    /// Uniform in the box around the walls.
    pub fn place(&self, stream: &mut Stream) -> [u32; 3] {
        let at: Vector = std::array::from_fn(|k| stream.between(self.low[k], self.high[k]));
        self.fixed(at)
    }

    /// `count` particles of random tags (ids all different, two gases), uniform, with normal velocities of this
    /// many m/s per axis.
    pub fn particles(&self, stream: &mut Stream, count: usize, speed: f64) -> Vec<GpuParticle> {
        let mut ids: Vec<u32> = (0..2 * count as u32).collect();
        stream.shuffle(&mut ids);
        ids.truncate(count);
        ids.iter()
            .map(|&id| GpuParticle {
                position: self.place(stream),
                tag: GpuParticle::tag((stream.word() & 1) as u8, id),
                velocity: stream.normals().map(|v| (v * speed) as f32),
                spin: stream.half_chi_square(2) as f32 * (speed * speed) as f32,
            })
            .collect()
    }
}
