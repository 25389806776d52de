//! Installed, the library is found by pkg-config and by CMake, shared and static.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::build::{built, done, root};

const PROGRAM: &str = "#include <halfshade.h>\n#include <stdio.h>\n\
                       int main(void) { puts(hs_version()); return hs_abi_version() != HS_ABI_VERSION; }\n";
const PROJECT: &str = "cmake_minimum_required(VERSION 3.13)\nproject(use C)\nfind_package(halfshade REQUIRED)\n\
                       add_executable(shared use.c)\ntarget_link_libraries(shared halfshade::halfshade)\n\
                       add_executable(static use.c)\ntarget_link_libraries(static halfshade::static)\n";

fn install(prefix: &Path) {
    let folder = built("libhalfshade.so");
    let folder = folder.parent().expect("it lies in a folder");
    done(
        Command::new(root().join("tools/install.sh"))
            .arg(prefix)
            .arg(folder),
    );
}

fn says_its_version(program: &Path) {
    let out = done(&mut Command::new(program));
    assert_eq!(out.trim(), env!("CARGO_PKG_VERSION"));
}

#[test]
fn pkg_config_and_cmake_find_what_is_installed() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let prefix = folder.path().join("prefix");
    install(&prefix);
    let source = folder.path().join("use.c");
    fs::write(&source, PROGRAM).expect("written");

    let path = prefix.join("lib/pkgconfig");
    let flags = done(
        Command::new("pkg-config")
            .args(["--cflags", "--libs", "halfshade"])
            .env("PKG_CONFIG_PATH", &path),
    );
    let program = folder.path().join("use");
    done(
        Command::new("cc")
            .arg(&source)
            .arg("-o")
            .arg(&program)
            .args(flags.split_whitespace())
            .arg(format!("-Wl,-rpath,{}", prefix.join("lib").display())),
    );
    says_its_version(&program);

    fs::write(folder.path().join("CMakeLists.txt"), PROJECT).expect("written");
    let build = folder.path().join("build");
    done(
        Command::new("cmake")
            .arg("-S")
            .arg(folder.path())
            .arg("-B")
            .arg(&build)
            .arg(format!("-DCMAKE_PREFIX_PATH={}", prefix.display())),
    );
    done(Command::new("cmake").arg("--build").arg(&build));
    says_its_version(&build.join("shared"));
    says_its_version(&build.join("static"));
}
