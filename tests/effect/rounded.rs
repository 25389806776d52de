//! Surfaces in formats that round positions off: what the light sees stays lit, whatever its tilt, and shadows stay where they are.

use std::sync::Arc;

use ash::vk;
use glam::{DMat4, DVec2, DVec3, DVec4};
use halfshade::frame::Surface;
use halfshade::gpu::Gpu;
use halfshade::render::SlotImages;
use halfshade::scene::LightShape;
use halfshade::technique::{Settings, Technique};

use super::host::Host;
use super::kinds::{clip_from_positions, frame_of};
use super::{PIXELS, SIDE, Stage, settings};

/// [scene units] The far plane.
const FAR: f64 = 1e4;

/// [visibility] What an engine would not see.
const UNSEEN: f32 = 0.05;

/// A surface image, with what is needed to read it.
struct Lent {
    name: &'static str,
    surface: Surface,
    format: vk::Format,
    texels: Vec<u8>,
    world_from_clip: DMat4,
    empty: f32,
}

/// The nearest 16-bit float; nothing here overflows.
fn half(value: f32) -> u16 {
    let (sign, magnitude) = ((value.to_bits() >> 16) as u16 & 0x8000, value.abs());
    let bits = match magnitude < 1.0 / 16384.0 {
        true => (magnitude * 16_777_216.0).round_ties_even() as u32,
        false => {
            let bits = magnitude.to_bits();
            let rounded = bits + 0xfff + (bits >> 13 & 1);
            (rounded >> 13) - (112 << 10)
        }
    };
    sign | bits as u16
}

/// Depths with standard Z, each through `stored`, which says what the format keeps of them.
fn depths<T: bytemuck::NoUninit>(
    stage: &Stage,
    (name, format): (&'static str, vk::Format),
    near: f64,
    stored: impl Fn(f64) -> T,
) -> Lent {
    let clip = clip_from_positions(stage, |along| {
        (along * FAR - DVec4::W * (FAR * near)) / (FAR - near)
    });
    let world_from_clip = clip.inverse();
    let depth = |(index, position): (usize, &[f32; 4])| {
        if position[3] == 0.0 {
            return stored(1.0);
        }
        // On the ray through the pixel's centre, where depths are read.
        let side = SIDE as usize;
        let pixel = DVec2::new((index % side) as f64, (index / side) as f64);
        let window = 2.0 * (pixel + 0.5) / f64::from(SIDE) - 1.0;
        let from = world_from_clip.project_point3(window.extend(0.0));
        let way = world_from_clip.project_point3(window.extend(1.0)) - from;
        let normal = DVec3::from_slice(&stage.normals[index].map(f64::from));
        let point = DVec4::from_array(position.map(f64::from)).truncate();
        let along = (point - from).dot(normal) / way.dot(normal);
        stored(clip.project_point3(from + along * way).z)
    };
    let texels: Vec<T> = stage.positions.iter().enumerate().map(depth).collect();
    Lent {
        name,
        surface: Surface::Depths,
        format,
        texels: bytemuck::cast_slice(&texels).to_vec(),
        world_from_clip,
        empty: 1.0,
    }
}

fn all(stage: &Stage) -> Vec<Lent> {
    let halves: Vec<u16> = stage
        .positions
        .as_flattened()
        .iter()
        .map(|&x| half(x))
        .collect();
    vec![
        Lent {
            name: "RGBA16F",
            surface: Surface::Positions,
            format: vk::Format::R16G16B16A16_SFLOAT,
            texels: bytemuck::cast_slice(&halves).to_vec(),
            world_from_clip: DMat4::IDENTITY,
            empty: 0.0,
        },
        depths(
            stage,
            ("D32, near 0.01", vk::Format::D32_SFLOAT),
            0.01,
            |z| z as f32,
        ),
        depths(stage, ("D32, near 0.1", vk::Format::D32_SFLOAT), 0.1, |z| {
            z as f32
        }),
        depths(
            stage,
            ("D24 as the texels of R32, near 0.1", vk::Format::R32_SFLOAT),
            0.1,
            |z| ((z * 16_777_215.0).round() / 16_777_215.0) as f32,
        ),
        depths(stage, ("D16, near 0.1", vk::Format::D16_UNORM), 0.1, |z| {
            (z * 65535.0).round() as u16
        }),
    ]
}

/// The lowest of a pixel and its neighbours.
fn lowest_around(image: &[f32], index: usize) -> f32 {
    let side = SIDE as i32;
    let (x, y) = (index as i32 % side, index as i32 / side);
    let around = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy)));
    let inside = around.filter(|&(x, y)| (0..side).contains(&x) && (0..side).contains(&y));
    inside
        .map(|(x, y)| image[(y * side + x) as usize])
        .fold(f32::INFINITY, f32::min)
}

/// Under a light that is tilted against the ground.
fn check_tilt(host: &mut Host, device: &Arc<Gpu>, technique: Technique, degrees: f64) {
    let own = Settings {
        technique,
        ..settings(1)
    };
    let stage = Stage::new(device, own, |light| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        light.shape = LightShape::Disc {
            normal: DVec3::new(sin, -cos, 0.0),
            radius: 0.4,
        };
    });
    let slot = stage.slot(host, Vec::new());
    let exact = frame_of(host, &stage, Surface::Positions, &slot, |_| {});
    for lent in all(&stage) {
        let slot = SlotImages {
            surface: host.image(lent.format, (SIDE, SIDE), &lent.texels),
            ..stage.slot(host, Vec::new())
        };
        let found = frame_of(host, &stage, lent.surface, &slot, |frame| {
            frame.world_from_clip = lent.world_from_clip.as_mat4().to_cols_array_2d();
            frame.depth_empty = lent.empty;
        });
        let mut lit = 0;
        for (index, &value) in found.iter().enumerate() {
            if lowest_around(&exact, index) > 0.999 {
                lit += 1;
                assert!(
                    value > 1.0 - UNSEEN,
                    "{}, {technique}, {degrees}°: pixel {index} is at {value}",
                    lent.name
                );
            }
        }
        assert!(
            lit > PIXELS / 20,
            "{technique}, {degrees}°: {lit} lit pixels"
        );
        // Shadows stay: not all that was hidden is lit.
        let hidden = |image: &[f32]| image.iter().filter(|&&value| value < 0.5).count();
        assert!(
            2 * hidden(&found) > hidden(&exact),
            "{}, {technique}, {degrees}°: {} of {} pixels are in shadow",
            lent.name,
            hidden(&found),
            hidden(&exact)
        );
    }
}

pub fn check(host: &mut Host, device: &Arc<Gpu>) {
    for degrees in [0.0, 20.0, 45.0, 70.0, 85.0] {
        check_tilt(host, device, Technique::PacketContour, degrees);
    }
    for technique in [
        Technique::Micropatch,
        Technique::Bitmask,
        Technique::Pcss,
        Technique::Hard,
        Technique::ReferenceMaps,
    ] {
        check_tilt(host, device, technique, 0.0);
    }
}
