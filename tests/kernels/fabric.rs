//! `list_fabric`: a triangle is in the list of each cell that any point of it comes to in the step, and the cells around know.

use corpuscle::subdomain::{GpuSheet, GpuStep};

use crate::oracle::random::Stream;
use crate::oracle::vector::Vector;
use crate::rig::*;

const NODES: usize = 60;
const TRIANGLES: usize = 80;
/// m.
const GAP: f64 = 1e-7;
/// Points of a triangle that are looked at, along each of its sides and in time.
const PARTS: u32 = 12;

struct Swept {
    rig: Rig,
    world: World,
    /// At the start and at the end, quanta.
    nodes: [Vec<[u32; 3]>; 2],
    triangles: Vec<[u32; 3]>,
}

fn swept(seed: u32) -> Swept {
    let world = World::plain();
    let mut stream = Stream::new(seed);
    let before: Vec<[u32; 3]> = (0..NODES).map(|_| world.place(&mut stream)).collect();
    let moved = |place: &[u32; 3], stream: &mut Stream| {
        let way: Vector = std::array::from_fn(|_| stream.between(-0.008, 0.008));
        world.fixed(std::array::from_fn(|axis| world.metres(*place)[axis] + way[axis]))
    };
    let after = before.iter().map(|place| moved(place, &mut stream)).collect::<Vec<_>>();
    let mut node = || stream.word() % NODES as u32;
    let triangles: Vec<[u32; 3]> = (0..TRIANGLES).map(|_| [node(), node(), node()]).collect();
    let mut rig = Rig::new(&world);
    let four = |places: &[[u32; 3]]| places.iter().map(|p| [p[0], p[1], p[2], 0]).collect::<Vec<_>>();
    // Of the third step of an interval.
    let none = vec![[0u32; 4]; 2 * NODES];
    rig.put("nodes", &[none, four(&before), four(&after)].concat());
    let sheets: Vec<GpuSheet> =
        triangles.iter().map(|&[a, b, c]| GpuSheet { a, b, c, ..GpuSheet::default() }).collect();
    rig.put("fabric", &sheets);
    rig.put("fabric_planes", &vec![0f32; 4 * TRIANGLES]);
    rig.constant("FABRIC", 1.0);
    rig.constant("NODES", NODES as f64);
    rig.constant("SHEET_GAP", GAP);
    rig.step(GpuStep { count: 1, dt: 1e-5, slot: 2, ..GpuStep::default() });
    Swept { rig, world, nodes: [before, after], triangles }
}

/// Words before the entries, and the cells of the grid.
fn sizes(world: &World) -> (usize, usize) {
    let cells = world.grid.cell_count();
    (1 + cells + cells.div_ceil(32), cells)
}

fn listed(swept: &mut Swept, room: usize) -> Vec<u32> {
    let words = sizes(&swept.world).0 + 2 * room;
    swept.rig.put("fabric_cells", &vec![0u32; words]);
    swept.rig.run("list_fabric", TRIANGLES);
    swept.rig.get("fabric_cells", words)
}

/// The triangles in the list of a cell.
fn list(words: &[u32], before: usize, cell: usize) -> Vec<u32> {
    let mut found = Vec::new();
    let mut next = words[1 + cell] as usize;
    while next != 0 {
        let place = before + 2 * (next - 1);
        found.push(words[place]);
        next = words[place + 1] as usize;
    }
    found
}

/// Cells that points of a triangle come to, and cells that its box touches.
fn passed(swept: &Swept, triangle: [u32; 3]) -> Vec<usize> {
    let cells = swept.world.cells();
    let mut found = Vec::new();
    for (i, j, t) in (0..=PARTS).flat_map(|i| (0..=PARTS - i).flat_map(move |j| (0..=PARTS).map(move |t| (i, j, t)))) {
        let [u, v, t] = [i, j, t].map(|k| f64::from(k) / f64::from(PARTS));
        let corner = |k: usize| -> Vector {
            let [a, b] = [0, 1].map(|end| swept.world.metres(swept.nodes[end][triangle[k] as usize]));
            std::array::from_fn(|axis| a[axis] + t * (b[axis] - a[axis]))
        };
        let [a, b, c] = [0, 1, 2].map(corner);
        let point = std::array::from_fn(|axis| a[axis] + u * (b[axis] - a[axis]) + v * (c[axis] - a[axis]));
        found.push(cells.index(cells.cell(swept.world.fixed(point))) as usize);
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[test]
fn triangles_are_listed_wherever_they_come_to() {
    for seed in 1..4 {
        let mut swept = swept(seed);
        let words = listed(&mut swept, 40_000);
        let (before, cells) = sizes(&swept.world);
        let entries = words[0] as usize;
        let lists: Vec<Vec<u32>> = (0..cells).map(|cell| list(&words, before, cell)).collect();
        assert_eq!(lists.iter().map(Vec::len).sum::<usize>(), entries);
        assert!(entries > 4 * TRIANGLES && entries < TRIANGLES * cells / 2, "{entries} entries");
        let is_near = |cell: usize| words[1 + cells + cell / 32] >> (cell % 32) & 1 == 1;
        let counts = swept.world.grid.cells.map(|n| n as usize);
        for (number, &triangle) in (0u32..).zip(&swept.triangles) {
            for cell in passed(&swept, triangle) {
                assert!(lists[cell].contains(&number), "seed {seed}: triangle {number} is not in cell {cell}");
                let at = [cell % counts[0], cell / counts[0] % counts[1], cell / (counts[0] * counts[1])];
                for k in 0..27 {
                    let near: [usize; 3] = [at[0] + k % 3, at[1] + k / 3 % 3, at[2] + k / 9];
                    if (0..3).all(|axis| near[axis] >= 1 && near[axis] <= counts[axis]) {
                        let index = ((near[2] - 1) * counts[1] + near[1] - 1) * counts[0] + near[0] - 1;
                        assert!(is_near(index), "seed {seed}: cell {index} does not know of cell {cell}");
                    }
                }
            }
        }
        // The check can fail: some cell has no triangle, and each triangle is in few.
        assert!(lists.iter().any(Vec::is_empty));
        assert_eq!(swept.rig.counter(MISPLACED), 0);
    }
}

/// Entries without room are counted, and none is written behind the end.
#[test]
fn entries_without_room_are_counted() {
    let mut swept = swept(5);
    let all = listed(&mut swept, 40_000)[0];
    let words = listed(&mut swept, 100);
    assert_eq!(words[0], all);
    // A buffer has whole sixteens of bytes.
    let before = sizes(&swept.world).0;
    let room = ((before + 200).next_multiple_of(4) - before) / 2;
    assert_eq!(swept.rig.counter(MISPLACED) as usize, all as usize - room);
}
