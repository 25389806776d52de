//! Vulkan, ignorant of shadows: a device, its memory, pipelines that bind by shader variable name,
//! and a recorder that labels, times and orders passes.

mod commands;
mod cost;
mod create;
mod device;
mod draw;
mod failed;
mod host;
mod host_device;
mod instance;
mod memory;
mod pass;
mod physical;
mod pipeline;
mod recorder;
mod requirements;
mod resources;
mod shader;
mod target;
mod upload;
mod validation;

pub use commands::{Commands, Groups};
pub use cost::Cost;
pub use device::{Gpu, Options};
pub use draw::{Attachments, Draw, MAX_COLORS, Rendering};
pub use host::{HostBuffer, HostImage, HostImageInfo, ImageState, Loan};
pub use host_device::{Enabled, HostDevice};
pub use memory::{Buffer, Image, ImageKind, SAMPLES};
pub use pass::{Bound, ComputePass, GraphicsPass, Sources};
pub use physical::{DeviceInfo, list_devices};
pub use pipeline::{Blend, GraphicsState};
pub use recorder::{Recorder, Timings};
pub use requirements::{FORMATS, Limits, QUEUE_FLAGS, lacking};
pub use resources::{Resource, Resources};
pub use shader::{Constants, is_constant, used};
pub use target::Target;
