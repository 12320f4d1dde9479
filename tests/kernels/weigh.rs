//! `weigh`: the histograms of a tree of cuts, exactly.

use corpuscle::subdomain::{GpuStep, GpuWeights};

use crate::local::Local;
use crate::oracle::random::Stream;
use crate::rig::*;

const COUNT: usize = 2000;
/// So heavy that the low words carry.
const WEIGHTS: GpuWeights =
    GpuWeights { particle: 400_000_000, candidate: 30_000_001, wall: 70_000_003, sheet: 40_000_007, cuts: 0 };

/// Each own particle adds its weight to the plane of its cell in the open box that holds it; ghosts and particles of
/// boxes that are not to be cut add nothing.
#[test]
fn histograms_are_the_sums_over_planes_of_the_open_boxes() {
    let world = World::plain();
    // Of ghosts in the one layer of cells around some are two links away.
    let local = Local { depth: 2, ..Local::new(&world) };
    let mut stream = Stream::new(54);
    let all = local.cells();
    let cells: Vec<[u32; 3]> = (0..COUNT).map(|_| all[stream.below(all.len() as u32) as usize]).collect();
    let bins: Vec<u32> = cells.iter().filter_map(|&cell| local.bin(cell)).collect();
    let listed: Vec<u32> = (0..COUNT).map(|_| stream.below(20)).collect();
    let mut layer_and_marks = |cell: [u32; 3]| {
        let layer = if local.own.holds(cell) { 0 } else { 1 + stream.below(2) };
        layer | [0, NEAR, SHARED | NEAR, LISTED][stream.below(4) as usize]
    };
    // Triangles of fabric in the list of a cell.
    let sheets_at = |[x, y, z]: [u32; 3]| if (x + y) % 3 == 1 { 1 + z % 4 } else { 0 };
    let (fabric_cells, fabric_entries) = fabric(&world, sheets_at);
    let layers: Vec<u32> = cells.iter().map(|&cell| layer_and_marks(cell)).collect();
    // x at 4: below it z is to be cut; above it y at 3: a part below, an open box to cut along x above.
    let cuts: [[u32; 4]; 5] = [[0, 4, 1, 2], [3, 2, 1, 0], [1, 3, 3, 4], [4, 7, 0, 0], [3, 0, 4, 20]];
    let planes = 24;
    let mut expected = vec![0u64; planes];
    for s in (0..COUNT).filter(|&s| layers[s] & 0xff == 0) {
        let [x, y, z] = cells[s];
        let plane = match (x < 4, y < 3) {
            (true, _) => z - 1,
            (false, true) => continue,
            (false, false) => 20 + x - 4,
        };
        let wall = if layers[s] & NEAR != 0 { WEIGHTS.wall } else { 0 };
        expected[plane as usize] += u64::from(WEIGHTS.particle)
            + u64::from(WEIGHTS.candidate * listed[s] + wall)
            + u64::from(WEIGHTS.sheet * sheets_at(cells[s]));
    }
    let rig = |weights: GpuWeights| {
        let mut rig = Rig::new(&world);
        rig.put("cells", &bins);
        rig.put("marks", &layers);
        rig.put("neighbour_count", &listed);
        rig.put("cuts", &cuts);
        rig.constant("FABRIC", 1.0);
        rig.put("fabric_cells", &fabric_cells);
        rig.put("fabric_entries", &fabric_entries);
        rig.put("histogram", &vec![0u32; 2 * planes]);
        rig.uniform("weights", &[weights]);
        rig.step(GpuStep { count: COUNT as u32, ..local.step() });
        rig.run("weigh", COUNT + 64);
        rig
    };
    let sums = |rig: &Rig| -> Vec<u64> {
        rig.get::<[u32; 2]>("histogram", planes).iter().map(|w| u64::from(w[0]) | u64::from(w[1]) << 32).collect()
    };
    let found = rig(GpuWeights { cuts: cuts.len() as u32, ..WEIGHTS });
    assert_eq!(sums(&found), expected);
    assert_eq!(found.counter(CANDIDATES), 0);
    // The check can fail: sums carry, and planes differ.
    assert!(expected.iter().filter(|&&sum| sum > 1 << 33).count() > 3, "{expected:?}");
    // Without cuts the entries of all lists are counted, but those of the outermost ghosts, who do not choose, and nothing else.
    let chosen_from = |s: usize| if layers[s] & 0xff < local.depth { listed[s] } else { 0 };
    let counted = rig(GpuWeights { cuts: 0, ..WEIGHTS });
    assert_eq!(counted.counter(CANDIDATES), (0..COUNT).map(chosen_from).sum::<u32>());
    let ghosts = || (0..COUNT).filter(|&s| layers[s] & 0xff != 0);
    let walls = ghosts().filter(|&s| layers[s] & NEAR != 0).count();
    assert_eq!(counted.counter(GHOST_CANDIDATES), ghosts().map(chosen_from).sum::<u32>());
    assert_eq!(counted.counter(GHOST_WALLS) as usize, walls);
    let sheets = |s: usize| sheets_at(cells[s]);
    assert_eq!(counted.counter(SHEETS), (0..COUNT).map(sheets).sum::<u32>());
    assert_eq!(counted.counter(GHOST_SHEETS), ghosts().map(sheets).sum::<u32>());
    assert!(walls > 100 && ghosts().count() < COUNT - 100);
    assert_eq!(sums(&counted), vec![0; planes]);
}

/// `fabric_cells` and `fabric_entries` with so many triangles in the list of each cell.
fn fabric(world: &World, sheets_at: impl Fn([u32; 3]) -> u32) -> (Vec<u32>, Vec<[u32; 4]>) {
    let [width, height, depth] = world.grid.cells;
    let (mut entries, mut records) = (Vec::new(), Vec::new());
    let mut words = vec![0, 0];
    for cell in 0..width * height * depth {
        let place = [cell % width, cell / width % height, cell / (width * height)];
        let mut first = 0;
        for triangle in 0..sheets_at(place) {
            entries.push([triangle, first, 0, 0]);
            first = entries.len() as u32;
        }
        if first > 0 {
            records.push([0, 0, first, cell]);
        }
        words.push(if first > 0 { records.len() as u32 } else { 0 });
    }
    words.extend(vec![0; words.len().div_ceil(32)]);
    records.resize(entries.len(), [0; 4]);
    (words, [entries, records].concat())
}
