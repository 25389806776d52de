//! Buffers with what the host gives them.

use std::sync::Arc;

use gpu_allocator::MemoryLocation;

use super::device::Gpu;
use super::memory::Buffer;
use super::recorder::Recorder;
use crate::error::Result;

impl Buffer {
    /// A buffer that holds `data`: on the device, for which it waits, or, where only a host can submit the copy,
    /// in memory that both see.
    pub fn with_data<T: bytemuck::Pod>(gpu: &Arc<Gpu>, name: &str, data: &[T]) -> Result<Self> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        if gpu.has_queue() {
            let buffer = Self::new(gpu, name, bytes.len() as u64)?;
            buffer.upload(data)?;
            return Ok(buffer);
        }
        let mut buffer = Self::at(gpu, name, bytes.len() as u64, MemoryLocation::CpuToGpu)?;
        buffer.mapped_mut()?[..bytes.len()].copy_from_slice(bytes);
        Ok(buffer)
    }

    /// Replaces what a buffer on the device holds by `data` of the same size. Waits for the copy; nothing
    /// that reads the buffer may be under way.
    pub fn upload<T: bytemuck::Pod>(&self, data: &[T]) -> Result<()> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        if bytes.is_empty() {
            return Ok(());
        }
        let name = format!("{} (staging)", self.name);
        let size = bytes.len() as u64;
        let mut staging = Self::at(&self.gpu, &name, size, MemoryLocation::CpuToGpu)?;
        staging.mapped_mut()?[..bytes.len()].copy_from_slice(bytes);
        let mut recorder = Recorder::new(&self.gpu, 0)?;
        recorder.begin()?;
        recorder.commands().copy_buffer("upload", &staging, self);
        recorder.submit_and_wait()?;
        Ok(())
    }
}
