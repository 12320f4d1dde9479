//! What a run did in its steps: the amounts by which bytes and operations are counted.

use crate::geometry::Grid;
use crate::gpu::KernelVariant;
use crate::scene::Method;
use crate::simulation::{Done, Model, Outcome};
use crate::subdomain::{GpuParticle, MEMBERS, few_stretches};

use super::collision_cells::CollisionCells;

/// Cells that the scan takes together.
pub const CHUNK: usize = 64;

/// Summed over the steps.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Work {
    pub steps: f64,
    pub particle_steps: f64,
    /// Cells times steps, and of these the ones that hold a particle, and two or more.
    pub cell_steps: f64,
    /// The cells are few to the scan.
    pub few_stretches: bool,
    pub filled: f64,
    pub shared: f64,
    /// Particles in cells with two or more.
    pub gathered: f64,
    /// Stretches of [`CHUNK`] cells with a particle.
    pub chunks: f64,
    /// Cells with two or more that are put in order where they collide.
    pub few: f64,
    /// Of the method `half-turn`.
    pub collision_cells: CollisionCells,
    /// Particles in cells of more; whether a thread for each puts them in order (`shaders/shared/crowds.gpu.wgsl`).
    pub crowded: f64,
    pub by_threads: bool,
    /// Entries of the neighbour lists, and particles that have any.
    pub candidates: f64,
    pub listed: f64,
    /// Particles that chose: in all rounds, in the first of each step, and to count what the rounds lost.
    pub choosers: f64,
    pub first_choosers: f64,
    pub lost_choosers: f64,
    pub near_walls: f64,
    pub newborns: f64,
    pub collisions: f64,
    pub bounces: f64,
    /// Steps that were tallied, zones that were, and for how many pairs of gases.
    pub tallies: f64,
    pub zones: f64,
    pub gas_pairs: f64,
    pub intervals: f64,
    /// The diameter depends on the density.
    pub capped: bool,
}

/// A run whose last part is measured.
pub struct BenchedRun<'a> {
    /// What it had done when that began, and at its end.
    pub before: &'a Done,
    pub after: &'a Done,
    pub outcome: &'a Outcome,
    /// Entries of the neighbour lists in the last step, and particles that had any, over all particles.
    pub lists: [f64; 2],
}

impl Work {
    /// Of the steps between the two. The lengths of lists are those in the last steps of intervals; the cells are those
    /// of the particles at the end.
    pub fn new(model: &Model, run: &BenchedRun<'_>, variant: KernelVariant) -> Work {
        let &BenchedRun { before, after, outcome, lists } = run;
        let plan = &model.plan;
        let steps = (after.phases.steps - before.phases.steps) as f64;
        let particle_steps = (after.phases.particle_steps - before.phases.particle_steps) as f64;
        let intervals = after.lists.intervals - before.lists.intervals;
        let mean = |sum: u64| sum as f64 / intervals.max(1) as f64;
        let chosen = |round: usize| mean(after.lists.choosers[round] - before.lists.choosers[round]);
        let (rounds, collides) = (plan.rounds as usize, plan.method != Method::None);
        let has_rounds = plan.method.has_rounds();
        let cells = if collides { plan.grid.cell_count() as f64 } else { 0.0 };
        let [filled, shared, gathered, chunks, few, crowded] =
            if collides { occupied(&outcome.particles, &plan.grid) } else { [0.0; 6] };
        Work {
            steps,
            particle_steps,
            cell_steps: cells * steps,
            few_stretches: few_stretches(cells as u64),
            filled: filled * steps,
            shared: shared * steps,
            gathered: gathered * steps,
            few: few * steps,
            crowded: crowded * steps,
            collision_cells: if plan.method == Method::HalfTurn {
                CollisionCells::of(&outcome.particles, &plan.grid).times(steps)
            } else {
                CollisionCells::default()
            },
            by_threads: variant == KernelVariant::Gpu,
            chunks: chunks * steps,
            candidates: lists[0] * particle_steps,
            listed: lists[1] * particle_steps,
            choosers: if has_rounds { (0..rounds).map(chosen).sum::<f64>() * steps } else { 0.0 },
            first_choosers: if has_rounds { chosen(0) * steps } else { 0.0 },
            lost_choosers: if has_rounds { chosen(rounds) * intervals as f64 } else { 0.0 },
            near_walls: mean(after.lists.near_walls - before.lists.near_walls) * steps,
            newborns: (after.entered - before.entered) as f64,
            collisions: (after.collisions - before.collisions) as f64,
            bounces: (after.bounces - before.bounces) as f64,
            tallies: (steps / f64::from(plan.tally_every)).floor(),
            zones: zones_read(model) as f64,
            gas_pairs: plan.gases.len().div_ceil(2) as f64,
            intervals: intervals as f64,
            capped: plan.diameter_cap.is_some(),
        }
    }
}

/// Cells with a particle, with two or more, the particles of those, stretches of cells with a particle, and cells whose
/// particles a thread puts in order where they collide, and the particles of cells of more.
fn occupied(particles: &[GpuParticle], grid: &Grid) -> [f64; 6] {
    let mut counts = vec![0_u32; grid.cell_count()];
    for particle in particles {
        if let Some(count) = counts.get_mut(grid.cell_index(grid.cell_of(particle.position))) {
            *count += 1;
        }
    }
    let shared = counts.iter().filter(|&&count| count > 1);
    [
        counts.iter().filter(|&&count| count > 0).count() as f64,
        shared.clone().count() as f64,
        shared.map(|&count| f64::from(count)).sum(),
        counts.chunks(CHUNK).filter(|chunk| chunk.iter().any(|&count| count > 0)).count() as f64,
        counts.iter().filter(|count| (2..=MEMBERS).contains(*count)).count() as f64,
        counts.iter().filter(|&&count| count > MEMBERS).map(|&count| f64::from(count)).sum(),
    ]
}

/// Zones whose tally reads the particles: where the chambers have all of them, the last has what the others leave.
fn zones_read(model: &Model) -> usize {
    let chambers = &model.scene.chambers;
    let covered = chambers.last().is_some_and(|chamber| chamber.region.is_none());
    usize::from(!covered) + chambers.len() + model.scene.probes.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Region;
    use crate::study::bench::SCENES;
    use crate::study::verify::{model_from, scene_of};

    /// The box has one chamber without a region; the tank two, the last without one, and a probe.
    #[test]
    fn the_last_chamber_is_read_only_where_it_has_a_region() {
        let zones = SCENES.map(|scene| {
            let asked = scene_of(scene.name, scene.text).expect("a scene");
            let mut model = model_from(scene.name, asked).expect("a plan");
            let covered = zones_read(&model);
            let last = model.scene.chambers.len() - 1;
            model.scene.chambers[last].region = Some(Region::Box { min: [0.0; 3], max: [0.01; 3] });
            [covered, zones_read(&model)]
        });
        assert_eq!(zones, [[1, 2], [3, 4], [2, 3]]);
    }

    #[test]
    fn cells_are_counted_by_what_is_in_them() {
        let grid = Grid::around([0.0; 3], [1.0; 3], 0.05).unwrap();
        let edge = 1 << grid.cell_bits;
        let at =
            |x: u32, y: u32| GpuParticle { position: [x * edge + 1, y * edge, edge], ..bytemuck::Zeroable::zeroed() };
        // Three in one cell, one beside it, two far away.
        let particles = [at(1, 1), at(1, 1), at(1, 1), at(2, 1), at(1, 10), at(1, 10)];
        assert_eq!(occupied(&particles, &grid), [3.0, 2.0, 5.0, 2.0, 2.0, 0.0]);
        // Where the three were, a crowd.
        let crowd = [&vec![at(1, 1); MEMBERS as usize - 2][..], &particles].concat();
        let many = f64::from(MEMBERS) + 1.0;
        assert_eq!(occupied(&crowd, &grid), [3.0, 2.0, many + 2.0, 2.0, 1.0, many]);
        assert_eq!(occupied(&[], &grid), [0.0; 6]);
    }
}
