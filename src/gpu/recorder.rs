//! A command buffer of the library's own, which it submits and waits for.

use std::sync::Arc;
use std::sync::atomic::Ordering;

use ash::vk;

use super::commands::{Commands, Timer};
use super::device::Gpu;
use super::failed::failed;
use crate::error::{Error, Result};
use crate::number::sum;

/// GPU time of each recorded pass, in the order of recording.
#[derive(Debug, Clone, Default)]
pub struct Timings {
    /// Name and [ms]; the same name stands as often as the pass was recorded.
    pub passes: Vec<(String, f64)>,
}

impl Timings {
    /// [ms] Sum over the passes whose name counts.
    pub fn ms(&self, counts: impl Fn(&str) -> bool) -> f64 {
        let passes = self.passes.iter().filter(|(name, _)| counts(name));
        sum(passes.map(|&(_, ms)| ms))
    }
}

/// A command buffer that is recorded and submitted as a whole.
pub struct Recorder {
    gpu: Arc<Gpu>,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    timer: Timer,
}

impl Recorder {
    /// A recorder that times up to `timed_max` passes.
    ///
    /// # Errors
    /// The device is a host's, whose queues are its own; or a Vulkan call failed.
    pub fn new(gpu: &Arc<Gpu>, timed_max: u32) -> Result<Self> {
        if !gpu.has_queue() {
            return Err(Error::Unsupported(
                "the device belongs to the host, who alone submits to it; record an effect instead"
                    .into(),
            ));
        }
        let mut recorder = Self {
            gpu: gpu.clone(),
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            timer: Timer {
                queries: vk::QueryPool::null(),
                timed_max: if gpu.tick_ns > 0.0 { timed_max } else { 0 },
                names: Vec::new(),
            },
        };
        let device = &gpu.device;
        // SAFETY: all infos outlive the calls; `Drop` destroys what is created.
        unsafe {
            let info = vk::CommandPoolCreateInfo::default().queue_family_index(gpu.family);
            recorder.pool = device
                .create_command_pool(&info, None)
                .map_err(failed("vkCreateCommandPool"))?;
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(recorder.pool)
                .command_buffer_count(1);
            recorder.commands = device
                .allocate_command_buffers(&info)
                .map_err(failed("vkAllocateCommandBuffers"))?[0];
            recorder.fence = device
                .create_fence(&Default::default(), None)
                .map_err(failed("vkCreateFence"))?;
            if recorder.timer.timed_max > 0 {
                let info = vk::QueryPoolCreateInfo::default()
                    .query_type(vk::QueryType::TIMESTAMP)
                    .query_count(2 * recorder.timer.timed_max);
                recorder.timer.queries = device
                    .create_query_pool(&info, None)
                    .map_err(failed("vkCreateQueryPool"))?;
            }
        }
        Ok(recorder)
    }

    /// Starts over. What was submitted before has finished.
    pub fn begin(&mut self) -> Result<()> {
        self.timer.names.clear();
        let device = &self.gpu.device;
        // SAFETY: neither the command buffer nor the fence is pending: `submit_and_wait` waits.
        unsafe {
            device
                .reset_fences(&[self.fence])
                .map_err(failed("vkResetFences"))?;
            device
                .reset_command_pool(self.pool, Default::default())
                .map_err(failed("vkResetCommandPool"))?;
            let info = vk::CommandBufferBeginInfo::default()
                .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            device
                .begin_command_buffer(self.commands, &info)
                .map_err(failed("vkBeginCommandBuffer"))?;
            if self.timer.timed_max > 0 {
                device.cmd_reset_query_pool(
                    self.commands,
                    self.timer.queries,
                    0,
                    2 * self.timer.timed_max,
                );
            }
        }
        Ok(())
    }

    /// Names of the passes recorded since `begin`.
    pub fn names(&self) -> &[&'static str] {
        &self.timer.names
    }

    /// What records into the command buffer.
    pub fn commands(&mut self) -> Commands<'_> {
        Commands::timed(&self.gpu, self.commands, &mut self.timer)
    }

    /// Submits and waits for the end. Returns the GPU time of each pass.
    pub fn submit_and_wait(&mut self) -> Result<Timings> {
        // What the host reads next was written by copies.
        self.commands()
            .barrier(vk::PipelineStageFlags2::HOST, vk::AccessFlags2::HOST_READ);
        let device = &self.gpu.device;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        // SAFETY: the recording is complete; the queue is externally synchronized by the lock; the
        // fence is unsignalled and waited for.
        unsafe {
            device
                .end_command_buffer(self.commands)
                .map_err(failed("vkEndCommandBuffer"))?;
            let submission = self.gpu.submission.lock();
            self.gpu.submitted.store(true, Ordering::Relaxed);
            device
                .queue_submit2(self.gpu.queue, &submit, self.fence)
                .map_err(failed("vkQueueSubmit2"))?;
            drop(submission);
            device
                .wait_for_fences(&[self.fence], true, u64::MAX)
                .map_err(|result| {
                    // Nothing may be pending when the error is told; on a lost device this returns at once.
                    let _ = device.device_wait_idle();
                    failed("vkWaitForFences")(result)
                })?;
        }
        self.timings()
    }

    fn timings(&self) -> Result<Timings> {
        let timed = self.timer.names.len().min(self.timer.timed_max as usize);
        if timed == 0 {
            return Ok(Timings::default());
        }
        let mut ticks = vec![0u64; 2 * timed];
        // SAFETY: the queries were written by the submission that has finished.
        unsafe {
            self.gpu.device.get_query_pool_results(
                self.timer.queries,
                0,
                &mut ticks,
                vk::QueryResultFlags::TYPE_64,
            )
        }
        .map_err(failed("vkGetQueryPoolResults"))?;
        let ms = |pair: &[u64]| pair[1].wrapping_sub(pair[0]) as f64 * self.gpu.tick_ns * 1e-6;
        Ok(Timings {
            passes: self
                .timer
                .names
                .iter()
                .map(|name| (*name).to_owned())
                .zip(ticks.chunks_exact(2).map(ms))
                .collect(),
        })
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        // SAFETY: destroyed once, null handles are ignored. After a failed wait the device is lost and
        // nothing is pending.
        unsafe {
            device.destroy_query_pool(self.timer.queries, None);
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
        }
    }
}
