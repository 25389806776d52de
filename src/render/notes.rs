//! What a frame shows that nobody will have asked for.

use super::Renderer;
use crate::error::Result;
use crate::plan::{LightPlan, Lighting, shines_along};

impl Renderer {
    /// What is not as it was asked for, a sentence each: what the plan notes, and what the last frame shows. Call it after
    /// a frame.
    ///
    /// # Errors
    /// A Vulkan call failed.
    pub fn notes(&self) -> Result<Vec<String>> {
        let mut notes = self.plan().notes.clone();
        for (index, light) in self.plan().lights.iter().enumerate() {
            let visibility = self.visibility(index)?;
            if visibility.iter().all(|value| value.is_nan()) {
                return Ok(vec![
                    "The camera sees no surface; look at its eye, target and near plane.".into(),
                ]);
            }
            let lit = visibility.iter().any(|&value| value > 0.0);
            if !lit && light.lighting != Lighting::Dark {
                notes.push(self.lights_nothing(light)?);
            }
        }
        Ok(notes)
    }

    fn lights_nothing(&self, light: &LightPlan) -> Result<String> {
        let first = light.light.view_first as usize;
        let fits = self.fits()?;
        let of_light = &fits[first..first + light.light.view_count as usize];
        let faced = of_light.iter().any(|fit| fit.receiver_count > 0);
        let name = &light.name;
        Ok(match faced {
            true => format!("{name} lights nothing that is seen: all that faces it is in shadow."),
            false => format!(
                "{name} lights nothing that is seen: {}, and nothing there faces it.",
                shines_along(light)
            ),
        })
    }
}
