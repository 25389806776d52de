//! What the shared library exports, and by which name programs ask for it.

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use super::build::{built, done, root};

/// Every function that the headers declare.
fn declared() -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for header in ["halfshade.h", "halfshade_vulkan.h"] {
        let text =
            fs::read_to_string(root().join("include").join(header)).expect("the header is there");
        let code = text
            .split("/*")
            .map(|part| part.split("*/").last().expect("a part"));
        for word in code
            .collect::<String>()
            .split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '('))
        {
            if let Some((name, _)) = word.split_once('(')
                && name.starts_with("hs_")
            {
                names.insert(name.to_owned());
            }
        }
    }
    names
}

#[test]
fn the_library_exports_what_the_headers_declare_and_nothing_else() {
    let listing = done(
        Command::new("nm")
            .args(["--dynamic", "--defined-only", "--format=posix"])
            .arg(built("libhalfshade.so")),
    );
    let exported: BTreeSet<String> = listing
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .map(str::to_owned)
        .collect();
    assert_eq!(exported, declared());
}

#[test]
fn the_library_is_asked_for_by_the_version_of_its_interface() {
    let dynamic = done(
        Command::new("readelf")
            .args(["--dynamic", "--wide"])
            .arg(built("libhalfshade.so")),
    );
    let version = halfshade::c_api::types::HS_ABI_VERSION;
    let name = format!("[libhalfshade.so.{version}]");
    assert!(
        dynamic
            .lines()
            .any(|line| line.contains("SONAME") && line.contains(&name)),
        "{dynamic}"
    );
    let manifest = fs::read_to_string(root().join("Cargo.toml")).expect("it is there");
    let named = format!("version = \"{version}.0.0\"");
    let section = manifest
        .split("[package.metadata.capi.library]")
        .nth(1)
        .expect("cargo-c is told");
    assert!(section.trim_start().starts_with("name = ") && section.contains(&named));
}
