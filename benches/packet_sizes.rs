//! Time of classification and traversal over packet sizes, resolutions, light sizes, mappings and leaf rules
//! ([Yang09 fig. 12, 13]): `cargo bench --bench packet_sizes`, or with a part of a name, `-- 512/light_1/4x4`.

mod gpu_time;

use criterion::{Criterion, criterion_group, criterion_main};
use gpu_time::{GpuTime, bench, criterion, open, renderer, shot};
use halfshade::scene::LightShape;
use halfshade::shot::Shot;
use halfshade::study::is_traversal;
use halfshade::technique::{Leaf, Mapping, Settings};

/// [pixel]
const PACKETS: [(u32, u32); 7] = [(1, 1), (2, 2), (3, 3), (4, 2), (4, 4), (8, 4), (8, 8)];
/// [pixel] Width and height of the image.
const SIZES: [u32; 2] = [256, 512];
/// Of the shot's own light.
const LIGHTS: [f64; 3] = [0.5, 1.0, 2.0];

/// One view with the kernels of the default settings, which have four times the split and the map.
fn settings(packet: (u32, u32), mapping: Mapping, leaf: Leaf) -> Settings {
    Settings {
        packet,
        mapping,
        leaf,
        split: 1,
        map: 256,
        ..Settings::default()
    }
}

fn scaled(mut shot: Shot, scale: f64) -> Shot {
    for light in &mut shot.lights {
        match &mut light.shape {
            LightShape::Rect { u, v } | LightShape::Polygon { u, v, .. } => {
                (*u, *v) = (*u * scale, *v * scale)
            }
            LightShape::Disc { radius, .. } | LightShape::Sphere { radius } => *radius *= scale,
            LightShape::Sun { angle_deg, .. } => *angle_deg *= scale,
        }
    }
    shot
}

/// Mappings and leaf rules; a packet of one pixel knows neither.
fn variants(packet: (u32, u32)) -> Vec<(Mapping, Leaf)> {
    if packet == (1, 1) {
        return vec![(Mapping::Serial, Leaf::PerPixel)];
    }
    let leaves = [Leaf::PerPixel, Leaf::Reprocess];
    Mapping::ALL
        .iter()
        .flat_map(|&mapping| leaves.map(|leaf| (mapping, leaf)))
        .collect()
}

fn packet_sizes(criterion: &mut Criterion<GpuTime>) {
    let gpu = open();
    let mut group = criterion.benchmark_group("packet_sizes");
    for size in SIZES {
        for scale in LIGHTS {
            let shot = scaled(shot("colonnade", size), scale);
            for packet in PACKETS {
                for (mapping, leaf) in variants(packet) {
                    let (width, height) = packet;
                    let id = format!("{size}/light_{scale}/{width}x{height}/{mapping}/{leaf}");
                    let make = || renderer(&gpu, &shot, settings(packet, mapping, leaf));
                    let bytes =
                        |renderer: &halfshade::render::Renderer| renderer.plan().memory_bytes();
                    bench(&mut group, &gpu, &id, bytes, is_traversal, make);
                }
            }
        }
    }
    group.finish();
}

criterion_group! { name = benches; config = criterion(); targets = packet_sizes }
criterion_main!(benches);
