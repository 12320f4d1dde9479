//! Law: a run's bits depend on its scene alone (method.md, "Equal bits"). The history (every f64), the final
//! state (every byte of every particle), the counts and the audit are the same whatever the order of the initial
//! particles, the length of the batches, the growth of buffers on the way, and from run to run; and also however
//! many ranks share the space, however it is cut and cut anew, and whichever rank is first.

#[path = "../whole_run/mod.rs"]
mod whole_run;

mod alone;
mod among;
mod bits;
mod faults;
mod half_turn;
mod hashes;
mod orders;
mod ranks;
mod scenes;
