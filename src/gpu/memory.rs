//! Buffers and images. Each frees itself.

use std::sync::Arc;

use ash::vk;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use gpu_allocator::{AllocationError, MemoryLocation};

use super::device::Gpu;
use super::failed::failed;
use super::target::Target;
use crate::error::{Error, Result};

/// A buffer that shaders read and write, that indirect commands read, and that can be copied.
pub struct Buffer {
    pub(super) gpu: Arc<Gpu>,
    pub name: String,
    /// [byte]
    pub bytes: u64,
    pub(super) raw: vk::Buffer,
    allocation: Option<Allocation>,
}

/// What an image is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageKind {
    /// D32_SFLOAT, drawn to and sampled.
    Depth,
    /// RGBA32F, drawn to or written by compute passes, and sampled.
    Vector,
    /// RGBA8, drawn to and sampled.
    Color,
    /// D32_SFLOAT, an array that is drawn to a layer at a time, or that depth is copied to, sampled.
    Layers,
    /// RG32F, an array written by compute passes and sampled.
    Bounds,
    /// Likewise RG16F.
    Bounds16,
    /// R32F, whose draws add up, sampled.
    Sums,
    /// Likewise R16F.
    Sums16,
    /// As `Depth`, `Vector` and `Color`, with [`SAMPLES`] samples a texel: drawn to, the latter two sampled.
    DepthSamples,
    VectorSamples,
    ColorSamples,
}

/// Of a texel of a multisampled image. Every device has as many.
pub const SAMPLES: u32 = 4;

impl ImageKind {
    pub fn format(self) -> vk::Format {
        match self {
            Self::Depth | Self::DepthSamples | Self::Layers => vk::Format::D32_SFLOAT,
            Self::Vector | Self::VectorSamples => vk::Format::R32G32B32A32_SFLOAT,
            Self::Color | Self::ColorSamples => vk::Format::R8G8B8A8_UNORM,
            Self::Bounds => vk::Format::R32G32_SFLOAT,
            Self::Bounds16 => vk::Format::R16G16_SFLOAT,
            Self::Sums => vk::Format::R32_SFLOAT,
            Self::Sums16 => vk::Format::R16_SFLOAT,
        }
    }

    /// [byte]
    pub fn texel_bytes(self) -> u64 {
        match self {
            Self::Sums16 => 2,
            Self::Depth | Self::Layers | Self::Color | Self::Bounds16 | Self::Sums => 4,
            Self::Bounds => 8,
            Self::Vector => 16,
            Self::DepthSamples | Self::ColorSamples => u64::from(4 * SAMPLES),
            Self::VectorSamples => u64::from(16 * SAMPLES),
        }
    }

    pub(super) fn samples(self) -> vk::SampleCountFlags {
        match self.is_multisampled() {
            true => vk::SampleCountFlags::TYPE_4,
            false => vk::SampleCountFlags::TYPE_1,
        }
    }

    pub fn is_multisampled(self) -> bool {
        matches!(
            self,
            Self::DepthSamples | Self::VectorSamples | Self::ColorSamples
        )
    }

    /// Whether shaders know it as an array, however many layers it has.
    fn is_array(self) -> bool {
        matches!(self, Self::Bounds | Self::Bounds16 | Self::Layers)
    }

    fn usage(self) -> vk::ImageUsageFlags {
        let own = match self {
            Self::Depth | Self::DepthSamples | Self::Layers => {
                vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
            }
            Self::Vector => vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::STORAGE,
            Self::Color | Self::Sums | Self::Sums16 | Self::VectorSamples | Self::ColorSamples => {
                vk::ImageUsageFlags::COLOR_ATTACHMENT
            }
            Self::Bounds | Self::Bounds16 => vk::ImageUsageFlags::STORAGE,
        };
        own | vk::ImageUsageFlags::SAMPLED
            | vk::ImageUsageFlags::TRANSFER_SRC
            | vk::ImageUsageFlags::TRANSFER_DST
    }

    pub(super) fn aspect(self) -> vk::ImageAspectFlags {
        if self.format() == vk::Format::D32_SFLOAT {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        }
    }
}

/// An image with one mip level, always in the layout GENERAL once it is `Recorder::initialize`d.
pub struct Image {
    gpu: Arc<Gpu>,
    pub name: String,
    pub kind: ImageKind,
    /// [texel]
    pub width: u32,
    /// [texel]
    pub height: u32,
    pub layers: u32,
    pub(super) raw: vk::Image,
    pub(super) view: vk::ImageView,
    /// Of each layer, where layers are drawn to.
    layer_views: Vec<vk::ImageView>,
    allocation: Option<Allocation>,
}

impl Buffer {
    /// A buffer on the device.
    pub fn new(gpu: &Arc<Gpu>, name: &str, bytes: u64) -> Result<Self> {
        Self::at(gpu, name, bytes, MemoryLocation::GpuOnly)
    }

    /// A buffer that the device can copy to and the host can read.
    pub fn readback(gpu: &Arc<Gpu>, name: &str, bytes: u64) -> Result<Self> {
        Self::at(gpu, name, bytes, MemoryLocation::GpuToCpu)
    }

    /// The raw buffer, for hosts that bind it themselves.
    pub fn raw(&self) -> vk::Buffer {
        self.raw
    }

    pub(super) fn at(
        gpu: &Arc<Gpu>,
        name: &str,
        bytes: u64,
        location: MemoryLocation,
    ) -> Result<Self> {
        // Vulkan knows no empty buffers, and shaders must bind something.
        let bytes = bytes.max(16);
        let info = vk::BufferCreateInfo::default().size(bytes).usage(
            vk::BufferUsageFlags::STORAGE_BUFFER
                | vk::BufferUsageFlags::INDIRECT_BUFFER
                | vk::BufferUsageFlags::INDEX_BUFFER
                | vk::BufferUsageFlags::UNIFORM_BUFFER
                | vk::BufferUsageFlags::TRANSFER_SRC
                | vk::BufferUsageFlags::TRANSFER_DST,
        );
        // SAFETY: `info` outlives the calls; the buffer is bound once, and destroyed by `Drop` from
        // here on.
        unsafe {
            let raw = gpu
                .device
                .create_buffer(&info, gpu.callbacks())
                .map_err(failed(&format!("vkCreateBuffer of {name}")))?;
            gpu.name(raw, name);
            let mut buffer = Self {
                gpu: gpu.clone(),
                name: name.into(),
                bytes,
                raw,
                allocation: None,
            };
            let requirements = gpu.device.get_buffer_memory_requirements(raw);
            let allocation = allocate(gpu, name, requirements, location, true)?;
            let (memory, offset) = (allocation.memory(), allocation.offset());
            buffer.allocation = Some(allocation);
            gpu.device
                .bind_buffer_memory(raw, memory, offset)
                .map_err(failed(&format!("vkBindBufferMemory of {name}")))?;
            Ok(buffer)
        }
    }

    pub(super) fn mapped_mut(&mut self) -> Result<&mut [u8]> {
        self.allocation
            .as_mut()
            .and_then(|allocation| allocation.mapped_slice_mut())
            .ok_or_else(|| Error::Memory {
                resource: self.name.clone(),
                message: "the memory cannot be mapped".into(),
            })
    }

    /// What a `readback` buffer holds, once the copy into it has finished.
    pub fn read<T: bytemuck::Pod>(&self, count: usize) -> Result<Vec<T>> {
        let bytes = count * size_of::<T>();
        let mapped = self
            .allocation
            .as_ref()
            .and_then(|allocation| allocation.mapped_slice());
        match mapped.and_then(|slice| slice.get(..bytes)) {
            Some(slice) => Ok(bytemuck::pod_collect_to_vec(slice)),
            None => Err(Error::Memory {
                resource: self.name.clone(),
                message: format!("{bytes} bytes of it cannot be mapped"),
            }),
        }
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        // SAFETY: destroyed once; whoever submitted work with it has waited for it.
        unsafe {
            self.gpu
                .device
                .destroy_buffer(self.raw, self.gpu.callbacks())
        };
        release(&self.gpu, self.allocation.take());
    }
}

impl Image {
    /// An image on the device, of undefined content; `layers` > 1 makes it an array.
    pub fn new(
        gpu: &Arc<Gpu>,
        name: &str,
        kind: ImageKind,
        size: (u32, u32),
        layers: u32,
    ) -> Result<Self> {
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(kind.format())
            .extent(vk::Extent3D {
                width: size.0,
                height: size.1,
                depth: 1,
            })
            .mip_levels(1)
            .array_layers(layers)
            .samples(kind.samples())
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(kind.usage());
        // SAFETY: `info` outlives the calls; the image is bound once, and destroyed by `Drop` from
        // here on.
        unsafe {
            let raw = gpu
                .device
                .create_image(&info, gpu.callbacks())
                .map_err(failed(&format!("vkCreateImage of {name}")))?;
            gpu.name(raw, name);
            let mut image = Self {
                gpu: gpu.clone(),
                name: name.into(),
                kind,
                width: size.0,
                height: size.1,
                layers,
                raw,
                view: vk::ImageView::null(),
                layer_views: Vec::new(),
                allocation: None,
            };
            let requirements = gpu.device.get_image_memory_requirements(raw);
            let allocation = allocate(gpu, name, requirements, MemoryLocation::GpuOnly, false)?;
            let (memory, offset) = (allocation.memory(), allocation.offset());
            image.allocation = Some(allocation);
            gpu.device
                .bind_image_memory(raw, memory, offset)
                .map_err(failed(&format!("vkBindImageMemory of {name}")))?;
            let form = match kind.is_array() {
                true => vk::ImageViewType::TYPE_2D_ARRAY,
                false => vk::ImageViewType::TYPE_2D,
            };
            image.view = image.create_view(form, image.range())?;
            if kind == ImageKind::Layers {
                for layer in 0..layers {
                    let range = image.range().base_array_layer(layer).layer_count(1);
                    let view = image.create_view(vk::ImageViewType::TYPE_2D, range)?;
                    image.layer_views.push(view);
                }
            }
            Ok(image)
        }
    }

    fn create_view(
        &self,
        form: vk::ImageViewType,
        range: vk::ImageSubresourceRange,
    ) -> Result<vk::ImageView> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(form)
            .format(self.kind.format())
            .subresource_range(range);
        // SAFETY: the image is alive and bound.
        unsafe {
            self.gpu
                .device
                .create_image_view(&info, self.gpu.callbacks())
        }
        .map_err(failed(&format!("vkCreateImageView of {}", self.name)))
    }

    pub(super) fn range(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange::default()
            .aspect_mask(self.kind.aspect())
            .level_count(1)
            .layer_count(self.layers)
    }

    /// As something to draw to; of an image whose layers are drawn to one at a time, a layer.
    pub fn target(&self, layer: u32) -> Target {
        Target {
            view: *self.layer_views.get(layer as usize).unwrap_or(&self.view),
            layout: vk::ImageLayout::GENERAL,
            size: (self.width, self.height),
        }
    }

    /// [byte] Of its texels.
    pub fn bytes(&self) -> u64 {
        u64::from(self.width)
            * u64::from(self.height)
            * u64::from(self.layers)
            * self.kind.texel_bytes()
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: destroyed once; whoever submitted work with it has waited for it.
        unsafe {
            let callbacks = self.gpu.callbacks();
            for &view in self.layer_views.iter().chain([&self.view]) {
                self.gpu.device.destroy_image_view(view, callbacks);
            }
            self.gpu.device.destroy_image(self.raw, callbacks);
        }
        release(&self.gpu, self.allocation.take());
    }
}

fn allocate(
    gpu: &Gpu,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
    linear: bool,
) -> Result<Allocation> {
    let lost = |message: String| Error::Memory {
        resource: name.to_owned(),
        message,
    };
    let mut allocator = gpu
        .allocator
        .lock()
        .map_err(|_| lost("the allocator is gone".into()))?;
    allocator
        .allocate(&AllocationCreateDesc {
            name,
            requirements,
            location,
            linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })
        .map_err(|error| match error {
            AllocationError::OutOfMemory => {
                let result = vk::Result::ERROR_OUT_OF_DEVICE_MEMORY;
                failed(&format!("vkAllocateMemory of {name}"))(result)
            }
            AllocationError::FailedToMap(_) => {
                let result = vk::Result::ERROR_MEMORY_MAP_FAILED;
                failed(&format!("vkMapMemory of {name}"))(result)
            }
            other => lost(other.to_string()),
        })
}

fn release(gpu: &Gpu, allocation: Option<Allocation>) {
    if let (Some(allocation), Ok(mut allocator)) = (allocation, gpu.allocator.lock()) {
        // An allocation that can't be freed is one that the allocator does not know: nothing to free.
        let _ = allocator.free(allocation);
    }
}
