//! A host with a device of its own: images, buffers and a command buffer, in plain Vulkan, under validation.

use std::sync::Arc;

use ash::vk;
use halfshade::gpu::{Enabled, Gpu, HostDevice, HostImageInfo, ImageState, Options};

/// What the host reads and writes, and frees at the end.
pub struct Host {
    pub gpu: Arc<Gpu>,
    physical: vk::PhysicalDevice,
    entry: ash::Entry,
    pool: vk::CommandPool,
    pub commands: vk::CommandBuffer,
    memories: Vec<vk::DeviceMemory>,
    images: Vec<vk::Image>,
    buffers: Vec<vk::Buffer>,
}

/// How the host keeps images between frames.
pub const AT_REST: ImageState = ImageState {
    layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    stage: vk::PipelineStageFlags2::FRAGMENT_SHADER,
    access: vk::AccessFlags2::SHADER_SAMPLED_READ,
};

/// Runs a test with a host and its device, and fails when the validation layer has anything to say.
pub fn with_host(test: impl FnOnce(&mut Host)) {
    let gpu = Gpu::open(&Options {
        validate: true,
        ..Options::default()
    })
    .expect("a Vulkan device and the validation layer");
    let messages = gpu.validation_messages();
    let mut host = Host::new(gpu);
    test(&mut host);
    drop(host);
    let messages = messages.lock().expect("no callback panicked");
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

impl Host {
    fn new(gpu: Arc<Gpu>) -> Self {
        let (instance, device, _, family) = gpu.raw();
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
        // SAFETY: plain Vulkan; the infos are complete, here and below.
        unsafe {
            let entry = ash::Entry::load().expect("Vulkan's loader");
            let physical = instance.enumerate_physical_devices().expect("devices");
            let physical = physical
                .into_iter()
                .find(|&candidate| {
                    let name = instance.get_physical_device_properties(candidate);
                    name.device_name_as_c_str()
                        .is_ok_and(|name| name.to_string_lossy() == gpu.info.name)
                })
                .expect("the device was listed");
            let pool = device.create_command_pool(&info, None).expect("a pool");
            let info = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            let commands = device.allocate_command_buffers(&info).expect("commands")[0];
            Self {
                physical,
                entry,
                pool,
                commands,
                memories: Vec::new(),
                images: Vec::new(),
                buffers: Vec::new(),
                gpu,
            }
        }
    }

    /// The device as a host hands it over.
    pub fn device(&self) -> HostDevice {
        let (instance, device, _, family) = self.gpu.raw();
        HostDevice {
            get_instance_proc_addr: self.entry.static_fn().get_instance_proc_addr,
            instance: instance.handle(),
            physical: self.physical,
            device: device.handle(),
            api_version: vk::API_VERSION_1_3,
            debug_utils: true,
            enabled: Enabled {
                shader_storage_image_extended_formats: true,
                scalar_block_layout: true,
                dynamic_rendering: true,
                synchronization2: true,
                maintenance4: true,
            },
            family,
            callbacks: None,
        }
    }

    /// The device as an effect sees it.
    pub fn adopted(&self) -> Arc<Gpu> {
        // SAFETY: the handles are alive as long as the host, which outlives all that the tests make.
        unsafe { Gpu::adopt(self.device()) }.expect("the device has all that is required")
    }

    fn allocate(&mut self, needs: vk::MemoryRequirements, visible: bool) -> vk::DeviceMemory {
        let (instance, device, _, _) = self.gpu.raw();
        let wanted = match visible {
            true => vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
            false => vk::MemoryPropertyFlags::empty(),
        };
        // SAFETY: as above.
        unsafe {
            let kinds = instance.get_physical_device_memory_properties(self.physical);
            let kind = (0..kinds.memory_type_count)
                .find(|&kind| {
                    needs.memory_type_bits & (1 << kind) != 0
                        && kinds.memory_types[kind as usize]
                            .property_flags
                            .contains(wanted)
                })
                .expect("a kind of memory");
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(kind);
            let memory = device.allocate_memory(&info, None).expect("memory");
            self.memories.push(memory);
            memory
        }
    }

    /// A buffer that host and device see.
    pub fn buffer(&mut self, data: &[u8]) -> (vk::Buffer, vk::DeviceMemory) {
        let device = self.gpu.raw().1.clone();
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::VERTEX_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default()
            .size(data.len() as u64)
            .usage(usage);
        // SAFETY: as above; the memory is as large as the data.
        unsafe {
            let buffer = device.create_buffer(&info, None).expect("a buffer");
            self.buffers.push(buffer);
            let memory = self.allocate(device.get_buffer_memory_requirements(buffer), true);
            device.bind_buffer_memory(buffer, memory, 0).expect("bound");
            let place = device
                .map_memory(memory, 0, data.len() as u64, Default::default())
                .expect("mapped");
            std::ptr::copy_nonoverlapping(data.as_ptr(), place.cast(), data.len());
            device.unmap_memory(memory);
            (buffer, memory)
        }
    }

    /// An image at rest that holds `data`; empty = nothing in particular.
    pub fn image(&mut self, format: vk::Format, size: (u32, u32), data: &[u8]) -> HostImageInfo {
        let device = self.gpu.raw().1.clone();
        let usage = vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_DST
            | vk::ImageUsageFlags::TRANSFER_SRC;
        let attachment = match aspects(format).0 {
            vk::ImageAspectFlags::DEPTH => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
            _ => vk::ImageUsageFlags::COLOR_ATTACHMENT,
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D {
                width: size.0,
                height: size.1,
                depth: 1,
            })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage | attachment);
        // SAFETY: as above.
        let raw = unsafe {
            let image = device.create_image(&info, None).expect("an image");
            self.images.push(image);
            let memory = self.allocate(device.get_image_memory_requirements(image), false);
            device.bind_image_memory(image, memory, 0).expect("bound");
            image
        };
        let info = HostImageInfo {
            raw,
            format,
            size,
            layer: 0,
            level: 0,
            found: AT_REST,
            left: AT_REST,
        };
        let staging = (!data.is_empty()).then(|| self.buffer(data).0);
        self.run(|device, commands| {
            let target = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            let mut layout = vk::ImageLayout::UNDEFINED;
            if let Some(staging) = staging {
                turn(device, commands, &info, layout, target);
                let region = [region(&info)];
                // SAFETY: as above; the buffer holds the image.
                unsafe { device.cmd_copy_buffer_to_image(commands, staging, raw, target, &region) };
                layout = target;
            }
            turn(device, commands, &info, layout, AT_REST.layout);
        });
        info
    }

    /// What an image at rest holds.
    pub fn read(&mut self, image: &HostImageInfo, bytes: usize) -> Vec<u8> {
        let (buffer, memory) = self.buffer(&vec![0; bytes]);
        self.run(|device, commands| {
            let source = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
            turn(device, commands, image, AT_REST.layout, source);
            let region = [region(image)];
            // SAFETY: as above; the buffer holds the image.
            unsafe {
                device.cmd_copy_image_to_buffer(commands, image.raw, source, buffer, &region)
            };
            turn(device, commands, image, source, AT_REST.layout);
        });
        let device = self.gpu.raw().1;
        // SAFETY: as above; the copy has finished.
        unsafe {
            let place = device
                .map_memory(memory, 0, bytes as u64, Default::default())
                .expect("mapped");
            let data = std::slice::from_raw_parts(place.cast::<u8>(), bytes).to_vec();
            device.unmap_memory(memory);
            data
        }
    }

    pub fn begin(&self) {
        let device = self.gpu.raw().1;
        // SAFETY: as above; nothing is pending, for `submit` waits.
        unsafe {
            device
                .reset_command_pool(self.pool, Default::default())
                .expect("reset");
            device
                .begin_command_buffer(self.commands, &vk::CommandBufferBeginInfo::default())
                .expect("recording");
        }
    }

    pub fn submit(&self) {
        let (_, device, queue, _) = self.gpu.raw();
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        // SAFETY: as above.
        unsafe {
            device.end_command_buffer(self.commands).expect("recorded");
            device
                .queue_submit2(queue, &submit, vk::Fence::null())
                .expect("submitted");
            device.queue_wait_idle(queue).expect("done");
        }
    }

    fn run(&self, record: impl FnOnce(&ash::Device, vk::CommandBuffer)) {
        self.begin();
        record(self.gpu.raw().1, self.commands);
        self.submit();
    }
}

/// What of a format is copied, and what changes its layout.
fn aspects(format: vk::Format) -> (vk::ImageAspectFlags, vk::ImageAspectFlags) {
    let (depth, color) = (vk::ImageAspectFlags::DEPTH, vk::ImageAspectFlags::COLOR);
    match format {
        vk::Format::D32_SFLOAT | vk::Format::D16_UNORM => (depth, depth),
        vk::Format::D32_SFLOAT_S8_UINT => (depth, depth | vk::ImageAspectFlags::STENCIL),
        _ => (color, color),
    }
}

fn region(image: &HostImageInfo) -> vk::BufferImageCopy {
    vk::BufferImageCopy::default()
        .image_subresource(
            vk::ImageSubresourceLayers::default()
                .aspect_mask(aspects(image.format).0)
                .layer_count(1),
        )
        .image_extent(vk::Extent3D {
            width: image.size.0,
            height: image.size.1,
            depth: 1,
        })
}

fn turn(
    device: &ash::Device,
    commands: vk::CommandBuffer,
    image: &HostImageInfo,
    from: vk::ImageLayout,
    to: vk::ImageLayout,
) {
    let all = vk::PipelineStageFlags2::ALL_COMMANDS;
    let any = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
    let barrier = [vk::ImageMemoryBarrier2::default()
        .src_stage_mask(all)
        .src_access_mask(any)
        .dst_stage_mask(all)
        .dst_access_mask(any)
        .old_layout(from)
        .new_layout(to)
        .image(image.raw)
        .subresource_range(
            vk::ImageSubresourceRange::default()
                .aspect_mask(aspects(image.format).1)
                .level_count(1)
                .layer_count(1),
        )];
    let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
    // SAFETY: recording, outside of rendering.
    unsafe { device.cmd_pipeline_barrier2(commands, &info) };
}

impl Drop for Host {
    fn drop(&mut self) {
        let device = self.gpu.raw().1;
        // SAFETY: the queue is idle, so nothing uses them.
        unsafe {
            self.images
                .iter()
                .for_each(|&image| device.destroy_image(image, None));
            self.buffers
                .iter()
                .for_each(|&buffer| device.destroy_buffer(buffer, None));
            self.memories
                .iter()
                .for_each(|&memory| device.free_memory(memory, None));
            device.destroy_command_pool(self.pool, None);
        }
    }
}
