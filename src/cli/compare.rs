//! `halfshade compare`: error metrics between two images.

use std::path::{Path, PathBuf};

use halfshade::compare::{
    HEATMAP_LEGEND, Metrics, PictureMetrics, compare, compare_pictures, heatmap,
};
use halfshade::image::{MAX_SAMPLES, Plane, check_writable, read_exr, read_png, write_png};
use halfshade::number::decimals;
use halfshade::{Error, Result};

use super::outputs::{self, Format, Output};
use super::print;

/// Compares an image with its reference: OpenEXR visibility by error metrics, PNG pictures by FLIP.
///
/// Errors are image − reference, in visibility from 0 (umbra) to 1 (lit). Pixels without a surface (NaN)
/// in either image are left out and counted.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The image to judge (.exr or .png)
    image: PathBuf,
    /// The image to judge it by (.exr or .png)
    reference: PathBuf,
    /// Write a picture of the error: signed for .exr, the FLIP map for .png
    #[arg(long, value_name = "FILE.png")]
    heatmap: Option<PathBuf>,
    /// Print one JSON object instead of a table
    #[arg(long)]
    json: bool,
    /// Compare only pixels whose surface faces the whole light (channel `facing` of the reference)
    #[arg(long)]
    facing: bool,
    /// The channel to compare [default: Y, or the only one there is]; one of a light, such as Y1, is also compared with
    /// the Y of an image that has a single light's visibility
    #[arg(long, value_name = "NAME")]
    channel: Option<String>,
    /// Most samples of an image, pixels times channels: what claims more is refused before anything is allocated
    #[arg(long, value_name = "N", default_value_t = MAX_SAMPLES)]
    max_samples: u64,
}

/// Of an image, by name.
type Channels = Vec<(String, Plane)>;

/// The visibility of a single light.
const ALONE: &str = "Y";

/// # Errors
/// What is named cannot be compared, or the picture is not to be written where it is said.
pub fn check(args: &Args) -> Result<()> {
    let invalid = |message: &str| Err(Error::Invalid(message.into()));
    match (is_png(&args.image), is_png(&args.reference)) {
        (true, true) if args.facing || args.channel.is_some() => {
            invalid("--facing and --channel are for .exr images, not for pictures")
        }
        (true, false) | (false, true) => {
            invalid("a .png and an .exr cannot be compared with each other")
        }
        _ => outputs::check(&args.outputs(), &[&args.image, &args.reference]),
    }
}

impl Args {
    fn outputs(&self) -> Vec<Output<'_>> {
        let heatmap = self.heatmap.iter().map(|path| Output {
            flag: "--heatmap",
            path,
            format: Format::Png,
        });
        heatmap.collect()
    }
}

/// # Errors
/// When a file, a channel or a size is not what a comparison needs.
pub fn run(args: &Args) -> Result<()> {
    if let Some(path) = &args.heatmap {
        check_writable(path)?;
    }
    match is_png(&args.image) {
        true => run_pictures(args),
        false => run_planes(args),
    }
}

fn is_png(path: &Path) -> bool {
    path.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("png"))
}

fn run_planes(args: &Args) -> Result<()> {
    let seen = read_exr(&args.image, args.max_samples)?;
    let mut truth = read_exr(&args.reference, args.max_samples)?;
    let facing = match args.facing {
        true => Some(take_facing(&args.reference, &mut truth)?),
        false => None,
    };
    let wanted = args.channel.as_deref();
    let names = [chosen(wanted, &seen, &truth), chosen(wanted, &truth, &seen)];
    let image = take_channel(&args.image, seen, names[0])?;
    let reference = take_channel(&args.reference, truth, names[1])?;
    let metrics = compare(&image, &reference, facing.as_ref())?;
    if let Some(path) = &args.heatmap {
        let rgb8 = heatmap(&image, &reference, facing.as_ref())?;
        write_png(path, image.width as u32, image.height as u32, &rgb8)?;
    }
    match args.json {
        true => print(&json_text(&metrics)),
        false => print(&table(&metrics, args)),
    }
}

fn run_pictures(args: &Args) -> Result<()> {
    let image = read_png(&args.image, args.max_samples)?;
    let (metrics, map) = compare_pictures(&image, &read_png(&args.reference, args.max_samples)?)?;
    if let Some(path) = &args.heatmap {
        write_png(path, image.width, image.height, &map)?;
    }
    match args.json {
        true => print(&json_text(&metrics)),
        false => print(&picture_table(&metrics)),
    }
}

/// Name of the channel to take from `channels`, to be compared with one of `others`: the wanted one, but for a light's
/// that only the other image has by its name, where this one is the visibility of a single light.
fn chosen<'a>(wanted: Option<&'a str>, channels: &Channels, others: &Channels) -> Option<&'a str> {
    let has = |channels: &Channels, wanted: &str| channels.iter().any(|(name, _)| name == wanted);
    let single = has(channels, ALONE) && !channels.iter().any(|(name, _)| is_of_light(name));
    match wanted {
        Some(name) if is_of_light(name) && single && has(others, name) => Some(ALONE),
        wanted => wanted,
    }
}

/// Whether a channel is the visibility of one of several lights: Y0, Y1, …, or called by the light.
fn is_of_light(name: &str) -> bool {
    let number = name.strip_prefix(ALONE).unwrap_or_default();
    name.ends_with(".Y") || !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
}

/// The channel called `name`; without a name `Y`, or else the only one.
fn take_channel(path: &Path, channels: Channels, name: Option<&str>) -> Result<Plane> {
    let names: Vec<String> = channels.iter().map(|(name, _)| name.clone()).collect();
    let wanted = name.unwrap_or(ALONE);
    let alone = name.is_none() && channels.len() == 1;
    let found = channels
        .into_iter()
        .find(|(name, _)| alone || name == wanted);
    found.map(|(_, plane)| plane).ok_or_else(|| {
        let names = names.join(", ");
        Error::parse(
            path,
            format!("has no channel {wanted}; it has {names} (--channel picks one)"),
        )
    })
}

fn take_facing(path: &Path, channels: &mut Channels) -> Result<Plane> {
    let index = channels
        .iter()
        .position(|(name, _)| name == "facing")
        .ok_or_else(|| {
            Error::parse(
                path,
                "has no channel facing, which --facing needs; `halfshade reference` writes it",
            )
        })?;
    Ok(channels.remove(index).1)
}

fn json_text(metrics: &impl serde::Serialize) -> String {
    // Numbers under literal keys: this serialisation cannot fail.
    format!("{}\n", serde_json::json!(metrics))
}

fn table(m: &Metrics, args: &Args) -> String {
    let row = |what: &str, all: &str, shadow: &str| {
        let row = format!("{what:<34}{all:>12}{shadow:>16}");
        row.trim_end().to_string() + "\n"
    };
    let number = |value: f64| decimals(value, 6);
    let shadow = |value: f64| match m.shadow_pixels {
        0 => "–".to_string(),
        _ => number(value),
    };
    let mut text = "error = image − reference, in visibility (0 umbra … 1 lit)\n\n".to_string();
    text += &row("", "all pixels", "shadow pixels");
    let counts = (m.pixels.to_string(), m.shadow_pixels.to_string());
    text += &row("pixels compared", &counts.0, &counts.1);
    for (what, all, in_shadow) in [
        ("mean absolute error (MAE)", m.mae, m.mae_shadow),
        ("root mean square error (RMSE)", m.rmse, m.rmse_shadow),
        ("signed mean (+ = too bright)", m.bias, m.bias_shadow),
        (
            "share with |error| > 0.05",
            m.share_over_0_05,
            m.share_over_0_05_shadow,
        ),
    ] {
        text += &row(what, &number(all), &shadow(in_shadow));
    }
    text += &row("99th percentile of |error|", "", &shadow(m.p99));
    text += &row("maximum of |error|", &number(m.max), "");
    text += "\nshadow pixels: reference below 1\n";
    text += &format!(
        "{} pixel(s) have a surface in only one of the images: left out\n",
        m.mismatched
    );
    if args.facing {
        text += &format!(
            "{} pixel(s) do not face the whole light: left out\n",
            m.left_out_by_facing
        );
    }
    if let Some(path) = &args.heatmap {
        text += &format!("{}: {HEATMAP_LEGEND}\n", path.display());
    }
    text
}

fn picture_table(m: &PictureMetrics) -> String {
    format!(
        "{:<34}{:>12}\n{:<34}{:>12.6}\n{:<34}{:>12.6}\n",
        "pixels compared",
        m.pixels,
        "FLIP, mean (0 = same … 1)",
        m.flip,
        "RMSE of the stored values (0 … 1)",
        m.rmse
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_is_compared_with_the_visibility_of_a_single_one() {
        let channels = |names: &str| -> Channels {
            let plane = Plane::new(1, 1, vec![1.0]).unwrap();
            let names = names.split_whitespace();
            names.map(|name| (name.to_owned(), plane.clone())).collect()
        };
        for (wanted, here, other, found) in [
            (Some("Y1"), "Y facing stderr", "Y0 Y1", Some("Y")),
            (Some("Y1"), "Y", "Y0 Y1", Some("Y")),
            (Some("lamp.Y"), "Y", "lamp.Y sun.Y", Some("Y")),
            // It has it, or another light's, or the other one has it not either.
            (Some("Y1"), "Y0 Y1", "Y", Some("Y1")),
            (Some("Y1"), "Y0 Y2", "Y0 Y1", Some("Y1")),
            (Some("Y1"), "Y Y0", "Y0 Y1", Some("Y1")),
            (Some("Y1"), "Y", "Y", Some("Y1")),
            (Some("Y1"), "facing", "Y1", Some("Y1")),
            // Only visibility stands for visibility.
            (Some("facing"), "Y", "Y facing", Some("facing")),
            (Some("Yes"), "Y", "Yes", Some("Yes")),
            (None, "Y", "Y0 Y1", None),
        ] {
            let name = chosen(wanted, &channels(here), &channels(other));
            assert_eq!(name, found, "{wanted:?} of {here}, against {other}");
        }
    }
}
