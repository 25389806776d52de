//! Techniques: what each publication runs in every view, between the shared front (g-buffer, shadow map,
//! MSSM) and the shared back (resolve, shade). A technique is data, a list of stages: the plan counts them,
//! the renderer records them. All add to one image of occlusion that `resolve` cannot tell apart.

mod hard;
mod packet_contour;
mod pixel_contour;

use crate::shot::{Settings, Technique};

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
    /// Every pixel.
    Pixels,
    /// Every pixel, if the view has casters or nothing is accumulated.
    Kernels,
    /// Every packet of the image, if the view has casters.
    Packets,
    /// The view's list of coherent packets.
    PacketList,
    /// The view's list of single pixels.
    PixelList,
}

/// A technique with its settings, as what there is to run.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Recipe {
    /// Whether the stages read the MSSM.
    pub mssm: bool,
    pub stages: Vec<Stage>,
}

impl Recipe {
    /// `point`: the light has no extent, so its shadow is hard whatever the technique.
    pub fn new(settings: &Settings, point: bool) -> Self {
        match settings.technique {
            _ if point => hard::recipe(),
            Technique::PacketContour => packet_contour::recipe(settings),
            Technique::PixelContour => pixel_contour::recipe(settings),
            Technique::Hard => hard::recipe(),
        }
    }

    pub fn has(&self, work: Work) -> bool {
        self.stages.iter().any(|stage| stage.work == work)
    }
}

/// The kernels of all pixels, which back-projection techniques share [GBP06, SS07; Yang09 eq. 1].
const KERNELS: Stage = Stage {
    name: "kernels",
    shader: "kernels.comp",
    work: Work::Kernels,
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
    shader: "packet_visibility.comp",
    work: Work::PixelList,
};
