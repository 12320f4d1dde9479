//! What a time loop knows beside the particles, as plain data: with the particles it continues a run to the bit.
//!
//! Taken between intervals, when no interval is under way. Nothing in it depends on the number of ranks. What the scene
//! and the plan say is not in it: a run is set up from them anew and then put where it was.

use serde::{Deserialize, Serialize};

use crate::gas::InflowState;
use crate::output::{Checkpoint, CheckpointError};
use crate::simulation::accounting::audit::AccountState;
use crate::simulation::accounting::averages::AveragesState;
use crate::simulation::accounting::guards::GuardState;
use crate::simulation::accounting::vent_watch::VentWatch;
use crate::simulation::control::clock::ClockState;
use crate::simulation::control::ladder::{Demand, LadderState};
use crate::simulation::control::surface_states::{SeenGas, SurfaceMemory};
use crate::simulation::zero_d::switch::SwitchState;
use crate::subdomain::GpuParticle;

/// All particles of a checkpoint, by id.
///
/// # Errors
/// If a file is not as it was written.
pub fn particles_of(checkpoint: &Checkpoint) -> Result<Vec<GpuParticle>, CheckpointError> {
    let mut all: Vec<GpuParticle> = Vec::new();
    for file in 0..checkpoint.particle_files() {
        all.extend(bytemuck::pod_collect_to_vec::<u8, GpuParticle>(&checkpoint.particles(file)?));
    }
    all.sort_unstable_by_key(GpuParticle::id);
    Ok(all)
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunState {
    pub clock: ClockState,
    pub ladder: LadderState,
    pub averages: AveragesState,
    pub account: AccountState,
    pub inflow: InflowState,
    /// What states read so far ask and no interval has followed yet, oldest first.
    pub feedback: Vec<Feedback>,
    pub surfaces: SurfaceMemory,
    pub guards: GuardState,
    pub switch: SwitchState,
    /// What was seen of each vent of the scene.
    pub vents: Vec<VentWatch>,
    /// Of elastic fabric.
    pub fabric: Option<FabricState>,
    /// Intervals so far.
    pub submitted: u64,
    /// s.
    pub next_row: f64,
    pub next_snapshot: u32,
    /// s.
    pub read_until: f64,
    /// How often steps were run again.
    pub repeated: u32,
}

/// Elastic fabric between intervals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FabricState {
    /// What the device has of its nodes and triangles.
    pub membrane: Vec<u32>,
    /// What the gas gave each node in the last step, on all ranks.
    pub impulses: Vec<u64>,
    /// Its open window: how many steps, and the volumes and areas of its surfaces summed over them.
    pub window: (u64, Vec<[f64; 2]>),
    /// Kinetic and strain energy at the start of the run, J.
    pub start: [f64; 2],
}

/// What the state at the end of an interval asks of one to come.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Feedback {
    /// Of the step and the diameters.
    pub demand: Demand,
    /// Of the walls, by what they have seen.
    pub seen: SeenGas,
    /// Particles that had left.
    pub left: u64,
    /// Whether a control volume takes over.
    pub switches: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gas::{Inflow, InflowParticles};
    use crate::plan::Plan;
    use crate::simulation::accounting::audit::Account;
    use crate::simulation::accounting::averages::{Averages, Sampled};
    use crate::simulation::accounting::row::Layout;
    use crate::simulation::control::clock::Clock;
    use crate::simulation::control::ladder::Ladder;
    use crate::simulation::control::surface_states::VentTarget;
    use crate::simulation::model::build::Model;
    use crate::simulation::zero_d::switch::{Decided, Deviations};
    use crate::subdomain::{SurfaceModelSum, SurfaceSum, Tallies, VentSum, ZoneSum};

    fn plan() -> Plan {
        let text = include_str!("../../scenes/tank.toml").replace("particles = 1000000", "particles = 2000");
        let scene = crate::scene::parse(&text, "tank.toml", std::path::Path::new("")).unwrap();
        Model::new(scene).unwrap().plan
    }

    const PATCHES: usize = 2;
    const SURFACE_MODELS: usize = 2;
    const VENTS: usize = 1;
    const MOTIONS: usize = 1;

    fn averages(plan: &Plan) -> Averages {
        let layout = Layout {
            volumes: vec![1e-3, 2e-3, 1e-4],
            chambers: 2,
            surfaces: vec![(vec![0], 0.1), (vec![0, 1], 0.3)],
            walls: vec![(vec![0, 1], 0.2)],
            surface_models: SURFACE_MODELS,
            vents: vec![false; VENTS],
            motions: MOTIONS,
            fabrics: 0,
            elastic: false,
            patches: 0,
        };
        Averages::new(plan, layout, PATCHES)
    }

    /// Tallies that differ from interval to interval, with sums as large as they come.
    fn tallies(plan: &Plan, interval: i64) -> Tallies {
        let zones = (0..4 * plan.gases.len() as i64).map(|zone| ZoneSum {
            number: if zone < plan.gases.len() as i64 { 3 } else { 100 + zone + interval },
            velocity: [interval << 40, -(zone << 33), 7],
            kinetic: (1 << 50) + interval,
            spin: 1 << 45,
        });
        let surfaces = (0..PATCHES as i64).map(|patch| SurfaceSum {
            impulse: [i64::MAX - patch, i64::MIN + interval, 1],
            normal: 1 << (40 + patch),
            hits: interval,
        });
        Tallies {
            counters: crate::subdomain::Counters::default(),
            zones: zones.collect(),
            surfaces: surfaces.collect(),
            surface_models: vec![SurfaceModelSum { energy: 1 << 50, tallied: -interval }; SURFACE_MODELS],
            vents: vec![VentSum { energy: interval, left: [3; 16], ..VentSum::default() }; VENTS],
            passages: Vec::new(),
            works: vec![SurfaceModelSum { energy: 3 - interval, tallied: 0 }; MOTIONS],
            blocks: Vec::new(),
            fast: Vec::new(),
        }
    }

    fn wanted(interval: i64) -> Vec<VentTarget> {
        vec![VentTarget { mass: 0.1 * interval as f64, isentropic: 0.3 }; VENTS]
    }

    fn through_bytes<T: Serialize + serde::de::DeserializeOwned>(state: &T) -> T {
        postcard::from_bytes(&postcard::to_stdvec(state).unwrap()).unwrap()
    }

    /// Wherever the window is cut, its row and all later rows are the same to the bit, and so are the impulses, which
    /// are longer than 64 bits.
    #[test]
    fn restored_averages_give_the_same_rows() {
        let plan = plan();
        let rows = |cut: Option<i64>, forget: bool| {
            let mut averages = averages(&plan);
            let mut rows = Vec::new();
            for interval in 1..=9 {
                let sampled = Sampled { dt: 1e-6 / interval as f64, steps: 32, samples: 4 };
                averages.add(&tallies(&plan, interval), sampled, &wanted(interval));
                averages.add_room(sampled, &[1e-3 / interval as f64, 2e-3, 1e-4]);
                if interval % 4 == 0 {
                    rows.push(averages.row(1e-5 * interval as f64, 2000));
                }
                if cut == Some(interval) {
                    let mut state = through_bytes(&averages.state());
                    assert_eq!(state, averages.state());
                    if forget {
                        state.received.fill([0; 3]);
                    }
                    averages = self::averages(&plan);
                    averages.restore(&state).unwrap();
                }
            }
            rows.push(averages.row(1e-4, 2000));
            (rows, averages.total_impulse())
        };
        let whole = rows(None, false);
        for cut in 1..=9 {
            assert_eq!(rows(Some(cut), false), whole, "cut after interval {cut}");
        }
        assert_ne!(rows(Some(5), true), whole);
    }

    #[test]
    fn averages_of_another_scene_are_refused() {
        let plan = plan();
        let layout = Layout { volumes: vec![1e-3], chambers: 1, ..Layout::default() };
        let other = Averages::new(&plan, layout, 0).state();
        let mut own = averages(&plan);
        own.add(&tallies(&plan, 3), Sampled { dt: 1e-6, steps: 32, samples: 4 }, &wanted(3));
        let before = own.state();
        assert!(own.restore(&other).unwrap_err().to_string().contains("sums over zones"));
        let mut short = before.clone();
        short.received.pop();
        assert!(own.restore(&short).unwrap_err().to_string().contains("impulses of patches"));
        assert_eq!(own.state(), before);
    }

    /// The whole state, with infinities in it, is the same after its way through bytes.
    #[test]
    fn the_state_of_a_run_reads_back_to_the_bit() {
        let plan = plan();
        let mut account = Account::new(&plan);
        let mut start = tallies(&plan, 0);
        for zone in &mut start.zones[..plan.gases.len()] {
            zone.number = 0;
        }
        start.zones[0].number = plan.initial_particles as i64;
        account.start(&start);
        let state = RunState {
            clock: Clock::new(&plan).state(),
            ladder: Ladder::new(&plan, Vec::new()).state(),
            averages: averages(&plan).state(),
            account: account.state().clone(),
            inflow: Inflow::new(
                &[],
                1.0,
                InflowParticles { gases: &[], moles_per_particle: 1.0, seed: 1, first_id: 0 },
            )
            .state(),
            feedback: vec![Feedback {
                demand: Demand { collision: 0.1 + 0.2, fast_level: 3, hot: true, shares: vec![1, 32768] },
                seen: SeenGas::default(),
                left: 7,
                switches: true,
            }],
            switch: SwitchState {
                recent: [Deviations { window: [0.1, 0.1 + 0.2], of_places: vec![[-1e-3, 1e-300]] }].into(),
                decided: Some(Decided { window: [0.1, 0.3], noise: 1.0 / 3.0 }),
            },
            vents: vec![VentWatch { opened: Some([0.1 + 0.2, 1e5]), ..VentWatch::default() }],
            fabric: Some(FabricState {
                membrane: vec![1, u32::MAX],
                impulses: vec![u64::MAX, 3],
                window: (32, vec![[0.1 + 0.2, 1e-300]]),
                start: [0.0, 1.0 / 3.0],
            }),
            surfaces: SurfaceMemory::default(),
            guards: GuardState::default(),
            submitted: 5,
            next_row: 1.0 / 3.0,
            next_snapshot: 2,
            read_until: 5e-324,
            repeated: 1,
        };
        let read = through_bytes(&state);
        assert_eq!(read, state);
        assert_eq!(postcard::to_stdvec(&read).unwrap(), postcard::to_stdvec(&state).unwrap());
        let mut restored = Account::new(&plan);
        restored.restore(&plan, &read.account).unwrap();
        assert_eq!(*restored.state(), state.account);
        // That of a run with another number of particles is refused.
        let other = Plan { initial_particles: plan.initial_particles + 1, ..plan.clone() };
        assert!(Account::new(&other).restore(&other, &read.account).is_err());
    }
}
