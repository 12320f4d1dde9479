//! The pipeline cache of a device: compiled kernels with runtime constants, which its next scene may want as well.

use std::sync::{Mutex, PoisonError};

use super::GpuError;

#[derive(Clone)]
pub(super) struct Compiled {
    pub pipeline: wgpu::ComputePipeline,
    pub layout: wgpu::BindGroupLayout,
}

/// All that a compiled kernel depends on.
#[derive(PartialEq)]
pub(super) struct Made {
    pub source: &'static str,
    pub taken: Vec<(&'static str, f64)>,
    pub runtime: Vec<&'static str>,
}

#[derive(Default)]
pub(super) struct PipelineCache(Mutex<Vec<(Made, Compiled)>>);

impl PipelineCache {
    /// The kernel from the cache, or made now. (Two threads may both make it: it is the same.)
    pub fn or_make(
        &self,
        made: Made,
        make: impl FnOnce(&Made) -> Result<Compiled, GpuError>,
    ) -> Result<Compiled, GpuError> {
        let cached = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, compiled)) = cached().iter().find(|(known, _)| *known == made) {
            return Ok(compiled.clone());
        }
        let compiled = make(&made)?;
        cached().push((made, compiled.clone()));
        Ok(compiled)
    }

    #[cfg(test)]
    pub fn len(&self) -> usize {
        self.0.lock().expect("the kernels").len()
    }
}
