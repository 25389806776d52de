//! A glTF file taken apart: the JSON tree, exact node transforms and the bytes it refers to.
//!
//! Nothing of the tree is trusted: every index is looked up through [`Document::get`] and every byte
//! range is checked before it is sliced.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use glam::{DAffine3, DQuat, DVec3};
use gltf::binary::Glb;
use gltf::json::root::Get;
use gltf::json::{Buffer, Index, Root, buffer};

use super::file;
use crate::{Error, Result};

/// The extensions whose meaning the loader knows; a file may require these and no others.
const KNOWN_EXTENSIONS: [&str; 3] = [
    "EXT_lights_area",
    "KHR_lights_punctual",
    "KHR_texture_transform",
];

/// Files in the wild omit the padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Names an object in a message: `mesh 3 ("leaf")`.
pub(super) fn label(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => {
            let short: String = name.chars().take(60).collect();
            format!("{kind} {index} ({short:?})")
        }
        _ => format!("{kind} {index}"),
    }
}

/// A parsed glTF file and the bytes of its buffers, loaded when first asked for.
pub(super) struct Document<'a> {
    path: &'a Path,
    pub root: Root,
    /// One per node: node space to its parent's.
    pub transforms: Vec<DAffine3>,
    binary: Option<Cow<'a, [u8]>>,
    buffers: Vec<OnceCell<Cow<'a, [u8]>>>,
}

impl<'a> Document<'a> {
    /// Parses the bytes of a .gltf or .glb; `path` names it in errors and tells the folder in which its
    /// other files lie.
    ///
    /// # Errors
    /// When the bytes are no glTF 2.0 or the file requires an extension that is not known here.
    pub fn parse(path: &'a Path, bytes: &'a [u8]) -> Result<Self> {
        let (json, binary) = split(path, bytes)?;
        let not_gltf = |e| Error::parse(path, format!("is not a glTF file: {e}"));
        let root = Root::from_slice(&json).map_err(not_gltf)?;
        let exact: exact::Root = serde_json::from_slice(&json).map_err(not_gltf)?;
        if !root.asset.version.starts_with("2.") {
            let version = &root.asset.version;
            return Err(Error::parse(
                path,
                format!("has glTF version {version:?}; only 2.x can be read"),
            ));
        }
        let unknown = |name: &&String| !KNOWN_EXTENSIONS.contains(&name.as_str());
        if let Some(name) = root.extensions_required.iter().find(unknown) {
            return Err(Error::parse(
                path,
                format!(
                    "requires the extension {name:?}, which is not supported; export it without"
                ),
            ));
        }
        Ok(Self {
            path,
            transforms: exact.nodes.iter().map(exact::Node::transform).collect(),
            buffers: vec![OnceCell::new(); root.buffers.len()],
            root,
            binary,
        })
    }

    /// The extensions that the file uses without requiring them and that are not known here.
    pub fn ignored_extensions(&self) -> Vec<&str> {
        let used = self.root.extensions_used.iter().map(String::as_str);
        used.filter(|name| !KNOWN_EXTENSIONS.contains(name))
            .collect()
    }

    /// An error about the contents of this file.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::parse(self.path, message)
    }

    /// The object that `user` refers to.
    pub fn get<T>(&self, index: Index<T>, kind: &str, user: &str) -> Result<&T>
    where
        Root: Get<T>,
    {
        self.root.get(index).ok_or_else(|| {
            let index = index.value();
            self.error(format!(
                "{user} refers to {kind} {index}, which does not exist"
            ))
        })
    }

    /// The bytes of a buffer view that `user` refers to, and its stride [byte] where it states one.
    pub fn view(&self, index: Index<buffer::View>, user: &str) -> Result<(&[u8], Option<usize>)> {
        let view = self.get(index, "buffer view", user)?;
        let name = label("buffer view", index.value(), view.name.as_deref());
        let bytes = self.buffer(view.buffer, &name)?;
        let start = view.byte_offset.unwrap_or_default().0;
        let slice = start
            .checked_add(view.byte_length.0)
            .and_then(|end| bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        let slice = slice.ok_or_else(|| {
            self.error(format!(
                "{name}: {} bytes from byte {start} do not fit into the {} bytes of buffer {}",
                view.byte_length.0,
                bytes.len(),
                view.buffer.value(),
            ))
        })?;
        Ok((slice, view.byte_stride.map(|stride| stride.0)))
    }

    fn buffer(&self, index: Index<Buffer>, user: &str) -> Result<&[u8]> {
        let buffer = self.get(index, "buffer", user)?;
        let cell = &self.buffers[index.value()];
        if let Some(bytes) = cell.get() {
            return Ok(bytes);
        }
        let name = label("buffer", index.value(), buffer.name.as_deref());
        let length = buffer.byte_length.0;
        let mut bytes = match &buffer.uri {
            Some(uri) => Cow::Owned(self.resource(uri, length, &name)?),
            None if index.value() == 0 => self.binary.clone().ok_or_else(|| {
                self.error(format!("{name}: has no uri and the file no binary chunk"))
            })?,
            None => return Err(self.error(format!("{name}: has no uri"))),
        };
        if (bytes.len() as u64) < length {
            let held = bytes.len();
            return Err(self.error(format!("{name}: holds {held} bytes instead of {length}")));
        }
        match &mut bytes {
            Cow::Owned(bytes) => bytes.truncate(length as usize),
            Cow::Borrowed(bytes) => *bytes = &bytes[..length as usize],
        }
        Ok(cell.get_or_init(|| bytes))
    }

    /// What a `data:` URI holds, or the first `limit` [byte] of the file that a relative URI names.
    ///
    /// # Errors
    /// When the URI leaves the folder of the glTF, or the data cannot be read.
    pub fn resource(&self, uri: &str, limit: u64, user: &str) -> Result<Vec<u8>> {
        if let Some(data) = uri.strip_prefix("data:") {
            let Some((_, data)) = data.split_once(";base64,") else {
                return Err(self.error(format!("{user}: its data URI is not in base64")));
            };
            return BASE64
                .decode(data)
                .map_err(|e| self.error(format!("{user}: its data URI is not valid base64: {e}")));
        }
        let Some(relative) = relative_path(uri) else {
            let short: String = uri.chars().take(80).collect();
            return Err(self.error(format!(
                "{user}: refuses to read {short:?}, which is not a path below the folder of the glTF"
            )));
        };
        let folder = match self.path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let path = folder.join(relative);
        let real = |path: &Path| path.canonicalize().map_err(|e| Error::io(path, e));
        if !real(&path)?.starts_with(real(folder)?) {
            return Err(self.error(format!(
                "{user}: refuses to read {uri:?}, a link out of the folder of the glTF"
            )));
        }
        file::read_at_most(&path, limit)
    }
}

/// The JSON text and the binary chunk of a .glb, or all of a .gltf.
fn split<'a>(path: &Path, bytes: &'a [u8]) -> Result<(Cow<'a, [u8]>, Option<Cow<'a, [u8]>>)> {
    if !bytes.starts_with(b"glTF") {
        return Ok((bytes.into(), None));
    }
    // `Glb::from_slice` subtracts the header's 12 bytes from this length without looking.
    let length = bytes.get(8..12).and_then(|b| b.try_into().ok());
    if length
        .map(u32::from_le_bytes)
        .is_none_or(|length| length < 12)
    {
        return Err(Error::parse(
            path,
            "is not a complete GLB file: its header is broken",
        ));
    }
    let glb = Glb::from_slice(bytes)
        .map_err(|e| Error::parse(path, format!("is not a complete GLB file: {e}")))?;
    Ok((glb.json, glb.bin))
}

/// The path that a URI reference means, if it stays below the folder it starts from.
fn relative_path(uri: &str) -> Option<PathBuf> {
    // RFC 3986 §4.2: a colon in the first segment makes it a URL (or a Windows drive).
    if uri.split('/').next()?.contains(':') {
        return None;
    }
    let decoded = percent_encoding::percent_decode_str(uri)
        .decode_utf8()
        .ok()?;
    if decoded.contains(['\\', '\0']) {
        return None;
    }
    let path = PathBuf::from(decoded.into_owned());
    let below = |part| matches!(part, Component::Normal(_) | Component::CurDir);
    let names_file = path.file_name().is_some();
    (names_file && path.components().all(below)).then_some(path)
}

/// Node transforms as f64: the `gltf` crate rounds them to f32, which displaces distant objects.
mod exact {
    use super::{DAffine3, DQuat, DVec3};

    #[derive(serde::Deserialize)]
    pub struct Root {
        #[serde(default)]
        pub nodes: Vec<Node>,
    }

    #[derive(serde::Deserialize)]
    pub struct Node {
        matrix: Option<[f64; 16]>,
        translation: Option<[f64; 3]>,
        rotation: Option<[f64; 4]>,
        scale: Option<[f64; 3]>,
    }

    impl Node {
        pub fn transform(&self) -> DAffine3 {
            if let Some([a, b, c, _, d, e, f, _, g, h, i, _, x, y, z, _]) = self.matrix {
                return DAffine3::from_cols_array(&[a, b, c, d, e, f, g, h, i, x, y, z]);
            }
            let rotation = DQuat::from_array(self.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
            let length = rotation.length();
            let rotation = if length > 0.0 {
                rotation / length
            } else {
                DQuat::IDENTITY
            };
            DAffine3::from_scale_rotation_translation(
                DVec3::from_array(self.scale.unwrap_or([1.0; 3])),
                rotation,
                DVec3::from_array(self.translation.unwrap_or([0.0; 3])),
            )
        }
    }
}
