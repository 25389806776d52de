//! `index.html`: plot, table and sheets on one page that needs no network.

use std::fmt::Write;

use crate::{Error, Result};

use super::front::front;
use super::run::Run;
use super::sheet::{Sheet, escaped};
use super::table::COLUMNS;

/// The page with marks where its parts go.
const TEMPLATE: &str = include_str!("page.html");

/// The page.
///
/// `plot`: an SVG.
///
/// # Errors
/// A value cannot be written.
pub(super) fn page(runs: &[Run], plot: &str, sheets: &[Sheet]) -> Result<String> {
    let fronts = fronts(runs);
    let rows: Vec<Vec<String>> = runs
        .iter()
        .map(|run| COLUMNS.iter().map(|(_, value)| value(run)).collect())
        .collect();
    let names: Vec<&str> = COLUMNS.iter().map(|(name, _)| *name).collect();
    let data = serde_json::json!({ "columns": names, "rows": rows, "front": fronts });
    let data = serde_json::to_string(&data).map_err(|error| Error::Invalid(error.to_string()))?;
    let mut figures = String::new();
    for sheet in sheets {
        let (name, file) = (escaped(&sheet.title), address(&sheet.file));
        // Writing to a string cannot fail.
        let _ = writeln!(
            figures,
            "<details><summary>{name}</summary><img loading=\"lazy\" src=\"sheets/{file}\" alt=\"{name}\"></details>"
        );
    }
    let parts = [
        ("<!--devices-->", devices(runs)),
        ("<!--plot-->", plot.to_owned()),
        ("<!--sheets-->", figures),
        // No text of a run ends the script.
        ("/*data*/", data.replace("</", "<\\/")),
    ];
    Ok(parts
        .into_iter()
        .fold(TEMPLATE.to_owned(), |page, (mark, part)| {
            page.replacen(mark, &part, 1)
        }))
}

/// A file name as part of a URL.
fn address(name: &str) -> String {
    percent_encoding::utf8_percent_encode(name, percent_encoding::NON_ALPHANUMERIC).to_string()
}

/// Indices of the runs on the front of their shot and device.
fn fronts(runs: &[Run]) -> Vec<usize> {
    let group = |run: &Run| (run.content.clone(), run.machine.device.clone());
    let on_front = |run: &Run| {
        let peers = runs.iter().filter(|other| group(other) == group(run));
        front(peers).iter().any(|other| std::ptr::eq(*other, run))
    };
    let all = runs.iter().enumerate();
    all.filter(|(_, run)| on_front(run))
        .map(|(index, _)| index)
        .collect()
}

/// A list item for each device.
fn devices(runs: &[Run]) -> String {
    let mut lines: Vec<String> = Vec::new();
    for run in runs {
        let machine = &run.machine;
        let kind = match machine.device_kind.as_str() {
            "cpu" => "a CPU driver, whose times are no GPU's",
            kind => kind,
        };
        let line = format!(
            "<li>{} ({}): {}, subgroups of {}; halfshade {}, commit {}; truth by {} rays a pixel</li>",
            escaped(&machine.device),
            escaped(kind),
            escaped(&machine.driver),
            machine.subgroup_size,
            escaped(&machine.version),
            escaped(&machine.commit),
            run.truth_samples
        );
        if !lines.contains(&line) {
            lines.push(line);
        }
    }
    lines.join("\n")
}
