//! What is drawn, and to what.

use ash::vk;

use super::memory::Buffer;
use super::pass::Bound;
use super::target::Target;
use crate::shared::Push;

/// What to draw.
pub enum Draw<'a> {
    /// Without vertex input.
    Vertices {
        /// [vertex]
        count: u32,
        instances: u32,
    },
    /// A VkDrawIndexedIndirectCommand at a byte offset, with the index buffer.
    Indexed {
        indices: &'a Buffer,
        command: (&'a Buffer, u64),
    },
}

/// What is drawn to, all of the same size. Colours are cleared to zero and depth to 0, the far end.
pub struct Attachments<'a> {
    /// At most [`MAX_COLORS`].
    pub colors: &'a [Target],
    pub depth: Option<Target>,
    /// [texel] Frame round the image that nothing is drawn to.
    pub margin: u32,
}

/// Most colours that are drawn to at a time.
pub const MAX_COLORS: usize = 4;

fn attach(target: Target) -> vk::RenderingAttachmentInfo<'static> {
    vk::RenderingAttachmentInfo::default()
        .image_view(target.view)
        .image_layout(target.layout)
        .load_op(vk::AttachmentLoadOp::CLEAR)
        .store_op(vk::AttachmentStoreOp::STORE)
}

/// A pass that renders.
pub struct Rendering<'a> {
    pub(super) device: &'a ash::Device,
    pub(super) commands: vk::CommandBuffer,
}

impl Rendering<'_> {
    /// Draws with one or more pipelines into cleared attachments.
    pub fn draw<'p>(
        &self,
        attachments: &Attachments,
        push: Push,
        draws: impl IntoIterator<Item = (Bound<'p>, Draw<'p>)>,
    ) {
        self.render(attachments, || {
            for (bound, draw) in draws {
                record_draw(self.device, self.commands, bound, push, draw);
            }
        });
    }

    /// Lets the host draw into cleared attachments, with viewport and scissor set.
    pub fn draw_by_host(&self, attachments: &Attachments, draw: impl FnOnce()) {
        self.render(attachments, draw);
    }

    fn render(&self, attachments: &Attachments, draw: impl FnOnce()) {
        begin_rendering(self.device, self.commands, attachments);
        draw();
        // SAFETY: recording; rendering was begun above.
        unsafe { self.device.cmd_end_rendering(self.commands) };
    }
}

fn begin_rendering(device: &ash::Device, commands: vk::CommandBuffer, attachments: &Attachments) {
    let mut colors = [vk::RenderingAttachmentInfo::default(); MAX_COLORS];
    for (info, color) in colors.iter_mut().zip(attachments.colors) {
        *info = attach(*color);
    }
    let depth = attachments.depth.map(attach);
    let sizes = attachments.depth.iter().chain(attachments.colors);
    let (width, height) = sizes.map(|target| target.size).next().unwrap_or_default();
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
    let mut info = vk::RenderingInfo::default()
        .render_area(whole)
        .layer_count(1)
        .color_attachments(&colors[..attachments.colors.len().min(MAX_COLORS)]);
    if let Some(depth) = &depth {
        info = info.depth_attachment(depth);
    }
    // SAFETY: recording; the attachments are alive.
    unsafe {
        device.cmd_begin_rendering(commands, &info);
        device.cmd_set_viewport(commands, 0, &[viewport]);
        device.cmd_set_scissor(commands, 0, &[inner]);
    }
}

fn record_draw(
    device: &ash::Device,
    commands: vk::CommandBuffer,
    bound: Bound,
    push: Push,
    draw: Draw,
) {
    let stages = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
    bound.record(
        device,
        commands,
        vk::PipelineBindPoint::GRAPHICS,
        stages,
        push,
    );
    // SAFETY: recording inside rendering; the buffers are alive until submission ends.
    unsafe {
        match draw {
            Draw::Vertices { count, instances } => {
                device.cmd_draw(commands, count, instances, 0, 0);
            }
            Draw::Indexed {
                indices,
                command: (buffer, offset),
            } => {
                device.cmd_bind_index_buffer(commands, indices.raw, 0, vk::IndexType::UINT32);
                device.cmd_draw_indexed_indirect(commands, buffer.raw, offset, 1, 0);
            }
        }
    }
}
