//! Which settings a study tries.

use std::collections::BTreeSet;

use crate::technique::{KNOBS, Knob, Settings, Technique};
use crate::{Error, Result};

/// What to try: the variants of each technique, and of each knob that has values here all of them in place of the usual
/// one. A knob without values stays as it is usual.
#[derive(Debug, Clone, Default)]
pub struct Sweep(pub Vec<(&'static Knob, Vec<String>)>);

impl Sweep {
    /// With these values of a knob, given by its field.
    ///
    /// # Errors
    /// There is no such knob.
    pub fn with(mut self, field: &str, values: &[&str]) -> Result<Self> {
        let knob = KNOBS.iter().find(|knob| knob.field == field);
        let knob = knob.ok_or_else(|| Error::Invalid(format!("there is no knob {field}")))?;
        let values = values.iter().map(|&value| value.to_owned());
        self.0.push((knob, values.collect()));
        Ok(self)
    }

    /// All combinations, each once: knobs that a technique does not read multiply nothing.
    ///
    /// # Errors
    /// A value is none of its knob's, or out of its range, whether or not a technique reads it.
    pub fn settings(&self) -> Result<Vec<Settings>> {
        let mut all = self.combinations()?;
        all.iter().try_for_each(Settings::validate)?;
        let mut known = BTreeSet::new();
        all.retain(|settings| known.insert(settings.flags()));
        Ok(all)
    }

    fn combinations(&self) -> Result<Vec<Settings>> {
        let mut all: Vec<Settings> = self
            .techniques()?
            .into_iter()
            .flat_map(Technique::variants)
            .collect();
        let others = self.0.iter().filter(|(knob, _)| knob.field != "technique");
        for (knob, values) in others.filter(|(_, values)| !values.is_empty()) {
            let mut varied = Vec::new();
            for settings in &all {
                for value in values {
                    let mut settings = settings.clone();
                    knob.set(&mut settings, value)?;
                    settings
                        .technique
                        .method()
                        .follow(knob.field, &mut settings);
                    varied.push(settings);
                }
            }
            all = varied;
        }
        Ok(all)
    }

    /// Those that are named, or all.
    fn techniques(&self) -> Result<Vec<Technique>> {
        let named = self.0.iter().filter(|(knob, _)| knob.field == "technique");
        let named: Vec<&String> = named.flat_map(|(_, values)| values).collect();
        match named.is_empty() {
            true => Ok(Technique::ALL.to_vec()),
            false => named.into_iter().map(|name| name.parse()).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(field: &str, values: &[&str]) -> Sweep {
        Sweep::default().with(field, values).unwrap()
    }

    #[test]
    fn without_knobs_it_is_the_variants() {
        let all = Sweep::default().settings().unwrap();
        let variants = Technique::ALL
            .iter()
            .flat_map(|technique| technique.variants());
        assert_eq!(all, variants.collect::<Vec<_>>());
    }

    #[test]
    fn knobs_multiply_where_they_are_read() {
        let sweep = values("technique", &["packet-contour", "hard"])
            .with("split", &["1", "2"])
            .and_then(|sweep| sweep.with("map", &["64", "128", "256"]))
            .and_then(|sweep| sweep.with("packet", &["2x2", "4x4"]))
            .unwrap();
        // Packets, all pixels evaluated or half: 2 splits × 3 maps × 2 packets; hard: nearest and 3×3, times 2 splits × 3 maps.
        assert_eq!(sweep.settings().unwrap().len(), 2 * 12 + 12);
    }

    #[test]
    fn values_out_of_range_are_refused_where_nothing_reads_them_too() {
        let sweep = values("technique", &["hard"])
            .with("layers", &["1", "9"])
            .unwrap();
        let error = sweep.settings().unwrap_err().to_string();
        assert!(error.contains("1 to 4, not 9"), "{error}");
    }

    #[test]
    fn the_search_for_blockers_takes_half_the_filters_samples() {
        let sweep = values("technique", &["pcss"])
            .with("filter_samples", &["1", "64"])
            .unwrap();
        let blockers = sweep
            .settings()
            .unwrap()
            .iter()
            .map(|s| s.blocker_samples)
            .collect::<Vec<_>>();
        assert_eq!(blockers, [1, 32]);
    }
}
