//! When the particles of a gas enter, and through which of its orifices.

use crate::gas::curve::FlowIntegral;

/// One gas of one orifice.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stream {
    pub source: usize,
    pub gas: usize,
    /// Integral of the orifice's mass flow, kg.
    pub flow: FlowIntegral,
    /// kg of the whole mixture that flow by while this gas delivers one particle.
    pub mass_per_particle: f64,
    /// Particles of the run, at most.
    pub most: u64,
    pub taken: u64,
}

impl Stream {
    /// Particles that the curve delivers until a time.
    pub fn delivered(&self, time: f64) -> f64 {
        self.flow.until(time) / self.mass_per_particle
    }

    /// When the curve has delivered so many, never if it does not.
    pub fn time_of(&self, particles: u64) -> f64 {
        self.flow.time_of(particles as f64 * self.mass_per_particle).unwrap_or(f64::INFINITY)
    }
}

/// When the particles of a gas enter, through whichever orifice.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Schedule {
    /// Places among the streams of all gases.
    pub streams: Vec<usize>,
    /// The flow of all its orifices: kg of the mixture of one, moles of the gas of several.
    pub flow: FlowIntegral,
    /// What of that flows by between two particles.
    pub per_particle: f64,
    pub count: u64,
    pub taken: u64,
    pub next: Option<f64>,
}

impl Schedule {
    pub fn new(streams: &[Stream], gas: usize, moles_per_particle: f64, end_time: f64) -> Option<Self> {
        let own: Vec<usize> = (0..streams.len()).filter(|&index| streams[index].gas == gas).collect();
        let (flow, per_particle) = match own[..] {
            [] => return None,
            [only] => (streams[only].flow.clone(), streams[only].mass_per_particle),
            _ => {
                let moles = |&index: &usize| {
                    let stream: &Stream = &streams[index];
                    (moles_per_particle / stream.mass_per_particle, &stream.flow)
                };
                (FlowIntegral::sum(&own.iter().map(moles).collect::<Vec<_>>()), moles_per_particle)
            }
        };
        let schedule = Self { streams: own, flow, per_particle, count: 0, taken: 0, next: None };
        Some(schedule.counted(end_time))
    }

    pub fn time_of(&self, index: u64) -> Option<f64> {
        self.flow.time_of((index as f64 + 0.5) * self.per_particle)
    }

    pub fn counted(mut self, end_time: f64) -> Self {
        let enters = |schedule: &Self, index| schedule.time_of(index).is_some_and(|time| time < end_time);
        // The quotient may miss the last particle by rounding: ask the schedule itself.
        self.count = (self.flow.total() / self.per_particle + 0.5) as u64;
        while enters(&self, self.count) {
            self.count += 1;
        }
        while self.count > 0 && !enters(&self, self.count - 1) {
            self.count -= 1;
        }
        self.take(0);
        self
    }

    /// So many have entered.
    pub fn take(&mut self, taken: u64) {
        self.taken = taken;
        self.next = if taken < self.count { self.time_of(taken) } else { None };
    }

    /// The stream through which the particle of this time enters, the first of equals.
    pub fn stream_at(&self, time: f64, streams: &[Stream]) -> usize {
        if let [only] = self.streams[..] {
            return only;
        }
        let ahead = |index: usize| streams[index].delivered(time) - streams[index].taken as f64;
        let due = self.streams.iter().filter(|&&index| ahead(index) > 0.0);
        let first = due.min_by(|&&a, &&b| {
            let whole = |index: usize| streams[index].time_of(streams[index].taken + 1);
            whole(a).total_cmp(&whole(b))
        });
        // Some stream is ahead by the half particle, but for rounding.
        *first.or_else(|| self.streams.iter().max_by(|&&a, &&b| ahead(a).total_cmp(&ahead(b)))).unwrap_or(&0)
    }
}
