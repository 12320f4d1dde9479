// Loops that the device has ended too soon: some software devices end all loops of a thread, and of those that run with it, once they have
// turned so often (Mesa's lavapipe of 22.3 after 65,535 turns). What such a thread does is wrong, so it is told.

var<private> cut_short: bool;

// After a loop that goes on while k < end.
fn through(k: u32, end: u32) {
    if (k < end) {
        cut_short = true;
    }
}

// At the end of a kernel.
fn tell_cut_short() {
    if (cut_short) {
        atomicAdd(&counters[CUT_SHORT], 1u);
    }
}
