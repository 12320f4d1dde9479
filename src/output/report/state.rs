//! How far the run in a folder has got, from its files alone; nothing is locked or written.

use std::path::Path;

use super::super::environment::host_name;
use super::super::marker::has_ended;
use super::super::names::LOCK_FILE;

/// Whether somebody writes into a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Progressing {
    Ended,
    /// By whom, as its lock file says.
    Going(String),
    /// It was killed, has failed, or was stopped at a checkpoint.
    Stopped,
}

impl Progressing {
    pub fn of(run: &Path) -> Progressing {
        if has_ended(run) {
            return Progressing::Ended;
        }
        let signed = std::fs::read_to_string(run.join(LOCK_FILE)).unwrap_or_default();
        match signed.trim() {
            "" => Progressing::Stopped,
            holder if is_alive(holder) => Progressing::Going(holder.to_owned()),
            _ => Progressing::Stopped,
        }
    }
}

/// Whether the process of a signature `process ID of HOST: COMMAND` may still be there. The lock itself is not tried: who
/// starts a run at that moment would be refused. Of another host nothing is known, so it is taken at its word.
fn is_alive(holder: &str) -> bool {
    let Some((process, host)) = holder.strip_prefix("process ").and_then(|rest| rest.split_once(" of ")) else {
        return true;
    };
    let host = host.split(": ").next().unwrap_or(host);
    let local = Path::new("/proc/self").exists() && host == host_name();
    // Who writes the page of its own run has come to its end.
    let own = process == std::process::id().to_string();
    !local || !own && Path::new("/proc").join(process).exists()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::names::AUDIT_FILE;

    #[test]
    fn a_run_goes_on_as_long_as_its_process_does() {
        let dir = tempfile::tempdir().unwrap();
        let state = || Progressing::of(dir.path());
        assert_eq!(state(), Progressing::Stopped);
        let sign = |process: u32, host: &str| {
            let text = format!("process {process} of {host}: corpuscle run a.toml\n");
            std::fs::write(dir.path().join(LOCK_FILE), &text).unwrap();
            Progressing::Going(text.trim().to_owned())
        };
        let first = sign(1, &host_name());
        assert_eq!(state(), first);
        sign(std::process::id(), &host_name());
        assert_eq!(state(), Progressing::Stopped);
        // No process has this number.
        sign(u32::MAX, &host_name());
        assert_eq!(state(), Progressing::Stopped);
        let elsewhere = sign(u32::MAX, "another host");
        assert_eq!(state(), elsewhere);
        std::fs::write(dir.path().join(AUDIT_FILE), "").unwrap();
        assert_eq!(state(), Progressing::Ended);
    }
}
