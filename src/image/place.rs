//! Where a path leads: links followed, other spellings of the same file recognised.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What stands, or will stand, under a path.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// A regular file, all links followed.
    File(PathBuf),
    /// A device or a pipe: renaming a file over it would destroy it.
    Stream,
}

/// Follows a path to the file that it writes; a link that leads nowhere yet leads to where it points.
///
/// # Errors
/// It is a folder or no file name, a folder on the way is missing or closed, or links lead in a circle.
pub(super) fn place_of(path: &Path) -> io::Result<Place> {
    match fs::metadata(path) {
        Ok(found) if found.is_dir() => Err(io::Error::new(
            ErrorKind::IsADirectory,
            "is a folder, not a file",
        )),
        Ok(found) if !found.is_file() => Ok(Place::Stream),
        Ok(_) => fs::canonicalize(path).map(Place::File),
        Err(error) if error.kind() == ErrorKind::NotFound => absent(path).map(Place::File),
        Err(error) => Err(error),
    }
}

/// Where a file will stand that the system has not found.
fn absent(path: &Path) -> io::Result<PathBuf> {
    let mut place = path.to_path_buf();
    // The links end: the system has followed them to what is missing.
    while let Ok(next) = fs::read_link(&place) {
        place = folder_of(&place).join(next);
    }
    let invalid = |why: &str| io::Error::new(ErrorKind::InvalidInput, why);
    let name = place.file_name();
    let name = name.ok_or_else(|| invalid("is not a file name"))?;
    if place.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return Err(invalid("is the name of a folder, not of a file"));
    }
    let folder = folder_of(&place);
    if !folder.is_dir() {
        let message = format!("the folder {} does not exist", folder.display());
        return Err(io::Error::new(ErrorKind::NotFound, message));
    }
    Ok(fs::canonicalize(folder)?.join(name))
}

pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// What two paths have in common that lead to the same file.
#[derive(PartialEq, Eq)]
enum Identity {
    /// Device and inode, which hard links share.
    #[cfg(unix)]
    Inode(u64, u64),
    /// The number of a character device, wherever its node stands.
    #[cfg(unix)]
    Device(u64),
    /// The one real path.
    Path(PathBuf),
}

#[cfg(unix)]
fn identity(path: &Path) -> Option<Identity> {
    use std::os::unix::fs::{FileTypeExt, MetadataExt};
    match fs::metadata(path) {
        Ok(found) if found.file_type().is_char_device() => Some(Identity::Device(found.rdev())),
        Ok(found) => Some(Identity::Inode(found.dev(), found.ino())),
        Err(error) if error.kind() == ErrorKind::NotFound => absent(path).ok().map(Identity::Path),
        Err(_) => None,
    }
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<Identity> {
    match place_of(path).ok()? {
        Place::File(real) => Some(Identity::Path(real)),
        Place::Stream => Some(Identity::Path(path.into())),
    }
}

/// Whether two paths lead to the same file, be it by symbolic links, hard links or another spelling, and be the file
/// there or not. The null device, which keeps nothing, is never the same.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (identity(a), identity(b)) {
        (Some(a), Some(b)) => a == b && identity(Path::new("/dev/null")).as_ref() != Some(&a),
        // They lead nowhere.
        (None, None) => a == b,
        _ => false,
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn links_and_spellings_of_a_file_are_the_same() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        fs::write(at("real"), "").unwrap();
        fs::write(at("other"), "").unwrap();
        fs::hard_link(at("real"), at("hard")).unwrap();
        symlink("real", at("soft")).unwrap();
        symlink("soft", at("chain")).unwrap();
        symlink(folder.path(), at("sub/up")).unwrap();
        for same in [
            "real",
            "hard",
            "soft",
            "chain",
            "./real",
            "sub/../real",
            "sub/up/real",
        ] {
            assert!(is_same_file(&at("real"), &at(same)), "{same}");
        }
        assert!(!is_same_file(&at("real"), &at("other")));
        // None of them is there.
        symlink("sub/new", at("dangling")).unwrap();
        symlink("dangling", at("twice")).unwrap();
        for same in ["sub/new", "dangling", "twice", "sub/up/sub/new"] {
            assert!(is_same_file(&at("sub/new"), &at(same)), "{same}");
        }
        assert!(!is_same_file(&at("sub/new"), &at("new")));
        symlink("round", at("round")).unwrap();
        assert!(is_same_file(&at("round"), &at("round")));
        assert!(!is_same_file(&at("round"), &at("gone/new")));
        assert!(is_same_file(&at("gone/new"), &at("gone/./new")));
        let null = Path::new("/dev/null");
        assert!(!is_same_file(null, null));
    }

    #[test]
    fn a_place_is_where_the_links_end() {
        let folder = tempfile::tempdir().unwrap();
        let real = fs::canonicalize(folder.path()).unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("sub")).unwrap();
        symlink("sub/new", at("dangling")).unwrap();
        symlink("dangling", at("twice")).unwrap();
        symlink("round", at("round")).unwrap();
        symlink("gone/new", at("lost")).unwrap();
        let place = place_of(&at("twice")).unwrap();
        assert_eq!(place, Place::File(real.join("sub/new")));
        assert_eq!(place_of(Path::new("/dev/null")).unwrap(), Place::Stream);
        for (path, why) in [
            ("round", "symbolic link"),
            ("lost", "does not exist"),
            ("sub", "is a folder"),
            ("new/", "name of a folder"),
            ("new/..", "not a file name"),
        ] {
            let error = place_of(&at(path)).unwrap_err().to_string();
            assert!(error.contains(why), "{path}: {error}");
        }
    }
}
