//! The operations that the phases of a step do, counted from their kernels ([`Stretch`]) as they are specialised to the scene, times how
//! often they run.
//!
//! Of each phase its kernels count once for each of what they have a thread for (particles, cells, those that choose, pairs), and
//! their loops as often as the run knows:
//!
//! | loop | turns |
//! |---|---|
//! | candidates of the search | four for each particle, or as many as were found where those are more |
//! | pairs found | half of the entries of the lists |
//! | entries of the list of one that chooses | as many as the mean list has: all up to the test of the time (of rigid spheres of the distance), the rest for those that collide |
//! | walls, for a flight near them and at each hit | one cell, one triangle up to the side it shows |
//! | members of a collision cell, three times; halvings of a tile | all; for each cell of the grid |
//! | members of a crowded cell, twice, and what puts a cell in order; candidates in it | all; those that collided |
//! | ids of a crowded cell, where a thread for each particle puts it in order | all of a mean cell, by fours |
//! | particles in the tally | all up to the test of the zone for each zone and two gases, once the rest |
//!
//! What only some do (branches that this does not name, longer lists, cells with moving walls, candidates of a cell in vain) does not count, so
//! operations over time are less than what is really done.

use crate::gpu::{Constants, GpuError, Operations, Stretch};
use crate::scene::Method;
use crate::subdomain::registry::LISTS;
use crate::subdomain::{CROWD, KERNELS, STRETCH};

use super::collision_cells::CollisionCells;
use super::work::{CHUNK, Work};

/// The kernels of a step of a device alone, but for those of rare work; of `complete_lists` only the flights that may meet a wall count, and
/// `arrange_crowded` where it has all of the crowded cells.
const COUNTED: [&str; 25] = [
    "bin",
    "arrange",
    "arrange_crowded",
    "list_ids",
    "arrange_by_id",
    "collision_cells",
    "half_turn",
    "scan_sums",
    "scan_stretches",
    "scan_cells",
    "order",
    "start_flights",
    "neighbours",
    "complete_lists",
    "collide",
    "collide_crowded",
    "choose",
    "clear_cells",
    "match_pairs",
    "settle",
    "lost",
    "advect",
    "bounce",
    "tally",
    "blocks",
];

/// The turns that each search takes at least, as in `shaders/neighbours.wgsl`.
const FEWEST_TURNS: f64 = 4.0;

/// Loops over the rows of four slots of a crowded cell, and over half of them.
const ROWS: [(&str, u32); 2] = [("row", CROWD / 4), ("half of the rows", CROWD / 8)];

/// The kernels of a scene, counted.
pub struct Counted(Vec<(&'static str, Stretch)>);

impl Counted {
    /// # Errors
    /// If a kernel cannot be read.
    pub fn new(constants: &Constants) -> Result<Counted, GpuError> {
        let counted = KERNELS.iter().filter(|kernel| COUNTED.contains(&kernel.name));
        let counted = counted.map(|kernel| Ok((kernel.name, Stretch::of_kernel(kernel, constants)?)));
        Ok(Counted(counted.collect::<Result<_, GpuError>>()?))
    }

    fn of(&self, kernel: &str) -> Option<&Stretch> {
        self.0.iter().find(|(name, _)| *name == kernel).map(|(_, stretch)| stretch)
    }

    fn straight(&self, kernel: &str) -> Option<Operations> {
        Some(self.of(kernel)?.straight())
    }

    /// A turn of a loop.
    fn turn(&self, kernel: &str, name: &str) -> Option<Operations> {
        Some(self.of(kernel)?.inner(name)?.straight())
    }

    /// The flight's way along the walls of one cell, up to which side the first shows.
    fn walls(stretch: &Stretch) -> Option<Operations> {
        let rows = ["plane of cells", "row of cells"];
        let rows = rows.iter().map(|name| Some(stretch.inner(name)?.straight())).sum::<Option<Operations>>()?;
        Some(rows + stretch.inner("triangle")?.around("side")?[0])
    }

    /// An entry of the list of one that chooses, up to the first test that most fail, and the rest.
    fn entry(&self) -> Option<[Operations; 2]> {
        let entry = self.of("choose")?.inner("entry")?;
        // Rigid spheres are not asked for the time first.
        entry.around("in time").or_else(|| entry.around("near"))
    }

    /// Those that choose: themselves, and so many entries of their lists.
    fn choices(&self, choosers: f64, entries: f64) -> Option<Operations> {
        Some(self.straight("choose")? * choosers + self.entry()?[0] * (choosers * entries))
    }

    /// The collisions of all particles of a cell: cells of the grid find theirs, and each of its particles counts in three loops.
    fn half_turns(&self, cells: f64, divided: &CollisionCells) -> Option<Operations> {
        let found =
            self.straight("collision_cells")? * cells + self.turn("collision_cells", "halved")? * divided.halvings;
        let relaxed = self.of("half_turn")?;
        // (Gas without spin has none of it.)
        let spin = relaxed.inner("spin").map(Stretch::straight).unwrap_or_default();
        let each = relaxed.straight() + relaxed.inner("turned")?.straight() + spin;
        let fitted = relaxed.inner("fitted")?.straight();
        Some(found + each * divided.number + fitted * divided.fitted + relaxed.every("member") * divided.members)
    }

    /// Of particles that may meet a wall: but for those near walls, who are few, all up to the class of their cell.
    fn away_from_walls(&self, kernel: &str) -> Option<Operations> {
        let kernel = self.of(kernel)?;
        Some(kernel.around("far")?[0] + kernel.around("around")?[1])
    }
}

/// Operations of a phase over the run; `None` of one that is not counted.
pub fn operations(phase: &str, method: Method, work: &Work, counted: &Counted) -> Option<Operations> {
    let Work { particle_steps: n, cell_steps: cells, candidates, collisions, choosers, .. } = *work;
    let rounds = method.has_rounds();
    let present = n / work.steps.max(1.0);
    let entries = candidates / n.max(1.0);
    Some(match phase {
        "scan" => {
            let (chunks, fours) = (cells / CHUNK as f64, cells / 4.0);
            let filled = work.chunks * CHUNK as f64 / 4.0;
            let own = counted.straight("scan_sums")? + counted.straight("scan_cells")?;
            // Of the others of a stretch half come before, in the mean.
            let before = counted.turn("scan_cells", "chunks before")? * (0.5 * CHUNK as f64 / 16.0);
            // Few stretches are summed by each chunk: half of them, by fours, in the mean.
            let sum = if work.few_stretches {
                let stretches = cells / work.steps.max(1.0) / (CHUNK * CHUNK) as f64;
                counted.turn("scan_cells", "stretches before")? * (stretches / 8.0)
            } else {
                counted.turn("scan_stretches", "stretches")? * (0.5 / CHUNK as f64)
            };
            (own + before + sum) * chunks
                + counted.turn("scan_sums", "counted")? * (fours / 8.0)
                + counted.turn("scan_cells", "started")? * (0.25 * filled)
                + counted.turn("scan_cells", "empty")? * (fours - filled).max(0.0)
        }
        "sort" if method == Method::HalfTurn => {
            // Each looks at all of its cell, by fours that begin anywhere.
            let fours = 1.0 + 0.25 * (n / work.filled.max(1.0) - 1.0).max(0.0);
            let placed = counted.straight("arrange_by_id")? + counted.turn("arrange_by_id", "lower ids")? * fours;
            (counted.straight("list_ids")? + placed) * n
        }
        "collide" if method == Method::HalfTurn => counted.half_turns(cells, &work.collision_cells)?,
        "sort" if rounds => {
            let order = counted.away_from_walls("order")?;
            (if work.capped { order + counted.straight("start_flights")? } else { order }) * n
        }
        "sort" => {
            // Each looks at all of its cell, by fours.
            let fours = work.crowded / (work.shared - work.few).max(1.0) / 4.0;
            let crowd = counted.straight("arrange_crowded")? + counted.turn("arrange_crowded", "lower ids")? * fours;
            counted.straight("arrange")? * n + crowd * if work.by_threads { work.crowded } else { 0.0 }
        }
        "neighbours" => {
            let turns = (FEWEST_TURNS * n).max(0.5 * candidates);
            let meeting = counted.of("complete_lists")?.inner("near a wall")?;
            let walls = counted.straight("complete_lists")? + meeting.straight() + Counted::walls(meeting)?;
            counted.straight("neighbours")? * n
                + walls * work.near_walls
                + counted.turn("neighbours", "candidate")? * turns
                + counted.turn("neighbours", "found")? * (0.5 * candidates)
        }
        "choose" => counted.choices(choosers, entries)? + counted.entry()?[1] * (2.0 * collisions),
        "settle" => {
            let [alone, mutual] = counted.of("match_pairs")?.around("mutual")?;
            // Most lists are of one turn.
            let touched = counted.turn("settle", "touched")?;
            alone * choosers + (mutual + counted.straight("settle")? + touched) * collisions
        }
        "lost" => {
            let alone = counted.of("match_pairs")?.around("mutual")?[0];
            counted.choices(work.lost_choosers, entries)? + alone * work.lost_choosers
        }
        "collide" => {
            let few = counted.turn("collide", "in order")? + counted.turn("collide", "colliding")?;
            let crowds = counted.of("collide_crowded")?;
            let network = ROWS.iter().map(|&(name, turns)| crowds.every(name) * f64::from(turns)).sum::<Operations>();
            let order = crowds.inner("fits")?.straight() + network;
            let order = if work.by_threads { Operations::default() } else { order };
            let crowd = crowds.straight() + order + counted.turn("collide_crowded", "colliding")?;
            counted.straight("collide")? * cells
                + counted.turn("collide", "shared")? * work.shared
                + few * work.few
                + crowd * (work.shared - work.few)
                + crowds.every("member") * work.crowded
                + counted.turn("collide", "candidate pair")? * collisions
        }
        "advect" => {
            let flight = if rounds { counted.straight("advect")? } else { counted.away_from_walls("advect")? };
            // Each hit as one of a flight of its own: the way to the wall and the way from it.
            let turn = counted.of("bounce")?.inner("hit")?;
            let last = turn.around("last")?[0];
            let hit =
                counted.straight("bounce")? + turn.straight() + last + Counted::walls(counted.of("bounce")?)? * 2.0;
            let flights = flight * n + hit * work.bounces;
            if method == Method::None {
                return Some(flights);
            }
            // The step that follows finds them in their cells.
            let cleared = counted.turn("clear_cells", "cleared")? * (cells / 4.0);
            flights + cleared + (counted.straight("bin")? + counted.turn("bin", "binned")?) * n
        }
        "tally" => {
            let particle = counted.of("tally")?.inner("particle")?;
            let seen = particle.around("everywhere").or_else(|| particle.around("inside"))?[0];
            let added = particle.around("inside")?[1];
            (seen * (work.zones * work.gas_pairs) + added) * (present * work.tallies)
        }
        // `reset` compares the number of each of its threads twice, and stores.
        "bin" => Operations { floating: 0.0, integer: 2.0 * (f64::from(LISTS) * work.steps + cells / STRETCH as f64) },
        "blocks" => counted.straight("blocks")? * (present * work.intervals),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::MARK;

    /// As a scene of one gas between mirrors at rest has it.
    fn lean(method: Method) -> Counted {
        let on = |yes: bool| f64::from(u8::from(yes));
        let lacks = [
            "DIVIDED_GAS",
            "HALO",
            "MOVING",
            "SURFACE_MODELS",
            "VENTS",
            "SURFACES",
            "ORIFICES",
            "SPIN",
            "CURVES",
            "CAPPED",
        ];
        let mut constants: Vec<(&str, f64)> = lacks.iter().map(|&name| (name, 0.0)).collect();
        constants.extend([
            ("GASES", 1.0),
            ("CHAMBERS", 1.0),
            ("RIGID", on(method == Method::HardSphere)),
            ("COLLISIONS", on(method != Method::None)),
            ("ROUNDS_OF_PAIRS", on(method.has_rounds())),
        ]);
        Counted::new(&constants).unwrap()
    }

    fn phases(method: Method) -> &'static [&'static str] {
        match method {
            Method::None => &["advect", "tally", "blocks"],
            Method::Cell | Method::HalfTurn => &["scan", "sort", "collide", "advect", "tally", "blocks"],
            _ => &["scan", "sort", "neighbours", "choose", "settle", "lost", "advect", "tally", "blocks"],
        }
    }

    const METHODS: [Method; 5] =
        [Method::ClosestApproach, Method::HardSphere, Method::Cell, Method::HalfTurn, Method::None];

    /// Every branch and loop that is asked for by its name is there, and every phase of a step is counted.
    #[test]
    fn every_phase_is_counted() {
        let work = Work {
            steps: 1.0,
            particle_steps: 1.0,
            cell_steps: 1.0,
            candidates: 1.0,
            choosers: 1.0,
            lost_choosers: 1.0,
            tallies: 1.0,
            zones: 1.0,
            gas_pairs: 1.0,
            intervals: 1.0,
            ..Work::default()
        };
        for method in METHODS {
            let counted = lean(method);
            for phase in phases(method) {
                let own = operations(phase, method, &work, &counted).unwrap_or_else(|| panic!("{method:?} {phase}"));
                assert!(own.all() > 0.0 && own.floating >= 0.0, "{method:?} {phase}: {own:?}");
            }
            assert_eq!(operations("exchange", method, &work, &counted), None);
        }
    }

    /// A name in a shader stands before a branch or a loop, and this file asks for it: one that does not is of no use, or misspelt.
    #[test]
    fn every_name_in_a_shader_is_asked_for() {
        let code = include_str!("operations.rs").split("mod tests").next().unwrap();
        let mut names = 0;
        for kernel in KERNELS.iter().filter(|kernel| COUNTED.contains(&kernel.name)) {
            let lines: Vec<&str> = kernel.source.lines().map(str::trim).collect();
            for pair in lines.windows(2) {
                let Some(name) = pair[0].strip_prefix(MARK) else { continue };
                let begins = ["if (", "for (", "while (", "loop {"].iter().any(|begin| pair[1].starts_with(begin));
                assert!(begins && code.contains(&format!("\"{name}\"")), "{}: {name}, before {}", kernel.name, pair[1]);
                names += 1;
            }
        }
        assert!(names > 50, "{names}");
    }

    /// A crowded cell is put in order once: where it collides, or by a thread for each of its particles before.
    #[test]
    fn crowded_cells_are_put_in_order_in_one_phase() {
        let counted = lean(Method::Cell);
        let by_network = Work { particle_steps: 100.0, shared: 2.0, crowded: 50.0, ..Work::default() };
        let by_threads = Work { by_threads: true, ..by_network };
        let [sort, collide] = ["sort", "collide"].map(|phase| {
            [by_network, by_threads].map(|work| operations(phase, Method::Cell, &work, &counted).unwrap().all())
        });
        assert!(sort[0] < sort[1] && collide[0] > collide[1], "{sort:?} {collide:?}");
    }

    /// Each amount costs where it is dealt with, and nowhere else.
    #[test]
    fn amounts_cost_where_they_are_dealt_with() {
        let work = Work { steps: 4.0, particle_steps: 400.0, cell_steps: 640.0, chunks: 2.0, ..Work::default() };
        let more: [(&str, Work, &[&str]); 7] = [
            ("choosers", Work { choosers: 9.0, ..work }, &["choose", "settle"]),
            ("lost", Work { lost_choosers: 9.0, ..work }, &["lost"]),
            ("pairs", Work { candidates: 90.0, ..work }, &["neighbours"]),
            ("walls", Work { near_walls: 9.0, ..work }, &["neighbours"]),
            ("hits", Work { bounces: 9.0, ..work }, &["advect"]),
            ("collisions", Work { collisions: 9.0, ..work }, &["choose", "settle"]),
            ("chunks", Work { chunks: 3.0, ..work }, &["scan"]),
        ];
        let method = Method::ClosestApproach;
        let counted = lean(method);
        for (name, work_with, dear) in more {
            for phase in phases(method) {
                let [without, with] =
                    [&work, &work_with].map(|work| operations(phase, method, work, &counted).unwrap().all());
                assert_eq!(with > without, dear.contains(phase), "{name}: {phase}");
            }
        }
    }

    /// A collision cell costs by its members, and its axes for itself; cells of the grid find it by halves.
    #[test]
    fn collision_cells_cost_by_their_members() {
        let counted = lean(Method::HalfTurn);
        let of = |number: f64, fitted: f64, members: f64, halvings: f64| {
            let collision_cells = CollisionCells { number, fitted, members, halvings };
            let work = Work { steps: 1.0, particle_steps: 14.0, collision_cells, ..Work::default() };
            operations("collide", Method::HalfTurn, &work, &counted).unwrap()
        };
        let [none, alone, fitted] = [of(0.0, 0.0, 0.0, 0.0), of(1.0, 0.0, 0.0, 0.0), of(1.0, 1.0, 0.0, 0.0)];
        assert_eq!(none, Operations::default());
        // Twelve rotations of Jacobi's, of two square roots each; a gradient is three rows of nine products.
        assert!(alone.floating > 12.0 * 40.0 && fitted.floating > alone.floating + 27.0, "{alone:?} {fitted:?}");
        // Of each member the squares of places and velocities, the flow thrice, the stress and the turn.
        let member = of(0.0, 0.0, 1.0, 0.0);
        assert!((150.0..400.0).contains(&member.floating), "{member:?}");
        assert!(of(0.0, 0.0, 0.0, 1.0).integer >= 3.0 && of(0.0, 0.0, 0.0, 1.0).floating == 0.0);
    }

    /// A collision of rigid spheres or of `cell` draws random numbers: hundreds of operations of integers; a flight needs none.
    #[test]
    fn random_numbers_are_operations_of_integers() {
        let work = Work { steps: 1.0, particle_steps: 1.0, collisions: 1.0, ..Work::default() };
        let collided = |method, phase| operations(phase, method, &work, &lean(method)).unwrap();
        for (method, phase) in [(Method::ClosestApproach, "settle"), (Method::Cell, "collide")] {
            let own = collided(method, phase);
            assert!(own.integer > 400.0 && own.floating < own.integer, "{own:?}");
        }
        let flight = collided(Method::None, "advect");
        assert!(flight.all() < 200.0, "{flight:?}");
    }
}
