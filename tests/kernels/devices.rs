//! The devices of these tests: two, since a software device compiles its kernels one after the other.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use corpuscle::gpu::Device;

static DEVICES: [OnceLock<Device>; 2] = [const { OnceLock::new() }; 2];
/// The tests that have each of them at the moment.
static TESTS: [AtomicUsize; 2] = [const { AtomicUsize::new(0) }; 2];

/// Which of the devices a test has, whose thread is its own, to its end.
struct Seat(usize);

impl Seat {
    fn take() -> Seat {
        let [first, second] = [0, 1].map(|at: usize| TESTS[at].load(Ordering::Relaxed));
        let seat = Seat(usize::from(second < first));
        TESTS[seat.0].fetch_add(1, Ordering::Relaxed);
        seat
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        TESTS[self.0].fetch_sub(1, Ordering::Relaxed);
    }
}

thread_local!(static SEAT: Seat = Seat::take());

pub fn device() -> &'static Device {
    let at = SEAT.with(|seat| seat.0);
    DEVICES[at].get_or_init(|| Device::open(None).expect("a device (install Mesa's lavapipe where there is no GPU)"))
}
