//! Scalar twins of the passes, one for each stage and named like its shader or the library of shaders that it mirrors.
//!
//! A twin decides in f32 what is an integer (a status, a cell, a list): such a decision can only be the same when it is taken
//! on the same values, so `receiver`, `kernels` and `classify` mirror their shaders' `precise` expressions operation by
//! operation. What is summed up, the visibility, is derived anew from the geometry in f64.

pub mod beam;
pub mod classify;
pub mod contour;
pub mod facing;
pub mod hierarchy;
pub mod irradiance;
pub mod join;
pub mod kernels;
pub mod microrect;
pub mod outline;
pub mod polygon_irradiance;
pub mod quality;
pub mod radial;
pub mod receiver;
pub mod resolve;
pub mod shadow_width;
pub mod soft_shadow_map;
pub mod tile;
