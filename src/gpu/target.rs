//! Where a draw goes.

use ash::vk;

/// An image that can be drawn to.
#[derive(Clone, Copy, Default)]
pub struct Target {
    pub(super) view: vk::ImageView,
    pub(super) layout: vk::ImageLayout,
    /// [texel] Width and height of the image, or of the part of it at its first texel that is drawn to.
    pub size: (u32, u32),
}
