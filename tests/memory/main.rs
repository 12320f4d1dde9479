//! Law: no rank has the particles of all in its host's memory, neither at the start of a run nor when it goes on from a
//! checkpoint.
//!
//! Ranks are threads here. The allocator counts what each thread asks for and gives back; what one allocates and another frees (a
//! message) leaves the one more and the other less, so that a rank's peak is what it holds to within the messages.

#[allow(dead_code)] // Each test binary uses its own part.
#[path = "../whole_run/mod.rs"]
mod whole_run;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

use corpuscle::output::{
    Adapter, AppendedState, Checkpoint, CheckpointWriter, HistoryState, Moment, Origin, OutputState, RunContext,
};
use corpuscle::ranks::{Communicator, Pace, in_process};
use corpuscle::scene::UnitSystem;
use corpuscle::simulation::{Initial, InitialParticles, Model};
use corpuscle::subdomain::GpuParticle;

const RANKS: usize = 8;
const PARTICLES: u64 = 600_000;
/// Of all particles, what a rank may hold: its share, what it owns in memory that has grown by doubling, and what it has sent; each an
/// eighth, and the second twice.
const MOST: isize = 5 * (PARTICLES as usize * size_of::<GpuParticle>() / RANKS) as isize;

thread_local! {
    static HELD: Cell<isize> = const { Cell::new(0) };
    static PEAK: Cell<isize> = const { Cell::new(0) };
}

struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn count(bytes: isize) {
    let held = HELD.get() + bytes;
    HELD.set(held);
    PEAK.set(PEAK.get().max(held));
}

// SAFETY: all is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(layout.size() as isize);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        count(-(layout.size() as isize));
        unsafe { System.dealloc(memory, layout) }
    }
}

/// What this thread holds for the act at its peak.
fn peak(act: impl FnOnce()) -> isize {
    let before = HELD.get();
    PEAK.set(before);
    act();
    PEAK.get() - before
}

fn gas_box() -> Model {
    let model = whole_run::published("box.toml", PARTICLES, 1e-3);
    assert!(model.plan.initial_particles >= PARTICLES - 10);
    model
}

/// Each rank takes its share of the stock, and hands the others what is theirs; the peak of the one with the highest.
fn deal(stock: &InitialParticles, model: &Model) -> isize {
    let dealt = in_process(RANKS, Pace::Together, |comm: &dyn Communicator| {
        let mut number = 0;
        let peak = peak(|| {
            let share = stock.share(model, comm).unwrap();
            let own = stock.own(model, comm, share, |particle| particle.id() as usize % RANKS).unwrap();
            assert!(own.iter().all(|particle| particle.id() as usize % RANKS == comm.rank()));
            number = own.len() as u64;
        });
        (number, peak)
    });
    let dealt = dealt.unwrap();
    assert_eq!(dealt.iter().map(|(number, _)| number).sum::<u64>(), model.plan.initial_particles);
    dealt.into_iter().map(|(_, peak)| peak).max().unwrap()
}

/// All particles in the file of one rank.
fn saved(parent: &Path, number: u32) -> Checkpoint {
    let particle = |id: u32| GpuParticle {
        position: [id.wrapping_mul(0x9e37_79b9) >> 1, 7, 3],
        tag: GpuParticle::tag(0, id),
        ..Default::default()
    };
    let particles: Vec<GpuParticle> = (0..number).map(particle).collect();
    let writer = CheckpointWriter::new(parent, 1);
    let files = vec![writer.particles(0, bytemuck::cast_slice(&particles)).unwrap()];
    let moment = Moment { step: 1, time: 1.0, particles: number.into(), ids: number.into() };
    let origin = Origin {
        scene: String::new(),
        plan: String::new(),
        meshes: Vec::new(),
        adapter: Adapter::default(),
        units: UnitSystem::Si,
    };
    let file = AppendedState { bytes: 0, crc32: 0 };
    let output = OutputState { history: HistoryState { rows: 0, file }, snapshots: None };
    let path = writer.commit(files, &moment, RunContext { origin: &origin, state: &1_u64, output: &output }).unwrap();
    Checkpoint::open(&path).unwrap()
}

#[test]
fn at_the_start_no_rank_has_all_particles() {
    let model = gas_box();
    let found = deal(&InitialParticles::Sampled(Initial::default()), &model);
    assert!(found < MOST, "{} of {MOST} bytes", found);
}

#[test]
fn from_a_checkpoint_no_rank_has_all_particles() {
    let model = gas_box();
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = saved(folder.path(), model.plan.initial_particles as u32);
    let found = deal(&InitialParticles::Saved(Arc::new(checkpoint.clone())), &model);
    assert!(found < MOST, "{} of {MOST} bytes", found);
    // Its checks hold a bit of each particle.
    let found = peak(|| drop(Checkpoint::open(checkpoint.path()).unwrap()));
    assert!(found < MOST / 8, "{} of {MOST} bytes", found);
    // The check can fail: one rank with all.
    let all = in_process(RANKS, Pace::Together, |comm: &dyn Communicator| {
        peak(|| assert!(comm.rank() > 0 || !checkpoint.particles(0).unwrap().is_empty()))
    });
    let all = all.unwrap();
    assert!(all[0] > MOST && all[1..].iter().all(|&found| found < MOST / 8), "{all:?}");
}
