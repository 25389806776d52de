//! Vulkan, ignorant of shadows: a device, its memory, pipelines that bind by shader variable name,
//! and a recorder that labels, times and orders passes.

mod device;
mod memory;
mod pass;
mod recorder;
mod requirements;
mod shader;
mod validation;

pub use device::{DeviceInfo, Gpu, Options, list_devices};
pub use memory::{Buffer, Image, ImageKind, Resource, Resources};
pub use pass::{ComputePass, GraphicsPass, GraphicsState, Specialization};
pub use recorder::{Attachments, Draw, Groups, Recorder, Timings};
pub use requirements::Limits;
