//! The plan in words.

use std::fmt::{Display, Formatter, Result};

use super::{LightPlan, Lighting, Plan, ViewSet};
use crate::frame::Domain;
use crate::scene::Spread;
use crate::technique::Mapping;

const LEVELS: &str = "hierarchy levels";

/// What only the device finds out, and leaves out then.
const ON_DEVICE: [(&str, &str); 3] = [
    ("triangles", "those that shadow nothing visible"),
    ("views", "those without receivers or without casters"),
    (LEVELS, "those above a view's largest kernel"),
];

/// The faces of a view, by where they look in the light's frame.
const FACES: [&str; 5] = ["front", "+u", "-u", "+v", "-v"];

impl Display for Plan {
    fn fmt(&self, out: &mut Formatter) -> Result {
        let (width, height) = self.size;
        let results = match self.outputs.picture {
            true => "picture and visibility",
            false => "visibility only",
        };
        writeln!(out, "image  {width}x{height} pixels, {results}")?;
        writeln!(
            out,
            "scene  {} triangles, {} of them alpha-masked",
            self.frame.opaque_count + self.frame.masked_count,
            self.frame.masked_count
        )?;
        for light in &self.lights {
            self.write_light(out, light)?;
        }
        writeln!(out, "\npasses of a frame    recorded")?;
        for (name, count) in self.passes() {
            writeln!(out, "  {name:<18} {count:>8}")?;
        }
        writeln!(out, "\nmemory                      bytes")?;
        let sum = ("sum", self.memory_bytes());
        for (name, bytes) in self.memory().chain([sum]) {
            writeln!(out, "  {name:<17} {bytes:>13}  {:>10}", human(bytes))?;
        }
        writeln!(out, "\nleft out, and why")?;
        write_columns(
            out,
            (self.omissions.iter()).map(|omission| (&*omission.what, &*omission.reason)),
        )?;
        if self.views().next().is_none() {
            return Ok(());
        }
        writeln!(out, "\nleft out by the device, where it finds so")?;
        let found = ON_DEVICE.into_iter();
        write_columns(
            out,
            found.filter(|(what, _)| *what != LEVELS || self.levels > 0),
        )
    }
}

impl Plan {
    fn write_light(&self, out: &mut Formatter, light: &LightPlan) -> Result {
        let [half_u, half_v] = light.light.half_size;
        let shape = match (half_u == 0.0 && half_v == 0.0, light.light.round != 0) {
            _ if light.light.spread == Spread::Sun as u32 => {
                format!("sun of {:.3} degrees", 2.0 * half_u.atan().to_degrees())
            }
            _ if light.light.spread == Spread::Sphere as u32 => {
                format!("sphere of radius {half_u:.3}")
            }
            (true, _) => "point".to_owned(),
            (_, true) => format!("disc of radius {half_u:.3}"),
            _ if light.light.corner_count > 0 => format!(
                "polygon of {} corners, {:.3} x {:.3}",
                light.light.corner_count,
                2.0 * half_u,
                2.0 * half_v
            ),
            _ => format!("rectangle of {:.3} x {:.3}", 2.0 * half_u, 2.0 * half_v),
        };
        write!(out, "\n{}: {shape}, ", light.name)?;
        match light.lighting {
            Lighting::Dark => writeln!(out, "lights nothing visible"),
            Lighting::Unshadowed => writeln!(out, "casts no shadow on anything visible"),
            Lighting::Shadowed => {
                writeln!(out, "casts shadows")?;
                let mut sets = light.sets.iter();
                sets.try_for_each(|set| self.write_views(out, set))
            }
        }
    }

    fn write_views(&self, out: &mut Formatter, set: &ViewSet) -> Result {
        let faces: Vec<&str> = (0..FACES.len())
            .filter(|&face| (set.views.iter()).any(|view| view.view.face as usize == face))
            .map(|face| FACES[face])
            .collect();
        let part = match set.settings.technique.method().has_views_of_points() {
            true => "point",
            false => "sub-light",
        };
        writeln!(
            out,
            "  views       {}: {} {} x {} {} ({})",
            set.views.len(),
            set.views.len() / faces.len(),
            plural(set.views.len() / faces.len(), part),
            faces.len(),
            plural(faces.len(), "face"),
            faces.join(", ")
        )?;
        let at_once = match self.views_at_once {
            1 => String::new(),
            count => format!(", of {count} views at once"),
        };
        writeln!(
            out,
            "  shadow map  {0}x{0} texels{at_once}",
            set.settings.map
        )?;
        if set.recipe.kernels {
            let (width, height) = self.size;
            writeln!(
                out,
                "  hierarchy   {}, up to {} levels, bounds of {} bits",
                self.hierarchy(&set.settings),
                self.levels,
                self.bounds_bits
            )?;
            writeln!(out, "  kernels     {width}x{height}, one for each pixel")?;
        }
        if set.recipe.has(Domain::PacketList) {
            let (width, height) = self.packet;
            let local = match set.settings.packet_mapping() {
                Mapping::Cooperative => "local, in ",
                Mapping::Serial | Mapping::Lanes => "",
            };
            writeln!(
                out,
                "  packets     {local}{}x{} of {width}x{height} pixels",
                self.size.0.div_ceil(width),
                self.size.1.div_ceil(height)
            )?;
        }
        let passes: Vec<String> = (self.passes_of_view(set.view_first).into_iter())
            .map(|(name, times)| match times {
                1 => name.to_owned(),
                _ => format!("{name} x {times}"),
            })
            .collect();
        writeln!(out, "  each view   {}", passes.join(", "))
    }
}

/// Lines of two columns, the first as wide as it must be.
fn write_columns<'a>(
    out: &mut Formatter,
    rows: impl Iterator<Item = (&'a str, &'a str)> + Clone,
) -> Result {
    let width = rows.clone().map(|(what, _)| what.chars().count()).max();
    let width = width.unwrap_or(0);
    for (what, why) in rows {
        writeln!(out, "  {what:<width$}  {why}")?;
    }
    Ok(())
}

fn plural(count: usize, what: &str) -> String {
    let s = if count == 1 { "" } else { "s" };
    format!("{what}{s}")
}

/// A size for people: the largest binary unit that leaves at least 1.
pub(super) fn human(bytes: u64) -> String {
    let (mut size, mut unit) = (bytes as f64, "B");
    for larger in ["KiB", "MiB", "GiB", "TiB"] {
        if size < 1024.0 {
            break;
        }
        (size, unit) = (size / 1024.0, larger);
    }
    match unit {
        "B" => format!("{bytes} B"),
        _ => format!("{size:.1} {unit}"),
    }
}
