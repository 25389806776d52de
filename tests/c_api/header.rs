//! The headers are those of the source, and compile on their own as strict C99 and C++17.

use std::fs;
use std::path::Path;
use std::process::Command;

use halfshade::technique::KNOBS;

use super::build::{Workshop, done, root};

/// The constants of all knobs that are choices, as Rust source: HS_LEAF_REPROCESS for `reprocess` of `leaf`.
fn choices() -> String {
    let mut text = String::new();
    for knob in KNOBS {
        for (number, (name, summary)) in knob.choices().iter().enumerate() {
            let constant = format!("HS_{}_{name}", knob.field)
                .to_uppercase()
                .replace('-', "_");
            let field = knob.field;
            text += &format!("/// `{field}`:{summary}\npub const {constant}: u32 = {number};\n");
        }
    }
    text
}

/// The header that cbindgen writes from files of `src/c_api`, and from the choices, a file as well.
fn generate(config: &str, sources: &[&str]) -> String {
    let workshop = Workshop::new();
    let generated = workshop.path("choices.rs");
    fs::write(&generated, choices()).expect("written");
    let config =
        cbindgen::Config::from_file(root().join(config)).expect("the configuration is fine");
    let mut builder = cbindgen::Builder::new().with_config(config);
    for source in sources {
        builder = builder.with_src(match *source {
            "choices.rs" => generated.clone(),
            source => root().join("src/c_api").join(source),
        });
    }
    let mut text = Vec::new();
    builder
        .generate()
        .expect("the source is what cbindgen understands")
        .write(&mut text);
    String::from_utf8(text).expect("UTF-8")
}

/// Compares a checked-in header with the generated one, or replaces it where `tools/headers.sh` says so.
fn compare(name: &str, generated: &str) {
    let path = root().join("include").join(name);
    if std::env::var_os("HALFSHADE_WRITE_HEADERS").is_some() {
        fs::write(&path, generated).expect("include can be written");
    }
    let kept = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        kept == generated,
        "include/{name} is stale; run tools/headers.sh"
    );
}

#[test]
fn the_header_is_that_of_the_source() {
    let sources = [
        "types_context.rs",
        "types_scene.rs",
        "choices.rs",
        "types_render.rs",
        "devices.rs",
        "call.rs",
        "contexts.rs",
        "scene.rs",
        "shot.rs",
        "renderer.rs",
        "reference.rs",
    ];
    compare("halfshade.h", &generate("cbindgen.toml", &sources));
}

#[test]
fn the_vulkan_header_is_that_of_the_source() {
    let sources = [
        "vulkan_types.rs",
        "vulkan_frame_types.rs",
        "vulkan_device.rs",
        "vulkan_effect.rs",
    ];
    compare(
        "halfshade_vulkan.h",
        &generate("cbindgen_vulkan.toml", &sources),
    );
}

/// Compiles a file that does nothing but include a header.
fn compile_alone(workshop: &Workshop, header: &str, compiler: &str, standard: &str) {
    let extension = if compiler == "cc" { "c" } else { "cpp" };
    let source = workshop.path(&format!("{header}.{extension}"));
    fs::write(
        &source,
        format!("#include \"{header}\"\nint unused_{extension};\n"),
    )
    .expect("written");
    let flags = [
        "-Wall",
        "-Wextra",
        "-Werror",
        "-pedantic",
        "-c",
        "-o",
        "/dev/null",
    ];
    done(
        Command::new(compiler)
            .arg(standard)
            .args(flags)
            .arg(format!("-I{}", root().join("include").display()))
            .arg(Path::new(&source)),
    );
}

#[test]
fn the_headers_compile_alone_as_c_and_as_cpp() {
    let workshop = Workshop::new();
    for entry in fs::read_dir(root().join("include")).expect("include is there") {
        let name = entry.expect("an entry").file_name();
        let name = name.to_str().expect("UTF-8");
        compile_alone(&workshop, name, "cc", "-std=c99");
        compile_alone(&workshop, name, "c++", "-std=c++17");
    }
}
