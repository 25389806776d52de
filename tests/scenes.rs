//! The committed scenes are what the generator writes, and what glTF allows.

#[path = "../tools/make_scenes/mod.rs"]
mod make_scenes;

use std::path::PathBuf;

#[test]
fn committed_scenes_equal_the_generators() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenes");
    for file in make_scenes::files() {
        let committed = std::fs::read(folder.join(&file.name)).unwrap_or_default();
        assert!(
            committed == file.bytes,
            "scenes/{} is stale: run `cargo run --example make_scenes`",
            file.name
        );
    }
}

#[test]
fn every_scene_is_valid_and_has_a_shot() {
    let files = make_scenes::files();
    let shots: Vec<serde_json::Value> = files
        .iter()
        .filter(|file| file.name.ends_with(".json"))
        .map(|file| serde_json::from_slice(&file.bytes).expect("a shot file is JSON"))
        .collect();
    assert_eq!(shots.len(), 7);
    for shot in shots {
        let scene = files.iter().find(|file| shot["scene"] == *file.name);
        let scene = scene.unwrap_or_else(|| panic!("{} has no scene", shot["name"]));
        let gltf = gltf::Gltf::from_slice(&scene.bytes)
            .unwrap_or_else(|error| panic!("{}: {error}", scene.name));
        assert_eq!(gltf.cameras().count(), 1, "{}", scene.name);
        assert_eq!(shot["lights"].as_array().map(Vec::len), Some(1));
    }
}

#[test]
fn the_colonnade_is_instanced() {
    let files = make_scenes::files();
    let file = files.iter().find(|file| file.name == "colonnade.glb");
    let gltf = gltf::Gltf::from_slice(&file.expect("a colonnade").bytes).expect("valid glTF");
    let instances = gltf.nodes().filter(|node| node.mesh().is_some()).count();
    assert!(instances >= 60, "{instances} nodes with a mesh");
    assert!(gltf.meshes().count() <= 12);
}

#[test]
fn the_scenes_are_small() {
    let bytes: usize = make_scenes::files().iter().map(|f| f.bytes.len()).sum();
    assert!(bytes < 500_000, "{bytes} bytes");
}
