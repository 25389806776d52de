//! Mutants of a good glTF: an error or a sound scene, never a panic.

mod support;

use std::path::Path;
use std::time::{Duration, Instant};

use halfshade::scene::gltf::{Limits, LoadOptions, parse};
use support::*;

/// Marsaglia's xorshift: the same mutants in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end as u64) as usize
    }

    fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }
}

/// Replaces a number or word of the JSON text, or bytes anywhere.
fn mutate(random: &mut Random, file: &[u8]) -> Vec<u8> {
    let mut mutant = file.to_vec();
    for _ in 0..=random.below(3) {
        let at = random.below(mutant.len());
        match random.below(4) {
            0 => mutant[at] ^= 1 << random.below(8),
            1 => mutant[at] = random.below(256) as u8,
            2 => {
                let end = mutant.len().min(at + 1 + random.below(8));
                mutant.drain(at..end);
            }
            _ => {
                let is_digit = |byte: &u8| byte.is_ascii_digit();
                let Some(skip) = mutant[at..].iter().position(is_digit) else {
                    continue;
                };
                let start = at + skip;
                let digits = mutant[start..]
                    .iter()
                    .take_while(|byte| is_digit(byte))
                    .count();
                let odd = [
                    "0",
                    "1",
                    "2",
                    "3",
                    "-1",
                    "5126",
                    "5121",
                    "255",
                    "4294967295",
                    "18446744073709551615",
                    "1e38",
                    "1e308",
                    "null",
                    "\"\"",
                    "[]",
                    "{}",
                ];
                mutant.splice(start..start + digits, random.pick(&odd).bytes());
            }
        }
        if mutant.is_empty() {
            break;
        }
    }
    mutant
}

#[test]
fn mutants_do_not_panic() {
    let texels: Vec<_> = (0..64).map(|i| [i * 4, 255 - i, i, 255]).collect();
    let formats = [image::ImageFormat::Png, image::ImageFormat::Jpeg];
    let seeds: Vec<_> = formats
        .iter()
        .map(|&format| textured_triangle(&encode(8, 8, &texels, format)))
        .flat_map(|gltf| [gltf.to_gltf(), gltf.to_glb()])
        .collect();
    let limits = Limits {
        max_triangles: 10_000,
        max_texels: 1 << 16,
        ..Limits::default()
    };
    let options = LoadOptions {
        limits,
        punctual_radius: Some(0.5),
        scene: None,
    };
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (start, mut loaded) = (Instant::now(), 0);
    for seed in &seeds {
        let scene = parse(Path::new("seed"), seed, &options).unwrap();
        assert_eq!(
            (
                scene.triangles.len(),
                scene.lights.len(),
                scene.cameras.len()
            ),
            (2, 2, 1)
        );
        for _ in 0..1500 {
            let mutant = mutate(&mut random, seed);
            let Ok(scene) = parse(Path::new("mutant"), &mutant, &options) else {
                continue;
            };
            loaded += 1;
            let vertices = scene.positions.len();
            assert!(scene.positions.iter().all(|position| position.is_finite()));
            assert!(
                scene
                    .triangles
                    .as_flattened()
                    .iter()
                    .all(|&i| (i as usize) < vertices)
            );
            assert!(scene.texcoords.is_empty() || scene.texcoords.len() == vertices);
        }
    }
    assert!(
        loaded > 100,
        "only {loaded} mutants got past the first checks"
    );
    assert!(
        start.elapsed() < Duration::from_secs(30),
        "{:?}",
        start.elapsed()
    );
}
