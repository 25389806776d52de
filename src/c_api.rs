//! The C library: `include/halfshade.h` is generated from the standalone tier's files here, and
//! `include/halfshade_vulkan.h` from `vulkan_….rs`; a test fails when one is stale.
//!
//! Nothing that a caller passes is trusted: structures are checked before they are read (`check`), handles are
//! looked up and never followed (`handles`), and no panic leaves an export (`call`).

#![allow(non_camel_case_types)] // C's names.

mod call;
mod call_result;
mod check;
mod context;
mod contexts;
mod convert;
mod devices;
mod handles;
mod reference;
mod renderer;
mod scene;
mod shot;
mod structure;
pub mod types;
mod types_context;
mod types_render;
mod types_scene;
mod vulkan_device;
mod vulkan_effect;
mod vulkan_features;
mod vulkan_frame;
pub mod vulkan_frame_types;
mod vulkan_lend;
pub mod vulkan_names;
pub mod vulkan_types;
