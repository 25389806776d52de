//! What a plan leaves out, and why.

use super::maps::hierarchy_levels;
use super::{Lighting, Omission, Plan};
use crate::frame::{Domain, Scope, counts};
use crate::scene::Outline;
use crate::shot::Shot;

impl Plan {
    fn omit(&mut self, what: impl Into<String>, reason: impl Into<String>) {
        self.omissions.push(Omission {
            what: what.into(),
            reason: reason.into(),
        });
    }

    pub(super) fn list_omissions(&mut self, shot: &Shot) {
        if !self.masked {
            self.omit(
                "fragment shader of the shadow maps",
                "no material is alpha-masked",
            );
        }
        if !self.textured {
            let reason = if shot.scene.textures.is_empty() {
                "no material has a texture"
            } else {
                "only visibility is asked for"
            };
            self.omit("textures and texture coordinates", reason);
        }
        if !self.outputs.picture {
            self.omit("shade", "only visibility is asked for");
        }
        if shot.settings.multisample > 1 && !self.multisampled {
            self.omit("samples of a pixel", "only visibility is asked for");
        }
        for index in 0..self.lights.len() {
            self.omit_of_light(shot, index);
        }
    }

    /// What a kept shadow map leaves out.
    pub(super) fn omit_lasting(&mut self) {
        let lasting = (self.graph.steps.iter())
            .filter(|step| step.pass.lasts && matches!(step.scope, Scope::Views { .. }));
        let names: Vec<&str> = counts(lasting).iter().map(|(name, _)| *name).collect();
        self.omit(
            names.join(", "),
            "nothing that the view depends on has changed since the last frame",
        );
    }

    fn omit_of_light(&mut self, shot: &Shot, index: usize) {
        let planned = &self.lights[index];
        let name = planned.name.clone();
        match planned.lighting {
            Lighting::Dark => {
                return self.omit(
                    format!("{name}: everything"),
                    "no visible surface faces it: visibility 0",
                );
            }
            Lighting::Unshadowed => {
                return self.omit(
                    format!("{name}: shadow maps"),
                    "nothing can cast a shadow on what is visible: visibility 1",
                );
            }
            Lighting::Shadowed => {}
        }
        let accumulates = planned.accumulates();
        let one_face = planned.views().all(|view| view.view.face == 0);
        let (parts, near) = (planned.part_count as u32, planned.near_count as u32);
        let reach =
            (planned.sets.iter()).fold(90.0, |least: f64, set| least.min(set.reach_degrees()));
        let recipe = planned.sets[0].recipe.clone();
        if near > 0 {
            self.omit(
                format!("{name}: contours of {near} of {parts} sub-lights"),
                "an occluder is nearer to each than it is wide: the hard shadows of points stand for it",
            );
        }
        if shot.lights[index].is_point() {
            self.omit(
                format!("{name}: hierarchy, kernels, packets"),
                "the light has no extent: its shadow is hard",
            );
        }
        if !accumulates {
            self.omit(format!("{name}: accumulation"), "it has a single view");
        }
        if one_face {
            self.omit(
                format!("{name}: side faces"),
                format!("every receiver lies within {reach:.0}° of the light's axis"),
            );
        }
        let cells = shot.settings.split * shot.settings.split;
        if parts < cells && !shot.lights[index].is_point() {
            self.omit(
                format!("{name}: {} sub-lights", cells - parts),
                match shot.lights[index].outline() {
                    Outline::Polygon(_) => "the polygon's sides leave nothing of them",
                    _ => "the disc's rim leaves nothing of them",
                },
            );
        }
        if !recipe.kernels && !shot.lights[index].is_point() && near < parts {
            self.omit(
                format!("{name}: hierarchy, kernels, lists"),
                format!("{} has no kernels", shot.settings.technique),
            );
        }
        let packets = shot.settings.reads("packet", false) == Some(true);
        if packets && !recipe.has(Domain::PacketList) && recipe.has(Domain::PixelList) {
            self.omit(
                format!("{name}: packet_visibility"),
                "a packet is a single pixel",
            );
        }
        if recipe.windows && !recipe.has(Domain::PixelList) {
            self.omit(
                format!("{name}: pixel_visibility"),
                "the driver ends no walk of a packet",
            );
        }
        let asked = shot.settings.hierarchy;
        if recipe.kernels && self.hierarchy(&shot.settings) != asked {
            self.omit(
                format!("{name}: nodes of the {asked} hierarchy between those side by side"),
                "the device's largest image does not hold them",
            );
        }
        let wanted = hierarchy_levels(self.map);
        if recipe.kernels && self.levels < wanted {
            self.omit(
                format!("{name}: hierarchy levels {} to {}", self.levels, wanted - 1),
                "the device's largest image does not hold them; larger kernels start from more roots",
            );
        }
    }
}
