mod clock;
mod ladder;
mod step;
pub use clock::Clock;
pub use ladder::{Demand, Ladder, LadderError};
pub use step::{Sampling, step};
