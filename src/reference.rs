//! Ray-traced truth: the visibility of an area light by shadow rays to points on it.

pub(crate) mod bvh;
mod light_sampler;
pub(crate) mod pinhole;
mod texture;

use std::ops::RangeInclusive;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use glam::{DVec3, Vec2};
use rayon::prelude::*;

use crate::image::Plane;
use crate::scene::{Ball, Scene};
use crate::shot::Shot;
use crate::{Error, Result};
use bvh::{Bvh, Hit, Ray};
use light_sampler::Emitter;
use pinhole::Pinhole;

/// Independent randomisations of the points on the light in each pixel. Their spread gives the
/// standard error, with 7 degrees of freedom; more of them would make the image itself noisier, since
/// only the points within one are evenly spread.
pub const BATCHES: u32 = 8;

/// How far a shadow ray starts from its surface, along the normal of its visible side, per largest
/// coordinate of the point, seen from the eye: 8 times the rounding of f32 coordinates there. Nearer occluders
/// cannot be told from the surface itself.
const OFFSET: f64 = 1.0 / (1 << 21) as f64;

/// Shadow rays per pixel that can be asked for.
pub const SAMPLES: RangeInclusive<u32> = 16..=65536;

/// How well to trace.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReferenceOptions {
    /// In [`SAMPLES`]. Shadow rays per pixel, rounded up to a multiple of [`BATCHES`].
    pub samples: u32,
    /// Another seed gives another image with independent noise.
    pub seed: u64,
}

impl Default for ReferenceOptions {
    fn default() -> Self {
        Self {
            samples: 1024,
            seed: 0,
        }
    }
}

/// The truth about one light, NaN where a pixel sees no surface.
#[derive(Debug, Clone)]
pub struct ReferenceImage {
    /// [0, 1] The unoccluded share of the light's area, 0 where `facing` is 0. Area below the
    /// receiver's horizon is not counted as occluded.
    pub visibility: Plane,
    /// [0, 1] The share of the light's area that is in front of the surface's visible side, exact; 0
    /// for surfaces behind the light.
    pub facing: Plane,
    /// Standard error of `visibility`: from the variance of the means of the [`BATCHES`] batches, each
    /// an independently Owen-scrambled Sobol sequence. (The binomial estimate would be several times
    /// too large, for the points within a batch are not independent.) Its square is an unbiased estimate; 0
    /// does not mean "exact" where all batches happen to agree.
    pub standard_error: Plane,
}

/// Traces the visibility of light `light` in every pixel's centre, in parallel; the image is the
/// same for any number of threads.
///
/// `progress` is called from any thread with the share that is done. Setting `cancel` ends the work
/// within a few pixels.
///
/// # Errors
/// When the samples are out of range, when the shot lacks the light or has no pixels, when camera
/// or light are degenerate, or when cancelled.
pub fn trace(
    shot: &Shot,
    light: usize,
    options: ReferenceOptions,
    progress: &(dyn Fn(f64) + Sync),
    cancel: &AtomicBool,
) -> Result<ReferenceImage> {
    let tracer = Tracer::new(shot, light, options)?;
    let (width, height) = (shot.width as usize, shot.height as usize);
    let done = AtomicUsize::new(0);
    let row = |y: usize| -> Result<Vec<Pixel>> {
        let mut scratch = Scratch::default();
        let pixel = |x| match cancel.load(Ordering::Relaxed) {
            true => Err(Error::Interrupted),
            false => Ok(tracer.pixel(x, y, &mut scratch)),
        };
        let pixels = (0..width).map(pixel).collect();
        progress((done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / height as f64);
        pixels
    };
    let rows: Vec<Vec<Pixel>> = (0..height)
        .into_par_iter()
        .map(row)
        .collect::<Result<_>>()?;
    let plane = |value: fn(&Pixel) -> f64| {
        Plane::new(
            width,
            height,
            rows.iter()
                .flatten()
                .map(|pixel| value(pixel) as f32)
                .collect(),
        )
    };
    Ok(ReferenceImage {
        visibility: plane(|pixel| pixel.visibility)?,
        facing: plane(|pixel| pixel.facing)?,
        standard_error: plane(|pixel| pixel.standard_error)?,
    })
}

#[derive(Clone, Copy)]
struct Pixel {
    visibility: f64,
    facing: f64,
    standard_error: f64,
}

/// Memory that rays of one thread share.
#[derive(Default)]
struct Scratch {
    stack: Vec<u32>,
    /// The triangle that occluded last: often it occludes the next ray as well.
    last_occluder: Option<usize>,
}

/// The visible point of a pixel, relative to the eye.
struct Receiver {
    point: DVec3,
    /// Of length 1, on the visible side.
    normal: DVec3,
    /// [scene units] Where shadow rays start, above `point`.
    offset: f64,
}

struct Tracer<'a> {
    scene: &'a Scene,
    bvh: Bvh,
    /// [scene units, world] What all positions here are relative to.
    origin: DVec3,
    pinhole: Pinhole,
    /// [scene units] What the camera sees is farther away, along its axis.
    near: f64,
    emitter: Emitter,
    /// [scene units] See [`Shot::touch`].
    touch: f64,
    width: usize,
    batch_samples: u32,
    seed: u64,
}

impl<'a> Tracer<'a> {
    fn new(shot: &'a Shot, light: usize, options: ReferenceOptions) -> Result<Self> {
        let invalid = |message: String| Err(Error::Invalid(message));
        if !SAMPLES.contains(&options.samples) {
            return invalid(format!(
                "{} samples are not between {} and {}",
                options.samples,
                SAMPLES.start(),
                SAMPLES.end()
            ));
        }
        if shot.width == 0 || shot.height == 0 {
            return invalid("an image needs at least one pixel".into());
        }
        let Some(area_light) = shot.lights.get(light) else {
            return invalid(format!(
                "there is no light {light}: the shot has {}",
                shot.lights.len()
            ));
        };
        let scene = &*shot.scene;
        Ok(Self {
            scene,
            bvh: Bvh::new(scene, shot.origin())?,
            origin: shot.origin(),
            near: shot.camera.near.unwrap_or(0.0),
            pinhole: Pinhole::new(&shot.camera, shot.width, shot.height)?,
            emitter: Emitter::new(area_light, Ball::around(scene.bounds()), shot.origin())?,
            touch: shot.touch(area_light),
            width: shot.width as usize,
            batch_samples: options.samples.div_ceil(BATCHES),
            seed: options.seed,
        })
    }

    fn pixel(&self, x: usize, y: usize, scratch: &mut Scratch) -> Pixel {
        let Some(receiver) = self.receiver(x, y, scratch) else {
            let nothing = f64::NAN;
            return Pixel {
                visibility: nothing,
                facing: nothing,
                standard_error: nothing,
            };
        };
        let exact = |visibility: f64, facing: f64| Pixel {
            visibility,
            facing,
            standard_error: 0.0,
        };
        if !self.emitter.shines_to(receiver.point) {
            return exact(0.0, 0.0);
        }
        let Some(emitter) = self.emitter.seen_from(receiver.point) else {
            return exact(1.0, 1.0);
        };
        let facing = emitter.share_in_front(receiver.point, receiver.normal);
        if facing == 0.0 {
            return exact(0.0, facing);
        }
        if emitter.is_point() {
            let occluded = self.occluded(&receiver, &emitter, (0.5, 0.5), scratch);
            return exact(if occluded { 0.0 } else { 1.0 }, facing);
        }
        let pixel_seed = mix(self.seed ^ mix((y * self.width + x) as u64));
        let means: [f64; BATCHES as usize] = std::array::from_fn(|batch| {
            let seed = mix(pixel_seed.wrapping_add(batch as u64)) as u32;
            let coordinate =
                |index, dimension| f64::from(sobol_burley::sample(index, dimension, seed));
            let lit = (0..self.batch_samples).filter(|&index| {
                let at = (coordinate(index, 0), coordinate(index, 1));
                !self.occluded(&receiver, &emitter, at, scratch)
            });
            lit.count() as f64 / f64::from(self.batch_samples)
        });
        let count = f64::from(BATCHES);
        let visibility = means.iter().sum::<f64>() / count;
        let squares: f64 = means.iter().map(|mean| (mean - visibility).powi(2)).sum();
        let standard_error = (squares / (count * (count - 1.0))).sqrt();
        Pixel {
            visibility,
            facing,
            standard_error,
        }
    }

    /// What the camera sees in a pixel's centre: not the back of single-sided surfaces, and nothing
    /// where a masked texture is transparent.
    fn receiver(&self, x: usize, y: usize, scratch: &mut Scratch) -> Option<Receiver> {
        let (start, direction) = self.pinhole.ray(x, y);
        let ray = Ray::new(start, direction);
        let visible = |hit: &Hit| {
            let front = self.normal(hit.triangle).dot(direction) < 0.0;
            (front || self.double_sided(hit.triangle)) && hit.t > self.near && self.opaque(hit)
        };
        let hit = self.bvh.nearest(&ray, &mut scratch.stack, visible)?;
        let normal = self.normal(hit.triangle).normalize();
        let [a, b, c] = hit.weights;
        let corners = self.corners(hit.triangle);
        let point = corners[0] * a + corners[1] * b + corners[2] * c;
        Some(Receiver {
            point,
            normal: if normal.dot(direction) < 0.0 {
                normal
            } else {
                -normal
            },
            offset: point.abs().max_element() * OFFSET,
        })
    }

    /// Whether something stands between the receiver and a point on the light as it sees it. What lies below the
    /// receiver's own horizon does not count as occluded.
    fn occluded(
        &self,
        receiver: &Receiver,
        emitter: &Emitter,
        (a, b): (f64, f64),
        scratch: &mut Scratch,
    ) -> bool {
        let on_light = emitter.point(a, b);
        if receiver.normal.dot(on_light - receiver.point) <= 0.0 {
            return false;
        }
        let start = receiver.point + receiver.normal * receiver.offset;
        let ray = Ray::new(start, on_light - start);
        // A lamp's own surface casts no shadow.
        let end = emitter.share_before(start, on_light, self.touch);
        let opaque = |hit: &Hit| self.scene.casts(hit.triangle) && self.opaque(hit);
        let again = |slot| {
            self.bvh
                .test(&ray, slot, end)
                .is_some_and(|hit| opaque(&hit))
        };
        if scratch.last_occluder.is_some_and(again) {
            return true;
        }
        let occluder = self.bvh.any(&ray, &mut scratch.stack, end, opaque);
        scratch.last_occluder = occluder.or(scratch.last_occluder);
        occluder.is_some()
    }

    /// Towards the front, not normalised.
    fn normal(&self, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(c - a)
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.scene.corners_around(self.origin, triangle)
    }

    fn double_sided(&self, triangle: usize) -> bool {
        self.scene.material_of(triangle).double_sided
    }

    /// Whether a ray ends at a hit: always, but where a masked texture is below its cutoff.
    fn opaque(&self, hit: &Hit) -> bool {
        let scene = self.scene;
        if hit.triangle < scene.opaque_count {
            return true;
        }
        let material = scene.material_of(hit.triangle);
        let Some(cutoff) = material.alpha_cutoff else {
            return true;
        };
        let texture_alpha = material.texture.map_or(1.0, |index| {
            let [a, b, c] =
                scene.triangles[hit.triangle].map(|vertex| scene.texcoords[vertex as usize]);
            let along = |axis: fn(Vec2) -> f32| {
                let corners = [a, b, c].map(|corner| f64::from(axis(corner)));
                corners
                    .iter()
                    .zip(hit.weights)
                    .map(|(corner, weight)| corner * weight)
                    .sum()
            };
            texture::alpha(&scene.textures[index], along(|v| v.x), along(|v| v.y))
        });
        texture_alpha * f64::from(material.base_color.w) >= f64::from(cutoff)
    }
}

/// A 64-bit finaliser: similar numbers become unrelated ones [SplitMix64, Steele 2014].
fn mix(value: u64) -> u64 {
    let value = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let value = (value ^ (value >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let value = (value ^ (value >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    value ^ (value >> 31)
}
