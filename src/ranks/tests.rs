//! Laws of the ranks of one process.

use super::conformance::CHECKS;
use super::{Communicator, Pace, RankError, Solo, in_process};
use std::sync::atomic::{AtomicUsize, Ordering};

const PACES: [Pace; 2] = [Pace::Together, Pace::OneAtATime];

fn conforms(size: usize, pace: Pace) {
    let results = in_process(size, pace, |comm| {
        for (law, check) in CHECKS {
            if let Err(message) = check(comm) {
                let message = format!("{law}: {message}");
                comm.fail(&message, 1);
                return Err(message);
            }
        }
        Ok(())
    });
    let failed: Vec<String> = results.unwrap().into_iter().filter_map(Result::err).collect();
    assert!(failed.is_empty(), "{size} ranks, {pace:?}: {}", failed.join("\n"));
}

#[test]
fn one_process_conforms() {
    let solo = Solo::new();
    for (law, check) in CHECKS {
        check(&solo).unwrap_or_else(|message| panic!("{law}: {message}"));
    }
}

#[test]
fn a_few_ranks_of_a_process_conform() {
    for size in [1, 2, 3, 8] {
        for pace in PACES {
            conforms(size, pace);
        }
    }
}

#[test]
fn many_ranks_of_a_process_conform() {
    for pace in PACES {
        conforms(64, pace);
    }
}

type Call = fn(&dyn Communicator) -> Result<(), RankError>;

/// What others wait for when one fails.
const WAITS: [Call; 4] = [
    |comm| comm.receive(1).map(drop),
    |comm| comm.barrier(),
    |comm| comm.sum(vec![1]).map(drop),
    |comm| comm.gather(Vec::new()).map(drop),
];

/// Whoever waits, and whoever calls later, hears who failed first and why.
#[test]
fn a_failure_ends_all() {
    for pace in PACES {
        for wait in WAITS {
            let heard = in_process(5, pace, |comm| {
                if comm.rank() == 1 {
                    comm.fail("out of gas", 3);
                    comm.fail("out of luck", 3);
                    return comm.send(0, Vec::new()).unwrap_err();
                }
                let error = wait(comm).unwrap_err();
                assert_eq!(comm.barrier(), Err(error.clone()));
                error
            });
            assert_eq!(heard.unwrap(), vec![RankError::Failed { rank: 1, message: "out of gas".to_owned() }; 5]);
        }
    }
    let solo = Solo::new();
    solo.fail("out of gas", 3);
    assert_eq!(solo.barrier(), Err(RankError::Failed { rank: 0, message: "out of gas".to_owned() }));
}

/// A panic of one rank ends all, and the run is an error that names it.
#[test]
fn a_panic_ends_all() {
    for pace in PACES {
        let result = in_process(4, pace, |comm| {
            assert_ne!(comm.rank(), 2, "two is one too many");
            comm.barrier().unwrap_err()
        });
        let Err(RankError::Failed { rank: 2, message }) = result else { panic!("{result:?}") };
        assert!(message.starts_with("panicked: ") && message.contains("two is one too many"), "{message}");
    }
}

/// Ranks that all wait for each other are told so.
#[test]
fn a_circle_of_waiting_ranks_is_an_error() {
    for pace in PACES {
        let heard = in_process(3, pace, |comm| comm.receive((comm.rank() + 1) % 3).unwrap_err()).unwrap();
        let RankError::Stuck { waits } = &heard[0] else { panic!("{heard:?}") };
        assert!(waits.contains("rank 2 for a message from rank 0"), "{waits}");
        assert!(heard.iter().all(|error| *error == heard[0]));
        let heard = in_process(2, pace, |comm| if comm.rank() == 0 { comm.barrier() } else { Ok(()) }).unwrap();
        assert!(matches!(&heard[0], Err(RankError::Stuck { .. })), "{heard:?}");
        let heard = in_process(2, pace, |comm| if comm.rank() == 0 { comm.receive(1).map(drop) } else { Ok(()) });
        let Ok([Err(error), Ok(())]) = heard.as_deref() else { panic!("{heard:?}") };
        assert!(error.to_string().contains("which has ended"), "{error}");
    }
}

/// Different collective calls do not meet.
#[test]
fn collective_calls_out_of_sequence_are_an_error() {
    for pace in PACES {
        let heard = in_process(2, pace, |comm| match comm.rank() {
            0 => comm.barrier(),
            _ => comm.all_gather(Vec::new()).map(drop),
        });
        for error in heard.unwrap() {
            assert!(matches!(error, Err(RankError::Sequence { .. })), "{error:?}");
        }
    }
}

/// One at a time: between two calls no other rank runs, and they take turns in the same order every time.
#[test]
fn one_at_a_time_is_one_at_a_time() {
    let running = AtomicUsize::new(0);
    let turns = || {
        let order = std::sync::Mutex::new(Vec::new());
        let work = |comm: &dyn Communicator| {
            assert_eq!(running.fetch_add(1, Ordering::SeqCst), 0, "another rank runs");
            std::thread::yield_now();
            order.lock().unwrap().push(comm.rank());
            assert_eq!(running.fetch_sub(1, Ordering::SeqCst), 1);
        };
        in_process(6, Pace::OneAtATime, |comm| {
            let (own, size) = (comm.rank(), comm.size());
            for _ in 0..20 {
                work(comm);
                comm.send((own + 1) % size, vec![1]).unwrap();
                work(comm);
                comm.receive((own + size - 1) % size).unwrap();
                work(comm);
                comm.sum(vec![1]).unwrap();
            }
        })
        .unwrap();
        order.into_inner().unwrap()
    };
    let first = turns();
    assert_eq!(first.len(), 6 * 60);
    for _ in 0..3 {
        assert_eq!(turns(), first);
    }
}

/// As many ranks as the largest published run had devices.
#[test]
fn hundreds_of_ranks_exchange() {
    for pace in PACES {
        let sums = in_process(384, pace, |comm| {
            let (own, size) = (comm.rank(), comm.size());
            let mut sum = Vec::new();
            for step in 1..5 {
                comm.send((own + step) % size, vec![step as u8]).unwrap();
                assert_eq!(comm.receive((own + size - step) % size).unwrap(), vec![step as u8]);
                sum = comm.sum(vec![own as u64]).unwrap();
            }
            sum
        });
        assert_eq!(sums.unwrap(), vec![vec![384 * 383 / 2]; 384]);
    }
}

/// A message that MPI could not count is refused everywhere.
#[test]
fn too_long_a_message_is_refused() {
    // Zeroed memory that nobody touches takes no space.
    let long = || vec![0; super::LONGEST_MESSAGE + 1];
    let error = RankError::TooLong { bytes: super::LONGEST_MESSAGE + 1 };
    let heard = in_process(2, Pace::Together, |comm| {
        let message = || if comm.rank() == 0 { long() } else { Vec::new() };
        let gathered = comm.gather(message()).map(drop);
        [comm.send(1 - comm.rank(), long()), gathered, comm.broadcast(message()).map(drop)]
    });
    assert_eq!(heard.unwrap(), vec![[const { Err(()) }; 3].map(|_: Result<(), ()>| Err(error.clone())); 2]);
    assert_eq!(Solo::new().broadcast(long()), Err(error));
}
