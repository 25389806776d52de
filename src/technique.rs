//! Techniques: what each publication runs in every view, between the shared front (g-buffer, shadow map,
//! acceleration structures) and the shared back (resolve, shade). A technique is data, a list of passes: the plan
//! puts them in order, the renderer records them. All add to one image of occlusion that `resolve` cannot tell apart.

mod bitmask;
mod depth_peeling;
mod hard;
mod micropatch;
mod micropatch_hierarchical;
mod packet_contour;
mod pcss;
mod pixel_contour;
mod reference_maps;

use crate::frame::kernel::{CLASSIFY, KERNELS};
use crate::frame::{Domain, Pass, Resource};
use crate::scene::AreaLight;
use crate::shot::{Settings, Technique};
use crate::sub_light::{self, Part};

/// A technique with its settings, as what there is to run.
#[derive(Debug, Clone, Default)]
pub struct Recipe {
    /// Whether the passes read the MSSM: all that have kernels do.
    pub mssm: bool,
    /// Whether they read the hierarchical shadow map.
    pub hsm: bool,
    /// [layer] Of the shadow map that are peeled off and kept; 0 = the map itself is read.
    pub layers: u32,
    /// [word] What a pixel keeps from one round to the next, where a driver bounds loops.
    pub words: u32,
    /// [turn] Of loops for each cell of the map, at most, where a driver bounds them.
    pub turns: u32,
    /// What runs in each view, between its shadow map and the back, each with the level that it makes.
    pub passes: Vec<(Pass, u32)>,
    /// What the technique has for itself.
    pub resources: &'static [Resource],
}

impl Recipe {
    /// `settings`: as they run for the light ([`Settings::of_light`]).
    pub fn new(settings: &Settings) -> Self {
        match settings.technique {
            Technique::PacketContour => packet_contour::recipe(settings),
            Technique::PixelContour => pixel_contour::recipe(settings),
            Technique::Micropatch => micropatch::recipe(),
            Technique::MicropatchHierarchical => micropatch_hierarchical::recipe(),
            Technique::Bitmask => bitmask::recipe(settings),
            Technique::DepthPeeling => depth_peeling::recipe(settings),
            Technique::Pcss => pcss::recipe(),
            Technique::Hard => hard::recipe(),
            Technique::ReferenceMaps => reference_maps::recipe(),
        }
    }

    /// A kernel for each penumbra pixel, and a pass over the list of them.
    fn over_pixels(name: &'static str, shader: &'static str) -> Self {
        let pass = Pass::dispatch(name, shader, Domain::PixelList).with(SINGLE);
        Self {
            mssm: true,
            words: 1,
            turns: TURNS_OF_SCANS,
            passes: once([KERNELS, CLASSIFY, pass]),
            ..Self::default()
        }
    }

    /// A pass over all pixels that tests samples of the map.
    fn over_samples(name: &'static str, shader: &'static str) -> Self {
        Self {
            passes: once([Pass::dispatch(name, shader, Domain::Pixels)]),
            ..Self::default()
        }
    }

    /// Whether it works off lists of packets or pixels.
    pub fn has_lists(&self) -> bool {
        self.has(Domain::PacketList) || self.has(Domain::PixelList)
    }

    pub fn has(&self, domain: Domain) -> bool {
        self.passes
            .iter()
            .any(|(pass, _)| pass.domain() == Some(domain))
    }
}

/// Passes that make a single level.
fn once(passes: impl IntoIterator<Item = Pass>) -> Vec<(Pass, u32)> {
    passes.into_iter().map(|pass| (pass, 0)).collect()
}

/// The parts of a light that have views of their own; `settings`: as they run for it.
pub fn parts(light: &AreaLight, settings: &Settings) -> Vec<Part> {
    match settings.technique {
        Technique::ReferenceMaps => reference_maps::parts(light, settings),
        _ => sub_light::parts(light, settings.split),
    }
}

/// [turn] Of a scan for each cell: the cell, what is found in it, and what neighbours find that differ in all of it.
const TURNS_OF_SCANS: u32 = 8;
/// [turn] Of a walk through the MSSM, which passes most cells by.
const TURNS_OF_WALKS: u32 = 4;

/// The MSSM walked pixel by pixel [Yang09 §4.2].
const PIXELS: Pass = Pass::dispatch(
    "pixel_visibility",
    "packet_visibility.comp",
    Domain::PixelList,
)
.with(SINGLE);

/// Whoever works off the pixel list has packets of one pixel.
const SINGLE: &[(&str, u32)] = &[
    ("PACKET_WIDTH", 1),
    ("PACKET_HEIGHT", 1),
    ("HELD", 1),
    ("LANES", 0),
];
