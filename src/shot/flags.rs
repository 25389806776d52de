//! Settings as the flags of the command line that ask for them, and as a short name.

use super::{Settings, Technique};
use crate::technique::Recipe;

/// A flag of the command line that some technique reads.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Knob {
    name: &'static str,
    /// Whether these settings read it.
    read: bool,
    ask: Ask,
}

/// How a flag asks for a setting.
#[derive(Debug, Clone, PartialEq, Eq)]
enum Ask {
    Value(String),
    /// A switch has no value: it is there, or not.
    Switch(bool),
}

impl Knob {
    fn new(name: &'static str, read: bool, value: impl ToString) -> Self {
        let ask = Ask::Value(value.to_string());
        Self { name, read, ask }
    }

    fn switch(name: &'static str, read: bool, on: bool) -> Self {
        let ask = Ask::Switch(on);
        Self { name, read, ask }
    }

    fn value(&self) -> Option<&str> {
        match &self.ask {
            Ask::Value(value) => Some(value),
            Ask::Switch(_) => None,
        }
    }
}

impl Settings {
    /// The flags that ask for these settings: all that the technique reads, so that neither defaults nor a device's
    /// calibration change what they mean. Without `--counters`, which changes no image.
    pub fn flags(&self) -> Vec<String> {
        let mut flags = Vec::new();
        for knob in self.asked() {
            flags.push(format!("--{}", knob.name));
            flags.extend(knob.value().map(str::to_owned));
        }
        flags
    }

    /// A name for tables: the technique, its maps and views, and what else differs from its usual settings.
    pub fn label(&self) -> String {
        const ALWAYS: [&str; 2] = ["map", "split"];
        let usual = Self::usual(self.technique).asked();
        let is_told = |knob: &&Knob| ALWAYS.contains(&knob.name) || !usual.contains(knob);
        let mut label = self.technique.to_string();
        for knob in self.asked().iter().filter(is_told) {
            label += ", ";
            label += &knob.name.replace('-', " ");
            if let Some(value) = knob.value() {
                label += " ";
                label += value;
            }
        }
        label
    }

    /// Whether these settings read a flag, given without its dashes. None: no technique does, it is no setting of theirs.
    ///
    /// `point`: for a light without extent, whose shadow is hard whatever the technique.
    pub fn reads(&self, flag: &str, point: bool) -> Option<bool> {
        let knobs = self.knobs(point);
        let found = knobs.iter().find(|knob| knob.name == flag);
        found.map(|knob| knob.read)
    }

    /// What is read and asked for.
    fn asked(&self) -> Vec<Knob> {
        let mut knobs = self.knobs(false);
        knobs.retain(|knob| knob.read && knob.ask != Ask::Switch(false));
        knobs
    }

    /// The knobs of all techniques; `point` as in [`Self::reads`].
    fn knobs(&self, point: bool) -> Vec<Knob> {
        use Technique::*;
        let technique = self.technique;
        let is = |these: &[Technique]| !point && these.contains(&technique);
        let mssm = !point && Recipe::new(self).mssm;
        let has_packets = is(&[PacketContour]) && self.packet != (1, 1);
        let patches = is(&[Micropatch, MicropatchHierarchical]);
        let packet = format!("{}x{}", self.packet.0, self.packet.1);
        let (bitmask, pcss) = (is(&[Bitmask]), is(&[Pcss]));
        vec![
            Knob::new("technique", !point || technique == Hard, technique),
            Knob::new("map", true, self.map),
            Knob::new("bias", true, self.bias()),
            Knob::new("split", !point && technique != ReferenceMaps, self.split),
            Knob::new("packet", is(&[PacketContour]), packet),
            Knob::new("leaf", has_packets, self.leaf),
            Knob::new("mapping", has_packets, self.mapping),
            Knob::new("near-points", is(&[PacketContour]), self.near_points),
            Knob::new("mssm-bits", mssm, self.mssm_bits),
            Knob::new("light-samples", bitmask, self.light_samples),
            Knob::new("pattern", bitmask, self.pattern),
            Knob::new("layers", is(&[Bitmask, DepthPeeling]), self.layers),
            Knob::new("occluders", is(&[DepthPeeling]), self.occluders),
            Knob::new("blocker-samples", pcss, self.blocker_samples),
            Knob::new("filter-samples", pcss, self.filter_samples),
            Knob::new("maps", is(&[ReferenceMaps]), self.maps),
            Knob::switch(
                "no-footprint-pruning",
                is(&[PacketContour]),
                !self.footprint_pruning,
            ),
            Knob::switch("hierarchical", is(&[PixelContour]), self.hierarchical),
            Knob::switch("no-gap-filling", patches, !self.gap_filling),
            Knob::switch(
                "percentage-closer",
                technique == Hard,
                self.percentage_closer,
            ),
        ]
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

    #[test]
    fn what_a_technique_does_not_read_is_told() {
        let reads = |technique, flag| Settings::usual(technique).reads(flag, false);
        assert_eq!(reads(Technique::PacketContour, "packet"), Some(true));
        assert_eq!(reads(Technique::PixelContour, "packet"), Some(false));
        assert_eq!(reads(Technique::PixelContour, "layers"), Some(false));
        assert_eq!(reads(Technique::Bitmask, "layers"), Some(true));
        assert_eq!(reads(Technique::ReferenceMaps, "split"), Some(false));
        assert_eq!(reads(Technique::Hard, "mssm-bits"), Some(false));
        // A switch is read or not whether it is on or off.
        assert_eq!(reads(Technique::Hard, "percentage-closer"), Some(true));
        assert_eq!(reads(Technique::Pcss, "percentage-closer"), Some(false));
        // No setting of a technique.
        assert_eq!(reads(Technique::Hard, "size"), None);
        // Packets of one pixel have no leaves that their pixels disagree about.
        let single = Settings {
            packet: (1, 1),
            ..Settings::default()
        };
        assert_eq!(single.reads("leaf", false), Some(false));
    }

    #[test]
    fn a_light_without_extent_reads_map_and_bias() {
        for &technique in Technique::ALL {
            let settings = Settings::usual(technique);
            let names = settings.knobs(true).into_iter();
            let read: Vec<_> = names
                .filter(|knob| knob.read)
                .map(|knob| knob.name)
                .collect();
            match technique {
                Technique::Hard => {
                    assert_eq!(read, ["technique", "map", "bias", "percentage-closer"]);
                }
                _ => assert_eq!(read, ["map", "bias"], "{technique}"),
            }
        }
    }
}
