//! The kernels of the step's phases, bound to the buffers.

use crate::gpu::{BoundKernel, Constants, Device, GpuError, Kernel};

use super::buffers::Buffers;
use super::constants::Features;

/// What a scene needs is there; what it lacks is not compiled.
pub struct Kernels<K> {
    pub inject: Option<K>,
    pub collisions: Option<CollisionKernels<K>>,
    pub exchange: Option<ExchangeKernels<K>>,
    pub reset: K,
    pub advect: K,
    pub bounce: K,
    pub tally: K,
    pub blocks: K,
}

pub struct CollisionKernels<K> {
    pub bin: K,
    pub scan_sums: K,
    pub scan_chunks: K,
    pub scan_cells: K,
    pub scatter: K,
    pub order: K,
    pub wall_times: K,
    pub neighbours: K,
    pub screen: K,
    pub choose: K,
    /// The same kernel, for the pass over the ghosts that were asked.
    pub choose_asked: K,
    pub match_pairs: K,
    pub settle: K,
    pub lost: K,
}

/// On a device among others.
pub struct ExchangeKernels<K> {
    pub pack: K,
    pub pack_updates: K,
    pub receive: K,
    pub weigh: K,
}

impl<K> Kernels<K> {
    fn build<E>(features: Features, mut make: impl FnMut(&'static str) -> Result<K, E>) -> Result<Kernels<K>, E> {
        let collisions = if features.collisions {
            Some(CollisionKernels {
                bin: make("bin")?,
                scan_sums: make("scan_sums")?,
                scan_chunks: make("scan_chunks")?,
                scan_cells: make("scan_cells")?,
                scatter: make("scatter")?,
                order: make("order")?,
                wall_times: make("wall_times")?,
                neighbours: make("neighbours")?,
                screen: make("screen")?,
                choose: make("choose")?,
                choose_asked: make("choose_asked")?,
                match_pairs: make("match_pairs")?,
                settle: make("settle")?,
                lost: make("lost")?,
            })
        } else {
            None
        };
        let exchange = if features.halo {
            Some(ExchangeKernels {
                pack: make("pack")?,
                pack_updates: make("pack_updates")?,
                receive: make("receive")?,
                weigh: make("weigh")?,
            })
        } else {
            None
        };
        Ok(Kernels {
            inject: if features.orifices { Some(make("inject")?) } else { None },
            collisions,
            exchange,
            reset: make("reset")?,
            advect: make("advect")?,
            bounce: make("bounce")?,
            tally: make("tally")?,
            blocks: make("blocks")?,
        })
    }
}

/// The shader of a kernel: one may be bound twice, to different buffers, so that both do the same to the last bit.
fn source(name: &str) -> &str {
    if name == "choose_asked" { "choose" } else { name }
}

/// Compiled kernels by name.
pub struct Compiled(Vec<(&'static str, Kernel)>);

impl Compiled {
    pub fn new(device: &Device, features: Features, constants: &Constants) -> Result<Compiled, GpuError> {
        let mut compiled = Vec::new();
        Kernels::build(features, |name| {
            if source(name) == name {
                compiled.push((name, Kernel::new(device, name, constants)?));
            }
            Ok::<(), GpuError>(())
        })?;
        Ok(Compiled(compiled))
    }

    pub fn bind(
        &self,
        device: &Device,
        features: Features,
        buffers: &Buffers<'_>,
    ) -> Result<Kernels<BoundKernel>, GpuError> {
        Kernels::build(features, |name| {
            let kernel = self.0.iter().find(|(known, _)| *known == source(name)).map(|(_, kernel)| kernel);
            let Some(kernel) = kernel else {
                return Err(GpuError::Kernel { kernel: name.into(), reason: "not compiled".into() });
            };
            kernel.bind(device, |buffer| buffers.by_name(name, buffer))
        })
    }
}
