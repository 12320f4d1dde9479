//! `corpuscle adapters`: what runs can use, with the limits that matter.

use crate::gpu::{self, AdapterDescription, GpuError};
use crate::output::grouped;
use crate::subdomain::most_particles;

use super::CliError;
use super::terminal::say;

pub fn adapters() -> Result<(), CliError> {
    let adapters = gpu::adapters();
    if adapters.is_empty() {
        return Err(GpuError::NoAdapter.into());
    }
    let blocks: Vec<String> = adapters.iter().map(block).collect();
    say(&blocks.join("\n"))
}

fn block(adapter: &AdapterDescription) -> String {
    let AdapterDescription { index, info, limits, features } = adapter;
    let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let timestamps = features.contains(wgpu::Features::TIMESTAMP_QUERY);
    let or_none = |text: &str| if text.is_empty() { "none".to_owned() } else { text.to_owned() };
    let facts = [
        ("type", format!("{:?}", info.device_type)),
        ("backend", info.backend.to_string()),
        ("driver", or_none(format!("{} {}", info.driver, info.driver_info).trim())),
        ("PCI id", or_none(&info.device_pci_bus_id)),
        ("largest binding", bytes(limits.max_storage_buffer_binding_size)),
        ("largest buffer", bytes(limits.max_buffer_size)),
        ("workgroups per dimension", grouped(u64::from(limits.max_compute_workgroups_per_dimension))),
        ("timestamps", if timestamps { "yes" } else { "no" }.to_owned()),
        ("particles by the binding", format!("{} at most", grouped(most_particles(binding)))),
    ];
    let widest = facts.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let head = format!("{index}: {}\n", info.name);
    facts.iter().fold(head, |text, (name, fact)| text + &format!("   {name:<widest$}  {fact}\n"))
}

/// With the unit in which limits are round.
fn bytes(count: u64) -> String {
    format!("{} bytes ({:.1} GiB)", grouped(count), count as f64 / f64::from(1 << 30))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A particle is 32 bytes, and its share of the tails of neighbour lists half a byte.
    #[test]
    fn the_binding_limits_the_particles() {
        assert_eq!(most_particles(128 << 20), (256 << 20) / 65);
        assert_eq!(bytes(128 << 20), "134,217,728 bytes (0.1 GiB)");
    }
}
