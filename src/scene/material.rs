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
use super::extensions::{unread_image, unread_texture};
use super::notes::Notes;
use super::options::{Blend, LoadOptions};
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
        Ok(texture_info(material).map(|info| {
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

/// The base-colour texture of a material.
fn texture_info(material: &MaterialJson) -> Option<&Info> {
    let base_color = &material.pbr_metallic_roughness;
    base_color.base_color_texture.as_ref()
}

/// The image of a texture: in WebP where there is one [EXT_texture_webp], for who brings it means it.
fn image_of(texture: &TextureJson) -> Option<Index<Image>> {
    let extensions = texture.extensions.as_ref();
    let webp = extensions.and_then(|extensions| extensions.others.get("EXT_texture_webp"));
    let source = webp.and_then(|json| json.get("source")?.as_u64());
    match source {
        Some(source) => Some(Index::new(u32::try_from(source).ok()?)),
        // An extension for other formats may leave the standard's own source empty.
        None => (texture.source.value() != u32::MAX as usize).then_some(texture.source),
    }
}

/// What a texture is that has no image to read.
fn without_image(texture: &TextureJson) -> &'static str {
    let extensions = texture.extensions.iter();
    let names = extensions.flat_map(|extensions| extensions.others.keys());
    unread_texture(names).unwrap_or("has no image in PNG, JPEG or WebP")
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

/// What a material's alpha means to shadows.
enum Alpha {
    Opaque,
    /// Light passes where it is 0.
    Blended,
    /// Light passes where it is lower.
    Cut(f32),
    LeftOut,
}

/// Why there is no texture.
enum Fault {
    /// Flags can raise it.
    Limit(Error),
    Unreadable(Error),
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Self::Unreadable(error)
    }
}

/// [texel] Width, height, and RGBA of 8 bits each.
type Texels = (u32, u32, Vec<u8>);

/// The materials and textures that the triangles of a scene use, loaded when first asked for.
pub(super) struct Materials<'a> {
    document: &'a Document<'a>,
    blend: Blend,
    allow_missing: bool,
    max_texture_side: u32,
    texels_left: u64,
    fates: HashMap<Option<usize>, Fate>,
    /// Image, wrap modes and filter, to the index into `textures`.
    loaded: HashMap<(usize, [u32; 2], bool), usize>,
    pub list: Vec<Material>,
    pub textures: Vec<Texture>,
    /// Of the texels of each.
    least_alphas: Vec<u8>,
}

impl<'a> Materials<'a> {
    pub fn new(document: &'a Document<'a>, options: &LoadOptions) -> Self {
        Self {
            document,
            blend: options.blend,
            allow_missing: options.allow_missing,
            max_texture_side: options.limits.max_texture_side,
            texels_left: options.limits.max_texels,
            fates: HashMap::new(),
            loaded: HashMap::new(),
            list: Vec::new(),
            textures: Vec::new(),
            least_alphas: Vec::new(),
        }
    }

    /// Takes over a material (None = glTF's default material), unless that happened before.
    ///
    /// # Errors
    /// When its texture decides where light passes and cannot be read, or exceeds a limit.
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
        let (cutoff, needed) = match self.alpha(json, base_color.w, &name, notes) {
            Alpha::Opaque => (0.0, false),
            Alpha::Blended => (0.5 / 255.0 * base_color.w, false),
            Alpha::Cut(cutoff) => (cutoff, cutoff > 0.0),
            Alpha::LeftOut => return Ok(Fate::LeftOut),
        };
        let texture = match texture_info(json) {
            Some(info) => self.texture_or_note(info, &name, needed, notes)?,
            None => None,
        };
        // Where no texel is below the cutoff there is nothing to test.
        let least = |index: usize| f32::from(self.least_alphas[index]) / 255.0;
        let has_holes = texture.is_some_and(|index| least(index) * base_color.w < cutoff);
        let alpha_cutoff = has_holes.then_some(cutoff);
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

    /// What a material's alpha means to shadows. `most`: its largest; a texture can only lower it.
    fn alpha(&self, json: &MaterialJson, most: f32, name: &str, notes: &mut Notes) -> Alpha {
        let cutoff = json.alpha_cutoff.unwrap_or_default().0;
        let (alpha, note) = match (json.alpha_mode, self.blend) {
            (Checked::Valid(AlphaMode::Mask), _) => (Alpha::Cut(cutoff), None),
            (Checked::Valid(AlphaMode::Blend), Blend::Opaque) if most > 0.0 => (
                Alpha::Blended,
                Some(
                    "alphaMode BLEND is opaque but where its alpha is 0; --blend ignore leaves it out, --blend mask \
                     cuts it at its alphaCutoff",
                ),
            ),
            (Checked::Valid(AlphaMode::Blend), Blend::Opaque) => (
                Alpha::LeftOut,
                Some("its alpha is 0; its triangles are left out"),
            ),
            (Checked::Valid(AlphaMode::Blend), Blend::Mask) => (
                Alpha::Cut(cutoff),
                Some("alphaMode BLEND is cut at its alphaCutoff (--blend mask)"),
            ),
            (Checked::Valid(AlphaMode::Blend), Blend::Ignore) => (
                Alpha::LeftOut,
                Some("alphaMode BLEND is left out (--blend ignore)"),
            ),
            (Checked::Valid(AlphaMode::Opaque), _) => (Alpha::Opaque, None),
            (Checked::Invalid, _) => (
                Alpha::Opaque,
                Some("its alphaMode is invalid; it is opaque"),
            ),
        };
        if let Some(note) = note {
            notes.add(note, name);
        }
        match alpha {
            Alpha::Cut(cutoff) if most < cutoff => {
                let what = "its alpha is below its cutoff; its triangles are left out";
                notes.add(what, name);
                Alpha::LeftOut
            }
            alpha => alpha,
        }
    }

    /// A texture, or None where it cannot be read and shadows can do without.
    fn texture_or_note(
        &mut self,
        info: &Info,
        name: &str,
        needed: bool,
        notes: &mut Notes,
    ) -> Result<Option<usize>> {
        match self.texture(info, name) {
            Ok(index) => Ok(Some(index)),
            Err(Fault::Limit(error)) => Err(error),
            Err(Fault::Unreadable(error)) if needed && !self.allow_missing => {
                Err(self.document.error(format!(
                    "{name}: where light passes it depends on a texture that cannot be read ({error}); \
                     repair it, or pass --allow-missing to take the material as opaque"
                )))
            }
            Err(Fault::Unreadable(error)) => {
                let what = match needed {
                    true => "its texture cannot be read; it is opaque, in a flat colour (--allow-missing)",
                    false => "its texture cannot be read; it has a flat colour",
                };
                notes.add(what, &format!("{name} ({error})"));
                Ok(None)
            }
        }
    }

    fn texture(&mut self, info: &Info, user: &str) -> std::result::Result<usize, Fault> {
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
        let source = image_of(texture).ok_or_else(|| {
            let label = label("texture", info.index.value(), texture.name.as_deref());
            document.error(format!("{label}: {}", without_image(texture)))
        })?;
        let key = (source.value(), wrap.map(|wrap| wrap as u32), linear);
        if let Some(&known) = self.loaded.get(&key) {
            return Ok(known);
        }
        let (width, height, rgba) = self.image(source, user)?;
        let alphas = rgba.chunks_exact(4).map(|texel| texel[3]);
        self.least_alphas.push(alphas.min().unwrap_or(u8::MAX));
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

    fn image(&mut self, index: Index<Image>, user: &str) -> std::result::Result<Texels, Fault> {
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
                Err(document.error(format!("{name}: has neither a uri nor a buffer view")))?
            }
        }
    }

    fn decode(&mut self, bytes: &[u8], name: &str) -> std::result::Result<Texels, Fault> {
        let broken = |e: image::ImageError| -> Error {
            self.document
                .error(format!("{name}: cannot be decoded: {e}"))
        };
        let format = match image::guess_format(bytes) {
            Ok(format @ (ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)) => format,
            _ => {
                let what = unread_image(bytes).unwrap_or("is not in PNG, JPEG or WebP");
                Err(self.document.error(format!("{name}: {what}")))?
            }
        };
        let reader = || ImageReader::with_format(Cursor::new(bytes), format);
        let (width, height) = reader().into_dimensions().map_err(broken)?;
        let texels = u64::from(width) * u64::from(height);
        if width.max(height) > self.max_texture_side || texels > self.texels_left {
            return Err(Fault::Limit(self.document.error(format!(
                "{name}: its {width}×{height} texels exceed the limit on textures ({0}×{0}, {1} texels left); \
                 raise --max-texture-side or --max-texels",
                self.max_texture_side, self.texels_left
            ))));
        }
        let room = self.document.spend(texels * 4, name);
        room.map_err(Fault::Limit)?;
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
