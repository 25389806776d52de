//! A glTF file taken apart: the JSON tree, exact node transforms and the bytes it refers to.
//!
//! Nothing of the tree is trusted: every index is looked up through [`Document::get`] and every byte
//! range is checked before it is sliced.

use std::borrow::Cow;
use std::cell::{OnceCell, RefCell};
use std::collections::{BTreeSet, HashSet};
use std::path::{Path, PathBuf};

use glam::{DAffine3, DQuat, DVec3};
use gltf::json::root::Get;
use gltf::json::{Buffer, Index, Root, buffer};

use super::container::{Bytes, check_version, split};
use super::meshopt::Compressed;
use super::options::{Budget, LoadOptions};
use super::uri::{NamedFile, data_of, inline_data};
use super::{draco, extensions, file};
use crate::{Error, Result};

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
    binary: Option<Bytes<'a>>,
    buffers: Vec<OnceCell<Bytes<'a>>>,
    /// One per buffer view: what compressed ones hold, as bytes or as meshes.
    decoded: Vec<OnceCell<Vec<u8>>>,
    meshes: Vec<OnceCell<draco::Mesh>>,
    outside_paths: bool,
    budget: RefCell<Budget>,
    /// The files beside it that were read.
    read: RefCell<HashSet<PathBuf>>,
}

impl<'a> Document<'a> {
    /// Parses the bytes of a .gltf or .glb; `path` names it in errors and tells the folder in which its
    /// other files lie.
    ///
    /// # Errors
    /// When the bytes are no glTF 2.0 or the file requires an extension that is not known here.
    pub fn parse(path: &'a Path, bytes: &'a [u8], options: &LoadOptions) -> Result<Self> {
        let (json, binary) = split(path, bytes)?;
        check_version(path, json)?;
        let not_gltf = |e| Error::parse(path, format!("is not a glTF file: {e}"));
        let root = Root::from_slice(json).map_err(not_gltf)?;
        let exact: exact::Root = serde_json::from_slice(json).map_err(not_gltf)?;
        let unknown = |name: &&String| !extensions::may_be_required(name);
        if let Some(name) = root.extensions_required.iter().find(unknown) {
            return Err(Error::parse(
                path,
                format!(
                    "requires the extension {name:?}, which is not supported; export it without"
                ),
            ));
        }
        let mut budget = Budget::new(&options.limits);
        budget.earn(bytes.len());
        Ok(Self {
            path,
            outside_paths: options.outside_paths,
            budget: RefCell::new(budget),
            read: RefCell::default(),
            transforms: exact.nodes.iter().map(exact::Node::transform).collect(),
            buffers: vec![OnceCell::new(); root.buffers.len()],
            decoded: (root.buffer_views.iter())
                .map(|_| OnceCell::new())
                .collect(),
            meshes: (root.buffer_views.iter())
                .map(|_| OnceCell::new())
                .collect(),
            root,
            binary,
        })
    }

    /// Whether vertices may be integers.
    pub fn is_quantized(&self) -> bool {
        let mut used = self.root.extensions_used.iter();
        used.any(|name| name == "KHR_mesh_quantization")
    }

    /// The extensions that the file uses without requiring them and that are not known here.
    pub fn ignored_extensions(&self) -> Vec<&str> {
        let used = self.root.extensions_used.iter().map(String::as_str);
        used.filter(|name| !extensions::is_known(name)).collect()
    }

    /// An error about the contents of this file.
    pub fn error(&self, message: impl Into<String>) -> Error {
        Error::parse(self.path, message)
    }

    /// Takes memory for something that `user` asks for.
    ///
    /// # Errors
    /// When the scene would take more than in proportion to its files.
    pub fn spend(&self, bytes: u64, user: &str) -> Result<()> {
        if self.budget.borrow_mut().spend(bytes) {
            return Ok(());
        }
        Err(self.error(format!(
            "{user}: expands to far more than the file holds; if it is to be trusted, raise --max-expansion"
        )))
    }

    /// An error about another file, with who asks for it.
    fn asked_for(&self, user: &str, error: &Error) -> Error {
        self.error(format!("{user}: {error}"))
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
        let stride = view.byte_stride.map(|stride| stride.0);
        match Compressed::of(view) {
            None => {
                let start = view.byte_offset.unwrap_or_default().0;
                let slice = self.slice(view.buffer, start, view.byte_length.0, &name)?;
                Ok((slice, stride))
            }
            Some(compressed) => {
                let compressed = compressed
                    .map_err(|e| self.error(format!("{name}: its meshopt compression: {e}")))?;
                let own = compressed.is_strided().then_some(compressed.byte_stride);
                let bytes = self.decoded(index.value(), &compressed, &name)?;
                Ok((bytes, stride.or(own)))
            }
        }
    }

    /// A range [byte] of a buffer.
    fn slice(&self, buffer: Index<Buffer>, start: u64, length: u64, user: &str) -> Result<&[u8]> {
        let bytes = self.buffer(buffer, user)?;
        let slice = start
            .checked_add(length)
            .and_then(|end| bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
        slice.ok_or_else(|| {
            self.error(format!(
                "{user}: {length} bytes from byte {start} do not fit into the {} bytes of buffer {}",
                bytes.len(),
                buffer.value(),
            ))
        })
    }

    /// The bytes of a buffer view that meshoptimizer has compressed.
    fn decoded(&self, index: usize, compressed: &Compressed, name: &str) -> Result<&[u8]> {
        let cell = &self.decoded[index];
        if let Some(bytes) = cell.get() {
            return Ok(bytes);
        }
        let buffer = Index::new(u32::try_from(compressed.buffer).unwrap_or(u32::MAX));
        let (start, length) = (compressed.byte_offset, compressed.byte_length);
        let stream = self.slice(buffer, start, length, name)?;
        self.spend(compressed.size().unwrap_or(u64::MAX), name)?;
        let bytes = compressed.decode(stream).map_err(|e| {
            self.error(format!(
                "{name}: its meshopt compression cannot be undone: {e}"
            ))
        })?;
        Ok(cell.get_or_init(|| bytes))
    }

    /// The mesh that Draco has compressed into a buffer view, to which `user` refers.
    pub fn draco(&self, view: u32, user: &str) -> Result<&draco::Mesh> {
        let (stream, _) = self.view(Index::new(view), user)?;
        let cell = &self.meshes[view as usize];
        if let Some(mesh) = cell.get() {
            return Ok(mesh);
        }
        let most = self.budget.borrow().left();
        let mesh = draco::Mesh::decode(stream, most).map_err(|e| {
            self.error(format!(
                "{user}: its Draco compression cannot be undone: {e}"
            ))
        })?;
        self.spend(mesh.size(), user)?;
        Ok(cell.get_or_init(|| mesh))
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
    /// When the URI leaves the folder of the glTF and that is not allowed, or the data cannot be read.
    pub fn resource(&self, uri: &str, limit: u64, user: &str) -> Result<Vec<u8>> {
        if let Some(data) = data_of(uri) {
            return inline_data(data)
                .map_err(|what| self.error(format!("{user}: its data URI {what}")));
        }
        let path = self.resource_path(uri, user)?;
        let bytes = file::read_at_most(&path, limit).map_err(|e| self.asked_for(user, &e))?;
        // Buffers may name the same file over and over.
        if self.read.borrow_mut().insert(path) {
            self.budget.borrow_mut().earn(bytes.len());
        }
        self.spend(bytes.len() as u64, user)?;
        Ok(bytes)
    }

    /// The files of all buffers and images that it refers to, those too that nothing reads.
    pub fn files(&self) -> Vec<PathBuf> {
        let buffers = self
            .root
            .buffers
            .iter()
            .filter_map(|buffer| buffer.uri.as_ref());
        let images = self
            .root
            .images
            .iter()
            .filter_map(|image| image.uri.as_ref());
        let uris = buffers.chain(images).filter(|uri| data_of(uri).is_none());
        let named: BTreeSet<PathBuf> = uris
            .filter_map(|uri| Some(self.folder().join(NamedFile::new(uri)?.path)))
            .collect();
        named.into_iter().collect()
    }

    /// In which its other files lie.
    fn folder(&self) -> &Path {
        match self.path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        }
    }

    /// The file that a URI names, by its one real path.
    fn resource_path(&self, uri: &str, user: &str) -> Result<PathBuf> {
        let refused = |why: &str| {
            let short: String = uri.chars().take(80).collect();
            self.error(format!("{user}: refuses to read {short:?}, {why}"))
        };
        let named =
            NamedFile::new(uri).ok_or_else(|| refused("which names no file on this machine"))?;
        let folder = self.folder();
        if !self.outside_paths && !named.is_below() {
            return Err(refused(
                "which is not a path below the folder of the glTF; if it is to be trusted, pass --allow-outside-paths",
            ));
        }
        let real = |path: &Path| {
            let found = path.canonicalize().map_err(|e| Error::io(path, e));
            found.map_err(|e| self.asked_for(user, &e))
        };
        let path = real(&folder.join(&named.path))?;
        if !self.outside_paths && !path.starts_with(real(folder)?) {
            return Err(refused(
                "a link out of the folder of the glTF; if it is to be trusted, pass --allow-outside-paths",
            ));
        }
        Ok(path)
    }
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
