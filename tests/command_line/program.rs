//! A folder to run the program in.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::{Value, json};
use tempfile::TempDir;

pub struct Folder(TempDir);

/// What a run of the program left.
pub struct Run {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

pub fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// A shot of the plate that is small and quick to render.
pub fn plate() -> Value {
    json!({
        "scene": scenes().join("plate.gltf"),
        "camera": {"eye": [0, 4.6, 5.4], "target": [0, 0.25, 0], "vfov_deg": 36, "width": 24, "height": 16},
        "lights": [{"type": "rect", "center": [0, 3, 0], "u": [0.75, 0, 0], "v": [0, 0, 0.75]}],
    })
}

/// The program, as [`at_home`].
pub fn program() -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_halfshade"));
    at_home(&mut program);
    program
}

/// Gives a command folders of these tests in place of the user's: nobody calibrates there, and pipeline caches stay,
/// which a device needs to start in reasonable time.
pub fn at_home(command: &mut Command) -> &mut Command {
    let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("home");
    for (variable, folder) in [
        ("HOME", ""),
        ("XDG_DATA_HOME", "data"),
        ("XDG_CACHE_HOME", "cache"),
    ] {
        command.env(variable, home.join(folder));
    }
    // Mesa makes no folders above its own.
    std::fs::create_dir_all(home.join("cache")).expect("a folder");
    command
}

impl Folder {
    pub fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).expect("the folder can be written");
    }

    pub fn write_shot(&self, shot: &Value) {
        self.write("shot.json", shot.to_string());
    }

    /// The program, to be run here.
    pub fn program(&self) -> Command {
        let mut program = program();
        program.current_dir(self.0.path());
        program
    }

    /// Runs the program here.
    pub fn run(&self, args: &[&str]) -> Run {
        let output = self.program().args(args).output();
        let Output {
            status,
            stdout,
            stderr,
        } = output.expect("the program starts");
        Run {
            code: status.code(),
            out: String::from_utf8(stdout).expect("UTF-8"),
            err: String::from_utf8(stderr).expect("UTF-8"),
        }
    }

    /// The names of all that is there.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path()).expect("the folder is there");
        let mut names: Vec<String> = entries
            .map(|entry| entry.unwrap().file_name().into_string().expect("UTF-8"))
            .collect();
        names.sort();
        names
    }

    /// Runs the program, which must refuse with one sentence that has all of `words` in it, and leave
    /// the folder as it was.
    pub fn refuses(&self, args: &[&str], words: &[&str]) {
        let before = self.names();
        let run = self.run(args);
        assert_eq!(run.code, Some(1), "{args:?}: {}", run.err);
        assert_eq!(run.err.lines().count(), 1, "{args:?}: {}", run.err);
        assert!(run.err.starts_with("halfshade: "), "{args:?}: {}", run.err);
        assert!(run.out.is_empty(), "{args:?}: {}", run.out);
        run.expect_words(args, words);
        assert_eq!(self.names(), before, "{args:?}");
    }

    /// The same for wrong usage, which clap reports: its first line is the sentence.
    pub fn refuses_usage(&self, args: &[&str], words: &[&str]) {
        let before = self.names();
        let run = self.run(args);
        assert_eq!(run.code, Some(2), "{args:?}: {}", run.err);
        assert!(run.err.starts_with("error: "), "{args:?}: {}", run.err);
        run.expect_words(args, words);
        assert_eq!(self.names(), before, "{args:?}");
    }

    /// Runs the program, which must do as it is told.
    pub fn does(&self, args: &[&str]) -> String {
        let run = self.run(args);
        assert_eq!(run.code, Some(0), "{args:?}: {}", run.err);
        assert!(run.err.is_empty(), "{args:?}: {}", run.err);
        run.out
    }
}

impl Run {
    fn expect_words(&self, args: &[&str], words: &[&str]) {
        let first = self.err.lines().next().unwrap_or_default();
        for word in words {
            assert!(first.contains(word), "{args:?}: no {word:?} in: {first}");
        }
        assert!(!self.err.contains("panicked"), "{args:?}: {}", self.err);
    }
}
