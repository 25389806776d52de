//! Which settings a study tries.

use std::collections::BTreeSet;

use crate::Result;
use crate::shot::{Occluders, Settings, Technique};

/// What to try: the usual settings of each technique, and of each knob that is named all its values in place of the
/// usual one. A knob without values stays as it is usual.
#[derive(Debug, Clone, Default)]
pub struct Sweep {
    /// Empty: all.
    pub techniques: Vec<Technique>,
    pub splits: Vec<u32>,
    /// [texel]
    pub maps: Vec<u32>,
    /// [pixel]
    pub packets: Vec<(u32, u32)>,
    pub layers: Vec<u32>,
    pub light_samples: Vec<u32>,
    /// Of the filter; the search for blockers takes half of them.
    pub filter_samples: Vec<u32>,
    pub reference_maps: Vec<u32>,
    /// [texel]
    pub biases: Vec<f32>,
}

impl Sweep {
    /// All combinations, each once: knobs that a technique does not read multiply nothing.
    pub fn settings(&self) -> Vec<Settings> {
        let mut all = self.combinations();
        let mut known = BTreeSet::new();
        all.retain(|settings| known.insert(settings.flags()));
        all
    }

    /// # Errors
    /// A value is out of its range, whether or not a technique reads it.
    pub fn validate(&self) -> Result<()> {
        self.combinations().iter().try_for_each(Settings::validate)
    }

    fn combinations(&self) -> Vec<Settings> {
        let techniques = match self.techniques.is_empty() {
            true => Technique::ALL,
            false => &self.techniques,
        };
        let mut all: Vec<Settings> = techniques
            .iter()
            .flat_map(|&technique| usual_settings(technique))
            .collect();
        vary(&mut all, &self.splits, |settings, &split| {
            settings.split = split;
        });
        vary(&mut all, &self.maps, |settings, &map| settings.map = map);
        vary(&mut all, &self.packets, |settings, &packet| {
            settings.packet = packet;
        });
        vary(&mut all, &self.layers, |settings, &layers| {
            settings.layers = layers;
        });
        vary(&mut all, &self.light_samples, |settings, &samples| {
            settings.light_samples = samples;
        });
        vary(&mut all, &self.filter_samples, |settings, &samples| {
            settings.filter_samples = samples;
            settings.blocker_samples = (samples / 2).max(1);
        });
        vary(&mut all, &self.reference_maps, |settings, &maps| {
            settings.maps = maps;
        });
        vary(&mut all, &self.biases, |settings, &bias| {
            settings.bias = Some(bias);
        });
        all
    }
}

/// Each of `all` with each of `values`; as they are without values.
fn vary<T>(all: &mut Vec<Settings>, values: &[T], set: impl Fn(&mut Settings, &T)) {
    if values.is_empty() {
        return;
    }
    let varied = all.iter().flat_map(|settings| {
        values.iter().map(|value| {
            let mut settings = settings.clone();
            set(&mut settings, value);
            settings
        })
    });
    *all = varied.collect();
}

/// The settings by which a technique is compared with others: those of its publication, and its variants.
pub fn usual_settings(technique: Technique) -> Vec<Settings> {
    let usual = Settings::usual(technique);
    let with = |change: fn(&mut Settings)| {
        let mut settings = usual.clone();
        change(&mut settings);
        settings
    };
    match technique {
        Technique::PacketContour => vec![
            with(|settings| settings.split = 1),
            with(|settings| settings.split = 2),
            usual,
        ],
        Technique::PixelContour => vec![with(|settings| settings.hierarchical = true), usual],
        Technique::Micropatch => vec![with(|settings| settings.gap_filling = false), usual],
        Technique::Bitmask => vec![
            with(|settings| settings.light_samples = 8),
            with(|settings| settings.layers = 2),
            usual,
        ],
        Technique::DepthPeeling => vec![
            with(|settings| {
                settings.layers = 2;
                settings.occluders = Occluders::Contours;
            }),
            usual,
        ],
        Technique::Hard => vec![with(|settings| settings.percentage_closer = true), usual],
        Technique::ReferenceMaps => vec![with(|settings| settings.maps = 256)],
        Technique::MicropatchHierarchical | Technique::Pcss => vec![usual],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_knobs_it_is_the_usual_settings() {
        let all = Sweep::default().settings();
        let usual: Vec<Settings> = Technique::ALL
            .iter()
            .flat_map(|&technique| usual_settings(technique))
            .collect();
        assert_eq!(all, usual);
        all.iter().for_each(|settings| settings.validate().unwrap());
    }

    #[test]
    fn knobs_multiply_where_they_are_read() {
        let sweep = Sweep {
            techniques: vec![Technique::PacketContour, Technique::Hard],
            splits: vec![1, 2],
            maps: vec![64, 128, 256],
            packets: vec![(2, 2), (4, 4)],
            ..Sweep::default()
        };
        // Packets: 2 splits × 3 maps × 2 packets; hard: nearest and 3×3, times 2 splits × 3 maps.
        assert_eq!(sweep.settings().len(), 12 + 12);
        sweep.validate().unwrap();
    }

    #[test]
    fn values_out_of_range_are_refused_where_nothing_reads_them_too() {
        let sweep = Sweep {
            techniques: vec![Technique::Hard],
            layers: vec![1, 9],
            ..Sweep::default()
        };
        assert!(sweep.settings().iter().all(|settings| settings.layers == 1));
        let error = sweep.validate().unwrap_err().to_string();
        assert!(error.contains("1 to 4, not 9"), "{error}");
    }
}
