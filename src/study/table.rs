//! The table of all runs: `results.csv`, and the page's.

use serde::Serialize;

use crate::compare::Metrics;
use crate::number::decimals;
use crate::{Error, Result};

use super::run::{Measured, Outcome, Run};

/// Name of a column, and what it says of a run; empty = not measured.
type Column = (&'static str, fn(&Run) -> String);

pub(super) const COLUMNS: &[Column] = &[
    ("shot", |run| run.shot.clone()),
    ("size", |run| format!("{}x{}", run.size.0, run.size.1)),
    ("technique", |run| run.settings.technique.to_string()),
    ("settings", |run| run.label.clone()),
    ("mae_shadow", |run| error(run, |m| m.mae_shadow)),
    ("rmse_shadow", |run| error(run, |m| m.rmse_shadow)),
    ("bias_shadow", |run| error(run, |m| m.bias_shadow)),
    ("p99", |run| error(run, |m| m.p99)),
    ("max", |run| error(run, |m| m.max)),
    ("share_over_0_05_shadow", |run| {
        error(run, |m| m.share_over_0_05_shadow)
    }),
    ("mae", |run| error(run, |m| m.mae)),
    ("rmse", |run| error(run, |m| m.rmse)),
    ("mae_shadow_all", |run| {
        of(run, |m| maybe(m.errors.mae_shadow_all))
    }),
    ("flip", |run| of(run, |m| decimals(m.errors.flip, 6))),
    ("flicker", |run| of(run, |m| maybe(m.errors.flicker))),
    ("shadow_pixels", |run| {
        of(run, |m| m.errors.metrics.shadow_pixels.to_string())
    }),
    ("shadow_ms", |run| ms(run, |m| m.shadow_ms.median)),
    ("shadow_ms_min", |run| ms(run, |m| m.shadow_ms.min)),
    ("shadow_ms_max", |run| ms(run, |m| m.shadow_ms.max)),
    ("visibility_ms", |run| ms(run, |m| m.visibility_ms.median)),
    ("visibility_ms_min", |run| ms(run, |m| m.visibility_ms.min)),
    ("visibility_ms_max", |run| ms(run, |m| m.visibility_ms.max)),
    ("raster_ms", |run| ms(run, |m| m.raster_ms.median)),
    ("compute_ms", |run| ms(run, |m| m.compute_ms.median)),
    ("total_ms", |run| ms(run, |m| m.total_ms.median)),
    ("frames", |run| of(run, |m| m.frames.to_string())),
    ("warm", |run| of(run, |m| m.warm.to_string())),
    ("memory_bytes", |run| {
        of(run, |m| m.memory_bytes.to_string())
    }),
    ("samples_read", |run| counted(run, "samples_read")),
    ("nodes_visited", |run| counted(run, "nodes_visited")),
    ("device", |run| run.machine.device.clone()),
    ("device_kind", |run| run.machine.device_kind.clone()),
    ("driver", |run| run.machine.driver.clone()),
    ("subgroup_size", |run| run.machine.subgroup_size.to_string()),
    ("commit", |run| run.machine.commit.clone()),
    ("command", |run| run.command.clone()),
    ("failure", |run| match &run.outcome {
        Outcome::Failed(reason) => reason.clone(),
        Outcome::Measured(_) => String::new(),
    }),
];

fn maybe(value: Option<f64>) -> String {
    value.map(|value| decimals(value, 6)).unwrap_or_default()
}

fn of(run: &Run, value: impl Fn(&Measured) -> String) -> String {
    run.measured().map(value).unwrap_or_default()
}

fn error(run: &Run, value: fn(&Metrics) -> f64) -> String {
    of(run, |measured| decimals(value(&measured.errors.metrics), 6))
}

fn ms(run: &Run, value: fn(&Measured) -> f64) -> String {
    of(run, |measured| decimals(value(measured), 3))
}

fn counted(run: &Run, name: &str) -> String {
    of(run, |measured| {
        let count = measured.counters.get(name);
        count.map(u64::to_string).unwrap_or_default()
    })
}

/// All runs, with a header.
///
/// # Errors
/// A value cannot be written.
pub(super) fn csv(runs: &[Run]) -> Result<String> {
    let header = COLUMNS.iter().map(|(name, _)| (*name).to_owned()).collect();
    let rows = runs.iter().map(|run| {
        COLUMNS
            .iter()
            .map(|(_, value)| value(run))
            .collect::<Vec<_>>()
    });
    written(std::iter::once(header).chain(rows))
}

/// Records as comma-separated values, below a header if they are structs.
///
/// # Errors
/// A value cannot be written.
pub(super) fn written(records: impl Iterator<Item = impl Serialize>) -> Result<String> {
    let failed = |error: String| Error::Invalid(format!("the table cannot be written: {error}"));
    let mut writer = csv::Writer::from_writer(Vec::new());
    for record in records {
        writer
            .serialize(record)
            .map_err(|error| failed(error.to_string()))?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|error| failed(error.to_string()))?;
    String::from_utf8(bytes).map_err(|error| failed(error.to_string()))
}
