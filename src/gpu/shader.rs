//! The shaders that `build.rs` compiled and embedded.

use std::collections::BTreeMap;

use crate::error::{Error, Result};

/// Values of specialization constants by name. A shader takes those that it uses; its others keep their defaults.
pub type Constants = BTreeMap<&'static str, u32>;

/// Those of the constants that some of these shaders use: what tells pipelines of the same shaders apart.
///
/// # Errors
/// There is no shader of such a name.
pub fn used(constants: &Constants, shaders: &[&str]) -> Result<Constants> {
    let mut used = Constants::new();
    for shader in shaders {
        let names = Shader::find(shader)?.constants.iter();
        used.extend(names.filter_map(|(name, _)| constants.get_key_value(name)));
    }
    Ok(used)
}

/// Whether some shader uses a constant of this name.
pub fn is_constant(name: &str) -> bool {
    let mut all = SHADERS.iter().flat_map(|shader| shader.constants);
    all.any(|(known, _)| *known == name)
}

/// A compiled shader and its resources.
pub struct Shader {
    /// File name of the source.
    pub name: &'static str,
    /// SPIR-V.
    pub words: &'static [u8],
    pub bindings: &'static [Binding],
    /// Specialization constants that it uses: name and id.
    pub constants: &'static [(&'static str, u32)],
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

    /// Those of the constants that it has, by id.
    pub fn constants_by_id(&self, constants: &Constants) -> Vec<(u32, u32)> {
        let id = |name: &str| self.constants.iter().find(|(known, _)| *known == name);
        let by_id = |(name, value): (&&'static str, &u32)| Some((id(name)?.1, *value));
        constants.iter().filter_map(by_id).collect()
    }
}
