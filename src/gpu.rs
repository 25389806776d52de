//! Vulkan, ignorant of shadows: a device, its memory, pipelines that bind by shader variable name,
//! and a recorder that labels, times and orders passes.

mod commands;
mod create;
mod device;
mod draw;
mod host;
mod memory;
mod pass;
mod physical;
mod pipeline;
mod recorder;
mod requirements;
mod resources;
mod shader;
mod validation;

pub use commands::{Commands, Groups};
pub use device::{Gpu, Options};
pub use draw::{Attachments, Draw, MAX_COLORS, Target};
pub use host::{Enabled, HostBuffer, HostDevice, HostImage, HostImageInfo, ImageState, Loan};
pub use memory::{Buffer, Image, ImageKind};
pub use pass::{Bound, ComputePass, GraphicsPass, Sources};
pub use physical::{DeviceInfo, list_devices};
pub use pipeline::GraphicsState;
pub use recorder::{Recorder, Timings};
pub use requirements::{FORMATS, Limits, QUEUE_FLAGS, lacking};
pub use resources::{Resource, Resources};
pub use shader::{Constants, is_constant, used};
