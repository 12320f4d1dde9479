//! How many rounds of collisions to go between two exchanges of ghosts, found by trying.
//!
//! Few rounds need a thin halo and many messages, many rounds a thick halo and few messages: what is best
//! depends on the devices, the network and the size of the subdomains. Every choice gives the same bits. Each
//! candidate runs for a few intervals; the fastest stays until the number of particles has changed much.

/// Intervals per candidate; the first of them makes room and is not judged.
const TRIALS: usize = 3;
/// Change of the number of particles after which the choice is made anew.
const CHANGE: f64 = 1.5;

pub struct Tuner {
    candidates: Vec<u32>,
    /// s per particle and step, the fastest seen, by candidate.
    fastest: Vec<f64>,
    /// Intervals submitted since the trials began.
    submitted: usize,
    /// What the intervals under way run with, oldest first, and whether it is judged.
    under_way: std::collections::VecDeque<Option<usize>>,
    /// What stays, and the particles when it was chosen.
    chosen: Option<(u32, u64)>,
}

impl Tuner {
    /// `fixed`: no trials.
    pub fn new(rounds: u32, fixed: Option<u32>) -> Tuner {
        if rounds == 0 {
            // Nothing is exchanged between rounds.
            return Tuner::of(vec![0]);
        }
        let powers = (0..).map(|power| 1 << power).take_while(|&candidate| candidate < rounds);
        let candidates: Vec<u32> = match fixed {
            Some(fixed) => vec![fixed.clamp(1, rounds)],
            None => powers.chain([rounds]).collect(),
        };
        Tuner::of(candidates)
    }

    fn of(candidates: Vec<u32>) -> Tuner {
        Tuner {
            fastest: vec![f64::INFINITY; candidates.len()],
            candidates,
            submitted: 0,
            under_way: std::collections::VecDeque::new(),
            chosen: None,
        }
    }

    /// What the first interval runs with.
    pub fn first(&self) -> u32 {
        self.candidates[0]
    }

    /// What the next interval runs with.
    pub fn next(&mut self) -> u32 {
        if let Some((chosen, _)) = self.chosen {
            self.under_way.push_back(None);
            return chosen;
        }
        let trial = self.submitted / TRIALS;
        let judged = !self.submitted.is_multiple_of(TRIALS);
        self.submitted += 1;
        match self.candidates.get(trial) {
            Some(&rounds) => {
                self.under_way.push_back(judged.then_some(trial));
                rounds
            }
            // All were tried, and the last results are on their way.
            None => {
                self.under_way.push_back(None);
                self.best()
            }
        }
    }

    /// An interval ran again, with others after it: times of those under way say nothing.
    pub fn disturbed(&mut self) {
        self.under_way.iter_mut().for_each(|trial| *trial = None);
    }

    /// The oldest interval under way took `seconds` (the slowest rank's) for `steps` steps of `particles`.
    pub fn measured(&mut self, seconds: f64, steps: u32, particles: u64) {
        let trial = self.under_way.pop_front().flatten();
        if let Some(trial) = trial {
            let cost = seconds / (f64::from(steps) * particles.max(1) as f64);
            self.fastest[trial] = self.fastest[trial].min(cost);
        }
        match self.chosen {
            None if self.submitted > TRIALS * self.candidates.len() && !self.under_way.iter().any(Option::is_some) => {
                self.chosen = Some((self.best(), particles));
                tracing::debug!(
                    "{} rounds between two exchanges; tried {:?}: {:?}",
                    self.best(),
                    self.candidates,
                    self.fastest
                );
            }
            Some((_, then)) if self.candidates.len() > 1 => {
                let change = particles.max(1) as f64 / then.max(1) as f64;
                if !(1.0 / CHANGE..CHANGE).contains(&change) {
                    self.chosen = None;
                    self.submitted = 0;
                    self.fastest.fill(f64::INFINITY);
                }
            }
            _ => {}
        }
    }

    fn best(&self) -> u32 {
        let fastest = (0..self.candidates.len()).min_by(|&a, &b| self.fastest[a].total_cmp(&self.fastest[b]));
        self.candidates[fastest.unwrap_or(0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs `intervals`, two under way at once, with a cost for each choice; what was run with.
    fn run(tuner: &mut Tuner, intervals: usize, particles: u64, cost: impl Fn(u32) -> f64) -> Vec<u32> {
        let mut under_way = std::collections::VecDeque::new();
        let mut ran = Vec::new();
        for _ in 0..intervals {
            let rounds = tuner.next();
            under_way.push_back(rounds);
            ran.push(rounds);
            if under_way.len() > 2 {
                let done = under_way.pop_front().unwrap();
                tuner.measured(cost(done), 32, particles);
            }
        }
        while let Some(done) = under_way.pop_front() {
            tuner.measured(cost(done), 32, particles);
        }
        ran
    }

    /// The fastest of all divisions of the rounds is found and kept; when the gas has changed, another may be.
    #[test]
    fn the_fastest_choice_stays() {
        let mut tuner = Tuner::new(8, None);
        let ran = run(&mut tuner, 40, 1000, |rounds| f64::from(rounds.abs_diff(4)) + 1.0);
        assert!([1, 2, 4, 8].iter().all(|candidate| ran[..12].contains(candidate)), "{ran:?}");
        assert!(ran[16..].iter().all(|&rounds| rounds == 4), "{ran:?}");
        run(&mut tuner, 1, 2000, |_| 1.0);
        let ran = run(&mut tuner, 40, 2000, |rounds| f64::from(rounds.abs_diff(1)) + 1.0);
        assert!(ran[20..].iter().all(|&rounds| rounds == 1), "{ran:?}");
    }

    /// What was asked for is not put to trial, and is at most the rounds there are.
    #[test]
    fn a_fixed_choice_stays() {
        assert!(run(&mut Tuner::new(8, Some(2)), 30, 1000, |_| 1.0).iter().all(|&rounds| rounds == 2));
        assert_eq!(Tuner::new(3, Some(8)).first(), 3);
        assert!(run(&mut Tuner::new(3, None), 9, 1000, |_| 1.0).contains(&3));
    }
}
