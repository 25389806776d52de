//! The validation layer is awake: a missing barrier is reported. Without this, a silent layer would pass
//! for a clean engine.

use std::sync::Arc;

use ash::vk;
use halfshade::gpu::{Gpu, Options};

const BYTES: u64 = 4096;

/// A buffer with memory of its own.
struct Bytes {
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
}

impl Bytes {
    fn new(device: &ash::Device) -> Self {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default().size(BYTES).usage(usage);
        // SAFETY: the infos are complete; any memory type that the buffer allows will do.
        unsafe {
            let buffer = device.create_buffer(&info, None).expect("a buffer");
            let needs = device.get_buffer_memory_requirements(buffer);
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(needs.memory_type_bits.trailing_zeros());
            let memory = device.allocate_memory(&info, None).expect("memory");
            device
                .bind_buffer_memory(buffer, memory, 0)
                .expect("bound memory");
            Self { buffer, memory }
        }
    }

    fn destroy(self, device: &ash::Device) {
        // SAFETY: the queue is idle, so nothing uses them.
        unsafe {
            device.destroy_buffer(self.buffer, None);
            device.free_memory(self.memory, None);
        }
    }
}

/// Fills a buffer, then copies it; without the barrier the copy may read what was there before.
fn fill_and_copy(gpu: &Arc<Gpu>, barrier: bool) {
    let (_, device, queue, family) = gpu.raw();
    let (from, to) = (Bytes::new(device), Bytes::new(device));
    let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
    // SAFETY: plain Vulkan but for the missing barrier, which the test is about; it can but give the
    // copy other bytes, which nobody reads.
    unsafe {
        let pool = device.create_command_pool(&info, None).expect("a pool");
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .command_buffer_count(1);
        let commands = device
            .allocate_command_buffers(&info)
            .expect("a command buffer")[0];
        device
            .begin_command_buffer(commands, &vk::CommandBufferBeginInfo::default())
            .expect("recording");
        device.cmd_fill_buffer(commands, from.buffer, 0, vk::WHOLE_SIZE, 1);
        if barrier {
            let stage = vk::PipelineStageFlags2::ALL_TRANSFER;
            let barrier = [vk::MemoryBarrier2::default()
                .src_stage_mask(stage)
                .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .dst_stage_mask(stage)
                .dst_access_mask(vk::AccessFlags2::TRANSFER_READ)];
            let info = vk::DependencyInfo::default().memory_barriers(&barrier);
            device.cmd_pipeline_barrier2(commands, &info);
        }
        let region = [vk::BufferCopy::default().size(BYTES)];
        device.cmd_copy_buffer(commands, from.buffer, to.buffer, &region);
        device.end_command_buffer(commands).expect("recorded");
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        device
            .queue_submit2(queue, &submit, vk::Fence::null())
            .expect("submitted");
        device.queue_wait_idle(queue).expect("done");
        device.destroy_command_pool(pool, None);
    }
    from.destroy(device);
    to.destroy(device);
}

/// What the layer says, up to and including the device's end.
fn messages_of(work: impl FnOnce(&Arc<Gpu>)) -> Vec<String> {
    let options = Options {
        validate: true,
        ..Options::default()
    };
    let gpu = Gpu::open(&options).expect("a Vulkan device and the validation layer");
    let messages = gpu.validation_messages();
    work(&gpu);
    drop(gpu);
    messages.lock().expect("no callback panicked").clone()
}

#[test]
fn a_missing_barrier_is_reported() {
    let messages = messages_of(|gpu| fill_and_copy(gpu, false));
    assert!(
        messages
            .iter()
            .any(|message| message.contains("SYNC-HAZARD-READ-AFTER-WRITE")),
        "the layer only said: {messages:?}"
    );
}

#[test]
fn the_right_barrier_is_not() {
    let messages = messages_of(|gpu| fill_and_copy(gpu, true));
    assert!(messages.is_empty(), "{messages:?}");
}

#[test]
fn what_outlives_its_device_is_reported() {
    let mut left = None;
    let messages = messages_of(|gpu| left = Some(Bytes::new(gpu.raw().1)));
    assert!(
        messages
            .iter()
            .any(|message| message.contains("VUID-vkDestroyDevice-device")),
        "the layer only said: {messages:?}"
    );
}
