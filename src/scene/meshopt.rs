//! Buffer views that meshoptimizer has compressed: EXT_meshopt_compression, and KHR_meshopt_compression, which is the same with a
//! newer stream of vertices and a filter for colours.

use gltf::json::buffer::View;
use meshoptimizer_rs::{Limits, Workspace, codec};
use serde::Deserialize;

/// What the extension says in the place of a buffer view.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Compressed {
    pub buffer: usize,
    #[serde(default)]
    pub byte_offset: u64,
    pub byte_length: u64,
    /// [byte] Of a decoded element.
    pub byte_stride: usize,
    pub count: usize,
    mode: Mode,
    #[serde(default)]
    filter: Filter,
}

#[derive(Deserialize, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

#[derive(Deserialize, Default, PartialEq)]
#[serde(rename_all = "UPPERCASE")]
enum Filter {
    #[default]
    None,
    Octahedral,
    Quaternion,
    Exponential,
    Color,
}

impl Compressed {
    /// None: the view is not compressed.
    pub fn of(view: &View) -> Option<Result<Self, serde_json::Error>> {
        let others = &view.extensions.as_ref()?.others;
        let json = ["EXT_meshopt_compression", "KHR_meshopt_compression"]
            .into_iter()
            .find_map(|name| others.get(name))?;
        Some(Self::deserialize(json))
    }

    /// [byte] When it is decoded; None: more than can be counted.
    pub fn size(&self) -> Option<u64> {
        (self.count as u64).checked_mul(self.byte_stride as u64)
    }

    /// Whether elements are vertices, with a stride.
    pub fn is_strided(&self) -> bool {
        self.mode == Mode::Attributes
    }

    /// The bytes of the view, from those of its stream.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn decode(&self, stream: &[u8]) -> Result<Vec<u8>, meshoptimizer_rs::Error> {
        let (count, stride) = (self.count, self.byte_stride);
        let limits = Limits {
            max_bytes: usize::MAX,
            max_work: u64::MAX,
        };
        let work = &mut Workspace::new(limits);
        let mut bytes = match self.mode {
            Mode::Attributes => codec::decode_vertex_buffer(count, stride, stream, work),
            Mode::Triangles => codec::decode_index_buffer(count, stride, stream, work),
            Mode::Indices => codec::decode_index_sequence(count, stride, stream, work),
        }?;
        match self.filter {
            Filter::None => Ok(()),
            Filter::Octahedral => codec::decode_filter_oct(&mut bytes, count, stride, work),
            Filter::Quaternion => codec::decode_filter_quat(&mut bytes, count, stride, work),
            Filter::Exponential => codec::decode_filter_exp(&mut bytes, count, stride, work),
            Filter::Color => codec::decode_filter_color(&mut bytes, count, stride, work),
        }?;
        Ok(bytes)
    }
}
