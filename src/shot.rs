//! One image, completely: a scene, a camera, lights, a size and the settings of the technique.

use std::sync::Arc;

use glam::DVec3;

use crate::scene::{AreaLight, Camera, MAX_COORDINATE, Scene};
use crate::{Error, Result};

#[cfg(feature = "cli")]
mod built_in;
mod flags;
mod load;
mod names;

pub use load::Overrides;

/// What a leaf does whose status differs between the packet's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Leaf {
    /// Null status: the whole packet goes to the pixel-wise list [Yang09 §4.1].
    Reprocess,
    /// The four comparisons are made for each pixel, all else is shared.
    PerPixel,
}

/// How a packet's pixels map to shader invocations.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mapping {
    /// One invocation loops over the packet's pixels [Yang09 alg. 2].
    Serial,
    /// One invocation per pixel; all lanes of a packet walk the same stack.
    Lanes,
}

/// Which publication computes the visibility.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Technique {
    /// [Yang09], this engine's own.
    PacketContour,
    /// [GBP07] as re-implemented in [Yang09]: every cell of the kernel, pixel by pixel.
    PixelContour,
    /// [GBP06]: the back-projected areas of all texels of the kernel.
    Micropatch,
    /// [DU07]: the same, found in a min-max pyramid.
    MicropatchHierarchical,
    /// [SS07]: bits of light samples covered by microquads.
    Bitmask,
    /// [BCS08]: several peeled layers of the shadow map.
    DepthPeeling,
    /// [Fernando05]: blocker search and percentage-closer filter.
    Pcss,
    /// [Williams78]: nearest sample, or 3×3 of them.
    Hard,
    /// The mean of many hard shadow maps.
    ReferenceMaps,
}

/// Where the samples of a bitmask stand in the light's strata.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Pattern {
    /// In their middles.
    Regular,
    /// Anywhere, the same for all pixels.
    Jittered,
}

/// What the texels of a peeled layer stand for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Occluders {
    /// A rectangle each.
    Micropatches,
    /// The area inside their contour.
    Contours,
}

/// The knobs of a technique.
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Settings {
    pub technique: Technique,
    /// [pixel] Width and height of a packet, each 1 to 8; 1×1 is the pixel-wise path.
    pub packet: (u32, u32),
    pub leaf: Leaf,
    pub mapping: Mapping,
    /// [1, 16] The light is cut into split × split sub-lights.
    pub split: u32,
    /// [texel] [16, 8192] Width and height of a shadow map.
    pub map: u32,
    /// 32 or 16: bits of a bound in the MSSM. With 16 they are conservative: half the memory, wider kernels.
    pub mssm_bits: u32,
    /// Leave out nodes whose back-projection misses the light (`algorithm.md` §7).
    pub footprint_pruning: bool,
    /// `PixelContour` only: walk the MSSM instead of every cell.
    pub hierarchical: bool,
    /// `Micropatch…` only: patches reach out to where their left and bottom neighbours end.
    pub gap_filling: bool,
    /// [layer] [1, 4] `Bitmask` and `DepthPeeling` only: peeled layers of the shadow map.
    pub layers: u32,
    /// `DepthPeeling` only.
    pub occluders: Occluders,
    /// [8, 16] `Bitmask` only: the light has light_samples × light_samples samples.
    pub light_samples: u32,
    /// `Bitmask` only.
    pub pattern: Pattern,
    /// [sample] [1, 1024] `Pcss` only: of the blocker search and of the filter.
    pub blocker_samples: u32,
    pub filter_samples: u32,
    /// `Hard` only: the share of 3×3 samples instead of the nearest one.
    pub percentage_closer: bool,
    /// [map] [1, 4096] `ReferenceMaps` only.
    pub maps: u32,
    /// [point] [0, 4096] `PacketContour` only: on the whole light, of those that stand for sub-lights that an occluder is
    /// nearer to than they are wide; fewer where side faces multiply their views; 0 = none, they are integrated all the
    /// same.
    pub near_points: u32,
    /// [texel] Bias along the receiver's plane, in texels of its slope; None: the usual one of what runs
    /// ([`Settings::bias`]).
    pub bias: Option<f32>,
    /// Count pixels, packets, nodes and edges (costs time).
    pub counters: bool,
}

/// One image, completely.
#[derive(Debug, Clone)]
pub struct Shot {
    pub scene: Arc<Scene>,
    pub camera: Camera,
    /// [pixel]
    pub width: u32,
    /// [pixel]
    pub height: u32,
    pub lights: Vec<AreaLight>,
    pub settings: Settings,
    /// What the shot file asked for and is ignored, a sentence each (`Scene::notes` are the scene's).
    pub notes: Vec<String>,
}

/// [texel] The smallest width and height of a shadow map.
const MIN_MAP: u32 = 16;

/// [texel] A map of a point that is no larger is not made smaller.
const POINT_MAP: u32 = 128;

/// [pixel] The largest width and height of an image.
pub const MAX_SIZE: u32 = 32768;

impl Default for Settings {
    fn default() -> Self {
        Self {
            technique: Technique::PacketContour,
            packet: (4, 4),
            leaf: Leaf::PerPixel,
            mapping: Mapping::Serial,
            split: 4,
            map: 512,
            mssm_bits: 32,
            footprint_pruning: true,
            hierarchical: false,
            gap_filling: true,
            layers: 1,
            occluders: Occluders::Micropatches,
            light_samples: 16,
            pattern: Pattern::Jittered,
            blocker_samples: 16,
            filter_samples: 32,
            percentage_closer: false,
            maps: 1024,
            near_points: 256,
            bias: None,
            counters: false,
        }
    }
}

impl Settings {
    /// The settings that a technique is known by: rivals have a single view, as in their publications.
    pub fn usual(technique: Technique) -> Self {
        let usual = Self::default();
        Self {
            technique,
            split: match technique {
                Technique::PacketContour => usual.split,
                _ => 1,
            },
            layers: match technique {
                Technique::DepthPeeling => 4,
                _ => 1,
            },
            ..usual
        }
    }

    /// The usual settings, but that every sub-light is integrated, as in the publications.
    pub fn published(technique: Technique) -> Self {
        Self {
            near_points: 0,
            ..Self::usual(technique)
        }
    }

    /// As they run for a light: one without extent casts a hard shadow, whatever the technique.
    pub fn of_light(&self, light: &AreaLight) -> Self {
        let mut settings = self.clone();
        if light.is_point() && self.technique != Technique::Hard {
            settings.technique = Technique::Hard;
            settings.percentage_closer = false;
        }
        settings
    }

    /// As they run for points of the light that stand for a part of it: hard shadows of which the mean counts. A quarter of
    /// the texels of large maps is enough, since a point's error is one of many.
    pub fn of_points(&self) -> Self {
        Self {
            technique: Technique::ReferenceMaps,
            map: (self.map / 2).max(self.map.min(POINT_MAP)),
            bias: None,
            ..self.clone()
        }
    }

    /// [texel] The bias that is asked for, or else the usual one, with which the technique errs least: what covers the
    /// way from a receiver to the samples that it is compared with.
    pub fn bias(&self) -> f32 {
        let usual = match self.technique {
            // The nearest sample is within half a texel.
            Technique::ReferenceMaps => 0.5,
            // Samples of 3×3 texels are within one and a half.
            Technique::Hard if self.percentage_closer => 1.5,
            // A filter of many texels: where the mean of the error is nothing on most scenes.
            Technique::Pcss => 6.0,
            // Contours' samples are compared with the receiver's plane. What is left is the rasteriser's grid, to which
            // corners of triangles are moved: 1/16 of a texel is what Vulkan asks for.
            _ if self.has_contours() => 0.25,
            _ => 1.0,
        };
        self.bias.unwrap_or(usual)
    }

    /// Whether sub-lights that an occluder is near to give way to points.
    pub fn has_near_points(&self) -> bool {
        self.technique == Technique::PacketContour && self.near_points > 0
    }

    /// Whether it is the light's points that cast shadows, hard ones.
    pub fn samples_points(&self) -> bool {
        matches!(self.technique, Technique::Hard | Technique::ReferenceMaps)
    }

    /// Whether occluders are what contours enclose.
    pub fn has_contours(&self) -> bool {
        match self.technique {
            Technique::PacketContour | Technique::PixelContour => true,
            Technique::DepthPeeling => self.occluders == Occluders::Contours,
            _ => false,
        }
    }

    /// # Errors
    /// [`Error::Invalid`] when a setting is out of its range.
    pub fn validate(&self) -> Result<()> {
        let (width, height) = self.packet;
        let check = |ok: bool, message: String| ok.then_some(()).ok_or(Error::Invalid(message));
        check(
            (1..=8).contains(&width) && (1..=8).contains(&height),
            format!("a packet is 1x1 to 8x8 pixels, not {width}x{height}"),
        )?;
        check(
            (1..=16).contains(&self.split),
            format!("the light's split is 1 to 16, not {}", self.split),
        )?;
        check(
            (MIN_MAP..=8192).contains(&self.map),
            format!(
                "a shadow map is {MIN_MAP} to 8192 texels wide, not {}",
                self.map
            ),
        )?;
        check(
            [16, 32].contains(&self.mssm_bits),
            format!(
                "a bound of the MSSM has 16 or 32 bits, not {}",
                self.mssm_bits
            ),
        )?;
        for (what, value, range) in [
            ("layers of a shadow map", self.layers, 1..=4),
            (
                "samples along a side of the light",
                self.light_samples,
                8..=16,
            ),
            (
                "samples of the blocker search",
                self.blocker_samples,
                1..=1024,
            ),
            ("samples of the filter", self.filter_samples, 1..=1024),
            ("reference maps", self.maps, 1..=4096),
            ("points near occluders", self.near_points, 0..=4096),
        ] {
            check(
                range.contains(&value),
                format!(
                    "the number of {what} is {} to {}, not {value}",
                    range.start(),
                    range.end()
                ),
            )?;
        }
        check(
            self.bias().is_finite() && self.bias() >= 0.0,
            format!(
                "the bias is a finite number of texels from 0, not {}",
                self.bias()
            ),
        )
    }
}

impl Shot {
    /// [scene units, world] What positions on the device are relative to: the camera's eye, so that what is seen keeps its
    /// precision whatever else the scene holds.
    pub fn origin(&self) -> DVec3 {
        self.camera.eye
    }

    /// [scene units] Surfaces no higher over the plane of a light touch it: they are the lamp's own and cast no shadow. That
    /// is 1e-7 of the light's size, or what rounds off coordinates as large as the light's, be it in the file, whose are
    /// no larger than the scene, or seen from the eye.
    pub fn touch(&self, light: &AreaLight) -> f64 {
        let (lower, upper) = self.scene.bounds();
        let in_file = light.center.abs().max_element();
        let of_scene = 0.5 * (upper - lower).max_element();
        let from_eye = (light.center - self.origin()).abs().max_element();
        light.touch(from_eye.max(in_file.min(of_scene)))
    }

    /// # Errors
    /// [`Error::Invalid`] when the shot cannot be rendered: no triangles, no light, or a camera, size,
    /// light or setting that makes no sense.
    pub fn validate(&self) -> Result<()> {
        if self.scene.triangles.is_empty() {
            return Err(Error::Invalid("the scene holds no triangles".into()));
        }
        let size = 1..=MAX_SIZE;
        if !size.contains(&self.width) || !size.contains(&self.height) {
            return Err(Error::Invalid(format!(
                "an image is 1 to {MAX_SIZE} pixels wide and high, not {}x{}",
                self.width, self.height
            )));
        }
        self.camera.validate()?;
        if self.lights.is_empty() {
            return Err(Error::Invalid("there is no light".into()));
        }
        self.lights.iter().try_for_each(AreaLight::validate)?;
        self.settings.validate()
    }
}

/// The smallest |sin| between a camera's `up` and its view direction.
const UP_TOLERANCE: f64 = 1e-6;

impl Camera {
    /// # Errors
    /// [`Error::Invalid`] when a number is not finite or beyond 10¹⁸, eye and target coincide, `up` has
    /// no length or lies along the view direction, the field of view is not in (0, 180), or the near plane is not in
    /// [0, 10¹⁸].
    pub fn validate(&self) -> Result<()> {
        let vectors = [self.eye, self.target, self.up];
        let sane = |v: &DVec3| v.is_finite() && v.abs().max_element() <= MAX_COORDINATE;
        let view = (self.target - self.eye).try_normalize();
        let fault = match (view, self.up.try_normalize()) {
            _ if !vectors.iter().all(sane) => "its eye, target or up is not finite or beyond 1e18",
            _ if !(self.vfov_deg > 0.0 && self.vfov_deg < 180.0) => {
                "its vertical field of view must be more than 0 and less than 180 degrees"
            }
            _ if !self
                .near
                .is_none_or(|near| (0.0..=MAX_COORDINATE).contains(&near)) =>
            {
                "its near plane must be at a distance from 0 to 1e18"
            }
            (None, _) => "its eye and target are the same point",
            (_, None) => "its up has no length",
            (Some(view), Some(up)) if view.cross(up).length() < UP_TOLERANCE => {
                "its up is parallel to the view direction"
            }
            _ => return Ok(()),
        };
        Err(Error::Invalid(format!(
            "the camera cannot be used: {fault}"
        )))
    }
}
