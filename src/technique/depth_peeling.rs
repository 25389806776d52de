//! Soft shadow mapping with depth peeling [BCS08]: several layers of the shadow map, seen from the light's centre,
//! each with its micropatches or its contours.
//!
//! Right: occluders behind other occluders are no longer missed, and their patches close the gaps of the first layer,
//! without gap filling. Wrong: the areas of all layers add up, so a solid whose front and back are both layers hides
//! its part of the light twice: shadows are too dark. How many layers are needed depends on the scene.
//! DEVIATION [BCS08]: no midpoints between layers against self-shadowing, but a slope bias. Contours, not patches, leave
//! out samples below the receiver's plane, as in `packet_contour`.

use super::{Method, Occluders, Recipe, Settings, with};

pub struct DepthPeeling;

impl Method for DepthPeeling {
    fn recipe(&self, settings: &Settings) -> Recipe {
        let layers = settings.layers;
        Recipe {
            layers: if layers > 1 { layers } else { 0 },
            ..Recipe::over_pixels("depth_peeling_visibility", "depth_peeling_visibility.comp")
        }
    }

    fn knobs(&self, _settings: &Settings) -> Vec<&'static str> {
        vec!["split", "layers", "occluders"]
    }

    fn occluders(&self) -> &'static [Occluders] {
        &[Occluders::Micropatches, Occluders::Contours]
    }

    fn constants(&self, settings: &Settings) -> Vec<(&'static str, u32)> {
        vec![(
            "CONTOURS",
            (settings.occluders == Occluders::Contours).into(),
        )]
    }

    fn bias(&self, settings: &Settings) -> f32 {
        match settings.occluders {
            Occluders::Contours => super::CONTOUR_BIAS,
            _ => 1.0,
        }
    }

    fn make_usual(&self, settings: &mut Settings) {
        (settings.split, settings.layers) = (1, 4);
    }

    fn variants(&self, usual: Settings) -> Vec<Settings> {
        let contours = with(&usual, |settings| {
            settings.layers = 2;
            settings.occluders = Occluders::Contours;
        });
        vec![contours, usual]
    }
}
