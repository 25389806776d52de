//! Reading accessors: ranges are checked once, when an accessor is opened; elements are read in place.

use gltf::json::accessor::{ComponentType, GenericComponentType, IndexComponentType, Type};
use gltf::json::validation::Checked;
use gltf::json::{Accessor as AccessorJson, Index};

use super::document::{Document, label};
use crate::Result;

/// A typed view of bytes. Elements before `count` can be read without further checks.
pub(super) struct Accessor<'a> {
    /// Without a buffer view: every element is zero unless `sparse` replaces it.
    dense: Option<Strided<'a>>,
    sparse: Option<Sparse<'a>>,
    component: ComponentType,
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
    /// Opens an accessor that `user` refers to and that must be of this type, with one of these
    /// component types (integers for a vector type must be normalized).
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
        let json = document.get(index, "accessor", user)?;
        let name = label("accessor", index.value(), json.name.as_deref());
        let component = match json.component_type {
            Checked::Valid(GenericComponentType(component))
                if json.type_ == Checked::Valid(shape)
                    && components.contains(&component)
                    && (shape == Type::Scalar
                        || component == ComponentType::F32
                        || json.normalized) =>
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
        let range = |view, offset: u64, count: u64, element: usize| {
            strided(document, view, offset, count, element, &name)
        };
        let dense = json
            .buffer_view
            .map(|view| {
                range(
                    view,
                    json.byte_offset.unwrap_or_default().0,
                    json.count.0,
                    element,
                )
            })
            .transpose()?;
        let sparse = json
            .sparse
            .as_ref()
            .map(|sparse| {
                let Checked::Valid(IndexComponentType(index_type)) = sparse.indices.component_type
                else {
                    return Err(
                        document.error(format!("{name}: its sparse indices have no valid type"))
                    );
                };
                let (indices, values, count) = (&sparse.indices, &sparse.values, sparse.count.0);
                Ok(Sparse {
                    indices: range(
                        indices.buffer_view,
                        indices.byte_offset.0,
                        count,
                        index_type.size(),
                    )?,
                    index_type,
                    values: range(values.buffer_view, values.byte_offset.0, count, element)?,
                    count: count as usize,
                })
            })
            .transpose()?;
        let count = usize::try_from(json.count.0)
            .map_err(|_| document.error(format!("{name}: holds too many elements")))?;
        Ok(Self {
            dense,
            sparse,
            component,
            count,
        })
    }

    /// The components of an element; integers are scaled to [0, 1].
    pub fn floats<const N: usize>(&self, index: usize) -> [f32; N] {
        let size = self.component.size();
        let Some(bytes) = self.element(index, N * size) else {
            return [0.0; N];
        };
        std::array::from_fn(|i| float(self.component, &bytes[i * size..][..size]))
    }

    /// An element that is an index.
    pub fn index(&self, index: usize) -> u32 {
        let bytes = self.element(index, self.component.size());
        bytes.map_or(0, integer)
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

impl Sparse<'_> {
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

fn float(component: ComponentType, bytes: &[u8]) -> f32 {
    match component {
        ComponentType::U8 => integer(bytes) as f32 / f32::from(u8::MAX),
        ComponentType::U16 => integer(bytes) as f32 / f32::from(u16::MAX),
        _ => f32::from_bits(integer(bytes)),
    }
}
