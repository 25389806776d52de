//! What is drawn, and to what.

use ash::vk;

use super::memory::{Buffer, Image};
use super::pass::Pass;
use crate::shared::Push;

/// What to draw.
pub enum Draw<'a> {
    /// [vertex] Without vertex input.
    Vertices(u32),
    /// A VkDrawIndexedIndirectCommand at a byte offset, with the index buffer.
    Indexed {
        indices: &'a Buffer,
        command: (&'a Buffer, u64),
    },
}

/// What is drawn to. Colours are cleared to zero and depth to 0, the far end.
pub struct Attachments<'a> {
    pub colors: &'a [&'a Image],
    pub depth: &'a Image,
    /// [texel] Frame round the image that nothing is drawn to.
    pub margin: u32,
}

pub(super) fn begin_rendering(
    device: &ash::Device,
    commands: vk::CommandBuffer,
    attachments: &Attachments,
) {
    let attach = |image: &Image| {
        vk::RenderingAttachmentInfo::default()
            .image_view(image.view)
            .image_layout(vk::ImageLayout::GENERAL)
            .load_op(vk::AttachmentLoadOp::CLEAR)
            .store_op(vk::AttachmentStoreOp::STORE)
    };
    let colors: Vec<_> = attachments
        .colors
        .iter()
        .map(|image| attach(image))
        .collect();
    let depth = attach(attachments.depth);
    let (width, height) = (attachments.depth.width, attachments.depth.height);
    let margin = attachments.margin;
    let whole = vk::Rect2D {
        offset: vk::Offset2D::default(),
        extent: vk::Extent2D { width, height },
    };
    let inner = vk::Rect2D {
        offset: vk::Offset2D {
            x: margin as i32,
            y: margin as i32,
        },
        extent: vk::Extent2D {
            width: width.saturating_sub(2 * margin),
            height: height.saturating_sub(2 * margin),
        },
    };
    let viewport = vk::Viewport {
        x: 0.0,
        y: 0.0,
        width: width as f32,
        height: height as f32,
        min_depth: 0.0,
        max_depth: 1.0,
    };
    let info = vk::RenderingInfo::default()
        .render_area(whole)
        .layer_count(1)
        .color_attachments(&colors)
        .depth_attachment(&depth);
    // SAFETY: recording; the attachments are alive.
    unsafe {
        device.cmd_begin_rendering(commands, &info);
        device.cmd_set_viewport(commands, 0, &[viewport]);
        device.cmd_set_scissor(commands, 0, &[inner]);
    }
}

pub(super) fn record_draw(
    device: &ash::Device,
    commands: vk::CommandBuffer,
    pass: &Pass,
    push: Push,
    draw: &Draw,
) {
    let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
    // SAFETY: recording inside rendering; the pass and the buffers are alive until submission ends.
    unsafe {
        device.cmd_bind_pipeline(commands, vk::PipelineBindPoint::GRAPHICS, pass.pipeline);
        let sets = [pass.set];
        device.cmd_bind_descriptor_sets(
            commands,
            vk::PipelineBindPoint::GRAPHICS,
            pass.layout,
            0,
            &sets,
            &[],
        );
        device.cmd_push_constants(commands, pass.layout, stages, 0, bytemuck::bytes_of(&push));
        match draw {
            Draw::Vertices(count) => device.cmd_draw(commands, *count, 1, 0, 0),
            Draw::Indexed {
                indices,
                command: (buffer, offset),
            } => {
                device.cmd_bind_index_buffer(commands, indices.raw, 0, vk::IndexType::UINT32);
                device.cmd_draw_indexed_indirect(commands, buffer.raw, *offset, 1, 0);
            }
        }
    }
}
