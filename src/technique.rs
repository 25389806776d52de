//! Techniques: what each publication runs in every view, between the shared front (g-buffer, shadow map,
//! acceleration structures) and the shared back (resolve, shade). A technique is data, a list of stages: the plan
//! counts them, the renderer records them. All add to one image of occlusion that `resolve` cannot tell apart.

mod bitmask;
mod depth_peeling;
mod hard;
mod micropatch;
mod micropatch_hierarchical;
mod packet_contour;
mod pcss;
mod pixel_contour;
mod reference_maps;

use crate::scene::AreaLight;
use crate::shot::{Settings, Technique};
use crate::sub_light::{self, Part};

/// One dispatch in every view.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Stage {
    /// Name in plans, labels, timings and tables; a stage that integrates visibility says so.
    pub name: &'static str,
    /// File of the shader.
    pub shader: &'static str,
    pub work: Work,
}

/// What a stage is dispatched over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Work {
    /// Every pixel, if the view has casters or nothing is accumulated.
    Pixels,
    /// Every packet of the image, if the view has casters.
    Packets,
    /// The view's list of coherent packets.
    PacketList,
    /// The view's list of single pixels.
    PixelList,
}

/// A technique with its settings, as what there is to run.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Recipe {
    /// Whether the stages read the MSSM: all that have kernels do.
    pub mssm: bool,
    /// Whether they read the hierarchical shadow map.
    pub hsm: bool,
    /// [layer] Of the shadow map that are peeled off and kept; 0 = the map itself is read.
    pub layers: u32,
    /// [word] What a pixel keeps from one round to the next, where a driver bounds loops.
    pub words: u32,
    /// [turn] Of loops for each cell of the map, at most, where a driver bounds them.
    pub turns: u32,
    pub stages: Vec<Stage>,
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

    /// A kernel for each penumbra pixel, and `stage` over the list of them.
    fn over_pixels(name: &'static str, shader: &'static str) -> Self {
        let stage = Stage {
            name,
            shader,
            work: Work::PixelList,
        };
        Self {
            mssm: true,
            words: 1,
            turns: TURNS_OF_SCANS,
            stages: vec![KERNELS, CLASSIFY, stage],
            ..Self::default()
        }
    }

    /// `stage` over all pixels, testing samples of the map.
    fn over_samples(name: &'static str, shader: &'static str) -> Self {
        let stage = Stage {
            name,
            shader,
            work: Work::Pixels,
        };
        Self {
            stages: vec![stage],
            ..Self::default()
        }
    }

    /// Whether it works off lists of packets or pixels.
    pub fn has_lists(&self) -> bool {
        self.has(Work::PacketList) || self.has(Work::PixelList)
    }

    pub fn has(&self, work: Work) -> bool {
        self.stages.iter().any(|stage| stage.work == work)
    }
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

/// The kernels of all pixels, which back-projection techniques share [GBP06, SS07; Yang09 eq. 1].
const KERNELS: Stage = Stage {
    name: "kernels",
    shader: "kernels.comp",
    work: Work::Pixels,
};

/// Packets and pixels to their lists [Yang09 §4.3].
const CLASSIFY: Stage = Stage {
    name: "classify",
    shader: "classify.comp",
    work: Work::Packets,
};

/// The MSSM walked pixel by pixel [Yang09 §4.2].
const PIXELS: Stage = Stage {
    name: "pixel_visibility",
    shader: "pixel_visibility.comp",
    work: Work::PixelList,
};
