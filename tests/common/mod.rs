//! A device under validation, and what each view of a shot leaves behind on it.
#![allow(dead_code)] // Each test program uses a part of it.

use std::path::PathBuf;
use std::sync::Arc;

use glam::Vec3;
use halfshade::gpu::{Gpu, Options};
use halfshade::plan::{Outputs, ViewPlan};
use halfshade::render::{DEFAULT_COSTS, DEFAULT_EXPOSURE, RenderOptions, Renderer};
use halfshade::shared::{Counters, Fit, Kernel, Lists, Packet, Tile, Window};
use halfshade::shot::{Overrides, Shot};

/// [pixel] Width and height of every image.
pub const SIZE: u32 = 128;
/// [texel] Width and height of every shadow map.
pub const MAP: u32 = 256;

/// Runs `test` under the validation layer. Any message of it is a failure, the last ones included that come
/// when the device is destroyed.
pub fn with_device(test: impl FnOnce(&Arc<Gpu>)) {
    let options = Options {
        validate: true,
        ..Options::default()
    };
    let gpu = Gpu::open(&options).expect("a device and the validation layer");
    let messages = gpu.validation_messages();
    test(&gpu);
    assert_eq!(Arc::strong_count(&gpu), 1, "something still lives on it");
    drop(gpu);
    let messages = messages.lock().expect("nothing panicked");
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

/// A shot of `scenes/`, small.
pub fn shot(scene: &str) -> Shot {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let overrides = Overrides {
        size: Some((SIZE, SIZE)),
        ..Overrides::default()
    };
    let mut shot = Shot::load(&folder.join(format!("{scene}.json")), &overrides)
        .expect("the scenes can be loaded");
    shot.settings.map = MAP;
    // The passes of sub-lights, whatever stands before them.
    shot.settings.near_points = 0;
    shot.settings.counters = true;
    shot
}

pub fn renderer(gpu: &Arc<Gpu>, shot: &Shot) -> Renderer {
    let options = RenderOptions {
        outputs: Outputs { picture: false },
        costs: DEFAULT_COSTS,
        exposure: DEFAULT_EXPOSURE,
    };
    Renderer::new(gpu, shot, options).expect("the scenes can be rendered")
}

/// What the camera sees in a pixel.
#[derive(Clone, Copy)]
pub struct Point {
    pub position: Vec3,
    pub normal: Vec3,
}

/// The g-buffer, row by row; None where there is no surface.
pub fn points(renderer: &Renderer) -> Vec<Option<Point>> {
    let count = (4 * SIZE * SIZE) as usize;
    let read = |name| -> Vec<f32> { renderer.read_image(name, count).expect(name) };
    let (positions, normals) = (read("position_world"), read("normal_world"));
    let pixels = positions.chunks_exact(4).zip(normals.chunks_exact(4));
    pixels
        .map(|(position, normal)| {
            (position[3] > 0.0).then(|| Point {
                position: Vec3::from_slice(position),
                normal: Vec3::from_slice(normal),
            })
        })
        .collect()
}

/// What a view leaves behind.
pub struct Traces {
    pub planned: ViewPlan,
    pub fit: Fit,
    pub map: Vec<f32>,
    /// The image that holds all levels, row by row.
    pub hierarchy: Vec<[f32; 2]>,
    pub tiles: Vec<Tile>,
    pub kernels: Vec<Kernel>,
    /// Those of a grid of packets, or what local ones form in.
    pub packets: Vec<Packet>,
    pub windows: Vec<Window>,
    pub pixels: Vec<u32>,
    pub occlusion: Vec<f32>,
    /// Before and after it.
    pub counters: [Counters; 2],
}

/// Renders one view alone and reads what it leaves behind.
pub fn traces(renderer: &mut Renderer, view: u32) -> Traces {
    let before = renderer.counters().expect("counters");
    renderer.render_view(view).expect("a view can be rendered");
    let plan = renderer.plan();
    let planned = plan.views().nth(view as usize).expect("it is planned");
    let pixels = (SIZE * SIZE) as usize;
    let texels = (MAP * MAP) as usize;
    let lists: Vec<Lists> = renderer
        .read_buffer("lists", plan.views().count())
        .expect("lists");
    let lists = lists[view as usize];
    let local = plan.memory().any(|(name, _)| name == "windows");
    Traces {
        planned: planned.clone(),
        fit: renderer.fits().expect("fits")[view as usize],
        map: renderer
            .read_image_of_view("shadow_map", view, texels)
            .expect("shadow_map"),
        hierarchy: bounds(renderer, view),
        tiles: listed(renderer, "tiles", lists.tile_count),
        kernels: renderer.read_buffer("kernels", pixels).expect("kernels"),
        packets: if local {
            Vec::new()
        } else {
            listed(renderer, "packets", lists.packet_count)
        },
        windows: if local {
            listed(renderer, "windows", lists.packet_count)
        } else {
            Vec::new()
        },
        // On drivers that end loops local packets leave some over.
        pixels: listed(renderer, "pixels", lists.pixel_count),
        occlusion: renderer
            .read_buffer("occlusion", pixels)
            .expect("occlusion"),
        counters: [before, renderer.counters().expect("counters")],
    }
}

/// The hierarchy, in however many bits.
fn bounds(renderer: &Renderer, view: u32) -> Vec<[f32; 2]> {
    let plan = renderer.plan();
    let (width, height, layers) = plan.density.extent(plan.map, plan.levels);
    let count = (width * height * layers) as usize;
    // Zeros and normal numbers are all that is stored.
    let widened = |half: u16| match half {
        0 => 0.0,
        half => f32::from_bits((u32::from(half) << 13) + (112 << 23)),
    };
    match plan.bounds_bits {
        16 => {
            let halves: Vec<[u16; 2]> = read(renderer, view, count);
            halves.into_iter().map(|pair| pair.map(widened)).collect()
        }
        _ => read(renderer, view, count),
    }
}

/// `count` values of a view's hierarchy.
fn read<T: bytemuck::Pod>(renderer: &Renderer, view: u32, count: usize) -> Vec<T> {
    let read = renderer.read_image_of_view("hierarchy", view, count);
    read.expect("the hierarchy can be read")
}

fn listed<T: bytemuck::Pod>(renderer: &Renderer, name: &str, count: u32) -> Vec<T> {
    if count == 0 {
        return Vec::new();
    }
    renderer.read_buffer(name, count as usize).expect(name)
}
