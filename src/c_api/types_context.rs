//! The types and constants of `halfshade.h`: results, handles, contexts and devices.

use std::ffi::{c_char, c_void};

use super::structure::structures;

/// Version of the binary interface: a library with another one does not fit this header.
pub const HS_ABI_VERSION: u32 = 1;

/// How a call ended: HS_OK or why it failed.
pub type hs_result = i32;
/// Done.
pub const HS_OK: hs_result = 0;
/// An argument makes no sense: a NULL, a wrong type or size, a number out of range, a handle that is none.
pub const HS_INVALID_ARGUMENT: hs_result = 1;
/// The device, the system or this context cannot do it.
pub const HS_UNSUPPORTED: hs_result = 2;
/// No memory on the host.
pub const HS_OUT_OF_HOST_MEMORY: hs_result = 3;
/// No memory on the device.
pub const HS_OUT_OF_DEVICE_MEMORY: hs_result = 4;
/// The device is gone; from then on every call on this context and on what lives in it ends so.
pub const HS_DEVICE_LOST: hs_result = 5;
/// Something must be done first.
pub const HS_NOT_READY: hs_result = 6;
/// A file could not be read.
pub const HS_IO: hs_result = 7;
/// A file is not what it should be.
pub const HS_PARSE: hs_result = 8;
/// The driver failed, the validation layer objected, or the library has an error.
pub const HS_INTERNAL: hs_result = 9;

/// `type` of hs_context_info.
pub const HS_TYPE_CONTEXT_INFO: u32 = 1;
/// `type` of hs_device_info.
pub const HS_TYPE_DEVICE_INFO: u32 = 2;
/// `type` of hs_scene_info.
pub const HS_TYPE_SCENE_INFO: u32 = 3;
/// `type` of hs_material.
pub const HS_TYPE_MATERIAL: u32 = 4;
/// `type` of hs_texture.
pub const HS_TYPE_TEXTURE: u32 = 5;
/// `type` of hs_scene_counts.
pub const HS_TYPE_SCENE_COUNTS: u32 = 6;
/// `type` of hs_camera.
pub const HS_TYPE_CAMERA: u32 = 7;
/// `type` of hs_light.
pub const HS_TYPE_LIGHT: u32 = 8;
/// `type` of hs_settings.
pub const HS_TYPE_SETTINGS: u32 = 9;
/// `type` of hs_shot_counts.
pub const HS_TYPE_SHOT_COUNTS: u32 = 10;
/// `type` of hs_renderer_info.
pub const HS_TYPE_RENDERER_INFO: u32 = 11;
/// `type` of hs_statistics.
pub const HS_TYPE_STATISTICS: u32 = 12;
/// `type` of hs_pass.
pub const HS_TYPE_PASS: u32 = 13;
/// `type` of hs_reference_info.
pub const HS_TYPE_REFERENCE_INFO: u32 = 14;
/// hs_knob
pub const HS_TYPE_KNOB: u32 = 15;
/// hs_polygon
pub const HS_TYPE_POLYGON: u32 = 16;

/// Run under the Khronos validation layer with synchronization validation; see hs_context_validation_messages.
pub const HS_CONTEXT_VALIDATE: u32 = 1;
/// Open no device: for scenes, shots and hs_reference.
pub const HS_CONTEXT_WITHOUT_DEVICE: u32 = 2;

/// Severity of a log message: something a reader may want to know, such as what of a file is ignored.
pub const HS_LOG_NOTE: u32 = 0;
/// Severity of a log message: what the validation layer says.
pub const HS_LOG_WARNING: u32 = 1;
/// Severity of a log message: the sentence of a call that failed.
pub const HS_LOG_ERROR: u32 = 2;

/// A device and its objects' common ground. Opaque.
pub struct hs_context {
    _private: [u8; 0],
}
/// Triangles and their materials; never changes. Opaque.
pub struct hs_scene {
    _private: [u8; 0],
}
/// A scene with camera, lights, size and settings. Opaque.
pub struct hs_shot {
    _private: [u8; 0],
}
/// What renders a shot, with all memory and pipelines. Opaque.
pub struct hs_renderer {
    _private: [u8; 0],
}

/// Receives messages, on the thread of the call that caused them, before that call returns (the validation layer's
/// last words come when a context ends). `message` is UTF-8 and valid during the call only. It may call
/// hs_last_error and nothing else of this library, and must return.
pub type hs_log_callback =
    Option<unsafe extern "C" fn(severity: u32, message: *const c_char, user: *mut c_void)>;

/// How to create a context.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_context_info {
    /// HS_TYPE_CONTEXT_INFO
    pub r#type: u32,
    /// sizeof(hs_context_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// A part of the device's name, in any case, or its whole UUID in 32 hexadecimal digits. NULL: the best one,
    /// discrete before integrated before CPU.
    pub device: *const c_char,
    /// Folder that keeps compiled pipelines from one run to the next, created if absent. NULL: none are kept.
    pub cache_folder: *const c_char,
    /// HS_CONTEXT_..., combined by |.
    pub flags: u32,
    /// 0
    pub reserved: u32,
    /// Receives messages; NULL for none.
    pub log: hs_log_callback,
    /// Passed to `log`.
    pub log_user: *mut c_void,
    /// [byte] Frames that would take more of the device are refused; 0: those that take more than it has.
    pub max_memory: u64,
}

/// A Vulkan device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct hs_device_info {
    /// HS_TYPE_DEVICE_INFO
    pub r#type: u32,
    /// sizeof(hs_device_info)
    pub size: u32,
    /// NULL
    pub next: *const c_void,
    /// Name, as UTF-8 with a NUL at the end, as all texts here.
    pub name: [c_char; 256],
    /// "discrete", "integrated", "virtual", "cpu" or "other".
    pub kind: [c_char; 16],
    /// Name and version of the driver.
    pub driver: [c_char; 512],
    /// UUID in hexadecimal digits.
    pub uuid: [c_char; 40],
    /// What it lacks to run the library, separated by commas; empty when it can.
    pub missing: [c_char; 512],
    /// [invocation]
    pub subgroup_size: u32,
    /// 1 = it can run the library, 0 = it lacks something.
    pub usable: u32,
}

structures! {
    hs_context_info = HS_TYPE_CONTEXT_INFO,
    hs_device_info = HS_TYPE_DEVICE_INFO,
}
