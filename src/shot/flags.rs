//! Settings as the flags of the command line that ask for them, and as a short name.

use super::{Settings, Technique};
use crate::technique::Recipe;

/// A flag of the command line; a switch has no value.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Knob {
    name: &'static str,
    value: Option<String>,
}

impl Settings {
    /// The flags that ask for these settings: all that the technique reads, so that neither defaults nor a device's
    /// calibration change what they mean. Without `--counters`, which changes no image.
    pub fn flags(&self) -> Vec<String> {
        let mut flags = vec!["--technique".to_owned(), self.technique.to_string()];
        for knob in self.knobs() {
            flags.push(format!("--{}", knob.name));
            flags.extend(knob.value);
        }
        flags
    }

    /// A name for tables: the technique, its maps and views, and what else differs from its usual settings.
    pub fn label(&self) -> String {
        const ALWAYS: [&str; 2] = ["map", "split"];
        let usual = Self::usual(self.technique).knobs();
        let is_told = |knob: &&Knob| ALWAYS.contains(&knob.name) || !usual.contains(knob);
        let mut label = self.technique.to_string();
        for knob in self.knobs().iter().filter(is_told) {
            label += ", ";
            label += &knob.name.replace('-', " ");
            if let Some(value) = &knob.value {
                label += " ";
                label += value;
            }
        }
        label
    }

    fn knobs(&self) -> Vec<Knob> {
        let mut knobs = Vec::new();
        let mut add = |name, value: String| {
            knobs.push(Knob {
                name,
                value: Some(value),
            });
        };
        add("map", self.map.to_string());
        add("bias", self.bias().to_string());
        let technique = self.technique;
        if technique != Technique::ReferenceMaps {
            add("split", self.split.to_string());
        }
        if technique == Technique::PacketContour {
            add("packet", format!("{}x{}", self.packet.0, self.packet.1));
            add("leaf", self.leaf.to_string());
            add("mapping", self.mapping.to_string());
            add("near-points", self.near_points.to_string());
        }
        if Recipe::new(self).mssm {
            add("mssm-bits", self.mssm_bits.to_string());
        }
        if technique == Technique::Bitmask {
            add("light-samples", self.light_samples.to_string());
            add("pattern", self.pattern.to_string());
        }
        if matches!(technique, Technique::Bitmask | Technique::DepthPeeling) {
            add("layers", self.layers.to_string());
        }
        if technique == Technique::DepthPeeling {
            add("occluders", self.occluders.to_string());
        }
        if technique == Technique::Pcss {
            add("blocker-samples", self.blocker_samples.to_string());
            add("filter-samples", self.filter_samples.to_string());
        }
        if technique == Technique::ReferenceMaps {
            add("maps", self.maps.to_string());
        }
        let patches = matches!(
            technique,
            Technique::Micropatch | Technique::MicropatchHierarchical
        );
        for (name, set) in [
            (
                "no-footprint-pruning",
                technique == Technique::PacketContour && !self.footprint_pruning,
            ),
            (
                "hierarchical",
                technique == Technique::PixelContour && self.hierarchical,
            ),
            ("no-gap-filling", patches && !self.gap_filling),
            (
                "percentage-closer",
                technique == Technique::Hard && self.percentage_closer,
            ),
        ] {
            if set {
                knobs.push(Knob { name, value: None });
            }
        }
        knobs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_settings_are_called_by_their_technique_and_maps() {
        let label = |technique| Settings::usual(technique).label();
        assert_eq!(label(Technique::Pcss), "pcss, map 512, split 1");
        assert_eq!(
            label(Technique::PacketContour),
            "packet-contour, map 512, split 4"
        );
        assert_eq!(label(Technique::ReferenceMaps), "reference-maps, map 512");
    }

    #[test]
    fn what_differs_is_named_and_what_is_not_read_is_not() {
        let settings = Settings {
            hierarchical: true,
            map: 1024,
            layers: 3,
            ..Settings::usual(Technique::PixelContour)
        };
        assert_eq!(
            settings.label(),
            "pixel-contour, map 1024, split 1, hierarchical"
        );
        assert_eq!(
            settings.flags().join(" "),
            "--technique pixel-contour --map 1024 --bias 0.25 --split 1 --mssm-bits 32 --hierarchical"
        );
    }
}
