//! What the repository cites is in it: publications, sections of docs/algorithm.md, files that documents link to.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Files below a folder, by their extensions.
fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let extension = path.extension().map(|e| e.to_string_lossy().into_owned());
        match extension {
            _ if path.is_dir() => found.extend(files(&path, extensions)),
            Some(extension) if extensions.contains(&extension.as_str()) => found.push(path),
            _ => {}
        }
    }
    found
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn documents() -> Vec<PathBuf> {
    let names = ["README.md", "ARCHITECTURE.md", "CHANGELOG.md"];
    let mut all: Vec<PathBuf> = names.iter().map(|name| root().join(name)).collect();
    for folder in ["docs", "benches/results"] {
        all.extend(files(&root().join(folder), &["md"]));
    }
    all
}

/// Documents, and what the comments of sources say.
fn texts() -> Vec<(PathBuf, String)> {
    let mut all = documents();
    for folder in [
        "src", "glsl", "tests", "benches", "examples", "tools", "include",
    ] {
        let extensions = ["rs", "glsl", "comp", "vert", "frag", "h", "c", "py"];
        all.extend(files(&root().join(folder), &extensions));
    }
    let said = |path: PathBuf| {
        let text = read(&path);
        let comments = |line: &str| line.split_once("//").map(|(_, comment)| comment.to_owned());
        let text = match path.extension().is_some_and(|e| e == "md") {
            true => text,
            false => text
                .lines()
                .filter_map(comments)
                .collect::<Vec<_>>()
                .join("\n"),
        };
        (path, text)
    };
    all.into_iter().map(said).collect()
}

/// Keys such as Yang09 in what stands in brackets: letters and a two-digit year.
fn keys(text: &str) -> BTreeSet<String> {
    let inside = text
        .split('[')
        .skip(1)
        .filter_map(|rest| rest.split(']').next());
    let words = inside.flat_map(|inside| inside.split(|c: char| !c.is_ascii_alphanumeric()));
    let is_key = |word: &&str| {
        let letters = word.trim_end_matches(|c: char| c.is_ascii_digit());
        word.len() == letters.len() + 2
            && letters.len() > 1
            && letters.starts_with(|c: char| c.is_ascii_uppercase())
            && letters.chars().all(|c| c.is_ascii_alphabetic())
    };
    words.filter(is_key).map(str::to_owned).collect()
}

#[test]
fn publications_that_are_cited_are_listed() {
    let list = root().join("docs/references.md");
    let rows = read(&list);
    let rows = rows.lines().filter(|line| line.starts_with("| ["));
    let listed: BTreeSet<String> = rows.flat_map(keys).collect();
    let texts = texts().into_iter().filter(|(path, _)| *path != list);
    let cited: BTreeSet<String> = texts.flat_map(|(_, text)| keys(&text)).collect();
    assert!(listed.contains("Yang09") && cited.contains("Yang09"));
    let missing: Vec<_> = cited.difference(&listed).collect();
    assert!(missing.is_empty(), "docs/references.md lacks {missing:?}");
    let idle: Vec<_> = listed.difference(&cited).collect();
    assert!(idle.is_empty(), "nothing cites {idle:?}");
}

#[test]
fn sections_that_are_cited_exist() {
    let text = read(&root().join("docs/algorithm.md"));
    let headings = text.lines().filter_map(|line| line.strip_prefix("## "));
    let sections: Vec<u32> = headings
        .filter_map(|heading| heading.split('.').next()?.parse().ok())
        .collect();
    assert_eq!(sections, (1..=sections.len() as u32).collect::<Vec<_>>());
    let mut cited = 0;
    for (path, text) in texts() {
        for rest in text.split("algorithm.md").skip(1) {
            let rest = rest.trim_start_matches(['`', ')']);
            let Some(rest) = rest.strip_prefix(" §") else {
                continue;
            };
            let digits: String = rest.chars().take_while(char::is_ascii_digit).collect();
            let section: u32 = digits.parse().expect("a number");
            assert!(
                sections.contains(&section),
                "{}: §{section}",
                path.display()
            );
            cited += 1;
        }
    }
    assert!(cited > 15, "{cited}");
}

#[test]
fn links_lead_somewhere() {
    let mut links = 0;
    for path in documents() {
        for rest in read(&path).split("](").skip(1) {
            let link = rest.split([')', '#', ' ']).next().unwrap_or_default();
            if link.is_empty() || link.contains("://") {
                continue;
            }
            let target = path.parent().expect("a folder").join(link);
            assert!(target.exists(), "{}: {link}", path.display());
            links += 1;
        }
    }
    assert!(links > 10, "{links}");
}

#[test]
fn examples_that_are_named_exist() {
    let mut named = 0;
    for (path, text) in texts() {
        for rest in text.split("examples/").skip(1) {
            let is_part = |c: char| c.is_ascii_alphanumeric() || "_./".contains(c);
            let name = rest.split(|c| !is_part(c)).next().unwrap_or_default();
            let name = name.trim_end_matches('.');
            assert!(
                root().join("examples").join(name).exists(),
                "{}: {name}",
                path.display()
            );
            named += 1;
        }
    }
    assert!(named > 5, "{named}");
}

#[test]
fn files_that_documents_name_exist() {
    let mut named = 0;
    for path in documents() {
        for quoted in read(&path).split('`').skip(1).step_by(2) {
            let name = quoted.split([':', ' ']).next().unwrap_or_default();
            let is_file = ["src/", "glsl/", "tests/", "tools/", "docs/"]
                .iter()
                .any(|folder| name.starts_with(folder));
            if is_file && !name.contains(['*', '{', '<']) && !name.contains("NAME") {
                let target = root().join(name.trim_end_matches(['.', ',']));
                assert!(target.exists(), "{}: {name}", path.display());
                named += 1;
            }
        }
    }
    assert!(named > 20, "{named}");
}
