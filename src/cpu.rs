//! What is computed on the CPU: ray-traced truth.

mod bvh;
mod light;
mod pinhole;
pub mod reference;
mod texture;
