//! What must hold for any scene: the ends of the range are exact, small moves have small effects, and
//! neither the frame of reference, nor the device's order of work, nor an earlier frame shows.

#[path = "../support/closed_form.rs"]
mod closed_form;
#[path = "../support/gpu.rs"]
mod support;

mod bias;
mod closed;
mod ends;
mod frames;
mod generated;
mod near;
mod similarity;
mod tilted;
mod world;

use std::sync::Arc;

use closed_form::{Occluder, rectangle_visibility};
use glam::{DQuat, DVec2, DVec3, Vec3};
use halfshade::gpu::Gpu;
use halfshade::plan::{Lighting, Outputs, Plan, plan};
use halfshade::scene::{AreaLight, LightShape, Scene};
use halfshade::shot::Shot;
use halfshade::technique::{Evaluate, Hierarchy, Settings, Technique};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use support::{
    Image, SCENES, Triangles, camera, disc_light, load, positions, raster_grid, rectangle,
    rectangle_light, render, renderer, same_bits, shot, visibility, with_gpu,
};

const LIGHT: DVec3 = DVec3::new(0.1, 3.0, -0.05);
const HALF: DVec2 = DVec2::new(0.5, 0.4);

fn settings(map: u32, split: u32) -> Settings {
    Settings {
        map,
        split,
        // Contours are what is looked at, whatever stands before the light.
        near_points: 0,
        ..Settings::default()
    }
}

/// [scene units] The largest texel of any view at a height below a light that shines down.
fn texel(image: &Image, light: DVec3, height: f64) -> f64 {
    let focal = image.fits.iter().flat_map(|fit| fit.focal);
    let least = focal
        .filter(|&focal| focal > 0.0)
        .fold(f32::INFINITY, f32::min);
    (light.y - height) / f64::from(least)
}

fn planned(gpu: &Gpu, shot: &Shot) -> Plan {
    plan(shot, Outputs { picture: false }, &gpu.limits).expect("a plan")
}
