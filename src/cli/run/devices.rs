//! Which device each rank takes, and what all must have in common.

use std::fmt::Write;

use crate::gpu::{Device, adapters};
use crate::ranks::{self, Communicator, choose_device};
use crate::scene::to_toml;
use crate::simulation::Model;

use super::super::CliError;

/// The device that was asked for, or the one that is this rank's among those of its machine: GPUs in turn,
/// a CPU adapter only where there is no GPU.
pub fn open(asked: Option<&str>, comm: &dyn Communicator) -> Result<Device, CliError> {
    if asked.is_some() || comm.size() == 1 {
        return Ok(Device::open(asked)?);
    }
    let known = adapters();
    let gpus = known.iter().filter(|adapter| !adapter.is_cpu()).count();
    let usable = if gpus > 0 { gpus } else { known.len().min(1) };
    let Some((index, shared)) = choose_device(comm.node_rank(), comm.node_size(), usable) else {
        return Ok(Device::open(None)?);
    };
    if shared && comm.node_rank() == index {
        tracing::warn!(
            "{} ranks of this machine share {usable} device{}: adapter {index} serves several",
            comm.node_size(),
            if usable == 1 { "" } else { "s" },
        );
    }
    Ok(Device::open(Some(&index.to_string()))?)
}

/// All ranks must be the same program on the same scene, and their adapters of one model and driver: else their
/// bits would differ.
pub fn agree(device: &Device, model: &Model, comm: &dyn Communicator) -> Result<(), CliError> {
    let info = &device.adapter().info;
    let facts = [
        ("version of the program", env!("CARGO_PKG_VERSION").to_owned()),
        ("scene", to_toml(&model.scene)),
        ("plan", model.plan.to_toml()?),
        ("adapter", info.name.clone()),
        ("driver", format!("{} {}", info.driver, info.driver_info)),
    ];
    Ok(ranks::agree(comm, &facts)?)
}

/// A line for each rank: its machine's adapter. Collective; empty for a rank alone.
pub fn map(device: &Device, comm: &dyn Communicator) -> Result<String, CliError> {
    if comm.size() == 1 {
        return Ok(String::new());
    }
    let adapter = device.adapter();
    let own = format!(
        "{}, rank {} of {} there: adapter {} {} {}",
        host(),
        comm.node_rank(),
        comm.node_size(),
        adapter.index,
        adapter.info.name,
        adapter.info.device_pci_bus_id,
    );
    let mut text = String::new();
    for (rank, line) in comm.gather(own.into_bytes())?.unwrap_or_default().into_iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "rank {rank}: {}", String::from_utf8_lossy(&line).trim_end());
    }
    Ok(text)
}

fn host() -> String {
    std::fs::read_to_string("/proc/sys/kernel/hostname")
        .map_or_else(|_| "this machine".into(), |name| name.trim().into())
}
