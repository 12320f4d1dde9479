//! How many rounds of collisions to go between two exchanges of ghosts, and which ghosts choose partners, found by
//! trying.
//!
//! Few rounds need a thin halo and many messages, many rounds a thick halo and few messages: what is best
//! depends on the devices, the network and the size of the subdomains. Ghosts that choose only when asked are less work
//! and more passes, so that depends on the device, too. Every choice gives the same bits. Each
//! candidate runs for a few intervals, fewest rounds first, until more rounds have proved slower; the fastest stays until
//! the number of particles has changed much.

use crate::subdomain::Ghosts;

/// How a halo is kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Halo {
    /// Rounds between two exchanges.
    pub rounds: u32,
    pub ghosts: Ghosts,
}

/// What of a halo is not to be tried out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HaloOptions {
    pub rounds: Option<u32>,
    pub ghosts: Option<Ghosts>,
}

/// Intervals per candidate; the first of them makes room and is not judged.
const TRIALS: usize = 3;
/// If twice the rounds take so many times as long, more are not tried.
const HOPELESS: f64 = 1.15;
/// Change of the number of particles after which the choice is made anew.
const CHANGE: f64 = 1.5;

pub struct Tuner {
    candidates: Vec<Halo>,
    /// s per particle and step, the fastest seen, by candidate.
    fastest: Vec<f64>,
    /// Intervals submitted since the trials began.
    submitted: usize,
    /// What the intervals under way run with, oldest first, and whether it is judged.
    under_way: std::collections::VecDeque<Option<usize>>,
    /// What stays, and the particles when it was chosen.
    chosen: Option<(Halo, u64)>,
}

impl Tuner {
    /// `rounds`: of the plan; 0 where nothing is exchanged between rounds.
    pub fn new(rounds: u32, fixed: HaloOptions) -> Tuner {
        if rounds == 0 {
            return Tuner::among(vec![Halo { rounds: 0, ghosts: Ghosts::All }]);
        }
        let powers = (0..).map(|power| 1 << power).take_while(|&candidate| candidate < rounds);
        let of_rounds: Vec<u32> = match fixed.rounds {
            Some(fixed) => vec![fixed.clamp(1, rounds)],
            None => powers.chain([rounds]).collect(),
        };
        let of_ghosts = fixed.ghosts.map_or(vec![Ghosts::All, Ghosts::OnDemand], |ghosts| vec![ghosts]);
        let halos = |&rounds: &u32| of_ghosts.iter().map(move |&ghosts| Halo { rounds, ghosts });
        Tuner::among(of_rounds.iter().flat_map(halos).collect())
    }

    fn among(candidates: Vec<Halo>) -> Tuner {
        Tuner {
            fastest: vec![f64::INFINITY; candidates.len()],
            candidates,
            submitted: 0,
            under_way: std::collections::VecDeque::new(),
            chosen: None,
        }
    }

    /// What the first interval runs with.
    pub fn first(&self) -> Halo {
        self.candidates[0]
    }

    /// What the next interval runs with.
    pub fn next(&mut self) -> Halo {
        if let Some((chosen, _)) = self.chosen {
            self.under_way.push_back(None);
            return chosen;
        }
        if self.submitted.is_multiple_of(TRIALS) && self.is_hopeless(self.submitted / TRIALS) {
            self.submitted = TRIALS * self.candidates.len();
        }
        let trial = self.submitted / TRIALS;
        let judged = !self.submitted.is_multiple_of(TRIALS);
        self.submitted += 1;
        match self.candidates.get(trial) {
            Some(&halo) => {
                self.under_way.push_back(judged.then_some(trial));
                halo
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
                    "the halo is kept by {:?}; tried {:?}: {:?}",
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

    /// Of fewer rounds than the candidate's, more have proved slower.
    fn is_hopeless(&self, trial: usize) -> bool {
        let Some(candidate) = self.candidates.get(trial) else { return false };
        let of_rounds = |rounds: u32| {
            self.candidates
                .iter()
                .zip(&self.fastest)
                .filter(move |(halo, _)| halo.rounds == rounds)
                .map(|(_, &cost)| cost)
        };
        let mut fewer = self.candidates.iter().map(|halo| halo.rounds).filter(|&rounds| 2 * rounds <= candidate.rounds);
        fewer.any(|rounds| {
            let few = of_rounds(rounds).fold(f64::INFINITY, f64::min);
            // Those not measured yet are infinite.
            let all_known = of_rounds(2 * rounds).all(f64::is_finite);
            all_known && of_rounds(2 * rounds).fold(f64::INFINITY, f64::min) > HOPELESS * few
        })
    }

    fn best(&self) -> Halo {
        let fastest = (0..self.candidates.len()).min_by(|&a, &b| self.fastest[a].total_cmp(&self.fastest[b]));
        self.candidates[fastest.unwrap_or(0)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ASKED: HaloOptions = HaloOptions { rounds: None, ghosts: Some(Ghosts::OnDemand) };

    /// Runs `intervals`, two under way at once, with a cost for each choice; what was run with.
    fn run(tuner: &mut Tuner, intervals: usize, particles: u64, cost: impl Fn(u32) -> f64) -> Vec<u32> {
        let halos = run_halos(tuner, intervals, particles, |halo| cost(halo.rounds));
        halos.iter().map(|halo| halo.rounds).collect()
    }

    fn run_halos(tuner: &mut Tuner, intervals: usize, particles: u64, cost: impl Fn(Halo) -> f64) -> Vec<Halo> {
        let mut under_way = std::collections::VecDeque::new();
        let mut ran = Vec::new();
        for _ in 0..intervals {
            let halo = tuner.next();
            under_way.push_back(halo);
            ran.push(halo);
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
        let mut tuner = Tuner::new(8, ASKED);
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
        let fixed = |rounds: u32| HaloOptions { rounds: Some(rounds), ..ASKED };
        assert!(run(&mut Tuner::new(8, fixed(2)), 30, 1000, |_| 1.0).iter().all(|&rounds| rounds == 2));
        assert_eq!(Tuner::new(3, fixed(8)).first().rounds, 3);
        assert!(run(&mut Tuner::new(3, ASKED), 9, 1000, |_| 1.0).contains(&3));
    }

    /// Where more rounds prove slower, still more are not tried; where not, all are.
    #[test]
    fn what_is_hopeless_is_not_tried() {
        let mut tuner = Tuner::new(8, ASKED);
        let ran = run(&mut tuner, 40, 1000, f64::from);
        assert!(ran.contains(&2) && !ran.contains(&8), "{ran:?}");
        assert!(ran[14..].iter().all(|&rounds| rounds == 1), "{ran:?}");
        let ran = run(&mut Tuner::new(8, ASKED), 40, 1000, |rounds| 1.0 / f64::from(rounds));
        assert!([1, 2, 4, 8].iter().all(|candidate| ran[..12].contains(candidate)), "{ran:?}");
        assert!(ran[16..].iter().all(|&rounds| rounds == 8), "{ran:?}");
    }

    /// Both ways of the ghosts are tried with each number of rounds, and the better one stays, whichever that is.
    #[test]
    fn ghosts_are_tried_both_ways() {
        for better in [Ghosts::OnDemand, Ghosts::All] {
            let mut tuner = Tuner::new(4, HaloOptions::default());
            let cost =
                |halo: Halo| (1.0 + 0.01 * f64::from(halo.rounds)) * if halo.ghosts == better { 1.0 } else { 1.5 };
            let ran = run_halos(&mut tuner, 40, 1000, cost);
            for rounds in [1, 2, 4] {
                for ghosts in [Ghosts::OnDemand, Ghosts::All] {
                    assert!(ran[..18].contains(&Halo { rounds, ghosts }), "{rounds} {ghosts:?}: {ran:?}");
                }
            }
            assert!(ran[24..].iter().all(|&halo| halo == Halo { rounds: 1, ghosts: better }), "{ran:?}");
        }
    }
}
