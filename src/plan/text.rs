//! The plan in words.

use std::fmt::{Display, Formatter, Result};

use super::{LightPlan, Outcome, Plan};

impl Display for Plan {
    fn fmt(&self, out: &mut Formatter) -> Result {
        let (width, height) = self.size;
        writeln!(
            out,
            "image {width}x{height}, {} triangles, {} of them alpha-masked",
            self.frame.opaque_count + self.frame.masked_count,
            self.frame.masked_count
        )?;
        for light in &self.lights {
            self.write_light(out, light)?;
        }
        writeln!(out, "\npasses                 recorded")?;
        for (name, count) in &self.passes {
            writeln!(out, "  {name:<20} {count:>8}")?;
        }
        writeln!(out, "\nmemory                    bytes")?;
        for (name, bytes) in &self.resources {
            writeln!(out, "  {name:<16} {bytes:>12}")?;
        }
        writeln!(out, "  {:<16} {:>12}", "sum", self.memory_bytes())?;
        writeln!(out, "\nleft out")?;
        for omission in &self.omissions {
            writeln!(out, "  {}: {}", omission.what, omission.reason)?;
        }
        writeln!(
            out,
            "  on the device, where it finds so: triangles that shadow nothing visible, views without"
        )?;
        writeln!(
            out,
            "  receivers or casters, mssm levels above a view's largest kernel"
        )
    }
}

impl Plan {
    fn write_light(&self, out: &mut Formatter, light: &LightPlan) -> Result {
        let faces = light.views.len() / light.part_count.max(1);
        match light.outcome {
            Outcome::Dark => writeln!(out, "{}: dark", light.name),
            Outcome::Unshadowed => writeln!(out, "{}: unshadowed", light.name),
            Outcome::Shadowed => writeln!(
                out,
                "{}: {} sub-lights × {faces} faces = {} views, map {}x{}, up to {} mssm levels",
                light.name,
                light.part_count,
                light.views.len(),
                self.map,
                self.map,
                self.levels
            ),
        }
    }
}
