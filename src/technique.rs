//! Techniques: what each publication runs in every view, between the shared front (g-buffer, shadow map,
//! acceleration structures) and the shared back (resolve, shade). A technique is data: its file says which knobs it reads,
//! which passes it has and which memory these take; the plan puts them in order, the renderer records them. All add to one
//! image of occlusion that `resolve` cannot tell apart.
//!
//! To add one: its file, which implements [`Method`], its shaders, and its lines in the list below. Knobs that no technique
//! had before are a row each of the table in `settings`.

mod asked;
mod choice;
mod field;
mod kinds;
mod knob;
mod row;
mod running;
mod settings;

mod bitmask;
mod depth_peeling;
mod hard;
mod micropatch;
mod micropatch_hierarchical;
mod occluder_driven;
mod packet_contour;
mod pcss;
mod pixel_contour;
mod reference_maps;
mod shadow_width;

use crate::frame::kernel::{CLASSIFY, JOIN, KERNELS, SMOOTH_QUALITY, TILES, blended};
use crate::frame::{Domain, Pass, Resource, Work};
use crate::scene::AreaLight;
use crate::shared::FRONT_REACH;
use crate::sub_light::{self, Part};

pub use choice::Choice;
pub use kinds::{Accumulate, Evaluate, Hierarchy, Leaf, Mapping, Neighbours, Occluders, Pattern};
pub use reference_maps::POINT_REACH;
pub use row::{Row, SweepFlag};
pub use settings::{KNOBS, Knob, Settings};

/// Registers techniques, in the order of their numbers in the C library: name of the variant, name for people, and what
/// implements it.
macro_rules! techniques {
    ($($(#[doc = $summary:literal])+ $variant:ident = $name:literal, $method:path;)+) => {
        choice::choice! {
            /// Which publication computes the visibility.
            enum Technique, "technique" {
                $($(#[doc = $summary])+ $variant = $name,)+
            }
        }

        impl Technique {
            /// What it runs.
            pub fn method(self) -> &'static dyn Method {
                match self {
                    $(Self::$variant => &$method,)+
                }
            }
        }
    };
}

techniques! {
    /// Packet-based hierarchical contours [Yang09], the library's own.
    PacketContour = "packet-contour", packet_contour::PacketContour;
    /// Contours pixel by pixel [GBP07], as re-implemented in [Yang09].
    PixelContour = "pixel-contour", pixel_contour::PixelContour;
    /// Back-projected areas of all texels of the kernel [GBP06].
    Micropatch = "micropatch", micropatch::Micropatch;
    /// The same, found in a min-max pyramid [DU07].
    MicropatchHierarchical = "micropatch-hierarchical", micropatch_hierarchical::MicropatchHierarchical;
    /// Light samples covered by microquads [SS07].
    Bitmask = "bitmask", bitmask::Bitmask;
    /// Several peeled layers of the shadow map [BCS08].
    DepthPeeling = "depth-peeling", depth_peeling::DepthPeeling;
    /// Percentage-closer soft shadows [Fernando05].
    Pcss = "pcss", pcss::Pcss;
    /// Hard shadows [Williams78].
    Hard = "hard", hard::Hard;
    /// The mean of many hard shadow maps.
    ReferenceMaps = "reference-maps", reference_maps::ReferenceMaps;
    /// A single light sample and the width of its shadow [Kirsch03].
    ShadowWidth = "shadow-width", shadow_width::ShadowWidth;
    /// Micropatches scattered into a soft shadow map [Atty06].
    OccluderDriven = "occluder-driven", occluder_driven::OccluderDriven;
}

/// What a technique's file says of it. What it leaves out is as for a rival with a single view of kernels.
pub trait Method: Sync {
    /// What runs in each view.
    fn recipe(&self, settings: &Settings) -> Recipe;

    /// The flags of the knobs that it reads with these settings, beside those that all read: map, bias and counters, and
    /// the hierarchy's if it has kernels.
    fn knobs(&self, settings: &Settings) -> Vec<&'static str>;

    /// Specialization constants beside those that knobs set.
    fn constants(&self, _settings: &Settings) -> Vec<(&'static str, u32)> {
        Vec::new()
    }

    /// [texel] The usual bias ([`Settings::bias`]).
    fn bias(&self, _settings: &Settings) -> f32 {
        1.0
    }

    /// Changes default settings to those that it is known by.
    fn make_usual(&self, settings: &mut Settings) {
        settings.split = 1;
    }

    /// The kinds of occluders that it has a choice of; none: there is no choice.
    fn occluders(&self) -> &'static [Occluders] {
        &[]
    }

    /// The settings by which it is compared with others, those that it is known by (`usual`) and its variants.
    fn variants(&self, usual: Settings) -> Vec<Settings> {
        vec![usual]
    }

    /// What goes with another value of a knob, given by its field, where a study tries several.
    fn follow(&self, _field: &str, _settings: &mut Settings) {}

    /// The parts of a light that have views of their own.
    fn parts(&self, light: &AreaLight, settings: &Settings) -> Vec<Part> {
        sub_light::parts(light, settings.split)
    }

    /// Tangent up to which a view's front face holds receivers; side faces hold the rest.
    fn reach(&self) -> f32 {
        FRONT_REACH
    }

    /// Whether points of the light cast its shadows, hard ones.
    fn samples_points(&self) -> bool {
        false
    }

    /// Whether these points are many, each with a view of its own, of which the mean counts.
    fn has_views_of_points(&self) -> bool {
        false
    }
}

impl Technique {
    /// The settings by which it is compared with others.
    pub fn variants(self) -> Vec<Settings> {
        self.method().variants(Settings::usual(self))
    }
}

/// A technique with its settings, as what there is to run.
#[derive(Debug, Clone, Default)]
pub struct Recipe {
    /// Whether the passes have kernels, and so read the hierarchy over the map.
    pub kernels: bool,
    /// Whether packets are not on a grid, but form in windows that the kernels list.
    pub windows: bool,
    /// [layer] Of the shadow map that are peeled off and kept; 0 = the map itself is read.
    pub layers: u32,
    /// [level] Coarser than the map that visibility is blended from; 0 = no budget limits quality.
    pub coarse_levels: u32,
    /// These levels are of microrects.
    pub microrects: bool,
    /// [grid] On which pixels are joined from others, beside that of all pixels; 0 = all are evaluated.
    pub grids: u32,
    /// [word] What a pixel keeps from one round to the next, where a driver bounds loops.
    pub words: u32,
    /// [turn] Of loops for each cell of the map, at most, where a driver bounds them.
    pub turns: u32,
    /// What runs in each view, between its shadow map and the back, each with the level that it makes.
    pub passes: Vec<(Pass, u32)>,
    /// What the technique has for itself.
    pub resources: Vec<Resource>,
}

impl Recipe {
    /// Whether views are looked at side by side, where their maps are made so: they list what they look at, and need nothing else of
    /// their own.
    pub fn side_by_side(&self) -> bool {
        self.windows && self.coarse_levels == 0
    }

    /// `settings`: as they run for the light ([`Settings::of_light`]).
    pub fn new(settings: &Settings) -> Self {
        let mut recipe = settings.technique.method().recipe(settings);
        if recipe.can_join() {
            recipe.grids = settings.evaluate.grids();
        }
        let sparsest_first = (1..=recipe.grids).rev();
        recipe
            .passes
            .extend(sparsest_first.map(|grid| (JOIN, grid)));
        recipe
    }

    /// Whether pixels can be joined from others: levels of quality are smoothed over all that are penumbra.
    fn can_join(&self) -> bool {
        self.kernels && self.coarse_levels == 0
    }

    /// A kernel for each penumbra pixel, and a pass over the list of them.
    fn over_pixels(name: &'static str, shader: &'static str) -> Self {
        let pass = Pass::dispatch(name, shader, Domain::PixelList);
        Self {
            kernels: true,
            words: 1,
            turns: TURNS_OF_SCANS,
            passes: once([TILES, KERNELS, CLASSIFY, pass]),
            ..Self::default()
        }
    }

    /// As it is where a budget of micro-occluders limits quality [Schwarz08 §4.2]: levels of quality are found with the kernels
    /// and smoothed, and visibility is integrated in the two that a pixel's lies between.
    fn within_budget(mut self, settings: &Settings) -> Self {
        let Some(levels) = settings.coarse_levels() else {
            return self;
        };
        self.coarse_levels = levels;
        self.microrects = settings.occluders == Occluders::Microrects;
        let passes = self.passes.into_iter().flat_map(|(pass, level)| {
            let passes = match pass.domain() {
                Some(Domain::PacketList | Domain::PixelList) => blended(pass).to_vec(),
                _ if pass == KERNELS => [&[pass][..], &SMOOTH_QUALITY].concat(),
                _ => vec![pass],
            };
            passes.into_iter().map(move |pass| (pass, level))
        });
        self.passes = passes.collect();
        self
    }

    /// A pass over all pixels that tests samples of the map.
    fn over_samples(name: &'static str, shader: &'static str) -> Self {
        Self {
            passes: once([Pass::dispatch(name, shader, Domain::Pixels)]),
            ..Self::default()
        }
    }

    /// Whether it draws geometry beside the shadow map.
    pub fn redraws(&self) -> bool {
        let draws = |(pass, _): &(Pass, u32)| matches!(pass.work, Work::Draw { what, .. } if what.is_geometry());
        self.layers > 0 || self.passes.iter().any(draws)
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
    settings.technique.method().parts(light, settings)
}

/// The flags of knobs that limit quality.
fn budget_knobs(settings: &Settings) -> &'static [&'static str] {
    match settings.budget {
        None => &["budget"],
        Some(_) => &[
            "budget",
            "budget-falloff",
            "budget-masking",
            "no-query-growth",
        ],
    }
}

/// Of a technique's variants: its usual settings with a change.
fn with(usual: &Settings, change: impl FnOnce(&mut Settings)) -> Settings {
    let mut settings = usual.clone();
    change(&mut settings);
    settings
}

/// [texel] Contours' samples are compared with the receiver's plane. What is left is the rasteriser's grid, to which corners
/// of triangles are moved: 1/16 of a texel is what Vulkan asks for.
const CONTOUR_BIAS: f32 = 0.25;

/// [turn] Of a scan for each cell: the cell, what is found in it, and what neighbours find that differ in all of it.
const TURNS_OF_SCANS: u32 = 8;
/// [turn] Of a walk through the hierarchy, which passes most cells by.
const TURNS_OF_WALKS: u32 = 4;

/// The hierarchy walked pixel by pixel [Yang09 §4.2].
const PIXELS: Pass = Pass::dispatch(
    "pixel_visibility",
    "pixel_visibility.comp",
    Domain::PixelList,
);
