//! Kernels alone, and other ways to do the same beside them: `cargo bench --bench kernels`.
//!
//! Each group is one task done in several ways on the same data, turn about; a line has the median wall time of a way,
//! the time per item, and that over the first way's, formed turn by turn. The ways of a group must agree in what they
//! give, or the bench fails. `records` and `arrays` are the inner loops of the step's kernels without what
//! they do besides, `search` is that of the search that finds each pair from both of its particles, row after row (the step's own finds it once, in one
//! loop); the scan of chunks are the step's own kernels.
//!
//! `-- 1000000` chooses the number of particles (default 262144), `-- --turns N` the turns (default 9).

use std::error::Error;
use std::time::Instant;

use corpuscle::gas::{Draws, Purpose};
use corpuscle::gpu::{Access, Binding, BoundKernel, Device, Kernel, KernelSource, Recording, fold};
use corpuscle::subdomain::{GpuStep, shader};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Positions are 10 bits per axis.
const UNITS: u32 = 1024;
/// Entries of a neighbour list.
const LIST: usize = 24;

fn main() -> Outcome<()> {
    let (mut count, mut turns) = (1usize << 18, 9);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            // Given by cargo.
            "--bench" => {}
            "--turns" => turns = arguments.next().ok_or("--turns needs a number")?.parse()?,
            number => count = number.parse()?,
        }
    }
    let device = Device::open(None)?;
    println!("{}: {count} particles, medians of {turns} turns", device.adapter().info.name);
    let bench = Bench { device, count, turns };
    bench.search_by_workgroup()?;
    bench.search_by_cell()?;
    bench.scans()?;
    bench.layouts()
}

struct Bench {
    device: Device,
    count: usize,
    turns: usize,
}

/// One way to do a task: its dispatches, and where its result is.
struct Way {
    name: String,
    dispatches: Vec<(BoundKernel, [u32; 3])>,
    /// Copied before each turn, not timed.
    restores: Vec<(wgpu::Buffer, wgpu::Buffer)>,
    result: wgpu::Buffer,
    words: usize,
}

impl Bench {
    /// Times the ways in turns and prints a line for each; `digest` of their results must be one for all (it is given which
    /// way's they are).
    fn compare(&self, task: &str, items: usize, ways: &[Way], digest: impl Fn(usize, Vec<u32>) -> u64) -> Outcome<()> {
        println!("\n{task}, {items} items");
        let mut seconds = vec![Vec::new(); ways.len()];
        let mut first = None;
        for turn in 0..=self.turns {
            for (k, (way, seconds)) in ways.iter().zip(&mut seconds).enumerate() {
                let mut rec = Recording::new(&self.device);
                for (from, to) in &way.restores {
                    rec.encoder().copy_buffer_to_buffer(from, 0, to, 0, from.size().min(to.size()));
                }
                let submission = rec.submit();
                self.device.wait(&submission)?;
                for (kernel, groups) in &way.dispatches {
                    kernel.dispatch(&mut rec.phase(kernel.phases().first().unwrap_or(&"way")), 0, *groups);
                }
                let start = Instant::now();
                let submission = rec.submit();
                self.device.wait(&submission)?;
                // The first turn warms up, and shows what is found.
                if turn > 0 {
                    seconds.push(start.elapsed().as_secs_f64());
                } else {
                    let found = digest(k, self.device.read(&way.result, way.words)?);
                    if *first.get_or_insert(found) != found {
                        return Err(
                            format!("{task}: `{}` gives another result than `{}`", way.name, ways[0].name).into()
                        );
                    }
                }
            }
        }
        for (way, own) in ways.iter().zip(&seconds) {
            let ratio = median(own.iter().zip(&seconds[0]).map(|(own, first)| own / first).collect());
            let own = median(own.clone());
            let per_item = 1e9 * own / items as f64;
            println!("  {:<44} {:9.3} ms {per_item:9.2} ns per item {ratio:7.2}", way.name, 1e3 * own);
        }
        Ok(())
    }

    fn search_by_workgroup(&self) -> Outcome<()> {
        let cloud = Cloud::new(self.count, 1.0);
        let ways = [64, 32, 128, 256, 8];
        let ways = ways.map(|size| self.search(&cloud, &format!("workgroups of {size}"), true, size));
        let ways = ways.into_iter().collect::<Outcome<Vec<_>>>()?;
        self.compare("search of neighbours by size of workgroup", self.count, &ways, |_, found| sum(&found))
    }

    fn search_by_cell(&self) -> Outcome<()> {
        let mut ways = Vec::new();
        for (edge, rows) in [(1.0, true), (1.0, false), (0.5, true), (0.5, false), (1.5, true), (2.0, true)] {
            let cloud = Cloud::new(self.count, edge);
            let side = 2 * cloud.reach + 1;
            let what = if rows { format!("{} rows of {side}", side * side) } else { format!("{} cells", side.pow(3)) };
            let name = format!("{what}, cells of {edge} of the reach");
            ways.push(self.search(&cloud, &name, rows, 64)?);
        }
        self.compare("search of neighbours by cells around", self.count, &ways, |_, found| sum(&found))
    }

    fn search(&self, cloud: &Cloud, name: &str, rows: bool, workgroup: u32) -> Outcome<Way> {
        let device = &self.device;
        let buffers = [
            ("places", device.storage_of("places", &cloud.places)?),
            ("cells", device.storage_of("cells", &cloud.cells)?),
            ("cell_start", device.storage_of("cell_start", &cloud.starts)?),
            ("found", device.storage::<u32>("found", self.count as u64)?),
            ("neighbours", device.storage::<u32>("neighbours", (LIST * self.count) as u64)?),
        ];
        let constants = [
            ("WORKGROUP", f64::from(workgroup)),
            ("COUNT", self.count as f64),
            ("EDGE", f64::from(cloud.edge)),
            ("REACH", f64::from(cloud.reach)),
            ("ROWS", f64::from(u8::from(rows))),
            ("NEAR2", f64::from(cloud.near2)),
            ("LIST", LIST as f64),
        ];
        let source =
            source("search", include_str!("kernels/search.wgsl"), &buffers.each_ref().map(|(n, _)| *n), &constants);
        let kernel = self.bind(&Kernel::new(device, source, &constants)?, &buffers)?;
        Ok(Way {
            name: name.to_owned(),
            dispatches: vec![(kernel, self.groups(self.count, workgroup))],
            restores: Vec::new(),
            result: buffers[3].1.clone(),
            words: self.count,
        })
    }

    /// Where the particles of so many cells begin: some eight cells for a particle, as in a tank, most of them empty.
    fn scans(&self) -> Outcome<()> {
        let cells = 8 * self.count;
        let mut counts = vec![0u32; cells];
        let mut numbers = Numbers::of(3);
        (0..self.count).for_each(|_| counts[numbers.below(cells as u32) as usize / 2] += 1);
        let mut ways = Vec::new();
        for chunk in [64, 32, 256] {
            ways.push(self.scan_of_chunks(&counts, chunk)?);
        }
        for workgroup in [64, 256] {
            ways.push(self.scan_of_trees(&counts, workgroup)?);
        }
        self.compare("scan of the cells", cells, &ways, |_, starts| digest(&starts))
    }

    /// As the step does it, with so many cells per thread.
    fn scan_of_chunks(&self, counts: &[u32], chunk: usize) -> Outcome<Way> {
        let (device, cells) = (&self.device, counts.len());
        let step = device.uniform("step", size_of::<GpuStep>() as u64)?;
        device.write(&step, 0, &[GpuStep { bins: cells as u32, ..GpuStep::default() }]);
        let chunks = cells / chunk + 1;
        // Zeros to the end of the chunk that has the cell behind the last.
        let mut all = counts.to_vec();
        all.resize(chunk * chunks, 0);
        let kept = device.storage_of("kept", &all)?;
        let no_sums = device.storage_of("no_sums", &vec![0u32; chunks.div_ceil(64)])?;
        let buffers = [
            ("step", step),
            ("chunk_sums", device.storage::<u32>("chunk_sums", chunks.next_multiple_of(64) as u64)?),
            ("stretch_sums", device.storage::<u32>("stretch_sums", chunks.div_ceil(64) as u64)?),
            ("cell_start", device.storage::<u32>("cell_start", all.len() as u64)?),
        ];
        let constants = [("CHUNK", chunk as f64), ("FEW_STRETCHES", 0.0)];
        let mut dispatches = Vec::new();
        for (name, groups) in [
            ("scan_sums", self.groups(chunks, 64)),
            ("scan_stretches", [1, 1, 1]),
            ("scan_cells", self.groups(chunks, 64)),
        ] {
            dispatches.push((self.bind(&Kernel::new(device, shader(name)?, &constants)?, &buffers)?, groups));
        }
        Ok(Way {
            name: format!("chunks of {chunk} cells, a thread each"),
            dispatches,
            // It leaves starts where the counts were, and adds to the sums of stretches.
            restores: vec![(kept, buffers[3].1.clone()), (no_sums, buffers[2].1.clone())],
            result: buffers[3].1.clone(),
            words: cells + 1,
        })
    }

    /// In the memory of workgroups, two values per thread, level above level.
    fn scan_of_trees(&self, counts: &[u32], workgroup: u32) -> Outcome<Way> {
        let (device, span) = (&self.device, 2 * workgroup as usize);
        let mut levels = vec![counts.len()];
        while levels[levels.len() - 1] > span {
            levels.push(levels[levels.len() - 1].div_ceil(span));
        }
        let mut values = vec![device.storage_of("values", counts)?];
        for &count in &levels[1..] {
            values.push(device.storage::<u32>("values", count as u64)?);
        }
        let nothing = device.storage::<u32>("totals", 4)?;
        let mut sums = Vec::new();
        let mut dispatches = Vec::new();
        for (level, &count) in levels.iter().enumerate() {
            sums.push(device.storage::<u32>("sums", count as u64 + 1)?);
            let above = values.get(level + 1);
            let constants = [
                ("WORKGROUP", f64::from(workgroup)),
                ("COUNT", count as f64),
                ("TOTALS", f64::from(u8::from(above.is_some()))),
            ];
            let totals = above.unwrap_or(&nothing).clone();
            let buffers = [("values", values[level].clone()), ("sums", sums[level].clone()), ("totals", totals)];
            let text = include_str!("kernels/scan_tree.wgsl");
            let source = source("scan_tree", text, &["values", "sums", "totals"], &constants);
            let kernel = self.bind(&Kernel::new(device, source, &constants)?, &buffers)?;
            dispatches.push((kernel, self.groups(count, span as u32)));
        }
        for level in (0..levels.len()).rev() {
            let count = levels[level];
            let before = sums.get(level + 1).unwrap_or(&nothing).clone();
            let constants = [("WORKGROUP", f64::from(workgroup)), ("COUNT", count as f64), ("SPAN", span as f64)];
            let buffers = [("before", before), ("sums", sums[level].clone()), ("values", values[level].clone())];
            let text = include_str!("kernels/scan_add.wgsl");
            let source = source("scan_add", text, &["before", "sums", "values"], &constants);
            let kernel = self.bind(&Kernel::new(device, source, &constants)?, &buffers)?;
            dispatches.push((kernel, self.groups(count, workgroup)));
        }
        Ok(Way {
            name: format!("{} levels of {span} in a workgroup's memory", levels.len()),
            dispatches,
            restores: Vec::new(),
            result: sums[0].clone(),
            words: counts.len() + 1,
        })
    }

    /// A particle's words together, or each in an array of its own.
    fn layouts(&self) -> Outcome<()> {
        let mut numbers = Numbers::of(5);
        let records: Vec<u32> =
            (0..self.count).flat_map(|_| [0; 8].map(|_: u32| (100.0 * numbers.uniform()).to_bits())).collect();
        let word = |k: usize| records.iter().skip(k).step_by(8).copied();
        let arrays: Vec<u32> = (0..8).flat_map(word).collect();
        // As from one step to the next: most particles are near where they were.
        let mut order: Vec<u32> = (0..self.count as u32).collect();
        (0..self.count).for_each(|k| {
            let other = (k + numbers.below(512) as usize).min(self.count - 1);
            order.swap(k, other);
        });
        let texts = [
            ("records of 32 bytes (records)", include_str!("kernels/records.wgsl"), &records, false),
            ("an array for each of 8 words (arrays)", include_str!("kernels/arrays.wgsl"), &arrays, true),
        ];
        for (task, entry, result) in [("flight", "fly", 1), ("a new order", "gather", 2)] {
            let mut ways = Vec::new();
            for (name, text, data, _) in texts {
                let device = &self.device;
                let kept = device.storage_of("kept", data)?;
                let buffers = [
                    ("order", device.storage_of("order", &order)?),
                    ("particles", device.storage_of("particles", data)?),
                    ("ordered", device.storage::<u32>("ordered", data.len() as u64)?),
                ];
                let constants = [("COUNT", self.count as f64)];
                let source = source(entry, text, &["order", "particles", "ordered"], &constants);
                let kernel = self.bind(&Kernel::new(device, source, &constants)?, &buffers)?;
                ways.push(Way {
                    name: name.to_owned(),
                    dispatches: vec![(kernel, self.groups(self.count, 64))],
                    restores: vec![(kept, buffers[1].1.clone())],
                    result: buffers[result].1.clone(),
                    words: data.len(),
                });
            }
            let count = self.count;
            // Particle by particle, wherever its words are.
            let digest_of = |way: usize, words: Vec<u32>| {
                let (.., apart) = texts[way];
                let at =
                    |particle: usize, word: usize| if apart { word * count + particle } else { 8 * particle + word };
                let words: Vec<u32> = (0..8 * count).map(|k| words[at(k / 8, k % 8)]).collect();
                digest(&words)
            };
            self.compare(&format!("particles: {task}"), count, &ways, digest_of)?;
        }
        Ok(())
    }

    fn bind(&self, kernel: &Kernel, buffers: &[(&str, wgpu::Buffer)]) -> Outcome<BoundKernel> {
        let find = |name: &str| buffers.iter().find(|(known, _)| *known == name).map(|(_, buffer)| buffer);
        Ok(kernel.bind(&self.device, find)?)
    }

    fn groups(&self, items: usize, workgroup: u32) -> [u32; 3] {
        let limit = self.device.limits().max_compute_workgroups_per_dimension;
        fold(items as u64, workgroup, limit)
    }
}

/// A kernel of this bench: of its bindings, the first is read; `values`, `before`, `cells` and `cell_start` are too.
fn source(
    entry_point: &'static str,
    text: &'static str,
    names: &[&'static str],
    constants: &[(&'static str, f64)],
) -> &'static KernelSource {
    let read = ["places", "cells", "cell_start", "values", "before", "order"];
    let binding = |(index, name): (u32, &&'static str)| Binding {
        index,
        name,
        access: if read.contains(name) { Access::Read } else { Access::ReadWrite },
        stepped: None,
    };
    let bindings: Vec<Binding> = (0..).zip(names).map(binding).collect();
    let overrides: Vec<(&'static str, bool)> = constants.iter().map(|(name, _)| (*name, true)).collect();
    // A table of kernels is static; this one is as long as the program.
    Box::leak(Box::new(KernelSource {
        name: entry_point,
        entry_point,
        phases: &[],
        bindings: Vec::leak(bindings),
        overrides: Vec::leak(overrides),
        source: text,
        variants: [None; 2],
    }))
}

/// Uniform points in the order of cells, 1.1 mean spacings being the reach of a search (closest-approach at occupancy .12
/// and steps of a tenth of the collision time).
struct Cloud {
    places: Vec<u32>,
    cells: Vec<u32>,
    starts: Vec<u32>,
    /// Cells along an edge, with the border.
    edge: u32,
    reach: u32,
    near2: u32,
}

impl Cloud {
    /// With cells of `share` of the reach.
    fn new(count: usize, share: f64) -> Cloud {
        let near = (1.1 * f64::from(UNITS) / (count as f64).cbrt()).round();
        let cell = (share * near).floor().max(1.0) as u32;
        let reach = (near / f64::from(cell)).ceil() as u32;
        let edge = UNITS.div_ceil(cell) + 2 * reach;
        let mut numbers = Numbers::of(1);
        let mut points: Vec<(u32, u32)> = (0..count)
            .map(|_| {
                let place = [0; 3].map(|_: u32| numbers.below(UNITS));
                let [x, y, z] = place.map(|at| at / cell + reach);
                ((z * edge + y) * edge + x, place[0] | (place[1] << 10) | (place[2] << 20))
            })
            .collect();
        points.sort_unstable();
        let mut starts = vec![0u32; edge.pow(3) as usize + 1];
        points.iter().for_each(|&(cell, _)| starts[cell as usize + 1] += 1);
        (1..starts.len()).for_each(|k| starts[k] += starts[k - 1]);
        let (cells, places) = points.into_iter().unzip();
        Cloud { places, cells, starts, edge, reach, near2: (near * near) as u32 }
    }
}

/// Equal numbers in every run.
struct Numbers(Draws);

impl Numbers {
    fn of(seed: u64) -> Numbers {
        Numbers(Draws::new(seed, Purpose::InitialPosition, 0))
    }

    fn below(&mut self, limit: u32) -> u32 {
        ((self.0.uniform() * f64::from(limit)) as u32).min(limit - 1)
    }

    fn uniform(&mut self) -> f32 {
        self.0.uniform() as f32
    }
}

fn sum(words: &[u32]) -> u64 {
    words.iter().map(|&word| u64::from(word)).sum()
}

/// Of the words in their order.
fn digest(words: &[u32]) -> u64 {
    words.iter().fold(0, |hash: u64, &word| (hash ^ u64::from(word)).wrapping_mul(0x100_0000_01b3))
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
