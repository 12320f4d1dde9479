//! The state of the time loop at the start of a refined run.
//!
//! The clock, the rows and the snapshots go on where the parent was. Averages and account start at the refinement: what had entered by
//! then counts as there from the start, and walls have received nothing. The step is the one that the refined state asks for,
//! as at the start of any run.

use crate::gas::Inflow;
use crate::geometry::block_volumes;
use crate::plan::Plan;
use crate::simulation::accounting::audit::Account;
use crate::simulation::accounting::averages::{AveragesState, Counts};
use crate::simulation::accounting::guards::GuardState;
use crate::simulation::control::clock::Clock;
use crate::simulation::control::ladder::{Ladder, LadderError};
use crate::simulation::model::build::Model;
use crate::simulation::model::patches::patches;
use crate::simulation::run_state::RunState;
use crate::simulation::zero_d::switch::SwitchState;
use crate::subdomain::{BlockSum, GpuParticle, Scales};

/// `clock` and `inflow` are the refined run's at that moment, `parent` is the state of the parent.
pub fn state(
    model: &Model,
    clock: Clock,
    inflow: Inflow,
    parent: &RunState,
    particles: &[GpuParticle],
) -> Result<RunState, LadderError> {
    let Model { scene, vessel, plan, surface_models, .. } = model;
    let mut ladder = Ladder::new(plan, block_volumes(vessel, &plan.grid, plan.block_cells_log2));
    let (blocks, fast) = tallies(plan, particles);
    ladder.start(ladder.demand(&blocks, &fast, [0; 2]))?;
    let mut account = Account::new(plan);
    account.start_with(particles, &inflow);
    let zones = scene.chambers.len() + scene.probes.len();
    Ok(RunState {
        clock: clock.state(),
        ladder: ladder.state(),
        averages: AveragesState::starting_at(
            clock.time(),
            &Counts {
                zones,
                gases: plan.gases.len(),
                patches: patches(model).1.len(),
                surface_models: surface_models.placed.len(),
                vents: scene.vents.len(),
            },
        ),
        account: account.state().clone(),
        inflow: inflow.state(),
        feedback: Vec::new(),
        switch: SwitchState::default(),
        vents: parent.vents.clone(),
        fabric: None,
        surfaces: parent.surfaces.clone(),
        guards: GuardState::default(),
        submitted: 0,
        next_row: parent.next_row,
        next_snapshot: parent.next_snapshot,
        read_until: clock.time(),
        repeated: 0,
    })
}

/// Those of `shaders/blocks.wgsl`: number and kinetic energy in each block, and how many particles are too fast for each
/// level of the ladder.
fn tallies(plan: &Plan, particles: &[GpuParticle]) -> (Vec<BlockSum>, Vec<u32>) {
    let grid = &plan.grid;
    let scales = Scales::new(plan);
    let [nx, ny, nz] = grid.blocks(plan.block_cells_log2).map(|n| n as usize);
    let mut blocks = vec![BlockSum::default(); nx * ny * nz];
    let mut fast = vec![0; plan.ladder_levels as usize];
    for particle in particles {
        let cell = grid.cell_of(particle.position);
        let at = |axis: usize| (cell[axis].clamp(1, grid.cells[axis] - 2) >> plan.block_cells_log2) as usize;
        let block = &mut blocks[(at(2) * ny + at(1)) * nx + at(0)];
        let square: f64 = particle.velocity.iter().map(|&v| f64::from(v).powi(2)).sum();
        let mass = plan.gases[usize::from(particle.gas())].molar_mass * plan.moles_per_particle;
        block.number += 1;
        block.energy += (0.5 * mass / scales.reference_mass * square * scales.block_energy).round() as u64;
        let mut reach = square.sqrt() * plan.time_step / grid.cell;
        for count in &mut fast {
            if reach <= 1.0 {
                break;
            }
            *count += 1;
            reach *= 0.5;
        }
    }
    (blocks, fast)
}
