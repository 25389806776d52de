//! The shaders that `build.rs` compiled and embedded.

use crate::error::{Error, Result};

/// A compiled shader and its resources.
pub struct Shader {
    /// File name of the source.
    pub name: &'static str,
    /// SPIR-V.
    pub words: &'static [u8],
    pub bindings: &'static [Binding],
}

/// A resource as the shader names it.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    pub name: &'static str,
    pub binding: u32,
    pub kind: BindingKind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BindingKind {
    StorageBuffer,
    StorageImage,
    SampledImage,
}

/// Bytes with the alignment of SPIR-V's words.
#[repr(C, align(4))]
struct Aligned<T: ?Sized>(T);

macro_rules! words {
    ($file:literal) => {{
        static WORDS: &Aligned<[u8]> =
            &Aligned(*include_bytes!(concat!(env!("OUT_DIR"), "/", $file)));
        &WORDS.0
    }};
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

impl Shader {
    pub fn find(name: &str) -> Result<&'static Self> {
        SHADERS
            .iter()
            .find(|shader| shader.name == name)
            .ok_or_else(|| Error::Unsupported(format!("there is no shader {name}")))
    }
}
