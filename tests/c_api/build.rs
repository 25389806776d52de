//! Compiling and running C programs against the library that belongs to these tests.

use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A file that cargo built beside these tests.
pub fn built(name: &str) -> PathBuf {
    let tests = std::env::current_exe().expect("this program has a path");
    let path = tests.parent().expect("it lies in a folder").join(name);
    assert!(path.exists(), "{} was not built", path.display());
    path
}

/// A folder with the shared library under the names that linkers and loaders look for.
pub struct Workshop {
    folder: TempDir,
}

impl Workshop {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for name in ["libhalfshade.so", "libhalfshade.so.1"] {
            symlink(built("libhalfshade.so"), folder.path().join(name)).expect("a link");
        }
        Self { folder }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Compiles C99 with all warnings as errors, and links it to the shared library and to Vulkan's loader.
    pub fn compile(&self, source: &Path, flags: &[&str]) -> PathBuf {
        let program = self.path(source.file_stem().expect("a name").to_str().expect("UTF-8"));
        let link = format!("-L{}", self.folder.path().display());
        let find = format!("-Wl,-rpath,{}", self.folder.path().display());
        let include = format!("-I{}", root().join("include").display());
        done(
            Command::new("cc")
                .args([
                    "-std=c99",
                    "-Wall",
                    "-Wextra",
                    "-Werror",
                    "-pedantic",
                    "-O1",
                    "-g",
                ])
                .args(flags)
                .args([&include, &link, &find])
                .arg(source)
                .arg("-o")
                .arg(&program)
                .args(["-lhalfshade", "-lvulkan", "-lpthread", "-lm"]),
        );
        program
    }
}

/// Runs a command that must succeed; its standard output.
pub fn done(command: &mut Command) -> String {
    let Output {
        status,
        stdout,
        stderr,
    } = command.output().expect("the command starts");
    let (out, err) = (
        String::from_utf8_lossy(&stdout),
        String::from_utf8_lossy(&stderr),
    );
    assert!(status.success(), "{command:?}: {status}\n{out}{err}");
    out.into_owned()
}
