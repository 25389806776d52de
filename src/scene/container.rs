//! What stands between the bytes of a file and its glTF: containers, byte-order marks and padding as tools write them, and what
//! a file is that is no glTF at all.

use std::borrow::Cow;
use std::path::Path;

use serde_json::Value;

use crate::{Error, Result};

/// Borrowed from the file where it holds them as they are.
pub(super) type Bytes<'a> = Cow<'a, [u8]>;

/// [byte] Of a GLB's header, and of a chunk's.
const HEADER: usize = 12;
const CHUNK_HEADER: usize = 8;

/// In UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

const JSON: &[u8] = b"JSON";
const BINARY: &[u8] = b"BIN\0";

/// The JSON text and the binary chunk of a .glb, or all of a .gltf. What common readers take is taken: the length in the header
/// is not believed, chunks of other kinds are passed by, and the last one may be cut short (who needs the rest will miss it).
///
/// # Errors
/// When the bytes are no glTF; the message says what they are, if that can be told.
pub(super) fn split<'a>(path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<Bytes<'a>>)> {
    if let Some(what) = another_kind(bytes) {
        return Err(Error::parse(path, what));
    }
    if !bytes.starts_with(b"glTF") {
        return Ok((tidy(bytes), None));
    }
    let broken = |what: &str| Error::parse(path, format!("is not a complete GLB file: {what}"));
    let number = |at: usize| {
        let four = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes(four.try_into().ok()?))
    };
    match number(4) {
        Some(2) => {}
        Some(version) => {
            return Err(broken(&format!(
                "it has version {version}, and only 2 can be read; convert it to glTF 2.0"
            )));
        }
        None => return Err(broken("its header is cut short")),
    }
    let (mut json, mut binary) = (None, None);
    let mut at = HEADER;
    while let Some(length) = number(at).filter(|_| bytes.len() >= at + CHUNK_HEADER) {
        let kind = &bytes[at + 4..at + CHUNK_HEADER];
        let rest = &bytes[at + CHUNK_HEADER..];
        let data = &rest[..rest.len().min(length as usize)];
        match kind {
            JSON if json.is_none() => json = Some(data),
            BINARY if binary.is_none() => binary = Some(Cow::Borrowed(data)),
            _ => {}
        }
        at += CHUNK_HEADER + data.len();
    }
    let json = json.ok_or_else(|| broken("it holds no JSON"))?;
    Ok((tidy(json), binary))
}

/// A JSON text without a byte-order mark before it and without zeros after it.
fn tidy(text: &[u8]) -> &[u8] {
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    let end = text.iter().rposition(|&byte| byte != 0);
    &text[..end.map_or(0, |last| last + 1)]
}

/// Refuses what is no glTF 2, by what its `asset` says.
///
/// # Errors
/// When the text is no JSON or its version is not 2.
pub(super) fn check_version(path: &Path, json: &[u8]) -> Result<()> {
    let not_gltf = |e| Error::parse(path, format!("is not a glTF file: {e}"));
    let value: Value = serde_json::from_slice(json).map_err(not_gltf)?;
    match value.pointer("/asset/version") {
        Some(Value::String(version)) if !version.starts_with("2.") => Err(Error::parse(
            path,
            format!("has glTF version {version:?}; only 2.x can be read: convert it to glTF 2.0"),
        )),
        _ => Ok(()),
    }
}

/// Files that are no glTF, by how their text begins in any case, and what to do about them.
const OTHER_KINDS: [(&[&[u8]], &str); 9] = [
    (
        &[b"<!doctype html", b"<html"],
        "is a web page, not a glTF file; download the file itself, not the page that shows it",
    ),
    (
        &[b"<?xml", b"<collada"],
        "is an XML file (COLLADA, X3D?), not a glTF file; convert it to glTF 2.0",
    ),
    (
        &[b"version https://git-lfs"],
        "is a pointer of Git LFS, not the file itself; run `git lfs pull` where it comes from",
    ),
    (
        &[b"Kaydara FBX Binary", b"; FBX"],
        "is an FBX file; convert it to glTF 2.0, as Blender does",
    ),
    (
        &[b"PXR-USDC", b"#usda"],
        "is a USD file; convert it to glTF 2.0, as Blender does",
    ),
    (
        &[b"PK\x03\x04"],
        "is a zip archive (USDZ, 3MF?); unpack it, and give the glTF file in it",
    ),
    (&[b"\x1f\x8b"], "is compressed with gzip; unpack it"),
    (&[b"BLENDER"], "is a Blender file; export it as glTF 2.0"),
    (
        &[b"ply\n", b"ply\r", b"solid "],
        "is a PLY or STL file; convert it to glTF 2.0",
    ),
];

/// What a file is that is certainly no glTF, and what to do about it.
fn another_kind(bytes: &[u8]) -> Option<&'static str> {
    if bytes.is_empty() {
        return Some("is empty; was it downloaded or exported to the end?");
    }
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Some("is text in UTF-16; save it as UTF-8");
    }
    let text = bytes.strip_prefix(BYTE_ORDER_MARK).unwrap_or(bytes);
    let text = text.trim_ascii_start();
    let begins = |with: &&[u8]| {
        let start = text.get(..with.len());
        start.is_some_and(|start| start.eq_ignore_ascii_case(with))
    };
    let known = OTHER_KINDS
        .iter()
        .find(|(starts, _)| starts.iter().any(begins));
    known.map(|(_, what)| *what).or_else(|| {
        is_wavefront(text)
            .then_some("is a Wavefront OBJ file; convert it to glTF 2.0, as Blender does")
    })
}

/// Whether the first lines that say anything are those of an OBJ.
fn is_wavefront(text: &[u8]) -> bool {
    let lines = text.split(|&byte| byte == b'\n').take(64);
    let mut said = lines
        .map(<[u8]>::trim_ascii)
        .filter(|line| !line.is_empty() && line[0] != b'#');
    said.next().is_some_and(|line| {
        ["v ", "o ", "g ", "mtllib ", "vn ", "vt "]
            .iter()
            .any(|word| line.starts_with(word.as_bytes()))
    })
}
