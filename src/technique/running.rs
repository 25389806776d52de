//! What settings come to: for a light, for its points, for shaders.

use super::field;
use super::settings::{KNOBS, Knob, Settings};
use super::{Mapping, Occluders, Recipe, Technique};
use crate::Result;
use crate::scene::AreaLight;
use crate::shared::LEAST_BUDGET;

/// Knobs that every technique reads, whatever its lights.
const COMMON: [&str; 3] = ["map", "bias", "views-at-once"];

/// [texel] A map of a point that is no larger is not made smaller.
const POINT_MAP: u32 = 128;

impl Settings {
    /// The settings that a technique is known by: rivals have a single view, as in their publications.
    pub fn usual(technique: Technique) -> Self {
        let mut usual = Self {
            technique,
            ..Self::default()
        };
        technique.method().make_usual(&mut usual);
        usual
    }

    /// The usual settings, but that every sub-light is integrated, as in the publications.
    pub fn published(technique: Technique) -> Self {
        Self {
            near_points: 0,
            ..Self::usual(technique)
        }
    }

    /// As they run for a light: one without extent casts a hard shadow, whatever the technique.
    pub fn of_light(&self, light: &AreaLight) -> Self {
        let mut settings = self.clone();
        if light.is_point() && self.technique != Technique::Hard {
            settings.technique = Technique::Hard;
            settings.percentage_closer = false;
        }
        settings
    }

    /// As they run for points of the light that stand for a part of it: hard shadows of which the mean counts. A quarter of
    /// the texels of large maps is enough, since a point's error is one of many.
    pub fn of_points(&self) -> Self {
        Self {
            technique: Technique::ReferenceMaps,
            map: (self.map / 2).max(self.map.min(POINT_MAP)),
            bias: None,
            ..self.clone()
        }
    }

    /// [texel] The bias that is asked for, or else the usual one, with which the technique errs least: what covers the
    /// way from a receiver to the samples that it is compared with.
    pub fn bias(&self) -> f32 {
        let usual = || self.technique.method().bias(self);
        self.bias.unwrap_or_else(usual)
    }

    /// Whether sub-lights that an occluder is near to give way to points.
    pub fn has_near_points(&self) -> bool {
        self.near_points > 0 && self.reads("near-points", false) == Some(true)
    }

    /// [level] Coarser than the map that a budget can take; None: there is no budget.
    pub fn coarse_levels(&self) -> Option<u32> {
        let whole = self.map.next_power_of_two().ilog2();
        (self.budget).map(|_| whole.saturating_sub(LEAST_BUDGET.ilog2()))
    }

    /// Whether it is the light's points that cast shadows, hard ones.
    pub fn samples_points(&self) -> bool {
        self.technique.method().samples_points()
    }

    /// Whether these settings read a flag, given without its dashes. None: no technique does, it is no knob.
    ///
    /// `point`: for a light without extent, whose shadow is hard whatever the technique.
    pub fn reads(&self, flag: &str, point: bool) -> Option<bool> {
        KNOBS.iter().find(|knob| knob.row.flag == flag)?;
        if COMMON.contains(&flag) {
            return Some(true);
        }
        let mut own = self.technique.method().knobs(self);
        if point {
            // Sub-lights have no extent either, and another technique's knobs are not asked for.
            own.retain(|knob| self.technique == Technique::Hard && *knob != "split");
        }
        let is_read = match flag {
            "technique" => !point || self.technique == Technique::Hard,
            "hierarchy" | "mssm-bits" => !point && Recipe::new(self).kernels,
            "evaluate" => !point && Recipe::new(self).can_join(),
            "counters" | "multisample" => true,
            "no-neighbour-visibility" => self.multisample > 1,
            _ => own.contains(&flag),
        };
        Some(is_read)
    }

    /// As a size of packets: they form where they are [Yang09 §6], among the pixels that the lanes of a subgroup hold.
    pub const LOCAL: (u32, u32) = field::LOCAL;
    /// [pixel] What local packets form in.
    const WINDOW: (u32, u32) = (8, 8);

    /// [pixel] Width and height of what is listed as a packet: the packet, or what local ones form in.
    pub fn window(&self) -> (u32, u32) {
        match self.packet {
            Self::LOCAL => Self::WINDOW,
            packet => packet,
        }
    }

    /// How a packet maps to invocations: local ones have no choice.
    pub fn packet_mapping(&self) -> Mapping {
        match self.packet {
            Self::LOCAL => Mapping::Cooperative,
            _ => self.mapping,
        }
    }

    /// The specialization constants that the technique's shaders take, by name.
    pub fn constants(&self) -> Vec<(&'static str, u32)> {
        let read = KNOBS
            .iter()
            .filter(|knob| self.reads(knob.row.flag, false) == Some(true));
        let constant = |knob: &Knob| Some((knob.row.constant?, knob.number(self)));
        let mut constants: Vec<_> = read.filter_map(constant).collect();
        constants.extend(self.technique.method().constants(self));
        constants
    }

    /// # Errors
    /// [`Error::Invalid`](crate::Error::Invalid) when a setting is out of its range.
    pub fn validate(&self) -> Result<()> {
        KNOBS.iter().try_for_each(|knob| knob.check(self))?;
        let known = self.technique.method().occluders();
        match known.is_empty() || known.contains(&self.occluders) {
            true => Ok(()),
            false => {
                let names: Vec<String> = known.iter().map(Occluders::to_string).collect();
                Err(crate::Error::Invalid(format!(
                    "the occluders of {} are {}, not {}",
                    self.technique,
                    names.join(" or "),
                    self.occluders
                )))
            }
        }
    }
}
