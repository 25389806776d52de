//! Records passes: each with a label, two timestamps and the barrier before it.

use std::ffi::CString;
use std::sync::Arc;

use ash::vk;

use super::device::{Gpu, failed};
use super::draw::{Attachments, Draw, begin_rendering, record_draw};
use super::memory::{Buffer, Image, Resources};
use super::pass::{ComputePass, GraphicsPass};
use crate::error::Result;
use crate::shared::Push;

/// How many work groups to dispatch.
pub enum Groups<'a> {
    Direct([u32; 3]),
    /// A VkDispatchIndirectCommand at a byte offset.
    Indirect(&'a Buffer, u64),
}

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
        passes.map(|(_, ms)| ms).sum()
    }
}

/// A command buffer. Its recording calls cannot fail; it is submitted as a whole.
pub struct Recorder {
    gpu: Arc<Gpu>,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    queries: vk::QueryPool,
    /// [pass] How many passes can be timed.
    timed_max: u32,
    names: Vec<String>,
}

impl Recorder {
    /// A recorder that times up to `timed_max` passes.
    pub fn new(gpu: &Arc<Gpu>, timed_max: u32) -> Result<Self> {
        let mut recorder = Self {
            gpu: gpu.clone(),
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            queries: vk::QueryPool::null(),
            timed_max: if gpu.tick_ns > 0.0 { timed_max } else { 0 },
            names: Vec::new(),
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
            if recorder.timed_max > 0 {
                let info = vk::QueryPoolCreateInfo::default()
                    .query_type(vk::QueryType::TIMESTAMP)
                    .query_count(2 * recorder.timed_max);
                recorder.queries = device
                    .create_query_pool(&info, None)
                    .map_err(failed("vkCreateQueryPool"))?;
            }
        }
        Ok(recorder)
    }

    /// Starts over. What was submitted before has finished.
    pub fn begin(&mut self) -> Result<()> {
        self.names.clear();
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
            if self.timed_max > 0 {
                device.cmd_reset_query_pool(self.commands, self.queries, 0, 2 * self.timed_max);
            }
        }
        Ok(())
    }

    /// Names of the passes recorded since `begin`.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Brings new images into the layout that they stay in.
    pub fn initialize(&mut self, resources: &Resources) {
        let (old, new) = (vk::ImageLayout::UNDEFINED, vk::ImageLayout::GENERAL);
        self.change_layout(resources.images(), old, new);
    }

    fn change_layout<'a>(
        &self,
        images: impl Iterator<Item = &'a Image>,
        old: vk::ImageLayout,
        new: vk::ImageLayout,
    ) {
        let barriers: Vec<_> = images
            .map(|image| {
                vk::ImageMemoryBarrier2::default()
                    .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                    .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
                    .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
                    .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
                    .old_layout(old)
                    .new_layout(new)
                    .image(image.raw)
                    .subresource_range(image.range())
            })
            .collect();
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: recording; the images are alive.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.commands, &info) };
    }

    /// Dispatches a compute pass.
    pub fn dispatch(&mut self, name: &str, pass: &ComputePass, push: Push, groups: Groups) {
        self.dispatch_all(name, pass, &[(push, groups)]);
    }

    /// Dispatches a compute pass several times; each dispatch sees what those before it have written.
    pub fn dispatch_all(&mut self, name: &str, pass: &ComputePass, dispatches: &[(Push, Groups)]) {
        let pass = &pass.0;
        self.begin_pass(name);
        for (turn, (push, groups)) in dispatches.iter().enumerate() {
            if turn > 0 {
                self.order();
            }
            let (device, commands) = (&self.gpu.device, self.commands);
            // SAFETY: recording; the pass and the buffers it binds are alive until submission ends.
            unsafe {
                device.cmd_bind_pipeline(commands, vk::PipelineBindPoint::COMPUTE, pass.pipeline);
                let sets = [pass.set];
                device.cmd_bind_descriptor_sets(
                    commands,
                    vk::PipelineBindPoint::COMPUTE,
                    pass.layout,
                    0,
                    &sets,
                    &[],
                );
                let bytes = bytemuck::bytes_of(push);
                device.cmd_push_constants(
                    commands,
                    pass.layout,
                    vk::ShaderStageFlags::COMPUTE,
                    0,
                    bytes,
                );
                match groups {
                    Groups::Direct([x, y, z]) => device.cmd_dispatch(commands, *x, *y, *z),
                    Groups::Indirect(buffer, offset) => {
                        device.cmd_dispatch_indirect(commands, buffer.raw, *offset)
                    }
                }
            }
        }
        self.end_pass();
    }

    /// Draws with one or more pipelines into cleared attachments.
    pub fn draw(
        &mut self,
        name: &str,
        push: Push,
        attachments: &Attachments,
        draws: &[(&GraphicsPass, Draw)],
    ) {
        self.pass(name, |device, commands| {
            begin_rendering(device, commands, attachments);
            for (pass, draw) in draws {
                record_draw(device, commands, &pass.0, push, draw);
            }
            // SAFETY: recording; rendering was begun above.
            unsafe { device.cmd_end_rendering(commands) };
        });
    }

    /// Fills a buffer with zeros.
    pub fn clear(&mut self, name: &str, buffer: &Buffer) {
        self.pass(name, |device, commands| {
            // SAFETY: recording; the buffer is alive.
            unsafe { device.cmd_fill_buffer(commands, buffer.raw, 0, vk::WHOLE_SIZE, 0) };
        });
    }

    /// Copies as much as both hold.
    pub fn copy_buffer(&mut self, name: &str, from: &Buffer, to: &Buffer) {
        self.pass(name, |device, commands| {
            let region = [vk::BufferCopy::default().size(from.bytes.min(to.bytes))];
            // SAFETY: recording; both buffers are alive and hold that many bytes.
            unsafe { device.cmd_copy_buffer(commands, from.raw, to.raw, &region) };
        });
    }

    /// Copies all layers of an image, tightly packed. The image leaves its layout for the copy: validation
    /// layers hold that copying from any other than the one for copies costs time.
    pub fn copy_image(&mut self, name: &str, from: &Image, to: &Buffer) {
        let (stay, copy) = (
            vk::ImageLayout::GENERAL,
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        );
        self.change_layout(std::iter::once(from), stay, copy);
        self.pass(name, |device, commands| {
            let layers = vk::ImageSubresourceLayers::default()
                .aspect_mask(from.kind.aspect())
                .layer_count(from.layers);
            let region = [vk::BufferImageCopy::default()
                .image_subresource(layers)
                .image_extent(vk::Extent3D {
                    width: from.width,
                    height: from.height,
                    depth: 1,
                })];
            // SAFETY: recording; the buffer was made for the image.
            unsafe { device.cmd_copy_image_to_buffer(commands, from.raw, copy, to.raw, &region) };
        });
        self.change_layout(std::iter::once(from), copy, stay);
    }

    /// Copies an image of one layer into a layer of another of the same size and format. Both leave their layout
    /// for the copy, as in [`Self::copy_image`].
    pub fn copy_layer(&mut self, name: &str, from: &Image, to: &Image, layer: u32) {
        let stay = vk::ImageLayout::GENERAL;
        let (source, target) = (
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        );
        self.change_layout(std::iter::once(from), stay, source);
        self.change_layout(std::iter::once(to), stay, target);
        self.pass(name, |device, commands| {
            let layers = |image: &Image, first| {
                vk::ImageSubresourceLayers::default()
                    .aspect_mask(image.kind.aspect())
                    .base_array_layer(first)
                    .layer_count(1)
            };
            let region = [vk::ImageCopy::default()
                .src_subresource(layers(from, 0))
                .dst_subresource(layers(to, layer))
                .extent(vk::Extent3D {
                    width: from.width,
                    height: from.height,
                    depth: 1,
                })];
            // SAFETY: recording; both images are alive, and `to` has the layer.
            unsafe {
                device.cmd_copy_image(commands, from.raw, source, to.raw, target, &region);
            }
        });
        self.change_layout(std::iter::once(from), source, stay);
        self.change_layout(std::iter::once(to), target, stay);
    }

    /// Submits and waits for the end. Returns the GPU time of each pass.
    pub fn submit_and_wait(&mut self) -> Result<Timings> {
        let device = &self.gpu.device;
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        // What the host reads next was written by copies.
        self.barrier(vk::PipelineStageFlags2::HOST, vk::AccessFlags2::HOST_READ);
        // SAFETY: the recording is complete; the queue is externally synchronized by the lock; the
        // fence is unsignalled and waited for.
        unsafe {
            device
                .end_command_buffer(self.commands)
                .map_err(failed("vkEndCommandBuffer"))?;
            let submission = self.gpu.submission.lock();
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
        let timed = self.names.len().min(self.timed_max as usize);
        if timed == 0 {
            return Ok(Timings::default());
        }
        let mut ticks = vec![0u64; 2 * timed];
        // SAFETY: the queries were written by the submission that has finished.
        unsafe {
            self.gpu.device.get_query_pool_results(
                self.queries,
                0,
                &mut ticks,
                vk::QueryResultFlags::TYPE_64,
            )
        }
        .map_err(failed("vkGetQueryPoolResults"))?;
        let ms = |pair: &[u64]| pair[1].wrapping_sub(pair[0]) as f64 * self.gpu.tick_ns * 1e-6;
        Ok(Timings {
            passes: self
                .names
                .iter()
                .cloned()
                .zip(ticks.chunks_exact(2).map(ms))
                .collect(),
        })
    }

    /// One pass: what was written before is visible to it.
    fn pass(&mut self, name: &str, record: impl FnOnce(&ash::Device, vk::CommandBuffer)) {
        self.begin_pass(name);
        record(&self.gpu.device, self.commands);
        self.end_pass();
    }

    fn begin_pass(&mut self, name: &str) {
        self.label(Some(name));
        // The timestamp before the barrier: lavapipe takes it at the next flush, which is the barrier.
        self.timestamp(2 * self.names.len() as u32);
        self.names.push(name.to_owned());
        self.order();
    }

    fn end_pass(&self) {
        self.timestamp(2 * self.names.len() as u32 - 1);
        self.label(None);
    }

    /// What was written before is visible to what follows.
    fn order(&self) {
        self.barrier(
            vk::PipelineStageFlags2::ALL_COMMANDS,
            vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE,
        );
    }

    fn barrier(&self, stages: vk::PipelineStageFlags2, access: vk::AccessFlags2) {
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(stages)
            .dst_access_mask(access)];
        let info = vk::DependencyInfo::default().memory_barriers(&barrier);
        // SAFETY: recording, outside of rendering.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.commands, &info) };
    }

    fn timestamp(&self, query: u32) {
        if query < 2 * self.timed_max {
            let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
            // SAFETY: recording; the query exists and was reset by `begin`.
            unsafe {
                self.gpu
                    .device
                    .cmd_write_timestamp2(self.commands, stage, self.queries, query)
            };
        }
    }

    /// Begins a label, or ends it.
    fn label(&self, name: Option<&str>) {
        let Some(debug) = &self.gpu.debug else { return };
        // SAFETY: recording; labels are begun and ended in pairs.
        unsafe {
            match name.map(CString::new) {
                Some(name) => {
                    let name = name.unwrap_or_default();
                    let label = vk::DebugUtilsLabelEXT::default().label_name(&name);
                    debug.cmd_begin_debug_utils_label(self.commands, &label);
                }
                None => debug.cmd_end_debug_utils_label(self.commands),
            }
        }
    }
}

impl Drop for Recorder {
    fn drop(&mut self) {
        let device = &self.gpu.device;
        // SAFETY: destroyed once, null handles are ignored. After a failed wait the device is lost and
        // nothing is pending.
        unsafe {
            device.destroy_query_pool(self.queries, None);
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
        }
    }
}
