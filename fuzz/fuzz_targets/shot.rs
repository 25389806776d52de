//! Shot files over one good scene: `cargo +nightly fuzz run shot`.
#![no_main]

#[path = "../../tests/support/sound.rs"]
mod sound;
#[path = "../../tests/support/mod.rs"]
mod support;

use std::path::PathBuf;
use std::sync::LazyLock;

use halfshade::shot::Overrides;
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};
use serde_json::Value;
use support::Gltf;
use support::mutate::{self, Random};

/// A folder with a scene of one triangle.
static FOLDER: LazyLock<PathBuf> = LazyLock::new(|| {
    let folder = std::env::temp_dir().join(format!("halfshade-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("the temporary folder can be written");
    let scene = Gltf::triangle().to_glb();
    std::fs::write(folder.join("scene.glb"), scene).expect("the temporary folder can be written");
    folder
});

const SEED: &str = r#"{"scene": "scene.glb",
    "camera": {"eye": [0, 1, 5], "target": [0, 0, 0], "up": [0, 1, 0], "vfov_deg": 62, "width": 32, "height": 20},
    "lights": [{"type": "rect", "center": [0, 5.9, 0], "u": [3.2, 0, 0], "v": [0, 0, 0.9], "color": [1, 0.5, 0.25]},
               {"type": "disc", "center": [0, 3, 0], "normal": [0, -2, 0], "radius": 0.5, "intensity": 2}]}"#;

fuzz_target!(|file: &[u8]| {
    sound::check_shot(&FOLDER.join("shot.json"), file, &Overrides::default());
});

fuzz_mutator!(|data: &mut [u8], size: usize, room: usize, seed: u32| {
    let mut random = Random(u64::from(seed) << 1 | 1);
    let file = if size < 16 {
        SEED.as_bytes()
    } else {
        &data[..size]
    };
    let tree = serde_json::from_slice::<Value>(file).ok();
    let Some(mut tree) = tree.filter(|_| random.below(4) > 0) else {
        return fuzzer_mutate(data, size, room);
    };
    mutate::json(&mut random, &mut tree);
    let mutant = tree.to_string();
    if mutant.len() > room {
        return fuzzer_mutate(data, size, room);
    }
    data[..mutant.len()].copy_from_slice(mutant.as_bytes());
    mutant.len()
});
