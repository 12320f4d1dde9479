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

/// What becomes of messages of rank 1.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    None,
    /// Of what it hands out at the start a particle is missing.
    LoseStart,
    /// All updates of ghosts are missing: one alone may well concern nobody.
    LoseUpdates,
    /// All updates tell velocities that differ in the last bit.
    AlterUpdates,
    /// The particles of one message are missing.
    LoseParticles,
    /// All particles come as slots that hold none.
    EmptyParticles,
    /// All particles come with another speed along x, by up to a quarter.
    AlterParticles,
    /// Its first update names a ghost that is not there.
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

/// The end of a message says what it is about.
const SEAL: usize = 12;
const UPDATE: usize = size_of::<GpuUpdate>();
/// Of a particle, and so of an update, which begins with one.
const TAG: usize = std::mem::offset_of!(GpuParticle, tag);
const VELOCITY: usize = std::mem::offset_of!(GpuParticle, velocity);
/// Among these messages, in the first interval.
const SPOILT: std::ops::Range<u32> = 50..250;

impl Faulty<'_> {
    /// The message as it arrives; `None` if it does not.
    fn spoilt(&self, mut message: Vec<u8>) -> Option<Vec<u8>> {
        let at_start = self.sent.get() == 0;
        self.sent.set(self.sent.get() + 1);
        if at_start {
            // One has what the other owns of the initial gas.
            if self.fault == Fault::LoseStart && self.inner.rank() == 1 {
                message.truncate(message.len() - size_of::<GpuParticle>());
            }
            return Some(message);
        }
        // In the way below a step sends particles, then updates before each round but the first; the first step
        // sends updates once more, to count lost collisions.
        let updates = (self.sent.get() - 1) % 8 != 2;
        // What lies in places without a particle may ask for longer lists: then the interval runs again, in other messages.
        let spoils = match self.fault {
            Fault::EmptyParticles => self.sent.get() >= SPOILT.start,
            _ => SPOILT.contains(&self.sent.get()),
        };
        if self.inner.rank() != 1 || self.done.get() || !spoils || message.len() <= SEAL {
            return Some(message);
        }
        let fits = match self.fault {
            Fault::None | Fault::LoseStart => false,
            Fault::LoseMessage => true,
            Fault::LoseParticles | Fault::EmptyParticles | Fault::AlterParticles => !updates,
            _ => updates,
        };
        if !fits {
            return Some(message);
        }
        let all = [Fault::LoseUpdates, Fault::AlterUpdates, Fault::EmptyParticles, Fault::AlterParticles];
        self.done.set(!all.contains(&self.fault));
        match self.fault {
            Fault::LoseMessage => return None,
            Fault::LoseParticles | Fault::LoseUpdates => drop(message.drain(..message.len() - SEAL)),
            Fault::AlterUpdates => message.chunks_exact_mut(UPDATE).for_each(|update| update[VELOCITY] ^= 1),
            Fault::EmptyParticles => {
                let records = message.len() - SEAL;
                let particles = message[..records].chunks_exact_mut(size_of::<GpuParticle>());
                particles.for_each(|particle| particle[TAG..TAG + 4].fill(0xff));
            }
            Fault::AlterParticles => {
                let records = message.len() - SEAL;
                let particles = message[..records].chunks_exact_mut(size_of::<GpuParticle>());
                particles.for_each(|particle| particle[VELOCITY + 2] ^= 0x20);
            }
            Fault::AlterId => message[TAG] ^= 1,
            Fault::None | Fault::LoseStart => {}
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

/// One lost or altered message gives other bits or an error that says what is wrong, never a
/// run that hangs.
#[test]
fn a_spoilt_message_is_seen() {
    let mut model = gas_box();
    model.scene.output.rows = 5;
    let alone = Bits::of(&run(&model, Options::default()));
    let world = World::new(&model);
    assert_eq!((model.plan.rounds, model.plan.steps_per_interval), (8, 32), "what the faults are made for");
    let way = Way::new(2, Off, 1);
    let outcome =
        |fault: Fault| world.try_run(&way, Some(&*spoiling(fault))).map(|run| difference(&alone, &Bits::of(&run)));
    assert_eq!(outcome(Fault::None), Ok(None));
    for fault in [Fault::LoseUpdates, Fault::AlterUpdates, Fault::LoseParticles] {
        let found = outcome(fault);
        assert!(matches!(&found, Ok(Some(_)) | Err(_)), "{fault:?}: {found:?}");
    }
    let fewer = outcome(Fault::LoseStart);
    assert!(fewer.as_ref().is_err_and(|error| error.contains("came to the ranks that own them")), "{fewer:?}");
    // So many are missing that no run goes on.
    let fewer = outcome(Fault::EmptyParticles);
    let missed = ["updates of ghosts", "particles are there"];
    assert!(fewer.as_ref().is_err_and(|error| missed.iter().any(|what| error.contains(what))), "{fewer:?}");
    // Ranks that know other speeds of a particle both take it for theirs, or neither: the count after an interval is off.
    let doubled = outcome(Fault::AlterParticles);
    assert!(doubled.as_ref().is_err_and(|error| error.contains("particles are there")), "{doubled:?}");
    let missing = outcome(Fault::AlterId);
    assert!(missing.as_ref().is_err_and(|error| error.contains("updates of ghosts")), "{missing:?}");
    let stuck = outcome(Fault::LoseMessage);
    assert!(stuck.as_ref().is_err_and(|error| error.contains("message")), "{stuck:?}");
}
