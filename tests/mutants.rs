//! Mutants of good files: an error of one sentence or a sound scene, soon, and without taking more memory than
//! the file is worth. `HALFSHADE_SLOW=1` tries 80,000 instead of some thousand.

mod support;

#[path = "support/compressed.rs"]
mod compressed;
#[path = "support/heap.rs"]
mod heap;
#[path = "support/slow.rs"]
mod slow;
#[path = "support/sound.rs"]
mod sound;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use compressed::{Meshopt, draco};
use halfshade::scene::gltf::Limits;
use halfshade::shot::Overrides;
use serde_json::{Value, json};
use support::mutate::{self, Random};
use support::*;

#[global_allocator]
static HEAP: heap::Counting = heap::Counting;

/// [mutant] Of each seed.
fn mutants() -> u32 {
    slow::cases(1500, 10_000)
}

/// A mutant is read in a few hundred microseconds, the largest image that the limits let through in some ten
/// milliseconds.
const LONGEST: Duration = Duration::from_secs(2);

/// [byte] What the decoder of an image may take beside the image, which is some MiB with these limits; JSON
/// becomes at most some hundred times larger: an empty node of three characters takes 250 bytes.
const MOST_BYTES: usize = 16 << 20;
const BYTES_PER_BYTE: usize = 400;

fn overrides() -> Overrides {
    Overrides {
        radius: Some(0.5),
        limits: Limits {
            max_triangles: 10_000,
            max_texels: 1 << 16,
            ..Limits::default()
        },
        ..Overrides::default()
    }
}

/// Reads mutants of one seed. They must be of both kinds, so that neither check is idle.
fn check(
    name: &str,
    seed: u64,
    mutant: impl Fn(&mut Random) -> Vec<u8>,
    read: impl Fn(&[u8]) -> bool,
) {
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ seed);
    let (mut accepted, mut refused) = (0, 0);
    for index in 0..mutants() {
        let file = mutant(&mut random);
        let run = || {
            let start = Instant::now();
            let (result, bytes) = heap::peak_of(|| catch_unwind(AssertUnwindSafe(|| read(&file))));
            let result = result.unwrap_or_else(|_| {
                panic!(
                    "mutant {index} of {name}: {}",
                    String::from_utf8_lossy(&file)
                )
            });
            (result, bytes, start.elapsed())
        };
        let (result, bytes, took) = run();
        // A busy machine may stall once.
        assert!(
            took < LONGEST || run().2 < LONGEST,
            "mutant {index} of {name} takes {took:?}"
        );
        assert!(
            bytes < MOST_BYTES + BYTES_PER_BYTE * file.len(),
            "mutant {index} of {name}, {} bytes, takes {bytes} bytes",
            file.len()
        );
        match result {
            true => accepted += 1,
            false => refused += 1,
        }
    }
    println!("{name}: {accepted} accepted, {refused} refused");
    assert!(
        accepted > 30 && refused > 30,
        "{name}: {accepted} accepted, {refused} refused"
    );
}

/// The newer stream, with positions that are filtered.
fn filtered() -> Gltf {
    let kind = Meshopt {
        extension: "KHR_meshopt_compression",
        versions: [1, 0],
        indices: "INDICES",
        exponential: Some(12),
    };
    kind.compress()
}

fn texels() -> Vec<[u8; 4]> {
    (0..64).map(|i| [i * 4, 255 - i, i, 255]).collect()
}

#[test]
fn mutants_of_gltf() {
    let seeds = [
        (
            "a PNG",
            textured_triangle(&encode(8, 8, &texels(), image::ImageFormat::Png)),
        ),
        (
            "a JPEG",
            textured_triangle(&encode(8, 8, &texels(), image::ImageFormat::Jpeg)),
        ),
        (
            "a WebP",
            textured_triangle(&encode(8, 8, &texels(), image::ImageFormat::WebP)),
        ),
        ("a light and a camera", lit_triangle()),
        ("skins, targets and instances", posed_triangles()),
        ("meshopt", Meshopt::USUAL.compress()),
        ("filtered meshopt", filtered()),
        ("Draco", draco(7)),
        ("Draco in sequence", draco(0)),
    ];
    let path = Path::new("folder/mutant");
    for (index, (name, seed)) in seeds.iter().enumerate() {
        for file in [seed.to_gltf(), seed.to_glb()] {
            assert!(
                sound::check_gltf(path, &file, &overrides()),
                "{name} is refused"
            );
        }
        let read = |file: &[u8]| sound::check_gltf(path, file, &overrides());
        check(
            name,
            index as u64,
            |random| mutate::gltf(random, seed),
            read,
        );
    }
}

/// A glTF with a buffer in a file of its own.
#[test]
fn mutants_of_gltf_with_files() {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes/plate.gltf");
    let seed: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    let mutant = |random: &mut Random| {
        let mut tree = seed.clone();
        mutate::json(random, &mut tree);
        tree.to_string().into_bytes()
    };
    let read = |file: &[u8]| sound::check_gltf(&path, file, &overrides());
    check("plate.gltf", 7, mutant, read);
}

#[test]
fn mutants_of_shots() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.glb"), Gltf::triangle().to_glb()).unwrap();
    let path = folder.path().join("shot.json");
    let seeds = [
        json!({
            "scene": "scene.glb",
            "camera": {"eye": [0, 1, 5], "target": [0, 0, 0], "up": [0, 1, 0], "vfov_deg": 62, "width": 320, "height": 200},
            "lights": [
                {"type": "rect", "center": [0, 5.9, 0], "u": [3.2, 0, 0], "v": [0, 0, 0.9], "color": [1, 0.5, 0.25]},
                {"type": "disc", "center": [0, 3, 0], "normal": [0, -2, 0], "radius": 0.5, "intensity": 2},
            ],
        }),
        json!({
            "scene": "scene.glb",
            "camera": {"eye": [0, 1, 5], "target": [0, 0, 0], "vfov_deg": 62},
            "light": {"type": "disc", "center": [0, 3, 1], "radius": 0},
        }),
    ];
    for (index, seed) in seeds.iter().enumerate() {
        let mutant = |random: &mut Random| {
            let mut tree = seed.clone();
            mutate::json(random, &mut tree);
            let mut file = tree.to_string().into_bytes();
            if random.below(8) == 0 {
                mutate::bytes(random, &mut file);
            }
            file
        };
        let read = |file: &[u8]| sound::check_shot(&path, file, &overrides());
        assert!(read(seed.to_string().as_bytes()));
        check(&format!("shot {index}"), 100 + index as u64, mutant, read);
    }
}
