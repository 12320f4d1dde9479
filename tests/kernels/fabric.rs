//! `list_fabric` and `bound_fabric`: a triangle is in the list of each cell that any point of it comes to in the step, that point is between the
//! planes of the cell, and the cells around know.

use corpuscle::subdomain::{GpuSheet, GpuStep};

use crate::oracle::random::Stream;
use crate::oracle::vector::Vector;
use crate::rig::*;

const NODES: usize = 60;
const TRIANGLES: usize = 80;
/// m.
const GAP: f64 = 1e-7;
/// Where the cells begin in `fabric_cells`.
const FIRST: usize = 2;
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
    rig.put("fabric_swept", &vec![0u32; 8 * TRIANGLES]);
    rig.constant("FABRIC", 1.0);
    rig.constant("NODES", NODES as f64);
    rig.constant("SHEET_GAP", GAP);
    Swept { rig, world, nodes: [before, after], triangles }
}

/// Words of `fabric_cells`, and the cells of the grid.
fn sizes(world: &World) -> (usize, usize) {
    let cells = world.grid.cell_count();
    (FIRST + cells + cells.div_ceil(32), cells)
}

/// What a step leaves of fabric: counts and cells, entries, records of cells.
struct Listed {
    words: Vec<u32>,
    entries: Vec<[u32; 4]>,
    records: Vec<[u32; 4]>,
    /// Where the list of each cell is among `words`, if it has one.
    places: Vec<Option<usize>>,
}

fn listed(swept: &mut Swept, room: usize) -> Listed {
    let cells = swept.world.grid.cells;
    listed_in(swept, room, [0; 3], cells)
}

/// With lists in the cells of a box.
fn listed_in(swept: &mut Swept, room: usize, low: [u32; 3], size: [u32; 3]) -> Listed {
    let step = GpuStep { count: 1, dt: 1e-5, slot: 2, fabric_low: low, fabric_size: size, ..GpuStep::default() };
    swept.rig.step(step);
    let grid = swept.world.grid.cells;
    let place = |cell: u32| {
        let at = [cell % grid[0], cell / grid[0] % grid[1], cell / (grid[0] * grid[1])];
        let within = (0..3).all(|axis| low[axis] <= at[axis] && at[axis] - low[axis] < size[axis]);
        let [x, y, z] = [0, 1, 2].map(|axis| at[axis].wrapping_sub(low[axis]));
        within.then(|| FIRST + ((z * size[1] + y) * size[0] + x) as usize)
    };
    let places = (0..grid.iter().product()).map(place).collect();
    let (words, cells) = sizes(&swept.world);
    swept.rig.put("fabric_cells", &vec![0u32; words]);
    swept.rig.put("fabric_entries", &vec![[0u32; 4]; 2 * room]);
    swept.rig.run("list_fabric", TRIANGLES);
    swept.rig.run("bound_fabric", cells.min(room));
    let mut entries: Vec<[u32; 4]> = swept.rig.get("fabric_entries", 2 * room);
    let records = entries.split_off(room);
    Listed { words: swept.rig.get("fabric_cells", words), entries, records, places }
}

impl Listed {
    fn record(&self, cell: usize) -> Option<[u32; 4]> {
        let listed = (self.words[self.places[cell]?] as usize).checked_sub(1)?;
        assert_eq!(self.records[listed][3] as usize, cell);
        Some(self.records[listed])
    }

    /// The triangles in the list of a cell, with their boxes.
    fn list(&self, cell: usize) -> Vec<(u32, [[f64; 3]; 2])> {
        let mut found = Vec::new();
        let mut next = self.record(cell).map_or(0, |record| record[2]) as usize;
        while next != 0 {
            let [triangle, after, low, high] = self.entries[next - 1];
            found.push((triangle, [low, high].map(|corner| bytes(corner).map(|step| step / 254.0))));
            next = after as usize;
        }
        found
    }

    /// The planes of a cell: normal, and how far they are from the middle, in cells.
    fn slab(&self, cell: usize) -> (Vector, [f64; 2]) {
        let [normal, ends, ..] = self.record(cell).expect("a cell with fabric");
        let end = |word: u32| f64::from(word as u16 as i16) / 16384.0;
        (bytes(normal).map(|component| component / 127.0), [end(ends), end(ends >> 16)])
    }
}

fn bytes(word: u32) -> Vector {
    let bytes = word.to_le_bytes();
    std::array::from_fn(|axis| f64::from(bytes[axis] as i8))
}

/// Points that a triangle comes to, with their cells.
fn passed(swept: &Swept, triangle: [u32; 3]) -> Vec<(usize, Vector)> {
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
        found.push((cells.index(cells.cell(swept.world.fixed(point))) as usize, point));
    }
    found
}

/// Of a place within its cell, from the middle, in cells.
fn within(swept: &Swept, cell: usize, point: Vector) -> Vector {
    let grid = &swept.world.grid;
    let counts = grid.cells.map(|n| n as usize);
    let at = [cell % counts[0], cell / counts[0] % counts[1], cell / (counts[0] * counts[1])];
    let corner = swept.world.metres([0, 1, 2].map(|axis| (at[axis] as u32) << grid.cell_bits));
    std::array::from_fn(|axis| (point[axis] - corner[axis]) / grid.cell - 0.5)
}

#[test]
fn triangles_are_listed_wherever_they_come_to() {
    for seed in 1..4 {
        let mut swept = swept(seed);
        let found = listed(&mut swept, 40_000);
        let cells = sizes(&swept.world).1;
        let entries = found.words[0] as usize;
        let lists: Vec<_> = (0..cells).map(|cell| found.list(cell)).collect();
        assert_eq!(lists.iter().map(Vec::len).sum::<usize>(), entries);
        assert_eq!(lists.iter().filter(|list| !list.is_empty()).count(), found.words[1] as usize);
        assert!(entries > 4 * TRIANGLES && entries < TRIANGLES * cells / 2, "{entries} entries");
        let is_near = |cell: usize| found.words[FIRST + cells + cell / 32] >> (cell % 32) & 1 == 1;
        let counts = swept.world.grid.cells.map(|n| n as usize);
        for (number, &triangle) in (0u32..).zip(&swept.triangles) {
            let mut last = None;
            for (cell, point) in passed(&swept, triangle) {
                let point = within(&swept, cell, point);
                // (Behind the grid there is no gas.)
                if point.iter().any(|x| x.abs() > 0.5 + 1e-6) {
                    continue;
                }
                let (normal, [low, high]) = found.slab(cell);
                let height: f64 = (0..3).map(|axis| normal[axis] * point[axis]).sum();
                assert!(low <= height && height <= high, "seed {seed}: {height} in cell {cell} from {low} to {high}");
                let own = lists[cell].iter().find(|(listed, _)| *listed == number);
                let Some((_, [low, high])) = own else {
                    panic!("seed {seed}: triangle {number} is not in cell {cell}")
                };
                assert!(
                    (0..3).all(|axis| low[axis] - 1e-6 <= point[axis] && point[axis] <= high[axis] + 1e-6),
                    "{point:?}"
                );
                if last.replace(cell) == Some(cell) {
                    continue;
                }
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
        // The check can fail: some cell has no triangle, each triangle is in few, and planes leave room in many cells of a single one.
        assert!(lists.iter().any(Vec::is_empty));
        let alone = (0..cells).filter(|&cell| lists[cell].len() == 1);
        let thickness: Vec<f64> = alone.map(|cell| found.slab(cell).1).map(|[low, high]| high - low).collect();
        let thin = thickness.iter().filter(|&&thickness| thickness < 0.5).count();
        assert!(thickness.len() > 10 && 3 * thin > thickness.len(), "{thin} of {}", thickness.len());
        assert_eq!(swept.rig.counter(MISPLACED), 0);
    }
}

/// In a box of cells there are the same lists, and none elsewhere; those in its midst know the same of the cells around.
#[test]
fn lists_of_a_part_of_the_cells_are_those_of_all() {
    let mut swept = swept(4);
    let all = listed(&mut swept, 40_000);
    let (low, size) = ([2, 1, 3], [3, 5, 2]);
    let part = listed_in(&mut swept, 40_000, low, size);
    let cells = sizes(&swept.world).1;
    let sorted = |mut list: Vec<(u32, [[f64; 3]; 2])>| {
        list.sort_by_key(|(triangle, _)| *triangle);
        list
    };
    let (mut count, mut near) = (0, 0);
    for cell in 0..cells {
        let Some(place) = part.places[cell] else { continue };
        assert_eq!(sorted(part.list(cell)), sorted(all.list(cell)));
        count += part.list(cell).len();
        if !part.list(cell).is_empty() {
            assert_eq!(part.slab(cell), all.slab(cell));
        }
        let bits =
            |found: &Listed, number: usize, cells: usize| found.words[FIRST + cells + number / 32] >> (number % 32) & 1;
        let own = bits(&part, place - FIRST, size.iter().product::<u32>() as usize);
        assert!(own <= bits(&all, cell, cells));
        near += own;
    }
    assert!(count > 20 && part.words[0] as usize == count && near > 0, "{count} {near}");
    assert!(all.words[0] as usize > 2 * count);
}

/// Entries without room are counted, and none is written behind the end.
#[test]
fn entries_without_room_are_counted() {
    let mut swept = swept(5);
    let all = listed(&mut swept, 40_000).words[0];
    swept.rig.put("counters", &[0u32; COUNTER_WORDS]);
    let found = listed(&mut swept, 100);
    assert_eq!(found.words[0], all);
    let cells = sizes(&swept.world).1;
    let entered: usize = (0..cells).map(|cell| found.list(cell).len()).sum();
    assert!(entered <= 100 && swept.rig.counter(MISPLACED) as usize == all as usize - entered, "{entered} of {all}");
}
