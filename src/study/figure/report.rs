//! An experiment's outcome, as text, table, record and plot.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use serde_json::json;

use crate::image::write_atomically;
use crate::{Error, Result};

use super::super::run::{Machine, Outcome};
use super::super::table;
use super::check::{Check, Verdict, number};
use super::plot::curves;
use super::{Experiment, Row, Scale};

/// The share of the processors' time beyond which other work counts as a load on the times.
const LOADED: f64 = 0.1;

/// What an experiment has shown.
#[derive(Debug)]
pub struct Report {
    pub experiment: &'static Experiment,
    pub scale: Scale,
    /// The command line that measures this again.
    pub command: String,
    pub machine: Machine,
    /// Timed frames of each candidate at most.
    pub frames: u32,
    /// [0, 1] The share of all processors' time that other processes took meanwhile, where the system tells.
    pub others: Option<f64>,
    pub rows: Vec<Row>,
    pub checks: Vec<Check>,
    /// What else there is to say.
    pub notes: Vec<String>,
}

impl Report {
    pub fn verdict(&self) -> Verdict {
        Verdict::of(&self.checks)
    }

    /// The claim, the figures as a table, and the verdict.
    pub fn text(&self) -> String {
        let experiment = self.experiment;
        let mut text = format!("{}: {}\n", experiment.name, experiment.source);
        for (what, said) in [
            ("the paper", experiment.paper),
            ("it claims", experiment.claim),
            ("run here", experiment.here),
            ("missing", experiment.missing),
        ] {
            if !said.is_empty() {
                text += &format!("  {what:<9}  {said}\n");
            }
        }
        text += "\n";
        text += &self.table_text();
        text += &format!("\nverdict: {}\n", self.verdict());
        for check in &self.checks {
            let holds = if check.holds { "yes" } else { "no " };
            text += &format!("  {holds}  {}: {}\n", check.claim, check.found);
        }
        if self.verdict() != Verdict::SameTrend {
            text += &format!("  why it may differ: {}\n", experiment.differs);
        }
        for note in self.all_notes() {
            text += &format!("note: {note}\n");
        }
        text
    }

    /// What is to be kept in mind about the figures.
    fn all_notes(&self) -> Vec<String> {
        let mut notes = self.notes.clone();
        let failed = |row: &Row| match &row.run.outcome {
            Outcome::Failed(reason) => Some(format!(
                "{}, {}, {}: {reason}",
                row.scene, row.series, row.x
            )),
            Outcome::Measured(_) => None,
        };
        notes.extend(self.rows.iter().filter_map(failed));
        if self.machine.device_kind == "cpu" {
            notes.push(format!(
                "{} is a CPU driver: its times are no GPU's",
                self.machine.device
            ));
        }
        if let Some(share) = self.others.filter(|&share| share > LOADED) {
            notes.push(format!(
                "the machine was loaded, other work took {:.0} % of its processors: times compare within a scene only",
                100.0 * share
            ));
        }
        notes
    }

    fn table_text(&self) -> String {
        let width = |pick: fn(&Row) -> &str| {
            let names = self.rows.iter().map(|row| pick(row).chars().count());
            names.max().unwrap_or(0)
        };
        let (scene, series) = (width(|row| &row.scene), width(|row| &row.series));
        let x = self.experiment.abscissa.chars().count().max(10);
        let columns = self.experiment.columns;
        let wide = |name: &str| name.chars().count().max(10);
        let mut text = format!("{:<scene$}  {:<series$}  ", "", "");
        text += &format!("{:>x$}", self.experiment.abscissa);
        for column in columns {
            text += &format!("  {:>1$}", column.name, wide(column.name));
        }
        text += "\n";
        for row in &self.rows {
            text += &format!("{:<scene$}  {:<series$}  ", row.scene, row.series);
            text += &format!("{:>x$}", number(row.x));
            for column in columns {
                text += &format!("  {:>1$}", number((column.of)(row)), wide(column.name));
            }
            text += "\n";
        }
        text
    }

    /// The figures, and what ran.
    ///
    /// # Errors
    /// A value cannot be written.
    pub fn csv(&self) -> Result<String> {
        let experiment = self.experiment;
        let mut header = vec![
            "scene".to_owned(),
            "series".into(),
            experiment.abscissa.into(),
        ];
        header.extend(experiment.columns.iter().map(|column| column.name.into()));
        let after = [
            "settings", "size", "rays", "device", "driver", "commit", "failure",
        ];
        header.extend(after.map(String::from));
        let row = |row: &Row| {
            let run = &row.run;
            let mut record = vec![row.scene.clone(), row.series.clone(), row.x.to_string()];
            record.extend(experiment.columns.iter().map(|column| {
                let value = (column.of)(row);
                match value.is_finite() {
                    true => value.to_string(),
                    false => String::new(),
                }
            }));
            let failure = match &run.outcome {
                Outcome::Failed(reason) => reason.clone(),
                Outcome::Measured(_) => String::new(),
            };
            record.extend([
                run.settings.flags().join(" "),
                format!("{}x{}", run.size.0, run.size.1),
                run.truth_samples.to_string(),
                run.machine.device.clone(),
                run.machine.driver.clone(),
                run.machine.commit.clone(),
                failure,
            ]);
            record
        };
        table::written(std::iter::once(header).chain(self.rows.iter().map(row)))
    }

    /// Everything, with what is needed to repeat it.
    ///
    /// # Errors
    /// A value cannot be written.
    pub fn json(&self) -> Result<String> {
        let experiment = self.experiment;
        let value = json!({
            "name": experiment.name,
            "source": experiment.source,
            "paper": experiment.paper,
            "claim": experiment.claim,
            "here": experiment.here,
            "missing": experiment.missing,
            "command": self.command,
            "scale": self.scale,
            "frames": self.frames,
            "machine": self.machine,
            "others": self.others,
            "verdict": self.verdict(),
            "checks": self.checks,
            "notes": self.all_notes(),
            "abscissa": experiment.abscissa,
            "rows": self.rows,
        });
        serde_json::to_string_pretty(&value).map_err(|error| Error::Invalid(error.to_string()))
    }

    /// Writes NAME.csv, NAME.json and NAME.svg into a folder, which is made if it is not there.
    ///
    /// # Errors
    /// Something cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        fs::create_dir_all(folder).map_err(|error| Error::io(folder, error))?;
        let plot = curves(self.experiment, &self.rows)?;
        let texts = [self.csv()?, self.json()?, plot];
        for (file, text) in self.experiment.files(folder).iter().zip(texts) {
            write_atomically(file, |out| out.write_all(text.as_bytes()))?;
        }
        Ok(())
    }
}

/// All experiments, a line each.
pub fn list() -> String {
    let mut text = String::new();
    for experiment in &super::EXPERIMENTS {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{:<16}  {}", experiment.name, experiment.source);
    }
    text
}
