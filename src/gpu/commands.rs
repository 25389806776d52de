//! Recording into a command buffer: passes, each with a label, timestamps where they are wanted, and the barrier
//! before it. Recording takes no memory, submits nothing and waits for nothing, so that it serves the recorder's own
//! command buffers and those of a host alike.

use std::ffi::CStr;

use ash::vk;

use super::device::Gpu;
use super::draw::Rendering;
use super::host::HostImage;
use super::memory::{Buffer, Image};
use super::pass::Bound;
use super::resources::Resources;
use crate::shared::Push;

/// How many work groups to dispatch.
pub enum Groups<'a> {
    Direct([u32; 3]),
    /// A VkDispatchIndirectCommand at a byte offset.
    Indirect(&'a Buffer, u64),
}

/// The names of recorded passes, and timestamps around the first of them.
pub(super) struct Timer {
    pub queries: vk::QueryPool,
    /// [pass] How many passes can be timed.
    pub timed_max: u32,
    pub names: Vec<&'static str>,
}

/// A command buffer that is being recorded. Its calls cannot fail.
pub struct Commands<'a> {
    gpu: &'a Gpu,
    raw: vk::CommandBuffer,
    timer: Option<&'a mut Timer>,
}

impl<'a> Commands<'a> {
    pub(super) fn timed(gpu: &'a Gpu, raw: vk::CommandBuffer, timer: &'a mut Timer) -> Self {
        Self {
            gpu,
            raw,
            timer: Some(timer),
        }
    }

    /// A host's command buffer.
    ///
    /// # Safety
    /// It is of the same device, in the recording state, outside of rendering, of a family with graphics and compute,
    /// and nothing else records into it meanwhile.
    pub unsafe fn of_host(gpu: &'a Gpu, raw: vk::CommandBuffer) -> Self {
        Self {
            gpu,
            raw,
            timer: None,
        }
    }

    /// Brings images into the layout that they stay in; what they held is lost.
    pub fn initialize(&mut self, resources: &Resources) {
        let (old, new) = (vk::ImageLayout::UNDEFINED, vk::ImageLayout::GENERAL);
        for image in resources.images() {
            self.change_layout(image, old, new);
        }
    }

    fn change_layout(&self, image: &Image, old: vk::ImageLayout, new: vk::ImageLayout) {
        let barrier = vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .old_layout(old)
            .new_layout(new)
            .image(image.raw)
            .subresource_range(image.range());
        self.image_barrier(barrier);
    }

    fn image_barrier(&self, barrier: vk::ImageMemoryBarrier2) {
        let barriers = [barrier];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: recording; the image is alive.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.raw, &info) };
    }

    /// Takes over an image from the state that the host leaves it in.
    pub fn acquire(&mut self, image: &HostImage) {
        self.image_barrier(image.acquisition());
    }

    /// Gives it back in the state that the host wants it in.
    pub fn release(&mut self, image: &HostImage) {
        self.image_barrier(image.release());
    }

    /// Dispatches a compute pass.
    pub fn dispatch<'p>(
        &mut self,
        name: &'static str,
        pass: impl Into<Bound<'p>>,
        push: Push,
        groups: Groups,
    ) {
        self.dispatch_all(name, [(pass.into(), push, groups)]);
    }

    /// Dispatches several times within one pass; each dispatch sees what those before it have written.
    pub fn dispatch_all<'p>(
        &mut self,
        name: &'static str,
        dispatches: impl IntoIterator<Item = (Bound<'p>, Push, Groups<'p>)>,
    ) {
        self.dispatches(name, true, dispatches);
    }

    /// Dispatches several times within one pass; no dispatch touches what another writes.
    pub fn dispatch_independent<'p>(
        &mut self,
        name: &'static str,
        dispatches: impl IntoIterator<Item = (Bound<'p>, Push, Groups<'p>)>,
    ) {
        self.dispatches(name, false, dispatches);
    }

    fn dispatches<'p>(
        &mut self,
        name: &'static str,
        in_order: bool,
        dispatches: impl IntoIterator<Item = (Bound<'p>, Push, Groups<'p>)>,
    ) {
        self.begin_pass(name);
        for (turn, (bound, push, groups)) in dispatches.into_iter().enumerate() {
            if turn > 0 && in_order {
                self.order();
            }
            let (device, commands) = (&self.gpu.device, self.raw);
            bound.record(
                device,
                commands,
                vk::PipelineBindPoint::COMPUTE,
                vk::ShaderStageFlags::COMPUTE,
                push,
            );
            // SAFETY: recording; the pass and the buffers it binds are alive until submission ends.
            unsafe {
                match groups {
                    Groups::Direct([x, y, z]) => device.cmd_dispatch(commands, x, y, z),
                    Groups::Indirect(buffer, offset) => {
                        device.cmd_dispatch_indirect(commands, buffer.raw, offset)
                    }
                }
            }
        }
        self.end_pass();
    }

    /// Renders, once or several times, within one pass; what is drawn touches nothing that the pass draws elsewhere.
    pub fn render<R>(&mut self, name: &'static str, record: impl FnOnce(&Rendering) -> R) -> R {
        self.pass(name, |device, commands| {
            record(&Rendering { device, commands })
        })
    }

    /// Fills buffers with zeros.
    pub fn clear<'b>(&mut self, name: &'static str, buffers: impl IntoIterator<Item = &'b Buffer>) {
        self.pass(name, |device, commands| {
            for buffer in buffers {
                // SAFETY: recording; the buffer is alive.
                unsafe { device.cmd_fill_buffer(commands, buffer.raw, 0, vk::WHOLE_SIZE, 0) };
            }
        });
    }

    /// Writes values that the command buffer carries to the start of buffers; multiples of 4 bytes.
    pub fn update<'b>(
        &mut self,
        name: &'static str,
        updates: impl IntoIterator<Item = (&'b Buffer, &'b [u8])>,
    ) {
        /// [byte] What a single command may carry.
        const CHUNK: usize = 65536;
        self.pass(name, |device, commands| {
            for (buffer, data) in updates {
                for (index, chunk) in data.chunks(CHUNK).enumerate() {
                    let offset = (index * CHUNK) as u64;
                    // SAFETY: recording; the buffer is alive and holds the data.
                    unsafe { device.cmd_update_buffer(commands, buffer.raw, offset, chunk) };
                }
            }
        });
    }

    /// Copies as much as both hold.
    pub fn copy_buffer(&mut self, name: &'static str, from: &Buffer, to: &Buffer) {
        self.pass(name, |device, commands| {
            let region = [vk::BufferCopy::default().size(from.bytes.min(to.bytes))];
            // SAFETY: recording; both buffers are alive and hold that many bytes.
            unsafe { device.cmd_copy_buffer(commands, from.raw, to.raw, &region) };
        });
    }

    /// Copies all layers of an image, tightly packed. The image leaves its layout for the copy: validation
    /// layers hold that copying from any other than the one for copies costs time.
    pub fn copy_image(&mut self, name: &'static str, from: &Image, to: &Buffer) {
        let (stay, copy) = (
            vk::ImageLayout::GENERAL,
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        );
        self.change_layout(from, stay, copy);
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
        self.change_layout(from, copy, stay);
    }

    /// Copies an image of one layer into a layer of another of the same size and format. Both leave their layout
    /// for the copy, as in [`Self::copy_image`].
    pub fn copy_layer(&mut self, name: &'static str, from: &Image, to: &Image, layer: u32) {
        let stay = vk::ImageLayout::GENERAL;
        let (source, target) = (
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        );
        self.change_layout(from, stay, source);
        self.change_layout(to, stay, target);
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
        self.change_layout(from, source, stay);
        self.change_layout(to, target, stay);
    }

    /// One pass: what was written before is visible to it.
    fn pass<R>(
        &mut self,
        name: &'static str,
        record: impl FnOnce(&ash::Device, vk::CommandBuffer) -> R,
    ) -> R {
        self.begin_pass(name);
        let result = record(&self.gpu.device, self.raw);
        self.end_pass();
        result
    }

    fn begin_pass(&mut self, name: &'static str) {
        self.label(Some(name));
        // The timestamp before the barrier: lavapipe takes it at the next flush, which is the barrier.
        let recorded = self.timer.as_ref().map_or(0, |timer| timer.names.len());
        self.timestamp(2 * recorded as u32);
        if let Some(timer) = &mut self.timer {
            timer.names.push(name);
        }
        self.order();
    }

    fn end_pass(&self) {
        if let Some(timer) = &self.timer {
            self.timestamp(2 * timer.names.len() as u32 - 1);
        }
        self.label(None);
    }

    /// What was written before is visible to what follows.
    pub fn order(&self) {
        self.barrier(
            vk::PipelineStageFlags2::ALL_COMMANDS,
            vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE,
        );
    }

    pub(super) fn barrier(&self, stages: vk::PipelineStageFlags2, access: vk::AccessFlags2) {
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(stages)
            .dst_access_mask(access)];
        let info = vk::DependencyInfo::default().memory_barriers(&barrier);
        // SAFETY: recording, outside of rendering.
        unsafe { self.gpu.device.cmd_pipeline_barrier2(self.raw, &info) };
    }

    fn timestamp(&self, query: u32) {
        let Some(timer) = &self.timer else { return };
        if query < 2 * timer.timed_max {
            let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
            // SAFETY: recording; the query exists and was reset by `Recorder::begin`.
            unsafe {
                self.gpu
                    .device
                    .cmd_write_timestamp2(self.raw, stage, timer.queries, query)
            };
        }
    }

    /// Begins a label, or ends it.
    fn label(&self, name: Option<&str>) {
        let Some(debug) = &self.gpu.debug else { return };
        // SAFETY: recording; labels are begun and ended in pairs.
        unsafe {
            match name {
                Some(name) => {
                    let mut text = [0u8; 64];
                    let length = name.len().min(text.len() - 1);
                    text[..length].copy_from_slice(&name.as_bytes()[..length]);
                    let name = CStr::from_bytes_until_nul(&text).unwrap_or_default();
                    let label = vk::DebugUtilsLabelEXT::default().label_name(name);
                    debug.cmd_begin_debug_utils_label(self.raw, &label);
                }
                None => debug.cmd_end_debug_utils_label(self.raw),
            }
        }
    }
}
