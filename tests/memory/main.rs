//! Law: no rank has the particles of all in its host's memory, neither at the start of a run nor when it goes on from a
//! checkpoint.
//!
//! Ranks are threads here, so that what all of them hold is what the process does: at its peak a few times the particles,
//! however many ranks there are. The allocator counts.

#[allow(dead_code)] // Each test binary uses its own part.
#[path = "../whole_run/mod.rs"]
mod whole_run;

use std::alloc::{GlobalAlloc, Layout, System};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::sync::{Arc, Mutex, MutexGuard};

use corpuscle::output::{
    Adapter, AppendedState, Checkpoint, CheckpointWriter, HistoryState, Moment, Origin, OutputState,
};
use corpuscle::ranks::{Communicator, Pace, in_process};
use corpuscle::simulation::{Initial, Model, Stock};
use corpuscle::subdomain::GpuParticle;

const RANKS: usize = 8;
const PARTICLES: u64 = 600_000;
/// The shares, what is owned in memory that has grown by doubling, and what is under way.
const MOST: usize = 4 * PARTICLES as usize * size_of::<GpuParticle>();

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);

struct Counting;

#[global_allocator]
static ALLOCATOR: Counting = Counting;

// SAFETY: all is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        PEAK.fetch_max(HELD.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(memory, layout) }
    }
}

/// One test at a time: what another held would count.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// What the act holds at its peak.
fn peak(act: impl FnOnce()) -> usize {
    let before = HELD.load(Relaxed);
    PEAK.store(before, Relaxed);
    act();
    PEAK.load(Relaxed) - before
}

fn gas_box() -> Model {
    let model = whole_run::published("box.toml", PARTICLES, 1e-3);
    assert!(model.plan.initial_particles >= PARTICLES - 10);
    model
}

/// Each rank takes its share of the stock, and hands the others what is theirs; all hold what they own until all have it.
fn deal(stock: &Stock, model: &Model) {
    let dealt = in_process(RANKS, Pace::Together, |comm: &dyn Communicator| {
        let share = stock.share(model, comm).unwrap();
        let own = stock.own(model, comm, share, |particle| particle.id() as usize % RANKS).unwrap();
        comm.barrier().unwrap();
        assert!(own.iter().all(|particle| particle.id() as usize % RANKS == comm.rank()));
        own.len() as u64
    });
    assert_eq!(dealt.unwrap().iter().sum::<u64>(), model.plan.initial_particles);
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
    let origin = Origin { scene: String::new(), plan: String::new(), meshes: Vec::new(), adapter: Adapter::default() };
    let file = AppendedState { bytes: 0, crc32: 0 };
    let output = OutputState { history: HistoryState { rows: 0, file }, snapshots: None };
    let path = writer.commit(files, &moment, &origin, &1_u64, &output).unwrap();
    Checkpoint::open(&path).unwrap()
}

#[test]
fn at_the_start_no_rank_has_all_particles() {
    let _alone = alone();
    let model = gas_box();
    let found = peak(|| deal(&Stock::Initial(Initial::default()), &model));
    assert!(found < MOST, "{} MB", found >> 20);
}

#[test]
fn from_a_checkpoint_no_rank_has_all_particles() {
    let _alone = alone();
    let model = gas_box();
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = saved(folder.path(), model.plan.initial_particles as u32);
    let stock = Stock::Saved(Arc::new(checkpoint.clone()));
    let found = peak(|| deal(&stock, &model));
    assert!(found < MOST, "{} MB", found >> 20);
    // Its checks hold a bit of each particle.
    let found = peak(|| drop(Checkpoint::open(checkpoint.path()).unwrap()));
    assert!(found < MOST / 16, "{} MB", found >> 20);
    // The check can fail: each rank with all.
    let found = peak(|| {
        let all = in_process(RANKS, Pace::Together, |comm: &dyn Communicator| {
            let all = checkpoint.particles(0).unwrap();
            comm.barrier().unwrap();
            all.len()
        });
        assert_eq!(all.unwrap().len(), RANKS);
    });
    assert!(found > 3 * MOST / 2, "{} MB", found >> 20);
}
