//! Buffers on a device, uploads and late readback.

use std::sync::mpsc;

use super::{Device, GpuError};

impl Device {
    /// A zeroed storage buffer of `items` of type `T`, at least one.
    ///
    /// # Errors
    /// If it is over the device's binding or buffer limit (the numbers are in the error).
    pub fn storage<T: bytemuck::Pod>(&self, name: &'static str, items: u64) -> Result<wgpu::Buffer, GpuError> {
        let bytes = (items.max(1) * size_of::<T>() as u64).next_multiple_of(16);
        let limit = self.limits().max_storage_buffer_binding_size.min(self.limits().max_buffer_size);
        if bytes > limit {
            return Err(GpuError::TooLarge { name, bytes, limit, items });
        }
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        self.create(name, bytes, usage)
    }

    /// A storage buffer that holds `data` (at least one item's room).
    ///
    /// # Errors
    /// As [`Device::storage`].
    pub fn storage_of<T: bytemuck::Pod>(&self, name: &'static str, data: &[T]) -> Result<wgpu::Buffer, GpuError> {
        let buffer = self.storage::<T>(name, data.len() as u64)?;
        self.write(&buffer, 0, data);
        Ok(buffer)
    }

    /// Arguments of `items` indirect dispatches, three words each, which kernels may write.
    ///
    /// # Errors
    /// If the device has no memory for it.
    pub fn indirect(&self, name: &'static str, items: u64) -> Result<wgpu::Buffer, GpuError> {
        let usage = wgpu::BufferUsages::INDIRECT
            | wgpu::BufferUsages::STORAGE
            | wgpu::BufferUsages::COPY_SRC
            | wgpu::BufferUsages::COPY_DST;
        self.create(name, items * 12, usage)
    }

    /// A uniform buffer of this many bytes.
    ///
    /// # Errors
    /// If the device has no memory for it.
    pub fn uniform(&self, name: &'static str, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        self.create(name, bytes, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST)
    }

    /// A buffer that copies can write and the host can map.
    ///
    /// # Errors
    /// If the device has no memory for it.
    pub fn staging(&self, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        self.create("staging", bytes, wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST)
    }

    /// A buffer that timestamp queries resolve into.
    ///
    /// # Errors
    /// If the device has no memory for it.
    pub fn resolve(&self, bytes: u64) -> Result<wgpu::Buffer, GpuError> {
        self.create("timestamps", bytes, wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC)
    }

    fn create(&self, name: &'static str, bytes: u64, usage: wgpu::BufferUsages) -> Result<wgpu::Buffer, GpuError> {
        let memory = self.raw().push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let buffer = self.raw().create_buffer(&wgpu::BufferDescriptor {
            label: Some(name),
            size: bytes,
            usage,
            mapped_at_creation: false,
        });
        match pollster::block_on(memory.pop()) {
            Some(error) => Err(GpuError::Memory { name, bytes, reason: error.to_string() }),
            None => Ok(buffer),
        }
    }

    /// Writes items into a buffer, `offset` in bytes; done before the next submission.
    pub fn write<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer, offset: u64, data: &[T]) {
        if !data.is_empty() {
            self.queue().write_buffer(buffer, offset, bytemuck::cast_slice(data));
        }
    }

    /// Writes parts into a buffer one after the other, from `offset`, with one copy on the way; done before the next
    /// submission. Offset and lengths are multiples of 4 bytes.
    ///
    /// # Errors
    /// If they do not fit the buffer, or the device has no memory for the copy.
    pub fn write_joined(&self, buffer: &wgpu::Buffer, offset: u64, parts: &[Vec<u8>]) -> Result<(), GpuError> {
        let bytes = parts.iter().map(|part| part.len() as u64).sum();
        let Some(size) = wgpu::BufferSize::new(bytes) else {
            return Ok(());
        };
        let view = self.queue().write_buffer_with(buffer, offset, size);
        let refused = || GpuError::Trouble { reason: format!("a write of {bytes} bytes at {offset} was refused") };
        let mut view = view.ok_or_else(refused)?;
        let mut at = 0;
        for part in parts {
            view.slice(at..at + part.len()).copy_from_slice(part);
            at += part.len();
        }
        Ok(())
    }

    /// Starts to map a staging buffer that `submission` fills.
    pub fn read_later(&self, staging: wgpu::Buffer, submission: wgpu::SubmissionIndex) -> Readback {
        let (sender, receiver) = mpsc::channel();
        staging.map_async(wgpu::MapMode::Read, .., move |result| {
            // The receiver is gone only if the readback was dropped unread.
            let _ = sender.send(result);
        });
        Readback { staging, submission, receiver }
    }

    /// The first `items` items of a buffer, waiting for the device.
    ///
    /// # Errors
    /// If the device fails.
    pub fn read<T: bytemuck::Pod>(&self, buffer: &wgpu::Buffer, items: usize) -> Result<Vec<T>, GpuError> {
        let bytes = items * size_of::<T>();
        if bytes == 0 {
            return Ok(Vec::new());
        }
        let padded = (bytes as u64).next_multiple_of(4);
        let staging = self.staging(padded)?;
        let mut encoder = self.encoder();
        encoder.copy_buffer_to_buffer(buffer, 0, &staging, 0, padded);
        let submission = self.submit(encoder);
        let data: Vec<u8> = self.read_later(staging, submission).finish(self, <[u8]>::to_vec)?.0;
        Ok(bytemuck::pod_collect_to_vec(&data[..bytes]))
    }
}

/// A copy on its way to the host.
pub struct Readback {
    staging: wgpu::Buffer,
    submission: wgpu::SubmissionIndex,
    receiver: mpsc::Receiver<Result<(), wgpu::BufferAsyncError>>,
}

impl Readback {
    /// What it waits for.
    pub fn submission(&self) -> &wgpu::SubmissionIndex {
        &self.submission
    }

    /// Waits for the copy and gives its bytes to `read`; returns the staging buffer for reuse.
    ///
    /// # Errors
    /// If the device fails.
    pub fn finish<R>(self, device: &Device, read: impl FnOnce(&[u8]) -> R) -> Result<(R, wgpu::Buffer), GpuError> {
        device.wait(&self.submission)?;
        let mapped = self.receiver.recv_timeout(std::time::Duration::from_secs(10));
        let trouble = |reason: String| GpuError::Trouble { reason };
        mapped
            .map_err(|error| trouble(format!("a readback was not delivered: {error}")))?
            .map_err(|error| trouble(error.to_string()))?;
        let result = {
            let view = self.staging.get_mapped_range(..).map_err(|error| trouble(error.to_string()))?;
            read(&view)
        };
        self.staging.unmap();
        Ok((result, self.staging))
    }
}
