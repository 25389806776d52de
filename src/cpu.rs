//! What is computed on the CPU: ray-traced truth, and scalar twins of the algorithmic passes under the
//! names of their shaders.
//!
//! A twin decides in f32 what is an integer (a status, a cell, a list): such a decision can only be the
//! same when it is taken on the same values, so the twins of `depth`, `kernels` and `classify` mirror
//! their shaders' `precise` expressions operation by operation. What is summed up, the visibility, is
//! derived anew from the geometry in f64.

pub(crate) mod bvh;
pub mod classify;
pub mod contour;
pub mod depth;
pub mod irradiance;
pub mod kernels;
mod light;
pub mod mssm;
pub(crate) mod pinhole;
pub mod radial;
pub mod reference;
pub mod resolve;
mod texture;
