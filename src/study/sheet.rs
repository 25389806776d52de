//! Contact sheets: what each run of a technique looks like on a shot, and where it errs.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use crate::compare::HEATMAP_LEGEND;
use crate::{Error, Result};

use super::folder::Folder;
use super::run::{Measured, Run};

/// [pixel] Width of a picture on the sheet, and what is around it.
const PICTURE: u32 = 256;
const MARGIN: u32 = 12;
const CAPTION: u32 = 44;
const HEAD: u32 = 56;
/// Runs side by side.
const COLUMNS: usize = 3;

/// The runs of a technique on a shot and a device.
pub(super) struct Sheet {
    pub title: String,
    /// In the folder `sheets/`.
    pub file: String,
    pub svg: String,
}

/// All sheets; pictures are embedded.
///
/// # Errors
/// A picture cannot be read.
pub(super) fn sheets(folder: &Folder, runs: &[Run]) -> Result<Vec<Sheet>> {
    let mut groups: BTreeMap<String, Vec<(&Run, &Measured)>> = BTreeMap::new();
    for run in runs {
        if let Some(measured) = run.measured() {
            let (width, height) = run.size;
            let title = format!(
                "{}, {width}x{height}: {} on {}",
                run.shot, run.settings.technique, run.machine.device
            );
            groups.entry(title).or_default().push((run, measured));
        }
    }
    groups
        .into_iter()
        .map(|(title, group)| {
            Ok(Sheet {
                svg: sheet(folder, &title, &group)?,
                file: file_name(&title),
                title,
            })
        })
        .collect()
}

/// Letters and digits; what stands between them is a hyphen.
fn file_name(title: &str) -> String {
    let words = title.split(|c: char| !c.is_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    words.join("-") + ".svg"
}

fn sheet(folder: &Folder, title: &str, group: &[(&Run, &Measured)]) -> Result<String> {
    let (run, _) = group[0];
    let scale = f64::from(PICTURE) / f64::from(run.size.0);
    let height = (f64::from(run.size.1) * scale).ceil() as u32;
    let cell = (2 * PICTURE + MARGIN, height + CAPTION + MARGIN);
    let columns = COLUMNS.min(group.len());
    let width = columns as u32 * (cell.0 + MARGIN) + MARGIN;
    let total = HEAD + group.len().div_ceil(columns) as u32 * (cell.1 + MARGIN);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{total}\" \
         font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    text(&mut svg, (MARGIN, 20), title);
    text(
        &mut svg,
        (MARGIN, 40),
        &format!("right: error; {HEATMAP_LEGEND}"),
    );
    for (index, (run, measured)) in group.iter().enumerate() {
        let x = MARGIN + (index % columns) as u32 * (cell.0 + MARGIN);
        let y = HEAD + (index / columns) as u32 * (cell.1 + MARGIN);
        picture(&mut svg, (x, y), height, &folder.picture_file(run))?;
        let right = (x + PICTURE + MARGIN, y);
        picture(&mut svg, right, height, &folder.error_file(run))?;
        text(&mut svg, (x, y + height + 16), &run.label);
        let metrics = &measured.errors.metrics;
        let figures = format!(
            "MAE {:.4}, RMSE {:.4}, 99 % {:.3}, FLIP {:.4}; {:.2} ms",
            metrics.mae_shadow,
            metrics.rmse_shadow,
            metrics.p99,
            measured.errors.flip,
            measured.shadow_ms.median
        );
        text(&mut svg, (x, y + height + 34), &figures);
    }
    svg += "</svg>\n";
    Ok(svg)
}

/// A picture, or of several lights' errors the first.
fn picture(svg: &mut String, (x, y): (u32, u32), height: u32, file: &Path) -> Result<()> {
    let bytes = fs::read(file).map_err(|error| Error::io(file, error))?;
    let data = STANDARD.encode(bytes);
    // Writing to a string cannot fail.
    let _ = writeln!(
        svg,
        "<image x=\"{x}\" y=\"{y}\" width=\"{PICTURE}\" height=\"{height}\" preserveAspectRatio=\"xMidYMin slice\" \
         href=\"data:image/png;base64,{data}\"/>"
    );
    Ok(())
}

fn text(svg: &mut String, (x, y): (u32, u32), words: &str) {
    let _ = writeln!(svg, "<text x=\"{x}\" y=\"{y}\">{}</text>", escaped(words));
}

/// Text as XML and HTML take it.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}
