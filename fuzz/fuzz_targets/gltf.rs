//! glTF and GLB, as scene and as shot: `cargo +nightly fuzz run gltf`.
#![no_main]

#[path = "../../tests/support/sound.rs"]
mod sound;
#[path = "../../tests/support/mod.rs"]
mod support;

use std::path::Path;

use halfshade::scene::gltf::Limits;
use halfshade::shot::Overrides;
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use support::mutate::{self, Random};
use support::{Gltf, encode, lit_triangle, posed_triangles, textured_triangle};

fuzz_target!(|file: &[u8]| {
    let overrides = Overrides {
        radius: Some(0.5),
        limits: Limits {
            max_triangles: 10_000,
            max_texels: 1 << 16,
            ..Limits::default()
        },
        ..Overrides::default()
    };
    sound::check_gltf(Path::new("folder/mutant"), file, &overrides);
});

fuzz_mutator!(|data: &mut [u8], size: usize, room: usize, seed: u32| {
    let mut random = Random(u64::from(seed) << 1 | 1);
    // What can be taken apart is mutated by its structure, all else by its bytes.
    let parts = Gltf::from_glb(&data[..size]).filter(|_| random.below(4) > 0);
    let parts = parts.or_else(|| (size < 32).then(|| seed_file(&mut random)));
    let Some(parts) = parts else {
        return fuzzer_mutate(data, size, room);
    };
    let mutant = mutate::gltf(&mut random, &parts);
    if mutant.len() > room {
        return fuzzer_mutate(data, size, room);
    }
    data[..mutant.len()].copy_from_slice(&mutant);
    mutant.len()
});

/// A good file to start from.
fn seed_file(random: &mut Random) -> Gltf {
    let texels: Vec<_> = (0..64).map(|i| [i * 4, 255 - i, i, 255]).collect();
    match random.below(5) {
        0 => textured_triangle(&encode(8, 8, &texels, image::ImageFormat::Png)),
        1 => textured_triangle(&encode(8, 8, &texels, image::ImageFormat::Jpeg)),
        2 => textured_triangle(&encode(8, 8, &texels, image::ImageFormat::WebP)),
        3 => posed_triangles(),
        _ => lit_triangle(),
    }
}
