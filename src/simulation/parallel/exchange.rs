//! What the ranks tell each other within a step: the particles that change their owner or are near its
//! border, and what the rounds did to the ghosts. A rank alone tells nothing.

use std::time::Instant;

use crate::gpu::Recording;
use crate::ranks::Communicator;
use crate::simulation::error::SimulationError;
use crate::subdomain::{StepSlot, Subdomain};

/// What went between the ranks, as this one saw it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Traffic {
    pub steps: u64,
    /// Sent.
    pub messages: u64,
    pub bytes: u64,
    /// Waits for the device to have packed.
    pub waits: u64,
    /// s, from a submission to its end.
    pub device_seconds: f64,
    /// s, until the messages of others were in.
    pub waiting_seconds: f64,
    /// Summed over steps: particles here, ghosts included, and of them those that came from others.
    pub present: u64,
    pub arrived: u64,
    /// s, of intervals: from their start to the submission of all their steps.
    pub wall_seconds: f64,
    /// s, of rebalances and of the exchanges that brought the particles home afterwards.
    pub rebalancing_seconds: f64,
}

/// What a message is about: its last bytes say so, that one that is missing or cut short is seen at once.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Subject {
    step: u32,
    /// The round before which ghosts are brought up to date, or PARTICLES.
    round: u32,
}

/// The exchange of particles, before all rounds.
const PARTICLES: u32 = u32::MAX;
const SEAL: usize = 12;

impl Subject {
    fn seal(self, message: &mut Vec<u8>) {
        let bytes = message.len() as u32;
        message.extend([self.step, self.round, bytes].iter().flat_map(|word| word.to_ne_bytes()));
    }

    /// The message without its seal.
    fn open(self, rank: usize, mut message: Vec<u8>) -> Result<Vec<u8>, SimulationError> {
        let bytes = message.len().saturating_sub(SEAL);
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&message[bytes..][..(message.len() - bytes) / 4 * 4]);
        let found = match words[..] {
            [step, round, said] if (Subject { step, round }) == self && said as usize == bytes => {
                message.truncate(bytes);
                return Ok(message);
            }
            [step, round, said] => format!("{} of {said} bytes, {bytes} of them here", Subject { step, round }),
            _ => format!("of {} bytes", message.len()),
        };
        Err(SimulationError::Message { rank, found, expected: self.to_string() })
    }
}

impl std::fmt::Display for Subject {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.round {
            PARTICLES => write!(to, "the particles of step {}", self.step),
            round => write!(to, "the updates of step {}, round {round}", self.step),
        }
    }
}

impl Traffic {
    /// What went since an earlier look.
    fn since(&self, earlier: &Traffic) -> Traffic {
        Traffic {
            steps: self.steps - earlier.steps,
            messages: self.messages - earlier.messages,
            bytes: self.bytes - earlier.bytes,
            waits: self.waits - earlier.waits,
            device_seconds: self.device_seconds - earlier.device_seconds,
            waiting_seconds: self.waiting_seconds - earlier.waiting_seconds,
            present: self.present - earlier.present,
            arrived: self.arrived - earlier.arrived,
            wall_seconds: self.wall_seconds - earlier.wall_seconds,
            rebalancing_seconds: self.rebalancing_seconds - earlier.rebalancing_seconds,
        }
    }
}

pub struct Exchange<'a> {
    comm: Option<&'a dyn Communicator>,
    /// Ranks in the order of the place's peers.
    peers: Vec<usize>,
    near: usize,
    /// Of impulses on fabric.
    staging: Option<wgpu::Buffer>,
    traffic: Traffic,
    reported: Traffic,
}

impl<'a> Exchange<'a> {
    pub fn new(comm: &'a dyn Communicator) -> Exchange<'a> {
        Exchange { comm: Some(comm), ..Exchange::none() }
    }

    /// On a rank alone.
    pub fn none() -> Exchange<'a> {
        Exchange {
            comm: None,
            peers: Vec::new(),
            near: 0,
            staging: None,
            traffic: Traffic::default(),
            reported: Traffic::default(),
        }
    }

    /// The ranks of the peers of a place, the near ones first.
    pub fn set_peers(&mut self, peers: Vec<usize>, near: usize) {
        self.peers = peers;
        self.near = near;
    }

    pub fn traffic(&self) -> Traffic {
        self.traffic
    }

    /// What went since the last call.
    pub fn recent(&mut self) -> Traffic {
        let recent = self.traffic.since(&self.reported);
        self.reported = self.traffic;
        recent
    }

    /// Time that went into an interval.
    pub fn ran(&mut self, seconds: f64) {
        self.traffic.wall_seconds += seconds;
    }

    /// Time that went into a rebalance.
    pub fn rebalanced(&mut self, seconds: f64) {
        self.traffic.rebalancing_seconds += seconds;
    }

    /// Particles to those who own them or need them as ghosts, in one message to each peer.
    ///
    /// # Errors
    /// If a device or another rank fails.
    pub fn particles(
        &mut self,
        subdomain: &mut Subdomain,
        rec: &mut Recording<'_>,
        slot: &mut StepSlot,
    ) -> Result<(), SimulationError> {
        if subdomain.place().is_alone() {
            return Ok(());
        }
        let start = Instant::now();
        let outgoing = subdomain.pack(rec, slot)?;
        let messages = self.timed(|| subdomain.packed(rec, slot, outgoing))?;
        let received = self.swap(messages, self.peers.len(), Subject { step: slot.index(), round: PARTICLES })?;
        subdomain.arrive(rec, slot, &received)?;
        self.traffic.steps += 1;
        self.traffic.present += u64::from(slot.present());
        self.traffic.arrived += u64::from(slot.arrived());
        if subdomain.place().scattered {
            self.traffic.rebalancing_seconds += start.elapsed().as_secs_f64();
        }
        Ok(())
    }

    /// Brings the ghosts up to date where the next round needs it.
    ///
    /// # Errors
    /// If a device or another rank fails.
    pub fn updates(
        &mut self,
        subdomain: &mut Subdomain,
        rec: &mut Recording<'_>,
        slot: &StepSlot,
        round: u32,
    ) -> Result<(), SimulationError> {
        if !subdomain.place().stale(round) || self.near == 0 {
            return Ok(());
        }
        let outgoing = subdomain.pack_updates(rec, slot, round - 1)?;
        let messages = self.timed(|| subdomain.packed_updates(rec, slot, round - 1, outgoing))?;
        let received = self.swap(messages, self.near, Subject { step: slot.index(), round })?;
        subdomain.receive(rec, slot, round - 1, &received)?;
        Ok(())
    }

    /// Sums over the ranks what the gas has given to the nodes of elastic fabric, two words for each sum.
    ///
    /// # Errors
    /// If a device or another rank fails.
    pub fn impulses(&mut self, rec: &mut Recording<'_>, impulses: &wgpu::Buffer) -> Result<(), SimulationError> {
        let Some(comm) = self.comm.filter(|comm| comm.size() > 1) else {
            return Ok(());
        };
        let device = rec.device();
        let staging = match self.staging.take() {
            Some(staging) => staging,
            None => device.staging(impulses.size())?,
        };
        rec.encoder().copy_buffer_to_buffer(impulses, 0, &staging, 0, impulses.size());
        let submission = rec.submit();
        let readback = device.read_later(staging, submission);
        let (own, staging) = self.timed(|| readback.finish(device, bytemuck::pod_collect_to_vec::<u8, u64>))?;
        self.staging = Some(staging);
        let start = Instant::now();
        self.traffic.messages += 1;
        self.traffic.bytes += impulses.size();
        let sums = comm.sum(own)?;
        self.traffic.waiting_seconds += start.elapsed().as_secs_f64();
        device.write(impulses, 0, &sums);
        Ok(())
    }

    fn timed<T, E>(&mut self, wait: impl FnOnce() -> Result<T, E>) -> Result<T, E> {
        let start = Instant::now();
        let result = wait();
        self.traffic.waits += 1;
        self.traffic.device_seconds += start.elapsed().as_secs_f64();
        result
    }

    /// One message to each of the first `count` peers, and one from each.
    fn swap(
        &mut self,
        messages: Vec<Vec<u8>>,
        count: usize,
        subject: Subject,
    ) -> Result<Vec<Vec<u8>>, SimulationError> {
        let Some(comm) = self.comm else {
            return Ok(Vec::new());
        };
        let start = Instant::now();
        let peers = &self.peers[..count];
        for (&peer, mut message) in peers.iter().zip(messages) {
            subject.seal(&mut message);
            self.traffic.messages += 1;
            self.traffic.bytes += message.len() as u64;
            comm.send(peer, message)?;
        }
        let mut received = Vec::with_capacity(count);
        for &peer in peers {
            received.push(subject.open(peer, comm.receive(peer)?)?);
        }
        self.traffic.waiting_seconds += start.elapsed().as_secs_f64();
        Ok(received)
    }
}
