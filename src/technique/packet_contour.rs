//! Packet-based hierarchical contours [Yang09]: coherent packets share the walk through the hierarchy and the
//! extraction of contour edges; what is left over is integrated pixel by pixel.
//!
//! Right: the same visibility as [GBP07], at a fraction of its cost. Wrong: what a single view per
//! sub-light cannot see; occluders at different depths that overlap on the light count twice.
//! DEVIATION [Yang09]: samples below the receiver's plane do not occlude (`limit_at`), so that tilted surfaces are no
//! occluders of themselves.

use super::{
    CLASSIFY, CONTOUR_BIAS, Evaluate, KERNELS, Leaf, Mapping, Method, PIXELS, Recipe, Settings,
    TILES, TURNS_OF_WALKS, budget_knobs, once, with,
};
use crate::frame::{Domain, Pass};

const PACKETS: Pass = Pass::dispatch(
    "packet_visibility",
    "packet_visibility.comp",
    Domain::PacketList,
);

const COOPERATIVE: Pass = Pass::dispatch(
    "packet_visibility",
    "cooperative_visibility.comp",
    Domain::PacketList,
);

/// How packets map to invocations. None: a packet of a single pixel is a pixel, the pixel-wise path.
fn mapping(settings: &Settings) -> Option<Mapping> {
    (settings.packet != (1, 1)).then(|| settings.packet_mapping())
}

pub struct PacketContour;

impl Method for PacketContour {
    fn recipe(&self, settings: &Settings) -> Recipe {
        let mapping = mapping(settings);
        let passes = match mapping {
            None => once([TILES, KERNELS, CLASSIFY, PIXELS]),
            Some(Mapping::Serial | Mapping::Lanes) => {
                once([TILES, KERNELS, CLASSIFY, PACKETS, PIXELS])
            }
            Some(Mapping::Cooperative) => {
                once([TILES, KERNELS, COOPERATIVE, PIXELS.of_leftovers()])
            }
        };
        Recipe {
            kernels: true,
            words: 1,
            turns: TURNS_OF_WALKS,
            passes,
            windows: mapping == Some(Mapping::Cooperative),
            ..Recipe::default()
        }
        .within_budget(settings)
    }

    fn knobs(&self, settings: &Settings) -> Vec<&'static str> {
        let mut knobs = vec!["split", "packet", "near-points", "no-footprint-pruning"];
        let mapping = mapping(settings);
        if mapping.is_some() && settings.packet != Settings::LOCAL {
            knobs.push("mapping");
        }
        if matches!(mapping, Some(Mapping::Serial | Mapping::Lanes)) {
            knobs.push("leaf");
        }
        knobs.extend(budget_knobs(settings));
        knobs
    }

    fn constants(&self, settings: &Settings) -> Vec<(&'static str, u32)> {
        let (width, height) = settings.window();
        let mapping = mapping(settings);
        let slots = match mapping {
            Some(Mapping::Serial) => width * height,
            _ => 1,
        };
        vec![
            ("PACKET_WIDTH", width),
            ("PACKET_HEIGHT", height),
            ("LANES", (mapping == Some(Mapping::Lanes)).into()),
            ("WINDOWS", (mapping == Some(Mapping::Cooperative)).into()),
            ("SLOTS", slots),
            ("REPROCESS", (settings.leaf == Leaf::Reprocess).into()),
            ("CONTOURS", 1),
        ]
    }

    fn bias(&self, _settings: &Settings) -> f32 {
        CONTOUR_BIAS
    }

    /// The defaults are its own.
    fn make_usual(&self, _settings: &mut Settings) {}

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        let one_view = with(&usual, |settings| settings.split = 1);
        let joining = |settings: &Settings| with(settings, |s| s.evaluate = Evaluate::Half);
        vec![
            joining(&one_view),
            one_view,
            with(&usual, |settings| settings.split = 2),
            joining(&usual),
            usual,
        ]
    }
}
