//! Materials and the textures they use.

use std::collections::HashMap;
use std::io::Cursor;

use glam::{Vec2, Vec4};
use gltf::json::material::AlphaMode;
use gltf::json::texture::{Info, MagFilter, MinFilter, Sampler, WrappingMode};
use gltf::json::validation::Checked;
use gltf::json::{Image, Index, Material as MaterialJson, Texture as TextureJson};
use image::{ImageFormat, ImageReader};

use super::document::{Document, label};
use super::notes::Notes;
use super::options::Limits;
use super::{Material, Texture, Wrap};
use crate::{Error, Result};

/// How a material reads its base-colour texture.
pub(super) struct TextureUse {
    /// n of TEXCOORD_n.
    pub set: u32,
    /// [texture widths, heights]
    offset: Vec2,
    scale: Vec2,
    /// [radian] Counter-clockwise as seen with the v axis pointing down.
    rotation: f32,
}

impl TextureUse {
    /// How the material of a primitive of mesh `user` reads its texture; None without one.
    ///
    /// # Errors
    /// When the material does not exist.
    pub fn of(
        document: &Document,
        material: Option<Index<MaterialJson>>,
        user: &str,
    ) -> Result<Option<Self>> {
        let Some(index) = material else {
            return Ok(None);
        };
        let material = document.get(index, "material", user)?;
        Ok(texture_info(document, material).map(|info| {
            let extensions = info.extensions.as_ref();
            let transform = extensions.and_then(|extensions| extensions.texture_transform.clone());
            let transform = transform.unwrap_or_default();
            Self {
                set: transform.tex_coord.unwrap_or(info.tex_coord),
                offset: transform.offset.0.into(),
                scale: transform.scale.0.into(),
                rotation: transform.rotation.0,
            }
        }))
    }

    /// Applies KHR_texture_transform: scale, then rotation, then offset.
    pub fn transform(&self, texcoord: Vec2) -> Vec2 {
        // The v axis points down, so a counter-clockwise turn is one by the negative angle.
        Vec2::from_angle(-self.rotation).rotate(texcoord * self.scale) + self.offset
    }
}

/// The base-colour texture of a material, if there is an image behind it.
fn texture_info<'a>(document: &Document, material: &'a MaterialJson) -> Option<&'a Info> {
    let info = material
        .pbr_metallic_roughness
        .base_color_texture
        .as_ref()?;
    // An extension for other image formats may leave the standard's own source empty.
    let empty = |texture: &TextureJson| texture.source.value() == u32::MAX as usize;
    let has_image = !document.root.get(info.index).is_some_and(empty);
    has_image.then_some(info)
}

/// What becomes of the triangles of a material.
#[derive(Clone, Copy)]
pub(super) enum Fate {
    /// Index into [`Materials::list`].
    Opaque(u32),
    /// Index into [`Materials::list`].
    Masked(u32),
    /// Nothing of the surface would remain.
    LeftOut,
}

/// The materials and textures that the triangles of a scene use, loaded when first asked for.
pub(super) struct Materials<'a> {
    document: &'a Document<'a>,
    max_texture_side: u32,
    texels_left: u64,
    fates: HashMap<Option<usize>, Fate>,
    /// Image, wrap modes and filter, to the index into `textures`.
    loaded: HashMap<(usize, [u32; 2], bool), usize>,
    pub list: Vec<Material>,
    pub textures: Vec<Texture>,
}

impl<'a> Materials<'a> {
    pub fn new(document: &'a Document<'a>, limits: &Limits) -> Self {
        Self {
            document,
            max_texture_side: limits.max_texture_side,
            texels_left: limits.max_texels,
            fates: HashMap::new(),
            loaded: HashMap::new(),
            list: Vec::new(),
            textures: Vec::new(),
        }
    }

    /// Takes over a material (None = glTF's default material), unless that happened before.
    ///
    /// # Errors
    /// When its texture cannot be read.
    pub fn fate(&mut self, index: Option<Index<MaterialJson>>, notes: &mut Notes) -> Result<Fate> {
        let key = index.map(|index| index.value());
        if let Some(&fate) = self.fates.get(&key) {
            return Ok(fate);
        }
        let fate = match index {
            None => self.push(&MaterialJson::default(), "default".into(), notes)?,
            Some(index) => {
                let json = self.document.get(index, "material", "a mesh")?;
                self.push(
                    json,
                    label("material", index.value(), json.name.as_deref()),
                    notes,
                )?
            }
        };
        self.fates.insert(key, fate);
        Ok(fate)
    }

    fn push(&mut self, json: &MaterialJson, name: String, notes: &mut Notes) -> Result<Fate> {
        let base_color = Vec4::from(json.pbr_metallic_roughness.base_color_factor.0);
        let base_color = base_color.clamp(Vec4::ZERO, Vec4::ONE);
        let info = texture_info(self.document, json);
        if info.is_none() && json.pbr_metallic_roughness.base_color_texture.is_some() {
            notes.add(
                "its texture has no PNG or JPEG image and is left out",
                &name,
            );
        }
        let mut alpha_cutoff = None;
        match json.alpha_mode {
            Checked::Valid(AlphaMode::Mask) => {
                let cutoff = json.alpha_cutoff.unwrap_or_default().0;
                // A texture can only lower the alpha.
                if base_color.w < cutoff {
                    notes.add(
                        "its alpha is below its cutoff; its triangles are left out",
                        &name,
                    );
                    return Ok(Fate::LeftOut);
                }
                if info.is_some() && cutoff > 0.0 {
                    alpha_cutoff = Some(cutoff);
                }
            }
            Checked::Valid(AlphaMode::Blend) => {
                notes.add("alphaMode BLEND is not supported; it is opaque", &name);
            }
            Checked::Valid(AlphaMode::Opaque) => {}
            Checked::Invalid => notes.add("its alphaMode is invalid; it is opaque", &name),
        }
        let texture = match info {
            Some(info) => Some(self.texture(info, &name)?),
            None => None,
        };
        let index = self.list.len() as u32;
        self.list.push(Material {
            name: json.name.clone().unwrap_or(name),
            base_color,
            texture,
            alpha_cutoff,
            double_sided: json.double_sided,
        });
        Ok(match alpha_cutoff {
            Some(_) => Fate::Masked(index),
            None => Fate::Opaque(index),
        })
    }

    fn texture(&mut self, info: &Info, user: &str) -> Result<usize> {
        let document = self.document;
        let texture = document.get(info.index, "texture", user)?;
        let sampler = match texture.sampler {
            Some(index) => document.get(index, "sampler", user)?.clone(),
            None => Sampler::default(),
        };
        let wrap = [wrap(sampler.wrap_s), wrap(sampler.wrap_t)];
        let linear = match (sampler.mag_filter, sampler.min_filter) {
            (Some(filter), _) => filter != Checked::Valid(MagFilter::Nearest),
            (None, filter) => filter != Some(Checked::Valid(MinFilter::Nearest)),
        };
        let key = (texture.source.value(), wrap.map(|wrap| wrap as u32), linear);
        if let Some(&known) = self.loaded.get(&key) {
            return Ok(known);
        }
        let (width, height, rgba) = self.image(texture.source, user)?;
        self.textures.push(Texture {
            width,
            height,
            rgba,
            wrap,
            linear,
        });
        self.loaded.insert(key, self.textures.len() - 1);
        Ok(self.textures.len() - 1)
    }

    fn image(&mut self, index: Index<Image>, user: &str) -> Result<(u32, u32, Vec<u8>)> {
        let document = self.document;
        let json = document.get(index, "image", user)?;
        let name = label("image", index.value(), json.name.as_deref());
        match (&json.uri, json.buffer_view) {
            (Some(uri), _) => {
                // No format takes more for a texel than four channels of 16 bits.
                let longest = self.texels_left.saturating_mul(8).saturating_add(1 << 20);
                self.decode(&document.resource(uri, longest, &name)?, &name)
            }
            (None, Some(view)) => self.decode(document.view(view, &name)?.0, &name),
            (None, None) => {
                Err(document.error(format!("{name}: has neither a uri nor a buffer view")))
            }
        }
    }

    fn decode(&mut self, bytes: &[u8], name: &str) -> Result<(u32, u32, Vec<u8>)> {
        let broken = |e: image::ImageError| -> Error {
            self.document
                .error(format!("{name}: cannot be decoded: {e}"))
        };
        let format = match image::guess_format(bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg)) => format,
            _ => {
                return Err(self
                    .document
                    .error(format!("{name}: is neither PNG nor JPEG")));
            }
        };
        let reader = || ImageReader::with_format(Cursor::new(bytes), format);
        let (width, height) = reader().into_dimensions().map_err(broken)?;
        let texels = u64::from(width) * u64::from(height);
        if width.max(height) > self.max_texture_side || texels > self.texels_left {
            return Err(self.document.error(format!(
                "{name}: its {width}×{height} texels exceed the limit on textures ({0}×{0}, {1} texels left); \
                 raise --max-texture-side or --max-texels",
                self.max_texture_side, self.texels_left
            )));
        }
        self.document.spend(texels * 4, name)?;
        let mut limits = image::Limits::no_limits();
        // At most 16 bits for each of four channels, and as much again for the decoder.
        limits.max_alloc = Some(texels * 16 + (64 << 20));
        let mut reader = reader();
        reader.limits(limits);
        let rgba = reader.decode().map_err(broken)?.into_rgba8().into_raw();
        self.texels_left -= texels;
        Ok((width, height, rgba))
    }
}

fn wrap(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    }
}
