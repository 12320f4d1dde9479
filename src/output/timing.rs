//! `timing.json`: what the steps of a run took, for programs that compare runs.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::OutputError;
use super::error::write_atomically;
use super::names::TIMING_FILE;

#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Wall time, without the set-up and the account at the end, as rank 0 saw it.
    pub stepping_seconds: f64,
    pub set_up_seconds: f64,
    /// Of this process's part of the run.
    pub steps: u64,
    pub particle_steps: u64,
    /// By rank.
    pub ranks: Vec<RankTiming>,
    /// In the order of the step; empty of a device without timestamps.
    #[serde(default)]
    pub phases: Vec<PhaseTiming>,
}

/// A phase of the step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PhaseTiming {
    pub name: String,
    /// Of the device, in the steps that were timed, each for as many as it stands for.
    pub device_seconds: f64,
    pub dispatches: u64,
}

/// What a rank did in the run; all zero on a rank alone, which waits for nobody.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct RankTiming {
    /// Waiting for its device before messages could be sent.
    pub device_seconds: f64,
    /// Waiting for the messages of others.
    pub waiting_seconds: f64,
    /// In rebalances.
    pub rebalancing_seconds: f64,
    /// Sent.
    pub messages: u64,
    pub bytes: u64,
    /// Summed over steps: particles, ghosts included.
    pub particle_steps: u64,
}

impl Timing {
    /// Writes `timing.json` into the existing folder `dir`.
    pub fn write(&self, dir: &Path) -> Result<(), OutputError> {
        write_atomically(&dir.join(TIMING_FILE), |out| {
            serde_json::to_writer_pretty(&mut *out, self)?;
            out.write_all(b"\n")
        })
    }

    /// # Errors
    /// If there is none in `dir`, or it is none.
    pub fn read(dir: &Path) -> Result<Timing, OutputError> {
        let path = dir.join(TIMING_FILE);
        let bytes = std::fs::read(&path).map_err(OutputError::io("read", &path))?;
        serde_json::from_slice(&bytes).map_err(|error| OutputError::BadRow {
            path,
            line: error.line() as u64,
            problem: error.to_string(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back_and_what_is_not_it_is_an_error() {
        let dir = tempfile::tempdir().unwrap();
        let timing = Timing {
            stepping_seconds: 1.0 / 3.0,
            steps: 7,
            ranks: vec![RankTiming::default(); 2],
            ..Timing::default()
        };
        timing.write(dir.path()).unwrap();
        assert_eq!(Timing::read(dir.path()).unwrap(), timing);
        std::fs::write(dir.path().join(TIMING_FILE), "{\"steps\": 7}").unwrap();
        assert!(Timing::read(dir.path()).unwrap_err().to_string().contains("timing.json"));
    }
}
