//! Files that are either there in full or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::place::{Place, folder_of, place_of};
use crate::{Error, Result};

/// A file under a temporary name, which is removed unless `commit` gave it its final one.
struct Partial {
    path: PathBuf,
    committed: bool,
}

impl Partial {
    /// Creates a file that nobody else has, in the folder of `target`, so that the renaming stays
    /// within one file system.
    fn create(target: &Path) -> io::Result<(Self, File)> {
        static COUNTER: AtomicU64 = AtomicU64::new(0);
        // Short and independent of the target's name, which may be as long as the system allows.
        let name = format!(
            ".halfshade-{}-{}.partial",
            std::process::id(),
            COUNTER.fetch_add(1, Ordering::Relaxed)
        );
        let path = folder_of(target).join(name);
        let file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&path)?;
        let committed = false;
        Ok((Self { path, committed }, file))
    }

    fn commit(mut self, target: &Path) -> io::Result<()> {
        fs::rename(&self.path, target)?;
        self.committed = true;
        Ok(())
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        if !self.committed {
            // Nothing can be done about a failure here; the error that led here is what is reported.
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Writes a file in full or not at all: until `write` has succeeded, whatever stood under `path`
/// stays as it is. Symbolic links are followed, those too that lead nowhere yet; a device or a pipe
/// (`/dev/stdout`) is written to directly.
///
/// # Errors
/// When the folder is missing or not writable, when `path` is a folder, or when `write` fails.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<()> {
    let written = place_of(path).and_then(|place| match place {
        Place::Stream => fill(OpenOptions::new().write(true).open(path)?, write),
        Place::File(target) => {
            let (partial, file) = Partial::create(&target)?;
            fill(file, write)?;
            partial.commit(&target)
        }
    });
    written.map_err(|source| Error::io(path, source))
}

/// Whether `write_atomically` could write `path`, asked before hours of work; leaves no file.
///
/// # Errors
/// The same sentence that writing would fail with.
pub fn check_writable(path: &Path) -> Result<()> {
    let checked = place_of(path).and_then(|place| match place {
        Place::Stream => Ok(()),
        Place::File(target) => Partial::create(&target).map(drop),
    });
    checked.map_err(|source| Error::io(path, source))
}

fn fill(file: File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut buffered = BufWriter::new(file);
    write(&mut buffered)?;
    buffered.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names_in(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_finished_file_is_all_there_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        write_atomically(&path, |file| file.write_all(b"first")).unwrap();
        write_atomically(&path, |file| file.write_all(b"second")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"second");
        assert_eq!(names_in(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_failure_leaves_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let fail = |file: &mut dyn Write| {
            file.write_all(b"half")?;
            Err(io::Error::other("the pen broke"))
        };
        let error = write_atomically(&path, fail).unwrap_err().to_string();
        assert!(
            error.contains("a.txt") && error.contains("the pen broke"),
            "{error}"
        );
        assert!(names_in(folder.path()).is_empty());
        fs::write(&path, "old").unwrap();
        write_atomically(&path, fail).unwrap_err();
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names_in(folder.path()), ["a.txt"]);
    }

    #[test]
    fn a_panic_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        let result = std::panic::catch_unwind(|| write_atomically(&path, |_| panic!("on purpose")));
        assert!(result.is_err());
        assert!(names_in(folder.path()).is_empty());
    }

    #[test]
    fn checking_leaves_nothing_and_refuses_what_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        check_writable(&folder.path().join("a.txt")).unwrap();
        assert!(names_in(folder.path()).is_empty());
        let error = check_writable(&folder.path().join("no/a.txt"))
            .unwrap_err()
            .to_string();
        assert!(error.contains("does not exist"), "{error}");
        let error = check_writable(folder.path()).unwrap_err().to_string();
        assert!(error.contains("is a folder"), "{error}");
        assert!(check_writable(Path::new("")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_devices_survive() {
        use std::os::unix::fs::FileTypeExt;
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real"), folder.path().join("link"));
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink("real", &link).unwrap();
        write_atomically(&link, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        // A chain of links that leads nowhere yet.
        let (chain, dangling) = (folder.path().join("chain"), folder.path().join("dangling"));
        std::os::unix::fs::symlink("made", &dangling).unwrap();
        std::os::unix::fs::symlink("dangling", &chain).unwrap();
        check_writable(&chain).unwrap();
        write_atomically(&chain, |file| file.write_all(b"new")).unwrap();
        assert_eq!(fs::read(folder.path().join("made")).unwrap(), b"new");
        for link in [&chain, &dangling] {
            assert!(fs::symlink_metadata(link).unwrap().is_symlink());
        }
        write_atomically(Path::new("/dev/null"), |file| file.write_all(b"gone")).unwrap();
        assert!(
            fs::metadata("/dev/null")
                .unwrap()
                .file_type()
                .is_char_device()
        );
    }
}
