//! Imports point one way: no circle between the rooms of the library, and none between the files of a room.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What each imports, by name.
type Imports = BTreeMap<String, BTreeSet<String>>;

/// Rust files below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        match path.is_dir() {
            true => found.extend(files(&path)),
            false if path.extension().is_some_and(|e| e == "rs") => found.push(path),
            false => {}
        }
    }
    found
}

/// The names that follow `prefix` in a file, its tests apart.
fn names(file: &Path, prefix: &str) -> BTreeSet<String> {
    let text = std::fs::read_to_string(file).expect("a file");
    let text = text.split("#[cfg(test)]").next().unwrap_or_default();
    let name = |rest: &str| {
        let end = rest.find(|c: char| !(c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'));
        rest[..end.unwrap_or(rest.len())].to_owned()
    };
    text.split(prefix).skip(1).map(name).collect()
}

fn stem(file: &Path) -> String {
    file.file_stem()
        .expect("a name")
        .to_string_lossy()
        .into_owned()
}

/// What imports itself by way of what it imports.
fn circles(imports: &Imports) -> Vec<&String> {
    let reaches = |start: &String| {
        let (mut seen, mut left) = (BTreeSet::new(), vec![start]);
        while let Some(next) = left.pop() {
            let known = imports[next]
                .iter()
                .filter(|name| imports.contains_key(*name));
            for name in known.filter(|name| *name != next) {
                if seen.insert(name) {
                    left.push(name);
                }
            }
        }
        seen.contains(start)
    };
    imports.keys().filter(|name| reaches(name)).collect()
}

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

#[test]
fn rooms_import_one_way() {
    let mut rooms = Imports::new();
    for file in files(&source()) {
        let inside = file.strip_prefix(source()).expect("below the source");
        let first = inside.components().next().expect("a name");
        let room = stem(Path::new(first.as_os_str()));
        // The program uses the library as others do.
        if !["main", "cli", "lib"].contains(&room.as_str()) {
            rooms
                .entry(room)
                .or_default()
                .extend(names(&file, "crate::"));
        }
    }
    assert!(rooms.len() > 10, "{rooms:?}");
    assert_eq!(circles(&rooms), Vec::<&String>::new());
}

#[test]
fn files_of_a_room_import_one_way() {
    let folders = files(&source()).into_iter();
    let folders: BTreeSet<PathBuf> = folders
        .filter_map(|file| Some(file.parent()?.into()))
        .collect();
    for folder in folders.iter().filter(|folder| **folder != source()) {
        let entries = std::fs::read_dir(folder).expect("a folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let inside = paths.filter(|path| path.extension().is_some_and(|e| e == "rs"));
        let imports: Imports = inside
            .map(|path| (stem(&path), names(&path, "super::")))
            .collect();
        let found = circles(&imports);
        assert!(found.is_empty(), "{}: {found:?}", folder.display());
    }
}

#[test]
fn circles_are_found() {
    let imports = |pairs: &[(&str, &str)]| -> Imports {
        let one =
            |(from, to): &(&str, &str)| ((*from).to_owned(), BTreeSet::from([(*to).to_owned()]));
        pairs.iter().map(one).collect()
    };
    let chain = imports(&[("a", "b"), ("b", "c"), ("c", "d"), ("d", "")]);
    assert!(circles(&chain).is_empty());
    let circle = imports(&[("a", "b"), ("b", "c"), ("c", "b"), ("d", "")]);
    assert_eq!(circles(&circle), ["b", "c"]);
}
