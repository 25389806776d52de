//! A shot to measure on, with its truth.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use crate::compare::faces_wholly;
use crate::image::{MAX_SAMPLES, Plane, is_same_file, read_exr, write_exr};
use crate::number::sum;
use crate::reference::{ReferenceImage, ReferenceOptions, trace};
use crate::scene::Texture;
use crate::shot::{Overrides, Shot};
use crate::{Error, Result};

/// Channels of a stored truth.
const CHANNELS: [&str; 3] = ["Y", "facing", "stderr"];

/// A shot and what is true of it.
#[derive(Debug)]
pub struct Subject {
    /// Name of the file without its ending.
    pub name: String,
    /// As given on the command line.
    pub file: String,
    pub shot: Shot,
    /// Hash of all that the shot shows.
    pub content: String,
    /// Rays per pixel of the truth.
    pub truth_samples: u32,
    /// The truth about all lights, one below the other: an image of width × (lights · height).
    pub visibility: Plane,
    /// Likewise the share of each light that is in front of the surface.
    pub facing: Plane,
    /// Likewise the standard error of the visibility.
    pub standard_error: Plane,
}

impl Subject {
    /// Reads a shot and its truth, which is traced if `cache` does not hold it yet.
    ///
    /// `progress` is called with the share of the tracing that is done; setting `cancel` ends it.
    ///
    /// # Errors
    /// The shot cannot be read or traced, or `cancel` was set.
    pub fn load(
        file: &Path,
        overrides: &Overrides,
        cache: &Path,
        options: ReferenceOptions,
        progress: &(dyn Fn(f64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<Self> {
        let shot = Shot::load(file, overrides)?;
        let name = Self::name_of(file);
        Self::of_shot(&name, file, shot, cache, options, progress, cancel)
    }

    /// The standard error of the truth, on the mean over shadow pixels that face the whole light; 0 without any. A mean
    /// absolute error of this size is the truth's own.
    pub fn noise(&self) -> f64 {
        let (truths, facing) = (&self.visibility.data, &self.facing.data);
        let pixels = truths.iter().zip(facing).zip(&self.standard_error.data);
        let counted = pixels.filter(|((truth, facing), _)| **truth < 1.0 && faces_wholly(**facing));
        let errors: Vec<f64> = counted.map(|(_, error)| f64::from(*error)).collect();
        sum(errors.iter().copied()) / errors.len().max(1) as f64
    }

    /// What the shot of a file is called.
    pub fn name_of(file: &Path) -> String {
        let stem = file.file_stem().unwrap_or(file.as_os_str());
        stem.to_string_lossy().into_owned()
    }

    /// Like [`Self::load`], of a shot that is in memory and known as `name`.
    ///
    /// # Errors
    /// It cannot be traced, the truth would be kept in a file that the shot is read from, or `cancel` was set.
    pub fn of_shot(
        name: &str,
        file: &Path,
        shot: Shot,
        cache: &Path,
        options: ReferenceOptions,
        progress: &(dyn Fn(f64) + Sync),
        cancel: &AtomicBool,
    ) -> Result<Self> {
        let content = content_hash(&shot);
        let lights = shot.lights.len();
        let mut images = Vec::new();
        for light in 0..lights {
            let share = |done| progress((light as f64 + done) / lights as f64);
            let file = truth_file(cache, &content, light, options);
            check_apart(&file, &shot)?;
            images.push(cached_truth(&file, &shot, light, options, &share, cancel)?);
        }
        let stacked = |plane: fn(&ReferenceImage) -> &Plane| {
            let data = images.iter().flat_map(|image| plane(image).data.clone());
            Plane::new(
                shot.width as usize,
                lights * shot.height as usize,
                data.collect(),
            )
        };
        Ok(Self {
            name: name.into(),
            file: file.display().to_string(),
            content,
            truth_samples: options.samples,
            visibility: stacked(|image| &image.visibility)?,
            facing: stacked(|image| &image.facing)?,
            standard_error: stacked(|image| &image.standard_error)?,
            shot,
        })
    }
}

fn check_apart(truth: &Path, shot: &Shot) -> Result<()> {
    match shot
        .scene
        .files
        .iter()
        .find(|file| is_same_file(file, truth))
    {
        Some(file) => Err(Error::Invalid(format!(
            "{} is read, so no truth is kept there; name another folder for truths",
            file.display()
        ))),
        None => Ok(()),
    }
}

fn truth_file(cache: &Path, content: &str, light: usize, options: ReferenceOptions) -> PathBuf {
    let ReferenceOptions { samples, seed } = options;
    cache.join(format!("{content}-{light}-{samples}-{seed}.exr"))
}

/// The truth as `file` has it; otherwise traced, and kept there.
fn cached_truth(
    file: &Path,
    shot: &Shot,
    light: usize,
    options: ReferenceOptions,
    progress: &(dyn Fn(f64) + Sync),
    cancel: &AtomicBool,
) -> Result<ReferenceImage> {
    if let Some(image) = stored_truth(file, shot) {
        return Ok(image);
    }
    let image = trace(shot, light, options, progress, cancel)?;
    let folder = file.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
    let planes = [&image.visibility, &image.facing, &image.standard_error];
    let channels: Vec<(&str, &Plane)> = CHANNELS.into_iter().zip(planes).collect();
    write_exr(file, &channels)?;
    Ok(image)
}

/// None: it is not there, or is not what was once written, and is traced anew.
fn stored_truth(file: &Path, shot: &Shot) -> Option<ReferenceImage> {
    let mut channels = read_exr(file, MAX_SAMPLES).ok()?;
    let mut take = |wanted: &str| {
        let index = channels.iter().position(|(name, _)| name == wanted)?;
        let plane = channels.remove(index).1;
        ((plane.width, plane.height) == (shot.width as usize, shot.height as usize))
            .then_some(plane)
    };
    Some(ReferenceImage {
        visibility: take(CHANNELS[0])?,
        facing: take(CHANNELS[1])?,
        standard_error: take(CHANNELS[2])?,
    })
}

/// A hash of everything that decides what a shot shows, its settings apart.
pub fn content_hash(shot: &Shot) -> String {
    let scene = &shot.scene;
    let mut hasher = blake3::Hasher::new();
    let mut add = |bytes: &[u8]| {
        hasher.update(&(bytes.len() as u64).to_le_bytes());
        hasher.update(bytes);
    };
    add(bytemuck::cast_slice(&scene.positions));
    add(bytemuck::cast_slice(&scene.texcoords));
    add(bytemuck::cast_slice(&scene.triangles));
    add(bytemuck::cast_slice(&scene.triangle_materials));
    for texture in &scene.textures {
        add(&texture.rgba);
        let description = Texture {
            rgba: Vec::new(),
            ..texture.clone()
        };
        add(format!("{description:?}").as_bytes());
    }
    // What is small, by all its fields: the text of a number gives all its digits.
    let small = (scene.opaque_count, &scene.casts, &scene.materials);
    add(format!("{small:?}").as_bytes());
    let view = (&shot.camera, shot.width, shot.height, &shot.lights);
    add(format!("{view:?}").as_bytes());
    hasher.finalize().to_hex()[..16].to_owned()
}
