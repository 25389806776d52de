//! Images and buffers that a host lends to a pass.

use std::sync::Arc;

use ash::vk;

use super::device::Gpu;
use super::failed::failed;
use super::target::Target;
use crate::error::{Error, Result};

/// How an image is found or left.
#[derive(Debug, Clone, Copy)]
pub struct ImageState {
    pub layout: vk::ImageLayout,
    pub stage: vk::PipelineStageFlags2,
    pub access: vk::AccessFlags2,
}

/// What a host's image is lent for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Loan {
    /// Read by passes.
    Sampled,
    /// Drawn to; what it held is lost.
    Drawn,
}

/// A host's image, one layer and one level of it.
#[derive(Debug, Clone, Copy)]
pub struct HostImageInfo {
    pub raw: vk::Image,
    pub format: vk::Format,
    /// [texel] Of the level.
    pub size: (u32, u32),
    pub layer: u32,
    pub level: u32,
    pub found: ImageState,
    pub left: ImageState,
}

/// A host's image with a view of it.
pub struct HostImage {
    gpu: Arc<Gpu>,
    info: HostImageInfo,
    loan: Loan,
    pub(super) view: vk::ImageView,
}

/// The aspects of a format: of what is read, and of what changes layout.
fn aspects(format: vk::Format) -> (vk::ImageAspectFlags, vk::ImageAspectFlags) {
    let (color, depth) = (vk::ImageAspectFlags::COLOR, vk::ImageAspectFlags::DEPTH);
    match format {
        vk::Format::D16_UNORM | vk::Format::D32_SFLOAT | vk::Format::X8_D24_UNORM_PACK32 => {
            (depth, depth)
        }
        vk::Format::D16_UNORM_S8_UINT
        | vk::Format::D24_UNORM_S8_UINT
        | vk::Format::D32_SFLOAT_S8_UINT => (depth, depth | vk::ImageAspectFlags::STENCIL),
        _ => (color, color),
    }
}

impl HostImage {
    /// # Errors
    /// The device cannot use the format so, or the view cannot be had.
    ///
    /// # Safety
    /// The image is of this device, as described, and outlives this and all work that was recorded with it.
    pub unsafe fn new(gpu: &Arc<Gpu>, name: &str, info: HostImageInfo, loan: Loan) -> Result<Self> {
        let needed = match loan {
            Loan::Sampled => vk::FormatFeatureFlags::SAMPLED_IMAGE,
            Loan::Drawn => vk::FormatFeatureFlags::COLOR_ATTACHMENT,
        };
        if !gpu.format_features(info.format).contains(needed) {
            return Err(Error::Unsupported(format!(
                "{name}: the device cannot use the format {:?} as {needed:?}",
                info.format
            )));
        }
        let range = vk::ImageSubresourceRange {
            aspect_mask: aspects(info.format).0,
            base_mip_level: info.level,
            level_count: 1,
            base_array_layer: info.layer,
            layer_count: 1,
        };
        let create = vk::ImageViewCreateInfo::default()
            .image(info.raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(info.format)
            .subresource_range(range);
        // SAFETY: the caller's promise.
        let view = unsafe { gpu.device.create_image_view(&create, gpu.callbacks()) }
            .map_err(failed(&format!("vkCreateImageView of {name}")))?;
        gpu.name(view, name);
        Ok(Self {
            gpu: gpu.clone(),
            info,
            loan,
            view,
        })
    }

    /// How it is while it is lent.
    fn lent(&self) -> ImageState {
        match self.loan {
            Loan::Sampled => ImageState {
                layout: Self::SAMPLED,
                stage: vk::PipelineStageFlags2::ALL_COMMANDS,
                access: vk::AccessFlags2::SHADER_SAMPLED_READ,
            },
            Loan::Drawn => ImageState {
                layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
                stage: vk::PipelineStageFlags2::COLOR_ATTACHMENT_OUTPUT,
                access: vk::AccessFlags2::COLOR_ATTACHMENT_WRITE,
            },
        }
    }

    /// The layout of images that are read, whatever their aspects.
    pub(super) const SAMPLED: vk::ImageLayout = vk::ImageLayout::READ_ONLY_OPTIMAL;

    pub(super) fn acquisition(&self) -> vk::ImageMemoryBarrier2<'static> {
        let mut found = self.info.found;
        if self.loan == Loan::Drawn {
            found.layout = vk::ImageLayout::UNDEFINED;
        }
        self.barrier(found, self.lent())
    }

    pub(super) fn release(&self) -> vk::ImageMemoryBarrier2<'static> {
        self.barrier(self.lent(), self.info.left)
    }

    fn barrier(&self, from: ImageState, to: ImageState) -> vk::ImageMemoryBarrier2<'static> {
        vk::ImageMemoryBarrier2::default()
            .src_stage_mask(from.stage)
            .src_access_mask(from.access)
            .dst_stage_mask(to.stage)
            .dst_access_mask(to.access)
            .old_layout(from.layout)
            .new_layout(to.layout)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(self.info.raw)
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: aspects(self.info.format).1,
                base_mip_level: self.info.level,
                level_count: 1,
                base_array_layer: self.info.layer,
                layer_count: 1,
            })
    }

    /// As something to draw to.
    pub fn target(&self) -> Target {
        Target {
            view: self.view,
            layout: self.lent().layout,
            size: self.info.size,
        }
    }

    pub fn format(&self) -> vk::Format {
        self.info.format
    }

    /// [texel]
    pub fn size(&self) -> (u32, u32) {
        self.info.size
    }
}

impl Drop for HostImage {
    fn drop(&mut self) {
        // SAFETY: destroyed once; the host says when what was recorded with it has finished.
        unsafe {
            self.gpu
                .device
                .destroy_image_view(self.view, self.gpu.callbacks())
        };
    }
}

/// A part of a host's buffer, which passes read as storage.
#[derive(Debug, Clone, Copy)]
pub struct HostBuffer {
    pub(super) raw: vk::Buffer,
    /// [byte] A multiple of the device's alignment of storage buffers.
    pub(super) offset: u64,
    /// [byte]
    pub(super) range: u64,
}

impl HostBuffer {
    /// The part of a buffer that holds `bytes` from `offset` on, and where in that part they begin [byte].
    ///
    /// # Errors
    /// It is more than a shader can see.
    ///
    /// # Safety
    /// The buffer is of this device, holds these bytes, was created as a storage buffer, and outlives all work that
    /// is recorded with it.
    pub unsafe fn new(
        gpu: &Gpu,
        name: &str,
        raw: vk::Buffer,
        offset: u64,
        bytes: u64,
    ) -> Result<(Self, u64)> {
        let start = offset - offset % gpu.limits.storage_alignment;
        let range = (offset - start) + bytes;
        if range > gpu.limits.buffer_bytes {
            return Err(Error::Unsupported(format!(
                "{name} takes {range} bytes and a shader can see {}; split the mesh",
                gpu.limits.buffer_bytes
            )));
        }
        let part = Self {
            raw,
            offset: start,
            range,
        };
        Ok((part, offset - start))
    }
}
