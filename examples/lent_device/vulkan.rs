//! The engine's own Vulkan: instance, device, images, buffers and a command buffer.

use std::ffi::CStr;

use ash::vk;
use halfshade::gpu::HostImageInfo;

use super::{AT_REST, PIXELS, Result, SIDE};

/// What the engine has of Vulkan; the library knows nothing of it but what it is lent.
pub struct Engine {
    pub entry: ash::Entry,
    pub instance: ash::Instance,
    pub physical: vk::PhysicalDevice,
    pub device: ash::Device,
    queue: vk::Queue,
    pub family: u32,
    pool: vk::CommandPool,
    pub commands: vk::CommandBuffer,
    memories: Vec<vk::DeviceMemory>,
    buffers: Vec<vk::Buffer>,
    images: Vec<vk::Image>,
}

/// The queue family with graphics and compute.
fn family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<u32> {
    let both = vk::QueueFlags::GRAPHICS | vk::QueueFlags::COMPUTE;
    // SAFETY: a plain query.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
    let found = families
        .iter()
        .position(|family| family.queue_flags.contains(both));
    found.map(|index| index as u32)
}

/// A device with what the library requires.
fn create_device(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Result<ash::Device> {
    let family = family(instance, physical).ok_or("no queue")?;
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(family)
        .queue_priorities(&[1.0])];
    let core = vk::PhysicalDeviceFeatures::default().shader_storage_image_extended_formats(true);
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default().scalar_block_layout(true);
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true)
        .maintenance4(true);
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_features(&core)
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: all that the info points to outlives the call.
    Ok(unsafe { instance.create_device(physical, &info, None) }?)
}

/// The engine's own Vulkan. SAFETY, throughout: handles are alive, infos complete, and the queue idles after each submission.
impl Engine {
    /// An instance, the first device that the library can use, and a queue with graphics and compute.
    pub fn new() -> Result<Self> {
        const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";
        // SAFETY: plain Vulkan, here and below: handles are alive, infos complete, and the queue idles before anything goes.
        unsafe {
            let entry = ash::Entry::load()?;
            let installed = entry.enumerate_instance_layer_properties()?;
            let validates = installed
                .iter()
                .any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION));
            let layers = [VALIDATION.as_ptr()];
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
            let info = vk::InstanceCreateInfo::default()
                .application_info(&application)
                .enabled_layer_names(if validates { &layers } else { &[] });
            let instance = entry.create_instance(&info, None)?;
            let (physical, family) = instance
                .enumerate_physical_devices()?
                .into_iter()
                .find_map(|physical| Some((physical, family(&instance, physical)?)))
                .ok_or("no device has a queue with graphics and compute")?;
            let device = create_device(&instance, physical)?;
            let pool = vk::CommandPoolCreateInfo::default().queue_family_index(family);
            let pool = device.create_command_pool(&pool, None)?;
            let commands = vk::CommandBufferAllocateInfo::default()
                .command_pool(pool)
                .command_buffer_count(1);
            Ok(Self {
                commands: device.allocate_command_buffers(&commands)?[0],
                queue: device.get_device_queue(family, 0),
                family,
                entry,
                instance,
                physical,
                device,
                pool,
                memories: Vec::new(),
                buffers: Vec::new(),
                images: Vec::new(),
            })
        }
    }

    pub fn begin(&self) -> Result<()> {
        let info = vk::CommandBufferBeginInfo::default();
        unsafe {
            self.device
                .reset_command_pool(self.pool, Default::default())?;
            Ok(self.device.begin_command_buffer(self.commands, &info)?)
        }
    }

    pub fn submit(&self) -> Result<()> {
        let commands = [self.commands];
        let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
        unsafe {
            self.device.end_command_buffer(self.commands)?;
            self.device
                .queue_submit(self.queue, &submit, vk::Fence::null())?;
            Ok(self.device.queue_wait_idle(self.queue)?)
        }
    }

    fn allocate(
        &mut self,
        needs: vk::MemoryRequirements,
        visible: bool,
    ) -> Result<vk::DeviceMemory> {
        let wanted = match visible {
            true => vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
            false => vk::MemoryPropertyFlags::empty(),
        };
        unsafe {
            let kinds = self
                .instance
                .get_physical_device_memory_properties(self.physical);
            let fits = |kind: &u32| {
                let flags = kinds.memory_types[*kind as usize].property_flags;
                needs.memory_type_bits & (1 << kind) != 0 && flags.contains(wanted)
            };
            let kind = (0..kinds.memory_type_count)
                .find(fits)
                .ok_or("no such memory")?;
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(needs.size)
                .memory_type_index(kind);
            let memory = self.device.allocate_memory(&info, None)?;
            self.memories.push(memory);
            Ok(memory)
        }
    }

    /// A buffer that holds `data`, with its memory.
    pub fn buffer(&mut self, data: &[u8]) -> Result<(vk::Buffer, vk::DeviceMemory)> {
        let usage = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_SRC
            | vk::BufferUsageFlags::TRANSFER_DST;
        let info = vk::BufferCreateInfo::default()
            .size(data.len() as u64)
            .usage(usage);
        unsafe {
            let buffer = self.device.create_buffer(&info, None)?;
            self.buffers.push(buffer);
            let memory = self.allocate(self.device.get_buffer_memory_requirements(buffer), true)?;
            self.device.bind_buffer_memory(buffer, memory, 0)?;
            let place = self
                .device
                .map_memory(memory, 0, vk::WHOLE_SIZE, Default::default())?;
            std::ptr::copy_nonoverlapping(data.as_ptr(), place.cast(), data.len());
            self.device.unmap_memory(memory);
            Ok((buffer, memory))
        }
    }

    /// An image at rest that holds `data`, if there is any.
    pub fn image(&mut self, format: vk::Format, data: &[u8]) -> Result<HostImageInfo> {
        let usage = vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::COLOR_ATTACHMENT
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST;
        let extent = vk::Extent3D {
            width: SIDE,
            height: SIDE,
            depth: 1,
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(extent)
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage);
        let (raw, copy) = (
            unsafe { self.device.create_image(&info, None) }?,
            vk::ImageLayout::TRANSFER_DST_OPTIMAL,
        );
        self.images.push(raw);
        let needs = unsafe { self.device.get_image_memory_requirements(raw) };
        let memory = self.allocate(needs, false)?;
        unsafe { self.device.bind_image_memory(raw, memory, 0) }?;
        let staging = self.buffer(if data.is_empty() { &[0; 4] } else { data })?.0;
        self.begin()?;
        self.turn(raw, vk::ImageLayout::UNDEFINED, copy);
        if !data.is_empty() {
            let region = [region()];
            unsafe {
                self.device
                    .cmd_copy_buffer_to_image(self.commands, staging, raw, copy, &region)
            };
        }
        self.turn(raw, copy, AT_REST.layout);
        self.submit()?;
        let (size, found, left) = ((SIDE, SIDE), AT_REST, AT_REST);
        Ok(HostImageInfo {
            raw,
            format,
            size,
            layer: 0,
            level: 0,
            found,
            left,
        })
    }

    fn turn(&self, image: vk::Image, old: vk::ImageLayout, new: vk::ImageLayout) {
        let any = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let color = vk::ImageSubresourceRange::default()
            .aspect_mask(vk::ImageAspectFlags::COLOR)
            .level_count(1)
            .layer_count(1);
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(any)
            .dst_stage_mask(all)
            .dst_access_mask(any)
            .old_layout(old)
            .new_layout(new)
            .image(image)
            .subresource_range(color)];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        unsafe { self.device.cmd_pipeline_barrier2(self.commands, &info) };
    }

    /// What an image of floats holds.
    pub fn read(&mut self, image: &HostImageInfo) -> Result<Vec<f32>> {
        let (buffer, memory) = self.buffer(&[0; 4 * PIXELS])?;
        let copy = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        self.begin()?;
        self.turn(image.raw, AT_REST.layout, copy);
        let region = [region()];
        unsafe {
            self.device
                .cmd_copy_image_to_buffer(self.commands, image.raw, copy, buffer, &region)
        };
        self.turn(image.raw, copy, AT_REST.layout);
        self.submit()?;
        unsafe {
            let place = self
                .device
                .map_memory(memory, 0, vk::WHOLE_SIZE, Default::default())?;
            let data = std::slice::from_raw_parts(place.cast::<f32>(), PIXELS).to_vec();
            self.device.unmap_memory(memory);
            Ok(data)
        }
    }

    pub fn destroy(&mut self) {
        unsafe {
            self.images
                .drain(..)
                .for_each(|image| self.device.destroy_image(image, None));
            self.buffers
                .drain(..)
                .for_each(|buffer| self.device.destroy_buffer(buffer, None));
            self.memories
                .drain(..)
                .for_each(|memory| self.device.free_memory(memory, None));
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

/// All of an image.
fn region() -> vk::BufferImageCopy {
    let color = vk::ImageSubresourceLayers::default()
        .aspect_mask(vk::ImageAspectFlags::COLOR)
        .layer_count(1);
    vk::BufferImageCopy::default()
        .image_subresource(color)
        .image_extent(vk::Extent3D {
            width: SIDE,
            height: SIDE,
            depth: 1,
        })
}
