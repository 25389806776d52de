//! Reading accessors: ranges are checked once, when an accessor is opened; elements are read in place.

use gltf::json::accessor::sparse::Sparse as SparseJson;
use gltf::json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Accessor as AccessorJson, Index};

use super::document::{Document, label};
use super::draco;
use crate::Result;

/// A typed view of bytes. Elements before `count` can be read without further checks.
pub(super) struct Accessor<'a> {
    /// Without a buffer view: every element is zero unless `sparse` replaces it.
    dense: Option<Strided<'a>>,
    sparse: Option<Sparse<'a>>,
    component: ComponentType,
    /// Integers stand for shares of the largest one.
    normalized: bool,
    pub count: usize,
}

/// Elements at regular distances.
struct Strided<'a> {
    bytes: &'a [u8],
    /// [byte] From the start of one element to the start of the next.
    stride: usize,
}

/// Elements that replace those of the dense part.
struct Sparse<'a> {
    indices: Strided<'a>,
    index_type: ComponentType,
    values: Strided<'a>,
    count: usize,
}

impl<'a> Accessor<'a> {
    /// Opens an accessor that `user` refers to and that must be of this type, with one of these component types. Integers
    /// must be normalized where the file does not use KHR_mesh_quantization.
    ///
    /// # Errors
    /// When it is of another type or reaches beyond its buffer view.
    pub fn open(
        document: &'a Document,
        index: Index<AccessorJson>,
        shape: Type,
        components: &[ComponentType],
        user: &str,
    ) -> Result<Self> {
        let accessor = Self::open_integers(document, index, shape, components, user)?;
        let is_float = accessor.component == ComponentType::F32;
        if is_float || accessor.normalized || document.is_quantized() {
            return Ok(accessor);
        }
        Err(document.error(format!(
            "accessor {}: {user} must be normalized, or the file must use KHR_mesh_quantization",
            index.value()
        )))
    }

    /// As [`Self::open`]; integers stand for themselves.
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_integers(
        document: &'a Document,
        index: Index<AccessorJson>,
        shape: Type,
        components: &[ComponentType],
        user: &str,
    ) -> Result<Self> {
        let json = document.get(index, "accessor", user)?;
        let name = label("accessor", index.value(), json.name.as_deref());
        let component = match json.component_type {
            Checked::Valid(GenericComponentType(component))
                if json.type_ == Checked::Valid(shape) && components.contains(&component) =>
            {
                component
            }
            _ => {
                return Err(document.error(format!(
                    "{name}: {user} must be {shape:?} of {}",
                    components
                        .iter()
                        .map(|component| format!("{component:?}"))
                        .collect::<Vec<_>>()
                        .join(" or ")
                )));
            }
        };
        let element = component.size() * shape.multiplicity();
        let offset = json.byte_offset.unwrap_or_default().0;
        let dense = json
            .buffer_view
            .map(|view| strided(document, view, offset, json.count.0, element, &name))
            .transpose()?;
        let sparse = json
            .sparse
            .as_ref()
            .map(|sparse| Sparse::open(document, sparse, element, &name))
            .transpose()?;
        let count = usize::try_from(json.count.0)
            .map_err(|_| document.error(format!("{name}: holds too many elements")))?;
        Ok(Self {
            dense,
            sparse,
            component,
            normalized: json.normalized,
            count,
        })
    }

    /// Opens an attribute that was compressed, as [`Self::open`] and [`Self::open_integers`] do with those that were not.
    ///
    /// # Errors
    /// When it is of another type.
    pub fn decoded(
        document: &'a Document,
        index: Index<AccessorJson>,
        attribute: &'a draco::Attribute,
        shape: Type,
        components: &[ComponentType],
        user: &str,
    ) -> Result<Self> {
        let json = document.get(index, "accessor", user)?;
        let fits = |component: &ComponentType| {
            components.contains(component) && attribute.components == shape.multiplicity()
        };
        let component = attribute.component.filter(fits).ok_or_else(|| {
            document.error(format!(
                "{user} is of a type in its Draco stream that it must not have"
            ))
        })?;
        let stride = component.size() * attribute.components;
        Ok(Self {
            dense: Some(Strided {
                bytes: &attribute.bytes,
                stride,
            }),
            sparse: None,
            component,
            normalized: json.normalized,
            count: attribute.bytes.len() / stride,
        })
    }

    /// Opens the indices of a mesh that was compressed.
    pub fn decoded_indices(mesh: &'a draco::Mesh) -> Self {
        const STRIDE: usize = size_of::<u32>();
        Self {
            dense: Some(Strided {
                bytes: &mesh.indices,
                stride: STRIDE,
            }),
            sparse: None,
            component: ComponentType::U32,
            normalized: false,
            count: mesh.indices.len() / STRIDE,
        }
    }

    /// The components of an element; normalized integers are scaled to [0, 1] or [-1, 1].
    pub fn floats<const N: usize>(&self, index: usize) -> [f32; N] {
        let size = self.component.size();
        let Some(bytes) = self.element(index, N * size) else {
            return [0.0; N];
        };
        std::array::from_fn(|i| float(self.component, self.normalized, &bytes[i * size..][..size]))
    }

    /// An element that is an index.
    pub fn index(&self, index: usize) -> u32 {
        let bytes = self.element(index, self.component.size());
        bytes.map_or(0, integer)
    }

    /// The components of an element that holds indices.
    pub fn indices<const N: usize>(&self, index: usize) -> [u32; N] {
        let size = self.component.size();
        let Some(bytes) = self.element(index, N * size) else {
            return [0; N];
        };
        std::array::from_fn(|i| integer(&bytes[i * size..][..size]))
    }

    /// The bytes of an element; None = all zero.
    fn element(&self, index: usize, size: usize) -> Option<&'a [u8]> {
        let replaced = self.sparse.as_ref().and_then(|sparse| {
            let slot = sparse.find(index)?;
            Some(sparse.values.element(slot, size))
        });
        replaced.or_else(|| Some(self.dense.as_ref()?.element(index, size)))
    }
}

impl<'a> Sparse<'a> {
    /// Opens the sparse part of the accessor `name`, whose elements are `element` [byte] wide.
    fn open(document: &'a Document, json: &SparseJson, element: usize, name: &str) -> Result<Self> {
        let (indices, values, count) = (&json.indices, &json.values, json.count.0);
        let Checked::Valid(IndexComponentType(index_type)) = indices.component_type else {
            return Err(document.error(format!("{name}: its sparse indices have no valid type")));
        };
        let range = |view, offset: USize64, element| {
            strided(document, view, offset.0, count, element, name)
        };
        Ok(Self {
            indices: range(indices.buffer_view, indices.byte_offset, index_type.size())?,
            index_type,
            values: range(values.buffer_view, values.byte_offset, element)?,
            count: count as usize,
        })
    }

    /// Where among the values the replacement of an element stands. (The indices increase strictly, says
    /// glTF; where they do not, some replacements are not found.)
    fn find(&self, index: usize) -> Option<usize> {
        let size = self.index_type.size();
        let at = |slot| integer(self.indices.element(slot, size)) as usize;
        let (mut low, mut high) = (0, self.count);
        while low < high {
            let middle = low + (high - low) / 2;
            match at(middle).cmp(&index) {
                std::cmp::Ordering::Less => low = middle + 1,
                std::cmp::Ordering::Equal => return Some(middle),
                std::cmp::Ordering::Greater => high = middle,
            }
        }
        None
    }
}

impl<'a> Strided<'a> {
    fn element(&self, index: usize, size: usize) -> &'a [u8] {
        &self.bytes[index * self.stride..][..size]
    }
}

/// `count` elements of `element` [byte] each, `offset` [byte] into a buffer view.
fn strided<'a>(
    document: &'a Document,
    view: Index<gltf::json::buffer::View>,
    offset: u64,
    count: u64,
    element: usize,
    name: &str,
) -> Result<Strided<'a>> {
    let (bytes, stride) = document.view(view, name)?;
    let stride = stride.unwrap_or(element);
    if stride < element {
        return Err(document.error(format!(
            "{name}: its elements of {element} bytes are wider than the stride {stride} of buffer view {}",
            view.value()
        )));
    }
    let end = match count.checked_sub(1) {
        None => Some(offset),
        Some(last) => last
            .checked_mul(stride as u64)
            .and_then(|start| start.checked_add(offset)?.checked_add(element as u64)),
    };
    match end {
        Some(end) if end <= bytes.len() as u64 => Ok(Strided {
            bytes: &bytes[offset as usize..],
            stride,
        }),
        _ => {
            let beyond = end.map_or("far".into(), |end| {
                format!("{} bytes", end - bytes.len() as u64)
            });
            Err(document.error(format!(
                "{name}: reads {beyond} beyond the end of buffer view {}",
                view.value()
            )))
        }
    }
}

fn integer(bytes: &[u8]) -> u32 {
    bytes
        .iter()
        .rev()
        .fold(0, |value, &byte| value << 8 | u32::from(byte))
}

/// As glTF reads it [glTF 2.0 §3.11]: a normalized signed integer is at least -1.
fn float(component: ComponentType, normalized: bool, bytes: &[u8]) -> f32 {
    let bits = integer(bytes);
    let (value, largest) = match component {
        ComponentType::I8 => (f32::from(bits as u8 as i8), f32::from(i8::MAX)),
        ComponentType::I16 => (f32::from(bits as u16 as i16), f32::from(i16::MAX)),
        ComponentType::U8 => (bits as f32, f32::from(u8::MAX)),
        ComponentType::U16 => (bits as f32, f32::from(u16::MAX)),
        ComponentType::U32 => (bits as f32, u32::MAX as f32),
        ComponentType::F32 => return f32::from_bits(bits),
    };
    match normalized {
        true => (value / largest).max(-1.0),
        false => value,
    }
}
