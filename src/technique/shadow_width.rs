//! Soft shadows of a single light sample [Kirsch03]: beside the depth of the occluder a map tells how far the nearest texel is that
//! nothing hides; both together attenuate the light. The map of widths is built by an iterated minimum over three or six
//! neighbours, whose distance doubles, or by jump flooding [RT06].
//!
//! Right: shadows that get softer with the distance of the occluder, and hard where it touches, at a cost that hardly depends on the
//! image. Wrong: only what the light's centre does not see is shaded, so shadows are too small by the outer half of their penumbra,
//! and brighter than they are at their borders; where blockers overlap, softness jumps, since one depth is known at a texel, and
//! widths of blockers that join add up to darker shadows; a blocker that receives shadows itself has hardly any penumbra on it, for
//! it widens its own silhouette. Where blockers receive nothing, the depths of farthest back faces make shadows harder where
//! softness would jump, which is seen less [Kirsch03 §5, fig. 6]. Widths end with the starting difference's reach. The shape of the light does not matter.
//! DEVIATION [Kirsch03 §3]: distances are in half sizes of the light (`glsl/technique/shadow_width_visibility.comp`), so that
//! its size counts; faces to the side take the front face's scale.

use super::{Method, Neighbours, Recipe, Settings, with};
use crate::frame::map::{BOTTOM_MAP, bottom_map};
use crate::frame::{Domain, Pass, Resource, Shape};

pub struct ShadowWidth;

/// Where nothing is drawn; it lasts as the map does.
const SEED: Pass =
    Pass::dispatch("width_seed", "shadow_width_seed.comp", Domain::MapTexels).lasting();

/// Widths from neighbours, at one distance.
const SPREAD: Pass = Pass::dispatch(
    "width_spread",
    "shadow_width_spread.comp",
    Domain::MapTexels,
)
.lasting();

const WIDTHS: Resource = Resource::new("shadow_widths", |s| {
    // Two halves, which are read and written in turn.
    Shape::array::<[f32; 2]>(2 * u64::from(s.map) * u64::from(s.map))
});

/// [pass] That spread widths over the map: until the difference is 1, or the distance has been halved to a texel.
fn spreads(settings: &Settings) -> u32 {
    match settings.neighbours {
        Neighbours::Three | Neighbours::Six => settings.start.ilog2() + 1,
        Neighbours::Flood => settings.map.next_power_of_two().ilog2(),
    }
}

impl Method for ShadowWidth {
    fn recipe(&self, settings: &Settings) -> Recipe {
        let mut recipe = Recipe::over_samples("width_visibility", "shadow_width_visibility.comp");
        let spread = (0..spreads(settings)).map(|level| (SPREAD, level));
        let before = [(SEED, 0)].into_iter().chain(spread);
        let bottoms = settings.back_faces.then_some((BOTTOM_MAP, 0));
        recipe.passes.splice(0..0, before.chain(bottoms));
        recipe.resources = vec![WIDTHS, bottom_map(settings.back_faces)];
        recipe
    }

    fn knobs(&self, settings: &Settings) -> Vec<&'static str> {
        let mut knobs = vec!["split", "neighbours", "scale", "shadow-bias", "back-faces"];
        if settings.neighbours != Neighbours::Flood {
            knobs.push("start");
        }
        knobs
    }

    fn constants(&self, settings: &Settings) -> Vec<(&'static str, u32)> {
        vec![("SPREADS", spreads(settings))]
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        let six = with(&usual, |settings| settings.neighbours = Neighbours::Six);
        vec![six, usual]
    }
}
