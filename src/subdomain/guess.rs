//! How much of an outbox is copied before it is known how much is in it.

/// Least entries that are copied with the counts, before it is known how many there are.
const LEAST_GUESS: u64 = 256;

/// What of an outbox is copied at once: as much as was in it lately, and some more.
#[derive(Debug, Clone, Copy)]
pub struct Guess(u64);

impl Guess {
    pub fn entries(self) -> u64 {
        self.0
    }

    pub fn new() -> Guess {
        Guess(LEAST_GUESS)
    }

    pub fn follow(&mut self, count: u64) {
        let wanted = (count + count / 4).max(LEAST_GUESS);
        // Up at once, down slowly.
        self.0 = wanted.max(self.0 - self.0 / 16);
    }
}
