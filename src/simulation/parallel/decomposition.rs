//! Which rank owns which cells, and where a rank's particles start.
//!
//! Boxes of cells come from recursive coordinate bisection. Without collisions no particle needs to know of
//! another, so the particles are dealt out by their ids, nothing is exchanged and there is nothing to balance.

use super::exchange::Exchange;
use super::halo_tuner::Halo;
use crate::geometry::Grid;
use crate::gpu::Device;
use crate::partition::{Bisection, CellBox, IntegerWeights, Node, TOLERANCE, Tree, bisect, bisect_shared};
use crate::plan::Plan;
use crate::ranks::Communicator;
use crate::simulation::error::SimulationError;
use crate::subdomain::{Cells, GpuParticle, Subdomain, SubdomainBox, box_bits};

/// Layers of cells beyond the halo from which a particle may come in a step. One that flew farther is
/// found by its owner of the step before, and the interval is run again with everyone as a peer.
const FLIGHT: u32 = 6;

/// Layers of cells beyond the halo in which triangles of fabric are listed. A flight that comes farther is found by its owner, and the interval is
/// run again with triangles listed in all cells.
const FABRIC: u32 = 8;

pub struct Decomposition {
    /// Of boxes of cells, or of tiles.
    tree: Tree,
    /// Cells per edge, log2, of what its boxes are made of.
    bits: u32,
    rank: usize,
    halo: Halo,
    /// Layers of cells beyond the halo in which fabric is listed.
    fabric: u32,
    /// Everyone is a peer, and fabric is listed in all cells.
    wide: bool,
    /// The particles may be with anyone.
    scattered: bool,
}

impl Decomposition {
    /// Equal boxes, or boxes of equal weight of particles, of which each rank gives a part. Collective: the histograms
    /// are summed over the ranks.
    ///
    /// # Errors
    /// If there are more ranks than cells, or another rank fails.
    pub fn new(
        plan: &Plan,
        comm: &dyn Communicator,
        halo: Halo,
        particles: Option<&[GpuParticle]>,
    ) -> Result<Decomposition, SimulationError> {
        let (root, shares) = (root(plan), vec![1.0; comm.size()]);
        let tree = match particles {
            None => bisect(root, &shares, None, std::iter::empty())?,
            Some(part) => {
                let cells: Vec<[u32; 3]> = part.iter().map(|particle| cell_of(plan, particle)).collect();
                bisect_shared(root, &shares, &cells, |own| Ok::<_, SimulationError>(comm.sum(own)?))?
            }
        };
        let (bits, rank) = (box_bits(plan.method), comm.rank());
        Ok(Decomposition { tree, bits, rank, halo, fabric: FABRIC, wide: false, scattered: true })
    }

    /// With fabric listed in no more than the halo.
    #[must_use]
    pub fn with_fabric_nearby(self) -> Decomposition {
        Decomposition { fabric: 0, ..self }
    }

    /// The rank that starts with a particle: the owner of its cell. (The first exchange decides by the cell of its
    /// mid-step position.)
    pub fn owner(&self, plan: &Plan, particle: &GpuParticle) -> usize {
        self.tree.part_of(cell_of(plan, particle))
    }

    /// The ranks that this one exchanges particles with, those that share ghosts with it first, and its place
    /// among them.
    pub fn place(&self) -> (Vec<usize>, SubdomainBox) {
        let boxes = self.tree.boxes();
        let own = boxes[self.rank];
        let gap = |rank: &usize| boxes[*rank].gap(&own);
        let everyone = self.wide || self.scattered;
        let others = (0..boxes.len()).filter(|&rank| rank != self.rank);
        let mut peers: Vec<usize> =
            others.filter(|rank| everyone || gap(rank) << self.bits < self.depth() + FLIGHT).collect();
        peers.sort_by_key(|rank| (gap(rank) >= self.depth(), *rank));
        let near = peers.iter().filter(|rank| gap(rank) < self.depth()).count();
        let cells = |extent: &CellBox| Cells {
            low: extent.low.map(|at| at << self.bits),
            high: extent.high.map(|at| at << self.bits),
        };
        let place = SubdomainBox {
            own: cells(&own),
            depth: self.depth(),
            ghosts: self.halo.ghosts,
            peers: peers.iter().map(|&rank| cells(&boxes[rank])).collect(),
            near,
            flight: if self.depth() == 0 || peers.len() + 1 == boxes.len() { 0 } else { FLIGHT },
            fabric: if self.wide { None } else { Some(self.depth() + self.fabric) },
            scattered: self.scattered,
            tiled: self.bits > 0,
        };
        (peers, place)
    }

    /// Low and high corner of each rank's box, m.
    pub fn boxes(&self, grid: &Grid) -> Vec<[[f64; 3]; 2]> {
        let corner = |at: [u32; 3]| {
            std::array::from_fn(|a| grid.origin[a] + f64::from((at[a] << self.bits).min(grid.cells[a])) * grid.cell)
        };
        self.tree.boxes().iter().map(|extent| [corner(extent.low), corner(extent.high)]).collect()
    }

    /// Puts the subdomain and its exchange where the tree says.
    ///
    /// # Errors
    /// If the device has no memory for the cells.
    pub fn apply(
        &self,
        device: &Device,
        subdomain: &mut Subdomain,
        exchange: &mut Exchange<'_>,
    ) -> Result<(), SimulationError> {
        let (peers, place) = self.place();
        exchange.set_peers(peers, place.near);
        Ok(subdomain.move_to(device, place)?)
    }

    /// How the halo is kept from now on; true if that is a change.
    pub fn set_halo(&mut self, halo: Halo) -> bool {
        std::mem::replace(&mut self.halo, halo) != halo
    }

    /// Layers of cells.
    fn depth(&self) -> u32 {
        2 * self.halo.rounds
    }

    /// From now on particles may be with anyone, until the exchange of a step has brought them home.
    pub fn scatter(&mut self) {
        self.scattered = true;
    }

    pub fn is_scattered(&self) -> bool {
        self.scattered
    }

    /// The exchange of a step has brought all particles to their owners; true if that was needed.
    pub fn home(&mut self) -> bool {
        std::mem::take(&mut self.scattered)
    }

    /// Particles fly farther than thought: everyone is a peer, and fabric is listed in all cells, until these are shared out anew.
    pub fn widen(&mut self) {
        self.wide = true;
    }

    /// A tree from outside.
    pub fn replace(&mut self, tree: Tree) {
        self.tree = tree;
        self.wide = false;
        self.scatter();
    }

    /// The weight of the particles and cells that each rank owns by the tree, where the last step had them. Collective.
    ///
    /// # Errors
    /// If a device or another rank fails.
    pub fn weights(&self, histogram: &mut Histogram<'_>, weights: IntegerWeights) -> Result<Vec<u64>, SimulationError> {
        // Planes across the first axis, box after box.
        let mut starts = vec![0];
        for extent in self.tree.boxes() {
            starts.push(starts[starts.len() - 1] + extent.length(0) as usize);
        }
        let entry = |node: &Node| match *node {
            Node::Cut { axis, plane, low, high } => [axis as u32, plane, low as u32, high as u32],
            Node::Part(part) | Node::Open(part) => [3, 0, self.tree.boxes()[part].low[0], starts[part] as u32],
        };
        let cuts: Vec<[u32; 4]> = self.tree.nodes().iter().map(entry).collect();
        let planes = histogram.sum(weights, &cuts, starts[starts.len() - 1])?;
        let weight = |(bounds, extent): (&[usize], &CellBox)| {
            planes[bounds[0]..bounds[1]].iter().sum::<u64>()
                + u64::from(weights.cell << (3 * self.bits)) * extent.cells()
        };
        Ok(starts.windows(2).zip(self.tree.boxes()).map(weight).collect())
    }

    /// Cuts anew so that each rank has its share of the weights that the devices measured where the last step
    /// had its particles. Old cuts stay where balance allows; whether any has moved. Collective; the histograms are summed
    /// over the ranks, so that all find the same cuts.
    ///
    /// # Errors
    /// If a device or another rank fails.
    pub fn rebalance(
        &mut self,
        histogram: &mut Histogram<'_>,
        weights: IntegerWeights,
        shares: &[f64],
    ) -> Result<bool, SimulationError> {
        let mut bisection = Bisection::new(self.tree.root(), shares, Some(&self.tree), TOLERANCE)?;
        while !bisection.wanted().is_empty() {
            let cuts = cuts_of(bisection.partial_tree(), &bisection);
            let mut planes = histogram.sum(weights, &cuts, bisection.planes())?;
            bisection.add_cells(weights.cell << (3 * self.bits), &mut planes);
            bisection.cut(&planes)?;
        }
        let tree = bisection.finish()?;
        let moves = tree != self.tree;
        if moves {
            self.replace(tree);
        }
        Ok(moves)
    }
}

/// Weights over planes of cells, of the particles that all ranks own.
pub struct Histogram<'a> {
    pub device: &'a Device,
    pub subdomain: &'a mut Subdomain,
    pub comm: &'a dyn Communicator,
}

impl Histogram<'_> {
    /// Of so many planes, by these cuts. (The host knows how many cells there are.) Collective.
    fn sum(&mut self, weights: IntegerWeights, cuts: &[[u32; 4]], planes: usize) -> Result<Vec<u64>, SimulationError> {
        let of_particles = [weights.particle, weights.candidate, weights.wall, weights.sheet];
        let own = self.subdomain.histogram(self.device, of_particles, cuts, planes)?;
        Ok(self.comm.sum(own)?)
    }
}

/// The cells that particles can be in, or the tiles of such cells.
pub fn root(plan: &Plan) -> CellBox {
    let Cells { low, high } = Cells::inside(plan);
    let bits = box_bits(plan.method);
    CellBox { low: low.map(|at| at >> bits), high: high.map(|at| at >> bits) }
}

/// The cell of a particle's position, moved into the root as `nearest_cell` of the shaders does, or its tile.
fn cell_of(plan: &Plan, particle: &GpuParticle) -> [u32; 3] {
    std::array::from_fn(|axis| {
        let cell = (particle.position[axis] >> plan.grid.cell_bits).clamp(1, plan.grid.cells[axis] - 2);
        cell >> box_bits(plan.method)
    })
}

/// The tree so far, as `shaders/weigh.wgsl` reads it.
fn cuts_of(nodes: &[Node], bisection: &Bisection) -> Vec<[u32; 4]> {
    let entry = |node: &Node| match *node {
        Node::Cut { axis, plane, low, high } => [axis as u32, plane, low as u32, high as u32],
        Node::Part(part) => [4, part as u32, 0, 0],
        Node::Open(slice) => {
            let slice = bisection.wanted()[slice];
            [3, slice.axis as u32, slice.extent.low[slice.axis], slice.offset as u32]
        }
    };
    nodes.iter().map(entry).collect()
}
