//! Settings as the flags of the command line that ask for them, and as a short name.

use super::settings::{KNOBS, Knob, Settings};

impl Settings {
    /// The flags that ask for these settings: all that the technique reads, so that neither defaults nor a device's
    /// calibration change what they mean. Without `--counters`, which changes no image.
    pub fn flags(&self) -> Vec<String> {
        let mut flags = Vec::new();
        for (knob, value) in self.asked() {
            flags.push(format!("--{}", knob.row.flag));
            flags.extend(value);
        }
        flags
    }

    /// A name for tables: the technique, its maps and views, and what else differs from its usual settings.
    pub fn label(&self) -> String {
        const ALWAYS: [&str; 2] = ["map", "split"];
        let usual = Self::usual(self.technique).asked();
        let is_usual = |knob: &Knob, value: &Option<String>| {
            usual
                .iter()
                .any(|(known, usual)| known.field == knob.field && usual == value)
        };
        let mut label = self.technique.to_string();
        for (knob, value) in self.asked() {
            if knob.row.flag != "technique"
                && (ALWAYS.contains(&knob.row.flag) || !is_usual(knob, &value))
            {
                label += ", ";
                label += &knob.row.flag.replace('-', " ");
                if let Some(value) = value {
                    label += " ";
                    label += &value;
                }
            }
        }
        label
    }

    /// What is read and asked for, with the flags' values; switches have none.
    fn asked(&self) -> Vec<(&'static Knob, Option<String>)> {
        let told = Self {
            bias: Some(self.bias()),
            ..self.clone()
        };
        let is_asked = |knob: &&Knob| {
            knob.row.flag != "counters"
                && self.reads(knob.row.flag, false) == Some(true)
                && (!knob.row.is_switch() || knob.is_on(self))
        };
        let value = |knob: &'static Knob| {
            let value = (!knob.row.is_switch()).then(|| knob.text(&told));
            (knob, value)
        };
        KNOBS.iter().filter(is_asked).map(value).collect()
    }
}
#[cfg(test)]
mod tests {
    use super::*;
    use crate::technique::Technique;

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
            "--technique pixel-contour --map 1024 --bias 0.25 --split 1 --hierarchy graded --mssm-bits 32 \
             --views-at-once none --budget none --evaluate full --hierarchical --multisample 1"
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
    fn a_light_without_extent_reads_what_all_read() {
        for &technique in Technique::ALL {
            let settings = Settings::usual(technique);
            let read: Vec<&str> = (KNOBS.iter().map(|knob| knob.row.flag))
                .filter(|flag| settings.reads(flag, true) == Some(true))
                .collect();
            match technique {
                Technique::Hard => {
                    assert_eq!(
                        read,
                        [
                            "technique",
                            "map",
                            "bias",
                            "views-at-once",
                            "percentage-closer",
                            "multisample",
                            "counters"
                        ]
                    );
                }
                _ => assert_eq!(
                    read,
                    ["map", "bias", "views-at-once", "multisample", "counters"],
                    "{technique}"
                ),
            }
        }
    }
}
