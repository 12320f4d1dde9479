//! The comparison can fail: what a message loses or changes on its way is seen, or ends the run.

use std::cell::Cell;

use corpuscle::ranks::{Communicator, RankError, Reduction};
use corpuscle::simulation::BalanceMode::Off;
use corpuscle::simulation::Options;
use corpuscle::subdomain::{GpuParticle, GpuUpdate};

use crate::among::{Way, World, Wrap};
use crate::bits::{Bits, difference};
use crate::scenes::gas_box;
use crate::whole_run::run;

/// What becomes of the message of rank 1 that has the turn.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// Its first update of a ghost is missing.
    LoseUpdate,
    /// A ghost is told another velocity.
    AlterUpdate,
    /// Its first particle is missing.
    LoseParticle,
    /// An update names a ghost that is not there.
    AlterId,
    /// It never comes.
    LoseMessage,
}

struct Faulty<'a> {
    inner: &'a dyn Communicator,
    fault: Fault,
    done: Cell<bool>,
    sent: Cell<u32>,
}

const PARTICLE: usize = size_of::<GpuParticle>();
const UPDATE: usize = size_of::<GpuUpdate>();
/// Messages that pass first.
const BEFORE: u32 = 50;

impl Faulty<'_> {
    /// The message as it arrives; `None` if it does not.
    fn spoilt(&self, mut message: Vec<u8>) -> Option<Vec<u8>> {
        self.sent.set(self.sent.get() + 1);
        // Messages of particles alternate with those of updates (one exchange of them each step, in the way
        // below), which come second.
        let updates = self.sent.get().is_multiple_of(2);
        if self.inner.rank() != 1 || self.done.get() || self.sent.get() <= BEFORE || message.is_empty() {
            return Some(message);
        }
        let fits = match self.fault {
            Fault::None => false,
            Fault::LoseMessage => true,
            Fault::LoseParticle => !updates,
            _ => updates,
        };
        self.done.set(fits);
        if !fits {
            return Some(message);
        }
        match self.fault {
            Fault::LoseMessage => return None,
            Fault::LoseParticle => drop(message.drain(..PARTICLE)),
            Fault::LoseUpdate => drop(message.drain(..UPDATE)),
            // The low bits of a velocity; the id.
            Fault::AlterUpdate => message[16] ^= 1,
            Fault::AlterId => message[12] ^= 1,
            Fault::None => {}
        }
        Some(message)
    }
}

impl Communicator for Faulty<'_> {
    fn rank(&self) -> usize {
        self.inner.rank()
    }

    fn size(&self) -> usize {
        self.inner.size()
    }

    fn node_rank(&self) -> usize {
        self.inner.node_rank()
    }

    fn node_size(&self) -> usize {
        self.inner.node_size()
    }

    fn in_process(&self) -> bool {
        self.inner.in_process()
    }

    fn send(&self, dest: usize, message: Vec<u8>) -> Result<(), RankError> {
        self.spoilt(message).map_or(Ok(()), |message| self.inner.send(dest, message))
    }

    fn receive(&self, source: usize) -> Result<Vec<u8>, RankError> {
        self.inner.receive(source)
    }

    fn start_reduction(&self, sums: Vec<u64>, maxima: Vec<u64>) -> Result<Reduction, RankError> {
        self.inner.start_reduction(sums, maxima)
    }

    fn finish_reduction(&self, reduction: Reduction) -> Result<(Vec<u64>, Vec<u64>), RankError> {
        self.inner.finish_reduction(reduction)
    }

    fn gather(&self, message: Vec<u8>) -> Result<Option<Vec<Vec<u8>>>, RankError> {
        self.inner.gather(message)
    }

    fn all_gather(&self, message: Vec<u8>) -> Result<Vec<Vec<u8>>, RankError> {
        self.inner.all_gather(message)
    }

    fn broadcast(&self, message: Vec<u8>) -> Result<Vec<u8>, RankError> {
        self.inner.broadcast(message)
    }

    fn barrier(&self) -> Result<(), RankError> {
        self.inner.barrier()
    }

    fn fail(&self, message: &str, exit_code: i32) {
        self.inner.fail(message, exit_code);
    }
}

fn spoiling(fault: Fault) -> Box<Wrap> {
    Box::new(move |inner| Box::new(Faulty { inner, fault, done: Cell::new(false), sent: Cell::new(0) }))
}

/// A single lost or altered record of one message gives other bits or an error that says what is wrong, never a
/// run that hangs.
#[test]
fn a_spoilt_message_is_seen() {
    let mut model = gas_box();
    model.scene.output.rows = 5;
    let alone = Bits::of(&run(&model, Options::default()));
    let world = World::new(&model);
    // Eight rounds, halves of four: one exchange of updates a step.
    let way = Way::new(2, Off, 4);
    let outcome = |fault: Fault| {
        world.try_run(&way, Some(&*spoiling(fault))).map(|run| difference(&alone, &Bits::of(&run)))
    };
    assert_eq!(outcome(Fault::None), Ok(None));
    for fault in [Fault::LoseUpdate, Fault::AlterUpdate] {
        let found = outcome(fault);
        assert!(matches!(&found, Ok(Some(_)) | Err(_)), "{fault:?}: {found:?}");
    }
    let missing = outcome(Fault::AlterId);
    assert!(missing.as_ref().is_err_and(|error| error.contains("updates of ghosts")), "{missing:?}");
    let stuck = outcome(Fault::LoseMessage);
    assert!(stuck.as_ref().is_err_and(|error| error.contains("message")), "{stuck:?}");
    let lost = outcome(Fault::LoseParticle);
    assert!(matches!(&lost, Ok(Some(_)) | Err(_)), "{lost:?}");
}
