//! Writes the project's own scenes: `cargo run --example make_scenes -- [OUT_DIR]` (default `scenes/`).
//!
//! The files are committed; `tests/scenes.rs` fails when they no longer equal what this writes.

#[path = "make_scenes/mod.rs"]
mod make_scenes;

use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| "scenes".into()));
    std::fs::create_dir_all(&folder)?;
    for file in make_scenes::files() {
        let path = folder.join(&file.name);
        std::fs::write(&path, &file.bytes)?;
        println!("{:>7} bytes  {}", file.bytes.len(), path.display());
    }
    Ok(())
}
