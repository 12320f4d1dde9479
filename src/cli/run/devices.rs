//! Which device each rank takes, and what all must have in common.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::super::CliError;
use super::super::settings::Execution;
use crate::gpu::{Device, adapters};
use crate::output::host_name;
use crate::ranks::{self, Communicator, choose_device};
use crate::scene::to_toml;
use crate::simulation::Model;

/// The device that was asked for, or the one that is this rank's among those of its machine: GPUs in turn,
/// a CPU adapter only where there is no GPU.
pub fn open(asked: Option<&str>, comm: &dyn Communicator) -> Result<Device, CliError> {
    if asked.is_some() || comm.size() == 1 {
        return Ok(Device::open(asked)?);
    }
    let known = adapters();
    let gpus = known.iter().filter(|adapter| !adapter.is_cpu()).count();
    let usable = if gpus > 0 { gpus } else { known.len().min(1) };
    // `map` tells which devices serve several.
    let index = choose_device(comm.node_rank(), usable);
    Ok(Device::open(index.map(|index| index.to_string()).as_deref())?)
}

/// All ranks must do the same. To be asked first of all: what each does next is to be done by all.
pub fn agree_on_verb(verb: &str, comm: &dyn Communicator) -> Result<(), CliError> {
    Ok(ranks::agree(comm, &[("verb", verb.to_owned())])?)
}

/// All ranks must be the same program on the same scene, with the same options but for the device. To be asked before any rank
/// takes a way of its own.
pub fn agree_on_run(model: &Model, execution: &Execution, comm: &dyn Communicator) -> Result<(), CliError> {
    let facts = [
        ("version of the program", env!("CARGO_PKG_VERSION").to_owned()),
        ("build of the program", env!("CORPUSCLE_SOURCE").to_owned()),
        ("scene", to_toml(&model.scene)),
        ("plan", model.plan.to_toml()?),
        ("options", format!("{:?}", Execution { gpu: None, ..execution.clone() })),
    ];
    Ok(ranks::agree(comm, &facts)?)
}

/// Their adapters must be of one model and driver, and take one form of the kernels: else their bits might differ.
pub fn agree_on_device(device: &Device, comm: &dyn Communicator) -> Result<(), CliError> {
    let info = &device.adapter().info;
    let facts = [
        ("adapter", info.name.clone()),
        ("driver", format!("{} {}", info.driver, info.driver_info)),
        ("form of the kernels", device.variant().name().to_owned()),
    ];
    Ok(ranks::agree(comm, &facts)?)
}

/// A line for each rank: its machine's adapter. Warns of adapters that serve several ranks. Collective; empty for a rank
/// alone.
pub fn map(device: &Device, comm: &dyn Communicator) -> Result<String, CliError> {
    if comm.size() == 1 {
        return Ok(String::new());
    }
    let adapter = device.adapter();
    let place = format!("{}, rank {} of {} there", host_name(), comm.node_rank(), comm.node_size());
    let taken = format!("adapter {} {} {}", adapter.index, adapter.info.name, adapter.info.device_pci_bus_id);
    let own = [host_name(), place, taken].join("\n");
    let (mut text, mut served) = (String::new(), BTreeMap::<(String, String), usize>::new());
    for (rank, line) in comm.gather(own.into_bytes())?.unwrap_or_default().into_iter().enumerate() {
        let line = String::from_utf8_lossy(&line).into_owned();
        let mut parts = line.split('\n').map(|part| part.trim_end().to_owned());
        let [host, place, taken] = std::array::from_fn(|_| parts.next().unwrap_or_default());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "rank {rank}: {place}: {taken}");
        *served.entry((host, taken)).or_default() += 1;
    }
    for ((host, taken), ranks) in served.into_iter().filter(|(_, ranks)| *ranks > 1) {
        tracing::warn!("{ranks} ranks of {host} share {taken}");
    }
    Ok(text)
}
