//! Vulkan, ignorant of shadows: a device, its memory, pipelines that bind by shader variable name,
//! and a recorder that labels, times and orders passes.

mod device;
mod draw;
mod memory;
mod pass;
mod physical;
mod recorder;
mod requirements;
mod shader;
mod validation;

pub use device::{Gpu, Options};
pub use draw::{Attachments, Draw};
pub use memory::{Buffer, Image, ImageKind, Resource, Resources};
pub use pass::{ComputePass, GraphicsPass, GraphicsState, Specialization};
pub use physical::{DeviceInfo, list_devices};
pub use recorder::{Groups, Recorder, Timings};
pub use requirements::Limits;
